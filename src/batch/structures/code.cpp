#include "structures/code.h"

#include <algorithm>

#include "check/check.h"
#include "setting/option_key.h"
#include "targets/target.h"

namespace lacquer {

bool ShaderCode::complete() const {
  return std::all_of(targets.begin(), targets.end(), [](const auto& one) { return one.second.made; });
}

Coder::Coder(const Setting& setting) : setting_(setting) {
  if (setting.cache == nullptr || !setting.options.validate) return;
  for (const Target target : setting.options.targets) programs_[target] = check::programsOf(target);
}

/// The base covers this build with its compilers and validators, and the node library; the id covers the
/// module.
Key Coder::keyOf(const std::string& id, Target target) const {
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

TargetCode Coder::load(const Key& key) const {
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

void Coder::save(const Key& key, const TargetCode& code) const {
  if (setting_.cache == nullptr) return;
  const StageTimer timer(setting_.times, StageOfRun::Cache);
  BlobWriter blob;
  blob(code.validated, code.bytes);
  setting_.cache->put(key, blob.take());
}

void Coder::print(const std::string& id, Distinct& shader, const std::vector<Target>& targets,
                  ShaderCode& made) const {
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
  Options options = setting_.options;
  options.targets = targets;
  Wrong wrong;
  lacquer::print(data, options, wrong, setting_.times);
  shader.module = std::move(data.module);
  for (const Target target : targets) {
    TargetCode& code = made.targets[target];
    code.made = true;
    for (int stage = 0; stage < 2; ++stage) code.bytes[stage] = takeBytes(data, target, stage);
    Diagnostics& found = wrong[static_cast<size_t>(target)];
    code.validated =
        options.validate && hasValidator(target, hasArrays(shader.structure->reflection)) && found.empty();
    // Invalid code is our bug, and every run says so again. A registered target's check is asked in each
    // process.
    if (found.empty() && !targets::row(target).check) save(keyOf(id, target), code);
    std::move(found.begin(), found.end(), std::back_inserter(made.wrong));
  }
}

ShaderCode Coder::code(const std::string& id, Distinct& shader) const {
  ShaderCode made;
  std::vector<Target> missing;
  for (const Target target : setting_.options.targets) {
    made.targets[target] = load(keyOf(id, target));
    if (!made.targets[target].made) missing.push_back(target);
  }
  made.cached = missing.empty();
  if (!made.cached) print(id, shader, missing, made);
  return made;
}

}  // namespace lacquer
