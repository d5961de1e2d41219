#include "gltf/material.h"

#include <fmt/format.h>

#include <exception>
#include <optional>
#include <utility>

#include "gltf/container.h"
#include "gltf/json.h"
#include "gltf/material_reader.h"
#include "gltf/path.h"
#include "gltf/report.h"
#include "gltf/scene.h"
#include "gltf/text.h"

namespace lacquer::gltf {

namespace {

/// The two numbers of "2.0"; nothing when it is no version.
std::optional<std::pair<int, int>> versionOf(const std::string& text) {
  constexpr size_t kLongest = 9;  // digits of "1234.5678" at most: no overflow to care for
  const size_t dot = text.find('.');
  const auto digits = [](const std::string& s) {
    return !s.empty() && s.find_first_not_of("0123456789") == std::string::npos;
  };
  if (text.size() > kLongest || dot == std::string::npos) return std::nullopt;
  const std::string major = text.substr(0, dot);
  const std::string minor = text.substr(dot + 1);
  if (!digits(major) || !digits(minor)) return std::nullopt;
  return std::pair(std::stoi(major), std::stoi(minor));
}

/// Checks one of the asset's two versions. `newest` is the newest minor version that can be read.
void checkVersion(const Json& version, std::string_view name, int newest, const Path& path, Report& report) {
  if (!version.is_string()) return report.wrongType(path, name, version, "a string such as \"2.0\"");
  const auto& text = version.get_ref<const std::string&>();
  const std::optional<std::pair<int, int>> number = versionOf(text);
  if (number && number->first == 2 && number->second <= newest) return;
  report.error("unsupported-version", path, fmt::format("{} is {}", name, quote(text)),
               "Lacquer reads glTF 2.0");
}

/// What makes the file as a whole unusable.
void checkRoot(const Json& root, Report& report) {
  const Path path;
  if (!root.is_object()) return report.wrongType(path, "the file", root, "a JSON object");
  const Path assetPath(path, "asset");
  const Json* asset = member(root, "asset");
  if (asset == nullptr) {
    return report.error("missing-property", path, "the file has no \"asset\"",
                        "every glTF has one: \"asset\": { \"version\": \"2.0\" }");
  }
  if (!asset->is_object()) return report.wrongType(assetPath, "asset", *asset, "an object");
  if (const Json* version = member(*asset, "version")) {
    // Any 2.x can be read as a 2.0, unless it says otherwise in minVersion.
    checkVersion(*version, "version", 9999, Path(assetPath, "version"), report);
  } else {
    report.error("missing-property", assetPath, "the asset has no \"version\"", "Lacquer reads glTF 2.0");
  }
  if (const Json* least = member(*asset, "minVersion")) {
    checkVersion(*least, "minVersion", 0, Path(assetPath, "minVersion"), report);
  }
  if (const Json* materials = member(root, "materials"); materials != nullptr && !materials->is_array()) {
    report.wrongType(Path(path, "materials"), "materials", *materials, "an array");
  }
}

Result<Document> readDocument(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const Result<std::string_view> text = jsonText(bytes, name);
  if (!text) return tl::make_unexpected(text.error());
  Result<Json> root = parseJson(*text, name, options.limits);
  if (!root) {
    if (text->data() != bytes.data()) {
      for (Diagnostic& one : root.error()) one.message += " (in the GLB's JSON chunk)";
    }
    return tl::make_unexpected(std::move(root.error()));
  }
  Diagnostics fatal;
  Report report(name, fatal);
  checkRoot(*root, report);
  if (hasError(fatal)) return tl::make_unexpected(std::move(fatal));

  Document document;
  document.path = name;
  const FileFacts facts{name, readScene(*root, document), options.permissive};
  if (const Json* materials = member(*root, "materials")) {
    document.materials.reserve(materials->size());
    for (size_t i = 0; i < materials->size(); ++i)
      document.materials.push_back(readMaterial((*materials)[i], i, facts));
  }
  return document;
}

/// Turns what the libraries (or the lack of memory) may throw into an error, so that nothing passes the API.
template <class Read>
Result<Document> guarded(const std::string& name, Read read) {
  try {
    return read();
  } catch (const std::exception& exception) {
    return fail("cannot-read", {name, 0, 0, {}},
                "the file cannot be read: " + printable(exception.what(), 400));
  }
}

}  // namespace

std::vector<std::string> VertexAttributes::names() const {
  std::vector<std::string> out;
  if (normal) out.emplace_back("NORMAL");
  if (tangent) out.emplace_back("TANGENT");
  for (size_t i = 0; i < texCoord.size(); ++i) {
    if (texCoord[i]) out.push_back(fmt::format("TEXCOORD_{}", i));
  }
  if (color0) out.emplace_back("COLOR_0");
  return out;
}

Result<Document> read(const std::string& path, const ReadOptions& options) {
  return guarded(path, [&]() -> Result<Document> {
    const Result<std::string> bytes = readBytes(path);
    if (!bytes) return tl::make_unexpected(bytes.error());
    return readDocument(*bytes, path, options);
  });
}

Result<Document> readText(const std::string& bytes, const std::string& name, const ReadOptions& options) {
  return guarded(name, [&] { return readDocument(bytes, name, options); });
}

}  // namespace lacquer::gltf
