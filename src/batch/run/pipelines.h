// What an engine makes ahead of time: the distinct pipelines of a manifest, in the order of use.
#pragma once

#include "json/json.h"
#include "support/diagnostic.h"

namespace lacquer {

/// From a manifest of this form, whatever it holds, the text of docs/pipelines.schema.json.
std::string pipelinesText(const json::Json& manifest);

}  // namespace lacquer
