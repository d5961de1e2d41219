#include "run/named_shaders.h"

#include <fmt/format.h>

#include "support/text.h"

namespace lacquer {

std::vector<NamedShader> shadersNamedIn(const FileContract& file, size_t index) {
  std::vector<NamedShader> all;
  const auto add = [&](const ContractMaterial& material, const std::string& pointer) {
    for (size_t i = 0; i < material.uses.size(); ++i) {
      const ContractUse& use = material.uses[i];
      const std::string at = fmt::format("{}/uses/{}/", pointer, i);
      all.push_back({at + "shader", use.shader_id});
      if (use.fallback) all.push_back({at + "fallback/shader", use.fallback->shader_id});
    }
  };
  const std::string pointer = fmt::format("/files/{}", index);
  for (size_t i = 0; i < file.materials.size(); ++i)
    add(file.materials[i], fmt::format("{}/materials/{}", pointer, i));
  if (file.default_material) add(*file.default_material, pointer + "/default_material");
  return all;
}

Diagnostic noSuchShader(const std::string& path, const NamedShader& named, std::string help) {
  return {"no-such-shader",
          Severity::Error,
          {path, 0, 0, named.pointer},
          "there is no shader " + quote(named.id),
          std::move(help),
          {}};
}

}  // namespace lacquer
