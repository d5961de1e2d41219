#include "targets/samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cassert>
#include <functional>

#include "targets/legalize.h"

namespace lacquer::targets {

using ir::Op;
using ir::Rate;
using ir::Stage;
using ir::Type;
using ir::ValueId;

uint32_t Builder::block(ir::BlockRole role, std::string name, std::string instance,
                        std::vector<std::pair<std::string, Type>> fields, uint32_t array) {
  ir::Block block{role, std::move(name), std::move(instance), {}, array, 0};
  for (auto& [field, type] : fields) block.fields.push_back({std::move(field), type, 0, {}, {}});
  block.size = ir::layout(block.fields);
  // The places that the library's templates come to.
  constexpr ir::Binding kPlaces[] = {{0, 0, 0}, {0, 1, 1}, ir::kMaterialBinding, {2, 0, 3}};
  block.binding = kPlaces[static_cast<size_t>(role)];
  const auto index = static_cast<uint32_t>(module.blocks.size());
  for (uint32_t f = 0; f < block.fields.size(); ++f) {
    if (block.fields[f].name == "light_count") module.light_count = {index, f};
  }
  module.blocks.push_back(std::move(block));
  return index;
}

ValueId Builder::field(std::string_view path, int32_t element) {
  const size_t dot = path.find('.');
  for (uint32_t b = 0; b < module.blocks.size(); ++b) {
    const ir::Block& block = module.blocks[b];
    if (block.instance != path.substr(0, dot)) continue;
    for (uint32_t f = 0; f < block.fields.size(); ++f) {
      if (block.fields[f].name != path.substr(dot + 1)) continue;
      const bool looped = block.array != 0 && element < 0;
      const Rate rate = block.role == ir::BlockRole::Object ? Rate::Vertex
                        : looped                            ? Rate::Light
                                                            : Rate::Frame;
      return dag().input(
          {ir::InputKind::BlockField, std::string(path), block.fields[f].type, rate, {}, b, f, element});
    }
  }
  assert(false && "no such field");
  return ir::kNoValue;
}

ValueId Builder::texture(std::string name, Type type, bool environment) {
  uint32_t n = 0;
  for (const ir::TextureSlot& slot : module.textures) n += slot.environment == environment ? 1 : 0;
  const ir::Binding binding = environment ? ir::Binding{0, 2 + n, n} : ir::Binding{1, 1 + n, 3 + n};
  const auto index = static_cast<uint32_t>(module.textures.size());
  ir::TextureSlot slot;
  slot.name = name;
  slot.type = type;
  slot.environment = environment;
  slot.binding = binding;
  module.textures.push_back(std::move(slot));
  return dag().input({ir::InputKind::Texture, std::move(name), type, Rate::Frame, {}, 0, index});
}

ValueId Builder::attribute(std::string name, Type type) {
  const auto index = static_cast<uint32_t>(module.attributes.size());
  module.attributes.push_back({name, type, index});
  return dag().input({ir::InputKind::Attribute, std::move(name), type, Rate::Vertex, {}, 0, index});
}

ValueId Builder::varying(std::string name, ValueId source) {
  const auto index = static_cast<uint32_t>(module.varyings.size());
  const Type type = dag()[source].type;
  module.varyings.push_back({name, type, index, source});
  module.outputs.push_back({ir::OutputKind::Varying, Stage::Vertex, name, index, source});
  return dag().input({ir::InputKind::Varying, std::move(name), type, Rate::Fragment, {}, 0, index});
}

void Builder::color(std::string name, ValueId value, uint32_t location) {
  module.outputs.push_back({ir::OutputKind::Color, Stage::Fragment, std::move(name), location, value});
}

void Builder::position(ValueId clip_position) {
  module.outputs.push_back({ir::OutputKind::Position, Stage::Vertex, "position", 0, clip_position});
}

void Builder::discard(ValueId condition) {
  module.outputs.push_back({ir::OutputKind::Discard, Stage::Fragment, "discard", 0, condition});
}

ValueId Builder::named(ValueId value, std::string_view name) {
  dag().name(value, name);
  return value;
}

namespace {

void addFrame(Builder& b) {
  b.block(ir::BlockRole::Frame, "Frame", "frame",
          {{"view_projection", Type::Mat4},
           {"camera_position", Type::Vec3},
           {"light_count", Type::Int},
           {"exposure", Type::Float}});
}

void addLights(Builder& b) {
  b.block(ir::BlockRole::Lights, "Light", "light",
          {{"direction", Type::Vec3}, {"range", Type::Float}, {"color", Type::Vec3}, {"type", Type::Int}},
          16);
}

}  // namespace

ir::Module litSample(ir::LightGroup group) {
  Builder b;
  ir::Dag& dag = b.dag();
  addFrame(b);
  addLights(b);
  b.block(ir::BlockRole::Material, "Material", "material",
          {{"base_color", Type::Vec3}, {"roughness", Type::Float}, {"uv_scale", Type::Vec2}});
  b.block(ir::BlockRole::Object, "Object", "object", {{"model", Type::Mat4}});
  b.module.light_groups = {group};

  b.term("vertex.position", "");
  const ValueId local = dag.construct(Type::Vec4, {b.attribute("POSITION", Type::Vec3), dag.constant(1)});
  const ValueId world = b.named(dag.make(Op::MatMul, {b.field("object.model"), local}), "world_position");
  b.position(dag.make(Op::MatMul, {b.field("frame.view_projection"), world}));
  const ValueId position = b.varying("position", dag.swizzle(world, {{0, 1, 2}}));
  const ValueId normal_in = b.varying("normal", b.attribute("NORMAL", Type::Vec3));
  const ValueId uv = b.varying("uv", b.attribute("TEXCOORD_0", Type::Vec2));

  b.term("surface.normal", "glTF 2.0, \"Double Sided\"");
  const ValueId front =
      dag.input({ir::InputKind::FrontFacing, "front_facing", Type::Bool, Rate::Fragment, {}});
  const ValueId unit = b.named(dag.make(Op::Normalize, {normal_in}), "unit_normal");
  const ValueId normal = b.named(dag.make(Op::Select, {front, unit, dag.make(Op::Neg, {unit})}), "normal");

  b.term("base.color", "glTF 2.0, \"Metallic-Roughness Material\"");
  const ValueId map = b.texture("base_color_texture", Type::Texture2D);
  const ValueId texel = dag.make(Op::Texture, {map, dag.mul(uv, b.field("material.uv_scale"))});
  const ValueId base =
      b.named(dag.mul(dag.swizzle(texel, {{0, 1, 2}}), b.field("material.base_color")), "base_color");

  b.term("base.lambert", "glTF 2.0, B.3.1");
  const ValueId n_dot_l = dag.make(Op::Dot, {normal, b.field("light.direction")});
  const ValueId facing = b.named(dag.make(Op::Max, {dag.constant(0), n_dot_l}), "n_dot_l");
  const ValueId ranged = dag.make(Op::WholeEqual, {b.field("light.type"), dag.integer(1)});
  const ValueId fade = dag.make(Op::Select, {ranged, b.field("light.range"), dag.constant(1)});
  const ValueId each = dag.mul(dag.mul(base, b.field("light.color")), dag.mul(facing, fade));
  const ValueId sum = b.named(dag.make(Op::SumOverLights, {each}, 0), "direct");

  b.term("environment.specular", "");
  const ValueId cube = b.texture("environment_texture", Type::TextureCube, true);
  const ValueId view = dag.make(Op::Normalize, {dag.sub(b.field("frame.camera_position"), position)});
  const ValueId lod = dag.mul(b.field("material.roughness"), dag.constant(8));
  const ValueId reflected = dag.swizzle(dag.make(Op::TextureLod, {cube, view, lod}), {{0, 1, 2}});
  const ValueId light = dag.mul(dag.add(sum, b.named(reflected, "reflected")), b.field("frame.exposure"));
  b.color("color", dag.construct(Type::Vec4, {light, dag.component(texel, 3)}));
  return b.module;
}

namespace {

/// Every operation on integers, of variables and of numbers written out.
void wholes(Builder& b, const std::array<ValueId, 3>& floats,
            const std::function<void(ValueId, const std::string&)>& take) {
  ir::Dag& dag = b.dag();
  const ValueId i = b.named(dag.make(Op::ToInt, {floats[0]}), "number");
  const ValueId u = b.named(dag.make(Op::ToUInt, {floats[1]}), "bits");
  for (int k = 0; k < ir::kOpCount; ++k) {
    const Op op = static_cast<Op>(k);
    const ir::OpInfo& row = ir::info(op);
    if (!ir::ofWholes(row.signature)) continue;
    for (const bool without_sign : {false, true}) {
      const Type type = without_sign ? Type::UInt : Type::Int;
      const bool shift = row.signature == ir::Signature::Shift;
      const std::array<Type, 2> types = {type, shift ? Type::UInt : type};
      if (!ir::resultType(op, std::span(types).first(static_cast<size_t>(row.arity)))) continue;
      const ValueId a = without_sign ? u : i;
      std::vector<ValueId> others = {shift ? dag.make(Op::BitAnd, {u, dag.uinteger(31)})
                                           : dag.make(Op::BitOr, {a, dag.constant(type, {5})}),
                                     shift ? dag.uinteger(7) : dag.constant(type, {-3})};
      if (row.arity == 1) others.resize(1);
      for (const ValueId other : others) {
        const std::array<ValueId, 2> operands = {a, other};
        const ValueId made = dag.make(op, std::span(operands).first(static_cast<size_t>(row.arity)));
        const std::string name = fmt::format("{}_{}_{}", row.name, ir::typeName(type), dag.isConstant(other));
        if (row.signature == ir::Signature::WholeTest) {
          take(dag.make(Op::Select, {made, floats[0], floats[2]}), name);
        } else {
          const ValueId named = b.named(made, name);
          take(dag.make(without_sign ? Op::FromUInt : Op::FromInt, {named}), name + "_number");
        }
      }
    }
  }
  const ValueId back = dag.make(Op::AsInt, {dag.make(Op::WholeAdd, {dag.make(Op::AsUInt, {i}), u})});
  const ValueId chosen =
      dag.make(Op::Select, {dag.make(Op::Less, {floats[0], floats[1]}), back, dag.integer(INT32_MIN)});
  take(dag.make(Op::FromInt, {chosen}), "converted");
}

}  // namespace

ir::Module fixedSample() {
  Builder b;
  ir::Dag& dag = b.dag();
  addLights(b);
  const ValueId uv = b.varying("uv", b.attribute("TEXCOORD_1", Type::Vec2));
  const ValueId weight = b.varying("weight", dag.component(b.attribute("COLOR_0", Type::Vec4), 3));
  b.module.outputs.clear();  // the vertex stage is another's
  b.term("alpha.mask", "glTF 2.0, \"Alpha Coverage\"");
  b.discard(dag.make(Op::Less, {weight, dag.constant(0.5)}));
  b.term("odd\nname\\", "a line that must not continue \\");
  const ValueId two = dag.construct(Type::Vec2, {weight});
  b.color("first", dag.construct(Type::Vec4, {dag.add(uv, two), dag.constant(Type::Vec2, {1, 1})}), 0);
  const ValueId light = dag.mul(b.field("light.color", 2), weight);
  b.color("second", dag.construct(Type::Vec4, {light, dag.constant(1e-7)}), 1);
  return b.module;
}

ir::Module everyOpSample() {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId x = b.varying("x", b.attribute("WEIGHTS_0", Type::Vec4));
  const ValueId v3 = b.varying("v3", b.attribute("NORMAL", Type::Vec3));
  b.module.outputs.clear();
  const std::array<ValueId, 3> vectors = {v3, dag.swizzle(v3, {{1, 2, 0}}), dag.swizzle(x, {{0, 1, 2}})};
  const std::array<ValueId, 3> floats = {dag.component(x, 3), dag.component(x, 2), dag.component(x, 1)};
  ValueId total = dag.constant(Type::Vec3, {0.25, 0.5, 1});
  const auto take = [&](ValueId value, const std::string& name) {
    total = dag.add(total, b.named(value, name));
  };
  for (int i = 0; i < ir::kOpCount; ++i) {
    const Op op = static_cast<Op>(i);
    const ir::OpInfo& row = ir::info(op);
    if (row.signature != ir::Signature::Map) continue;
    // All mixtures of vectors and floats, numbers written out included.
    for (uint32_t mask = 0; mask < 1U << row.arity; ++mask) {
      for (const bool literal : {false, true}) {
        std::vector<ValueId> operands;
        for (size_t k = 0; k < static_cast<size_t>(row.arity); ++k) {
          const bool vector = (mask >> k & 1U) != 0;
          operands.push_back(vector    ? vectors[k]
                             : literal ? dag.constant(0.3 + 0.1 * static_cast<double>(k))
                                       : floats[k]);
        }
        if (literal && mask == 0) continue;
        take(dag.make(op, operands), fmt::format("{}_{}_{}", row.name, mask, literal ? "literal" : "value"));
      }
    }
  }
  wholes(b, floats, take);
  take(dag.make(Op::Cross, {v3, vectors[2]}), "cross_product");
  take(dag.make(Op::Length, {v3}), "length_of");
  take(dag.make(Op::Dot, {v3, vectors[2]}), "dot_product");
  take(dag.make(Op::Normalize, {v3}), "unit");
  take(dag.make(Op::DFdx, {v3}), "along_x");
  take(dag.make(Op::DFdy, {v3}), "along_y");
  const ValueId below = dag.make(Op::Less, {floats[0], floats[1]});
  const ValueId not_above = dag.make(Op::LessEqual, {floats[1], floats[2]});
  const ValueId same = dag.make(Op::Equal, {floats[0], floats[2]});
  const ValueId either = dag.make(Op::Or, {dag.make(Op::And, {below, dag.make(Op::Not, {not_above})}), same});
  take(dag.make(Op::Select, {either, v3, vectors[1]}), "choice");
  take(dag.construct(Type::Vec3, {dag.add(floats[0], floats[1])}), "splat");
  // A bool that has a variable.
  take(dag.make(Op::Select, {b.named(dag.make(Op::Not, {same}), "differ"), v3, dag.constant(Type::Vec3, {})}),
       "where_they_differ");
  b.color("color", dag.construct(Type::Vec4, {total, dag.constant(1)}));
  return b.module;
}

ir::Module lookupsSample() {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId uv = b.varying("uv", b.attribute("TEXCOORD_1", Type::Vec2));
  const ValueId way = b.varying("way", b.attribute("NORMAL", Type::Vec3));
  b.module.outputs.clear();
  const ValueId along_x = dag.make(Op::DFdx, {uv});
  const ValueId along_y = dag.make(Op::DFdy, {uv});
  ValueId total = dag.constant(Type::Vec4, {});
  ValueId sizes = dag.integer(0);
  const std::array kTypes = {std::pair{Type::Texture2D, "map"}, std::pair{Type::TextureCube, "around"},
                             std::pair{Type::Texture2DShadow, "depths"},
                             std::pair{Type::Texture2DArray, "tiles"}, std::pair{Type::Texture3D, "volume"}};
  for (const auto& [type, name] : kTypes) {
    const ValueId texture = b.texture(name, type, type != Type::Texture2D);
    if (type != Type::Texture2DShadow) {
      const bool flat = ir::derivativeType(type) == Type::Vec2;
      const ValueId at = ir::coordinateType(type) == Type::Vec2 ? uv : way;
      const ValueId x = flat ? along_x : dag.make(Op::DFdx, {way});
      const ValueId y = flat ? along_y : dag.make(Op::DFdy, {way});
      total =
          dag.add(total, b.named(dag.make(Op::TextureGrad, {texture, at, x, y}), fmt::format("of_{}", name)));
    }
    const ValueId level = dag.make(Op::ToInt, {dag.component(uv, 0)});
    for (int axis = 0; axis < ir::sizeCount(type); ++axis) {
      const ValueId asked = axis == 0 ? level : dag.integer(0);
      sizes = dag.make(Op::WholeAdd,
                       {sizes, dag.make(Op::TextureSize, {texture, asked}, static_cast<uint32_t>(axis))});
    }
  }
  b.color("color", total, 0);
  b.color("weight", dag.component(uv, 1), 1);
  b.color("place", uv, 2);
  b.color("texels", sizes, 3);
  b.color("bits", dag.make(Op::AsUInt, {sizes}), 4);
  b.module.outputs.push_back(
      {ir::OutputKind::Depth, Stage::Fragment, "nearness", 0,
       dag.make(Op::Clamp, {dag.component(way, 2), dag.constant(0), dag.constant(1)})});
  return b.module;
}

std::string print(ir::Module module, Stage stage, Target target, std::string_view head) {
  targets::legalize(module);
  return printText(module, schedule::schedule(module, stage), target, head);
}

namespace {

std::string joined(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + '\n';
  return text;
}

}  // namespace

check::Spirv expectCompiles(const std::string& text, Stage stage, Target target) {
  const check::Stage check_stage = stage == Stage::Vertex ? check::Stage::Vertex : check::Stage::Fragment;
  const std::string name = fmt::format("shader.{}", row(target).name);
  if (target == Target::Wgsl) {
    if (!check::haveTint()) return {};
    const Diagnostics wrong = check::compileWithTint(text, name);
    EXPECT_TRUE(wrong.empty()) << joined(wrong) << text;
    return {};
  }
  const Result<check::Spirv> words = check::compile(text, target, check_stage, name);
  if (!words) {
    ADD_FAILURE() << joined(words.error()) << text;
    return {};
  }
  if (!words->empty()) {
    const Diagnostics wrong = check::validate(*words, target == Target::GlslGl, name);
    EXPECT_TRUE(wrong.empty()) << joined(wrong) << text;
  }
  if (target == Target::Hlsl) {
    const Result<check::Spirv> model_5 =
        check::compile("#define LACQUER_SPACES 0\n" + text, target, check_stage, name);
    EXPECT_TRUE(model_5) << text;
  }
  if (target == Target::Hlsl && check::haveDxc()) {
    const Diagnostics wrong = check::compileWithDxc(text, check_stage, name);
    EXPECT_TRUE(wrong.empty()) << joined(wrong) << text;
  }
  return *words;
}

}  // namespace lacquer::targets
