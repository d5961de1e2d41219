// What a template declares has names in the shaders, which are the contract with the application: they must
// mean nothing else in any target, and no two of them may be one.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ir/names.h"
#include "lang/checker.h"
#include "support/letters.h"

namespace lacquer::lang {

/// Whether a name is a name in every target; reports it when not.
bool Checker::spelled(std::string_view name, Span span) {
  if (ir::Names().pick(name) == name) return true;
  reporter_.error(
      "reserved-name", span, fmt::format("'{}' is no name in every target", name),
      "it is a keyword, a type or a function in one of them, or begins like one; give it another");
  return false;
}

/// `text` names what is declared at `span` in some target's shaders.
void Checker::claim(std::string text, Span span, std::string what) {
  if (claimed_.empty()) {
    const std::string material = "the block of the material's numbers";
    claimed_ = {{"Material", material},
                {"MaterialBlock", material},
                {"material", material},
                {ir::kLightIndexName, "the light at hand"}};
  }
  const auto [it, fresh] = claimed_.try_emplace(std::move(text), std::move(what));
  if (fresh) return;
  reporter_.error("duplicate-name", span,
                  fmt::format("'{}' is the name of {} in the shaders", it->first, it->second),
                  "give this one another name");
}

void Checker::templateNames(const BlockDecl& decl) {
  for (const BlockFieldDecl& field : decl.fields) spelled(field.name, field.span);
  if (decl.extension) return;
  const Span type = decl.type_span;
  if (!spelled(decl.type_name, type) || !spelled(decl.instance, decl.span)) return;
  const std::string name(decl.type_name);
  const std::string instance(decl.instance);
  const std::string what = fmt::format("the block '{}'", decl.type_name);
  const bool lights = decl.role == BlockRole::Lights || decl.role == BlockRole::List;
  claim(name, type, what);
  claim(name + (lights ? "s" : "Block"), type, what);
  claim(lights ? instance + "s" : instance, decl.span, what);
}

void Checker::templateNames(const EnvironmentDecl& decl) {
  if (!spelled(decl.name, decl.span)) return;
  const std::string what = fmt::format("the texture '{}'", decl.name);
  claim(std::string(decl.name), decl.span, what);
  claim(fmt::format("{}_sampler", decl.name), decl.span, what);
}

namespace {

/// A name behind a prefix that ends with an underscore.
bool doubled(std::string_view name) {
  return name.starts_with('_') || name.find("__") != std::string_view::npos;
}

constexpr std::string_view kDoubled = "GLSL keeps two underscores in a row, and one stands before it";

}  // namespace

/// Attributes have a prefix in the texts, which takes the place of the underscore that glTF's
/// application-specific ones begin with, and are in small letters. In HLSL they are semantics besides, whose
/// number has no underscore before it.
void Checker::templateNames(const AttributeDecl& decl) {
  const std::string name = lowered(withoutUnderscore(decl.name));
  const bool kept = name.starts_with("sv_");
  if (kept || doubled(name)) {
    reporter_.error("reserved-name", decl.span, fmt::format("'{}' is no name in every target", decl.name),
                    std::string(kept ? "Direct3D keeps `SV_`" : kDoubled) + "; give it another");
    return;
  }
  const std::string what = fmt::format("the attribute '{}'", decl.name);
  std::string semantic = name;
  const size_t underscore = name.rfind('_');
  if (underscore != std::string::npos &&
      name.find_first_not_of("0123456789", underscore + 1) == std::string::npos)
    semantic.erase(underscore, 1);
  if (semantic != name) claim("in_" + name, decl.span, what);
  claim("in_" + semantic, decl.span, what);
}

void Checker::templateNames(const OutputDecl& decl) {
  if (!doubled(decl.name) || decl.role == OutputRole::Displacement) return;
  reporter_.error("reserved-name", decl.span, fmt::format("'{}' is no name in every target", decl.name),
                  std::string(kDoubled) + "; give it another");
}

}  // namespace lacquer::lang
