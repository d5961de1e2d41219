// A template with more blocks than a root signature has room for.
#include "targets/root_signature.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "targets/samples.h"

namespace lacquer::targets {
namespace {

/// `frame` and `object` blocks, each at a binding of its own.
ir::Module manyBlocks(uint32_t frame, uint32_t object) {
  Builder b;
  for (uint32_t i = 0; i < frame + object; ++i) {
    const bool of_frame = i < frame;
    b.block(of_frame ? ir::BlockRole::Frame : ir::BlockRole::Object, fmt::format("Block{}", i),
            fmt::format("block{}", i), {{"x", ir::Type::Vec4}});
    b.module.blocks.back().binding = {of_frame ? 0U : ir::kObjectSet, of_frame ? i : i - frame, i};
  }
  return std::move(b.module);
}

std::string kindsOf(const ir::Module& module) {
  std::string text;
  for (const RootParameter& p : rootParameters(module))
    text += p.kind == RootKind::Block    ? std::string("b")
            : p.kind == RootKind::Blocks ? fmt::format("({} of {})", p.count, p.space)
                                         : fmt::format("{}", static_cast<int>(p.kind));
  return text;
}

}  // namespace

TEST(RootSignature, HasItsBlocksInTheRootAsLongAsTheyFit) {
  EXPECT_EQ(kindsOf(manyBlocks(2, 1)), "0b34b34bb34");
  const std::string all(26, 'b');
  EXPECT_EQ(kindsOf(manyBlocks(26, 1)), "0b34b34" + all + "34") << "63 words";
}

TEST(RootSignature, PutsTheFramesIntoATableWhereTheyDoNotFit) {
  EXPECT_EQ(kindsOf(manyBlocks(30, 2)), "0bb34b34(30 of 0)34");
  EXPECT_EQ(kindsOf(manyBlocks(30, 30)), "0(30 of 2)34b34(30 of 0)34");
  EXPECT_NE(rootSignature(manyBlocks(30, 2))
                .find("DescriptorTable(CBV(b0, space=0, numDescriptors=30, flags=DESCRIPTORS_VOLATILE))"),
            std::string::npos);
}

}  // namespace lacquer::targets
