#include "manifest/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "json/path.h"
#include "json/report.h"
#include "manifest/manifest.h"
#include "setting/options.h"
#include "shader/module.h"
#include "shader/print.h"
#include "support/text.h"

namespace lacquer {

namespace {

using json::Path;

/// A member that an entry of docs/manifest.schema.json has.
struct Member {
  std::string_view name;
  bool (*fits)(const Json&);
  std::string_view expected;
  bool required = true;
};

bool isObject(const Json& json) { return json.is_object(); }
bool isText(const Json& json) { return json.is_string(); }
bool isWhole(const Json& json) { return json.is_number_integer(); }
bool isTexts(const Json& json) { return json.is_array() && std::all_of(json.begin(), json.end(), isText); }
bool isObjects(const Json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), isObject);
}
bool isFlags(const Json& json) {
  return json.is_object() && std::all_of(json.items().begin(), json.items().end(),
                                         [](const auto& flag) { return flag.second.is_boolean(); });
}

constexpr std::string_view kObject = "an object", kText = "a string", kTexts = "an array of strings",
                           kObjects = "an array of objects";

constexpr Member kFile[] = {{"source", isText, kText},
                            {"materials", isObjects, kObjects},
                            {"default_material", isObject, kObject, false},
                            {"variants", isTexts, kTexts, false},
                            {"primitives", isObjects, kObjects, false},
                            {"textures", isObjects, kObjects, false},
                            {"images", isObjects, kObjects, false},
                            {"diagnostics", isObjects, kObjects}};
constexpr Member kMaterial[] = {{"index", isWhole, "a whole number"}, {"name", isText, kText},
                                {"uses", isObjects, kObjects},        {"terms", isTexts, kTexts},
                                {"skipped", isObject, kObject},       {"ignored", isTexts, kTexts},
                                {"diagnostics", isObjects, kObjects}};
constexpr Member kUse[] = {{"attributes", isTexts, kTexts},    {"shader", isText, kText},
                           {"parameters", isObject, kObject},  {"uniforms", isObject, kObject},
                           {"textures", isObject, kObject},    {"absent_parameters", isObject, kObject},
                           {"unfilled_ports", isTexts, kTexts}};
constexpr Member kShader[] = {
    {"files", isObject, kObject},        {"validated", isFlags, "an object of booleans"},
    {"template", isText, kText},         {"uniforms", isObjects, kObjects},
    {"parameters", isObjects, kObjects}, {"spec_constants", isObjects, kObjects, false},
    {"textures", isObjects, kObjects},   {"inputs", isObjects, kObjects},
    {"outputs", isObjects, kObjects},    {"proofs", isObject, kObject}};

constexpr std::string_view kMembers[] = {"lacquer", "schema", "files", "shaders"};  ///< of a manifest

class Checker {
public:
  Checker(const std::string& file, std::vector<NamedShader>& named) : report_(file, wrong_), named_(named) {}

  void manifest(const Json& json) {
    const Path root;
    for (const auto& [name, value] : json.items()) {
      if (full()) return;
      if (std::find(std::begin(kMembers), std::end(kMembers), name) != std::end(kMembers)) continue;
      report_.error("unknown-property", Path(root, name), fmt::format("a manifest has no {}", quote(name)),
                    "it has " + listOf(kMembers));
    }
    const Path files(root, "files");
    const Json& all_files = json["files"];
    for (size_t i = 0; i < all_files.size() && !full(); ++i) file(all_files[i], Path(files, i));
    const Path shaders(root, "shaders");
    for (const auto& [id, entry] : json["shaders"].items()) {
      if (full()) return;
      shader(id, entry, Path(shaders, id));
    }
  }

  Diagnostics take() { return std::move(wrong_); }

private:
  /// What else is wrong would not be said.
  bool full() const { return isFull(wrong_); }

  /// Whether the entry is an object whose members have their types.
  bool fits(const Json& json, const Path& path, std::string_view what, std::span<const Member> members) {
    if (!json.is_object()) {
      report_.wrongType(path, what, json, kObject);
      return false;
    }
    bool good = true;
    for (const Member& member : members) {
      const Json* found = json::member(json, member.name);
      if (found == nullptr && member.required)
        report_.error("missing-property", path, fmt::format("{} has no \"{}\"", what, member.name));
      if (found != nullptr && !member.fits(*found)) {
        report_.error("wrong-type", Path(path, member.name),
                      fmt::format("\"{}\" of {} has the wrong type", member.name, what),
                      fmt::format("it must be {}", member.expected));
      }
      good &= found == nullptr ? !member.required : member.fits(*found);
    }
    return good;
  }

  void file(const Json& json, const Path& path) {
    if (!fits(json, path, "the file's entry", kFile)) return;
    const Path materials(path, "materials");
    const Json& all = json["materials"];
    for (size_t i = 0; i < all.size() && !full(); ++i) material(all[i], Path(materials, i));
    if (const Json* unnamed = json::member(json, "default_material"))
      material(*unnamed, Path(path, "default_material"));
  }

  void material(const Json& json, const Path& path) {
    if (!fits(json, path, "the material's entry", kMaterial)) return;
    const Path uses(path, "uses");
    const Json& all = json["uses"];
    for (size_t i = 0; i < all.size() && !full(); ++i) {
      const Path use(uses, i);
      if (!fits(all[i], use, "the use", kUse)) continue;
      named_.push_back({all[i]["shader"].text(), Path(use, "shader").text()});
    }
  }

  void shader(const std::string& id, const Json& json, const Path& path) {
    if (!isShaderId(id)) {
      return report_.error("wrong-id", path, fmt::format("{} is no shader's id", quote(id)),
                           "it has letters, digits, - and _");
    }
    if (!fits(json, path, "the shader's entry", kShader)) return;
    const Path files(path, "files");
    for (const auto& [name, entry] : json["files"].items()) {
      if (full()) return;
      target(id, name, entry, Path(files, name));
    }
  }

  /// The paths follow from the id: a manifest that says otherwise leads elsewhere.
  void target(const std::string& id, const std::string& name, const Json& json, const Path& path) {
    Target target{};
    if (!findTarget(name, target))
      return report_.error("unknown-target", path, fmt::format("there is no target {}", quote(name)));
    if (!json.is_object()) return report_.wrongType(path, "the target's entry", json, kObject);
    for (const auto& [stage, file] : json.items()) {
      if (full()) return;
      const bool known = stage == fileKind(target, 0) || stage == fileKind(target, 1);
      if (!known) {
        report_.error("wrong-path", Path(path, stage),
                      fmt::format("{} is no stage of this target", quote(stage)));
        continue;
      }
      const std::string expected = shaderPath(target, id, stage == fileKind(target, 0) ? 0 : 1);
      if (file.is_string() && file.text() == expected) continue;
      report_.error("wrong-path", Path(path, stage), "this is not where the shader lies",
                    fmt::format("it must be \"{}\"", expected));
    }
  }

  Diagnostics wrong_;
  json::Report report_;
  std::vector<NamedShader>& named_;
};

tl::unexpected<Diagnostics> noManifest(const std::string& path, std::string pointer, std::string message) {
  return fail("no-manifest", {path, 0, 0, std::move(pointer)}, std::move(message),
              "name what `lacquer gen` of this version wrote: a manifest or a shard");
}

}  // namespace

Result<void> checkManifestHead(const Json& manifest, const std::string& path) {
  const auto is = [&](const char* name, Json::Kind kind) {
    const Json* found = json::member(manifest, name);
    return found != nullptr && found->kind() == kind;
  };
  if (!is("lacquer", Json::Kind::String) || !is("files", Json::Kind::Array) ||
      !is("shaders", Json::Kind::Object)) {
    return noManifest(path, {}, "this is no manifest of Lacquer's");
  }
  const auto& written_by = json::member(manifest, "lacquer")->text();
  if (written_by != version()) {
    return noManifest(path, "/lacquer", "it was written by version " + printable(written_by));
  }
  const Json* schema = json::member(manifest, "schema");
  if (schema == nullptr || !schema->is_number_integer() || *schema != kManifestSchema) {
    return noManifest(path, schema == nullptr ? "" : "/schema",
                      fmt::format("its form (\"schema\") is not {}", kManifestSchema));
  }
  return {};
}

Result<void> checkManifest(const Json& manifest, const std::string& path, std::vector<NamedShader>& named) {
  if (Result<void> head = checkManifestHead(manifest, path); !head) return head;
  Checker checker(path, named);
  checker.manifest(manifest);
  Diagnostics wrong = checker.take();
  if (wrong.empty()) return {};
  return tl::make_unexpected(std::move(wrong));
}

}  // namespace lacquer
