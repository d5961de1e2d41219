// Surfaces of closures against MaterialX's own shaders, from the document to the colour: random closures and
// combinators, under one light and under an environment that is the same from all sides.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <regex>

#include "check/check.h"
#include "lacquer/contract.h"
#include "lacquer/generate.h"
#include "lacquer/tools.h"
#include "materialx/surface.h"
#include "patterns/peer.h"
#include "support/cases.h"
#include "vulkan/run.h"

namespace lacquer::test::closures_peer_test {
namespace {

constexpr size_t kPoints = 300;
constexpr int kEach = 3;  // surfaces of each kind

const vulkan::Device* device() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

class Random {
public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double in(double lo, double hi) { return lo + (hi - lo) * unit(); }
  std::array<double, 3> direction() {
    const double z = 2 * unit() - 1, phi = 2 * M_PI * unit(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  std::string number(const char* name, double lo, double hi) {
    return fmt::format("<input name=\"{}\" type=\"float\" value=\"{:.5f}\"/>", name, in(lo, hi));
  }
  std::string color(const char* name, double lo = 0, double hi = 1, const char* type = "color3") {
    return fmt::format("<input name=\"{}\" type=\"{}\" value=\"{:.5f}, {:.5f}, {:.5f}\"/>", name, type,
                       in(lo, hi), in(lo, hi), in(lo, hi));
  }
  std::string alphas() {
    return fmt::format("<input name=\"roughness\" type=\"vector2\" value=\"{:.5f}, {:.5f}\"/>", in(0.02, 1),
                       in(0.02, 1));
  }
  static std::string text(const char* name, const char* value) {
    return fmt::format("<input name=\"{}\" type=\"string\" value=\"{}\"/>", name, value);
  }
  static std::string flag(const char* name, bool value) {
    return fmt::format("<input name=\"{}\" type=\"boolean\" value=\"{}\"/>", name, value);
  }
  std::string film() { return number("thinfilm_thickness", 50, 900) + number("thinfilm_ior", 1.1, 2); }

private:
  std::mt19937_64 engine_;
};

/// A BSDF node of random numbers.
std::string bsdf(Random& r, const std::string& kind, const std::string& name) {
  std::string inputs = r.number("weight", 0.2, 1);
  std::string category = kind;
  if (kind == "oren_nayar" || kind == "oren_nayar_compensated") {
    category = "oren_nayar_diffuse_bsdf";
    inputs += r.color("color") + r.number("roughness", 0, 1) +
              Random::flag("energy_compensation", kind == "oren_nayar_compensated");
  } else if (kind == "burley") {
    category = "burley_diffuse_bsdf";
    inputs += r.color("color") + r.number("roughness", 0, 1);
  } else if (kind == "translucent") {
    category = "translucent_bsdf";
    inputs += r.color("color");
  } else if (kind == "conty_kulla" || kind == "zeltner") {
    category = "sheen_bsdf";
    // Below 0.133 the fit of Zeltner's albedo may be negative, which ours is not.
    inputs += r.color("color") + r.number("roughness", 0.14, 1) + Random::text("mode", kind.c_str());
  } else if (kind.starts_with("dielectric")) {
    category = "dielectric_bsdf";
    inputs += r.color("tint") + r.number("ior", 1.05, 2.5) + r.alphas();
    if (kind.ends_with("_T")) inputs += Random::text("scatter_mode", "T");
    if (kind.ends_with("_RT")) inputs += Random::text("scatter_mode", "RT");
    if (kind.ends_with("_film")) inputs += r.film();
    if (kind.ends_with("_retro")) inputs += Random::flag("retroreflective", true);
  } else if (kind.starts_with("conductor")) {
    category = "conductor_bsdf";
    inputs += r.color("ior", 0.2, 3) + r.color("extinction", 0.2, 5) + r.alphas();
    if (kind.ends_with("_film")) inputs += r.film();
  } else if (kind.starts_with("schlick")) {
    category = "generalized_schlick_bsdf";
    inputs += r.color("color0") + r.color("color82", 0.5, 1) + r.color("color90", 0.5, 1) +
              r.number("exponent", 2, 6) + r.alphas();
    if (kind.ends_with("_RT")) inputs += Random::text("scatter_mode", "RT");
    if (kind.ends_with("_film")) inputs += r.film();
  }
  return fmt::format("<{0} name=\"{1}\" type=\"BSDF\">{2}</{0}>\n", category, name, inputs);
}

std::string combined(const std::string& category, const std::string& name, const std::string& inputs) {
  return fmt::format("<{0} name=\"{1}\" type=\"BSDF\">{2}</{0}>\n", category, name, inputs);
}

std::string link(const char* input, const std::string& node) {
  return fmt::format("<input name=\"{}\" type=\"BSDF\" nodename=\"{}\"/>", input, node);
}

/// The nodes of a surface of one kind, of which the last is called `name`.
std::string nodesOf(Random& r, const std::string& kind, const std::string& name) {
  const std::string a = name + "_a", b = name + "_b", c = name + "_c", d = name + "_d";
  if (kind == "layer")
    return bsdf(r, "dielectric", a) + bsdf(r, "oren_nayar", b) +
           combined("layer", name, link("top", a) + link("base", b));
  if (kind == "mix")
    return bsdf(r, "conductor", a) + bsdf(r, "burley", b) +
           combined("mix", name, link("fg", a) + link("bg", b) + r.number("mix", 0, 1));
  if (kind == "add")
    return bsdf(r, "zeltner", a) + bsdf(r, "translucent", b) +
           combined("add", name, link("in1", a) + link("in2", b));
  if (kind == "multiply")
    return bsdf(r, "schlick", a) + combined("multiply", name, link("in1", a) + r.color("in2"));
  if (kind == "stack") {
    return bsdf(r, "dielectric", a) + bsdf(r, "oren_nayar_compensated", b) + bsdf(r, "conductor", c) +
           bsdf(r, "conty_kulla", d) + combined("layer", name + "_e", link("top", a) + link("base", b)) +
           combined("mix", name + "_f", link("fg", c) + link("bg", name + "_e") + r.number("mix", 0, 1)) +
           combined("multiply", name + "_g", link("in1", name + "_f") + r.number("in2", 0.5, 1)) +
           combined("layer", name, link("top", d) + link("base", name + "_g"));
  }
  return bsdf(r, kind, name);
}

struct At {
  std::array<double, 3> n, t, v, l;
};

std::vector<At> somePoints(Random& r) {
  std::vector<At> points(kPoints);
  for (At& at : points) {
    const auto dot = [&](const std::array<double, 3>& a) {
      return a[0] * at.n[0] + a[1] * at.n[1] + a[2] * at.n[2];
    };
    const auto onto = [&](std::array<double, 3>& a) {
      if (dot(a) < 0) a = {-a[0], -a[1], -a[2]};
    };
    at.n = r.direction();
    at.v = r.direction();
    at.l = r.direction();
    if (r.unit() < 0.9) onto(at.v);
    if (r.unit() < 0.8) onto(at.l);
    // The vertices' tangents lie in the surface.
    at.t = r.direction();
    const double d = dot(at.t);
    for (size_t i = 0; i < 3; ++i) at.t[i] -= d * at.n[i];
    const double length = std::sqrt(at.t[0] * at.t[0] + at.t[1] * at.t[1] + at.t[2] * at.t[2]);
    for (double& x : at.t) x /= length;
  }
  return points;
}

std::string pointsText(const std::vector<At>& points, bool lit) {
  std::string text = "[";
  for (const At& at : points) {
    const auto vec = [](const std::array<double, 3>& a) {
      return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", a[0], a[1], a[2]);
    };
    text += fmt::format("{}{{\"n\": {}, \"t\": [{:.9g}, {:.9g}, {:.9g}, 1], \"v\": {}, \"l\": {}{}}}",
                        text.size() == 1 ? "" : ",\n", vec(at.n), at.t[0], at.t[1], at.t[2], vec(at.v),
                        vec(at.l), lit ? "" : ", \"light\": [0, 0, 0], \"env\": [1, 1, 1]");
  }
  return text + "]";
}

std::vector<float> peerColors(const std::string& glsl, const std::vector<At>& points, bool lit) {
  const PeerShader peer = peerLit(glsl, lit ? 1 : 0, lit ? 0 : 1);
  vulkan::Work work;
  auto words = check::compile(peer.glsl, Target::Glsl, check::Stage::Fragment, "peer.frag");
  if (!words) throw std::runtime_error(format(words.error().at(0)));
  work.fragment = std::move(*words);
  work.points = points.size();
  // Its maps are bound, and not looked into.
  const std::regex map(R"(layout \(binding=(\d+)\) uniform sampler2D)");
  for (std::sregex_iterator it(glsl.begin(), glsl.end(), map), end; it != end; ++it) {
    vulkan::Texture texture;
    texture.image = texture.sampler = {0, static_cast<uint32_t>(std::stoul((*it)[1].str()))};
    texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, vulkan::Texel{1, 1, 1, 1});
    work.textures.push_back(std::move(texture));
  }
  for (const std::string& name : peer.inputs) {
    vulkan::Varying input{3, {}};
    for (const At& at : points) {
      const std::array<double, 3> zero{};
      const std::array<double, 3>& from = name == "normalWorld"    ? at.n
                                          : name == "tangentWorld" ? at.t
                                          : name == "view"         ? at.v
                                          : name == "light"        ? at.l
                                                                   : zero;
      for (const double x : from) input.values.push_back(static_cast<float>(x));
    }
    work.inputs.push_back(std::move(input));
  }
  const auto outcome = device()->run(work);
  if (!outcome) throw std::runtime_error(format(outcome.error().at(0)));
  return outcome->outputs.at(0);
}

void compare(const std::string& kind, uint64_t seed) {
  if (!peerFolder()) GTEST_SKIP() << "NOT TESTED: there is no MaterialX (LACQUER_MATERIALX), or no node.js";
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  Random r(seed);
  std::string document = "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n";
  for (int i = 0; i < kEach; ++i) {
    const std::string name = fmt::format("b{}", i);
    document +=
        nodesOf(r, kind, name) +
        fmt::format("<surface name=\"s{}\" type=\"surfaceshader\">{}</surface>\n", i, link("bsdf", name));
  }
  document += "</materialx>\n";
  const auto shaders = peerSurfaces(document);
  Messages messages;
  const Scene scene = Scene::fromMemory(document, "peer.mtlx", {}, messages);
  ASSERT_TRUE(scene) << document;
  ASSERT_EQ(shaders.size(), scene.materialCount());
  std::vector<double> off;
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    const std::vector<At> points = somePoints(r);
    for (const bool lit : {true, false}) {
      const std::vector<float> theirs = peerColors(shaders.at(fmt::format("s{}", i)), points, lit);
      const auto ours = evaluate(scene, i, pointsText(points, lit), Engine::Float, {}, {}, messages);
      ASSERT_TRUE(ours) << (messages.empty() ? "" : messages.back().text) << document;
      for (size_t p = 0; p < points.size(); ++p) {
        for (size_t c = 0; c < 3; ++c) {
          const double want = static_cast<double>(theirs[p * 4 + c]);
          if (!std::isfinite(want)) continue;
          off.push_back(std::abs(ours->rgba[p][c] - want) / std::max(std::abs(want), 1e-3));
        }
      }
    }
  }
  std::sort(off.begin(), off.end());
  const double median = off[off.size() / 2], most = off[off.size() * 97 / 100];
  std::cout << fmt::format("{}: median {:.2g}, 97 % within {:.2g}, all within {:.2g}, of {}\n", kind, median,
                           most, off.back(), off.size());
  EXPECT_LT(median, 1e-5) << document;
  EXPECT_LT(most, 1e-3) << document;
}

class ClosuresPeer : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, ClosuresPeer,
                         testing::Values("oren_nayar", "oren_nayar_compensated", "burley", "translucent",
                                         "conty_kulla", "zeltner", "dielectric", "dielectric_T",
                                         "dielectric_RT", "dielectric_film", "dielectric_retro", "conductor",
                                         "conductor_film", "schlick", "schlick_RT", "schlick_film", "layer",
                                         "mix", "add", "multiply", "stack"),
                         [](const auto& info) { return std::string(info.param); });

/// An input of a model, as its definition in nodes/materialx/ has it.
struct Port {
  std::string name, type, value;
};

std::vector<Port> portsOf(const std::string& model) {
  const std::string text = readFile(sourceFolder() / "nodes/materialx" / (model + ".mtlx"));
  const std::string head = text.substr(0, text.find("</nodedef>"));
  const std::regex port(R"re(<input name="(\w+)" type="(\w+)" value="([^"]*)")re");
  std::vector<Port> ports;
  for (std::sregex_iterator it(head.begin(), head.end(), port), end; it != end; ++it) {
    // MaterialX's own surface is OpenPBR 1.1.
    const std::string name = (*it)[1];
    if (name.starts_with("specular_haze") || name == "specular_retroreflectivity") continue;
    ports.push_back({name, (*it)[2], (*it)[3]});
  }
  return ports;
}

/// Random numbers of some inputs; the others are at their defaults. What scatters below the surface differs:
/// here its sphere comes from derivatives.
std::string randomInputs(Random& r, const std::string& model) {
  std::string in;
  for (const auto& [name, type, value] : portsOf(model)) {
    const bool coverage = name == "opacity" || name == "opacityThreshold" || name == "geometry_opacity" ||
                          name == "alpha" || type == "integer" || type == "boolean";
    if (coverage || name.starts_with("subsurface") || name.find("ormal") != std::string::npos) continue;
    if (r.unit() < 0.45) continue;
    double lo = 0.05, hi = 1;
    if (name.ends_with("ior") || name.ends_with("IOR")) lo = 1.1, hi = 2;
    if (name.find("thickness") != std::string::npos)
      lo = model == "open_pbr_surface" ? 0.1 : 100, hi = model == "open_pbr_surface" ? 0.9 : 900;
    // The fit of Zeltner's albedo may be negative below, which ours is not.
    if (name == "fuzz_roughness" || name == "sheen_roughness") lo = 0.4;
    in += type == "color3" ? r.color(name.c_str(), lo, hi) : r.number(name.c_str(), lo, hi);
  }
  if (model == "gltf_pbr" && r.unit() < 0.5)
    in += "<input name=\"alpha_mode\" type=\"integer\" value=\"2\"/>";
  if (model == "UsdPreviewSurface" && r.unit() < 0.5)
    in += "<input name=\"useSpecularWorkflow\" type=\"integer\" value=\"1\"/>";
  return in;
}

/// The same surface with each number in a node of its own: MaterialX leaves out nothing then.
std::string asNodes(const std::string& model, const std::string& in, size_t number) {
  std::string constants, inputs;
  for (const auto& [name, type, by_default] : portsOf(model)) {
    const std::regex given("name=\"" + name + "\" type=\"\\w+\" value=\"([^\"]*)\"");
    std::smatch found;
    const std::string value = std::regex_search(in, found, given) ? found[1].str() : by_default;
    constants += fmt::format(
        "<constant name=\"c{0}_{1}\" type=\"{2}\"><input name=\"value\" type=\"{2}\" "
        "value=\"{3}\"/></constant>\n",
        number, name, type, value);
    inputs += fmt::format("<input name=\"{1}\" type=\"{2}\" nodename=\"c{0}_{1}\"/>", number, name, type);
  }
  return constants +
         fmt::format("<{0} name=\"s{1}\" type=\"surfaceshader\">{2}</{0}>\n", model, number, inputs);
}

class ModelsPeer : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Models, ModelsPeer,
                         testing::Values("standard_surface", "open_pbr_surface", "gltf_pbr",
                                         "UsdPreviewSurface", "disney_principled"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(ModelsPeer, drawsAlike) {
  if (!peerFolder()) GTEST_SKIP() << "NOT TESTED: there is no MaterialX (LACQUER_MATERIALX), or no node.js";
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const std::string model = GetParam();
  constexpr size_t kSurfaces = 3;
  Random r(77);
  const std::string head = "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n";
  std::string own = head, theirs_text = head;
  for (size_t i = 0; i < kSurfaces; ++i) {
    const std::string in = randomInputs(r, model);
    theirs_text += asNodes(model, in, i);
    own += fmt::format("<{0} name=\"s{1}\" type=\"surfaceshader\">{2}</{0}>\n", model, i, in);
  }
  const auto shaders = peerSurfaces(theirs_text + "</materialx>\n");
  Messages messages;
  Options options;
  options.profile = "materialx";
  const Scene scene = Scene::fromMemory(own + "</materialx>\n", "peer.mtlx", options, messages);
  ASSERT_TRUE(scene) << (messages.empty() ? "" : messages[0].text);
  ASSERT_EQ(scene.materialCount(), kSurfaces);
  std::vector<double> off;
  for (size_t i = 0; i < kSurfaces; ++i) {
    const std::vector<At> points = somePoints(r);
    for (const bool lit : {true, false}) {
      const std::vector<float> theirs = peerColors(shaders.at(fmt::format("s{}", i)), points, lit);
      const auto ours = evaluate(scene, i, pointsText(points, lit), Engine::Float, {}, options, messages);
      ASSERT_TRUE(ours) << (messages.empty() ? "" : messages.back().text);
      for (size_t p = 0; p < points.size() * 3; ++p) {
        const double want = static_cast<double>(theirs[p / 3 * 4 + p % 3]);
        if (!std::isfinite(want)) continue;
        off.push_back(std::abs(ours->rgba[p / 3][p % 3] - want) / std::max(std::abs(want), 1e-3));
      }
    }
  }
  std::sort(off.begin(), off.end());
  const double median = off[off.size() / 2], most = off[off.size() * 97 / 100];
  std::cout << fmt::format("{}: median {:.2g}, 97 % within {:.2g}, all within {:.2g}, of {}\n", model, median,
                           most, off.back(), off.size());
  EXPECT_LE(median, 1e-5);
  EXPECT_LE(most, 1e-3);
}

/// Random surfaces of closures and of models, drawn by a Vulkan device, against the evaluator in double.
TEST(ClosuresOnADevice, areThoseInDouble) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  Random r(2027);
  std::string document = "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n";
  const std::vector<std::string> kinds = {"stack", "dielectric_RT", "conductor_film", "schlick", "zeltner"};
  for (size_t i = 0; i < kinds.size(); ++i) {
    const std::string name = fmt::format("b{}", i);
    document +=
        nodesOf(r, kinds[i], name) +
        fmt::format("<surface name=\"s{}\" type=\"surfaceshader\">{}</surface>\n", i, link("bsdf", name));
  }
  for (const char* model : {"standard_surface", "open_pbr_surface", "gltf_pbr"})
    document +=
        fmt::format("<{0} name=\"of_{0}\" type=\"surfaceshader\">{1}</{0}>\n", model, randomInputs(r, model));
  document += "</materialx>\n";
  Messages messages;
  Options options;
  options.profile = "materialx";
  const Scene scene = Scene::fromMemory(document, "random.mtlx", options, messages);
  ASSERT_EQ(scene.materialCount(), kinds.size() + 3) << (messages.empty() ? "" : messages[0].text);
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    const std::vector<At> points = somePoints(r);
    std::vector<double> off;
    for (const bool lit : {true, false}) {
      const std::string text = pointsText(points, lit);
      const auto exact = evaluate(scene, i, text, Engine::Double, {}, options, messages);
      const auto drawn = evaluate(scene, i, text, Engine::Vulkan, {}, options, messages);
      ASSERT_TRUE(exact && drawn) << (messages.empty() ? "" : messages.back().text) << document;
      for (size_t p = 0; p < points.size() * 3; ++p) {
        const double want = exact->rgba[p / 3][p % 3], is = drawn->rgba[p / 3][p % 3];
        ASSERT_TRUE(std::isfinite(is)) << scene.materialName(i) << " at " << p / 3;
        off.push_back(std::abs(is - want) / std::max(std::abs(want), 1e-3));
      }
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 1e-5) << scene.materialName(i) << document;
    EXPECT_LT(off[off.size() * 97 / 100], 1e-4) << scene.materialName(i) << document;
    EXPECT_LT(off.back(), 1e-3) << scene.materialName(i) << document;
  }
}

/// What a model's inputs come to, without MaterialX: how it is blended, what is a parameter, what is said.
TEST(Models, haveTheAlphaModesAndParametersOfTheirInputs) {
  const std::string text = R"(<materialx version="1.39">
  <gltf_pbr name="with_a_long_name_masked" type="surfaceshader">
    <input name="alpha" type="float" value="0.25"/>
    <input name="alpha_mode" type="integer" value="1"/>
    <input name="metallic" type="float" value="0"/>
    <input name="roughness" type="float" value="1.5"/>
    <input name="metalic" type="float" value="1"/>
  </gltf_pbr>
  <standard_surface name="with_a_long_name_solid" type="surfaceshader">
    <input name="coat" type="float" value="0"/>
    <input name="sheen" type="float" value="0.5"/>
    <input name="opacity" type="color3" value="1, 1, 1"/>
    <input name="base_color" type="color3" value="0.5, 0.5, 0.5"/>
  </standard_surface>
  <open_pbr_surface name="with_a_long_name_blended" type="surfaceshader">
    <input name="geometry_opacity" type="float" value="0.5"/>
  </open_pbr_surface>
  <standard_surface name="wrong" type="surfaceshader">
    <input name="coat" type="color3" value="1, 0, 0"/>
  </standard_surface>
</materialx>)";
  Messages messages;
  Options options;
  options.profile = "materialx";
  options.targets = {Target::Glsl};
  const Scene scene = Scene::fromMemory(text, "models.mtlx", options, messages);
  ASSERT_TRUE(scene);
  const Contract contract = lacquer::contract(scene, {}, options, messages);
  ASSERT_EQ(contract.materials.size(), 4U);
  EXPECT_EQ(contract.materials[0].state.alpha_mode, AlphaMode::Mask);
  EXPECT_EQ(contract.materials[1].state.alpha_mode, AlphaMode::Opaque);
  EXPECT_EQ(contract.materials[2].state.alpha_mode, AlphaMode::Blend);
  EXPECT_EQ(contract.materials[1].profile, "materialx");
  EXPECT_EQ(contract.materials[1].surface, "standard_surface");
  EXPECT_EQ(contract.materials[1].translation_error, 0);
  const auto parameters = [&](size_t material) {
    std::vector<std::string> names;
    const Graph graph = scene.graph(
        material, scene.uses(material).empty() ? Attributes() : scene.uses(material)[0], options, messages);
    for (const auto& one : graph.parameters()) names.push_back(one.name);
    return names;
  };
  EXPECT_EQ(parameters(0), (std::vector<std::string>{"alpha", "roughness"}));
  EXPECT_EQ(parameters(1), (std::vector<std::string>{"sheen", "base_color"}));
  const auto said = [&](std::string_view code) {
    return std::any_of(messages.begin(), messages.end(),
                       [&](const Message& one) { return one.code == code; });
  };
  EXPECT_TRUE(said("out-of-range"));
  EXPECT_TRUE(said("unknown-input"));
  EXPECT_TRUE(said("wrong-type"));
  EXPECT_FALSE(said("duplicate-name"));
  const auto seen = evaluate(scene, 0, "[{\"n\": [0, 0, 1], \"v\": [0, 0, 1], \"l\": [0, 0, 1]}]",
                             Engine::Float, {}, options, messages);
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->discarded.at(0));
}

/// Without MaterialX: the same random surfaces as closures, and translated to glTF's properties.
TEST(Translations, areAsFarOffAsTheManifestSays) {
  for (const std::string model :
       {"standard_surface", "open_pbr_surface", "gltf_pbr", "UsdPreviewSurface", "disney_principled"}) {
    constexpr size_t kSurfaces = 40;
    Random r(5);
    std::string text = "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n";
    for (size_t i = 0; i < kSurfaces; ++i)
      text += fmt::format("<{0} name=\"s{1}\" type=\"surfaceshader\">{2}</{0}>\n", model, i,
                          randomInputs(r, model));
    text += "</materialx>\n";
    Messages messages;
    Options options, as_gltf;
    options.as = "materialx";
    as_gltf.as = "gltf";
    const Scene exact = Scene::fromMemory(text, "exact.mtlx", options, messages);
    const Scene near = Scene::fromMemory(text, "near.mtlx", as_gltf, messages);
    double off = 0, all = 0;
    for (size_t i = 0; i < kSurfaces; ++i) {
      std::vector<At> points = somePoints(r);
      points.resize(60);
      const std::string at = pointsText(points, true);
      const auto a = evaluate(exact, i, at, Engine::Float, {}, options, messages);
      const auto b = evaluate(near, i, at, Engine::Float, {}, as_gltf, messages);
      ASSERT_TRUE(a && b) << (messages.empty() ? "" : messages.back().text);
      for (size_t p = 0; p < points.size() * 3; ++p) {
        const double want = a->rgba[p / 3][p % 3];
        off += std::abs(b->rgba[p / 3][p % 3] - want);
        all += want;
      }
    }
    std::cout << fmt::format("{}: {:.3f}\n", model, off / all);
    EXPECT_NEAR(off / all, materialx::translationError(model), 0.01) << model;
  }
}

TEST_P(ClosuresPeer, drawsAlike) { compare(GetParam(), std::string_view(GetParam()).size() * 7 + 3); }

}  // namespace
}  // namespace lacquer::test::closures_peer_test
