// Damaged glTF files, graphs and nodes through the public API: whatever comes in, what comes out is messages.
// Run under the sanitizers. The input at work is in out/fuzz, so that a crash leaves it behind.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "lacquer.h"

namespace {

namespace fs = std::filesystem;
using namespace lacquer;

enum class Kind : uint8_t { Gltf, Graph, Node };

struct Input {
  Kind kind;
  std::string text;
};

std::string readFile(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The examples, the graphs of their materials, and the node library.
std::vector<Input> corpus(const Options& options) {
  const fs::path root = LACQUER_SOURCE_FOLDER;
  std::vector<Input> inputs;
  for (const auto& entry : fs::directory_iterator(root / "examples")) {
    if (entry.path().extension() != ".gltf") continue;
    inputs.push_back({Kind::Gltf, readFile(entry.path())});
    Messages messages;
    const Scene scene = Scene::load(entry.path().string(), options, messages);
    for (size_t i = 0; scene && i < scene.materialCount(); ++i) {
      const Graph graph = scene.graph(i, {true, true, true, {true, true, false, false}}, options, messages);
      if (graph) inputs.push_back({Kind::Graph, graph.toJson()});
    }
  }
  // Under names of their own, or all that the checker said would be that they are there already.
  for (const auto& entry : fs::directory_iterator(root / "nodes")) {
    std::string text = readFile(entry.path());
    const std::string node = "\nnode ";
    for (size_t at = text.find(node); at != std::string::npos; at = text.find(node, at + 1)) {
      text.insert(at + node.size(), "own_");
    }
    inputs.push_back({Kind::Node, std::move(text)});
  }
  return inputs;
}

class Mutator {
public:
  explicit Mutator(uint64_t seed) : random_(seed) {}

  size_t below(size_t n) { return n == 0 ? 0 : random_() % n; }

  /// One to eight injuries; spans are taken from another input now and then.
  std::string damaged(std::string text, const std::string& other) {
    for (size_t n = 1 + below(8); n > 0; --n) injure(text, other);
    return text;
  }

private:
  void injure(std::string& text, const std::string& other) {
    static constexpr const char* kTokens[] = {
        "-1",   "1e400",   "1e-320", "0.1e", "null", "true", "[]",   "{}", "\"\"", "18446744073709551616",
        "\xff", "\\u0000", "nan",    "(",    "}",    "%",    "vec4", "if", "\n",   "KHR_materials_coat"};
    const size_t at = below(text.size() + 1);
    const size_t length = below(std::min<size_t>(text.size() - at, 64) + 1);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_());
        return;
      case 1: text.erase(at, length); return;
      case 2: text.insert(at, text.substr(at, length)); return;
      case 3: text.replace(at, length, kTokens[below(std::size(kTokens))]); return;
      case 4: text.replace(at, length, other.substr(below(other.size() + 1), below(64))); return;
      default: replaceNumber(text, at); return;
    }
  }

  void replaceNumber(std::string& text, size_t from) {
    static constexpr const char* kNumbers[] = {"0",    "-0",   "1",     "-1",         "2",   "1e9",
                                               "1e38", "1e39", "1e-45", "4294967296", "0.5", "1000000"};
    const size_t at = text.find_first_of("0123456789", from);
    if (at == std::string::npos) return;
    const size_t end = std::min(text.find_first_not_of("0123456789.eE+-", at), text.size());
    text.replace(at, end - at, kNumbers[below(std::size(kNumbers))]);
  }

  std::mt19937_64 random_;
};

/// True when a shader came out of it.
bool make(Graph graph, const Options& options) {
  Messages messages;
  if (!graph || !graph.check(messages, options)) return false;
  return static_cast<bool>(graph.generate(options, messages));
}

bool feed(const Input& input, const fs::path& folder, Options options) {
  Messages messages;
  switch (input.kind) {
    case Kind::Gltf: {
      const Scene scene = Scene::fromMemory(input.text, "fuzz.gltf", options, messages);
      bool made = false;
      for (size_t i = 0; scene && i < scene.materialCount(); ++i) {
        made |= make(scene.graph(i, {true, i % 2 == 0, i % 3 == 0, {true, i % 2 == 1, false, false}}, options,
                                 messages),
                     options);
      }
      return made;
    }
    case Kind::Graph: return make(Graph::fromJson(input.text, "fuzz.json", messages), options);
    case Kind::Node:
      options.node_directories = {folder.string()};
      return !nodesJson(options, messages).empty();
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60;
  const uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : std::random_device()();
  const fs::path folder = fs::path(LACQUER_SOURCE_FOLDER) / "out/fuzz";
  fs::create_directories(folder);
  Options options;
  options.targets = {Target::Glsl, Target::Hlsl, Target::Spirv};
  options.validate = false;
  const std::vector<Input> inputs = corpus(options);
  Mutator mutator(seed);
  fmt::print("seed {}, {} inputs, for {} s; the input at work is in {}\n", seed, inputs.size(), seconds,
             folder.string());
  size_t runs = 0;
  size_t made = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    Input input = inputs[mutator.below(inputs.size())];
    input.text = mutator.damaged(std::move(input.text), inputs[mutator.below(inputs.size())].text);
    options.template_name = mutator.below(8) == 0 ? "surface" : "forward";
    std::ofstream(folder / (input.kind == Kind::Node ? "fuzz.node" : "fuzz.json"), std::ios::binary)
        << input.text;
    made += feed(input, folder, options) ? 1 : 0;
    if (input.kind == Kind::Node) fs::remove(folder / "fuzz.node");
    ++runs;
  }
  fmt::print("fuzz: good: {} inputs, {} of them still made a shader or a library\n", runs, made);
  return 0;
}
