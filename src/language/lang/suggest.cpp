#include "lang/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "lang/forms.h"
#include "support/text.h"

namespace lacquer::lang {

namespace {

constexpr size_t kMostNamed = 8;

constexpr std::pair<std::string_view, std::string_view> kElsewhere[] = {
    {"color3", "vec3"}, {"color4", "vec4"},  {"vector2", "vec2"},  {"vector3", "vec3"},  {"vector4", "vec4"},
    {"integer", "int"}, {"boolean", "bool"}, {"matrix33", "mat3"}, {"matrix44", "mat4"}, {"float2", "vec2"},
    {"float3", "vec3"}, {"float4", "vec4"},  {"float3x3", "mat3"}, {"float4x4", "mat4"}, {"int2", "ivec2"},
    {"int3", "ivec3"},  {"int4", "ivec4"},   {"uint2", "uvec2"},   {"uint3", "uvec3"},   {"uint4", "uvec4"},
    {"bool2", "bvec2"}, {"bool3", "bvec3"},  {"bool4", "bvec4"},   {"color", "vec3"},    {"vector", "vec3"},
    {"matrix", "mat4"}, {"mat3x3", "mat3"},  {"mat4x4", "mat4"},
};

constexpr std::pair<std::string_view, std::string_view> kFunctionsElsewhere[] = {
    {"lerp", "mix"}, {"frac", "fract"},    {"rsqrt", "inversesqrt"}, {"ddx", "dFdx"},
    {"ddy", "dFdy"}, {"tex2D", "texture"}, {"texture2D", "texture"}, {"textureCube", "texture"},
    {"fabs", "abs"},
};

/// The second of the row whose first it is.
template <class Rows>
std::string_view secondOf(const Rows& rows, std::string_view name) {
  const auto found =
      std::find_if(std::begin(rows), std::end(rows), [&](const auto& row) { return row.first == name; });
  return found == std::end(rows) ? std::string_view{} : found->second;
}

/// "add<vec3, float>" for "add<color3,float>". `told` gets what each foreign type is called.
std::string inOwnTypes(std::string_view name, std::string& told) {
  const size_t open = name.find('<');
  std::string_view list = name.substr(open + 1);
  if (list.ends_with('>')) list.remove_suffix(1);
  std::string out(name.substr(0, open + 1));
  for (;;) {
    const size_t comma = list.find(',');
    const std::string_view type = trimmed(list.substr(0, comma));
    const std::string_view own = typeElsewhere(type);
    if (!own.empty()) told += fmt::format("{}{} is called {} here", told.empty() ? "" : ", ", type, own);
    out += own.empty() ? type : own;
    if (comma == std::string_view::npos) return out + ">";
    list.remove_prefix(comma + 1);
    out += ", ";
  }
}

/// The forms to write in place of a name with types that no form has; empty where no node has the name.
std::string formsInstead(std::string_view name, std::span<const std::string_view> candidates) {
  const std::string_view family = name.substr(0, name.find('<') + 1);
  std::vector<std::string> forms;
  std::string told;
  const std::string own = inOwnTypes(name, told);
  bool there = false;
  for (const std::string_view candidate : candidates) {
    if (candidate == family.substr(0, family.size() - 1))
      return fmt::format("'{}' has no forms: leave the types away", candidate);
    if (!candidate.starts_with(family)) continue;
    forms.push_back(fmt::format("'{}'", candidate));
    there = there || candidate == own || beginsForm(candidate, own);
  }
  if (forms.empty()) return {};
  if (there && own != name)
    return told.empty() ? fmt::format("write '{}'", own) : fmt::format("{}: '{}'", told, own);
  const size_t shown = std::min(forms.size(), kMostNamed);
  std::string list =
      forms.size() > shown
          ? fmt::format("{} and {} more", fmt::join(forms.begin(), forms.begin() + kMostNamed, ", "),
                        forms.size() - shown)
          : listOf(std::vector<std::string_view>(forms.begin(), forms.end()));
  return fmt::format("{}{}there {} {}", told, told.empty() ? "" : "; ", forms.size() == 1 ? "is" : "are",
                     list);
}

}  // namespace

std::string_view typeElsewhere(std::string_view name) { return secondOf(kElsewhere, name); }
std::string_view functionElsewhere(std::string_view name) { return secondOf(kFunctionsElsewhere, name); }

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
  return closest(name, candidates);
}

std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise) {
  if (name.find('<') != std::string_view::npos) {
    if (std::string forms = formsInstead(name, candidates); !forms.empty()) return forms;
  }
  std::vector<std::string> whole;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > name.size() + 1 && candidate.ends_with(name) &&
        candidate[candidate.size() - name.size() - 1] == '.')
      whole.push_back("'" + std::string(candidate) + "'");
  }
  if (!name.empty() && whole.size() > 1 && whole.size() <= kMostNamed)
    return "did you mean " + listOf(std::vector<std::string_view>(whole.begin(), whole.end()), "or") + "?";
  const std::string_view found = closest(name, candidates);
  return found.empty() ? std::move(otherwise) : "did you mean '" + std::string(found) + "'?";
}

}  // namespace lacquer::lang
