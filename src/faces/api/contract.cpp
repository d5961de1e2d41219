#include <fmt/format.h>

#include <algorithm>

#include "api/internal.h"
#include "cache/cache.h"
#include "interface/interface.h"
#include "manifest/text.h"
#include "run/packed.h"
#include "run/programs.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/print.h"
#include "structures/contract.h"
#include "support/jobs.h"

namespace lacquer {

namespace {

/// Everything that contractOf() needs, for one call.
class Making {
public:
  Making(const material::Document& document, const Options& options, Messages& messages)
      : document_(document), options_(options), messages_(messages) {}

  Contract make(const Strings& materials, const Progress& progress);

private:
  bool open();
  bool openCache();
  bool wrong(const Diagnostics& diagnostics) {
    report(diagnostics, document_.path, messages_);
    return false;
  }
  void named(const Strings& materials, Contract& contract);

  const material::Document& document_;
  Options options_;  ///< with the names of the defaults where none was given
  Messages& messages_;
  std::shared_ptr<const Language> language_;
  std::unique_ptr<Cache> cache_;
};

bool Making::open() {
  if (const Diagnostics found = checkOptions(options_); !found.empty()) return wrong(found);
  const auto language = libraryFor(options_);
  if (!language) return wrong(language.error());
  language_ = *language;
  if (const Result<void> resolved = resolveNames(*language_, options_); !resolved)
    return wrong(resolved.error());
  if (const auto model = language_->models.of(options_.profile); !model) return wrong(model.error());
  return openCache();
}

bool Making::openCache() {
  if (options_.cache.empty()) return true;
  Result<std::string> secret;
  if (!options_.cache_key.empty()) secret = Cache::secretOf(options_.cache_key);
  if (!secret) return wrong(secret.error());
  cache_ = std::make_unique<Cache>(options_.cache, options_.cache_size, std::move(*secret));
  return true;
}

/// Says which of the names no material has.
void Making::named(const Strings& materials, Contract& contract) {
  for (const std::string& name : materials) {
    const auto& all = document_.materials;
    if (std::any_of(all.begin(), all.end(), [&](const auto& m) { return m.name == name; })) continue;
    contract.ok = wrong(fail("no-such-material", {}, fmt::format("there is no material named '{}'", name),
                             "names are those of the file")
                            .value());
  }
}

Contract Making::make(const Strings& materials, const Progress& progress) {
  Contract contract;
  contract.ok = open();
  if (!contract.ok) return contract;
  Setting setting{options_, *language_, baseOf(options_), cache_.get(), nullptr, *limitsOf(options_)};
  Structures structures(setting);
  std::unique_ptr<Sharing> sharing;
  if (options_.programs > 0 || options_.fallback) {
    Diagnostics said;
    Result<std::unique_ptr<Sharing>> shared = shareDocument(document_, materials, setting, structures, said);
    if (!shared) return contract.ok = wrong(shared.error()), contract;
    report(said, {}, messages_);
    sharing = std::move(*shared);
  }
  MadeContract made = contractOf(document_, materials, setting, structures, [&](size_t done, size_t known) {
    if (progress) progress(done, known);
  });
  report(made.diagnostics, document_.path, messages_);
  if (sharing) report(sharing->about(made.shaders.size()), {}, messages_);
  if (!made.shaders.empty()) report(withoutValidator(options_), {}, messages_);
  contract = std::move(made.values);
  const Result<const material::Schema*> schema = language_->models.schema();
  for (size_t i = 0; i < made.shaders.size(); ++i)
    contract.shaders[i].shader =
        ShaderMaker::make(std::move(made.shaders[i].data), schema ? *schema : nullptr, options_);
  named(materials, contract);
  if (cache_) report(cache_->problems(), {}, messages_);
  return contract;
}

}  // namespace

Contract contract(const Scene& scene, const Strings& materials, const Options& options, Messages& messages,
                  const Progress& progress) {
  Contract made;
  made.ok = false;
  if (!filled(scene.impl_.get(), "scene", messages)) return made;
  withJobs(options.jobs,
           [&] { made = Making(scene.impl_->document, options, messages).make(materials, progress); });
  return made;
}

Drawn Contract::fallback(const Drawn& drawn) const {
  if (!drawn || !drawn.use->fallback || drawn.use->fallback->shader >= shaders.size()) return {};
  return {drawn.material, drawn.use->fallback.get(), &shaders[drawn.use->fallback->shader]};
}

Drawn Contract::drawn(int material, std::optional<size_t> use) const {
  const ContractMaterial* found = nullptr;
  if (material < 0) {
    if (default_material) found = &*default_material;
  } else {
    const auto it = std::find_if(materials.begin(), materials.end(),
                                 [&](const ContractMaterial& one) { return one.index == material; });
    if (it != materials.end()) found = &*it;
  }
  if (found == nullptr || !use || *use >= found->uses.size()) return {};
  const ContractUse& chosen = found->uses[*use];
  if (chosen.shader >= shaders.size()) return {};
  return {found, &chosen, &shaders[chosen.shader]};
}

Drawn Contract::drawn(const ContractPrimitive& primitive, std::optional<size_t> variant) const {
  for (const VariantUse& one : primitive.variants) {
    if (variant && std::find(one.variants.begin(), one.variants.end(), *variant) != one.variants.end())
      return drawn(one.material, one.use);
  }
  return drawn(primitive.material, primitive.use);
}

Shader::Values numbersOf(const ContractUse& use, Shader::Values changed) {
  std::vector<std::pair<std::string, std::vector<double>>> today;
  for (const UsedParameter& parameter : use.parameters) today.emplace_back(parameter.name, parameter.value);
  return [today = std::move(today), changed = std::move(changed)](std::string_view name,
                                                                  std::span<double> components) {
    if (changed && changed(name, components)) return true;
    for (const auto& [known, value] : today) {
      if (known != name || value.size() != components.size()) continue;
      std::copy(value.begin(), value.end(), components.begin());
      return true;
    }
    return false;
  };
}

std::string manifestJson(const Contract& contract, const std::string& source) {
  std::string text;
  manifest::Writer manifest([&](std::string_view bytes) { text += bytes; });
  json::JsonText file(manifest::kEntryDepth);
  manifest::beginFile(source, file);
  for (const ContractMaterial& material : contract.materials) manifest::write(material, file);
  manifest::endFile(contract, file);
  manifest.file(file.take());
  for (const ContractShader& one : contract.shaders) {
    std::vector<ManifestCode> code;
    for (const Target target : contract.targets) {
      const auto it = std::find_if(one.validated.begin(), one.validated.end(),
                                   [&](const auto& of) { return of.first == target; });
      const bool validated = it != one.validated.end() && it->second;
      code.push_back(manifest::codeOf(target, one.shader.id(), one.shader.hasVertexStage(), validated));
    }
    json::JsonText json(manifest::kEntryDepth);
    manifest::writeShader(code, one.shader.reflection(), ShaderMaker::argumentBuffers(one.shader), json);
    manifest.shader(one.shader.id(), json.take());
  }
  manifest.finish();
  return text;
}

std::string packedManifest(const Contract& contract, Messages& messages) {
  std::vector<PackedShader> shaders;
  for (const ContractShader& one : contract.shaders) {
    PackedShader& shader = shaders.emplace_back();
    shader.id = one.shader.id();
    shader.reflection = &one.shader.reflection();
    shader.argument_buffers = ShaderMaker::argumentBuffers(one.shader) || shader.reflection->bindless;
    for (const auto& [target, validated] : one.validated) {
      for (int stage = one.shader.hasVertexStage() ? 0 : 1; stage < 2; ++stage)
        shader.codes.push_back({std::string(targetName(target)), std::string(fileKind(target, stage)),
                                ShaderMaker::code(one.shader, target, stage), validated});
    }
  }
  const FileContract* const files[] = {&contract};
  const Result<std::string> bytes = packedBytes(files, shaders);
  if (bytes) return *bytes;
  report(bytes.error(), {}, messages);
  return {};
}

}  // namespace lacquer
