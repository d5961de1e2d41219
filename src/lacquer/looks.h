/// What a MaterialX document says of geometry, as values: which material is for which, in looks
/// (docs/materialx.md, "Looks"). Part of lacquer/contract.h. lacquer.h says what holds for every declaration.
#pragma once

#include <string>
#include <vector>

#include "lacquer/options.h"

namespace lacquer {

/// Geometry by names, paths and expressions, as the document has them with its prefixes ("/chair/leg*",
/// "//*"), or by the name of a collection; an application knows which geometry that is.
struct GeometryNames {
  Strings paths;
  std::string collection;  ///< of Looks::collections, or of the geometry's own file; else empty
};

/// Of what is assigned to a geometry twice, the last one holds.
struct MaterialAssignment {
  std::string name;
  int material = -1;  ///< ContractMaterial::index
  GeometryNames geometry;
  bool exclusive = true;  ///< false: shaders of other kinds that were assigned before stay
};
struct PropertyAssignment {
  std::string property, type, value;  ///< "twosided", "boolean", "true"
  std::string target;                 ///< renderers that it is for; empty for all
  GeometryNames geometry;
};
struct VisibilityAssignment {
  std::string type;  ///< "camera", "shadow"; empty for all
  bool visible = true;
  GeometryNames geometry, viewers;  ///< without viewers: to all
};
/// In the order in which they hold, what it inherits before its own.
struct Look {
  std::string name;
  std::vector<MaterialAssignment> materials;
  std::vector<PropertyAssignment> properties;
  std::vector<VisibilityAssignment> visibility;
};
struct LookGroup {
  std::string name;
  Strings looks;           ///< those of groups within it, too
  std::string by_default;  ///< one of the looks; may be empty
};

/// What is included, without what is excluded.
struct GeometryCollection {
  std::string name;
  Strings include, collections, exclude;
};

struct GeometryValue {
  std::string name, type, value;
};
/// Values that hold for all of a geometry.
struct GeometryInfo {
  std::string name;
  GeometryNames geometry;
  std::vector<GeometryValue> properties, tokens;
};

/// A material with other values than the document's own one has.
struct MaterialVariant {
  int material = -1;  ///< ContractMaterial::index
  int of = -1;        ///< that of the document's own
  Strings variants;   ///< whose values it has, "wetness/wet", in the order in which they hold
};

/// All of a document; empty for other files.
struct Looks {
  std::vector<Look> looks;
  std::vector<LookGroup> groups;
  std::vector<GeometryCollection> collections;
  std::vector<GeometryInfo> geometry;
  std::vector<MaterialVariant> variants;
};

/// The part of a file's entry in the manifest that says this, as a JSON object.
std::string looksJson(const Looks& looks);

}  // namespace lacquer
