// What is kept between runs is found again under a key: an option that decides it must change the key.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "run/source_file.h"
#include "setting/language.h"
#include "setting/option_key.h"
#include "support/cases.h"

namespace lacquer::test::key_test {
namespace {

struct Row {
  const char* option;
  Decides decides;
  std::function<void(Options&)> change;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows = {
      {"profile", Decides::Graph, [](Options& o) { o.profile = "openpbr"; }},
      {"as", Decides::Graph, [](Options& o) { o.as = "gltf"; }},
      {"simplify", Decides::Graph, [](Options& o) { o.simplify = {"without:coat"}; }},
      {"template_name", Decides::Graph, [](Options& o) { o.template_name = "surface"; }},
      {"targets", Decides::Run, [](Options& o) { o.targets = {Target::Hlsl}; }},
      {"parameters", Decides::Module, [](Options& o) { o.parameters = Parameters::Baked; }},
      {"binding", Decides::Module, [](Options& o) { o.binding = BindingModel::Bindless; }},
      {"static_samplers", Decides::Module, [](Options& o) { o.static_samplers = true; }},
      {"lights", Decides::Graph, [](Options& o) { o.lights.mode = Lights::Mode::Scene; }},
      {"ibl", Decides::Graph, [](Options& o) { o.ibl = false; }},
      {"multiple_scattering", Decides::Graph, [](Options& o) { o.multiple_scattering = false; }},
      {"dfg_table", Decides::Graph, [](Options& o) { o.dfg_table = false; }},
      {"decode_srgb", Decides::Graph, [](Options& o) { o.decode_srgb = true; }},
      {"permissive", Decides::Graph, [](Options& o) { o.permissive = true; }},
      {"validate", Decides::Code, [](Options& o) { o.validate = false; }},
      {"unused", Decides::Graph, [](Options& o) { o.unused = true; }},
      {"spirv_route", Decides::SpirvCode, [](Options& o) { o.spirv_route = SpirvRoute::Glslang; }},
      {"relaxed", Decides::Module, [](Options& o) { o.relaxed = 0.01; }},
      {"half", Decides::Module, [](Options& o) { o.half = true; }},
      {"optimize", Decides::Module, [](Options& o) { o.optimize = 1; }},
      {"optimize_error", Decides::Module, [](Options& o) { o.optimize_error = 0.001; }},
      {"optimize_for", Decides::Module, [](Options& o) { o.optimize_for = "navi21"; }},
      {"debug", Decides::SpirvCode, [](Options& o) { o.debug = true; }},
      {"live", Decides::Graph, [](Options& o) { o.live = {"coat.darkening"}; }},
      {"node_directories", Decides::Run, [](Options& o) { o.node_directories = {"nodes"}; }},
      {"node_texts", Decides::Run,
       [](Options& o) {
         o.node_texts = {{"a.node", ""}};
       }},
      {"materialx_directories", Decides::Run, [](Options& o) { o.materialx_directories = {"studio"}; }},
      {"materialx_texts", Decides::Run,
       [](Options& o) {
         o.materialx_texts = {{"a.mtlx", ""}};
       }},
      {"document_texts", Decides::Nothing,
       [](Options& o) {
         o.document_texts = {{"a.mtlx", ""}};
       }},
      {"jobs", Decides::Nothing, [](Options& o) { o.jobs = 2; }},
      {"cache", Decides::Nothing, [](Options& o) { o.cache = "cache"; }},
      {"cache_size", Decides::Nothing, [](Options& o) { o.cache_size = 1; }},
      {"depfile", Decides::Run, [](Options& o) { o.depfile = "a.d"; }},
      {"shard", Decides::Run, [](Options& o) { o.shard = "a.json"; }},
      {"switches", Decides::Graph, [](Options& o) { o.switches["direct_multiple_scattering"] = true; }},
      {"limits", Decides::Graph, [](Options& o) { o.limits = {"file=1M"}; }},
      {"allow", Decides::Nothing, [](Options& o) { o.allow = {"images"}; }},
      {"cache_key", Decides::Nothing, [](Options& o) { o.cache_key = "key"; }},
      {"argument_buffers", Decides::MslCode, [](Options& o) { o.argument_buffers = true; }},
      {"sync", Decides::Nothing, [](Options& o) { o.sync = false; }},
      {"programs", Decides::Run, [](Options& o) { o.programs = 2; }},
      {"fallback", Decides::Run, [](Options& o) { o.fallback = true; }},
      {"weights", Decides::Run, [](Options& o) { o.weights = "weights.json"; }},
      {"programs_report", Decides::Run, [](Options& o) { o.programs_report = "programs.md"; }},
      {"properties", Decides::Graph, [](Options& o) { o.properties = true; }},
      {"packed", Decides::Run, [](Options& o) { o.packed = "all.lqpm"; }},
      {"pipelines", Decides::Run, [](Options& o) { o.pipelines = "pipelines.json"; }},
      {"programs_model", Decides::Run, [](Options& o) { o.programs_model = true; }},
  };
  return kRows;
}

Options changed(const Row& row) {
  Options options;
  row.change(options);
  return options;
}

Key keyOf(const Options& options, Decides what) {
  KeyBuilder key;
  addOptions(options, {what}, key);
  return key.finish();
}

constexpr Decides kAll[] = {Decides::Graph,   Decides::Module, Decides::Code,   Decides::SpirvCode,
                            Decides::MslCode, Decides::Run,    Decides::Nothing};

TEST(OptionKeys, HoldWhatTheOptionDecides) {
  const Options none;
  for (const Row& row : rows()) {
    const Options options = changed(row);
    for (const Decides what : kAll) {
      EXPECT_EQ(keyOf(options, what) != keyOf(none, what), what == row.decides)
          << row.option << " " << static_cast<int>(what);
    }
  }
}

TEST(OptionKeys, EveryOptionIsTried) {
  size_t count = 0;
  const Options none;
  eachOption(none, [&](Decides, const auto&) { ++count; });
  EXPECT_EQ(rows().size(), count);
}

TEST(OptionKeys, EachPartOfTheLightsCounts) {
  const std::function<void(Lights&)> changes[] = {
      [](Lights& l) { l.mode = Lights::Mode::Fixed; }, [](Lights& l) { l.counts["directional"] = 1; },
      [](Lights& l) { l.counts["directional"] = 2; }, [](Lights& l) { l.counts["spot"] = 1; }};
  const Options none;
  std::vector<Key> keys{keyOf(none, Decides::Graph)};
  for (const auto& change : changes) {
    Options options;
    change(options.lights);
    keys.push_back(keyOf(options, Decides::Graph));
    EXPECT_EQ(std::count(keys.begin(), keys.end(), keys.back()), 1);
  }
}

TEST(OptionKeys, ListsDoNotRunIntoOneAnother) {
  Options one;
  Options other = one;
  one.live = {"coat", "emission"};
  other.live = {"coat"};
  other.profile = "emission";
  EXPECT_NE(keyOf(one, Decides::Graph), keyOf(other, Decides::Graph));
}

TEST(Keys, ContentsThatMeetHaveKeysOfTheirOwn) {
  Keys keys(0);
  const Key a = keys.of("a"), b = keys.of("b"), c = keys.of("c");
  EXPECT_TRUE(a != b && b != c && a != c);
  EXPECT_EQ(keys.of("b"), b);
  EXPECT_EQ(keys.contentOf(c), "c");
  EXPECT_TRUE(keys.take(a, "a"));
  EXPECT_FALSE(keys.take(a, "other"));
  EXPECT_EQ(keys.contentOf(lacquer::keyOf("never asked for")), "");
}

TEST(Keys, ShadersOfOneIdentifierAreTold) {
  Options options;
  options.targets = {Target::Spirv};
  const auto language = libraryFor(options);
  ASSERT_TRUE(language.has_value());
  ASSERT_TRUE(resolveNames(**language, options));
  const auto diagnosticsOf = [&](size_t bits) {
    Setting setting{options, **language, {}};
    setting.id_bits = bits;
    Structures structures(setting);
    const std::string path = (sourceFolder() / "examples/coat.gltf").string();
    const FileResult result = makeInput(path, InputKind::ByName, {}, setting, structures);
    EXPECT_EQ(result.ok, bits == Keys::kAll);
    return static_cast<size_t>(std::count_if(result.diagnostics.begin(), result.diagnostics.end(),
                                             [](const Diagnostic& d) { return d.code == "same-id"; }));
  };
  EXPECT_EQ(diagnosticsOf(Keys::kAll), 0u);
  EXPECT_GT(diagnosticsOf(0), 0u);
}

}  // namespace
}  // namespace lacquer::test::key_test
