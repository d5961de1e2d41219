#include "bench/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "cost/cost.h"
#include "lod/estimate.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "shader/print.h"

namespace lacquer::bench {

namespace {

constexpr size_t kWeights = std::tuple_size_v<decltype(lod::Counts{}.all())>;
using Row = std::array<double, kWeights>;

struct Sample {
  std::string name;
  Row counts{};
  double cycles = 0, estimated = 0;  ///< RADV's; with the weights that the program has
  double instructions = 0;
};

/// The distinct shaders of files: each material as it is, and without or with each word of the library.
class Samples {
public:
  explicit Samples(const Options& options) : options_(options), language_(*libraryFor(options_)) {
    if (!resolveNames(*language_, options_)) throw std::runtime_error("the options have a name that is none");
  }

  void add(const std::string& file) {
    const Result<material::Document> document = readMaterials(file, *language_, options_);
    if (!document) throw std::runtime_error(format(document.error().at(0)));
    for (const material::Material& material : document->materials) {
      gltf::VertexAttributes attributes{true, true, false, {true, true}};
      add(material, attributes, {});
      Diagnostics warnings;
      const Result<graph::Graph> graph = buildGraph(material, attributes, *language_, options_, warnings);
      if (!graph) continue;
      for (const std::string& word : possibleWords(*graph, &material, *language_, options_))
        add(material, attributes, {word});
    }
  }

  std::vector<Sample> measured() {
    const cost::Measurement all = cost::measure(subjects_, cost::kFamilies[0], false);
    fmt::print("{}, {}\n", all.driver, cost::kFamilies[0]);
    std::vector<Sample> good;
    for (size_t i = 0; i < samples_.size(); ++i) {
      if (!all.outcomes[i].statistics) continue;
      samples_[i].cycles = static_cast<double>(all.outcomes[i].statistics->inverse_throughput);
      samples_[i].instructions = static_cast<double>(all.outcomes[i].statistics->instructions);
      good.push_back(samples_[i]);
    }
    return good;
  }

private:
  void add(const material::Material& material, const gltf::VertexAttributes& attributes,
           const Strings& words) {
    Options options = options_;
    options.simplify = words;
    Diagnostics warnings;
    Result<graph::Graph> graph = buildGraph(material, attributes, *language_, options, warnings);
    if (!graph || hasError(graph::check(*graph, *language_))) return;
    Result<ir::Module> module = toModule(*graph, *language_, options, {});
    if (!module) return;
    ShaderData data;
    data.id = shaderId(*module, *language_);
    if (!known_.insert(data.id).second) return;
    Sample sample;
    sample.name = data.id;
    sample.counts = lod::countsOf(*module, ir::Stage::Fragment).all();
    sample.estimated = static_cast<double>(lod::estimate(*module).cycles);
    data.has_vertex = hasVertexStage(*module);
    data.module = std::move(*module);
    Wrong wrong;
    print(data, options, wrong);
    subjects_.push_back({sample.name, data.spirv[0], data.spirv[1]});
    samples_.push_back(std::move(sample));
  }

  Options options_;
  std::shared_ptr<const Language> language_;
  std::set<std::string> known_;
  std::vector<Sample> samples_;
  std::vector<cost::Subject> subjects_;
};

/// The normal equations, by elimination with pivots; each shader's error counts by its own cost. What is not
/// `free` has no weight.
Row solved(const std::vector<Sample>& samples, const std::array<bool, kWeights>& free) {
  std::array<std::array<double, kWeights + 1>, kWeights> a{};
  for (const Sample& sample : samples) {
    const double weight = 1 / (sample.cycles * sample.cycles);
    for (size_t i = 0; i < kWeights; ++i) {
      if (!free[i]) continue;
      for (size_t j = 0; j < kWeights; ++j)
        a[i][j] += free[j] ? weight * sample.counts[i] * sample.counts[j] : 0;
      a[i][kWeights] += weight * sample.counts[i] * sample.cycles;
    }
  }
  for (size_t i = 0; i < kWeights; ++i) {
    size_t pivot = i;
    for (size_t row = i; row < kWeights; ++row) {
      if (std::abs(a[row][i]) > std::abs(a[pivot][i])) pivot = row;
    }
    std::swap(a[i], a[pivot]);
    if (std::abs(a[i][i]) < 1e-12) continue;
    for (size_t row = 0; row < kWeights; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (size_t k = i; k <= kWeights; ++k) a[row][k] -= factor * a[i][k];
    }
  }
  Row weights{};
  for (size_t i = 0; i < kWeights; ++i) weights[i] = std::abs(a[i][i]) < 1e-12 ? 0 : a[i][kWeights] / a[i][i];
  return weights;
}

/// None below 0: nothing makes a shader cheaper by being there.
Row fitted(const std::vector<Sample>& samples) {
  std::array<bool, kWeights> free;
  free.fill(true);
  while (true) {
    const Row weights = solved(samples, free);
    const auto least = std::min_element(weights.begin(), weights.end());
    if (*least >= 0) return weights;
    free[static_cast<size_t>(least - weights.begin())] = false;
  }
}

double byWeights(const Sample& sample, const Row& weights) {
  double sum = 0;
  for (size_t i = 0; i < kWeights; ++i) sum += weights[i] * sample.counts[i];
  return sum;
}

template <class Of>
void printError(const char* what, const std::vector<Sample>& samples, Of of) {
  double sum = 0;
  double most = 0;
  for (const Sample& sample : samples) {
    const double off = std::abs(of(sample) / sample.cycles - 1);
    sum += off;
    most = std::max(most, off);
  }
  fmt::print("{:44} {:6.2f} % in the mean, {:6.2f} % at most, of {} shaders\n", what,
             100 * sum / static_cast<double>(samples.size()), 100 * most, samples.size());
}

}  // namespace

int runEstimate() {
  if (const std::string reason = cost::unavailable(); !reason.empty()) {
    fmt::print(stderr, "nothing can be fitted: {}\n", reason);
    return 1;
  }
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  Samples all(options);
  std::vector<std::string> files;
  for (const char* folder : {"bench/works", "examples"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(LACQUER_SOURCE_FOLDER "/") + folder)) {
      if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) all.add(file);
  const std::vector<Sample> samples = all.measured();
  // Half of them are kept out of the fit.
  std::vector<Sample> in, out;
  for (size_t i = 0; i < samples.size(); ++i) (i % 2 == 0 ? in : out).push_back(samples[i]);
  if (in.empty() || out.empty()) return 1;
  const Row half = fitted(in);
  const Row whole = fitted(samples);
  fmt::print("weights by all:");
  for (const double x : whole) fmt::print(" {:.3g},", x);
  double instructions = 0;
  for (const Sample& sample : samples) instructions += sample.instructions / sample.cycles;
  fmt::print("\ninstructions for each cycle: {:.3g}\n", instructions / static_cast<double>(samples.size()));
  printError("fitted to half of them, on that half", in, [&](const Sample& s) { return byWeights(s, half); });
  printError("and on the others", out, [&](const Sample& s) { return byWeights(s, half); });
  printError("fitted to all", samples, [&](const Sample& s) { return byWeights(s, whole); });
  printError("with the weights that the program has", samples, [&](const Sample& s) { return s.estimated; });
  return 0;
}

}  // namespace lacquer::bench
