// What follows from a model's lines: which line says which id, which terms keep a number editable, the order
// that lines are put out in.
#pragma once

#include "model/model.h"

namespace lacquer::model {

/// Fills what the lines say of ids, outs, roles and terms, and Model::ordered.
void connect(Model& model);

}  // namespace lacquer::model
