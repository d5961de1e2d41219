#include "run/shaders.h"

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>

#include "cache/option_key.h"
#include "check/check.h"
#include "interface/entry.h"
#include "json/text.h"
#include "manifest/manifest.h"
#include "shader/print.h"
#include "targets/target.h"

namespace lacquer {

namespace {

/// The bytes of one target's files, and whether they have been found valid.
struct TargetCode {
  bool made = false;
  bool validated = false;
  std::array<std::string, 2> bytes;  ///< by stage
};

class Maker {
public:
  Maker(const Setting& setting, const std::string& folder, const Scratch& scratch, const Receipt* receipt)
      : setting_(setting), folder_(folder), writing_{&scratch, setting.options.sync}, receipt_(receipt) {
    if (setting.cache == nullptr || !setting.options.validate) return;
    for (const Target target : setting.options.targets) programs_[target] = check::programsOf(target);
  }

  MadeShader make(const std::string& id, Distinct& shader) const;

private:
  Key keyOf(const std::string& id, Target target) const;
  TargetCode load(const Key& key) const;
  void save(const Key& key, const TargetCode& code) const;
  void print(const std::string& id, Distinct& shader, const std::vector<Target>& targets,
             std::map<Target, TargetCode>& codes, MadeShader& made) const;
  void write(const std::string& id, const Structure& structure, const std::map<Target, TargetCode>& codes,
             MadeShader& made) const;
  std::string entry(const std::string& id, const Structure& structure,
                    const std::map<Target, TargetCode>& codes) const;

  const Setting& setting_;
  const std::string& folder_;
  Writing writing_;
  const Receipt* receipt_;
  std::map<Target, std::string> programs_;  ///< that check the code, beside what is linked
};

/// The base covers this build with its compilers and validators, and the node library; the id covers the
/// module.
Key Maker::keyOf(const std::string& id, Target target) const {
  const Options& options = setting_.options;
  KeyBuilder key;
  key.text("shader").key(setting_.base).text(id).text(targetName(target));
  addOptions(options, {Decides::Code}, key);
  const targets::Row& row = targets::row(target);
  if (row.words) addOptions(options, {Decides::SpirvCode}, key);
  if (row.argument_buffers) addOptions(options, {Decides::MslCode}, key);
  if (const auto found = programs_.find(target); found != programs_.end()) key.text(found->second);
  key.text(row.identity);
  return key.finish();
}

TargetCode Maker::load(const Key& key) const {
  if (setting_.cache == nullptr) return {};
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  const std::optional<std::string> bytes = setting_.cache->get(key);
  if (!bytes) return {};
  BlobReader blob(*bytes);
  TargetCode code;
  blob(code.validated, code.bytes);
  code.made = blob.complete();
  return code;
}

void Maker::save(const Key& key, const TargetCode& code) const {
  if (setting_.cache == nullptr) return;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  BlobWriter blob;
  blob(code.validated, code.bytes);
  setting_.cache->put(key, blob.take());
}

void Maker::print(const std::string& id, Distinct& shader, const std::vector<Target>& targets,
                  std::map<Target, TargetCode>& codes, MadeShader& made) const {
  if (!shader.module) {
    Result<ir::Module> module = moduleOf(*shader.structure, setting_);
    if (!module) {
      made.wrong = module.error();
      return;
    }
    shader.module = std::move(*module);
  }
  ShaderData data;
  data.id = id;
  data.has_vertex = shader.structure->has_vertex;
  data.module = std::move(*shader.module);
  shader.module.reset();
  Options options = setting_.options;
  options.targets = targets;
  Wrong wrong;
  lacquer::print(data, options, wrong, setting_.times);
  for (const Target target : targets) {
    TargetCode& code = codes[target];
    code.made = true;
    for (int stage = 0; stage < 2; ++stage) {
      code.bytes[stage] = takeBytes(data, target, stage);
    }
    Diagnostics& found = wrong[static_cast<size_t>(target)];
    const size_t before = made.wrong.size();
    code.validated = options.validate && hasValidator(target) && found.empty();
    for (Diagnostic& w : found) {
      if (!w.place.file.empty()) w.place.file = folder_ + "/" + w.place.file;
      made.wrong.push_back(std::move(w));
    }
    // What is not valid is our bug, and is said again in every run.
    if (made.wrong.size() == before) save(keyOf(id, target), code);
  }
}

void Maker::write(const std::string& id, const Structure& structure,
                  const std::map<Target, TargetCode>& codes, MadeShader& made) const {
  const StageTimer timer(setting_.times, StageOfRun::Write);
  for (const Target target : setting_.options.targets) {
    for (int stage = firstStage(target, structure.has_vertex); stage < 2; ++stage) {
      const std::string path = shaderPath(target, id, stage);
      const std::string& bytes = codes.at(target).bytes[stage];
      const Result<bool> written = writeFile(folder_ + "/" + path, bytes, writing_);
      if (!written)
        made.wrong.insert(made.wrong.end(), written.error().begin(), written.error().end());
      else
        made.written += *written ? 1 : 0;
      made.files.emplace_back(path, bytes.size());
    }
  }
}

std::string Maker::entry(const std::string& id, const Structure& structure,
                         const std::map<Target, TargetCode>& codes) const {
  JsonText json(2);
  json.beginObject().key("files").beginObject();
  for (const Target target : setting_.options.targets) {
    json.key(targetName(target)).beginObject();
    for (int stage = firstStage(target, structure.has_vertex); stage < 2; ++stage)
      json.key(fileKind(target, stage)).string(shaderPath(target, id, stage));
    json.endObject();
  }
  json.endObject().key("validated").beginObject();
  for (const Target target : setting_.options.targets) {
    if (isShader(target)) json.key(targetName(target)).boolean(codes.at(target).validated);
  }
  json.endObject();
  for (const auto& [name, text] : structure.interface) {
    if (isShown(name, setting_.options)) json.key(name.substr(0, name.find(' '))).raw(text);
  }
  return json.endObject().take();
}

MadeShader Maker::make(const std::string& id, Distinct& shader) const {
  MadeShader made;
  made.id = id;
  std::map<Target, TargetCode> codes;
  if (const ShaderReport* left = receipt_ == nullptr ? nullptr : receipt_->untouched(id)) {
    made.cached = true;
    made.validated = left->validated;
    made.files = left->files;
    for (const Target target : setting_.options.targets) {
      codes[target].validated = left->validated && hasValidator(target);
    }
    made.text = entry(id, *shader.structure, codes);
    shader.module.reset();
    return made;
  }
  std::vector<Target> missing;
  for (const Target target : setting_.options.targets) {
    codes[target] = load(keyOf(id, target));
    if (!codes[target].made) missing.push_back(target);
  }
  made.cached = missing.empty();
  if (!made.cached) print(id, shader, missing, codes, made);
  shader.module.reset();
  made.validated = setting_.options.validate;
  for (const auto& [target, code] : codes) {
    if (!code.made) return made;
    // Of what nothing here compiles the manifest says so.
    made.validated &= code.validated || !hasValidator(target);
  }
  write(id, *shader.structure, codes, made);
  made.text = entry(id, *shader.structure, codes);
  return made;
}

}  // namespace

std::vector<MadeShader> makeShaders(std::map<std::string, Distinct>& shaders, const Setting& setting,
                                    const std::string& folder, const Scratch& scratch, const Receipt* receipt,
                                    const std::function<void(size_t done)>& progress) {
  std::vector<std::pair<const std::string*, Distinct*>> list;
  for (auto& [id, shader] : shaders) list.emplace_back(&id, &shader);
  std::vector<MadeShader> made(list.size());
  std::atomic<size_t> done{0};
  std::atomic_flag reporting;  // not a mutex: what is called may wait by taking work of this very loop
  const Maker maker(setting, folder, scratch, receipt);
  tbb::parallel_for(size_t{0}, list.size(), [&](size_t i) {
    made[i] = maker.make(*list[i].first, *list[i].second);
    const size_t finished = ++done;
    if (reporting.test_and_set(std::memory_order_acquire)) return;
    progress(finished);  // when it throws, nothing is reported any more
    reporting.clear(std::memory_order_release);
  });
  return made;
}

}  // namespace lacquer
