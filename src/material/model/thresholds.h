// Where a material's values decide of its form: the numbers that conditions of the model compare properties
// with. The colour must not notice on which side of one it is.
#pragma once

#include <vector>

#include "model/model.h"

namespace lacquer::model {

struct Threshold {
  uint16_t property = 0;    ///< in Schema::properties
  int member = -1;          ///< of a texture: the number of its textureInfo
  ir::Components at{};      ///< of the property's type
  bool whole_part = false;  ///< at it a part of an extension may not be there at all
};

/// By property, then by member and number; each once. Choices and bools have none.
std::vector<Threshold> thresholds(const Model& model);

/// Whether a part of the extension makes something of what lies below it.
bool isLayer(const Model& model, uint16_t extension);

}  // namespace lacquer::model
