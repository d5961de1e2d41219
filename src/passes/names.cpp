#include "passes/names.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>

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

uint64_t hashOf(std::string_view name) {
  const uint64_t hash = XXH3_64bits(name.data(), name.size());
  return hash == 0 ? 1 : hash;
}

/// The place of a hash in a table, or the empty one where it belongs.
template <class Table>
size_t slotOf(const Table& table, uint64_t hash) {
  size_t slot = hash & (table.size() - 1);
  while (table[slot] != 0 && table[slot] != hash) slot = (slot + 1) & (table.size() - 1);
  return slot;
}

bool reserved(uint64_t hash) {
  static const auto kTable = [] {
    std::array<uint64_t, 1024> table{};
    static_assert(kReserved.size() * 2 < table.size());
    for (const std::string_view word : kReserved) table[slotOf(table, hashOf(word))] = hashOf(word);
    return table;
  }();
  return kTable[slotOf(kTable, hash)] != 0;
}

/// The printers' own prefixes: attributes, varyings, outputs and what languages keep for themselves.
bool prefixed(std::string_view name) {
  constexpr std::array kPrefixes = {"in_", "v_", "out_", "gl_", "lacquer_", "_"};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&](std::string_view p) { return name.starts_with(p); });
}

/// Letters, digits and underscores, in every locale the same.
bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

bool digit(char c) { return c >= '0' && c <= '9'; }

/// The name with only characters that every target takes, and none of the printers' prefixes.
std::string cleaned(std::string_view wanted) {
  std::string name;
  name.reserve(wanted.size());
  for (const char c : wanted) {
    const char kept = plain(c) ? c : '_';
    // Two underscores in a row are reserved in GLSL.
    if (kept == '_' && !name.empty() && name.back() == '_') continue;
    name += kept;
  }
  if (name.empty() || digit(name[0]) || prefixed(name)) name = "value_" + name;
  while (name.back() == '_') name.pop_back();
  // The helper functions of the C++ header are called min_of, max_of and so on.
  if (name.ends_with("_of")) name += "_value";
  return name;
}

}  // namespace

bool Names::grab(std::string_view name) {
  const uint64_t hash = hashOf(name);
  if (reserved(hash)) return false;
  const size_t slot = slotOf(taken_, hash);
  if (taken_[slot] != 0) return false;
  take(name);
  return true;
}

void Names::take(std::string_view name) {
  const uint64_t hash = hashOf(name);
  uint64_t& entry = taken_[slotOf(taken_, hash)];
  if (entry != 0) return;
  entry = hash;
  if (++count_ * 2 < taken_.size()) return;
  std::vector<uint64_t> wider(taken_.size() * 2, 0);
  for (const uint64_t old : taken_) {
    if (old != 0) wider[slotOf(wider, old)] = old;
  }
  taken_ = std::move(wider);
}

std::string Names::pick(std::string_view wanted, std::string_view layer) {
  std::string base = cleaned(wanted);
  if (grab(base)) return base;
  // "coat_alpha", but not "coat_coat_alpha": a second one of a layer's own is numbered.
  const bool of_layer =
      base.starts_with(layer) && base.substr(std::min(layer.size(), base.size())).starts_with('_');
  if (!layer.empty() && !of_layer) {
    base = cleaned(fmt::format("{}_{}", layer, base));
    if (grab(base)) return base;
  }
  for (int k = 2;; ++k) {
    std::string name = fmt::format("{}_{}", base, k);
    if (grab(name)) return name;
  }
}

std::string_view layerOf(std::string_view term) { return term.substr(0, term.find('.')); }

}  // namespace lacquer::passes
