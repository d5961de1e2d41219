#include "material/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::material {

using json::Json;
using json::member;
using json::Path;
using lang::ExtensionDecl;
using lang::PropertyDecl;

namespace {

constexpr std::string_view kTransform = "KHR_texture_transform";
constexpr std::string_view kProcedurals = "KHR_texture_procedurals";

/// "a number from 0 to 1", for messages about numbers and elements of arrays.
std::string rangeWords(const PropertyDecl& decl) {
  std::string words = "a number";
  const double least = decl.range.gap > 0 ? decl.range.gap : decl.range.lo;
  if (std::isfinite(least) && std::isfinite(decl.range.hi)) {
    words += fmt::format(" from {} to {}", least, decl.range.hi);
  } else if (std::isfinite(least)) {
    words += fmt::format(" of at least {}", least);
  }
  if (decl.range.gap > 0) words += ", or 0";
  return words;
}

class MaterialReader {
public:
  MaterialReader(const Schema& schema, const FileFacts& file, Material& material)
      : schema_(schema), file_(file), material_(material), report_(file.name, material.diagnostics) {}

  void read(const Json& json, const Path& path) {
    extensions_ = member(json, "extensions");
    const Here here{schema_.extensions[0]->name, true, true};
    object(json, path, "the material", schema_.extensions[0]->properties, here,
           [&](const PropertyDecl& decl, const Json& value, const Path& at) {
             property(decl, value, at, true);
           });
    std::sort(material_.ignored.begin(), material_.ignored.end());
    std::sort(material_.extensions.begin(), material_.extensions.end());
  }

private:
  /// What an object may have beside its properties.
  struct Here {
    std::string_view extension;  ///< those of this one may stand in its `extensions`
    bool extensible = true;      ///< any may
    bool named = false;          ///< a `name`
    bool texture = false;        ///< a textureInfo: index, texCoord and KHR_texture_transform
  };

  template <class Value>
  void object(const Json& json, const Path& path, std::string_view what, std::span<const PropertyDecl> rows,
              const Here& here, Value value);
  bool structure(std::string_view name, const Json& json, const Path& path, const Here& here);
  std::vector<std::string_view> known(std::span<const PropertyDecl> rows, const Here& here) const;
  void property(const PropertyDecl& decl, const Json& json, const Path& path, bool used);
  void extensions(const Json& all, const Path& path, const Here& here);
  void extension(uint16_t index, const Json& all, std::string_view name, const Json& json, const Path& path);

  bool value(const PropertyDecl& decl, const Json& json, const Path& path, ir::Components& out);
  bool choice(const PropertyDecl& decl, const Json& json, const Path& path, ir::Components& out);
  void number(const PropertyDecl& decl, std::string_view name, const Json& json, const Path& path,
              double& out);
  void texture(const PropertyDecl& decl, const Json& json, const Path& path, bool used);
  void unusedChannels(const PropertyDecl& decl, const gltf::TextureInfo& info, const Path& path);
  void texCoord(std::string_view name, const Json& json, const Path& path, int& out);
  void transform(const Json& json, const Path& path);
  void procedural(const Json& json, const Path& path);

  bool admitted(const ExtensionDecl& decl, const Json& all, const Path& path);
  bool overruled(const ExtensionDecl& decl, const Path& path);
  bool there(std::string_view extension) const;
  void unknownExtension(std::string_view name, const Path& path);
  void unknownProperty(std::string_view name, std::string_view what,
                       const std::vector<std::string_view>& known, const Path& path);

  const Schema& schema_;
  const FileFacts& file_;
  Material& material_;
  json::Report report_;
  const Json* extensions_ = nullptr;      ///< the material's own
  gltf::TextureInfo* texture_ = nullptr;  ///< the one that is read
  bool used_ = true;                      ///< what is read has an effect
};

template <class Value>
void MaterialReader::object(const Json& json, const Path& path, std::string_view what,
                            std::span<const PropertyDecl> rows, const Here& here, Value value) {
  constexpr size_t kMostUnknown = 16;  // beyond that the file is something else, and a list helps nobody
  if (!json.is_object()) return report_.wrongType(path, what, json, "an object");
  size_t unknown = 0;
  for (const auto& [name, element] : json.items()) {
    const Path at(path, name);
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&, &key = name](const PropertyDecl& r) { return r.name == key; });
    if (row != rows.end()) {
      value(*row, element, at);
    } else if (!structure(name, element, at, here) && name != "extras" && unknown++ < kMostUnknown) {
      unknownProperty(name, what, known(rows, here), at);
    }
  }
  if (unknown > kMostUnknown) {
    report_.warning("unknown-property", path,
                    fmt::format("{} has {} more unknown properties", what, unknown - kMostUnknown));
  }
}

/// What glTF's structure says of an object, whatever is declared.
bool MaterialReader::structure(std::string_view name, const Json& json, const Path& path, const Here& here) {
  if (name == "extensions") {
    extensions(json, path, here);
  } else if (here.named && name == "name") {
    if (json.is_string())
      material_.name = json::text(json);
    else
      report_.wrongType(path, name, json, "a string");
  } else if (here.texture && name == "index") {
    report_.index(path, name, json, file_.scene.textures.size(), "texture", texture_->texture);
  } else if (here.texture && name == "texCoord") {
    texCoord(name, json, path, texture_->texCoord);
  } else {
    return false;
  }
  return true;
}

std::vector<std::string_view> MaterialReader::known(std::span<const PropertyDecl> rows,
                                                    const Here& here) const {
  std::vector<std::string_view> names;
  if (here.named) names.emplace_back("name");
  if (here.texture) names.insert(names.end(), {"index", "texCoord"});
  for (const PropertyDecl& row : rows) names.push_back(row.name);
  return names;
}

void MaterialReader::property(const PropertyDecl& decl, const Json& json, const Path& path, bool used) {
  if (decl.kind == Kind::Object) {
    const auto inner = [&](const PropertyDecl& one, const Json& element, const Path& at) {
      property(one, element, at, used);
    };
    return object(json, path, decl.name, decl.members, {{}, false}, inner);
  }
  if (decl.kind == Kind::Texture) return texture(decl, json, path, used);
  ir::Components out = decl.default_value.value_or(ir::Components{});
  if (value(decl, json, path, out) && used) material_.numbers.push_back({schema_.indexOf(decl), out});
}

// -- values --

void MaterialReader::number(const PropertyDecl& decl, std::string_view name, const Json& json,
                            const Path& path, double& out) {
  if (!json.is_number()) return report_.wrongType(path, name, json, rangeWords(decl));
  out = json.get<double>();
  if (!decl.range.contains(out)) {
    report_.error("out-of-range", path, fmt::format("{} is {}", name, out),
                  fmt::format("it must be {}", rangeWords(decl)));
  } else if (std::abs(out) > static_cast<double>(std::numeric_limits<float>::max())) {
    report_.error("out-of-range", path, fmt::format("{} is {}", name, out),
                  "it must fit a 32-bit float: at most about 3.4e38");
  } else if (decl.tested && out > *decl.tested) {
    report_.warning("beyond-tested-range", path, fmt::format("{} is {}", name, out),
                    fmt::format("it is valid, but Lacquer is only tested up to {}", *decl.tested));
  }
}

bool MaterialReader::choice(const PropertyDecl& decl, const Json& json, const Path& path,
                            ir::Components& out) {
  if (!json.is_string()) return report_.wrongType(path, decl.name, json, "a string"), false;
  const auto& name = json::text(json);
  const auto found = std::find(decl.choices.begin(), decl.choices.end(), name);
  if (found != decl.choices.end()) {
    out[0] = static_cast<double>(found - decl.choices.begin());
    return true;
  }
  const std::string_view meant = closest(name, decl.choices);
  report_.error("unknown-value", path, fmt::format("{} is {}", decl.name, quote(name)),
                meant.empty() ? fmt::format("it must be {}", listOf(decl.choices, "or"))
                              : fmt::format("did you mean {}?", quote(meant)));
  return false;
}

bool MaterialReader::value(const PropertyDecl& decl, const Json& json, const Path& path,
                           ir::Components& out) {
  if (decl.kind == Kind::Choice) return choice(decl, json, path, out);
  if (decl.kind == Kind::Bool) {
    if (!json.is_boolean()) return report_.wrongType(path, decl.name, json, "true or false"), false;
    out[0] = json.get<bool>() ? 1 : 0;
    return true;
  }
  const auto count = static_cast<size_t>(ir::componentCount(decl.type));
  if (count == 1) {
    number(decl, decl.name, json, path, out[0]);
    return true;
  }
  if (!json.is_array())
    return report_.wrongType(path, decl.name, json, fmt::format("an array of {} numbers", count)), false;
  if (json.size() != count) {
    report_.error("wrong-length", path, fmt::format("{} has {}", decl.name, countOf(json.size(), "element")),
                  fmt::format("it must have {}", count));
    return false;
  }
  for (size_t i = 0; i < count; ++i) {
    number(decl, fmt::format("{}[{}]", decl.name, i), json[i], Path(path, i), out[i]);
  }
  return true;
}

void MaterialReader::texCoord(std::string_view name, const Json& json, const Path& path, int& out) {
  constexpr int kSets = std::tuple_size_v<decltype(gltf::VertexAttributes::texCoord)>;
  const std::optional<double> whole = report_.wholeNumber(path, name, json, "a whole number");
  if (!whole) return;
  if (*whole < 0 || *whole >= kSets) {
    return report_.error("out-of-range", path, fmt::format("{} is {}", name, *whole),
                         fmt::format("Lacquer supports {} UV sets: use 0 to {}", kSets, kSets - 1));
  }
  out = static_cast<int>(*whole);
}

void MaterialReader::texture(const PropertyDecl& decl, const Json& json, const Path& path, bool used) {
  if (!json.is_object()) return report_.wrongType(path, decl.name, json, "an object with an index");
  gltf::TextureInfo info;
  info.pointer = path.text();
  for (const PropertyDecl& one : decl.members)
    info.members.push_back(one.default_value.value_or(ir::Components{})[0]);
  texture_ = &info;
  const auto read = [&](const PropertyDecl& one, const Json& element, const Path& at) {
    number(one, one.name, element, at, info.members[static_cast<size_t>(&one - decl.members.data())]);
  };
  object(json, path, decl.name, decl.members, {{}, true, false, true}, read);
  texture_ = nullptr;
  if (member(json, "index") == nullptr && info.group.empty()) {
    report_.error("missing-property", path, fmt::format("{} has no \"index\"", decl.name),
                  "\"index\" is required");
  }
  if (info.texture >= 0) {
    const gltf::Texture& of = file_.scene.textures[static_cast<size_t>(info.texture)];
    info.image = of.image();
    info.channels = of.channels();
    info.sampler = of;
    unusedChannels(decl, info, path);
  }
  if (used) material_.textures.push_back({schema_.indexOf(decl), std::move(info)});
}

/// Channels that the declaration reads and the texture leaves unused.
void MaterialReader::unusedChannels(const PropertyDecl& decl, const gltf::TextureInfo& info,
                                    const Path& path) {
  constexpr std::string_view kLetters = "rgba";
  constexpr std::string_view kNames[] = {"red", "green", "blue", "alpha"};
  std::vector<std::string_view> unused;
  for (size_t c = 0; c < kLetters.size(); ++c) {
    const bool read = decl.channels.find(kLetters[c]) != std::string_view::npos;
    if (read && info.channels[c] == gltf::kUnused) unused.push_back(kNames[c]);
  }
  if (unused.empty()) return;
  report_.warning("unused-channel", path,
                  fmt::format("{} reads {}, which texture {} leaves unused", decl.name, listOf(unused, "and"),
                              info.texture),
                  "1 is taken, as without a texture");
}

/// KHR_texture_transform belongs to glTF's structure: any textureInfo may have it.
void MaterialReader::transform(const Json& json, const Path& path) {
  gltf::TextureTransform out;
  static const std::vector<PropertyDecl> kRows = [] {
    constexpr std::pair<std::string_view, ir::Type> kNames[] = {{"offset", ir::Type::Vec2},
                                                                {"rotation", ir::Type::Float},
                                                                {"scale", ir::Type::Vec2},
                                                                {"texCoord", ir::Type::Int}};
    std::vector<PropertyDecl> rows;
    for (const auto& [name, type] : kNames) {
      PropertyDecl& row = rows.emplace_back();
      row.name = name;
      row.type = type;
    }
    return rows;
  }();
  gltf::TextureInfo& info = *texture_;
  object(json, path, kTransform, kRows, {{}, false},
         [&](const PropertyDecl& row, const Json& element, const Path& at) {
           if (row.type == ir::Type::Int) return texCoord(row.name, element, at, info.texCoord);
           const bool scale = row.name == "scale";
           ir::Components read{scale ? 1.0 : 0.0, scale ? 1.0 : 0.0};
           if (!value(row, element, at, read)) return;
           if (row.type == ir::Type::Float)
             out.rotation = read[0];
           else
             (scale ? out.scale : out.offset) = {read[0], read[1]};
         });
  info.transform = out;
}

/// What computes the texel in the texture's place. Where that cannot be, the texture is taken; it is an error
/// where the file requires the extension.
void MaterialReader::procedural(const Json& json, const Path& path) {
  const std::vector<materialx::Procedural>& list = file_.procedurals->list;
  const auto fallback = [&](const Path& at, std::string message, const std::string& help = {}) {
    const std::string taken = help.empty() ? "the texture is taken" : help + ": the texture is taken";
    if (file_.procedurals->required)
      report_.error("procedural-fallback", at, std::move(message), help);
    else
      report_.warning("procedural-fallback", at, std::move(message), taken);
  };
  if (!json.is_object())
    return fallback(path, fmt::format("{} is {}", kProcedurals, json::describe(json)),
                    "it must be an object");
  const Json* number = member(json, "index");
  if (number == nullptr) return fallback(path, fmt::format("{} has no \"index\"", kProcedurals));
  const bool whole = number->is_number_unsigned();
  if (!whole || number->get<uint64_t>() >= list.size())
    return fallback(Path(path, "index"),
                    number->is_number()
                        ? fmt::format("there is no procedural {}", printable(json::dump(*number)))
                        : fmt::format("index is {}", json::describe(*number)),
                    fmt::format("the file has {}", countOf(list.size(), "procedural")));
  const auto index = static_cast<size_t>(number->get<uint64_t>());
  const materialx::Procedural& one = list[index];
  // Its own error says so, too.
  if (one.wrong) return fallback(path, fmt::format("the procedural {} is wrong", index));
  std::vector<std::string_view> names;
  for (const auto& [name, group] : one.outputs) names.push_back(name);
  const Json* named = member(json, "output");
  std::string wanted = named != nullptr && named->is_string() ? json::text(*named) : std::string();
  // Its number, too: its place among the outputs.
  if (named != nullptr && named->is_number_unsigned() && named->get<uint64_t>() < names.size())
    wanted = names[named->get<uint64_t>()];
  const std::string has = names.empty() ? "it has none" : fmt::format("it has {}", listOf(names));
  if (named == nullptr && names.size() > 1)
    return fallback(path, fmt::format("the procedural {} has several outputs, and none is named", index),
                    has);
  const bool some = named == nullptr || !wanted.empty();
  const std::string_view output = some ? one.output(wanted) : std::string_view();
  if (output.empty()) {
    const std::string of =
        named == nullptr || named->is_string() ? quote(wanted) : printable(json::dump(*named));
    return fallback(path, fmt::format("the procedural {} has no output {}", index, of), has);
  }
  texture_->group = one.group;
  texture_->output = output;
}

// -- extensions --

void MaterialReader::extensions(const Json& all, const Path& path, const Here& here) {
  if (!all.is_object()) return report_.wrongType(path, "extensions", all, "an object");
  for (const auto& [name, json] : all.items()) {
    const Path at(path, name);
    const std::optional<uint16_t> index = schema_.find(name);
    if (here.texture && name == kTransform) {
      transform(json, at);
    } else if (here.texture && name == kProcedurals && file_.procedurals != nullptr) {
      procedural(json, at);
    } else if (here.extensible && !here.texture && index && *index != 0 &&
               schema_.extensions[*index]->inside == (here.named ? std::string_view{} : here.extension)) {
      extension(*index, all, name, json, at);
    } else {
      unknownExtension(name, at);
    }
  }
}

void MaterialReader::extension(uint16_t index, const Json& all, std::string_view name, const Json& json,
                               const Path& path) {
  const ExtensionDecl& decl = *schema_.extensions[index];
  if (name != decl.name) {
    const bool both = member(all, decl.name) != nullptr;
    report_.note("draft-extension", path,
                 both ? fmt::format("{} is ignored: {} is also there", name, decl.name)
                      : fmt::format("{} is read as {}", name, decl.name),
                 fmt::format("{} is a draft's name for {}", name, decl.name));
    if (both) return;
  }
  if (!admitted(decl, all, path)) return;
  const bool outer = used_;
  used_ = !overruled(decl, path) && outer;
  if (used_) material_.extensions.push_back(index);
  const Here here{decl.name, true};
  const auto read = [&](const PropertyDecl& one, const Json& element, const Path& at) {
    property(one, element, at, used_);
  };
  object(json, path, name, decl.properties, here, read);
  used_ = outer;
}

/// False when the extension must be left out because of what else is there (with --permissive).
bool MaterialReader::admitted(const ExtensionDecl& decl, const Json& all, const Path& path) {
  for (const std::string_view other : decl.needs) {
    if (there(other)) continue;
    report_.error("misplaced-extension", path, fmt::format("{} needs {}", decl.name, other),
                  fmt::format("add {} to the material's extensions, beside it", other));
  }
  bool admitted = true;
  for (const std::string_view other : decl.excludes) {
    if (member(all, other) == nullptr) continue;
    if (file_.permissive) {
      admitted = false;
      report_.warning("excluded-extension", path,
                      fmt::format("{} is dropped: it must not be used together with {}", decl.name, other));
    } else {
      report_.error("excluded-extension", path,
                    fmt::format("{} must not be used together with {}", decl.name, other),
                    fmt::format("remove one of them, or use --permissive to drop {}", decl.name));
    }
  }
  return admitted;
}

/// Whether another extension takes its place; it is read and checked all the same.
bool MaterialReader::overruled(const ExtensionDecl& decl, const Path& path) {
  for (const std::string_view other : decl.yields_to) {
    if (!there(other)) continue;
    report_.note("replaced-extension", path,
                 fmt::format("{} is not used: {} takes precedence", decl.name, other));
    return true;
  }
  for (const std::string_view other : decl.loses_to) {
    if (!there(other)) continue;
    report_.warning("overruled-extension", path,
                    fmt::format("{} has no effect: {} wins over it", decl.name, other),
                    "keep only one of them");
    return true;
  }
  return false;
}

/// Whether the material has an extension of that name, or of a draft's, at its place.
bool MaterialReader::there(std::string_view extension) const {
  const std::optional<uint16_t> index = schema_.find(extension);
  const Json* all = extensions_;
  if (index && !schema_.extensions[*index]->inside.empty() && all != nullptr) {
    const Json* around = member(*all, schema_.extensions[*index]->inside);
    all = around == nullptr ? nullptr : member(*around, "extensions");
  }
  if (all == nullptr) return false;
  if (member(*all, extension) != nullptr) return true;
  if (!index) return false;
  const auto& drafts = schema_.extensions[*index]->drafts;
  return std::any_of(drafts.begin(), drafts.end(),
                     [&](std::string_view draft) { return member(*all, draft) != nullptr; });
}

void MaterialReader::unknownExtension(std::string_view name, const Path& path) {
  const std::optional<uint16_t> index = schema_.find(name);
  if (name != kTransform && (!index || *index == 0)) {
    material_.ignored.push_back(path.text());
    return;
  }
  if (name == kTransform) {
    return report_.error("misplaced-extension", path, fmt::format("{} has no place here", name),
                         "move it to a textureInfo's extensions");
  }
  const ExtensionDecl& decl = *schema_.extensions[*index];
  std::string help = decl.inside.empty() ? "move it to the material's extensions"
                                         : fmt::format("move it to {}.extensions", decl.inside);
  if (decl.name != name) help += fmt::format(", as {}", decl.name);
  if (!decl.inside.empty() && !there(decl.inside)) help += fmt::format(" ({} is missing too)", decl.inside);
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

Material readMaterial(const Json& json, size_t index, const Schema& schema, const FileFacts& file) {
  Material material;
  material.index = static_cast<int>(index);
  const Path root;
  const Path materials(root, "materials");
  MaterialReader(schema, file, material).read(json, Path(materials, index));
  return material;
}

}  // namespace lacquer::material
