#include "targets/spirv/body.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace lacquer::targets::spirv {

using ir::InputKind;
using ir::Op;
using ir::Rate;
using ir::Signature;
using ir::Type;
using ir::ValueId;

namespace {

/// The instruction columns of ops.def.
constexpr std::array<uint32_t, ir::kOpCount> opcodes() {
  using namespace spv;          // NOLINT: ops.def names the opcodes as the specification does
  constexpr uint32_t None = 0;  // NOLINT(readability-identifier-naming)
  return {{
#define OP(e, name, arity, signature, glsl, hlsl, set, instruction, ...) static_cast<uint32_t>(instruction),
#include "ir/ops.def"
#undef OP
  }};
}

constexpr std::array<uint32_t, ir::kOpCount> kOpcodes = opcodes();

/// What lone_component_ says of a value that is needed whole; below it, 1 + the component.
constexpr uint8_t kWhole = 0xff;

/// The ids in splats_ of a value: those of its vectors of 2, 3 and 4 components; where there are types of 16
/// bits, also those of its vectors of 16 bits, and that of the value converted to the other width.
constexpr size_t kSplats = 3, kHalfSplats = 3, kConverted = 6, kHalfForms = 7;

}  // namespace

Body::Body(const ir::Module& module, const schedule::Program& program, const Interface& interface,
           Globals& globals, const SpirvOptions& options)
    : module_(module),
      dag_(module.dag),
      program_(program),
      interface_(interface),
      globals_(globals),
      debug_(options.debug),
      relaxed_(options.relaxed),
      half_(module.half && module.half->used),
      forms_(half_ ? kHalfForms : kSplats),
      live_(program.live),
      loops_(dag_, live_),
      ids_(dag_.size(), 0),
      splats_(dag_.size() * forms_, 0),
      lone_component_(dag_.size(), 0) {
  constexpr size_t kWordsPerValue = 6;
  code_.reserve(live_.size() * kWordsPerValue + 64);
  findLoneComponents();
  findFusedProducts();
}

/// a b + c is one instruction, as are a b - c and c - a b. GPUs have it, and its rounding is within what
/// SPIR-V allows the two. Of two products the one that nothing else reads is preferred, since it need not be
/// made at all; where something does, the sum at least does not wait for it. Positions are left out: what
/// else a stage computes must not decide how they are rounded.
void Body::findFusedProducts() {
  std::vector<uint32_t> uses(dag_.size(), 0);
  for (const ValueId id : live_) {
    for (const ValueId operand : dag_[id].operands()) ++uses[operand];
  }
  for (const ir::Output& output : module_.outputs) ++uses[output.value];
  fused_.assign(dag_.size(), 0);
  product_in_.assign(dag_.size(), 0);
  const std::vector<bool> invariant = ir::ofPositions(module_, program_.stage);
  for (const ValueId id : live_) {
    if (invariant[id]) continue;
    const ir::Value& sum = dag_[id];
    if ((sum.op != Op::Add && sum.op != Op::Sub) || dag_[sum.args[0]].type != dag_[sum.args[1]].type)
      continue;
    for (const size_t k : {size_t{0}, size_t{1}}) {
      const ValueId operand = sum.args[k];
      const ir::Value& product = dag_[operand];
      const bool alike = product.op == Op::Mul && dag_[product.args[0]].type == dag_[product.args[1]].type;
      // What does not change with the light, or from round to round, stays outside of the loop.
      const bool together =
          (product.rate == Rate::Light) == (sum.rate == Rate::Light) && loops_.of(operand) == loops_.of(id);
      // One instruction has one precision.
      if (!alike || !together || relaxed(id) != relaxed(operand) || half(id) != half(operand)) continue;
      product_in_[id] = static_cast<uint8_t>(1 + k);
      if (uses[operand] != 1) continue;
      fused_[operand] = 1;
      break;
    }
  }
}

/// A field of a block that is read for one component only is loaded as that component: one instruction less,
/// and the vector's other components need no registers.
void Body::findLoneComponents() {
  const auto use = [this](ValueId id, uint8_t what) {
    uint8_t& known = lone_component_[id];
    known = known == 0 || known == what ? what : kWhole;
  };
  for (const ValueId id : live_) {
    const ir::Value& v = dag_[id];
    const bool lone = v.op == Op::Swizzle && ir::componentCount(v.type) == 1;
    for (const ValueId operand : v.operands()) {
      use(operand, lone ? static_cast<uint8_t>(1 + ir::swizzleComponent(v.payload, 0)) : kWhole);
    }
  }
  for (const ir::Output& output : module_.outputs) {
    if (output.stage == program_.stage) use(output.value, kWhole);
  }
}

uint32_t Body::write() {
  const uint32_t none = globals_.type(Kind::Void);
  const uint32_t type = globals_.type(Kind::Main);
  const uint32_t function = globals_.newId();
  code_.op(spv::OpFunction, none, function, spv::FunctionControlMaskNone, type);
  label(globals_.newId());
  bool dropped = false;
  for (const schedule::Statement& s : program_.statements) {
    dropped = s.kind == schedule::StatementKind::Discard && dag_.isConstant(s.value, 1);
    if (dropped) break;  // nothing comes after it
    statement(s);
  }
  assert(open_.empty());
  code_.op(dropped ? spv::OpKill : spv::OpReturn);
  code_.op(spv::OpFunctionEnd);
  return function;
}

// -- values --

/// A value with 16 bits or with 32, whatever it was computed with.
uint32_t Body::in(ValueId id, bool half) {
  if (!half_ || !ir::isFloating(dag_[id].type) || this->half(id) == half) return own(id);
  const Type type = dag_[id].type;
  if (half && dag_.isConstant(id)) return globals_.half(type, dag_.constantOf(id).data());
  const size_t slot = id * forms_ + kConverted;
  if (splats_[slot] != 0) return splats_[slot];
  const uint32_t from = own(id);
  const uint32_t to = globals_.type(half ? halfKindOf(type) : kindOf(type));
  const uint32_t made = globals_.newId();
  code_.op(spv::OpFConvert, to, made, from);
  splats_[slot] = made;
  if (!open_.empty()) open_.back().splats.push_back(static_cast<uint32_t>(slot));
  return made;
}

/// A value as it was computed.
uint32_t Body::own(ValueId id) {
  if (ids_[id] != 0) return ids_[id];
  const uint32_t made = make(id);
  ids_[id] = made;
  if (!open_.empty()) open_.back().made.push_back(id);
  return made;
}

uint32_t Body::make(ValueId id) {
  const ir::Value& v = dag_[id];
  switch (ir::info(v.op).signature) {
    case Signature::Special: return special(id);
    case Signature::Map:
    case Signature::Reduce2:
    case Signature::Cross:
    case Signature::Length:
    case Signature::Same:
    case Signature::Compare:
    case Signature::Logic:
    case Signature::Select:
    case Signature::Whole:
    case Signature::WholeTest:
    case Signature::Shift: return operation(id);
  }
  return 0;
}

uint32_t Body::special(ValueId id) {
  const Op op = dag_[id].op;
  // Not a switch: the ops without a hook here are written by their row in ops.def.
  if (op == Op::Constant) return constant(id);
  if (op == Op::Input) return input(id);
  if (op == Op::Construct) return construct(id);
  if (op == Op::Swizzle) return swizzle(id);
  if (op == Op::Element) return element(id);
  if (op == Op::Column) return column(id);
  if (ir::readsTexture(op)) return texture(id);
  if (op == Op::TextureSize) return textureSize(id);
  if (op == Op::TextureAt) return textureAt(id);
  return operation(id);
}

uint32_t Body::fusedSum(ValueId id, size_t product) {
  const ir::Value& sum = dag_[id];
  const ir::Value& factors = dag_[sum.args[product]];
  const bool half = this->half(id);
  std::array<uint32_t, 3> operands{in(factors.args[0], half), in(factors.args[1], half),
                                   in(sum.args[1 - product], half)};
  if (sum.op == Op::Sub) {
    uint32_t& negative = operands[product == 0 ? 2 : 0];
    negative = instruction(id, {ir::SpirvSet::Core, spv::OpFNegate}, &negative, 1);
  }
  return instruction(id, {ir::SpirvSet::Ext, GLSLstd450Fma}, operands.data(), operands.size());
}

uint32_t Body::operation(ValueId id) {
  const ir::Value& v = dag_[id];
  if (product_in_[id] != 0) return fusedSum(id, product_in_[id] - size_t{1});
  Instruction what{ir::info(v.op).spirv_set, kOpcodes[static_cast<size_t>(v.op)]};
  assert(what.set != ir::SpirvSet::None && "placed, and its loop is before it");
  std::array<uint32_t, 4> operands{};
  for (size_t k = 0; k < v.count; ++k) operands[k] = operand(id, k);
  if (v.op == Op::Mul && dag_[v.args[0]].type != dag_[v.args[1]].type) {
    what.opcode = spv::OpVectorTimesScalar;
    if (dag_[v.args[0]].type == Type::Float) std::swap(operands[0], operands[1]);
  }
  assert((v.op != Op::Dot || dag_[v.args[0]].type != Type::Float) && "legalized");
  return instruction(id, what, operands.data(), v.count);
}

/// The id of an operand as the instruction needs it. SPIR-V has no broadcast but OpVectorTimesScalar's.
uint32_t Body::operand(ValueId by, size_t index) {
  const ir::Value& user = dag_[by];
  const ValueId id = user.args[index];
  const Signature signature = ir::info(user.op).signature;
  const bool map = signature == Signature::Map && user.op != Op::Mul && dag_[id].type == Type::Float;
  const bool condition = signature == Signature::Select && index == 0;
  const bool splat = ir::isFloatVector(user.type) && (map || condition);
  return splat ? this->splat(id, user.type, half(by)) : in(id, half(by));
}

/// A vector as wide as `like` with the scalar, a Float or a Bool, in all components.
uint32_t Body::splat(ValueId scalar, Type like, bool half) {
  if (dag_.isConstant(scalar) && dag_[scalar].type == Type::Float) {
    const double x = dag_.constantOf(scalar)[0];
    const std::array<double, 4> all = {x, x, x, x};
    return half ? globals_.half(like, all.data()) : globals_.vector(like, all.data());
  }
  const auto width = static_cast<size_t>(ir::componentCount(like));
  const bool condition = dag_[scalar].type == Type::Bool;
  half = half && !condition;
  const size_t slot = scalar * forms_ + (half ? kHalfSplats : 0) + width - 2;
  if (splats_[slot] != 0) return splats_[slot];
  const uint32_t component = in(scalar, half);
  const uint32_t type = globals_.type(condition ? boolKind(like) : half ? halfKindOf(like) : kindOf(like));
  const uint32_t id = globals_.newId();
  code_.begin(spv::OpCompositeConstruct);
  code_.word(type);
  code_.word(id);
  for (size_t i = 0; i < width; ++i) code_.word(component);
  code_.end();
  if (relaxed(scalar)) globals_.decorations.op(spv::OpDecorate, id, spv::DecorationRelaxedPrecision);
  splats_[slot] = id;
  if (!open_.empty()) open_.back().splats.push_back(static_cast<uint32_t>(slot));
  return id;
}

uint32_t Body::constant(ValueId id) {
  const ir::Components& c = dag_.constantOf(id);
  switch (dag_[id].type) {
    case Type::Bool: return globals_.boolean(c[0] != 0);
    case Type::Int: return globals_.integer(static_cast<int32_t>(c[0]));
    case Type::UInt: return globals_.uinteger(static_cast<uint32_t>(static_cast<int32_t>(c[0])));
    case Type::Float: return globals_.number(c[0]);
    case Type::Vec2:
    case Type::Vec3:
    case Type::Vec4: return globals_.vector(dag_[id].type, c.data());
    case Type::Mat4:
    case Type::Texture2D:
    case Type::TextureCube:
    case Type::Texture2DShadow:
    case Type::Texture2DArray:
    case Type::Texture3D:
    case Type::IVec2:
    case Type::IVec3:
    case Type::IVec4:
    case Type::UVec2:
    case Type::UVec3:
    case Type::UVec4:
    case Type::BVec2:
    case Type::BVec3:
    case Type::BVec4:
    case Type::Mat3: break;
  }
  assert(false && "not a type of constants");
  return 0;
}

uint32_t Body::input(ValueId id) {
  const ir::Input& in = dag_.inputOf(id);
  switch (in.kind) {
    case InputKind::Parameter: break;  // the place pass made it a field of the material block
    case InputKind::BlockField: return blockField(id, in, -1);
    case InputKind::Attribute: return load(id, interface_.attributes[in.field]);
    case InputKind::Texture: return load(id, interface_.textures[in.field]);
    case InputKind::FrontFacing: return load(id, interface_.front_facing);
    case InputKind::LightIndex: return lightIndex();
    case InputKind::Varying: return load(id, interface_.varyings[in.field]);
    case InputKind::SpecConstant: return interface_.constants[in.field];
    case InputKind::LoopIndex:
    case InputKind::LoopValue: break;  // of an open loop: known
  }
  assert(false && "not an input of a placed module");
  return 0;
}

uint32_t Body::load(ValueId id, uint32_t variable) {
  assert(variable != 0 && "the program lists all that it uses");
  return instruction(id, {ir::SpirvSet::Core, spv::OpLoad}, &variable, 1);
}

/// Loads a field, or one component of it when `component` is not negative; `id` is the value that it becomes.
uint32_t Body::blockField(ValueId id, const ir::Input& input, int component) {
  const ir::Block& block = module_.blocks[input.block];
  const uint32_t variable = interface_.blocks[input.block];
  assert(variable != 0 && "the program lists all that it uses");
  std::array<uint32_t, 5> indices{};
  size_t count = 0;
  if (block.array != 0) {
    indices[count++] = globals_.integer(0);
    indices[count++] = input.element >= 0 ? globals_.integer(input.element) : lightIndex();
  }
  indices[count++] = globals_.integer(static_cast<int32_t>(input.field));
  const bool array = block.fields[input.field].array != 0;
  if (array) indices[count++] = globals_.integer(static_cast<int32_t>(input.index));
  if (component >= 0) indices[count++] = globals_.integer(component);
  const uint32_t pointer = globals_.pointer(spv::StorageClassUniform, kindOf(dag_[id].type));
  const uint32_t chain = globals_.newId();
  code_.begin(spv::OpAccessChain);
  code_.word(pointer);
  code_.word(chain);
  code_.word(variable);
  for (size_t i = 0; i < count; ++i) code_.word(indices[i]);
  code_.end();
  return instruction(id, {ir::SpirvSet::Core, spv::OpLoad}, &chain, 1);
}

/// Loads a field of a list's element, or a column of it where that is not negative: `id` is the value that it
/// becomes.
uint32_t Body::element(ValueId id, int column) {
  const ir::Value& from_value = dag_[column < 0 ? id : dag_[id].args[0]];
  const ir::ListField from = ir::ListField::of(from_value);
  const uint32_t number = value(from_value.args[0]);
  const uint32_t index = from_value.count > 1 ? value(from_value.args[1]) : 0;
  const uint32_t pointer = globals_.pointer(spv::StorageClassStorageBuffer, kindOf(dag_[id].type));
  const uint32_t zero = globals_.integer(0);
  const uint32_t field = globals_.integer(static_cast<int32_t>(from.field));
  const uint32_t part = column < 0 ? 0 : globals_.integer(column);
  const uint32_t chain = globals_.newId();
  code_.begin(spv::OpAccessChain);
  for (const uint32_t word : {pointer, chain, interface_.blocks[from.block], zero, number, field})
    code_.word(word);
  if (index != 0) code_.word(index);
  if (part != 0) code_.word(part);
  code_.end();
  return instruction(id, {ir::SpirvSet::Core, spv::OpLoad}, &chain, 1);
}

/// Loads a column of a matrix, which is a field of a block.
uint32_t Body::column(ValueId id) {
  const ir::Value& v = dag_[id];
  const auto number = static_cast<int>(v.payload);
  if (dag_[v.args[0]].op == Op::Element) return element(id, number);
  return blockField(id, dag_.inputOf(v.args[0]), number);
}

uint32_t Body::construct(ValueId id) {
  const ir::Value& v = dag_[id];
  if (v.count == 1 && dag_[v.args[0]].type == Type::Float) return splat(v.args[0], v.type, half(id));
  std::array<uint32_t, 4> parts{};
  for (size_t k = 0; k < v.count; ++k) parts[k] = in(v.args[k], half(id));
  return instruction(id, {ir::SpirvSet::Core, spv::OpCompositeConstruct}, parts.data(), v.count);
}

uint32_t Body::swizzle(ValueId id) {
  const ir::Value& v = dag_[id];
  const ValueId from = v.args[0];
  if (ir::componentCount(v.type) == 1) {
    const auto component = static_cast<uint32_t>(ir::swizzleComponent(v.payload, 0));
    const bool field = dag_[from].op == Op::Input && dag_.inputOf(from).kind == InputKind::BlockField;
    if (field && lone_component_[from] != kWhole) {
      return blockField(id, dag_.inputOf(from), static_cast<int>(component));
    }
    if (dag_[from].op == Op::Input && dag_.inputOf(from).kind == InputKind::SpecConstant) {
      return interface_.constant_components[dag_.inputOf(from).field].at(component);
    }
    const std::array<uint32_t, 2> operands = {in(from, half(id)), component};
    return instruction(id, {ir::SpirvSet::Core, spv::OpCompositeExtract}, operands.data(), 2);
  }
  std::array<uint32_t, 6> operands{};
  operands[0] = operands[1] = in(from, half(id));
  const auto count = static_cast<size_t>(ir::componentCount(v.type));
  for (size_t i = 0; i < count; ++i) {
    operands[2 + i] = static_cast<uint32_t>(ir::swizzleComponent(v.payload, static_cast<int>(i)));
  }
  return instruction(id, {ir::SpirvSet::Core, spv::OpVectorShuffle}, operands.data(), 2 + count);
}

/// Implicit derivatives exist in fragments only; a vertex samples the first level, as GLSL's texture() does.
uint32_t Body::texture(ValueId id) {
  const ir::Value& v = dag_[id];
  const bool compares = v.op == Op::TextureCompare || v.op == Op::TextureCompareLod;
  const bool implicit = ir::takesDerivatives(v.op) && program_.stage == ir::Stage::Fragment;
  std::array<uint32_t, 5> operands = {value(v.args[0]), value(v.args[1])};
  size_t count = 2;
  if (compares) operands[count++] = component(operands[1], 2);
  if (v.op == Op::TextureGrad) {
    operands[count++] = spv::ImageOperandsGradMask;
    operands[count++] = value(v.args[2]);
    operands[count++] = value(v.args[3]);
  } else if (!implicit) {
    operands[count++] = spv::ImageOperandsLodMask;
    operands[count++] = v.op == Op::TextureLod ? value(v.args[2]) : globals_.number(0);
  }
  const spv::Op opcode =
      compares   ? implicit ? spv::OpImageSampleDrefImplicitLod : spv::OpImageSampleDrefExplicitLod
      : implicit ? spv::OpImageSampleImplicitLod
                 : spv::OpImageSampleExplicitLod;
  return instruction(id, {ir::SpirvSet::Core, static_cast<uint32_t>(opcode)}, operands.data(), count);
}

/// What is taken from an array by a number that differs among the fragments, or is made of it.
uint32_t Body::nonUniform(uint32_t made) {
  globals_.decorations.op(spv::OpDecorate, made, spv::DecorationNonUniform);
  return made;
}

/// Loads a texture of an array, with its sampler.
uint32_t Body::textureAt(ValueId id) {
  const ir::Value& v = dag_[id];
  const uint32_t number = value(v.args[1]);
  const uint32_t pointer = globals_.pointer(spv::StorageClassUniformConstant, kindOf(v.type));
  const uint32_t chain = nonUniform(globals_.newId());
  code_.op(spv::OpAccessChain, pointer, chain, interface_.textures[dag_.inputOf(v.args[0]).field], number);
  return nonUniform(instruction(id, {ir::SpirvSet::Core, spv::OpLoad}, &chain, 1));
}

/// The query takes an image, without its sampler, and gives all of its axes.
uint32_t Body::textureSize(ValueId id) {
  const ir::Value& v = dag_[id];
  const Type type = dag_[v.args[0]].type;
  globals_.asksForSizes();
  const uint32_t sampled = value(v.args[0]);
  const uint32_t level = value(v.args[1]);
  const uint32_t image_type = globals_.type(imageKindOf(type));
  const uint32_t size_type = globals_.type(ir::vectorType(Type::Int, ir::sizeCount(type)));
  const uint32_t image = globals_.newId();
  if (dag_[v.args[0]].op == Op::TextureAt) nonUniform(image);
  code_.op(spv::OpImage, image_type, image, sampled);
  const uint32_t size = globals_.newId();
  code_.op(spv::OpImageQuerySizeLod, size_type, size, image, level);
  const std::array<uint32_t, 2> operands = {size, v.payload};
  return instruction(id, {ir::SpirvSet::Core, spv::OpCompositeExtract}, operands.data(), operands.size());
}

/// A component of a vector that no value of the DAG stands for.
uint32_t Body::component(uint32_t vector, uint32_t index) {
  const uint32_t type = globals_.type(Kind::Float);
  const uint32_t id = globals_.newId();
  code_.op(spv::OpCompositeExtract, type, id, vector, index);
  return id;
}

/// Writes the instruction that computes a value. Its operands are written already, so that what stands
/// between two OpLines is of one term.
uint32_t Body::instruction(ValueId id, const Instruction& what, const uint32_t* operands, size_t count) {
  const Type of = dag_[id].type;
  const uint32_t type = globals_.type(half(id) ? halfKindOf(of) : kindOf(of));
  const bool extended = what.set == ir::SpirvSet::Ext;
  const uint32_t set = extended ? globals_.glslSet() : 0;
  const uint32_t made = result(id);
  code_.begin(extended ? spv::OpExtInst : static_cast<spv::Op>(what.opcode));
  code_.word(type);
  code_.word(made);
  if (extended) {
    code_.word(set);
    code_.word(what.opcode);
  }
  for (size_t i = 0; i < count; ++i) code_.word(operands[i]);
  code_.end();
  return made;
}

/// A new id for a value, with the names that debugging wants.
uint32_t Body::result(ValueId id) {
  const uint32_t made = globals_.newId();
  if (relaxed(id)) globals_.decorations.op(spv::OpDecorate, made, spv::DecorationRelaxedPrecision);
  if (!debug_) return made;
  if (!program_.names[id].empty()) globals_.name(made, program_.names[id]);
  const ir::TermId term = dag_.termOf(id);
  if (term == term_) return made;
  term_ = term;
  if (dag_.terms()[term].name.empty()) {
    code_.op(spv::OpNoLine);
    return made;
  }
  // The declaration of the term's node; where that is not known, the term takes the place of a file.
  const ir::Term& t = dag_.terms()[term];
  const std::string place = !t.file.empty() ? t.file : t.source.empty() ? t.name : t.name + ": " + t.source;
  uint32_t& string = strings_[place];
  if (string == 0) string = globals_.string(place);
  code_.op(spv::OpLine, string, std::max(t.line, 1U), 1);
  return made;
}

// -- statements --

void Body::statement(const schedule::Statement& s) {
  switch (s.kind) {
    case schedule::StatementKind::Section: return;
    case schedule::StatementKind::Let:
      if (fused_[s.value] == 0) value(s.value);
      return;
    case schedule::StatementKind::LoopBegin: openLoop(s); return;
    case schedule::StatementKind::Accumulate: accumulate(s.value); return;
    case schedule::StatementKind::LoopEnd: closeLoop(); return;
    case schedule::StatementKind::RoundsBegin: openRounds(s.value); return;
    case schedule::StatementKind::Hold:
    case schedule::StatementKind::Next: return;  // the phis read all at once
    case schedule::StatementKind::RoundsEnd: closeRounds(s.value); return;
    case schedule::StatementKind::Discard: discard(s.value); return;
    case schedule::StatementKind::Output: {
      const ir::Output& output = module_.outputs[s.output];
      const bool varying = output.kind == ir::OutputKind::Varying;
      const uint32_t variable = varying ? interface_.varyings[output.location] : interface_.outputs[s.output];
      const uint32_t stored = value(output.value);
      code_.op(spv::OpStore, variable, stored);
      return;
    }
  }
}

void Body::label(uint32_t id) {
  code_.op(spv::OpLabel, id);
  block_ = id;
  term_ = 0;  // an OpLine holds to the end of its block
}

/// The loop over lights is around all others.
uint32_t Body::lightIndex() const {
  assert(!open_.empty());
  return open_.front().index;
}

/// The head of a loop holds the counter, and what its rounds hand on, as phis, so that nothing lives in
/// memory.
Body::Loop& Body::enter() {
  Loop& loop = open_.emplace_back();
  loop.head = globals_.newId();
  loop.next_step = globals_.newId();
  loop.merge = globals_.newId();
  loop.index = globals_.newId();
  loop.next_index = globals_.newId();
  return loop;
}

void Body::begin(const Loop& loop, uint32_t first) {
  const uint32_t before = block_;
  code_.op(spv::OpBranch, loop.head);
  label(loop.head);
  code_.op(spv::OpPhi, globals_.type(Kind::Int), loop.index, first, before, loop.next_index, loop.next_step);
}

void Body::runWhile(const Loop& loop, uint32_t end) {
  const uint32_t goes_on = globals_.newId();
  const uint32_t inside = globals_.newId();
  code_.op(spv::OpSLessThan, globals_.type(Kind::Bool), goes_on, loop.index, end);
  code_.op(spv::OpLoopMerge, loop.merge, loop.next_step, spv::LoopControlMaskNone);
  code_.op(spv::OpBranchConditional, goes_on, inside, loop.merge);
  label(inside);
}

void Body::openLoop(const schedule::Statement& s) {
  assert(open_.empty());
  hoist(s.sums);
  const ir::LightGroup& group = module_.light_groups[s.group];
  const auto [first, end] = boundsOf(group, dag_[s.sums[0]]);
  const uint32_t before = block_;
  Loop& loop = enter();
  for (const ValueId sum : s.sums) {
    const uint32_t phi = globals_.newId();
    loop.sums.push_back({sum, phi, globals_.newId()});
  }
  begin(loop, first);
  for (const Sum& sum : loop.sums) {
    const Type type = dag_[sum.value].type;
    const uint32_t zero = type == Type::Float ? globals_.number(0) : globals_.splat(type, 0);
    code_.op(spv::OpPhi, globals_.type(type), sum.phi, zero, before, sum.next, loop.next_step);
    // Behind the loop, the phi is the whole sum.
    ids_[sum.value] = sum.phi;
    if (debug_) globals_.name(sum.phi, program_.names[sum.value]);
  }
  runWhile(loop, end);
  if (debug_) globals_.name(loop.index, ir::kLightIndexName);
}

void Body::openRounds(ValueId chain) {
  const ir::Loop& of = loops_[loops_.indexOf(chain)];
  hoist(of);
  std::vector<uint32_t> firsts;
  for (const ir::Carry& carry : of.carries) firsts.push_back(value(carry.first));
  const uint32_t end = value(of.end);
  const uint32_t first = globals_.integer(ir::firstRound(dag_, of));
  const uint32_t before = block_;
  Loop& loop = enter();
  begin(loop, first);
  const auto know = [&](ValueId input, uint32_t id) {
    ids_[input] = id;
    loop.made.push_back(input);
    if (debug_ && !program_.names[input].empty()) globals_.name(id, program_.names[input]);
  };
  know(of.index, loop.index);
  for (size_t i = 0; i < of.carries.size(); ++i) {
    const uint32_t phi = globals_.newId();
    const uint32_t type = globals_.type(dag_[of.carries[i].value].type);
    code_.op(spv::OpPhi, type, phi, firsts[i], before, 0, loop.next_step);
    loop.nexts.push_back(code_.size() - 2);
    know(of.carries[i].value, phi);
  }
  runWhile(loop, end);
}

/// What a round leaves goes into the phis of the head. Behind the loop, they are what is left of it.
void Body::closeRounds(ValueId chain) {
  const int32_t number = loops_.indexOf(chain);
  const ir::Loop& of = loops_[number];
  std::map<uint32_t, uint32_t> phis;
  for (size_t i = 0; i < of.carries.size(); ++i) {
    code_.set(open_.back().nexts[i], value(of.carries[i].next));
    phis[dag_.inputOf(of.carries[i].value).index] = ids_[of.carries[i].value];
  }
  closeLoop();
  for (const ValueId id : live_) {
    if (dag_[id].op != Op::Carried || loops_.indexOf(id) != number) continue;
    ids_[id] = phis.at(dag_[id].payload);
    if (!open_.empty()) open_.back().made.push_back(id);
  }
}

/// Writes, before a loop, all that its body reads and that stands outside of it.
void Body::hoist(const ir::Loop& loop) {
  const int32_t number = loops_.indexOf(loop.last);
  const auto outside = [&](ValueId id) {
    return !loops_.within(loops_.of(id), number) && !ir::makesLoop(dag_[id].op);
  };
  for (const ValueId id : loops_.bodyOf(number)) {
    const ir::Value& v = dag_[id];
    for (size_t k = 0; k < v.count; ++k) {
      if (outside(v.args[k])) operand(id, k);
    }
  }
  for (const ir::Carry& carry : loop.carries) {
    if (outside(carry.next)) value(carry.next);
  }
}

/// Writes, before the loop, all that its body reads and that does not change with the light.
void Body::hoist(const std::vector<ValueId>& sums) {
  std::vector<ValueId> body;
  std::vector<ValueId> pending;
  std::vector<uint8_t> seen(dag_.size(), false);
  const auto visit = [&](ValueId id) {
    if (!seen[id] && dag_[id].rate == Rate::Light) pending.push_back(id);
    seen[id] = true;
  };
  for (const ValueId sum : sums) {
    const ValueId term = dag_[sum].args[0];
    if (dag_[term].rate != Rate::Light) value(term);
    visit(term);
  }
  while (!pending.empty()) {
    const ValueId id = pending.back();
    pending.pop_back();
    body.push_back(id);
    for (const ValueId operand : dag_[id].operands()) visit(operand);
  }
  std::sort(body.begin(), body.end());
  for (const ValueId id : body) {
    const ir::Value& v = dag_[id];
    for (size_t k = 0; k < v.count; ++k) {
      if (dag_[v.args[k]].rate != Rate::Light) operand(id, k);
    }
  }
}

/// The first place of the loop and that behind its last one.
std::pair<uint32_t, uint32_t> Body::boundsOf(const ir::LightGroup& group, const ir::Value& sum) {
  if (group.count != ir::LightGroup::kListed) {
    const bool counted = group.count == ir::LightGroup::kCounted;
    const uint32_t first = globals_.integer(group.first);
    return {first, counted ? lightCount() : globals_.integer(group.first + group.count)};
  }
  const uint32_t first = value(sum.args[1]);
  const uint32_t count = value(sum.args[2]);
  const uint32_t end = globals_.newId();
  code_.op(spv::OpIAdd, globals_.type(Kind::Int), end, first, count);
  return {first, end};
}

uint32_t Body::lightCount() {
  if (light_count_ != 0) return light_count_;
  const ir::LightCount& count = module_.light_count;
  const uint32_t index = globals_.integer(static_cast<int32_t>(count.field));
  const uint32_t pointer = globals_.pointer(spv::StorageClassUniform, Kind::Int);
  const uint32_t chain = globals_.newId();
  light_count_ = globals_.newId();
  code_.op(spv::OpAccessChain, pointer, chain, interface_.blocks[count.block], index);
  code_.op(spv::OpLoad, globals_.type(Kind::Int), light_count_, chain);
  return light_count_;
}

void Body::accumulate(ValueId sum) {
  const uint32_t term = value(dag_[sum].args[0]);
  for (const Sum& s : open_.back().sums) {
    if (s.value == sum) code_.op(spv::OpFAdd, globals_.type(dag_[sum].type), s.next, s.phi, term);
  }
}

void Body::closeLoop() {
  const Loop& loop = open_.back();
  code_.op(spv::OpBranch, loop.next_step);
  label(loop.next_step);
  const uint32_t one = globals_.integer(1);
  code_.op(spv::OpIAdd, globals_.type(Kind::Int), loop.next_index, loop.index, one);
  code_.op(spv::OpBranch, loop.head);
  label(loop.merge);
  // The body does not dominate what follows: what it computed is unknown here.
  for (const ValueId id : loop.made) ids_[id] = 0;
  for (const uint32_t slot : loop.splats) splats_[slot] = 0;
  open_.pop_back();
}

void Body::discard(ValueId condition) {
  derivativesFirst();
  const uint32_t drop = value(condition);
  const uint32_t kill = globals_.newId();
  const uint32_t merge = globals_.newId();
  code_.op(spv::OpSelectionMerge, merge, spv::SelectionControlMaskNone);
  code_.op(spv::OpBranchConditional, drop, kill, merge);
  label(kill);
  code_.op(spv::OpKill);
  label(merge);
}

/// Derivatives are undefined once a neighbour is dropped: what needs them comes before. What waits for a loop
/// that is still to come cannot.
void Body::derivativesFirst() {
  std::vector<uint8_t> waits(dag_.size(), false);
  for (const ValueId id : live_) {
    const ir::Value& v = dag_[id];
    // What has an id is there already; a sum's operands belong to its loop.
    bool wait = ids_[id] == 0 && (v.op == Op::SumOverLights || v.op == Op::Carried || v.rate == Rate::Light ||
                                  loops_.of(id) >= 0);
    for (const ValueId operand : v.operands()) wait = wait || (ids_[id] == 0 && waits[operand]);
    waits[id] = wait;
    if (ir::takesDerivatives(v.op) && !wait) value(id);
  }
}

}  // namespace lacquer::targets::spirv
