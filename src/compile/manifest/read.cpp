#include "manifest/read.h"

#include <fmt/format.h>

#include <map>

#include "json/path.h"
#include "json/report.h"
#include "manifest/members.h"
#include "manifest/text.h"
#include "setting/messages.h"
#include "shader/module.h"
#include "support/file.h"
#include "support/text.h"

namespace lacquer::manifest {

namespace {

using json::Json;
using json::Path;
using NamedTexts = decltype(ManifestCode::files);

constexpr std::string_view kObject = "an object", kText = "a string", kList = "an array";

/// Reads what members() describes.
class ReadObject {
public:
  static constexpr bool kReads = true;
  ReadObject(const Json& json, const Path& path, json::Report& report)
      : json_(json), path_(path), report_(report) {}

  void is(std::string_view noun) { noun_ = noun; }
  bool has(std::string_view key) const { return json::member(json_, key) != nullptr; }

  template <class T>
  void operator()(std::string_view key, T& value) {
    if (!find(key, value))
      report_.error("missing-property", path_, fmt::format("{} has no \"{}\"", noun_, key));
  }
  template <class T>
  void some(std::string_view key, T& value) {
    find(key, value);
  }

  /// A member that another reads.
  void ignore(std::string_view key) { known_.push_back(key); }

  /// Members that nothing has asked for.
  void finish() const {
    for (const auto& [key, value] : json_.items()) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      report_.error("unknown-property", Path(path_, key), fmt::format("{} has no {}", noun_, quote(key)),
                    "it has " + listOf(known_));
    }
  }

private:
  template <class T>
  bool find(std::string_view key, T& value) {
    known_.push_back(key);
    const Json* found = json::member(json_, key);
    if (found != nullptr) get(*found, Path(path_, key), key, value);
    return found != nullptr;
  }

  void wrong(const Path& path, std::string_view key, std::string_view expected) {
    report_.error("wrong-type", path, fmt::format("\"{}\" of {} has the wrong type", key, noun_),
                  fmt::format("it must be {}", expected));
  }

  void get(const Json& json, const Path& path, std::string_view key, std::string& to) {
    if (!json.is_string()) return wrong(path, key, kText);
    to = json.get<std::string>();
  }
  void get(const Json& json, const Path& path, std::string_view key, bool& to) {
    if (!json.is_boolean()) return wrong(path, key, "true or false");
    to = json.get<bool>();
  }
  void get(const Json& json, const Path& path, std::string_view key, double& to) {
    if (!json.is_number()) return wrong(path, key, "a number");
    to = json.get<double>();
  }
  template <std::integral T>
  void get(const Json& json, const Path& path, std::string_view key, T& to) {
    constexpr double kMost = sizeof(T) > 4 ? 9007199254740992.0 : std::numeric_limits<T>::max();
    const double x = json.is_number_integer() ? json.get<double>() : -2;
    if (!(x >= (std::is_signed_v<T> ? -1 : 0) && x <= kMost)) return wrong(path, key, "a whole number");
    to = static_cast<T>(x);
  }
  template <class T>
  requires std::is_enum_v<T>
  void get(const Json& json, const Path& path, std::string_view key, T& to) {
    const auto& words = Words<T>::kAll;
    const std::string word = json.is_string() ? json.get<std::string>() : std::string();
    const auto found = std::find(std::begin(words), std::end(words), word);
    if (word.empty() || found == std::end(words)) return wrong(path, key, "one of " + listOf(words));
    to = static_cast<T>(found - std::begin(words));
  }
  template <class T>
  void get(const Json& json, const Path& path, std::string_view key, std::optional<T>& to) {
    get(json, path, key, to.emplace());
  }
  void get(const Json& json, const Path& path, std::string_view key, std::vector<double>& to) {
    if (!json.is_array()) return get(json, path, key, to.emplace_back());
    for (size_t i = 0; i < json.size(); ++i) get(json[i], Path(path, i), key, to.emplace_back());
  }
  template <class T, size_t N>
  void get(const Json& json, const Path& path, std::string_view key, std::array<T, N>& to) {
    if (!json.is_array() || json.size() != N) return wrong(path, key, fmt::format("an array of {}", N));
    for (size_t i = 0; i < N; ++i) get(json[i], Path(path, i), key, to[i]);
  }
  /// null stands for no end.
  void get(const Json& json, const Path& path, std::string_view key, Range& to) {
    const auto fits = [](const Json& end) { return end.is_null() || end.is_number(); };
    if (!json.is_array() || json.size() != 2 || !fits(json[0]) || !fits(json[1]))
      return wrong(path, key, "two numbers or nulls");
    if (json[0].is_number()) to.low = json[0].get<double>();
    if (json[1].is_number()) to.high = json[1].get<double>();
  }
  void get(const Json& json, const Path& path, std::string_view key, Reached& to) {
    const auto end = [&](const Json& from, double& x) {
      if (from.is_number())
        x = from.get<double>();
      else if (from == "inf" || from == "-inf")
        x = from == "inf" ? HUGE_VAL : -HUGE_VAL;
      else
        wrong(path, key, "a range");
    };
    to.nan = json.is_array() && json.size() == 3 && json[2] == "nan";
    if (!json.is_array() || json.size() != (to.nan ? 3U : 2U)) return wrong(path, key, "a range");
    end(json[0], to.low);
    end(json[1], to.high);
  }
  template <class T>
  void get(const Json& json, const Path& path, std::string_view key, std::vector<T>& to) {
    if constexpr (!std::is_null_pointer_v<std::remove_const_t<decltype(kKey<T>)>>) {
      if (!json.is_object()) return wrong(path, key, kObject);
      for (const auto& [name, value] : json.items()) {
        T& item = to.emplace_back();
        item.*kKey<T> = name;
        get(value, Path(path, name), name, item);
      }
    } else {
      if (!json.is_array())
        return wrong(path, key, std::is_same_v<T, std::string> ? "an array of strings" : kList);
      for (size_t i = 0; i < json.size(); ++i) get(json[i], Path(path, i), key, to.emplace_back());
    }
  }
  template <class T>
  void get(const Json& json, const Path& path, std::string_view key,
           std::vector<std::pair<std::string, T>>& to) {
    if (!json.is_object()) return wrong(path, key, kObject);
    for (const auto& [name, value] : json.items())
      get(value, Path(path, name), name, to.emplace_back(name, T()).second);
  }
  template <class T>
  requires std::is_class_v<T>
  void get(const Json& json, const Path& path, std::string_view key, T& to) {
    if (!json.is_object()) return wrong(path, key, kObject);
    ReadObject object(json, path, report_);
    members(object, to);
    object.finish();
  }

  const Json& json_;
  const Path& path_;
  json::Report& report_;
  std::string_view noun_ = "the manifest";
  std::vector<std::string_view> known_;
};

/// Where the bindings of WebGPU and of Metal belong.
class Bindings {
public:
  Bindings(Reflection& of, json::Report& report) : of_(of), report_(report) {}

  void webgpu(const Json& json, const Path& path) {
    each(json, path, [&](const Json& row, const std::string& name, const Path& at) {
      BoundResource* bound = find(name);
      ReflectedTexture* sampled = bound == nullptr ? bySampler(name) : nullptr;
      if (sampled != nullptr) bound = sampled;
      if (bound == nullptr) bound = byArray(name);
      if (bound == nullptr) return unknown(name, at);
      number(row, "group", at, bound->wgsl.group);
      number(row, "binding", at, sampled != nullptr ? bound->wgsl.sampler : bound->wgsl.binding);
      // Those of an array's entry are the stages of all its textures, not of the first.
      if (sampled == nullptr ? byArray(name) == nullptr : sampled->array.empty()) stages(row, at, *bound);
    });
    // The textures of an array have one place.
    for (ReflectedTexture& texture : of_.textures) {
      if (!texture.array.empty()) texture.wgsl = byArray(texture.array)->wgsl;
    }
    const Json* limits = json::member(json, "limits");
    if (limits == nullptr || !limits->is_object())
      return report_.error("missing-property", path, "the bindings of WebGPU have no \"limits\"");
    const Path inside(path, "limits");
    for (const auto& [name, value] : limits->items()) {
      uint32_t limit = 0;
      number(*limits, name, inside, limit);
      of_.webgpu_limits.emplace_back(name, limit);
    }
  }

  bool metal(const Json& json, const Path& path) {
    const Json* argued = json::member(json, "argument_buffers");
    const bool buffers = argued != nullptr && argued->is_boolean() && argued->get<bool>();
    each(json, path, [&](const Json& row, const std::string& name, const Path& at) {
      BoundResource* bound = find(name);
      if (bound == nullptr) bound = byArray(name);
      if (bound == nullptr) return unknown(name, at);
      const bool block = json::member(row, buffers ? "sampler_id" : "sampler") == nullptr;
      MslPlace& to = buffers ? bound->msl_argument : bound->msl;
      if (buffers) number(row, "argument_buffer", at, to.argument_buffer);
      number(row, buffers ? "id" : block ? "buffer" : "texture", at, to.index);
      if (!block) number(row, buffers ? "sampler_id" : "sampler", at, to.sampler);
      if (byArray(name) == nullptr) stages(row, at, *bound);
    });
    for (ReflectedTexture& texture : of_.textures) {
      if (texture.array.empty()) continue;
      const ReflectedTexture& first = *byArray(texture.array);
      texture.msl = first.msl, texture.msl_argument = first.msl_argument;
    }
    return buffers;
  }

private:
  template <class Row>
  void each(const Json& json, const Path& path, const Row& row) {
    const Json* list = json::member(json, "bindings");
    if (list == nullptr || !list->is_array())
      return report_.error("missing-property", path, "it has no \"bindings\"");
    const Path inside(path, "bindings");
    for (size_t i = 0; i < list->size(); ++i) {
      const Path at(inside, i);
      const Json* name = json::member((*list)[i], "name");
      if (name == nullptr || !name->is_string())
        report_.error("missing-property", at, "the binding has no \"name\"");
      else
        row((*list)[i], name->get<std::string>(), at);
    }
  }

  BoundResource* find(const std::string& name) {
    for (UniformBlock& block : of_.blocks) {
      if (block.name == name) return &block;
    }
    for (ReflectedTexture& texture : of_.textures) {
      if (texture.name == name) return &texture;
    }
    return nullptr;
  }

  /// The first of an array's textures.
  ReflectedTexture* byArray(const std::string& array) {
    const auto it = std::find_if(of_.textures.begin(), of_.textures.end(),
                                 [&](const ReflectedTexture& texture) { return texture.array == array; });
    return it == of_.textures.end() || array.empty() ? nullptr : &*it;
  }

  ReflectedTexture* bySampler(const std::string& name) {
    const auto it = std::find_if(of_.textures.begin(), of_.textures.end(),
                                 [&](const ReflectedTexture& texture) { return texture.sampler == name; });
    return it == of_.textures.end() ? nullptr : &*it;
  }

  void number(const Json& row, std::string_view key, const Path& at, uint32_t& to) {
    const Json* found = json::member(row, key);
    const double x = found != nullptr && found->is_number_integer() ? found->get<double>() : -1;
    if (x >= 0 && x <= std::numeric_limits<uint32_t>::max())
      to = static_cast<uint32_t>(x);
    else
      report_.error("wrong-type", Path(at, key), fmt::format("\"{}\" of the binding has the wrong type", key),
                    "it must be a whole number");
  }

  void stages(const Json& row, const Path& at, BoundResource& bound) {
    const Json* list = json::member(row, "visibility");
    if (list == nullptr || !list->is_array())
      return report_.error("missing-property", at, "the binding has no \"visibility\"");
    for (const Json& stage : json::elements(*list)) {
      bound.vertex = bound.vertex || stage == "vertex";
      bound.fragment = bound.fragment || stage == "fragment";
    }
  }

  void unknown(const std::string& name, const Path& at) {
    report_.error("no-such-binding", at,
                  fmt::format("the shader has neither a block nor a texture {}", quote(name)));
  }

  Reflection& of_;
  json::Report& report_;
};

class Reader {
public:
  Reader(const std::string& file, Diagnostics& wrong) : wrong_(wrong), report_(file, wrong) {}

  void read(const Json& json, Manifest& to) {
    const Path root;
    members(json, root, to);
    for (size_t i = 0; i < to.shaders.size(); ++i) places_.emplace(to.shaders[i].id, i);
    for (FileContract& file : to.files) {
      for (ContractMaterial& material : file.materials) resolve(material, to.shaders);
      if (file.default_material) resolve(*file.default_material, to.shaders);
    }
  }

private:
  void members(const Json& json, const Path& root, Manifest& to) {
    constexpr std::string_view kMembers[] = {"lacquer", "schema", "files", "shaders", "levels"};
    for (const auto& [name, value] : json.items()) {
      if (std::find(std::begin(kMembers), std::end(kMembers), name) != std::end(kMembers)) continue;
      report_.error("unknown-property", Path(root, name), fmt::format("a manifest has no {}", quote(name)),
                    "it has " + listOf(kMembers));
    }
    to.lacquer = json::text(*json::member(json, "lacquer"));
    const Path files(root, "files");
    const Json& all_files = *json::member(json, "files");
    for (size_t i = 0; i < all_files.size() && !isFull(wrong_); ++i)
      entry(all_files[i], Path(files, i), "the file's entry", to.files.emplace_back());
    const Path shaders(root, "shaders");
    for (const auto& [id, value] : json::member(json, "shaders")->items()) {
      if (isFull(wrong_)) return;
      shader(id, value, Path(shaders, id), to.shaders.emplace_back());
    }
    const Json* levels = json::member(json, "levels");
    const Path of_levels(root, "levels");
    if (levels != nullptr && !levels->is_array())
      report_.wrongType(of_levels, "the list of levels", *levels, kList);
    for (size_t i = 0; levels != nullptr && i < json::arraySize(json, "levels"); ++i)
      entry((*levels)[i], Path(of_levels, i), "the material's levels", to.levels.emplace_back());
  }

  /// What follows from the shader that a use names.
  void resolve(ContractMaterial& material, const std::vector<ManifestShader>& shaders) const {
    for (ContractUse& use : material.uses) {
      resolve(use, shaders);
      if (!use.fallback) continue;
      auto fallback = std::make_shared<ContractUse>(*use.fallback);
      resolve(*fallback, shaders);
      use.fallback = std::move(fallback);
    }
  }
  void resolve(ContractUse& use, const std::vector<ManifestShader>& shaders) const {
    const auto it = places_.find(use.shader_id);
    use.shader = it == places_.end() ? shaders.size() : it->second;
    if (it == places_.end()) return;
    const Reflection& reflection = shaders[use.shader].reflection;
    for (UsedTexture& texture : use.textures) {
      const auto slot = std::find_if(reflection.textures.begin(), reflection.textures.end(),
                                     [&](const ReflectedTexture& one) { return one.name == texture.slot; });
      if (slot != reflection.textures.end()) texture.srgb = slot->srgb;
    }
  }

  template <class T>
  void entry(const Json& json, const Path& path, std::string_view noun, T& to) {
    if (!json.is_object()) return report_.wrongType(path, noun, json, kObject);
    ReadObject object(json, path, report_);
    manifest::members(object, to);
    object.finish();
  }

  void shader(const std::string& id, const Json& json, const Path& path, ManifestShader& to) {
    to.id = id;
    if (!isShaderId(id)) {
      return report_.error("wrong-id", path, fmt::format("{} is no shader's id", quote(id)),
                           "it has letters, digits, - and _");
    }
    if (!json.is_object()) return report_.wrongType(path, "the shader's entry", json, kObject);
    ReadObject object(json, path, report_);
    object.is("the shader's entry");
    std::vector<std::pair<std::string, NamedTexts>> files;
    std::vector<std::pair<std::string, bool>> validated;
    object("files", files);
    object("validated", validated);
    manifest::members(object, to.reflection);
    if (object.has("d3d12")) {
      RootSignatureOf<ReadObject> root_signature{to.reflection};
      object("d3d12", root_signature);
    }
    const Path of_files(path, "files");
    for (auto& [name, kinds] : files) target(id, name, kinds, Path(of_files, name), to);
    for (const auto& [name, good] : validated) {
      for (ManifestCode& code : to.targets) {
        if (targetName(code.target) == name) code.validated = good;
      }
    }
    object.ignore("webgpu");
    object.ignore("metal");
    object.finish();
    Bindings bindings(to.reflection, report_);
    if (const Json* webgpu = json::member(json, "webgpu")) bindings.webgpu(*webgpu, Path(path, "webgpu"));
    if (const Json* metal = json::member(json, "metal"))
      to.argument_buffers = bindings.metal(*metal, Path(path, "metal"));
  }

  /// The paths follow from the id: a manifest that says otherwise leads elsewhere.
  void target(const std::string& id, const std::string& name, NamedTexts& kinds, const Path& path,
              ManifestShader& to) {
    Target target{};
    if (!findTarget(name, target))
      return report_.error("unknown-target", path, fmt::format("there is no target {}", quote(name)));
    for (const auto& [kind, file] : kinds) {
      const bool first = kind == fileKind(target, 0);
      if (!first && kind != fileKind(target, 1)) {
        report_.error("wrong-path", Path(path, kind),
                      fmt::format("{} is no stage of this target", quote(kind)));
        continue;
      }
      const std::string expected = shaderPath(target, id, first ? 0 : 1);
      if (file == expected) continue;
      report_.error("wrong-path", Path(path, kind), "this is not where the shader lies",
                    fmt::format("it must be \"{}\"", expected));
    }
    to.targets.push_back({target, std::move(kinds), {}});
  }

  Diagnostics& wrong_;
  json::Report report_;
  std::map<std::string_view, size_t> places_;  ///< of the shaders, by id
};

tl::unexpected<Diagnostics> noManifest(const std::string& path, std::string pointer, std::string message) {
  return fail("no-manifest", {path, 0, 0, std::move(pointer)}, std::move(message),
              "name what `lacquer gen` of this version wrote: a manifest or a shard");
}

/// "no-manifest" for what is no manifest, or is one of another version or form.
Result<void> checkHead(const Json& manifest, const std::string& path) {
  const Json* version_of = json::member(manifest, "lacquer");
  const Json* files = json::member(manifest, "files");
  const Json* shaders = json::member(manifest, "shaders");
  const bool all = version_of != nullptr && files != nullptr && shaders != nullptr;
  if (!all || !version_of->is_string() || !files->is_array() || !shaders->is_object())
    return noManifest(path, {}, "this is no manifest of Lacquer's");
  const auto written_by = version_of->get<std::string>();
  if (written_by != version())
    return noManifest(path, "/lacquer", "it was written by version " + printable(written_by));
  const Json* schema = json::member(manifest, "schema");
  if (schema == nullptr || !schema->is_number_integer() || *schema != kSchema) {
    return noManifest(path, schema == nullptr ? "" : "/schema",
                      fmt::format("its form (\"schema\") is not {}", kSchema));
  }
  return {};
}

}  // namespace

Result<Manifest> read(std::string_view text, const std::string& path, const Limits& limits) {
  const Result<Json> json = json::parse(text, path, limits);
  if (!json) return tl::make_unexpected(json.error());
  if (Result<void> head = checkHead(*json, path); !head) return tl::make_unexpected(std::move(head.error()));
  Result<Manifest> manifest;
  Diagnostics wrong;
  Reader(path, wrong).read(*json, *manifest);
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  return manifest;
}

}  // namespace lacquer::manifest

namespace lacquer {

std::optional<Manifest> readManifest(const std::string& path, const Options& options, Messages& messages) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return report(limits.error(), path, messages), std::nullopt;
  const Result<std::string> text = readFile(path, limits->file);
  if (!text) return report(text.error(), path, messages), std::nullopt;
  return valueOf(manifest::read(*text, path, *limits), path, messages);
}

}  // namespace lacquer
