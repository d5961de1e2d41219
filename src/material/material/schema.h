// What the library's declarations say of materials, as one table: every extension, and every property under a
// number of its own. What reads, checks or shows materials follows this table.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lang/library.h"
#include "materialx/materialx.h"

namespace lacquer::material {

using Kind = lang::PropertyDecl::Kind;

/// A property that has a value, or a texture. Objects around it are only a part of its path.
struct Property {
  const lang::PropertyDecl* decl = nullptr;
  uint16_t extension = 0;  ///< in Schema::extensions
  std::string path;        ///< from the material on: "extensions/KHR_materials_ior/ior"
  std::string
      parameter_name;  ///< of the editable parameter, or without "_texture" of the texture: "coat_ior"
  std::string role;    ///< in Schema::roles
};

/// One row for whoever shows or checks the table.
struct Row {
  std::string_view object;  ///< the extension's name, or the object's or texture's that it stands in
  const lang::PropertyDecl* property = nullptr;
};

struct Schema {
  const lang::Library* library = nullptr;              ///< that it was collected from
  materialx::Definitions definitions = {};             ///< beside those that MaterialX documents have
  std::vector<const lang::ExtensionDecl*> extensions;  ///< glTF's own first, then by name
  std::vector<Property> properties;
  /// By what parts call them: the properties that give it, in the order of the extensions. Where several
  /// vendors (lang::Origin) call different properties alike, each is "EXTENSION.name", but for the library's
  /// own.
  std::map<std::string, std::vector<uint16_t>, std::less<>> roles;

  /// Of an extension's or draft's name.
  std::optional<uint16_t> find(std::string_view name) const;
  /// Where an extension stands, from the material on: "extensions/KHR_materials_clearcoat/extensions/…".
  std::string pathOf(uint16_t extension) const;
  /// The number of a property by its declaration.
  uint16_t indexOf(const lang::PropertyDecl& decl) const;
  /// The vendor in whose text a property stands.
  std::string_view vendorOf(const Property& property) const;
  std::vector<Row> rows() const;
};

/// "coat_color_factor" of "coatColorFactor".
std::string parameterName(std::string_view property);

/// Collects the library's extensions. Errors: those of the declarations; a role with two types, or with two
/// meanings in one vendor's text; an extension
/// that stands in one that is not there; more or fewer than one `material`.
/// With `aside`, what is wrong within a declaration goes there, and the schema has it as it is written: for
/// those who look for more that is wrong.
Result<Schema> schemaOf(const lang::Library& library, Diagnostics* aside = nullptr);

}  // namespace lacquer::material
