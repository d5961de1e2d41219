#include "run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "check/check.h"
#include "setting/options.h"
#include "shader/print.h"
#include "structures/contract.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// So many files are held in memory at once: enough for every thread, few enough that a run over thousands of
/// files does not grow with their number.
size_t filesAtOnce(size_t files) {
  constexpr size_t kMost = 16;
  return files <= 1 ? 1 : std::min(kMost, 2 * threads());
}

constexpr auto kProgressGrain = std::chrono::milliseconds(50);

}  // namespace

Run::Run(const Options& options, const Strings& inputs, Messages& messages,
         std::function<void(size_t, size_t)> progress)
    : options_(options),
      messages_(messages),
      progress_(std::move(progress)),
      shown_(std::chrono::steady_clock::now()),
      said_before_(messages.size()),
      inputs_(inputs) {
  other_.emplace(&times_, StageOfRun::Other);
  if (!options.weights.empty()) inputs_.push_back(options.weights);
}

bool Run::prepare() {
  prepared_ = true;
  for (const std::string& input : inputs_) {
    if (const Result<void> named = hasPath("an input", input); !named) return allGood(named.error());
  }
  if (const Diagnostics wrong = checkOptions(options_); !wrong.empty()) {
    report(wrong, {});
    report_.ok = false;
    return false;
  }
  if (!checkPrograms()) return false;
  const StageTimer timer(&times_, StageOfRun::Read);
  base_ = baseOf(options_, &node_files_, &nodes_known_);
  if (options_.cache.empty()) return true;
  Result<std::string> secret;
  if (!options_.cache_key.empty()) secret = Cache::secretOf(options_.cache_key);
  if (!secret) {
    report(secret.error(), {});
    report_.ok = false;
    return false;
  }
  cache_ = std::make_unique<Cache>(options_.cache, options_.cache_size, std::move(*secret));
  return true;
}

bool Run::open(const std::string& folder) {
  if (!prepared_ && !prepare()) return false;
  if (const Result<void> placed = hasPlace(folder, inputs_); !placed) return allGood(placed.error());
  const StageTimer timer(&times_, StageOfRun::Library);
  const auto library = libraryFor(options_);
  if (!library) {
    report(library.error(), {});
    report_.ok = false;
    return false;
  }
  library_ = *library;
  if (const Result<void> named = resolveNames(*library_, options_); !named) {
    report(named.error(), {});
    report_.ok = false;
    return false;
  }
  if (const auto model = library_->models.of(options_.profile); !model) {
    report(model.error(), {});
    report_.ok = false;
    return false;
  }
  setting_.emplace(Setting{options_, *library_, base_, cache_.get(), &times_, *limitsOf(options_), folder});
  setting_->several = inputs_.size() > 1;
  structures_.emplace(*setting_);
  return true;
}

bool Run::checkPrograms() {
  if (const Diagnostics wrong = wrongOfPrograms(options_); !wrong.empty()) return allGood(wrong);
  Result<programs::Weights> weights = weightsOf(options_, *limitsOf(options_));
  if (!weights) return allGood(weights.error());
  weights_ = std::move(*weights);
  return true;
}

/// The files stay in memory between the looks.
void Run::mergePrograms(const std::vector<std::string>& files, InputKind kind,
                        const std::vector<std::string>& only) {
  read_.resize(files.size());
  inParallel(files.size(), [&](size_t i) { read_[i] = readInput(files[i], kind, *setting_); });
  programs_ = sharePrograms(*setting_, *structures_, [&](Uses& uses) {
    const size_t at_once = filesAtOnce(read_.size());
    for (size_t first = 0; first < read_.size(); first += at_once) {
      std::vector<FileResult> results(std::min(at_once, read_.size() - first));
      inParallel(results.size(),
                 [&](size_t i) { results[i] = makeInput(read_[first + i], only, *setting_, *structures_); });
      for (const FileResult& result : results) {
        for (const Key& key : result.structures) uses.structure(key);
        for (const MaterialReport& material : result.materials)
          uses.material(material.shaders, weights_.of(material.file, material.name, material.index));
      }
    }
  });
  report(weights_.unused(options_.weights), {});
}

void Run::write(const std::string& path, const std::string& text, Receipt* receipt) {
  wrote(writeFile(path, text, {nullptr, options_.sync}));
  if (receipt != nullptr) receipt->wrote(path, outputKey(text));
}

void Run::writeProgramsReport(Receipt* receipt) {
  const std::string& path = options_.programs_report;
  if (path.empty() || !programs_) return;
  const programs::Curve& curve = programs_->curve();
  const std::string text = path.ends_with(".json") ? programs::toJson(curve)
                           : path.ends_with(".md") ? programs::toMarkdown(curve)
                                                   : programs::toSvg(curve);
  write(path, text, receipt);
}

std::optional<Receipt> Run::receipt(const Strings& files, const Strings& materials,
                                    const std::string& folder) {
  if (cache_ == nullptr || !nodes_known_) return std::nullopt;
  const StageTimer timer(&times_, StageOfRun::Read);
  return Receipt(files, materials, folder, options_, base_, *cache_);
}

bool Run::find(Receipt& receipt) {
  const StageTimer timer(&times_, StageOfRun::Cache);
  if (!receipt.find(report_, messages_)) return false;
  if (progress_) progress_(report_.shaders.size(), report_.shaders.size());
  return true;
}

void Run::keep(const Receipt& receipt) {
  const StageTimer timer(&times_, StageOfRun::Cache);
  receipt.keep(report_, Messages(messages_.begin() + static_cast<ptrdiff_t>(said_before_), messages_.end()));
}

void Run::progress(size_t done, bool last) {
  if (!progress_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!last && now - shown_ < kProgressGrain) return;
  shown_ = now;
  progress_(done, structures_->shaderCount());
}

void Run::readAll(const std::vector<std::string>& files, const std::function<FileResult(size_t file)>& read,
                  const std::function<void(FileResult&)>& each) {
  const size_t at_once = filesAtOnce(files.size());
  for (size_t first = 0; first < files.size(); first += at_once) {
    std::vector<FileResult> results(std::min(at_once, files.size() - first));
    inParallel(results.size(), [&](size_t i) { results[i] = read(first + i); });
    for (size_t i = 0; i < results.size(); ++i) {
      FileResult& result = results[i];
      report(result.diagnostics, files[first + i]);
      report_.ok &= result.ok;
      included_.insert(result.included.begin(), result.included.end());
      each(result);
      report_.materials.insert(report_.materials.end(), std::make_move_iterator(result.materials.begin()),
                               std::make_move_iterator(result.materials.end()));
    }
    progress(0, false);
  }
}

void Run::read(const std::vector<std::string>& files, InputKind kind, const std::vector<std::string>& only,
               const std::function<void(FileResult&)>& each) {
  if (options_.programs > 0 || options_.fallback || !options_.programs_report.empty())
    mergePrograms(files, kind, only);
  std::vector<std::string> seen;
  const bool in_memory = !read_.empty();
  readAll(
      files,
      [&](size_t i) {
        if (!in_memory) return makeInput(files[i], kind, only, *setting_, *structures_);
        FileResult result = makeInput(read_[i], only, *setting_, *structures_);
        read_[i] = {};
        return result;
      },
      [&](FileResult& result) {
        seen.insert(seen.end(), result.names.begin(), result.names.end());
        each(result);
      });
  if (programs_) report(programs_->about(structures_->shaders().size()), {});
  checkNames(only, seen);
}

void Run::checkNames(const std::vector<std::string>& only, const std::vector<std::string>& seen) {
  for (const std::string& name : only) {
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
    std::string known;
    for (size_t i = 0; i < seen.size() && i < 8; ++i)
      known += fmt::format("{}'{}'", i == 0 ? "" : ", ", seen[i]);
    if (seen.size() > 8) known += ", …";
    report({{"no-such-material",
             Severity::Error,
             {},
             fmt::format("no file has a material named '{}'", name),
             known.empty() ? "the files have no materials" : "there are " + known,
             {}}},
           {});
    report_.ok = false;
  }
}

bool Run::make(const std::string& folder, const Scratch& scratch, LeftShaders* left, Receipt* receipt,
               const std::function<void(const MadeShader&)>& each) {
  Strings paths, outputs;
  for (const auto& [id, shader] : structures_->shaders()) {
    for (const Target target : options_.targets) {
      for (int stage = firstStage(target, shader.structure->has_vertex); stage < 2; ++stage) {
        paths.push_back(shaderPath(target, id, stage));
        outputs.push_back(folder + "/" + paths.back());
      }
    }
  }
  if (!mayWrite(outputs)) return false;
  if (left != nullptr) left->expect(paths);
  const std::vector<MadeShader> made = makeShaders(structures_->shaders(), *setting_, folder, scratch,
                                                   receipt, [&](size_t done) { progress(done, false); });
  progress(made.size(), true);
  if (!made.empty()) report(withoutValidator(options_), {});
  for (const MadeShader& shader : made) {
    report(shader.wrong, {});
    report_.ok &= shader.wrong.empty();
    report_.shaders.push_back({shader.id, shader.files, shader.validated});
    for (size_t i = 0; receipt != nullptr && i < shader.contents.size(); ++i)
      receipt->wrote(folder + "/" + shader.files[i].first, shader.contents[i]);
    report_.made += shader.cached ? 0 : 1;
    report_.written += shader.written;
    if (!shader.text.empty()) each(shader);
  }
  return true;
}

bool Run::mayWrite(const Strings& outputs) { return allGood(clashes(readFiles(), outputs)); }

bool Run::mayName(const Strings& outputs, const std::string& folder) {
  Strings folders{Scratch::below(folder)};
  for (const std::string& name : targetNames()) folders.push_back(fmt::format("{}/{}", folder, name));
  Diagnostics wrong = reservedNames(folders, {folder + "/manifest.json"}, outputs);
  if (options_.cache.empty()) return allGood(wrong);
  for (Diagnostic& one : reservedNames({Cache::entriesBelow(options_.cache)}, {}, outputs)) {
    one.message = "this file is to be written where the cache's own are";
    wrong.push_back(std::move(one));
  }
  return allGood(wrong);
}

bool Run::allGood(const Diagnostics& wrong) {
  if (wrong.empty()) return true;
  report(wrong, {});
  report_.ok = false;
  return false;
}

void Run::wrote(const Result<bool>& written) {
  if (written) {
    report_.written += *written ? 1 : 0;
    return;
  }
  report(written.error(), {});
  report_.ok = false;
}

std::vector<std::string> Run::inputs() const {
  std::vector<std::string> all = inputs_;
  all.insert(all.end(), node_files_.begin(), node_files_.end());
  all.insert(all.end(), included_.begin(), included_.end());
  return all;
}

std::vector<std::string> Run::readFiles() const {
  std::vector<std::string> all = inputs();
  if (!options_.cache_key.empty()) all.push_back(options_.cache_key);
  return all;
}

Report Run::finish() {
  if (cache_) report(cache_->problems(), {});
  other_.reset();
  report_.times = times_.list();
  return std::move(report_);
}

}  // namespace lacquer
