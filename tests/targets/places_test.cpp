// Two resources in one place: found before anything is printed, and in what was printed all the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "check/check.h"
#include "passes/passes.h"
#include "targets/samples.h"
#include "targets/target.h"

namespace lacquer::targets {
namespace {

using ir::Type;

/// Reads a block and two textures. `clash`: the textures are in one place.
ir::Module twoTextures(bool clash) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame", {{"tint", Type::Vec4}});
  const ir::ValueId at = b.dag().swizzle(b.field("frame.tint"), {{0, 1}});
  const ir::ValueId first = b.dag().make(ir::Op::Texture, {b.texture("first", Type::Texture2D, false), at});
  const ir::ValueId second = b.dag().make(ir::Op::Texture, {b.texture("second", Type::Texture2D, false), at});
  b.color("shown", b.dag().add(first, second), 0);
  if (clash) b.module.textures[1].binding = b.module.textures[0].binding;
  return std::move(b.module);
}

std::string messages(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += d.code + ": " + d.message + "\n";
  return text;
}

std::string printed(const ir::Module& module, Target target) {
  return printText(module, schedule::schedule(module, ir::Stage::Fragment), target, {});
}

}  // namespace

TEST(Places, OfTheSamplesDiffer) { EXPECT_EQ(messages(passes::checkPlaces(twoTextures(false))), ""); }

TEST(Places, AClashIsFoundBeforePrinting) {
  EXPECT_EQ(messages(passes::checkPlaces(twoTextures(true))),
            "slot-clash: 'first' and 'second' are both at set 1, binding 1\n"
            "slot-clash: 'first' and 'second' are both at texture unit 3\n");
}

TEST(Places, BlocksAndTexturesShareSetsButNotNumbers) {
  ir::Module module = twoTextures(false);
  module.textures[0].binding = {0, 0, 0};
  EXPECT_EQ(messages(passes::checkPlaces(module)),
            "slot-clash: 'frame' and 'first' are both at set 0, binding 0\n");
}

TEST(Places, AClashIsFoundInSpirv) {
  for (const bool clash : {false, true}) {
    const ir::Module module = twoTextures(clash);
    const std::vector<uint32_t> words =
        writeSpirv(module, schedule::schedule(module, ir::Stage::Fragment), {});
    EXPECT_EQ(messages(check::checkSlots(words, false, "shader")),
              clash ? "slot-clash: 'first' and 'second' are both at set 1, binding 1\n" : "");
  }
}

TEST(Places, AClashIsFoundInTheTexts) {
  struct Text {
    Target target;
    std::string_view expected;
  };
  for (const Text& text : {Text{Target::Glsl, "set 1, binding 1"}, Text{Target::GlslGl, "binding 3"},
                           Text{Target::Hlsl, "set 1, binding 17"}}) {
    for (const bool clash : {false, true}) {
      const std::string source = printed(twoTextures(clash), text.target);
      const Result<check::Spirv> words =
          check::compile(source, text.target, check::Stage::Fragment, "shader");
      ASSERT_TRUE(words) << source << format(words.error()[0]);
      const std::string found = messages(check::checkSlots(*words, text.target == Target::GlslGl, "shader"));
      EXPECT_EQ(found.find("slot-clash: 'first' and 'second' are both at ") == 0, clash) << found;
      EXPECT_EQ(found.find(text.expected) != std::string::npos, clash) << found;
    }
  }
}

}  // namespace lacquer::targets
