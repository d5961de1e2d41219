// `lacquer lod`: levels of detail, looked for, made, measured, written.
#include "lod/lod.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cost/cost.h"
#include "interface/interface.h"
#include "lacquer/manifest.h"
#include "lacquer/tools.h"
#include "lod/geometry.h"
#include "lod/report.h"
#include "lod/share.h"
#include "manifest/stale.h"
#include "manifest/text.h"
#include "setting/messages.h"
#include "setting/simplify.h"
#include "shader/preshader.h"
#include "shader/print.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/text.h"

namespace lacquer {

namespace {

constexpr uint32_t kMostLevels = 16;
constexpr uint32_t kLeastSize = 16, kMostSize = 512;
/// The first level is for balls of this many pixels, the last for the least.
constexpr double kLargest = 256, kSmallest = 32;
/// Pixels of a ball in the report.
constexpr uint32_t kShown = 128;

/// Ascending (or descending) numbers within bounds, a level for each.
Result<void> checkBounds(const char* what, const std::vector<double>& bounds, double most, bool rising) {
  bool good = bounds.size() < kMostLevels;
  for (size_t i = 0; i < bounds.size(); ++i) {
    good = good && bounds[i] > 0 && bounds[i] < most;
    if (i > 0) good = good && (rising ? bounds[i] > bounds[i - 1] : bounds[i] < bounds[i - 1]);
  }
  if (good) return {};
  return fail("out-of-range", {}, fmt::format("the levels' {} are not as they must be", what),
              fmt::format("at most {}, above 0 and below {:g}, each {} than the one before", kMostLevels - 1,
                          most, rising ? "more" : "less"));
}

Result<void> checkLod(const Lod& lod, const Options& options) {
  if (Result<void> path = hasPath("the output folder", lod.output); !path) return path;
  if (Result<void> levels = inRange("the number of levels", lod.levels, 2, kMostLevels, {}); !levels)
    return levels;
  if (Result<void> size = inRange("the size of a ball", lod.size, kLeastSize, kMostSize, "pixels"); !size)
    return size;
  if (Result<void> errors = checkBounds("errors", lod.errors, 100, true); !errors) return errors;
  if (Result<void> costs = checkBounds("costs", lod.costs, 1, false); !costs) return costs;
  if (!lod.errors.empty() && !lod.costs.empty())
    return fail("wrong-count", {}, "levels are asked for by error and by cost", "name one of them");
  if (!(lod.radius >= 1e-6 && lod.radius <= 1e6))
    return fail("out-of-range", {}, fmt::format("the ball's radius is {}", lod.radius),
                "from 1e-6 to 1e6, in the unit of positions (glTF: meters)");
  if (!(lod.most_error > 0 && lod.most_error <= 100))
    return fail("out-of-range", {}, fmt::format("the last level's error is {}", lod.most_error),
                "it is a colour difference above 0, at most 100");
  if (options.parameters == Parameters::Spec)
    return fail("lod-parameters", {}, "levels have one uniform block, and specialization constants have none",
                "parameters are uniform or baked");
  return {};
}

/// A shader of a level, printed.
struct Printed {
  ManifestShader entry;
  std::vector<std::pair<std::string, std::string>> files;  ///< path below the folder, bytes
};

class LevelSearch {
public:
  LevelSearch(const Lod& lod, const Options& options, Messages& messages, const Progress& progress,
              const LevelStore* store)
      : lod_(lod),
        asked_(options),
        options_(options),
        messages_(messages),
        progress_(progress),
        store_(store) {}

  Result<Levels> make(const Strings& files, const Strings& materials) {
    if (Result<void> good = checkLod(lod_, options_); !good)
      return tl::make_unexpected(std::move(good.error()));
    if (Diagnostics wrong = checkOptions(options_); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    const auto library = libraryFor(options_);
    if (!library) return tl::make_unexpected(library.error());
    language_ = *library;
    if (Result<void> named = resolveNames(*language_, options_); !named)
      return tl::make_unexpected(std::move(named.error()));
    // Levels are for what is small in the picture: highlights must hold still there.
    if (language_->has(lang::DeclKind::Switch, kAntialiasing))
      options_.switches.try_emplace(std::string(kAntialiasing), true);
    warnWithoutDriver();
    Strings missing = materials;
    std::vector<Input> read_files;
    for (const std::string& file : files) read(file, materials, missing, read_files);
    if (!missing.empty())
      return fail("no-such-material", {}, fmt::format("no material is named '{}'", printable(missing[0])),
                  "`lacquer gen` lists the materials of a file");
    inputs_ = files;
    if (!options_.cache_key.empty()) inputs_.push_back(options_.cache_key);
    if (Result<void> may = mayWrite(); !may) return tl::make_unexpected(std::move(may.error()));
    for (size_t f = 0; f < read_files.size(); ++f) {
      const Input& input = read_files[f];
      FileImages images =
          input.graph ? FileImages::ofGraph(input.path, options_) : FileImages(input.path, options_);
      for (const material::Material& material : input.document.materials) chain(material, input, f, images);
      if (input.graph) chain(*input.graph, input, f, images);
      const Strings of_images = images.read();
      inputs_.insert(inputs_.end(), of_images.begin(), of_images.end());
    }
    if (chains_.empty()) return fail("nothing-to-show", {}, "there is no material with levels");
    if (Result<void> written = write(); !written) return tl::make_unexpected(std::move(written.error()));
    return Levels{lod_.output, driver_, found()};
  }

private:
  void warnWithoutDriver() {
    const std::string reason = cost::unavailable();
    if (reason.empty()) return;
    report({{"cost-estimated",
             Severity::Warning,
             {},
             fmt::format("costs are estimated from the operations: {}", reason),
             "install the Vulkan loader and Mesa's drivers (Debian: libvulkan1, mesa-vulkan-drivers)",
             {}}},
           {}, messages_);
  }

  /// A file's materials, or the graph that it is.
  struct Input {
    std::string path;
    material::Document document;
    std::optional<graph::Graph> graph;
    Key content{};  ///< of a graph's file, where results are kept
  };

  void readGraph(const std::string& file, const Strings& only, Strings& missing, std::vector<Input>& inputs) {
    Result<graph::Graph> graph = readGraphFile(file, options_);
    if (!graph) return report(graph.error(), file, messages_);
    std::erase(missing, graph->name);
    if (!only.empty() && std::find(only.begin(), only.end(), graph->name) == only.end()) return;
    ++known_;
    inputs.push_back({file, {}, std::move(*graph)});
    if (store_ == nullptr) return;
    const Result<std::string> bytes = readFile(file);
    inputs.back().content = keyOf(bytes ? *bytes : std::string());
  }

  void read(const std::string& file, const Strings& only, Strings& missing, std::vector<Input>& inputs) {
    if (isGraphFile(file)) return readGraph(file, only, missing, inputs);
    Result<material::Document> document = readMaterials(file, *language_, options_);
    if (!document) return report(document.error(), file, messages_);
    report(document->diagnostics, file, messages_);
    for (const material::Material& material : document->materials) std::erase(missing, material.name);
    const auto wanted = [&](const material::Material& material) {
      return only.empty() || std::find(only.begin(), only.end(), material.name) != only.end();
    };
    known_ +=
        static_cast<size_t>(std::count_if(document->materials.begin(), document->materials.end(), wanted));
    inputs.push_back({document->path, std::move(*document), {}});
    for (material::Material& material : inputs.back().document.materials) {
      if (!wanted(material)) material.index = -2;  // not asked for; its place in the list stays its number
    }
  }

  void chain(const EvalSubject& subject, const Input& input, size_t file, FileImages& images) {
    if (!subject.isGraph() && subject.material()->index < 0) return;
    report(subject.diagnostics(), input.path, messages_);
    if (!lacquer::hasError(subject.diagnostics())) {
      if (Result<void> made = found(subject, input, file, images); !made)
        report(made.error(), input.path, messages_);
    }
    ++done_;
    if (progress_) progress_(done_, known_);
  }

  Result<void> found(const EvalSubject& of, const Input& input, size_t file, FileImages& images) {
    gltf::VertexAttributes attributes{true, true, false, {true, true, false, false}};
    passes::LightFacts lights;
    preview::Mesh mesh;
    const material::Material* material = of.material();
    if (material != nullptr) {
      const auto& uses = input.document.uses[static_cast<size_t>(material->index)];
      if (!uses.empty()) attributes = uses[0];
      lights = lightsOf(input.document);
      mesh = lod::meshOf(*material, images, *language_, messages_);
    }
    // The default template and profile are named, which would build a graph.
    const Options& options = material == nullptr ? asked_ : options_;
    LodMaterial subject({of, attributes, lights, images, *language_, options, lod_.texels, mesh, lod_.radius,
                         store_, input.content},
                        lod_.size);
    Result<lod::Tried> exact = subject.open(messages_);
    if (!exact) return tl::make_unexpected(std::move(exact.error()));
    LodChain made;
    made.found.file = input.path;
    made.found.name = of.name();
    made.found.index = material == nullptr ? 0 : static_cast<size_t>(material->index);
    made.found.triangles = subject.figures({}).error_on_geometry ? mesh.triangles.size() / 3 : 0;
    made.found.radius = subject.radius();
    search(subject, *exact, made);
    if (Result<void> good = finish(subject, fmt::format("{}-{}", file, made.found.index), made); !good)
      return good;
    if (!subject.driver().empty()) driver_ = subject.driver();
    chains_.push_back(std::move(made));
    return {};
  }

  /// Before the search, which takes a while: the folder, and the names that are known.
  Result<void> mayWrite() const {
    if (Diagnostics wrong = clashes(inputs_, {lod_.output + "/manifest.json", lod_.output + "/report.html"});
        !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    if (const Result<bool> usable = makeFolder(lod_.output); !usable)
      return tl::make_unexpected(usable.error());
    return {};
  }

  /// What is measured is kept, and said, after so many sets.
  std::vector<std::optional<lod::Tried>> inBatches(LodMaterial& subject, const std::vector<lod::Words>& sets,
                                                   double most, const lod::Stage& stage,
                                                   const MaterialLevels& of) const {
    const size_t together = std::max<size_t>(16, 4 * threads());
    std::vector<std::optional<lod::Tried>> all;
    for (size_t i = 0; i < sets.size(); i += together) {
      const auto begin = sets.begin() + static_cast<ptrdiff_t>(i);
      const auto end = begin + static_cast<ptrdiff_t>(std::min(together, sets.size() - i));
      for (std::optional<lod::Tried>& one : subject.measure({begin, end}, most))
        all.push_back(std::move(one));
      if (!lod_.step) continue;
      const bool words = stage.what == lod::Stage::Of::Words;
      lod_.step({of.file, of.name, done_, known_, subject.measured(), subject.remembered(),
                 static_cast<LodStep::Stage>(stage.what), words ? all.size() : stage.at, stage.of});
    }
    return all;
  }

  std::vector<size_t> chosen(const std::vector<lod::Tried>& best) const {
    if (!lod_.errors.empty()) return lod::byError(best, lod_.errors);
    if (!lod_.costs.empty()) return lod::byCost(best, lod_.costs);
    return lod::byCount(best, lod_.levels, lod_.most_error);
  }

  /// Everything that is worth to be tried, and the best of it.
  void search(LodMaterial& subject, const lod::Tried& exact, LodChain& made) const {
    lod::Stage stage;
    const lod::Measure measure = [&](const std::vector<lod::Words>& sets, double most) {
      return inBatches(subject, sets, most, stage, made.found);
    };
    const lod::Subject of_word = [](const std::string& word) { return lacquer::subjectOf(word); };
    lod::Bounds bounds;
    bounds.most_error = 2 * (lod_.errors.empty() ? lod_.most_error : lod_.errors.back());
    if (!lod_.costs.empty()) bounds.most_error = 100;
    lod::Advice advice;
    advice.refit = [&](const lod::Words& words) { return subject.fitted(words); };
    advice.same = [&](const lod::Words& a, const lod::Words& b) { return subject.same(a, b); };
    advice.choose = [&](const std::vector<lod::Tried>& front) { return chosen(front); };
    advice.stage = [&](const lod::Stage& begins) { stage = begins; };
    advice.limit = [&](const lod::Tried& level, bool last) { return limitOf(level, last); };
    advice.look = [&](const lod::Words& words) -> std::optional<double> {
      const Result<LevelFigures> seen = subject.seen(words, false);
      return seen ? std::optional(seen->error.delta_e) : std::nullopt;
    };
    lod::Searched searched = lod::search(exact, subject.words(), of_word, bounds, measure, advice);
    made.tried = std::move(searched.tried);
    made.best = std::move(searched.best);
    made.found.measured = made.tried.size();
  }

  /// Levels that are asked for by their errors, and the last of a number, may be as wrong as was asked for.
  std::optional<double> limitOf(const lod::Tried& level, bool last) const {
    for (const double most : lod_.errors) {
      if (level.error <= most) return most;
    }
    const bool by_count = lod_.errors.empty() && lod_.costs.empty();
    return by_count && last ? std::optional(lod_.most_error) : std::nullopt;
  }

  /// Level `k` of `count` with the exact one, from the largest size to the smallest by equal factors.
  static uint32_t screenOf(size_t k, size_t count) {
    if (k == 0) return 0;
    const double part = count < 3 ? 1 : static_cast<double>(k - 1) / static_cast<double>(count - 2);
    return static_cast<uint32_t>(std::lround(kLargest * std::pow(kSmallest / kLargest, part)));
  }

  /// The levels' shaders with one interface, measured again.
  Result<void> finish(LodMaterial& subject, const std::string& stem, LodChain& made) {
    std::vector<ir::Module> modules;
    for (const size_t place : chosen(made.best)) {
      Level level;
      level.simplify = made.best[place].words;
      Result<ir::Module> module = subject.module(level.simplify);
      if (!module) return tl::make_unexpected(std::move(module.error()));
      modules.push_back(std::move(*module));
      made.found.levels.push_back(std::move(level));
    }
    lod::shareInterface(modules);
    if (Result<void> measured = measureLevels(subject, modules, made); !measured) return measured;
    uniformsOf(modules[0], made);
    ExactShots exact;
    for (size_t i = 0; i < made.found.levels.size(); ++i) {
      Level& level = made.found.levels[i];
      level.screen_size = screenOf(i, made.found.levels.size());
      if (Result<void> good = print(std::move(modules[i]), level); !good) return good;
      LevelPictures& pictures = made.pictures.emplace_back();
      if (i == 0) continue;
      const std::string path = fmt::format("pictures/{}-{}", stem, i);
      if (Result<void> good = draw(subject, path, level, exact, pictures); !good) return good;
    }
    return {};
  }

  /// A level whose own shader, with the shared block, does not cost less than the one before is none.
  static Result<void> measureLevels(LodMaterial& subject, std::vector<ir::Module>& modules, LodChain& made) {
    Result<std::vector<LevelFigures>> costs = subject.costs(modules, true);
    if (!costs) return tl::make_unexpected(std::move(costs.error()));
    std::vector<Level> levels;
    std::vector<ir::Module> kept;
    for (size_t i = 0; i < made.found.levels.size(); ++i) {
      Level& level = made.found.levels[i];
      level.figures = (*costs)[i];
      const Result<LevelFigures> found = subject.seen(level.simplify, true);
      if (!found) return tl::make_unexpected(found.error());
      level.figures.error = found->error;
      level.figures.error_on_geometry = found->error_on_geometry;
      if (!levels.empty() && level.figures.cost >= levels.back().figures.cost) continue;
      levels.push_back(std::move(level));
      kept.push_back(std::move(modules[i]));
    }
    made.found.levels = std::move(levels);
    modules = std::move(kept);
    return {};
  }

  /// What the engine puts into the block, and the textures that it binds, for today's numbers.
  static void uniformsOf(const ir::Module& module, LodChain& made) {
    const Preshader preshader(module);
    const std::vector<ir::Components> values =
        preshader.evaluate([&](uint32_t i) -> const ir::Components& { return module.parameters[i].value; });
    for (size_t i = 0; i < values.size(); ++i) {
      const Preshader::Field& field = preshader.fields()[i];
      const auto count = static_cast<ptrdiff_t>(ir::componentCount(field.type));
      made.found.uniforms.emplace_back(field.name,
                                       std::vector<double>(values[i].begin(), values[i].begin() + count));
    }
  }

  Result<void> print(ir::Module module, Level& level) {
    ShaderData data;
    data.id = shaderId(module, *language_);
    data.has_vertex = hasVertexStage(module);
    data.module = std::move(module);
    level.shader = data.id;
    if (printed_.contains(data.id)) return {};
    Wrong wrong;
    lacquer::print(data, options_, wrong);
    Printed made;
    made.entry.id = data.id;
    made.entry.argument_buffers = options_.argument_buffers;
    for (const Target target : options_.targets) {
      const auto row = static_cast<size_t>(target);
      if (lacquer::hasError(wrong[row])) return tl::make_unexpected(std::move(wrong[row]));
      made.entry.targets.push_back(
          manifest::codeOf(target, data.id, data.has_vertex, options_.validate && hasValidator(target)));
      for (int stage = firstStage(target, data.has_vertex); stage < 2; ++stage)
        made.files.emplace_back(shaderPath(target, data.id, stage), takeBytes(data, target, stage));
    }
    const Result<const material::Schema*> schema = language_->models.schema();
    made.entry.reflection = reflect(data.module, data.has_vertex, schema ? *schema : nullptr);
    printed_.emplace(data.id, std::move(made));
    return {};
  }

  /// Of the exact shader, by size and whether they are of triangles: several levels are seen beside one.
  using ExactShots = std::map<std::pair<uint32_t, bool>, std::vector<preview::Shot>>;

  Result<void> draw(const LodMaterial& subject, const std::string& stem, Level& level, ExactShots& known,
                    LevelPictures& pictures) {
    for (const bool used : {false, true}) {
      const uint32_t size = used ? level.screen_size : kShown;
      const bool triangles = atVertices(level.simplify);
      auto exact = known.find({size, triangles});
      if (exact == known.end()) {
        auto made = subject.shots({}, size, triangles);
        if (!made) return tl::make_unexpected(std::move(made.error()));
        exact = known.emplace(std::pair(size, triangles), std::move(*made)).first;
      }
      const auto simpler = subject.shots(level.simplify, size, triangles);
      if (!simpler) return tl::make_unexpected(simpler.error());
      if (used)
        subject.compare(exact->second, *simpler, level.error_at_screen_size,
                        level.error_on_geometry_at_screen_size);
      std::string path = stem + (used ? "-used.png" : ".png");
      pictures_.emplace_back(path, strip(exact->second, *simpler));
      (used ? pictures.used : pictures.large) = std::move(path);
    }
    return {};
  }

  std::vector<MaterialLevels> found() const {
    std::vector<MaterialLevels> all;
    for (const LodChain& chain : chains_) all.push_back(chain.found);
    return all;
  }

  std::string manifest() const {
    Manifest manifest{std::string(version()), {}, {}, found()};
    for (const auto& [id, one] : printed_) manifest.shaders.push_back(one.entry);
    return manifestJson(manifest);
  }

  Result<void> write() const {
    std::vector<std::pair<std::string, std::string>> files = pictures_;
    Strings shaders;
    for (const auto& [id, one] : printed_) {
      files.insert(files.end(), one.files.begin(), one.files.end());
      for (const auto& [path, bytes] : one.files) shaders.push_back(path);
    }
    files.emplace_back("report.html", lodPage(chains_, driver_, lod_.size, *language_));
    files.emplace_back("manifest.json", manifest());
    Strings outputs;
    for (const auto& [path, bytes] : files) outputs.push_back(lod_.output + "/" + path);
    if (Diagnostics wrong = clashes(inputs_, outputs); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    Scratch scratch(lod_.output);
    LeftShaders left(lod_.output, scratch, listedShaders(lod_.output + "/manifest.json"));
    left.expect(shaders);
    for (const auto& [path, bytes] : files) {
      const Result<bool> written = writeFile(lod_.output + "/" + path, bytes, {&scratch, options_.sync});
      if (!written) return tl::make_unexpected(written.error());
    }
    left.remove(shaders, inputs_);
    return {};
  }

  const Lod& lod_;
  const Options& asked_;
  Options options_;  ///< with its names resolved
  Messages& messages_;
  const Progress& progress_;
  const LevelStore* store_;
  std::shared_ptr<const Language> language_;
  Strings inputs_;
  std::vector<LodChain> chains_;
  std::map<std::string, Printed> printed_;  ///< by shader
  std::vector<std::pair<std::string, std::string>> pictures_;
  std::string driver_;
  size_t done_ = 0, known_ = 0;
};

}  // namespace

std::optional<Levels> lookForLevels(const Lod& lod, const Strings& files, const Strings& materials,
                                    const Options& options, Messages& messages, const Progress& progress,
                                    const LevelStore* store) {
  Result<Levels> made;
  withJobs(options.jobs,
           [&] { made = LevelSearch(lod, options, messages, progress, store).make(files, materials); });
  return valueOf(std::move(made), {}, messages);
}

}  // namespace lacquer
