#include "structures/contract.h"

#include <algorithm>
#include <atomic>

#include "cache/fingerprint.h"
#include "check/check.h"
#include "manifest/values.h"
#include "setting/messages.h"
#include "shader/module.h"
#include "support/jobs.h"

namespace lacquer {

namespace {

/// The places of shaders in the contract, by id.
using Places = std::map<std::string, size_t>;

ContractMaterial valuesOf(Described& described, const std::string& file, const Places& places) {
  ContractMaterial values = std::move(described.values);
  report(described.diagnostics, file, values.messages);
  for (size_t i = 0; i < values.uses.size(); ++i) {
    ContractUse& use = values.uses[i];
    use.shader = places.at(described.shaders[i]);
    if (!use.fallback) continue;
    auto fallback = std::make_shared<ContractUse>(*use.fallback);
    fallback->shader = places.at(fallback->shader_id);
    use.fallback = std::move(fallback);
  }
  return values;
}

CodedShader coded(const std::string& id, Distinct& shader, const Coder& coder, const Setting& setting,
                  Diagnostics& wrong) {
  ShaderCode code = coder.code(id, shader);
  wrong = std::move(code.wrong);
  CodedShader made;
  made.data.id = id;
  made.data.has_vertex = shader.structure->has_vertex;
  if (!shader.module) {
    Result<ir::Module> module = moduleOf(*shader.structure, setting);
    if (!module) return wrong.insert(wrong.end(), module.error().begin(), module.error().end()), made;
    shader.module = std::move(*module);
  }
  made.data.module = std::move(*shader.module);
  shader.module.reset();
  for (auto& [target, one] : code.targets) {
    if (isShader(target)) made.validated.emplace_back(target, one.validated);
    for (int file = 0; file < 2; ++file) putBytes(std::move(one.bytes[file]), made.data, target, file);
  }
  return made;
}

/// In the order of the ids.
void makeCode(const Setting& setting, Structures& structures, MadeContract& made,
              const std::function<void(size_t, size_t)>& progress) {
  std::vector<std::pair<const std::string*, Distinct*>> list;
  for (auto& [id, shader] : structures.shaders()) list.emplace_back(&id, &shader);
  made.shaders.resize(list.size());
  std::vector<Diagnostics> wrong(list.size());
  std::atomic<size_t> done{0};
  std::atomic_flag reporting;  // not a mutex: what is called may wait by taking work of this very loop
  const Coder coder(setting);
  inParallel(list.size(), [&](size_t i) {
    made.shaders[i] = coded(*list[i].first, *list[i].second, coder, setting, wrong[i]);
    const size_t finished = ++done;
    if (reporting.test_and_set(std::memory_order_acquire)) return;
    progress(finished, list.size());
    reporting.clear(std::memory_order_release);
  });
  progress(list.size(), list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    made.values.shaders.push_back({{}, made.shaders[i].validated});
    made.diagnostics.insert(made.diagnostics.end(), wrong[i].begin(), wrong[i].end());
    made.values.ok &= wrong[i].empty();
  }
}

}  // namespace

MadeContract contractOf(const material::Document& document, const std::vector<std::string>& only,
                        const Setting& setting, Structures& structures,
                        const std::function<void(size_t done, size_t known)>& progress) {
  MadeContract made;
  const passes::LightFacts lights = lightFacts(setting.options, lightsOf(document));
  const std::vector<Wanted> wanted = wantedOf(document, only, setting.options);
  std::vector<Described> described(wanted.size());
  inParallel(
      wanted.size(),
      [&](size_t i) { described[i] = describe(wanted[i], document.path, lights, setting, structures); },
      kMaterialsTogether);
  made.values.source = document.path;
  made.values.profile = setting.options.profile;
  made.values.targets = setting.options.targets;
  Places places;
  for (const auto& [id, shader] : structures.shaders()) places.emplace(id, places.size());
  UsesOf uses;
  for (size_t i = 0; i < wanted.size(); ++i) {
    made.diagnostics.insert(made.diagnostics.end(), described[i].diagnostics.begin(),
                            described[i].diagnostics.end());
    made.values.ok &= described[i].ok;
    uses.emplace(wanted[i].index, described[i].uses);
    ContractMaterial values = valuesOf(described[i], document.path, places);
    if (values.index < 0)
      made.values.default_material = std::move(values);
    else
      made.values.materials.push_back(std::move(values));
  }
  addScene(document, uses, made.values);
  made.values.looks = document.looks;
  report(document.diagnostics, document.path, made.values.messages);
  makeCode(setting, structures, made, progress);
  return made;
}

Key baseOf(const Options& options, std::vector<std::string>* node_files, bool* all_known) {
  KeyBuilder base;
  base.text(fingerprint()).text(check::toolVersions());
  // Of a folder that cannot be read whoever reads the library says why, or can read it again: its files were
  // as the base has them a moment ago.
  for (const lang::SourceFile& file : filesOfFolders(options, all_known)) {
    base.text(file.name).text(file.text);
    if (node_files != nullptr) node_files->push_back(file.name);
  }
  for (const auto* texts : {&options.node_texts, &options.materialx_texts}) {
    for (const auto& [name, text] : *texts) base.text(name).text(text);
  }
  return base.finish();
}

}  // namespace lacquer
