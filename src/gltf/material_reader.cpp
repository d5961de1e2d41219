#include "gltf/material_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "gltf/path.h"
#include "gltf/report.h"
#include "gltf/table.h"
#include "gltf/text.h"

namespace lacquer::gltf {

namespace {

/// "a number from 0 to 1", for messages about numbers and elements of arrays.
std::string rangeWords(const Range& range) {
  std::string words = "a number";
  if (std::isfinite(range.min) && std::isfinite(range.max)) {
    words += fmt::format(" from {} to {}", range.min, range.max);
  } else if (std::isfinite(range.min)) {
    words += fmt::format(" of at least {}", range.min);
  }
  if (range.orZero) words += ", or 0";
  return words;
}

class MaterialReader {
public:
  MaterialReader(const FileFacts& file, Material& material)
      : file_(file), material_(material), report_(file.name, material.diagnostics) {}

  void read(const Json& json, const Path& path) {
    extensions_ = member(json, "extensions");
    object<Material>(json, path, "the material", kMaterial, material_, true);
    std::sort(material_.ignored.begin(), material_.ignored.end());
  }

private:
  /// Reads the members of an object in their order. `extensible` is false for an object inside what S stands
  /// for, where S's extensions have no place.
  template <class S>
  void object(const Json& json, const Path& path, std::string_view what, std::span<const Property<S>> rows,
              S& out, bool extensible);
  template <class S>
  void property(const Property<S>& row, const Json& json, const Path& path, S& out);
  template <class S>
  void extensions(const Json& all, const Path& path, S& out, bool extensible);
  template <class S, class P>
  bool extension(const Extension<S, P>& row, const Json& all, std::string_view name, const Json& json,
                 const Path& path, P& out);

  void value(const PropertyFacts& facts, const Json& json, const Path& path, double& out);
  void value(const PropertyFacts& facts, const Json& json, const Path& path, bool& out);
  void value(const PropertyFacts& facts, const Json& json, const Path& path, int& out);
  void value(const PropertyFacts& facts, const Json& json, const Path& path, std::string& out);
  void value(const PropertyFacts& facts, const Json& json, const Path& path, AlphaMode& out);
  void value(const PropertyFacts& facts, const Json& json, const Path& path, Texture& out);
  template <size_t N>
  void value(const PropertyFacts& facts, const Json& json, const Path& path, std::array<double, N>& out);
  void number(const Range& range, std::string_view name, const Json& json, const Path& path, double& out);

  bool admitted(const ExtensionFacts& facts, const Json& all, const Path& path);
  bool replaced(const ExtensionFacts& facts, const Json& all, const Path& path);
  void warnOfTintAndColor(const Json& all, const Path& path);
  void unknownExtension(std::string_view name, const Path& path);
  void unknownProperty(std::string_view name, std::string_view what,
                       const std::vector<std::string_view>& known, const Path& path);

  const FileFacts& file_;
  Material& material_;
  Report report_;
  const Json* extensions_ = nullptr;  ///< the material's own
};

template <class S>
void MaterialReader::object(const Json& json, const Path& path, std::string_view what,
                            std::span<const Property<S>> rows, S& out, bool extensible) {
  constexpr size_t kMostUnknown = 16;  // beyond that the file is something else, and a list helps nobody
  if (!json.is_object()) return report_.wrongType(path, what, json, "an object");
  size_t unknown = 0;
  for (const auto& [name, value] : json.get_ref<const Json::object_t&>()) {
    const Path here(path, name);
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&, &key = name](const auto& r) { return r.facts.name == key; });
    if (row != rows.end()) {
      property(*row, value, here, out);
    } else if (name == "extensions") {
      extensions(value, here, out, extensible);
    } else if (name != "extras" && unknown++ < kMostUnknown) {
      std::vector<std::string_view> known;
      for (const Property<S>& r : rows) known.push_back(r.facts.name);
      unknownProperty(name, what, known, here);
    }
  }
  if (unknown > kMostUnknown) {
    report_.warning("unknown-property", path,
                    fmt::format("{} has {} more unknown properties", what, unknown - kMostUnknown));
  }
  for (const Property<S>& row : rows) {
    if (!row.facts.required || member(json, row.facts.name) != nullptr) continue;
    report_.error("missing-property", path, fmt::format("{} has no \"{}\"", what, row.facts.name),
                  fmt::format("\"{}\" is required", row.facts.name));
  }
}

template <class S>
void MaterialReader::property(const Property<S>& row, const Json& json, const Path& path, S& out) {
  std::visit(
      [&](const auto to) {
        if constexpr (std::is_same_v<std::remove_const_t<decltype(to)>, std::monostate>) {
          object<S>(json, path, row.facts.name, row.nested, out, false);
        } else {
          value(row.facts, json, path, out.*to);
        }
      },
      row.member);
}

void MaterialReader::number(const Range& range, std::string_view name, const Json& json, const Path& path,
                            double& out) {
  if (!json.is_number()) return report_.wrongType(path, name, json, rangeWords(range));
  out = json.get<double>();
  if (out == 0 && range.orZero) return;
  if (out < range.min || out > range.max) {
    report_.error("out-of-range", path, fmt::format("{} is {}", name, out),
                  fmt::format("it must be {}", rangeWords(range)));
  } else if (std::abs(out) > static_cast<double>(std::numeric_limits<float>::max())) {
    report_.error("out-of-range", path, fmt::format("{} is {}", name, out),
                  "it must fit a 32-bit float: at most about 3.4e38");
  } else if (out > range.tested) {
    report_.warning("beyond-tested-range", path, fmt::format("{} is {}", name, out),
                    fmt::format("it is valid, but Lacquer is only tested up to {}", range.tested));
  }
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, double& out) {
  number(facts.range, facts.name, json, path, out);
}

template <size_t N>
void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path,
                           std::array<double, N>& out) {
  if (!json.is_array())
    return report_.wrongType(path, facts.name, json, fmt::format("an array of {} numbers", N));
  if (json.size() != N) {
    return report_.error("wrong-length", path,
                         fmt::format("{} has {}", facts.name, countOf(json.size(), "element")),
                         fmt::format("it must have {}", N));
  }
  for (size_t i = 0; i < N; ++i) {
    number(facts.range, fmt::format("{}[{}]", facts.name, i), json[i], Path(path, i), out[i]);
  }
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, bool& out) {
  if (!json.is_boolean()) return report_.wrongType(path, facts.name, json, "true or false");
  out = json.get<bool>();
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, std::string& out) {
  if (!json.is_string()) return report_.wrongType(path, facts.name, json, "a string");
  out = json.get_ref<const std::string&>();
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, int& out) {
  if (facts.kind == Kind::TextureIndex) {
    report_.index(path, facts.name, json, file_.textureImages.size(), "texture", out);
    return;
  }
  constexpr int kSets = std::tuple_size_v<decltype(VertexAttributes::texCoord)>;
  const std::optional<double> whole = report_.wholeNumber(path, facts.name, json, "a whole number");
  if (!whole) return;
  if (*whole < 0 || *whole >= kSets) {
    return report_.error("out-of-range", path, fmt::format("{} is {}", facts.name, *whole),
                         fmt::format("Lacquer supports {} UV sets: use 0 to {}", kSets, kSets - 1));
  }
  out = static_cast<int>(*whole);
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, AlphaMode& out) {
  static constexpr std::string_view kNames[] = {"OPAQUE", "MASK", "BLEND"};  // in the enum's order
  if (!json.is_string()) return report_.wrongType(path, facts.name, json, "a string");
  const auto& name = json.get_ref<const std::string&>();
  const auto found = std::find(std::begin(kNames), std::end(kNames), name);
  if (found != std::end(kNames)) {
    out = static_cast<AlphaMode>(found - std::begin(kNames));
    return;
  }
  const std::string_view meant = closest(name, kNames);
  report_.error("unknown-value", path, fmt::format("{} is {}", facts.name, quote(name)),
                meant.empty() ? fmt::format("it must be {}", listOf(kNames, "or"))
                              : fmt::format("did you mean {}?", quote(meant)));
}

void MaterialReader::value(const PropertyFacts& facts, const Json& json, const Path& path, Texture& out) {
  if (!json.is_object()) return report_.wrongType(path, facts.name, json, "an object with an index");
  TextureInfo info;
  info.pointer = path.text();
  object<TextureInfo>(json, path, facts.name, textureInfoRows(facts.kind), info, true);
  if (info.texture >= 0) info.image = file_.textureImages[static_cast<size_t>(info.texture)];
  out = std::move(info);
}

template <class S>
void MaterialReader::extensions(const Json& all, const Path& path, S& out, bool extensible) {
  if (!all.is_object()) return report_.wrongType(path, "extensions", all, "an object");
  for (const auto& [name, json] : all.get_ref<const Json::object_t&>()) {
    const Path here(path, name);
    const auto tryRow = [&, &key = name, &object = json](const auto& row) {
      return extension(row, all, key, object, here, out);
    };
    const auto tryRows = [&](const auto&... row) { return (tryRow(row) || ...); };
    if (!extensible || !std::apply(tryRows, extensionsOf<S>())) unknownExtension(name, here);
  }
}

/// Reads `json` if the row is about an extension of that name, and says whether it is.
template <class S, class P>
bool MaterialReader::extension(const Extension<S, P>& row, const Json& all, std::string_view name,
                               const Json& json, const Path& path, P& out) {
  const ExtensionFacts& facts = row.facts;
  const bool draft = !facts.draft.empty() && name == facts.draft;
  if (name != facts.name && !draft) return false;
  if (draft) {
    const bool both = member(all, facts.name) != nullptr;
    report_.note("draft-extension", path,
                 both ? fmt::format("{} is ignored: {} is also there", name, facts.name)
                      : fmt::format("{} is read as {}", name, facts.name),
                 fmt::format("{} is a draft's name for {}", name, facts.name));
    if (both) return true;
  }
  if (!admitted(facts, all, path)) return true;
  const bool unused = replaced(facts, all, path);
  if (facts.name == kNameTint && !unused) warnOfTintAndColor(all, path);
  S object{};
  this->object<S>(json, path, name, row.properties, object, true);
  if (!unused) row.store(out, std::move(object));
  return true;
}

/// False when the extension must be left out because of what else is there (with --permissive).
bool MaterialReader::admitted(const ExtensionFacts& facts, const Json& all, const Path& path) {
  if (!facts.parent.empty() && member(all, facts.parent) == nullptr) {
    report_.error("misplaced-extension", path, fmt::format("{} needs {}", facts.name, facts.parent),
                  fmt::format("add {} to the material's extensions, beside it", facts.parent));
  }
  if (!facts.exclusive) return true;
  bool admitted = true;
  for (const std::string_view other : kExclusions) {
    if (member(all, other) == nullptr) continue;
    if (file_.permissive) {
      admitted = false;
      report_.warning("excluded-extension", path,
                      fmt::format("{} is dropped: it must not be used together with {}", facts.name, other));
    } else {
      report_.error("excluded-extension", path,
                    fmt::format("{} must not be used together with {}", facts.name, other),
                    "remove one of them, or use --permissive to drop the coat");
    }
  }
  return admitted;
}

bool MaterialReader::replaced(const ExtensionFacts& facts, const Json& all, const Path& path) {
  if (facts.replacer.empty() || member(all, facts.replacer) == nullptr) return false;
  report_.note("replaced-extension", path,
               fmt::format("{} is not used: {} takes precedence", facts.name, facts.replacer));
  return true;
}

void MaterialReader::warnOfTintAndColor(const Json& all, const Path& path) {
  const Json* clearcoat = member(all, kNameClearcoat);
  const Json* inside = clearcoat == nullptr ? nullptr : member(*clearcoat, "extensions");
  if (inside == nullptr) return;
  const ExtensionFacts& color = std::get<0>(kClearcoatExtensions).facts;
  if (member(*inside, color.name) == nullptr && member(*inside, color.draft) == nullptr) return;
  report_.warning("tint-and-color", path,
                  fmt::format("{} has no effect: {} wins over it", kNameTint, color.name),
                  "keep only one of them");
}

void MaterialReader::unknownExtension(std::string_view name, const Path& path) {
  const ExtensionPlace place = placeOf(name);
  if (place.where.empty()) {
    material_.ignored.push_back(path.text());
    return;
  }
  std::string help = fmt::format("move it to {}", place.where);
  if (place.now != name) help += fmt::format(", as {}", place.now);
  const bool in_clearcoat = place.where.starts_with(kNameClearcoat);
  if (in_clearcoat && (extensions_ == nullptr || member(*extensions_, kNameClearcoat) == nullptr))
    help += fmt::format(" ({} is missing too)", kNameClearcoat);
  report_.error("misplaced-extension", path, fmt::format("{} has no place here", name), std::move(help));
}

void MaterialReader::unknownProperty(std::string_view name, std::string_view what,
                                     const std::vector<std::string_view>& known, const Path& path) {
  std::string help;
  if (const std::string_view meant = closest(name, known); !meant.empty()) {
    help = fmt::format("did you mean {}?", quote(meant));
  } else if (known.empty()) {
    help = "it has no properties";
  } else {
    help = fmt::format("its properties are {}", listOf(known));
  }
  report_.warning("unknown-property", path, fmt::format("{} has no property {}", what, quote(name)),
                  std::move(help));
}

}  // namespace

Material readMaterial(const Json& json, size_t index, const FileFacts& file) {
  Material material;
  material.index = static_cast<int>(index);
  const Path root;
  const Path materials(root, "materials");
  MaterialReader(file, material).read(json, Path(materials, index));
  return material;
}

}  // namespace lacquer::gltf
