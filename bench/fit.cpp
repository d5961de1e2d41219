#include "bench/fit.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "cost/cost.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "shader/print.h"

namespace lacquer::bench {

namespace {

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

  std::vector<Sample> measured(std::string& driver) {
    const cost::Measurement all = cost::measure(subjects_, cost::kFamilies[0], false);
    driver = all.driver + ", " + cost::kFamilies[0];
    std::vector<Sample> good;
    for (size_t i = 0; i < samples_.size(); ++i) {
      if (!all.outcomes[i].statistics) continue;
      samples_[i].cycles = static_cast<double>(all.outcomes[i].statistics->inverse_throughput);
      samples_[i].instructions = static_cast<double>(all.outcomes[i].statistics->instructions);
      good.push_back(std::move(samples_[i]));
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
    data.has_vertex = hasVertexStage(*module);
    data.module = std::move(*module);
    Wrong wrong;
    print(data, options, wrong);
    subjects_.push_back({data.id, data.spirv[0], data.spirv[1]});
    samples_.push_back({data.id, std::move(data.module)});
  }

  Options options_;
  std::shared_ptr<const Language> language_;
  std::set<std::string> known_;
  std::vector<Sample> samples_;
  std::vector<cost::Subject> subjects_;
};

/// The normal equations, by elimination with pivots; each shader's error counts by its own cost. What is not
/// `free` has no weight.
Counted solved(const std::vector<Counted>& counts, const std::vector<double>& cycles,
               const std::vector<bool>& free) {
  const size_t n = free.size();
  std::vector<Counted> a(n, Counted(n + 1, 0.0));
  for (size_t s = 0; s < counts.size(); ++s) {
    const double weight = 1 / (cycles[s] * cycles[s]);
    for (size_t i = 0; i < n; ++i) {
      if (!free[i]) continue;
      for (size_t j = 0; j < n; ++j) a[i][j] += free[j] ? weight * counts[s][i] * counts[s][j] : 0;
      a[i][n] += weight * counts[s][i] * cycles[s];
    }
  }
  for (size_t i = 0; i < n; ++i) {
    size_t pivot = i;
    for (size_t row = i; row < n; ++row) {
      if (std::abs(a[row][i]) > std::abs(a[pivot][i])) pivot = row;
    }
    std::swap(a[i], a[pivot]);
    if (std::abs(a[i][i]) < 1e-12) continue;
    for (size_t row = 0; row < n; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (size_t k = i; k <= n; ++k) a[row][k] -= factor * a[i][k];
    }
  }
  Counted weights(n);
  for (size_t i = 0; i < n; ++i) weights[i] = std::abs(a[i][i]) < 1e-12 ? 0 : a[i][n] / a[i][i];
  return weights;
}

}  // namespace

std::vector<Sample> measuredSamples(const Options& options, std::string& driver) {
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
  return all.measured(driver);
}

/// None below 0: nothing makes a shader cheaper by being there.
Counted fitted(const std::vector<Counted>& counts, const std::vector<double>& cycles) {
  std::vector<bool> free(counts.at(0).size(), true);
  while (true) {
    Counted weights = solved(counts, cycles, free);
    const auto least = std::min_element(weights.begin(), weights.end());
    if (*least >= 0) return weights;
    free[static_cast<size_t>(least - weights.begin())] = false;
  }
}

double weighed(const Counted& counts, const Counted& weights) {
  double sum = 0;
  for (size_t i = 0; i < counts.size(); ++i) sum += weights[i] * counts[i];
  return sum;
}

void printError(const char* what, const FitError& error, size_t shaders) {
  fmt::print("{:44} {:6.2f} % in the mean, {:6.2f} % at most, of {} shaders\n", what, 100 * error.mean,
             100 * error.most, shaders);
}

void printFit(const std::vector<Counted>& counts, const std::vector<double>& cycles) {
  // Half of them are kept out of the fit.
  std::vector<Counted> in, out;
  std::vector<double> cycles_in, cycles_out;
  for (size_t i = 0; i < counts.size(); ++i) {
    (i % 2 == 0 ? in : out).push_back(counts[i]);
    (i % 2 == 0 ? cycles_in : cycles_out).push_back(cycles[i]);
  }
  if (in.empty() || out.empty()) return;
  const Counted half = fitted(in, cycles_in);
  const Counted whole = fitted(counts, cycles);
  fmt::print("weights by all:");
  for (const double x : whole) fmt::print(" {:.3g},", x);
  fmt::print("\n");
  printError("fitted to half of them, on that half",
             errorOf(cycles_in, [&](size_t i) { return weighed(in[i], half); }), in.size());
  printError("and on the others", errorOf(cycles_out, [&](size_t i) { return weighed(out[i], half); }),
             out.size());
  printError("fitted to all", errorOf(cycles, [&](size_t i) { return weighed(counts[i], whole); }),
             counts.size());
}

}  // namespace lacquer::bench
