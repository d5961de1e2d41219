#include "manifest/text.h"

#include <algorithm>
#include <vector>

#include "manifest/members.h"
#include "targets/target.h"

namespace lacquer {

namespace manifest {

namespace {

/// Writes what members() describes.
class WrittenObject {
public:
  static constexpr bool kReads = false;
  explicit WrittenObject(JsonText& json) : json_(json) {}

  void is(std::string_view) const {}
  template <class T>
  void operator()(std::string_view key, const T& value) {
    json_.key(key);
    put(value);
  }
  template <class T>
  void some(std::string_view key, const T& value) {
    if (!isNothing(value)) (*this)(key, value);
  }

  void put(const std::string& text) { json_.string(text); }
  void put(bool value) { json_.boolean(value); }
  void put(double number) { json_.number(number); }
  template <std::integral T>
  void put(T number) {
    json_.integer(static_cast<int64_t>(number));
  }
  template <class T>
  requires std::is_enum_v<T>
  void put(T value) { json_.string(wordOf(value)); }
  template <class T>
  void put(const std::optional<T>& value) {
    put(*value);
  }
  /// One number, or a list of them.
  void put(const std::vector<double>& numbers) { json_.numbers(numbers); }
  template <class T, size_t N>
  void put(const std::array<T, N>& list) {
    json_.beginArray();
    for (const T& item : list) put(item);
    json_.endArray();
  }
  void put(const Range& range) { put(std::array{range.low, range.high}); }
  /// Infinite ends are words; "nan" stands behind them where there may be no number.
  void put(const Reached& reached) {
    json_.beginArray();
    for (const double end : {reached.low, reached.high}) {
      if (std::isfinite(end))
        json_.number(end);
      else
        json_.string(end < 0 ? "-inf" : "inf");
    }
    if (reached.nan) json_.string("nan");
    json_.endArray();
  }
  template <class T>
  void put(const std::vector<T>& list) {
    if constexpr (!std::is_null_pointer_v<std::remove_const_t<decltype(kKey<T>)>>) {
      json_.beginObject();
      for (const T& item : list) (*this)(item.*kKey<T>, item);
      json_.endObject();
    } else {
      json_.beginArray();
      for (const T& item : list) put(item);
      json_.endArray();
    }
  }
  template <class T>
  void put(const std::vector<std::pair<std::string, T>>& named) {
    json_.beginObject();
    for (const auto& [name, value] : named) (*this)(name, value);
    json_.endObject();
  }
  template <class T>
  requires std::is_class_v<T>
  void put(const T& of) {
    json_.beginObject();
    members(*this, of);
    json_.endObject();
  }

private:
  template <class T>
  static bool isNothing(const T& value) {
    if constexpr (requires { value.has_value(); })
      return !value.has_value();
    else if constexpr (requires { value.empty(); })
      return value.empty();
    else
      return value == T{};
  }

  JsonText& json_;
};

/// The stages that read something, and what describes it, as an item of a list; nothing for what no stage
/// reads. `before` and `behind` write what stands around them.
template <class Before, class Behind>
void writeBound(const BoundResource& of, JsonText& to, const Before& before, const Behind& behind) {
  if (!of.vertex && !of.fragment) return;
  to.beginObject();
  before();
  to.key("visibility").beginArray();
  if (of.vertex) to.string("vertex");
  if (of.fragment) to.string("fragment");
  to.endArray();
  behind();
  to.endObject();
}

std::string_view dimensionOf(std::string_view type) {
  if (type == ir::typeName(ir::Type::TextureCube)) return "cube";
  if (type == ir::typeName(ir::Type::Texture2DArray)) return "2d-array";
  return type == ir::typeName(ir::Type::Texture3D) ? "3d" : "2d";
}

/// The textures that a layout has an entry for: an array stands once, under its own name, with the stages of
/// all its textures.
std::vector<ReflectedTexture> boundTextures(const Reflection& of) {
  std::vector<ReflectedTexture> bound;
  for (const ReflectedTexture& texture : of.textures) {
    const bool shared = !texture.array.empty();
    const auto same = std::find_if(bound.begin(), bound.end(), [&](const ReflectedTexture& other) {
      return shared && other.array == texture.array;
    });
    if (same != bound.end()) {
      same->vertex = same->vertex || texture.vertex;
      same->fragment = same->fragment || texture.fragment;
      continue;
    }
    ReflectedTexture& added = bound.emplace_back(texture);
    if (shared) added.name = added.array;
  }
  return bound;
}

/// "bindings": what createBindGroupLayout() wants, in its words, with the group of each; "limits": what
/// requestDevice() must be asked for beyond WebGPU's defaults, with colour attachments of `rgba16float`.
void writeWebGpu(const Reflection& of, JsonText& to) {
  to.beginObject().key("bindings").beginArray();
  const auto row = [&](const BoundResource& bound, const std::string& name, uint32_t binding,
                       const auto& describe) {
    writeBound(
        bound, to,
        [&] {
          to.key("name").string(name).key("group").integer(bound.wgsl.group).key("binding").integer(binding);
        },
        describe);
  };
  for (const UniformBlock& block : of.blocks) {
    row(block, block.name, block.wgsl.binding, [&] {
      to.key("buffer").beginObject();
      to.key("type").string(block.list.empty() ? "uniform" : "read-only-storage");
      to.key("minBindingSize").integer(std::max(block.array, 1U) * block.size).endObject();
    });
  }
  for (const ReflectedTexture& texture : boundTextures(of)) {
    const bool compares = texture.type == ir::typeName(ir::Type::Texture2DShadow);
    // An object's textures hold numbers in 32-bit floats, which WebGPU does not filter.
    const bool numbers = texture.role == TextureRole::Object;
    row(texture, texture.name, texture.wgsl.binding, [&] {
      to.key("texture").beginObject();
      to.key("sampleType").string(compares ? "depth" : numbers ? "unfilterable-float" : "float");
      to.key("viewDimension").string(dimensionOf(texture.type)).endObject();
    });
    row(texture, texture.sampler, texture.wgsl.sampler, [&] {
      to.key("sampler").beginObject().key("type");
      to.string(compares ? "comparison" : numbers ? "non-filtering" : "filtering").endObject();
    });
  }
  to.endArray().key("limits").beginObject();
  for (const auto& [name, number] : of.webgpu_limits) to.key(name).integer(static_cast<int64_t>(number));
  to.endObject().endObject();
}

/// "entry", the function's name; "argument_buffers"; and "bindings": the stages that read it, and the
/// `buffer`, or the `texture` and the `sampler`, of each block and texture; in argument buffers the
/// `argument_buffer` and the `id`, of a texture the `sampler_id`, too.
void writeMetal(const Reflection& of, bool argument_buffers, JsonText& to) {
  to.beginObject().key("entry").string("main0").key("argument_buffers").boolean(argument_buffers);
  to.key("bindings").beginArray();
  const auto row = [&](const BoundResource& bound, const std::string& name, bool block) {
    const MslPlace& at = argument_buffers ? bound.msl_argument : bound.msl;
    writeBound(
        bound, to,
        [&] {
          to.key("name").string(name);
          if (argument_buffers) to.key("argument_buffer").integer(at.argument_buffer);
          to.key(argument_buffers ? "id" : block ? "buffer" : "texture").integer(at.index);
          if (!block) to.key(argument_buffers ? "sampler_id" : "sampler").integer(at.sampler);
        },
        [] {});
  };
  for (const UniformBlock& block : of.blocks) row(block, block.name, true);
  for (const ReflectedTexture& texture : boundTextures(of)) row(texture, texture.name, false);
  to.endArray().endObject();
}

/// Whether one of the targets is bound as this member says: "d3d12", "webgpu", "metal".
bool isShown(std::string_view member, std::span<const Target> targets) {
  return std::any_of(targets.begin(), targets.end(),
                     [&](Target target) { return targets::row(target).binds == member; });
}

void writeReflectionMembers(const Reflection& of, std::span<const Target> targets, bool argument_buffers,
                            JsonText& to) {
  WrittenObject object(to);
  members(object, of);
  if (isShown("d3d12", targets)) {
    const RootSignatureOf<WrittenObject> root_signature{of};
    object("d3d12", root_signature);
  }
  if (isShown("webgpu", targets)) {
    to.key("webgpu");
    writeWebGpu(of, to);
  }
  if (isShown("metal", targets)) {
    to.key("metal");
    writeMetal(of, argument_buffers || of.bindless, to);
  }
}

}  // namespace

void write(const ContractMaterial& of, JsonText& to) { WrittenObject(to).put(of); }
void write(const FileContract& of, JsonText& to) { WrittenObject(to).put(of); }
void write(const ShaderOutput& of, JsonText& to) { WrittenObject(to).put(of); }
void write(const Blend& of, JsonText& to) { WrittenObject(to).put(of); }

void beginFile(const std::string& source, JsonText& to) {
  to.beginObject().key("source").string(source).key("materials").beginArray();
}

void endFile(const FileContract& of, JsonText& to) {
  to.endArray();
  WrittenObject object(to);
  behindMaterials(object, of);
  to.endObject();
}

void writeLevels(const std::vector<MaterialLevels>& of, JsonText& to) { WrittenObject(to).put(of); }

ManifestCode codeOf(Target target, const std::string& id, bool has_vertex, bool validated) {
  ManifestCode code{target, {}, {}};
  for (int stage = firstStage(target, has_vertex); stage < 2; ++stage)
    code.files.emplace_back(fileKind(target, stage), shaderPath(target, id, stage));
  if (isShader(target)) code.validated = validated;
  return code;
}

void writeReflection(const Reflection& of, std::span<const Target> targets, bool argument_buffers,
                     JsonText& to) {
  to.beginObject();
  writeReflectionMembers(of, targets, argument_buffers, to);
  to.endObject();
}

void writeShader(std::span<const ManifestCode> code, const Reflection& of, bool argument_buffers,
                 JsonText& to) {
  std::vector<Target> targets;
  to.beginObject().key("files").beginObject();
  for (const ManifestCode& one : code) {
    targets.push_back(one.target);
    to.key(targetName(one.target));
    WrittenObject(to).put(one.files);
  }
  to.endObject().key("validated").beginObject();
  for (const ManifestCode& one : code) {
    if (one.validated) to.key(targetName(one.target)).boolean(*one.validated);
  }
  to.endObject();
  writeReflectionMembers(of, targets, argument_buffers, to);
  to.endObject();
}

Writer::Writer(Append append, std::string_view version) : append_(std::move(append)) {
  JsonText name(1);
  append_("{\n  \"lacquer\": " + name.string(version).take() + ",\n  \"schema\": " + std::to_string(kSchema) +
          ",\n  \"files\": [");
}

void Writer::file(std::string_view entry) {
  append_(files_++ == 0 ? "\n    " : ",\n    ");
  append_(entry);
}

void Writer::beginShaders() { append_(files_ == 0 ? "],\n  \"shaders\": {" : "\n  ],\n  \"shaders\": {"); }

void Writer::shader(std::string_view id, std::string_view entry) {
  if (shaders_ == 0) beginShaders();
  append_(shaders_++ == 0 ? "\n    " : ",\n    ");
  append_(JsonText().string(id).take() + ": ");
  append_(entry);
}

void Writer::finish(const std::vector<MaterialLevels>& levels) {
  if (shaders_ == 0) beginShaders();
  append_(shaders_ == 0 ? "}" : "\n  }");
  if (!levels.empty()) {
    JsonText text(1);
    WrittenObject(text).put(levels);
    append_(",\n  \"levels\": " + text.take());
  }
  append_("\n}\n");
}

}  // namespace manifest

std::string looksJson(const Looks& looks) {
  json::JsonText text;
  manifest::WrittenObject(text).put(looks);
  return text.take();
}

std::string_view passName(Pass pass) { return manifest::wordOf(pass); }

std::string manifestJson(const Manifest& of) {
  std::string text;
  manifest::Writer writer([&](std::string_view part) { text += part; }, of.lacquer);
  const auto entry = [](const auto& write) {
    json::JsonText json(manifest::kEntryDepth);
    write(json);
    return json.take();
  };
  for (const FileContract& file : of.files)
    writer.file(entry([&](json::JsonText& json) { manifest::write(file, json); }));
  for (const ManifestShader& shader : of.shaders) {
    writer.shader(shader.id, entry([&](json::JsonText& json) {
                    manifest::writeShader(shader.targets, shader.reflection, shader.argument_buffers, json);
                  }));
  }
  writer.finish(of.levels);
  return text;
}

}  // namespace lacquer
