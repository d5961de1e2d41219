// Primitives: their attributes and how those are stored, their materials, those of variants among them.
#include <algorithm>
#include <array>
#include <iterator>

#include "gltf/reading.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

/// glTF 2.0, section 3.6.2.2 ("Accessor Data Types").
struct ComponentType {
  int number;
  std::string_view name;
};
constexpr ComponentType kComponentTypes[] = {{5120, "BYTE"},         {5121, "UNSIGNED_BYTE"},
                                             {5122, "SHORT"},        {5123, "UNSIGNED_SHORT"},
                                             {5125, "UNSIGNED_INT"}, {5126, "FLOAT"}};

/// The component types that a semantic may have: glTF 2.0, section 3.7.2.1, then what KHR_mesh_quantization
/// adds. An n before a name says "normalized".
struct Allowed {
  std::string_view semantic;  ///< or what it begins with, up to the underscore
  std::string_view core, quantized;
};
constexpr Allowed kAllowed[] = {
    {"POSITION", "FLOAT",
     "BYTE nBYTE UNSIGNED_BYTE nUNSIGNED_BYTE SHORT nSHORT UNSIGNED_SHORT nUNSIGNED_SHORT"},
    {"NORMAL", "FLOAT", "nBYTE nSHORT"},
    {"TANGENT", "FLOAT", "nBYTE nSHORT"},
    {"TEXCOORD_", "FLOAT nUNSIGNED_BYTE nUNSIGNED_SHORT",
     "BYTE nBYTE UNSIGNED_BYTE SHORT nSHORT UNSIGNED_SHORT"},
    {"COLOR_", "FLOAT nUNSIGNED_BYTE nUNSIGNED_SHORT", ""},
    {"JOINTS_", "UNSIGNED_BYTE UNSIGNED_SHORT", ""},
    {"WEIGHTS_", "FLOAT nUNSIGNED_BYTE nUNSIGNED_SHORT", ""},
};

const Allowed* allowedFor(std::string_view semantic) {
  const auto found = std::find_if(std::begin(kAllowed), std::end(kAllowed), [&](const Allowed& row) {
    return row.semantic.ends_with('_') ? semantic.starts_with(row.semantic) : semantic == row.semantic;
  });
  return found == std::end(kAllowed) ? nullptr : &*found;
}

/// Whether a list of words has this one.
bool lists(std::string_view words, std::string_view word) {
  for (size_t at = 0; at < words.size();) {
    const size_t end = std::min(words.find(' ', at), words.size());
    if (words.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

class PrimitiveReader {
public:
  PrimitiveReader(Reading& reading, Primitive& out)
      : reading_(reading), root_(reading.root), report_(reading.report), out_(out) {}

  /// False when it cannot be used.
  bool read(const Json& primitive, const Path& path) {
    if (isStandIn(primitive)) return false;
    bool usable = member(primitive, "attributes") != nullptr;
    for (const auto& [name, value] : primitive.items()) {
      const Path here(path, name);
      if (name == "attributes") {
        attributes(value, here);
        usable = usable && value.is_object();
      } else if (name == "material") {
        out_.material = materialIndex(value, here);
        usable = usable && out_.material >= 0;
      } else if (name == "targets") {
        targets(value, here);
      } else if (name == "extensions") {
        eachMember(report_, value, here, "extensions",
                   [&](std::string_view key, const Json& extension, const Path& p) {
                     if (key == kVariants) mappings(extension, p);
                   });
      }
    }
    if (member(primitive, "attributes") == nullptr) {
      report_.error("missing-property", path, "the primitive has no \"attributes\"",
                    "it must have POSITION at least");
    }
    return usable;
  }

private:
  void attributes(const Json& attributes, const Path& path) {
    eachMember(report_, attributes, path, "attributes",
               [&](std::string_view name, const Json& value, const Path& here) {
                 int accessor = -1;
                 report_.index(here, printable(name), value, arraySize(root_, "accessors"), "accessor",
                               accessor);
                 if (!known(name)) unread(name, here);
                 AttributeFormat format;
                 format.semantic = printable(name);
                 if (accessor >= 0)
                   stored(json::at(root_, "accessors")[static_cast<size_t>(accessor)], format);
                 checkFormat(format, here);
                 if (standsForItself(format)) out_.attributes.quantized = true;
                 out_.formats.push_back(std::move(format));
               });
    influences(path);
    // Tangents of a primitive without normals must be ignored (glTF 2.0, section 3.7.2.1).
    out_.attributes.tangent &= out_.attributes.normal;
  }

  /// Integers that a vertex format may not make floats of, of an attribute that may be other than an integer.
  static bool standsForItself(const AttributeFormat& format) {
    constexpr std::array<std::string_view, 5> kNumbers = {"POSITION", "TEXCOORD_0", "TEXCOORD_1",
                                                          "TEXCOORD_2", "TEXCOORD_3"};
    return !format.normalized && !format.componentType.empty() && format.componentType != "FLOAT" &&
           std::find(kNumbers.begin(), kNumbers.end(), format.semantic) != kNumbers.end();
  }

  /// Joints count with their weights alone, and the second four behind the first.
  void influences(const Path& path) {
    std::array<bool, 2>& skin = out_.attributes.skin;
    for (size_t i = 0; i < skin.size(); ++i) {
      skin[i] = joints_[i] && weights_[i] && (i == 0 || skin[0]);
      if (skin[i]) continue;
      for (const auto& [there, what] :
           {std::pair(joints_[i], "JOINTS_"), std::pair(weights_[i], "WEIGHTS_")}) {
        const std::string name = fmt::format("{}{}", what, i);
        if (there) unread(name, Path(path, name));
      }
    }
  }

  /// Notes an attribute of those that shaders may read: it is there, whatever its data.
  bool known(std::string_view name) {
    VertexAttributes& a = out_.attributes;
    if (name == "NORMAL") return a.normal = true;
    if (name == "TANGENT") return a.tangent = true;
    if (name == "COLOR_0") return a.color0 = true;
    for (size_t i = 0; i < a.texCoord.size(); ++i) {
      if (name == fmt::format("TEXCOORD_{}", i)) return a.texCoord[i] = true;
    }
    for (size_t i = 0; i < joints_.size(); ++i) {
      if (name == fmt::format("JOINTS_{}", i)) return joints_[i] = true;
      if (name == fmt::format("WEIGHTS_{}", i)) return weights_[i] = true;
    }
    if (name.starts_with('_') || isMore(name)) return application(name);
    return name == "POSITION";
  }

  /// A set beyond those that every shader may read, which patterns read by name.
  static bool isMore(std::string_view name) {
    const auto within = [&](std::string_view set, char first) {
      return name.starts_with(set) && name.size() == set.size() + 1 && name.back() >= first &&
             name.back() <= '9';
    };
    return within("COLOR_", '1') || within("TEXCOORD_", '4');
  }

  /// glTF 2.0, section 3.7.2.1: application-specific semantics begin with an underscore.
  bool application(std::string_view name) {
    std::vector<std::string>& own = out_.attributes.application;
    constexpr size_t kLongest = 64;
    constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
    // Of another name no template can speak.
    if (name.size() > kLongest || name.find_first_not_of(kPlain) != std::string_view::npos) return false;
    if (own.size() >= kMostApplicationAttributes) return false;
    own.insert(std::upper_bound(own.begin(), own.end(), name), std::string(name));
    return true;
  }

  void targets(const Json& targets, const Path& path) {
    eachElement(report_, targets, path, "morph target", [&](const Json& target, const Path& p, size_t) {
      std::vector<std::string>& semantics = out_.targets.emplace_back();
      for (const auto& [name, value] : target.items()) {
        int accessor = -1;
        report_.index(Path(p, name), printable(name), value, arraySize(root_, "accessors"), "accessor",
                      accessor);
        semantics.push_back(printable(name));
        if (name != "POSITION" && name != "NORMAL" && name != "TANGENT")
          unread(fmt::format("{} of a morph target", printable(name)), Path(p, name));
      }
    });
    out_.attributes.morph = !out_.targets.empty();
  }

  /// Said once in a file for each of glTF's semantics; the application's own begin with an underscore.
  void unread(std::string_view name, const Path& path) {
    if (name.starts_with('_') || !reading_.said.emplace(name).second) return;
    report_.note("attribute-unread", path, fmt::format("no shader reads {}", printable(name)),
                 "what it is for is the application's to do");
  }

  static void stored(const Json& accessor, AttributeFormat& out) {
    if (const Json* type = member(accessor, "type"); type != nullptr && type->is_string())
      out.type = printable(json::text(*type), 16);
    const Json* component = member(accessor, "componentType");
    for (const ComponentType& row : kComponentTypes) {
      if (component != nullptr && *component == row.number) out.componentType = row.name;
    }
    const Json* normalized = member(accessor, "normalized");
    out.normalized = normalized != nullptr && *normalized == true;
  }

  /// Said once in a file for each format of a semantic.
  void checkFormat(const AttributeFormat& format, const Path& path) {
    const Allowed* allowed = allowedFor(format.semantic);
    if (allowed == nullptr || format.componentType.empty()) return;
    const bool normalized = format.normalized && format.componentType != "FLOAT";
    const std::string word = (normalized ? "n" : "") + format.componentType;
    const bool extended = lists(allowed->quantized, word);
    if (lists(allowed->core, word) || (extended && reading_.quantized)) return;
    if (!reading_.said.insert(format.semantic + " " + word).second) return;
    const std::string what = fmt::format("{}{}", normalized ? "normalized " : "", format.componentType);
    report_.warning("attribute-format", path,
                    fmt::format("{} is stored as {}, which {} does not allow", format.semantic, what,
                                extended ? "glTF without KHR_mesh_quantization" : "glTF"),
                    extended ? "list KHR_mesh_quantization in extensionsUsed and extensionsRequired"
                             : "shaders read what the bytes come to as floats");
  }

  /// The materials that a primitive may be given instead of its own.
  void mappings(const Json& extension, const Path& path) {
    eachMember(report_, extension, path, kVariants,
               [&](std::string_view name, const Json& mappings, const Path& here) {
                 if (name != "mappings") return;
                 eachElement(report_, mappings, here, "mapping",
                             [&](const Json& one, const Path& p, size_t) { mapping(one, p); });
               });
  }

  void mapping(const Json& mapping, const Path& path) {
    if (isStandIn(mapping)) return;
    VariantMapping out;
    const Json* material = member(mapping, "material");
    if (material != nullptr)
      out.material = materialIndex(*material, Path(path, "material"));
    else
      report_.error("missing-property", path, "the mapping has no \"material\"", "it must name one");
    const Json* variants = member(mapping, "variants");
    const Path here(path, "variants");
    if (variants == nullptr) {
      report_.warning("missing-property", path, "the mapping has no \"variants\"",
                      "no variant chooses its material");
    } else if (!variants->is_array()) {
      report_.wrongType(here, "variants", *variants, "an array of indices");
    } else {
      for (size_t i = 0; i < variants->size(); ++i) variant((*variants)[i], Path(here, i), out);
    }
    if (out.material >= 0) out_.mappings.push_back(std::move(out));
  }

  void variant(const Json& value, const Path& path, VariantMapping& out) {
    int index = -1;
    if (!report_.index(path, "variant", value, reading_.variants, "variant", index)) return;
    if (!chosen_.insert(index).second) {
      return report_.warning("duplicate-variant", path,
                             fmt::format("the primitive has a material for variant {} already", index),
                             "the first one counts");
    }
    out.variants.push_back(index);
  }

  int materialIndex(const Json& value, const Path& path) {
    int index = -1;
    report_.index(path, "material", value, arraySize(root_, "materials"), "material", index);
    return index;
  }

  Reading& reading_;
  const Json& root_;
  Report& report_;
  Primitive& out_;
  std::array<bool, 2> joints_{}, weights_{};
  std::set<int> chosen_;  ///< variants that have a material
};

}  // namespace

void readVariants(Reading& reading, const Json& extension, const Path& path) {
  Report& report = reading.report;
  eachMember(report, extension, path, kVariants,
             [&](std::string_view key, const Json& variants, const Path& here) {
               if (key != "variants") return;
               eachElement(report, variants, here, "variant", [&](const Json& one, const Path& p, size_t) {
                 std::string& name = reading.scene.variants.emplace_back();
                 const Json* given = member(one, "name");
                 if (given != nullptr && given->is_string())
                   name = json::text(*given);
                 else if (!isStandIn(one))
                   report.warning("missing-property", p, "the variant has no \"name\"", "it must have one");
               });
             });
}

void readMesh(Reading& reading, size_t index, const Json& mesh, const Path& path) {
  Report& report = reading.report;
  const Json* primitives = member(mesh, "primitives");
  if (primitives == nullptr) {
    if (!isStandIn(mesh))
      report.error("missing-property", path, "the mesh has no \"primitives\"", "it must have at least one");
    return;
  }
  const Path here(path, "primitives");
  if (primitives->is_array() && primitives->empty())
    report.error("wrong-length", here, "the mesh has no primitives", "it must have at least one");
  eachElement(report, *primitives, here, "primitive", [&](const Json& one, const Path& p, size_t i) {
    Primitive primitive;
    primitive.mesh = index;
    primitive.index = i;
    if (PrimitiveReader(reading, primitive).read(one, p))
      reading.scene.primitives.push_back(std::move(primitive));
  });
}

}  // namespace lacquer::gltf
