#include "ir/names.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>

namespace lacquer::ir {

namespace {

/// Keywords, types, built-in functions and macros of the targets that could be taken for a local's name and
/// follow no rule below.
constexpr std::string_view kReserved =
    "EOF FALSE HUGE_VAL INFINITY M_E M_PI NAN NULL TRUE abort abs acos acosh active alignas alignof all and "
    "and_eq any asdouble asfloat asin asinh asint "
    "asm assert asuint atan atan2 atanh atomic_uint attribute auto barrier bitCount bitand "
    "bitfieldExtract bitfieldInsert bitfieldReverse bitor blendstate bool break buffer case cast catch "
    "cbuffer ceil centroid char char16_t char32_t clamp class clip coherent column_major common compile "
    "compileshader compl computeshader const const_cast constexpr continue cos cosh countbits cross dFdx "
    "dFdxCoarse dFdxFine dFdy dFdyCoarse dFdyFine ddx ddx_coarse ddx_fine ddy ddy_coarse ddy_fine "
    "decltype default degrees delete determinant devicecoherent discard distance do domainshader dot "
    "dot2add dot4add_i8packed dot4add_u8packed double dst dword dynamic_cast else enum equal errno "
    "errorf exp exp2 explicit export extern external f16tof32 f32tof16 faceforward false filter findLSB "
    "findMSB firstbithigh firstbitlow fixed flat float float16_t float2 float3 float32_t float4 "
    "float64_t floatBitsToInt floatBitsToUint floor fma fmod for frac fract frexp friend ftransform "
    "fvec2 fvec3 fvec4 fwidth fwidthCoarse fwidthFine geometryshader globallycoherent goto greaterThan "
    "greaterThanEqual groupMemoryBarrier groupshared half highp hullshader hvec2 hvec3 hvec4 if image "
    "imulExtended in inline inout input int int16_t int32_t int64_t intBitsToFloat interface "
    "interpolateAtCentroid interpolateAtOffset interpolateAtSample invariant inverse inversesqrt "
    "isampler2D isfinite isinf isnan layout ldexp length lerp less lessThan lessThanEqual line lineadj "
    "linear linux lit log log10 log2 long lowp mad main mat2 mat3 mat4 matrix matrixCompMult max mediump "
    "memoryBarrier min min10float min12int min16float min16int min16uint mix mod modf msad4 mul mutable "
    "namespace new noexcept noinline nointerpolation noise noise1 noise2 noise3 noise4 noperspective "
    "normalize not notEqual not_eq nullptr operator or or_eq out outerProduct output packDouble2x32 "
    "packHalf2x16 packSnorm2x16 packSnorm4x8 packUnorm2x16 packUnorm4x8 packoffset partition pass patch "
    "pixelfragment pixelshader point pow precise precision printf private protected public radians rcp "
    "readonly reflect refract register reinterpret_cast resource restrict return reversebits round "
    "roundEven row_major rsqrt sample sampler sampler1D sampler2D sampler3D samplerCUBE samplerCube "
    "sampler_state saturate shadow1D shadow2D shared short sign signed signgam sin sincos sinh size_t "
    "sizeof smooth smoothstep snorm sqrt stateblock static static_assert static_cast stderr stdin stdout "
    "step string struct subroutine superp switch tan tanh tbuffer technique template tex1D tex1Dbias "
    "tex1Dgrad tex1Dlod tex1Dproj tex2D tex2Dbias tex2Dgrad tex2Dlod tex2Dproj tex3D tex3Dbias tex3Dgrad "
    "tex3Dlod tex3Dproj texCUBE texCUBEbias texCUBEgrad texCUBElod texCUBEproj texture textureLod this "
    "thread_local throw transpose triangle triangleadj true trunc try typedef typeid typename uaddCarry "
    "uint uint16_t uint32_t uint64_t uintBitsToFloat umulExtended uniform union unix unorm "
    "unpackDouble2x32 unpackHalf2x16 unpackSnorm2x16 unpackSnorm4x8 unpackUnorm2x16 unpackUnorm4x8 "
    "unsigned usampler2D using usubBorrow varying vec2 vec3 vec4 vector vertexfragment vertexshader "
    "virtual void volatile wchar_t while workgroupcoherent writeonly xor xor_eq ";

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
  constexpr size_t kSlots = 2048;
  static_assert(std::count(kReserved.begin(), kReserved.end(), ' ') * 2 < static_cast<ptrdiff_t>(kSlots));
  static const auto kTable = [] {
    std::array<uint64_t, kSlots> table{};
    for (std::string_view rest = kReserved; !rest.empty();) {
      const uint64_t word = hashOf(rest.substr(0, rest.find(' ')));
      table[slotOf(table, word)] = word;
      rest.remove_prefix(rest.find(' ') + 1);
    }
    return table;
  }();
  return kTable[slotOf(kTable, hash)] != 0;
}

/// The printers' own prefixes: attributes, varyings, outputs and what languages keep for themselves.
bool prefixed(std::string_view name) {
  using namespace std::string_view_literals;
  constexpr std::array kPrefixes = {"in_"sv, "v_"sv, "out_"sv, "gl_"sv, "lacquer_"sv, "_"sv};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&](std::string_view p) { return p[0] == name[0] && name.starts_with(p); });
}

// Classes of characters in names, in every locale the same.
constexpr uint8_t kPlain = 1, kUnderscore = 2, kMark = 4;  // a mark is a digit or a capital

uint8_t classOf(char c) {
  static constexpr auto kClasses = [] {
    std::array<uint8_t, 256> classes{};
    for (int i = 0; i < 128; ++i) {
      const bool mark = (i >= 'A' && i <= 'Z') || (i >= '0' && i <= '9');
      const bool plain = mark || (i >= 'a' && i <= 'z') || i == '_';
      classes[static_cast<size_t>(i)] =
          static_cast<uint8_t>((plain ? kPlain : 0) | (i == '_' ? kUnderscore : 0) | (mark ? kMark : 0));
    }
    return classes;
  }();
  return kClasses[static_cast<unsigned char>(c)];
}

bool digit(char c) { return c >= '0' && c <= '9'; }
bool capital(char c) { return c >= 'A' && c <= 'Z'; }

/// Types by rule: "float4x4", "uint2", "dmat3", "isampler2DArray"; functions: "textureLod", "imageStore".
bool typed(std::string_view name) {
  using namespace std::string_view_literals;
  constexpr std::array kNumbered = {"bool"sv,     "int"sv,       "uint"sv,       "dword"sv,      "half"sv,
                                    "float"sv,    "double"sv,    "min16float"sv, "min10float"sv, "min16int"sv,
                                    "min12int"sv, "min16uint"sv, "vec"sv,        "ivec"sv,       "uvec"sv,
                                    "bvec"sv,     "dvec"sv,      "mat"sv,        "dmat"sv};
  constexpr std::array kFamilies = {"texture"sv, "sampler"sv, "isampler"sv, "usampler"sv, "image"sv,
                                    "iimage"sv,  "uimage"sv,  "subpass"sv,  "atomic"sv};
  // Each is lower case up to its number or its capital: one comparison with the longest head that there can
  // be.
  const auto end = std::find_if(name.begin(), name.end(), [](char c) { return capital(c) || digit(c); });
  if (end == name.end()) return false;
  const std::string_view head = name.substr(0, static_cast<size_t>(end - name.begin()));
  const auto family = [&](std::string_view one) { return one == head; };
  if (std::any_of(kFamilies.begin(), kFamilies.end(), family)) return true;
  const auto numbered = [&](std::string_view type) {
    if (!name.starts_with(type)) return false;
    const std::string_view rest = name.substr(type.size());
    return (rest.size() == 1 && digit(rest[0])) ||
           (rest.size() == 3 && digit(rest[0]) && rest[1] == 'x' && digit(rest[2]));
  };
  return digit(name.back()) && std::any_of(kNumbered.begin(), kNumbered.end(), numbered);
}

/// Whether cleaned() leaves a name as it is; of few names that it leaves, false.
bool clean(std::string_view name) {
  uint8_t all = kPlain, any = 0, twice = 0, before = 0;
  for (const char c : name) {
    const uint8_t one = classOf(c);
    all &= one;
    any |= one;
    twice |= one & before & kUnderscore;
    before = one;
  }
  if (name.empty() || all == 0 || twice != 0 || (before & kUnderscore) != 0 || (any & kMark) != 0)
    return false;
  return !prefixed(name) && !name.ends_with("_of");
}

/// The name with only characters that every target takes, and none of the printers' prefixes.
std::string cleaned(std::string_view wanted) {
  constexpr size_t kLongest = 64;  // a compiler may stop at 255, with all that is put around it
  wanted = wanted.substr(0, kLongest);
  if (clean(wanted)) return std::string(wanted);
  std::string name(wanted);
  // Two underscores in a row are reserved in GLSL.
  size_t length = 0;
  for (const char c : wanted) {
    const char kept = (classOf(c) & kPlain) != 0 ? c : '_';
    if (kept != '_' || length == 0 || name[length - 1] != '_') name[length++] = kept;
  }
  name.resize(length);
  if (name.empty() || digit(name[0]) || prefixed(name) || typed(name))
    name = (name.starts_with('_') ? "value" : "value_") + name;
  while (name.back() == '_') name.pop_back();
  // The helper functions of the C++ header are called min_of, max_of and so on.
  if (name.ends_with("_of")) name += "_value";
  return name;
}

}  // namespace

bool Names::grab(std::string_view name) {
  const uint64_t hash = hashOf(name);
  if (reserved(hash)) return false;
  return take(hash);
}

bool Names::taken(std::string_view name) const { return taken_[slotOf(taken_, hashOf(name))] != 0; }

void Names::take(std::string_view name) { take(hashOf(name)); }

bool Names::take(uint64_t hash) {
  uint64_t& entry = taken_[slotOf(taken_, hash)];
  if (entry != 0) return false;
  entry = hash;
  if (++count_ * 2 < taken_.size()) return true;
  std::vector<uint64_t> wider(taken_.size() * 2, 0);
  for (const uint64_t old : taken_) {
    if (old != 0) wider[slotOf(wider, old)] = old;
  }
  taken_ = std::move(wider);
  return true;
}

std::string Names::pick(std::string_view wanted, std::string_view layer) {
  std::string base = cleaned(wanted);
  if (grab(base)) return base;
  // "coat_alpha", but not "coat_coat_alpha": a second one of a layer's own is numbered.
  const bool of_layer =
      base.starts_with(layer) && base.substr(std::min(layer.size(), base.size())).starts_with('_');
  if (!layer.empty() && !of_layer) {
    base = cleaned(std::string(layer) + '_' + base);
    if (grab(base)) return base;
  }
  // Numbers below have been tried, and no name becomes free again.
  uint32_t& number = next_.try_emplace(hashOf(base), 2).first->second;
  while (true) {
    std::string name = base + '_' + std::to_string(number++);
    if (grab(name)) return name;
  }
}

std::string_view layerOf(std::string_view term) { return term.substr(0, term.find('.')); }

}  // namespace lacquer::ir
