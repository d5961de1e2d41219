#include "passes/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace lacquer::passes {

namespace {

/// Keywords, types and built-in functions of the targets that could be taken for a local's name. Sorted.
constexpr auto kReserved = std::to_array<std::string_view>({"abs",
                                                            "acos",
                                                            "active",
                                                            "alignas",
                                                            "alignof",
                                                            "all",
                                                            "and",
                                                            "and_eq",
                                                            "any",
                                                            "asin",
                                                            "asm",
                                                            "atan",
                                                            "atan2",
                                                            "atomic_uint",
                                                            "attribute",
                                                            "auto",
                                                            "bitand",
                                                            "bitor",
                                                            "bool",
                                                            "break",
                                                            "buffer",
                                                            "case",
                                                            "cast",
                                                            "catch",
                                                            "cbuffer",
                                                            "ceil",
                                                            "centroid",
                                                            "char",
                                                            "char16_t",
                                                            "char32_t",
                                                            "clamp",
                                                            "class",
                                                            "clip",
                                                            "coherent",
                                                            "column_major",
                                                            "common",
                                                            "compile",
                                                            "compl",
                                                            "const",
                                                            "const_cast",
                                                            "constexpr",
                                                            "continue",
                                                            "cos",
                                                            "cosh",
                                                            "cross",
                                                            "dFdx",
                                                            "dFdy",
                                                            "ddx",
                                                            "ddy",
                                                            "decltype",
                                                            "default",
                                                            "degrees",
                                                            "delete",
                                                            "determinant",
                                                            "discard",
                                                            "distance",
                                                            "do",
                                                            "dot",
                                                            "double",
                                                            "dst",
                                                            "dynamic_cast",
                                                            "else",
                                                            "enum",
                                                            "equal",
                                                            "exp",
                                                            "exp2",
                                                            "explicit",
                                                            "export",
                                                            "extern",
                                                            "external",
                                                            "false",
                                                            "filter",
                                                            "fixed",
                                                            "flat",
                                                            "float",
                                                            "float2",
                                                            "float3",
                                                            "float4",
                                                            "floor",
                                                            "fma",
                                                            "fmod",
                                                            "for",
                                                            "frac",
                                                            "fract",
                                                            "friend",
                                                            "fwidth",
                                                            "goto",
                                                            "groupshared",
                                                            "half",
                                                            "highp",
                                                            "hvec2",
                                                            "if",
                                                            "image",
                                                            "in",
                                                            "inline",
                                                            "inout",
                                                            "input",
                                                            "int",
                                                            "interface",
                                                            "invariant",
                                                            "inverse",
                                                            "inversesqrt",
                                                            "isampler2D",
                                                            "isinf",
                                                            "isnan",
                                                            "layout",
                                                            "length",
                                                            "lerp",
                                                            "less",
                                                            "line",
                                                            "linear",
                                                            "lit",
                                                            "log",
                                                            "log10",
                                                            "log2",
                                                            "long",
                                                            "lowp",
                                                            "mad",
                                                            "main",
                                                            "mat2",
                                                            "mat3",
                                                            "mat4",
                                                            "matrix",
                                                            "max",
                                                            "mediump",
                                                            "min",
                                                            "mix",
                                                            "mod",
                                                            "modf",
                                                            "mul",
                                                            "mutable",
                                                            "namespace",
                                                            "new",
                                                            "noexcept",
                                                            "noinline",
                                                            "noise",
                                                            "noise1",
                                                            "noperspective",
                                                            "normalize",
                                                            "not",
                                                            "not_eq",
                                                            "nullptr",
                                                            "operator",
                                                            "or",
                                                            "or_eq",
                                                            "out",
                                                            "output",
                                                            "packoffset",
                                                            "partition",
                                                            "pass",
                                                            "patch",
                                                            "pixelfragment",
                                                            "point",
                                                            "pow",
                                                            "precise",
                                                            "precision",
                                                            "private",
                                                            "protected",
                                                            "public",
                                                            "radians",
                                                            "rcp",
                                                            "readonly",
                                                            "reflect",
                                                            "refract",
                                                            "register",
                                                            "reinterpret_cast",
                                                            "resource",
                                                            "restrict",
                                                            "return",
                                                            "round",
                                                            "row_major",
                                                            "rsqrt",
                                                            "sample",
                                                            "sampler",
                                                            "sampler2D",
                                                            "samplerCube",
                                                            "saturate",
                                                            "shared",
                                                            "short",
                                                            "sign",
                                                            "signed",
                                                            "sin",
                                                            "sincos",
                                                            "sinh",
                                                            "sizeof",
                                                            "smooth",
                                                            "smoothstep",
                                                            "sqrt",
                                                            "stateblock",
                                                            "static",
                                                            "static_assert",
                                                            "static_cast",
                                                            "step",
                                                            "string",
                                                            "struct",
                                                            "subroutine",
                                                            "superp",
                                                            "switch",
                                                            "tan",
                                                            "tanh",
                                                            "tbuffer",
                                                            "technique",
                                                            "template",
                                                            "tex2D",
                                                            "texCUBE",
                                                            "texture",
                                                            "textureLod",
                                                            "this",
                                                            "thread_local",
                                                            "throw",
                                                            "transpose",
                                                            "triangle",
                                                            "true",
                                                            "trunc",
                                                            "try",
                                                            "typedef",
                                                            "typeid",
                                                            "typename",
                                                            "uint",
                                                            "uniform",
                                                            "union",
                                                            "unsigned",
                                                            "using",
                                                            "varying",
                                                            "vec2",
                                                            "vec3",
                                                            "vec4",
                                                            "vector",
                                                            "virtual",
                                                            "void",
                                                            "volatile",
                                                            "wchar_t",
                                                            "while",
                                                            "writeonly",
                                                            "xor",
                                                            "xor_eq"});
static_assert(std::is_sorted(kReserved.begin(), kReserved.end()));

bool reserved(std::string_view name) {
  static const std::unordered_set<std::string_view> kWords(kReserved.begin(), kReserved.end());
  return kWords.contains(name);
}

/// The printers' own prefixes: attributes, varyings, outputs and what languages keep for themselves.
bool prefixed(std::string_view name) {
  constexpr std::array kPrefixes = {"in_", "v_", "out_", "gl_", "lacquer_", "_"};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&](std::string_view p) { return name.starts_with(p); });
}

}  // namespace

namespace {

/// The name with only characters that every target takes, and none of the printers' prefixes.
std::string cleaned(std::string_view wanted) {
  std::string name;
  for (const char c : wanted) {
    const char kept = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    // Two underscores in a row are reserved in GLSL.
    if (kept == '_' && !name.empty() && name.back() == '_') continue;
    name += kept;
  }
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) || prefixed(name))
    name = "value_" + name;
  while (name.back() == '_') name.pop_back();
  // The helper functions of the C++ header are called min_of, max_of and so on.
  if (name.ends_with("_of")) name += "_value";
  return name;
}

}  // namespace

bool Names::free(std::string_view name) const { return !reserved(name) && !taken_.contains(name); }

std::string Names::pick(std::string_view wanted, std::string_view layer) {
  const std::string base = cleaned(wanted);
  std::string name = base;
  // "coat_alpha", but not "coat_coat_alpha": a second one of a layer's own is numbered.
  const bool of_layer =
      base.starts_with(layer) && base.substr(std::min(layer.size(), base.size())).starts_with('_');
  if (!free(name) && !layer.empty() && !of_layer) name = cleaned(fmt::format("{}_{}", layer, base));
  const std::string numbered = name;
  for (int k = 2; !free(name); ++k) name = fmt::format("{}_{}", numbered, k);
  taken_.insert(name);
  return name;
}

std::string_view layerOf(std::string_view term) { return term.substr(0, term.find('.')); }

}  // namespace lacquer::passes
