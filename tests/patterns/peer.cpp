#include "patterns/peer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

#include "check/check.h"
#include "support/cases.h"

namespace lacquer::test {

namespace fs = std::filesystem;

std::optional<std::string> peerGenerator() {
  const char* named = std::getenv("LACQUER_MATERIALX");
  const fs::path folder = named != nullptr ? fs::path(named) : sourceFolder() / "../shared/peers/materialx";
  const fs::path file = folder / "generate.mjs";
  if (!fs::exists(file) || std::system("node --version > /dev/null 2>&1") != 0) return std::nullopt;
  return fs::canonical(file).string();
}

PeerShader peerShader(const std::string& nodes, std::string_view type, bool editable) {
  const std::optional<std::string> generator = peerGenerator();
  if (!generator) throw std::runtime_error("there is no MaterialX, or no node.js");
  const fs::path folder = fs::temp_directory_path() / fmt::format("lacquer_peer_{}", getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "a.mtlx") << fmt::format(
      "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\"><nodegraph name=\"g\">{}<output name=\"out\" "
      "type=\"{}\" "
      "nodename=\"n\"/></nodegraph></materialx>\n",
      nodes, type);
  const std::string command = fmt::format("cd '{}' && node '{}' a.mtlx out VkShaderGenerator {} > log 2>&1",
                                          folder.string(), *generator, editable ? "prefilter" : "best");
  const int status = std::system(command.c_str());
  if (status != 0) {
    const std::string log = readFile(folder / "log");
    fs::remove_all(folder);
    throw std::runtime_error(nodes + ": " + log);
  }
  PeerShader shader;
  shader.glsl = readFile(folder / "out/g_out.pixel");
  fs::remove_all(folder);
  // One block of inputs becomes an input for each member.
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
