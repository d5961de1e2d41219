// How each value of a manifest is JSON: one description of its members, by which it is written (text.cpp) and
// read (read.cpp).
//
// `a(KEY, VALUE)` is a member that is always there, `a.some(KEY, VALUE)` one that is there where the value is
// not empty, false, 0 or nothing. Lists of what has a name of its own, and pairs, are objects.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <type_traits>
#include <vector>

#include "lacquer/manifest.h"
#include "setting/attributes.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/print.h"

namespace lacquer::manifest {

/// A value that is described: const where it is written.
template <class A, class T>
using Of = std::conditional_t<A::kReads, T, const T>;

/// The words of an enumeration, in its order; one without a word is no member.
template <class Enum>
struct Words;
template <>
struct Words<BlockRole> {
  static constexpr std::string_view kAll[] = {"frame", "lights", "material", "object", "list"};
};
template <>
struct Words<TextureRole> {
  static constexpr std::string_view kAll[] = {"material", "environment", "object"};
};
template <>
struct Words<RootKind> {
  static constexpr std::string_view kAll[] = {"constants", "block", "blocks", "textures", "samplers"};
};
template <>
struct Words<Message::Level> {
  static constexpr std::string_view kAll[] = {"note", "warning", "error"};
};
template <>
struct Words<AlphaMode> {
  static constexpr std::string_view kAll[] = {"OPAQUE", "MASK", "BLEND"};
};
template <>
struct Words<Pass> {
  static constexpr std::string_view kAll[] = {"opaque", "masked", "looks_through", "blended"};
};
template <>
struct Words<BlendFactor> {
  static constexpr std::string_view kAll[] = {"zero", "one", "src-alpha", "one-minus-src-alpha"};
};
template <>
struct Words<Wrap> {
  static constexpr std::string_view kAll[] = {"repeat", "clamp", "mirror"};
};
template <>
struct Words<Filter> {
  static constexpr std::string_view kAll[] = {"",
                                              "nearest",
                                              "linear",
                                              "nearest-mipmap-nearest",
                                              "linear-mipmap-nearest",
                                              "nearest-mipmap-linear",
                                              "linear-mipmap-linear"};
};
template <>
struct Words<Change> {
  static constexpr std::string_view kAll[] = {"nothing", "numbers", "textures", "program"};
};
/// That reads a block or a texture.
enum class Stage : uint8_t { Vertex, Fragment };
template <>
struct Words<Stage> {
  static constexpr std::string_view kAll[] = {"vertex", "fragment"};
};
/// Empty for what is no enumerator.
template <class Enum>
std::string_view wordOf(Enum value) {
  const auto place = static_cast<size_t>(value);
  return place < std::size(Words<Enum>::kAll) ? Words<Enum>::kAll[place] : std::string_view();
}

/// Lists of these are objects, whose keys are this member; of others nullptr.
template <class T>
inline constexpr std::nullptr_t kKey = nullptr;
template <>
inline constexpr std::string UsedParameter::*kKey<UsedParameter> = &UsedParameter::name;
template <>
inline constexpr std::string UsedTexture::*kKey<UsedTexture> = &UsedTexture::slot;
template <>
inline constexpr std::string PropertyUse::*kKey<PropertyUse> = &PropertyUse::pointer;
template <>
inline constexpr std::string StoredAttribute::*kKey<StoredAttribute> = &StoredAttribute::semantic;

/// A value that others share: read, it is a new one. `each` gives its members.
template <class A, class T, class Each>
void shared(A&, std::shared_ptr<const T>& of, const Each& each) {
  auto made = std::make_shared<T>();
  each(*made);
  of = std::move(made);
}
template <class A, class T, class Each>
void shared(A&, const std::shared_ptr<const T>& of, const Each& each) {
  const T none{};
  each(of == nullptr ? none : *of);
}

// -- files

template <class A>
void members(A& a, Of<A, Message>& of) {
  a.is("the diagnostic");
  a("code", of.code);
  a("severity", of.level);
  a.some("pointer", of.pointer);
  a("message", of.message);
  a.some("help", of.help);
  if constexpr (A::kReads) of = toMessage(toDiagnostic(of));
}

template <class A>
void members(A& a, Of<A, TextureTransform>& of) {
  a.is("the transform");
  a("offset", of.offset);
  a("rotation", of.rotation);
  a("scale", of.scale);
}

/// "srgb" or "linear".
template <class A>
void colorSpace(A& a, Of<A, bool>& srgb) {
  std::string word = srgb ? "srgb" : "linear";
  a("color_space", word);
  if constexpr (A::kReads) srgb = word == "srgb";
}

/// One texel in the place of a texture.
struct StandIn {
  std::array<double, 4> texel{};
  bool srgb = false;
};
template <class A>
void members(A& a, Of<A, StandIn>& of) {
  a.is("the texel");
  a("texel", of.texel);
  colorSpace(a, of.srgb);
}

template <class A>
void members(A& a, Of<A, UsedParameter>& of) {
  a.is("the parameter");
  a("value", of.value);
  a("pointer", of.pointer);
  a.some("animated", of.animated);
  a.some("stand_in", of.stand_in);
}

template <class A>
void members(A& a, Of<A, TextureSampler>& of) {
  a.is("the sampler");
  a("wrap_s", of.wrap_s);
  a("wrap_t", of.wrap_t);
  a.some("mag_filter", of.mag_filter);
  a.some("min_filter", of.min_filter);
}

template <class A>
void members(A& a, Of<A, UsedTexture>& of) {
  a.is("the texture");
  a("texture", of.texture);
  a("pointer", of.pointer);
  a.some("file", of.file);
  a.some("sampler", of.sampler);
  a.some("default", of.color);
  a.some("texcoord", of.texcoord);
  a.some("transform", of.transform);
  std::optional<StandIn> stand_in;
  if (of.stand_in) stand_in = StandIn{*of.stand_in, of.srgb};
  a.some("stand_in", stand_in);
  if constexpr (A::kReads) {
    if (stand_in) of.stand_in = stand_in->texel, of.srgb = stand_in->srgb;
  }
}

template <class A>
void members(A& a, Of<A, PropertyUse>& of) {
  a.is("the property");
  a("change", of.change);
  a.some("name", of.name);
  a.some("live", of.live);
}

/// What a use and its fallback say of their shaders.
template <class A>
void filled(A& a, Of<A, ContractUse>& of) {
  a("parameters", of.parameters);
  a("uniforms", of.uniforms);
  a("textures", of.textures);
  a.some("properties", of.properties);
  std::optional<Strings> stand_ins;
  if (of.shares_program) stand_ins = of.stand_in_attributes;
  a.some("stand_in_attributes", stand_ins);
  if constexpr (A::kReads) {
    of.shares_program = stand_ins.has_value();
    if (stand_ins) of.stand_in_attributes = std::move(*stand_ins);
  }
}

/// Of one whose shader is the use's own there is nothing but its name.
struct Fallback {
  std::shared_ptr<const ContractUse> use;
  bool own = false;
};
template <class A>
void members(A& a, Of<A, Fallback>& of) {
  a.is("the fallback");
  if constexpr (A::kReads) of.own = !a.has("uniforms");
  shared(a, of.use, [&](auto& use) {
    a("shader", use.shader_id);
    if (!of.own) filled(a, use);
  });
}

/// Of a use that was read.
inline std::shared_ptr<const ContractUse> fallbackOf(const ContractUse& use, const Fallback& read) {
  auto made = std::make_shared<ContractUse>(use);
  if (read.own) return made;
  *made = *read.use;
  made->attributes = use.attributes;
  made->facts = use.facts;
  return made;
}

template <class A>
void members(A& a, Of<A, ContractUse>& of) {
  a.is("the use");
  Strings attributes;
  if constexpr (!A::kReads) attributes = fromPublic(of.attributes).names();
  a("attributes", attributes);
  if constexpr (A::kReads) of.attributes = attributesOf(attributes);
  a("shader", of.shader_id);
  filled(a, of);
  std::optional<Fallback> fallback;
  if constexpr (!A::kReads) {
    if (of.fallback) fallback = Fallback{of.fallback, of.fallback->shader_id == of.shader_id};
  }
  a.some("fallback", fallback);
  shared(a, of.facts, [&](auto& facts) {
    a("absent_parameters", facts.absent_parameters);
    a("unfilled_ports", facts.unfilled_ports);
  });
  if constexpr (A::kReads) {
    // What is no object has been reported, and is neither.
    if (fallback && (fallback->own || fallback->use)) of.fallback = fallbackOf(of, *fallback);
  }
}

template <class A>
void members(A& a, Of<A, Blend>& of) {
  a.is("the blending");
  std::array color{of.source_color, of.destination_color}, alpha{of.source_alpha, of.destination_alpha};
  a("color", color);
  a("alpha", alpha);
  if constexpr (A::kReads) of = {color[0], color[1], alpha[0], alpha[1]};
}

/// Of a material's entry.
template <class A>
void state(A& a, Of<A, DrawState>& of) {
  a("alpha_mode", of.alpha_mode);
  if (of.alpha_mode == AlphaMode::Mask) a("alpha_cutoff", of.alpha_cutoff);
  a("pass", of.pass);
  a("depth_write", of.depth_write);
  a.some("blend", of.blend);
  a("double_sided", of.double_sided);
}

template <class A>
void members(A& a, Of<A, ContractMaterial>& of) {
  a.is("the material's entry");
  a("index", of.index);
  a("name", of.name);
  a.some("profile", of.profile);
  a.some("surface", of.surface);
  a.some("translation_error", of.translation_error);
  if (!of.profile.empty()) {  // a graph in JSON has none of these
    state(a, of.state);
    a.some("extensions", of.extensions);
  }
  a("uses", of.uses);
  shared(a, of.terms, [&](auto& terms) {
    a("terms", terms.terms);
    a("skipped", terms.skipped);
  });
  a("ignored", of.ignored);
  a("diagnostics", of.messages);
}

template <class A>
void members(A& a, Of<A, StoredAttribute>& of) {
  a.is("the attribute");
  a.some("type", of.type);
  a.some("component_type", of.component_type);
  a.some("normalized", of.normalized);
}

template <class A>
void members(A& a, Of<A, VariantUse>& of) {
  a.is("the variant");
  a("variants", of.variants);
  a("material", of.material);
  a.some("use", of.use);
}

template <class A>
void members(A& a, Of<A, ContractPrimitive>& of) {
  a.is("the primitive");
  a("mesh", of.mesh);
  a("primitive", of.primitive);
  a("material", of.material);
  a.some("use", of.use);
  a("attributes", of.attributes);
  a.some("targets", of.targets);
  a.some("variants", of.variants);
}

template <class A>
void members(A& a, Of<A, TextureImage>& of) {
  a.is("the image");
  a("image", of.image);
  a.some("extension", of.extension);
  a.some("channels", of.channels);
  a.some("layer", of.layer);
}

template <class A>
void members(A& a, Of<A, ContractTexture>& of) {
  a.is("the texture");
  a("images", of.images);
  a.some("swizzled", of.swizzled);
  a("sampler", of.sampler);
}

template <class A>
void members(A& a, Of<A, ContractImage>& of) {
  a.is("the image");
  a.some("uri", of.uri);
  a.some("data_uri", of.data_uri);
  std::optional<int> view;
  if (of.buffer_view >= 0) view = of.buffer_view;
  a.some("buffer_view", view);
  if constexpr (A::kReads) of.buffer_view = view.value_or(-1);
  a.some("mime_type", of.mime_type);
}

// -- looks

template <class A>
void geometryOf(A& a, Of<A, GeometryNames>& of) {
  a.some("geometry", of.paths);
  a.some("collection", of.collection);
}

template <class A>
void members(A& a, Of<A, MaterialAssignment>& of) {
  a.is("the assignment");
  a.some("name", of.name);
  a("material", of.material);
  geometryOf(a, of.geometry);
  a("exclusive", of.exclusive);
}

template <class A>
void members(A& a, Of<A, PropertyAssignment>& of) {
  a.is("the property");
  a("property", of.property);
  a("type", of.type);
  a("value", of.value);
  a.some("target", of.target);
  geometryOf(a, of.geometry);
}

template <class A>
void members(A& a, Of<A, VisibilityAssignment>& of) {
  a.is("the visibility");
  a.some("type", of.type);
  a("visible", of.visible);
  geometryOf(a, of.geometry);
  a.some("viewers", of.viewers.paths);
  a.some("viewer_collection", of.viewers.collection);
}

template <class A>
void members(A& a, Of<A, Look>& of) {
  a.is("the look");
  a("name", of.name);
  a("materials", of.materials);
  a.some("properties", of.properties);
  a.some("visibility", of.visibility);
}

template <class A>
void members(A& a, Of<A, LookGroup>& of) {
  a.is("the group of looks");
  a("name", of.name);
  a("looks", of.looks);
  a.some("default", of.by_default);
}

template <class A>
void members(A& a, Of<A, GeometryCollection>& of) {
  a.is("the collection");
  a("name", of.name);
  a.some("include", of.include);
  a.some("collections", of.collections);
  a.some("exclude", of.exclude);
}

template <class A>
void members(A& a, Of<A, GeometryValue>& of) {
  a.is("the value");
  a("name", of.name);
  a("type", of.type);
  a("value", of.value);
}

template <class A>
void members(A& a, Of<A, GeometryInfo>& of) {
  a.is("the geometry's entry");
  a("name", of.name);
  geometryOf(a, of.geometry);
  a.some("properties", of.properties);
  a.some("tokens", of.tokens);
}

template <class A>
void members(A& a, Of<A, MaterialVariant>& of) {
  a.is("the variant");
  a("material", of.material);
  a("of", of.of);
  a("variants", of.variants);
}

/// Of a file's entry.
template <class A>
void looksOf(A& a, Of<A, Looks>& of) {
  a.some("looks", of.looks);
  a.some("look_groups", of.groups);
  a.some("collections", of.collections);
  a.some("geometry", of.geometry);
  a.some("material_variants", of.variants);
}
template <class A>
void members(A& a, Of<A, Looks>& of) {
  a.is("the looks");
  looksOf(a, of);
}

/// What stands behind a file's materials.
template <class A>
void behindMaterials(A& a, Of<A, FileContract>& of) {
  a.some("default_material", of.default_material);
  a.some("variants", of.variants);
  a.some("primitives", of.primitives);
  a.some("textures", of.textures);
  a.some("images", of.images);
  looksOf(a, of.looks);
  a("diagnostics", of.messages);
}

template <class A>
void members(A& a, Of<A, FileContract>& of) {
  a.is("the file's entry");
  a("source", of.source);
  a("materials", of.materials);
  behindMaterials(a, of);
}

// -- shaders

/// Where it is bound, and for which stages.
template <class A>
void place(A& a, Of<A, BoundResource>& of) {
  a("set", of.at.set);
  a("binding", of.at.binding);
  a("flat", of.at.flat);
  std::vector<Stage> stages;
  if (of.vertex) stages.push_back(Stage::Vertex);
  if (of.fragment) stages.push_back(Stage::Fragment);
  a("stages", stages);
  if constexpr (A::kReads) {
    for (const Stage stage : stages) (stage == Stage::Vertex ? of.vertex : of.fragment) = true;
  }
}

template <class A>
void members(A& a, Of<A, BlockField>& of) {
  a.is("the field");
  a("name", of.name);
  a("type", of.type);
  a("offset", of.offset);
  a.some("array", of.array);
  a.some("stride", of.stride);
  a.some("expression", of.expression);
  a.some("meaning", of.meaning);
}

template <class A>
void members(A& a, Of<A, PreshaderValue>& of) {
  a.is("the value");
  a("name", of.name);
  a("type", of.type);
  a("expression", of.expression);
}

template <class A>
void members(A& a, Of<A, UniformBlock>& of) {
  a.is("the block");
  a("block", of.name);
  a("role", of.role);
  a.some("struct", of.structure);
  place(a, of);
  a.some("list", of.list);
  a.some("array", of.array);
  // Of one element where there are several, and of all of them.
  uint32_t stride = of.array != 0 || !of.list.empty() ? of.size : 0;
  uint32_t size = of.list.empty() ? std::max(of.array, 1U) * of.size : 0;
  a.some("stride", stride);
  if (of.list.empty()) a("size", size);
  if constexpr (A::kReads) of.size = stride != 0 ? stride : size;
  a.some("values", of.values);
  a("fields", of.fields);
}

template <class A>
void members(A& a, Of<A, ReflectedParameter>& of) {
  a.is("the parameter");
  a("name", of.name);
  a("type", of.type);
  a.some("range", of.range);
  a.some("or_zero", of.range.or_zero);
  a("default", of.neutral);
  a.some("meaning", of.meaning);
  a.some("fields", of.fields);
}

template <class A>
void members(A& a, Of<A, SpecConstant>& of) {
  a.is("the specialization constant");
  a("id", of.id);
  a("name", of.name);
  a("component", of.component);
  a("type", of.type);
  if (of.type != "bool") return a("default", of.neutral);
  bool neutral = of.neutral != 0;
  a("default", neutral);
  if constexpr (A::kReads) of.neutral = neutral ? 1 : 0;
}

template <class A>
void members(A& a, Of<A, ReflectedTexture>& of) {
  a.is("the texture");
  a("name", of.name);
  a("type", of.type);
  a("sampler", of.sampler);
  place(a, of);
  a("role", of.role);
  if (of.role == TextureRole::Material) colorSpace(a, of.srgb);
  a.some("array", of.array);
  if (!of.array.empty()) a("number", of.number);
  a.some("layered", of.layered);
  a.some("static_sampler", of.static_sampler);
  if (of.static_sampler) a("static_register", of.static_register);
}

template <class A>
void members(A& a, Of<A, ShaderInput>& of) {
  a.is("the input");
  a("name", of.name);
  a("type", of.type);
  a("location", of.location);
}

template <class A>
void members(A& a, Of<A, ShaderOutput>& of) {
  a.is("the output");
  a("name", of.name);
  a("type", of.type);
  a("location", of.location);
  a.some("holds", of.holds);
}

template <class A>
void members(A& a, Of<A, OperationProof>& of) {
  a.is("the operation");
  a("term", of.term);
  a.some("name", of.name);
  a("operation", of.operation);
  a("rate", of.rate);
  a("operand", of.operand);
  a("need", of.need);
  a("reached", of.reached);
}

/// The part of a shader's entry that says what is proved.
template <class A>
struct ProofsOf {
  Of<A, Reflection>& reflection;
};
template <class A>
void members(A& a, const ProofsOf<A>& of) {
  a.is("the proofs");
  a("safe", of.reflection.proved);
  a("unproved", of.reflection.unproved);
}

template <class A>
void members(A& a, Of<A, RelaxedFigures>& of) {
  a.is("the half precision");
  a("bound", of.bound);
  a("operations", of.operations);
  a("of_operations", of.of_operations);
  a("cycles", of.cycles);
  a("of_cycles", of.of_cycles);
  a("conversions", of.conversions);
}

template <class A>
void members(A& a, Of<A, HalfFigures>& of) {
  a.is("the types of 16 bits");
  a("used", of.used);
  a("by", of.by);
  a("cycles", of.cycles);
  a("of_cycles", of.of_cycles);
}

template <class A>
void members(A& a, Of<A, OptimizedFigures>& of) {
  a.is("the search");
  a("level", of.level);
  a("family", of.family);
  a("by", of.by);
  a("cycles", of.cycles);
  a("of_cycles", of.of_cycles);
  a("error_growth", of.error_growth);
  a("error", of.error);
}

template <class A>
void members(A& a, Of<A, RootParameter>& of) {
  a.is("the root parameter");
  a("kind", of.kind);
  a("space", of.space);
  if (of.kind == RootKind::Block) a("binding", of.binding);
  if (of.kind == RootKind::Blocks) a("count", of.count);
}

/// How Direct3D 12 binds it, of a shader with HLSL.
template <class A>
struct RootSignatureOf {
  Of<A, Reflection>& reflection;
};
template <class A>
void members(A& a, const RootSignatureOf<A>& of) {
  a.is("the root signature");
  a("root_signature", of.reflection.root_signature);
  a("parameters", of.reflection.root_parameters);
}

/// Of every target.
template <class A>
void members(A& a, Of<A, Reflection>& of) {
  a("template", of.template_name);
  a.some("bindless", of.bindless);
  a("uniforms", of.blocks);
  a("parameters", of.parameters);
  if constexpr (A::kReads) of.has_spec_constants = a.has("spec_constants");
  if (of.has_spec_constants) a("spec_constants", of.spec_constants);
  a("textures", of.textures);
  a("inputs", of.inputs);
  a("outputs", of.outputs);
  a.some("depth", of.depth);
  a.some("displaces", of.displaces);
  ProofsOf<A> proofs{of};
  a("proofs", proofs);
  a.some("relaxed", of.relaxed);
  a.some("half", of.half);
  a.some("optimized", of.optimized);
}

// -- levels

/// A mean and the 95th percentile.
template <class A>
struct Spread {
  Of<A, double>&mean, &p95;
};
template <class A>
void members(A& a, const Spread<A>& of) {
  a.is("the difference");
  a("mean", of.mean);
  a("p95", of.p95);
}

template <class A>
void members(A& a, Of<A, SeenDifference>& of) {
  a.is("the difference");
  Spread<A> delta_e{of.delta_e, of.delta_e_95}, flip{of.flip, of.flip_95};
  a("delta_e", delta_e);
  a("flip", flip);
}

/// The costs among a level's figures.
template <class A>
struct CostOf {
  Of<A, LevelFigures>& figures;
};
template <class A>
void members(A& a, const CostOf<A>& of) {
  a.is("the cost");
  a("inverse_throughput", of.figures.cycles);
  a("quarter_rate", of.figures.quarter_cycles);
  a("instructions", of.figures.instructions);
  a("vertex_inverse_throughput", of.figures.vertex_cycles);
  a("counted", of.figures.cost);
}

template <class A>
void members(A& a, Of<A, Level>& of) {
  a.is("the level");
  a("shader", of.shader);
  a("simplify", of.simplify);
  CostOf<A> cost{of.figures};
  a("cost", cost);
  a("error", of.figures.error);
  a.some("error_on_geometry", of.figures.error_on_geometry);
  a.some("screen_size", of.screen_size);
  if (of.screen_size > 0) a("error_at_screen_size", of.error_at_screen_size);
  a.some("error_on_geometry_at_screen_size", of.error_on_geometry_at_screen_size);
}

template <class A>
void members(A& a, Of<A, MaterialLevels>& of) {
  a.is("the material's levels");
  a("source", of.file);
  a("material", of.index);
  a("name", of.name);
  a("uniforms", of.uniforms);
  a("measured", of.measured);
  a("triangles", of.triangles);
  a("radius", of.radius);
  a("levels", of.levels);
}

}  // namespace lacquer::manifest
