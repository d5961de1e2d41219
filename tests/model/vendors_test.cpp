// Extensions of several vendors that call things alike: each means its own, and nothing is said of another's
// file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "graph/graph.h"
#include "model/build.h"

namespace lacquer::test {
namespace {

/// A layer of a vendor, in names that say nothing of the vendor. `type` is that of the property.
std::string layer(std::string_view extension, std::string_view type, std::string_view hidden,
                  std::string_view extra = {}) {
  std::string text = R"(
/// A layer.
/// source: EXTENSION
extension EXTENSION {
    TYPE amount in [0, 1] = TYPE(0);
    texture amountTexture .rgb;
    float roughnessFactor in [0, 1] = 0.5;
}

/// How much it hides at most.
const float MOST = HIDDEN;

/// A layer over the coat.
/// source: EXTENSION
part dust of EXTENSION over coat unless amount == TYPE(0) {
surface:
    dust.cover = cover(amount, amountTexture);
    bool rough = roughnessFactor == 1;
direct:
    dust.direct = covered(below.direct, dust.cover);
    out direct = dust.direct;
    term dust.grain when rough {
        dust.emission = covered(below.emission, dust.cover);
        out emission = dust.emission;
    }
    EXTRA
}

/// The part that is hidden.
/// source: EXTENSION
node cover(TYPE amount in [0, 1], vec3 texel in [0, 1] = vec3(1)) -> vec3 in [0, 1] {
    return MOST * amount * texel;
}

/// Over what is below.
/// source: EXTENSION
node covered(vec3 below in [0, inf], vec3 cover in [0, 1]) -> vec3 in [0, inf] {
    return below * (vec3(1) - cover);
}
)";
  const auto put = [&](std::string_view word, std::string_view with) {
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
      text.replace(at, word.size(), with);
  };
  put("EXTENSION", extension);
  put("TYPE", type);
  put("HIDDEN", hidden);
  put("EXTRA", extra);
  return text;
}

std::string allOf(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + "\n";
  return text;
}

const std::string kBoth =
    R"({"asset": {"version": "2.0"}, "textures": [{}, {}], "materials": [{"emissiveFactor": [1, 1, 1], "extensions": {
  "ACME_dust": {"amount": 0.5, "roughnessFactor": 1, "amountTexture": {"index": 0}},
  "BOLT_dust": {"amount": [0.25, 0.5, 0.75], "roughnessFactor": 1, "amountTexture": {"index": 1}}}}]})";

struct WithVendors {
  Diagnostics wrong, warnings;
  graph::Graph graph;
};

WithVendors withVendors(std::vector<lang::SourceFile> files, const std::string& gltf) {
  WithVendors out;
  lang::Library library = lang::Library::embedded();
  if (const Result<void> added = library.add(std::move(files)); !added) {
    out.wrong = added.error();
    return out;
  }
  out.wrong = library.checkAll();
  const model::Models models(library);
  const Result<const model::Model*> model = models.of("khr");
  if (!model) out.wrong = model.error();
  if (!out.wrong.empty()) return out;
  const auto document = material::readText(gltf, "both.gltf", **models.schema(), {});
  if (!document) out.wrong = document.error();
  if (!out.wrong.empty()) return out;
  model::BuildOptions options;
  options.template_name = "forward";
  auto graph = model::build(**model, **library.template_("forward"), document->materials[0],
                            {true, false, false, {true, false, false, false}}, options, out.warnings);
  if (!graph) out.wrong = graph.error();
  if (graph) out.graph = std::move(*graph);
  return out;
}

std::string inputsOf(const graph::Graph& graph, std::string_view id) {
  for (const graph::Node& node : graph.nodes) {
    if (node.id != id) continue;
    std::string text = node.type + "(";
    for (const auto& [name, source] : node.inputs) {
      const auto* parameter = std::get_if<graph::ParameterRef>(&source.from);
      const auto* from = std::get_if<graph::NodeRef>(&source.from);
      text += fmt::format("{}: {} ", name, parameter ? "$" + parameter->name : from ? from->node : "?");
    }
    return text + ")";
  }
  return "none";
}

TEST(Vendors, EachMeansItsOwn) {
  const WithVendors built = withVendors(
      {{"acme.node", layer("ACME_dust", "float", "0.75")}, {"bolt.node", layer("BOLT_dust", "vec3", "0.25")}},
      kBoth);
  ASSERT_EQ(allOf(built.wrong), "");
  const graph::Graph& graph = built.graph;
  EXPECT_EQ(inputsOf(graph, "ACME_dust.dust.cover"),
            "ACME_dust.cover(amount: $acme_dust_amount texel: acme_dust_amount.texel )");
  EXPECT_EQ(inputsOf(graph, "BOLT_dust.dust.cover"),
            "BOLT_dust.cover(amount: $bolt_dust_amount texel: bolt_dust_amount.texel )");
  EXPECT_EQ(inputsOf(graph, "BOLT_dust.dust.direct"),
            "BOLT_dust.covered(below: ACME_dust.dust.direct cover: BOLT_dust.dust.cover )");
  EXPECT_EQ(inputsOf(graph, "BOLT_dust.dust.emission"),
            "BOLT_dust.covered(below: ACME_dust.dust.emission cover: BOLT_dust.dust.cover )");
  std::set<std::string> ids, parameters, textures;
  for (const graph::Node& node : graph.nodes) EXPECT_TRUE(ids.insert(node.id).second) << node.id;
  for (const graph::Parameter& one : graph.parameters) EXPECT_TRUE(parameters.insert(one.name).second);
  for (const graph::Texture& one : graph.textures) EXPECT_TRUE(textures.insert(one.name).second);
  EXPECT_TRUE(parameters.contains("roughness_factor")) << "glTF's own keeps its name";
  EXPECT_EQ(textures, (std::set<std::string>{"acme_dust_amount_texture", "bolt_dust_amount_texture"}));
}

TEST(Vendors, TheOrderOfTheFilesIsNothing) {
  const lang::SourceFile acme{"acme.node", layer("ACME_dust", "float", "0.75")};
  const lang::SourceFile bolt{"bolt.node", layer("BOLT_dust", "vec3", "0.25")};
  const WithVendors one = withVendors({acme, bolt}, kBoth), other = withVendors({bolt, acme}, kBoth);
  ASSERT_EQ(allOf(one.wrong) + allOf(other.wrong), "");
  EXPECT_EQ(graph::toDot(one.graph), graph::toDot(other.graph));
}

TEST(Vendors, OneAloneHasPlainNames) {
  const WithVendors built = withVendors({{"acme.node", layer("ACME_dust", "float", "0.75")}}, kBoth);
  ASSERT_EQ(allOf(built.wrong), "");
  EXPECT_EQ(inputsOf(built.graph, "dust.cover"), "cover(amount: $amount texel: amount.texel )");
}

TEST(Vendors, AnErrorIsInTheTextOfWhoMadeIt) {
  const lang::SourceFile acme{"acme.node", layer("ACME_dust", "float", "0.75")};
  const auto wrong = [&](std::string_view extra) {
    return withVendors({acme, {"bolt.node", layer("BOLT_dust", "vec3", "0.25", extra)}}, kBoth).wrong;
  };
  for (const char* line : {"dust.other = cover(amount.x, nothing);",  // a name that nobody has
                           "coat.view_cosine = cover(amount);",       // a line of the library's
                           "dust.other = covered(below.direct, amountTexture, 1);",
                           "dust.cover = cover(amount);"}) {  // its own line again
    const Diagnostics found = wrong(line);
    EXPECT_FALSE(found.empty()) << line;
    for (const Diagnostic& one : found) EXPECT_EQ(one.place.file, "bolt.node") << format(one);
  }
}

TEST(Vendors, OthersSayWhoseTheyMean) {
  const lang::SourceFile acme{"acme.node", layer("ACME_dust", "float", "0.75")};
  const lang::SourceFile bolt{"bolt.node", layer("BOLT_dust", "vec3", "0.25")};
  const auto profile = [&](const std::string& id) {
    return withVendors(
        {acme, bolt, {"mine.node", "/// A lod of two.\nlod plain {\n    " + id + " = none;\n}\n"}}, kBoth);
  };
  EXPECT_EQ(allOf(profile("ACME_dust.dust.cover").wrong), "");
  const auto named = lang::Library::fromFiles({acme, bolt});
  ASSERT_TRUE(named.has_value());
  EXPECT_FALSE(named->has(lang::DeclKind::Node, "cover"));
  EXPECT_TRUE(named->node("ACME_dust.cover").has_value());
  const auto unclear = named->node("cover");
  ASSERT_FALSE(unclear.has_value());
  EXPECT_EQ(unclear.error()[0].help, "several extensions have one: 'ACME_dust.cover' and 'BOLT_dust.cover'");
}

TEST(Vendors, APartLiesOverAnothersOfTheSameName) {
  const auto placed = [](std::string_view over) {
    std::string bolt = layer("BOLT_dust", "vec3", "0.25");
    constexpr std::string_view kOver = "over coat unless";
    bolt.replace(bolt.find(kOver), kOver.size(), fmt::format("over {} unless", over));
    return withVendors({{"acme.node", layer("ACME_dust", "float", "0.75")}, {"bolt.node", bolt}}, kBoth);
  };
  const auto codes = [](const Diagnostics& of) {
    std::string text;
    for (const Diagnostic& one : of) text += one.code + " ";
    return text;
  };
  EXPECT_EQ(codes(placed("coat").warnings), "unordered-parts ");
  EXPECT_EQ(codes(placed("coat, ACME_dust.dust").warnings), "");
  const WithVendors wrong = placed("coat, ACME_dust.rust");
  EXPECT_EQ(codes(wrong.wrong), "unknown-part ");
}

TEST(Vendors, AWrongFileLeavesTheNamesAsTheyWere) {
  lang::Library library = lang::Library::embedded();
  ASSERT_TRUE(library.add({{"acme.node", layer("ACME_dust", "float", "0.75")}}).has_value());
  EXPECT_FALSE(library.add({{"bolt.node", layer("BOLT_dust", "vec3", "0.25") + "const float MOST = 1;\n"}})
                   .has_value());
  EXPECT_TRUE(library.node("cover").has_value());
  EXPECT_FALSE(library.has(lang::DeclKind::Node, "ACME_dust.cover"));
  ASSERT_TRUE(library.add({{"bolt.node", layer("BOLT_dust", "vec3", "0.25")}}).has_value());
  EXPECT_TRUE(library.node("ACME_dust.cover").has_value());
  EXPECT_TRUE(library.node("BOLT_dust.cover").has_value());
}

}  // namespace
}  // namespace lacquer::test
