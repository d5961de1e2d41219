// What an engine takes from the manifest alone: which primitive has which shader, the names in the texts, the
// states around a shader, images and samplers; and which files a run leaves behind.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::contract_test {
namespace {

using nlohmann::json;

const char* const kFile = R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_variants", "KHR_mesh_quantization", "KHR_texture_transform",
                   "KHR_texture_basisu"],
"extensionsRequired": ["KHR_mesh_quantization"],
"extensions": {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}},
"accessors": [{"componentType": 5122, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
  {"componentType": 5126, "count": 3, "type": "VEC2"}, {"componentType": 5121, "count": 3, "type": "VEC4"}],
"images": [{"uri": "a.png"}, {"uri": "a.ktx2", "mimeType": "image/ktx2"}],
"samplers": [{"wrapS": 33071, "minFilter": 9985}],
"textures": [{"source": 0, "sampler": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}}],
"meshes": [{"primitives": [
  {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "JOINTS_0": 3}, "material": 0,
   "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}},
  {"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0},
  {"attributes": {"POSITION": 0, "NORMAL": 1}},
  {"attributes": {"POSITION": 0}, "material": 2}]}],
"materials": [
  {"name": "Leaf", "alphaMode": "MASK", "doubleSided": true, "pbrMetallicRoughness": {"baseColorTexture":
    {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.25, 0], "rotation": 1}}}}},
  {"name": "Ghost", "alphaMode": "BLEND"},
  {"name": "Wrong", "pbrMetallicRoughness": {"metallicFactor": 2}}]})";

class Contract : public testing::Test {
protected:
  void SetUp() override {
    place_.write("leaf.gltf", kFile);
    const Outcome outcome = place_.run({"gen", "leaf.gltf", "-o", "out"});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    manifest_ = place_.manifest("out");
  }
  const json& file() const { return manifest_["files"][0]; }
  const json& material(size_t i) const { return file()["materials"][i]; }
  const json& shader(size_t i) const {
    return manifest_["shaders"][material(i)["uses"][0]["shader"].get<std::string>()];
  }

  Workplace place_;
  json manifest_;
};

TEST_F(Contract, PrimitivesNameTheirUsesAndThoseOfVariants) {
  EXPECT_EQ(manifest_["schema"], 1);
  EXPECT_EQ(file()["variants"], (json{"day", "night"}));
  const json& primitives = file()["primitives"];
  ASSERT_EQ(primitives.size(), 4U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(primitives[i]["mesh"], 0);
    EXPECT_EQ(primitives[i]["primitive"], i);
    EXPECT_EQ(primitives[i]["material"], 0);
    const json& use = material(0)["uses"][primitives[i]["use"].get<size_t>()];
    const bool textured = i == 0;
    EXPECT_EQ(use["attributes"],
              textured ? (json{"NORMAL", "TEXCOORD_0", "QUANTIZED"}) : (json{"NORMAL", "QUANTIZED"}));
  }
  const json night = {{{"variants", {1}}, {"material", 1}, {"use", 0}}};
  EXPECT_EQ(primitives[0]["variants"], night);
  EXPECT_FALSE(primitives[1].contains("variants"));
  EXPECT_EQ(material(1)["uses"][0]["attributes"], (json{"NORMAL", "TEXCOORD_0", "QUANTIZED"}));
  EXPECT_EQ(primitives[2]["material"], -1);
  EXPECT_EQ(file()["default_material"]["uses"].size(), 1U);
  EXPECT_EQ(primitives[2]["use"], 0);
  EXPECT_FALSE(primitives[3].contains("use")) << "its material has an error";
}

TEST_F(Contract, PrimitivesSayHowAttributesAreStored) {
  const json& attributes = file()["primitives"][0]["attributes"];
  EXPECT_EQ(attributes["POSITION"], (json{{"type", "VEC3"}, {"component_type", "SHORT"}}));
  EXPECT_EQ(attributes["NORMAL"], (json{{"type", "VEC3"}, {"component_type", "BYTE"}, {"normalized", true}}));
  EXPECT_EQ(attributes["JOINTS_0"], (json{{"type", "VEC4"}, {"component_type", "UNSIGNED_BYTE"}}));
  ASSERT_EQ(file()["diagnostics"].size(), 1U) << file()["diagnostics"];
  EXPECT_EQ(file()["diagnostics"][0]["code"], "attribute-unread");
}

TEST_F(Contract, MaterialsSayWhatStandsAroundTheShader) {
  EXPECT_EQ(material(0)["alpha_mode"], "MASK");
  EXPECT_EQ(material(0)["alpha_cutoff"], 0.5);
  EXPECT_EQ(material(0)["double_sided"], true);
  EXPECT_FALSE(material(0).contains("blend"));
  EXPECT_EQ(material(1)["alpha_mode"], "BLEND");
  EXPECT_EQ(material(1)["blend"], (json{{"color", {"src-alpha", "one-minus-src-alpha"}},
                                        {"alpha", {"one", "one-minus-src-alpha"}}}));
  EXPECT_EQ(material(1)["double_sided"], false);
  EXPECT_FALSE(material(1).contains("alpha_cutoff"));
  EXPECT_EQ(file()["default_material"]["alpha_mode"], "OPAQUE");
  EXPECT_EQ(material(0)["pass"], "masked");
  EXPECT_EQ(material(1)["pass"], "blended");
  EXPECT_EQ(file()["default_material"]["pass"], "opaque");
  EXPECT_EQ(material(0)["depth_write"], true);
  EXPECT_EQ(material(1)["depth_write"], false);
}

TEST_F(Contract, TexturesHaveImagesAndSamplers) {
  const json texture = {
      {"images", {{{"image", 1}, {"extension", "KHR_texture_basisu"}}, {{"image", 0}}}},
      {"sampler", {{"wrap_s", "clamp"}, {"wrap_t", "repeat"}, {"min_filter", "linear-mipmap-nearest"}}}};
  EXPECT_EQ(file()["textures"], json::array({texture}));
  EXPECT_EQ(file()["images"], (json{{{"uri", "a.png"}}, {{"uri", "a.ktx2"}, {"mime_type", "image/ktx2"}}}));
  const json& use = material(0)["uses"][file()["primitives"][0]["use"].get<size_t>()];
  const json& slot = use["textures"]["base_color_texture"];
  EXPECT_EQ(slot["texcoord"], 0);
  EXPECT_EQ(slot["transform"], (json{{"offset", {0.25, 0.0}}, {"rotation", 1.0}, {"scale", {1.0, 1.0}}}));
}

TEST_F(Contract, UnfilledPortsAreNamed) {
  const json& leaf = material(0)["uses"][0]["unfilled_ports"];
  const json& ghost = material(1)["uses"][0]["unfilled_ports"];
  const auto lists = [](const json& ports, const char* port) {
    return std::find(ports.begin(), ports.end(), port) != ports.end();
  };
  EXPECT_FALSE(lists(leaf, "hidden")) << leaf;
  EXPECT_TRUE(lists(ghost, "hidden")) << ghost;
  EXPECT_TRUE(lists(leaf, "alpha")) << leaf;
  EXPECT_FALSE(lists(ghost, "alpha")) << ghost;
  EXPECT_FALSE(lists(leaf, "direct")) << leaf;
}

/// What `--live` brings back is what it is said to bring back.
TEST_F(Contract, AbsentParametersComeBackByTheirTerms) {
  const json& absent = material(1)["uses"][0]["absent_parameters"];
  EXPECT_EQ(absent["emissive_factor"], json::array({"emission"})) << absent;
  EXPECT_FALSE(absent.contains("roughness_factor")) << absent;
  size_t tried = 0;
  for (const auto& [name, terms] : absent.items()) {
    std::vector<std::string> words = {"gen",      "leaf.gltf", "-o",         "live",
                                      "--target", "glsl",      "--material", "Ghost"};
    for (const json& term : terms) words.insert(words.end(), {"--live", term.get<std::string>()});
    ASSERT_EQ(place_.run(words).status, 0);
    const json use = place_.manifest("live")["files"][0]["materials"][0]["uses"][0];
    EXPECT_TRUE(use["parameters"].contains(name)) << name << use["parameters"];
    ++tried;
  }
  EXPECT_GT(tried, 0U);
}

TEST_F(Contract, ParametersHaveRangesProseAndFields) {
  for (const json& parameter : shader(1)["parameters"]) {
    if (parameter["name"] != "roughness_factor") continue;
    EXPECT_EQ(parameter["range"], (json{0.0, 1.0}));
    EXPECT_EQ(parameter["default"], 1.0);
    EXPECT_EQ(parameter["meaning"], "perceptual: alpha is its square");
    std::set<std::string> fields(parameter["fields"].begin(), parameter["fields"].end());
    EXPECT_TRUE(fields.contains("alpha2")) << parameter;
    EXPECT_FALSE(fields.contains("metallic_factor")) << parameter;
    return;
  }
  FAIL() << "there is no roughness_factor";
}

/// The names are those in the texts.
TEST_F(Contract, BlocksAndSamplersAreCalledWhatTheTextsCallThem) {
  size_t lights = 0;
  for (const auto& [id, shader] : manifest_["shaders"].items()) {
    std::map<std::string, std::string> texts;
    for (const char* target : {"glsl", "glsl-gl", "essl", "hlsl"}) {
      for (const auto& [stage, path] : shader["files"][target].items())
        texts[target] += place_.read("out/" + path.get<std::string>());
    }
    for (const json& block : shader["uniforms"]) {
      const std::string name = block["block"];
      lights += name == "Lights" ? 1 : 0;
      EXPECT_EQ(block.value("struct", ""), name == "Lights" ? "Light" : "");
      for (const char* target : {"glsl", "glsl-gl", "essl"})
        EXPECT_NE(texts[target].find(fmt::format(" uniform {} {{", name)), std::string::npos)
            << target << name;
      EXPECT_NE(texts["hlsl"].find(fmt::format("cbuffer {} :", name)), std::string::npos) << name;
    }
    for (const json& texture : shader["textures"]) {
      const std::string name = texture["name"];
      for (const char* target : {"glsl", "glsl-gl", "essl"})
        EXPECT_NE(texts[target].find(fmt::format(" {};", name)), std::string::npos) << target << name;
      EXPECT_NE(texts["hlsl"].find(fmt::format(" {} : LACQUER_AT(t", name)), std::string::npos) << name;
      EXPECT_NE(texts["hlsl"].find(fmt::format(" {} : LACQUER_AT(s", texture["sampler"].get<std::string>())),
                std::string::npos)
          << name;
    }
  }
  EXPECT_GT(lights, 0U);
}

/// A document's looks, by the number of each material; a shard's are those of the whole.
TEST(Looks, SayWhichMaterialIsForWhichGeometry) {
  const Workplace place;
  place.write("chair.mtlx", R"(<materialx version="1.39" geomprefix="/chair/">
  <standard_surface name="s" type="surfaceshader">
    <input name="specular_roughness" type="float" value="0.5"/>
  </standard_surface>
  <surfacematerial name="paint" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="s"/>
  </surfacematerial>
  <collection name="legs" includegeom="leg*" excludegeom="leg3"/>
  <variantset name="wetness">
    <variant name="wet"><input name="specular_roughness" type="float" value="0.125"/></variant>
  </variantset>
  <geominfo name="g" geom="seat"><token name="part" type="string" value="L"/></geominfo>
  <look name="dry">
    <materialassign name="m" material="paint" collection="legs"/>
    <propertyassign name="p" property="twosided" type="boolean" value="true" geom="seat"/>
    <visibility name="v" vistype="shadow" geom="seat" visible="false"/>
  </look>
  <look name="rain" inherit="dry">
    <variantassign name="v" variantset="wetness" variant="wet"/>
  </look>
  <lookgroup name="all" looks="dry, rain" default="dry"/>
</materialx>
)");
  ASSERT_EQ(place.run({"gen", "chair.mtlx", "-o", "out", "--target", "glsl"}).status, 0);
  const json manifest = place.manifest("out");
  const json& file = manifest["files"][0];
  const json legs = {{"name", "m"}, {"material", 0}, {"collection", "legs"}, {"exclusive", true}};
  EXPECT_EQ(file["looks"][0]["materials"], json::array({legs}));
  EXPECT_EQ(file["looks"][0]["properties"][0]["geometry"], json::array({"/chair/seat"}));
  EXPECT_EQ(file["looks"][1]["materials"][0]["material"], 1);
  EXPECT_EQ(file["materials"][1]["name"], "paint/wetness/wet");
  EXPECT_EQ(file["material_variants"][0], (json{{"material", 1}, {"of", 0}, {"variants", {"wetness/wet"}}}));
  EXPECT_EQ(file["look_groups"][0]["default"], "dry");
  EXPECT_EQ(file["collections"][0]["exclude"], json::array({"/chair/leg3"}));
  EXPECT_EQ(file["geometry"][0]["tokens"][0]["value"], "L");
  // Other numbers alone are no other shader.
  EXPECT_EQ(manifest["shaders"].size(), 1U);
  ASSERT_EQ(place.run({"merge", "out/manifest.json", "-o", "merged"}).status, 0);
  json merged = place.manifest("merged")["files"][0];
  merged["source"] = file["source"];
  EXPECT_EQ(merged, file);
  ASSERT_EQ(place.run({"pack", "out", "-o", "out.lqpm", "--target", "glsl"}).status, 0);
  EXPECT_EQ(place.read("out.lqpm").substr(0, 4), "LQPM");
  EXPECT_NE(place.run({"pack", "out", "-o", "none.lqpm", "--target", "hlsl"}).err.find("no-such-target"),
            std::string::npos);
  // What is left out keeps its number.
  ASSERT_EQ(
      place.run({"gen", "chair.mtlx", "-o", "one", "--target", "glsl", "--material", "paint/wetness/wet"})
          .status,
      0);
  EXPECT_EQ(place.manifest("one")["files"][0]["looks"], file["looks"]);
}

/// A document's displacement moves the vertices of a template that takes it; others say that they do not.
TEST(Displacement, GoesToATemplateThatTakesIt) {
  const Workplace place;
  place.write("nodes/displaced.node", R"(/// Forward shading of what is moved.
template displaced extends forward {
    port vec3 displacement = vec3(0);
    output displacement vec3 object_position = object_position + displacement;
}
)");
  place.write("waves.mtlx", R"(<materialx version="1.39">
  <fractal2d name="n" type="float"/>
  <displacement name="d" type="displacementshader">
    <input name="displacement" type="float" nodename="n"/>
    <input name="scale" type="float" value="0.25"/>
  </displacement>
  <gltf_pbr name="s" type="surfaceshader"/>
  <surfacematerial name="waves" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="s"/>
    <input name="displacementshader" type="displacementshader" nodename="d"/>
  </surfacematerial>
</materialx>
)");
  const Outcome moved = place.run(
      {"gen", "waves.mtlx", "-o", "out", "--nodes", "nodes", "--template", "displaced", "--target", "glsl"});
  ASSERT_EQ(moved.status, 0) << moved.all();
  EXPECT_EQ(moved.all().find("displacement-left-out"), std::string::npos) << moved.all();
  const json manifest = place.manifest("out");
  const json& use = manifest["files"][0]["materials"][0]["uses"][0];
  EXPECT_EQ(manifest["shaders"][use["shader"].get<std::string>()]["displaces"],
            json::array({"object_position"}));
  EXPECT_EQ(use["parameters"]["d_scale"]["value"], 0.25) << use["parameters"];
  const Outcome still = place.run({"gen", "waves.mtlx", "-o", "still", "--target", "glsl"});
  EXPECT_EQ(still.status, 0) << still.all();
  EXPECT_NE(still.all().find("displacement-left-out"), std::string::npos) << still.all();
}

TEST(Stale, ShadersThatOnlyTheEarlierManifestListsGo) {
  const Workplace place;
  const std::string both = gltfOf({R"({"name": "a"})", R"({"name": "b", "alphaMode": "MASK"})"});
  place.write("m.gltf", both);
  ASSERT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl,hlsl"}).status, 0);
  const std::set<std::string> first = place.names();
  place.write("out/glsl/forward-base-0123456789abcdef.frag.glsl", "not ours: no manifest lists it");
  place.write("out/notes.txt", "nor is this");
  place.write("m.gltf", gltfOf({R"({"name": "a"})"}));
  ASSERT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
  const json shaders = place.manifest("out")["shaders"];
  ASSERT_EQ(shaders.size(), 1U);
  const std::string kept = shaders.begin().key();
  EXPECT_TRUE(place.has("out/glsl/" + kept + ".frag.glsl"));
  EXPECT_TRUE(place.has("out/glsl/forward-base-0123456789abcdef.frag.glsl"));
  EXPECT_TRUE(place.has("out/notes.txt"));
  EXPECT_FALSE(place.has("out/hlsl")) << "it is empty";
  size_t gone = 0;
  for (const std::string& name : first) {
    const bool shader = name.ends_with(".glsl") || name.ends_with(".hlsl");
    if (!shader || name.find("/glsl/" + kept) != std::string::npos) continue;
    EXPECT_FALSE(place.has(name)) << name;
    ++gone;
  }
  EXPECT_EQ(gone, 6U);
}

/// A manifest that lists what no run makes has no say in what goes.
TEST(Stale, AManifestCannotNameOtherFiles) {
  const Workplace place;
  place.write("m.gltf", gltfOf({R"({"name": "a"})"}));
  place.write("out/precious.glsl", "mine");
  place.write("precious.frag.glsl", "mine");
  place.write("out/manifest.json", R"({"lacquer": "0.2.0", "files": [], "shaders": {
      "../../precious": {"files": {"glsl": {"frag": "../precious.frag.glsl"}}},
      "forward-base-0123456789abcdef": {"files": {"glsl": {"frag": "precious.glsl"}}}}})");
  ASSERT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
  EXPECT_TRUE(place.has("out/precious.glsl"));
  EXPECT_TRUE(place.has("precious.frag.glsl"));
  place.write("out/manifest.json", "[");
  EXPECT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
}

/// Nor has what lies where a killed run notes its shaders.
TEST(Stale, ANoteCannotNameOtherFiles) {
  const Workplace place;
  place.write("m.gltf", gltfOf({R"({"name": "a"})"}));
  const std::string left = "glsl/forward-base-0123456789abcdef0123456789abcdef.frag.glsl";
  for (const std::string& name :
       std::vector<std::string>{"out/precious.glsl", "precious.frag.glsl", "out/" + left})
    place.write(name, "mine");
  place.write("out/.lacquer-tmp/lacquer-0123456789abcdef-0.tmp",
              "lacquer: what a run may leave behind\nprecious.glsl\n../precious.frag.glsl\n" + left + "\n");
  ASSERT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
  EXPECT_TRUE(place.has("out/precious.glsl"));
  EXPECT_TRUE(place.has("precious.frag.glsl"));
  EXPECT_FALSE(place.has("out/" + left));
  EXPECT_FALSE(place.has("out/.lacquer-tmp"));
}

/// What a failed material has left behind goes as well, and a second run of the same finds nothing to do.
TEST(Stale, NothingThatIsNeededGoes) {
  const Workplace place;
  place.write("m.gltf", gltfOf({R"({"name": "a"})"}));
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(place.run({"gen", "m.gltf", "-o", "out", "--target", "glsl,spirv,cpp,js"}).status, 0);
    for (const auto& [id, shader] : place.manifest("out")["shaders"].items()) {
      for (const auto& [target, stages] : shader["files"].items()) {
        for (const auto& [stage, path] : stages.items())
          EXPECT_TRUE(place.has("out/" + path.get<std::string>())) << path;
      }
    }
  }
}

/// The same files into the same folder, named from three places: the same bytes.
TEST(Sources, AreRelativeToTheManifest) {
  const Workplace place;
  place.write("assets/m.gltf", gltfOf({R"({"name": "a"})"}));
  place.write("below/file", "");
  std::filesystem::create_directory_symlink("assets", place / "link");
  ASSERT_EQ(place.run({"gen", "assets/m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
  EXPECT_EQ(place.manifest("out")["files"][0]["source"], "../assets/m.gltf");
  const std::string expected = place.read("out/manifest.json");
  const std::string whole = (place / "assets/m.gltf").string();
  const std::vector<std::pair<std::string, std::vector<std::string>>> calls = {
      {".", {whole, "-o", (place / "out").string()}},
      {"below", {"../assets/m.gltf", "-o", "../out/"}},
      {"assets", {"./m.gltf", "-o", "../below/../out"}}};
  for (const auto& [folder, words] : calls) {
    std::string command =
        fmt::format("cd '{}' && '{}' gen -q --target glsl", (place / folder).string(), LACQUER_PROGRAM);
    for (const std::string& word : words) command += " '" + word + "'";
    std::filesystem::remove_all(place / "out");
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_EQ(place.read("out/manifest.json"), expected) << command;
  }
  // Through a link the name stays; out of one `..` leads where the link does.
  ASSERT_EQ(place.run({"gen", "link/m.gltf", "-o", "out", "--target", "glsl"}).status, 0);
  EXPECT_EQ(place.manifest("out")["files"][0]["source"], "../link/m.gltf");
  ASSERT_EQ(place.run({"gen", "assets/m.gltf", "-o", "link", "--target", "glsl"}).status, 0);
  EXPECT_EQ(place.manifest("assets")["files"][0]["source"], "m.gltf");
  // Merged into another folder they lead to the same file.
  ASSERT_EQ(place.run({"merge", "out/manifest.json", "-o", "below/deep"}).status, 0);
  EXPECT_EQ(place.manifest("below/deep")["files"][0]["source"], "../../link/m.gltf");
}

TEST(Schema, EveryManifestIsValid) {
  const Workplace place;
  place.write("leaf.gltf", kFile);
  const std::vector<std::vector<std::string>> runs = {
      {"leaf.gltf"},
      {"leaf.gltf", "--params", "baked"},
      {"leaf.gltf", "--params", "spec"},
      {"leaf.gltf", "--template", "surface"},
      {"leaf.gltf", "--template", "bsdf", "--no-validate"},
      {"leaf.gltf", "--simplify", "without:coat"},
      {"leaf.gltf", "--target", "cpp,js"},
      {"leaf.gltf", "--unused", "--lights", "directional:1"},
      {"absent.gltf"},
      {example("car_paint.gltf"), example("coat.gltf"), example("core.gltf"), "--target", "spirv"},
      {example("clearcoat.gltf"), "--nodes", example("engine"), "--template", "engine", "--target", "spirv"},
      {example("cloth.gltf"), example("film.gltf"), example("glass.gltf"), example("wax.gltf"), "--target",
       "essl,wgsl,msl", "--no-validate"},
  };
  std::vector<std::filesystem::path> manifests;
  for (size_t i = 0; i < runs.size(); ++i) {
    std::vector<std::string> words = {"gen", "-o", fmt::format("out{}", i)};
    words.insert(words.end(), runs[i].begin(), runs[i].end());
    place.run(words);
    manifests.push_back(place / fmt::format("out{}/manifest.json", i));
  }
  const std::optional<std::string> errors = schemaErrors(manifests);
  if (!errors) GTEST_SKIP() << "NOT TESTED: python3-jsonschema is not installed";
  EXPECT_EQ(*errors, "");
  place.write("wrong.json", R"({"lacquer": "0.2.0", "schema": 2, "files": [{}], "shaders": {}, "x": 1})");
  const std::string wrong = *schemaErrors({place / "wrong.json"});
  for (const char* part : {"'x'", "'source' is a required property", "1 was expected"})
    EXPECT_NE(wrong.find(part), std::string::npos) << part << "\n" << wrong;
}

}  // namespace
}  // namespace lacquer::test::contract_test
