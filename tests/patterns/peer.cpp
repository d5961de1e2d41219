#include "patterns/peer.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

#include "check/check.h"
#include "support/cases.h"

namespace lacquer::test {

namespace fs = std::filesystem;

std::optional<std::string> peerFolder() {
  const char* named = std::getenv("LACQUER_MATERIALX");
  const fs::path folder = named != nullptr ? fs::path(named) : sourceFolder() / "../shared/peers/materialx";
  if (!fs::exists(folder / "JsMaterialXGenShader.mjs") || std::system("node --version > /dev/null 2>&1") != 0)
    return std::nullopt;
  return fs::canonical(folder).string();
}

namespace {

/// A process of node.js with MaterialX in it, which ends with this one.
class Peer {
public:
  Peer() : folder_(fs::temp_directory_path() / fmt::format("lacquer_peer_{}", getpid())) {
    const std::optional<std::string> folder = peerFolder();
    if (!folder) throw std::runtime_error("there is no MaterialX, or no node.js");
    fs::create_directories(folder_);
    const fs::path answers = folder_ / "answers";
    if (::mkfifo(answers.c_str(), 0600) != 0) throw std::runtime_error("there is no place for MaterialX");
    const std::string program = (sourceFolder() / "tests/patterns/peers.mjs").string();
    const std::string command =
        fmt::format("exec node '{}' '{}' > '{}' 2> /dev/null", program, *folder, answers.string());
    asked_ = ::popen(command.c_str(), "w");
    if (asked_ != nullptr) answers_ = std::ifstream(answers);
  }
  ~Peer() {
    if (asked_ != nullptr) ::pclose(asked_);
    fs::remove_all(folder_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// The shaders of a document by their names, of a kind of peers.mjs.
  std::map<std::string, std::string> make(std::string_view kind, const std::string& document) {
    const fs::path file = folder_ / "a.mtlx", output = folder_ / "out";
    std::ofstream(file) << document;
    fs::remove_all(output);
    fs::create_directories(output);
    std::string answer;
    fmt::print(asked_, "{}\t{}\t{}\n", kind, file.string(), output.string());
    std::fflush(asked_);
    if (!std::getline(answers_, answer)) answer = "MaterialX has ended";
    if (answer != "good") throw std::runtime_error(document + ": " + answer);
    std::map<std::string, std::string> shaders;
    for (const fs::path& shader : findFiles(output, ".pixel"))
      shaders.emplace(shader.stem().string(), readFile(shader));
    return shaders;
  }

  static Peer& shared() {
    static Peer peer;
    return peer;
  }

private:
  fs::path folder_;
  std::FILE* asked_ = nullptr;
  std::ifstream answers_;
};

/// One block of inputs becomes an input for each member.
PeerShader takenApart(std::string glsl) {
  PeerShader shader;
  shader.glsl = std::move(glsl);
  const std::regex block(R"(layout \(location = (\d+)\) in VertexData\s*\{([^}]*)\} vd;)");
  std::smatch found;
  if (!std::regex_search(shader.glsl, found, block)) return shader;
  std::string inputs;
  const std::string members = found[2];
  const std::regex member(R"((\w+) (\w+);)");
  for (std::sregex_iterator it(members.begin(), members.end(), member), end; it != end; ++it) {
    inputs += fmt::format("layout (location = {}) in {} vd_{};\n", shader.inputs.size(), (*it)[1].str(),
                          (*it)[2].str());
    shader.inputs.push_back((*it)[2]);
  }
  const std::string before = found.prefix();
  const std::string after = std::regex_replace(found.suffix().str(), std::regex(R"(\bvd\.)"), "vd_");
  shader.glsl = before + inputs + after;
  return shader;
}

}  // namespace

PeerShader peerShader(const std::string& nodes, std::string_view type, bool editable) {
  const std::string document = fmt::format(
      "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\"><nodegraph name=\"g\">{}<output "
      "name=\"out\" type=\"{}\" nodename=\"n\"/></nodegraph></materialx>\n",
      nodes, type);
  return takenApart(Peer::shared().make(editable ? "editable" : "best", document).at("out"));
}

std::map<std::string, std::string> peerSurfaces(const std::string& document) {
  return Peer::shared().make("surfaces", document);
}

PeerShader peerLit(std::string glsl, double light, double environment) {
  // Uniforms become constants, but for the eye.
  const std::regex block(R"(layout \(std140, binding=\d+\) uniform \w+\s*\{([^}]*)\};)");
  for (std::smatch found; std::regex_search(glsl, found, block);) {
    std::string constants;
    const std::string members = found[1];
    const std::regex member(R"((\w+) (\w+)(\[\w+\])?;)");
    for (std::sregex_iterator it(members.begin(), members.end(), member), end; it != end; ++it) {
      const std::string name = (*it)[2];
      if (name == "u_viewPosition") continue;
      if ((*it)[3].length() > 0)
        constants += fmt::format("{} {}{};\n", (*it)[1].str(), name, (*it)[3].str());
      else
        constants += fmt::format("const {0} {1} = {0}({2});\n", (*it)[1].str(), name,
                                 name == "u_refractionTwoSided" ? "false" : "1");
    }
    glsl = found.prefix().str() + constants + found.suffix().str();
  }
  const auto answer = [&](const char* function, const std::string& body) {
    glsl = std::regex_replace(glsl, std::regex(fmt::format(R"((\w+ {}\([^)]*\)\s*\{{))", function)),
                              "$1 " + body);
  };
  answer("mx_latlong_map_lookup", fmt::format("return vec3({:.9f});", environment));
  answer("sampleLightSource",
         fmt::format("result.intensity = vec3({:.9f}); result.direction = in_light; return;", light));
  PeerShader shader = takenApart(std::move(glsl));
  std::string more;
  for (const char* name : {"view", "light"}) {
    more += fmt::format("layout (location = {}) in vec3 in_{};\n", shader.inputs.size(), name);
    shader.inputs.emplace_back(name);
  }
  // All of them are read, whatever the surface needs.
  std::string read = "0.0";
  for (const std::string& name : shader.inputs)
    read += fmt::format(" + {}{}.x", name == "view" || name == "light" ? "in_" : "vd_", name);
  const std::string_view alpha = "_out.color, 1.0)";
  shader.glsl.replace(shader.glsl.rfind(alpha), alpha.size(), "_out.color, " + read + ")");
  const size_t line = shader.glsl.find('\n', shader.glsl.find("#version"));
  shader.glsl.insert(line + 1, "#define u_viewPosition in_view\n" + more);
  return shader;
}

std::string writtenOut(std::string glsl) {
  glsl = std::regex_replace(glsl, std::regex("#version 450"),
                            "#version 450\n#extension GL_EXT_control_flow_attributes : enable");
  return std::regex_replace(glsl, std::regex(R"(\bfor \()"), "[[unroll]] for (");
}

std::vector<uint32_t> peerWords(const std::string& glsl) {
  auto words = check::compile(glsl, Target::Glsl, check::Stage::Fragment, "peer.frag");
  if (!words) throw std::runtime_error(format(words.error().at(0)));
  auto optimized = check::optimize(*words, "peer.frag");
  if (!optimized) throw std::runtime_error(format(optimized.error().at(0)));
  return *optimized;
}

}  // namespace lacquer::test
