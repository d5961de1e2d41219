// What the readers of glTF take from json/, by its short names.
#pragma once

#include "json/json.h"
#include "json/path.h"
#include "json/report.h"

namespace lacquer::gltf {

using json::arraySize;
using json::describe;
using json::Json;
using json::member;
using json::Path;
using json::Report;

/// As json::parse().
inline Result<Json> parseJson(std::string_view text, const std::string& file, const Limits& limits = {}) {
  return json::parse(text, file, limits);
}

}  // namespace lacquer::gltf
