// Materials that no file has, for checks of the library: numbers drawn in their ranges.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "material/material.h"
#include "material/schema.h"
#include "support/random.h"

namespace lacquer::material {

/// Adds an extension with all that it needs and stands in. False where they cannot stand beside those that
/// are there.
bool addExtension(const Schema& schema, uint16_t extension, std::vector<uint16_t>& to);

/// Gives a property a number, in place of the one that it has.
void setNumber(Material& material, uint16_t property, const ir::Components& value);

/// Numbers for all that the extensions have and the material does not say.
void drawNumbers(const Schema& schema, const std::vector<uint16_t>& extensions, Random& random,
                 Material& material);

/// A material with nothing but the extension, what it needs and what it stands in, its numbers drawn in their
/// ranges. Nothing where there is no such, since it excludes what it needs.
std::optional<Material> materialWith(const Schema& schema, uint16_t extension, uint64_t seed);

}  // namespace lacquer::material
