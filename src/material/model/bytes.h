// A model as bytes: that of the library's own texts is made when Lacquer is built, so that no program has to
// make it from the texts again when it starts.
#pragma once

#include <string>
#include <string_view>

#include "model/model.h"

namespace lacquer::model {

/// The model of the library's own texts. Names are written as places in these.
std::string toBytes(const Model& model);

/// The model that was written, for a library of the same texts and its schema. The bytes must stay as long as
/// the model, and be those of toBytes() in the same build: nothing of them is checked.
Model fromBytes(std::string_view bytes, const lang::Library& library, const material::Schema& schema);

}  // namespace lacquer::model
