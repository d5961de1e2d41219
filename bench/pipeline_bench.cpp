// Per material, warm, on one core: from the Material struct to each target; the same through glslang and
// spirv-opt from our own text; validation apart; and an edit of its graph, of a number to the bytes of its
// block and of the structure to SPIR-V. And whole runs whose shaders are all cached, against parsing the
// JSON.
#include "bench/pipeline_bench.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "check/check.h"
#include "lacquer.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "schedule/schedule.h"
#include "targets/legalize.h"
#include "targets/target.h"
#include "tests/build/random_gltf.h"
#include "tests/support/materials.h"

namespace lacquer::bench {

namespace {

namespace fs = std::filesystem;

/// What one material needs on its way.
struct Subject {
  std::string name;
  material::Material material;
  gltf::VertexAttributes attributes;
};

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

graph::Graph toGraph(const Subject& subject) {
  Diagnostics said;
  graph::Graph graph = test::buildGraph(subject.material, subject.attributes, {}, said);
  if (hasError(graph::check(graph, library()))) fmt::print(stderr, "{} does not check\n", subject.name);
  return graph;
}

ir::Module toPlaced(const Subject& subject) {
  ir::Module module = *lower::lower(toGraph(subject), library(), {});
  passes::runPipeline(module, {});
  return module;
}

constexpr ir::Stage kStages[] = {ir::Stage::Vertex, ir::Stage::Fragment};

size_t toSpirv(const ir::Module& module) {
  size_t words = 0;
  for (const ir::Stage stage : kStages) {
    words += targets::writeSpirv(module, schedule::schedule(module, stage), {}).size();
  }
  return words;
}

std::vector<std::string> toText(ir::Module module, Target target) {
  targets::legalize(module);
  std::vector<std::string> texts;
  for (const ir::Stage stage : kStages) {
    texts.push_back(targets::printText(module, schedule::schedule(module, stage), target, "bench"));
  }
  return texts;
}

std::vector<check::Spirv> throughGlslang(const std::vector<std::string>& texts) {
  return {*check::compile(texts[0], Target::Glsl, check::Stage::Vertex, "bench.vert"),
          *check::compile(texts[1], Target::Glsl, check::Stage::Fragment, "bench.frag")};
}

std::string pathOf(std::string_view work) {
  return fmt::format("{}/bench/works/{}.gltf", LACQUER_SOURCE_FOLDER, work);
}

std::vector<Subject> subjects() {
  std::vector<Subject> all;
  for (const char* work : {"w0", "w1", "w2", "w3"}) {
    const std::string path = pathOf(work);
    Result<material::Document> document = test::readMaterials(path);
    if (!document || document->materials.empty()) throw std::runtime_error(path + " cannot be read");
    gltf::VertexAttributes attributes;
    attributes.normal = attributes.tangent = true;
    attributes.texCoord[0] = true;
    all.push_back({work, document->materials[0], attributes});
  }
  return all;
}

template <class Work>
void add(const std::string& name, Work work) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [work](benchmark::State& state) {
                                 for (auto _ : state) benchmark::DoNotOptimize(work());
                               })
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(0.05)
      ->Repetitions(8);
}

void addMaterial(const Subject& s) {
  const ir::Module placed = toPlaced(s);
  const std::vector<std::string> texts = toText(placed, Target::Glsl);
  const std::vector<check::Spirv> compiled = throughGlslang(texts);
  std::vector<check::Spirv> direct;
  for (const ir::Stage stage : kStages)
    direct.push_back(targets::writeSpirv(placed, schedule::schedule(placed, stage), {}));
  add(s.name + "/graph", [s] { return toGraph(s); });
  add(s.name + "/graph+lower", [s] { return lower::lower(toGraph(s), library(), {}); });
  add(s.name + "/graph+lower+passes", [s] { return toPlaced(s); });
  add(s.name + "/to spirv", [s] { return toSpirv(toPlaced(s)); });
  add(s.name + "/to glsl", [s] { return toText(toPlaced(s), Target::Glsl); });
  add(s.name + "/to hlsl", [s] { return toText(toPlaced(s), Target::Hlsl); });
  add(s.name + "/glslang", [texts] { return throughGlslang(texts); });
  add(s.name + "/spirv-opt -O", [compiled] {
    return check::optimize(compiled[0], "bench.vert")->size() +
           check::optimize(compiled[1], "bench.frag")->size();
  });
  add(s.name + "/spirv-val", [direct] {
    return check::validate(direct[0], false, "bench.vert").size() +
           check::validate(direct[1], false, "bench.frag").size();
  });
}

// -- edits --

/// A tool's graph, which has its shader.
class Edited {
public:
  explicit Edited(std::string_view work) {
    options_.targets = {Target::Spirv};
    options_.validate = false;
    const Scene scene = Scene::load(pathOf(work), options_, messages_);
    graph_ = scene.graph(0, kUnusedAttributes, options_, messages_);
    shader_ = graph_.generate(options_, messages_);
    block_.resize(shader_.uniformSize());
    // An input that takes its value from a parameter, which the structure's edit makes a number, and back.
    for (const NodeUse& node : graph_.nodes()) {
      for (const Connection& input : node.inputs) {
        for (const Parameter& parameter : graph_.parameters()) {
          if (!parameter_.name.empty() || parameter.type != "float" ||
              input.source != fmt::format(R"({{"parameter": "{}"}})", parameter.name))
            continue;
          node_ = node.id;
          input_ = input;
          parameter_ = parameter;
        }
      }
    }
    if (!shader_ || node_.empty()) throw std::runtime_error(fmt::format("{} cannot be edited", work));
  }

  /// A parameter's value to the bytes of the block.
  std::byte number() {
    odd_ = !odd_;
    const double value = parameter_.value[0];
    const bool done = graph_.setParameter(parameter_.name, {odd_ ? value / 2 : value}, messages_) &&
                      graph_.changes() <= Change::Numbers && shader_.packGraph(graph_, block_, messages_);
    if (!done) throw std::runtime_error("a number is not edited");
    return block_[0];
  }

  /// Another connection to SPIR-V.
  size_t structure() {
    apart_ = !apart_;
    const std::string source = apart_ ? fmt::format("{}", parameter_.value[0]) : input_.source;
    if (!graph_.connect(node_, input_.name, source, messages_) || graph_.changes() != Change::Program)
      throw std::runtime_error("a connection is not edited");
    const Shader shader = graph_.generate(options_, messages_);
    if (!shader) throw std::runtime_error("an edited graph makes no shader");
    return shader.fragmentSpirv().size();
  }

private:
  Options options_;
  Messages messages_;
  Graph graph_;
  Shader shader_;
  std::vector<std::byte> block_;
  std::string node_;
  Connection input_;
  Parameter parameter_;
  bool odd_ = false, apart_ = false;  // of the number, and of the connection
};

void addEdits(std::string_view work) {
  const auto edited = std::make_shared<Edited>(work);
  add(fmt::format("{}/edit a number", work), [edited] { return edited->number(); });
  add(fmt::format("{}/edit the structure", work), [edited] { return edited->structure(); });
}

// -- whole runs --

struct RunFiles {
  fs::path folder = fs::temp_directory_path() / "lacquer-pipeline-bench";
  std::string input = (folder / "materials.gltf").string();
  std::string text;
  Options options;

  RunFiles(size_t materials, size_t kinds) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    text = test::RandomGltf(1).text(materials, kinds);
    std::ofstream(input, std::ios::binary) << text;
    options.validate = false;
    options.jobs = 1;
    options.cache = (folder / "cache").string();
    options.cache_size = uint64_t{4} << 30;
  }
  ~RunFiles() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  /// False when something had to be made.
  bool run() const {
    Messages messages;
    const Report report = generate({input}, {}, (folder / "out").string(), options, messages);
    return report.ok && report.made == 0;
  }
};

void addRuns(const RunFiles& files) {
  add("10000 materials/parse JSON", [&files] { return nlohmann::json::parse(files.text).size(); });
  add("10000 materials/cached run", [&files] { return files.run(); });
}

class Collector : public benchmark::ConsoleReporter {
public:
  Collector() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (!run.error_occurred && run.run_type == Run::RT_Iteration)
        keep(run.benchmark_name(), run.GetAdjustedCPUTime());
    }
  }
  std::map<std::string, double> microseconds;

private:
  /// The least of the repetitions: what else the machine does only adds.
  void keep(const std::string& name, double time) {
    const auto [it, fresh] = microseconds.try_emplace(name.substr(0, name.find("/min_time")), time);
    if (!fresh) it->second = std::min(it->second, time);
  }
};

nlohmann::ordered_json summary(std::map<std::string, double>& us, const std::vector<Subject>& all) {
  const auto rounded = [](double x) { return std::stod(fmt::format("{:.3g}", x)); };
  nlohmann::ordered_json json;
  json["unit"] = "microseconds of CPU time, one core, the least of 8 repetitions";
  for (const Subject& s : all) {
    nlohmann::ordered_json& row = json["materials"][s.name];
    for (const char* stage :
         {"graph", "graph+lower", "graph+lower+passes", "to spirv", "to glsl", "to hlsl", "glslang",
          "spirv-opt -O", "spirv-val", "edit a number", "edit the structure"}) {
      row[stage] = rounded(us[s.name + "/" + stage]);
    }
    const double text_route =
        us[s.name + "/to glsl"] + us[s.name + "/glslang"] + us[s.name + "/spirv-opt -O"];
    row["text route / direct"] = rounded(text_route / us[s.name + "/to spirv"]);
  }
  const double parse = us["10000 materials/parse JSON"];
  const double cached = us["10000 materials/cached run"];
  json["10000 materials"] = {
      {"parse JSON", rounded(parse)}, {"cached run", rounded(cached)}, {"ratio", rounded(cached / parse)}};
  return json;
}

}  // namespace

int runPipeline() {
  const std::vector<Subject> all = subjects();
  for (const Subject& subject : all) {
    addMaterial(subject);
    addEdits(subject.name);
  }
  const RunFiles files(10000, 40);
  files.run();
  if (!files.run()) throw std::runtime_error("the second run is not served from the cache");
  addRuns(files);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  const std::string path = std::string(LACQUER_SOURCE_FOLDER) + "/bench/pipeline.json";
  std::ofstream(path) << summary(collector.microseconds, all).dump(2) << "\n";
  fmt::print("written: {}\n", path);
  return 0;
}

int repeat(std::string_view work, size_t count) {
  const size_t slash = std::min(work.find('/'), work.size());
  const std::string_view edit = work.substr(slash);
  const auto repeated = [&](const auto& one) {
    one();
    for (size_t i = 0; i < count; ++i) one();
    return 0;
  };
  for (const Subject& subject : subjects()) {
    if (subject.name != work.substr(0, slash)) continue;
    if (edit.empty()) return repeated([&] { toSpirv(toPlaced(subject)); });
    Edited edited(subject.name);
    if (edit == "/number") return repeated([&] { edited.number(); });
    if (edit == "/structure") return repeated([&] { edited.structure(); });
  }
  fmt::print(stderr, "there is no work '{}'\n", work);
  return 2;
}

}  // namespace lacquer::bench
