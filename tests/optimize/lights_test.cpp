// What a light's own numbers are made of is made once a frame, by whoever fills its fields, not for each
// fragment.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "eval/subject.h"
#include "ir/module.h"
#include "setting/language.h"
#include "setting/options.h"
#include "shader/module.h"
#include "support/cases.h"

namespace lacquer::test::lights_test {
namespace {

struct Setting {
  const char* template_name;
  std::map<std::string, uint32_t, std::less<>> counts;  ///< none: any lights
  std::map<std::string, bool, std::less<>> switches;
  std::vector<std::string> left;  ///< what is not done once a frame
};

ir::Module moduleOf(const std::string& work, const Setting& setting) {
  Options options;
  options.template_name = setting.template_name;
  options.switches = setting.switches;
  options.ibl = false;
  if (!setting.counts.empty()) options.lights = {Lights::Mode::Fixed, setting.counts};
  const auto language = libraryFor(options);
  const std::string path = (sourceFolder() / "bench/works" / (work + ".gltf")).string();
  const Result<material::Document> document = readMaterials(path, **language, options);
  EXPECT_TRUE(document.has_value()) << path;
  EXPECT_TRUE(resolveNames(**language, options));
  const EvalSubject subject(document->materials[0]);
  Diagnostics warnings;
  const auto graph = subject.built(document->uses[0][0], **language, options, warnings);
  EXPECT_TRUE(graph) << format(graph.error()[0]);
  Result<ir::Module> module = toModule(*graph, **language, options, {});
  EXPECT_TRUE(module) << format(module.error()[0]);
  return std::move(*module);
}

/// The arithmetic of the fragment stage on fields of a light, numbers and what else is the same all over the
/// frame, but for flags.
std::vector<std::string> lightsOwn(const ir::Module& module) {
  std::vector<std::string> found;
  std::vector<bool> own(module.dag.size(), false), of_light(module.dag.size(), false);
  for (const ir::ValueId id : ir::reachable(module, ir::Stage::Fragment)) {
    const ir::Value& value = module.dag[id];
    const auto block = ir::blockOf(module, id);
    const bool lights =
        block && (module.blocks[*block].role == ir::BlockRole::Lights || value.op == ir::Op::Element);
    const auto operands = value.operands();
    if (lights || operands.empty()) {
      of_light[id] = lights;
      own[id] = lights || value.rate <= ir::Rate::Frame;
      continue;
    }
    own[id] = std::all_of(operands.begin(), operands.end(), [&](ir::ValueId k) { return own[k]; });
    of_light[id] = std::any_of(operands.begin(), operands.end(), [&](ir::ValueId k) { return of_light[k]; });
    const bool moves =
        value.op == ir::Op::Swizzle || value.op == ir::Op::Construct || value.op == ir::Op::Neg;
    if (own[id] && of_light[id] && !moves && value.type != ir::Type::Bool)
      found.push_back(
          fmt::format("{} in {}", ir::info(value.op).name, module.dag.terms()[module.dag.termOf(id)].name));
  }
  return found;
}

TEST(LightsOwn, WorkIsDoneOnceAFrame) {
  const std::map<std::string, bool, std::less<>> all = {
      {"light_shadows", true}, {"light_cookies", true}, {"light_profiles", true}, {"light_masks", true}};
  // The length of an area's axes: that they are shorter than what they are divided by is proved of them, of
  // any light.
  const std::string length = "dot in area_sample";
  const Setting settings[] = {
      {"forward", {}, {}, {}},
      {"forward", {{"directional", 1}}, {}, {}},
      {"forward", {{"directional", 1}, {"point", 1}, {"spot", 1}}, {}, {}},
      {"forward", {{"directional", 2}, {"point", 4}, {"spot", 3}}, {}, {}},
      {"forward_clustered", {}, all, {}},
      {"forward_area", {}, {}, {length, length}},
      {"forward_area", {{"rect", 1}, {"disk", 2}}, {}, {length, length, length, length}}};
  for (const char* work : {"w0", "w3", "c"}) {
    for (const Setting& setting : settings)
      EXPECT_EQ(lightsOwn(moduleOf(work, setting)), setting.left) << work << " " << setting.template_name;
  }
}

}  // namespace
}  // namespace lacquer::test::lights_test
