// A template with more blocks than a root signature has room for.
#include "targets/root_signature.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

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

TEST(RootSignature, HasARegisterForEverySampler) {
  using Wrap = ir::Sampler::Wrap;
  using Filter = ir::Sampler::Filter;
  std::set<uint32_t> registers;
  size_t count = 0;
  for (const Wrap s : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
    for (const Wrap t : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
      for (const Filter mag : {Filter::Nearest, Filter::Linear}) {
        for (int min = 1; min <= static_cast<int>(Filter::LinearMipmapLinear); ++min, ++count)
          registers.insert(staticRegister({s, t, mag, static_cast<Filter>(min)}));
      }
    }
  }
  EXPECT_EQ(registers.size(), count);
}

TEST(RootSignature, SaysFiltersInDirect3DsWords) {
  using Filter = ir::Sampler::Filter;
  struct Case {
    Filter mag, min;
    const char* text;
  };
  const Case cases[] = {
      {Filter::Linear, Filter::LinearMipmapLinear, "filter=FILTER_MIN_MAG_MIP_LINEAR,"},
      {Filter::Linear, Filter::LinearMipmapNearest, "filter=FILTER_MIN_MAG_LINEAR_MIP_POINT,"},
      {Filter::Linear, Filter::NearestMipmapLinear, "filter=FILTER_MIN_POINT_MAG_MIP_LINEAR,"},
      {Filter::Linear, Filter::NearestMipmapNearest, "filter=FILTER_MIN_POINT_MAG_LINEAR_MIP_POINT,"},
      {Filter::Nearest, Filter::LinearMipmapLinear, "filter=FILTER_MIN_LINEAR_MAG_POINT_MIP_LINEAR,"},
      {Filter::Nearest, Filter::LinearMipmapNearest, "filter=FILTER_MIN_LINEAR_MAG_MIP_POINT,"},
      {Filter::Nearest, Filter::NearestMipmapLinear, "filter=FILTER_MIN_MAG_POINT_MIP_LINEAR,"},
      {Filter::Nearest, Filter::NearestMipmapNearest, "filter=FILTER_MIN_MAG_MIP_POINT,"},
      {Filter::Nearest, Filter::Nearest, "filter=FILTER_MIN_MAG_MIP_POINT, maxLOD=0.25f,"},
      {Filter::Linear, Filter::Linear, "filter=FILTER_MIN_MAG_LINEAR_MIP_POINT, maxLOD=0.25f,"}};
  for (const Case& one : cases) {
    Builder b;
    b.module.textures.emplace_back().sampler = ir::Sampler{{}, {}, one.mag, one.min};
    EXPECT_NE(rootSignature(b.module).find(one.text), std::string::npos) << rootSignature(b.module);
  }
}

}  // namespace lacquer::targets
