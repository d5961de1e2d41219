#include "targets/spirv/interface.h"

#include <map>
#include <string>

#include "targets/clike.h"
#include "targets/target.h"

namespace lacquer::targets::spirv {

namespace {

class Declarer {
public:
  Declarer(const ir::Module& module, const schedule::Program& program, Globals& globals, uint32_t length)
      : module_(module), program_(program), globals_(globals), array_length_(length) {}

  Interface run() {
    made_.blocks.resize(module_.blocks.size());
    made_.textures.resize(module_.textures.size());
    made_.attributes.resize(module_.attributes.size());
    made_.varyings.resize(module_.varyings.size());
    made_.outputs.resize(module_.outputs.size());
    made_.constants.resize(module_.parameters.size());
    made_.constant_components.resize(module_.parameters.size());
    for (const uint32_t p : program_.parameters) constant(p);
    for (const uint32_t b : program_.blocks) made_.blocks[b] = block(module_.blocks[b]);
    for (const uint32_t t : program_.textures) made_.textures[t] = textureOrArray(module_.textures[t]);
    inputs();
    outputs();
    return std::move(made_);
  }

private:
  uint32_t variable(spv::StorageClass storage, uint32_t pointer, std::string_view name) {
    const uint32_t id = globals_.newId();
    globals_.declarations.op(spv::OpVariable, pointer, id, storage);
    if (!name.empty()) globals_.name(id, name);
    return id;
  }

  /// An input or output; the decoration is Location or BuiltIn.
  uint32_t io(spv::StorageClass storage, ir::Type type, std::string_view name, spv::Decoration decoration,
              uint32_t where) {
    const uint32_t id = variable(storage, globals_.pointer(storage, kindOf(type)), name);
    globals_.decorations.op(spv::OpDecorate, id, decoration, where);
    made_.entry_point.push_back(id);
    return id;
  }

  void bindAt(uint32_t variable, const ir::Binding& at) {
    globals_.decorations.op(spv::OpDecorate, variable, spv::DecorationDescriptorSet, at.set);
    globals_.decorations.op(spv::OpDecorate, variable, spv::DecorationBinding, at.binding);
  }

  /// Arrays of one length and stride are one type.
  uint32_t fieldType(const ir::BlockField& field) {
    const uint32_t element = globals_.type(field.type);
    if (field.array == 0) return element;
    uint32_t& known = arrays_[{field.type, field.array}];
    if (known != 0) return known;
    const uint32_t length = globals_.integer(static_cast<int32_t>(field.array));
    globals_.declarations.op(spv::OpTypeArray, known = globals_.newId(), element, length);
    globals_.decorations.op(spv::OpDecorate, known, spv::DecorationArrayStride, field.stride());
    return known;
  }

  /// The structure of the fields, at the offsets that they have in memory.
  uint32_t structure(const ir::Block& block) {
    std::vector<uint32_t> types;
    for (const ir::BlockField& field : block.fields) types.push_back(fieldType(field));
    Words& declarations = globals_.declarations;
    Words& decorations = globals_.decorations;
    const uint32_t id = globals_.newId();
    declarations.begin(spv::OpTypeStruct);
    declarations.word(id);
    for (const uint32_t type : types) declarations.word(type);
    declarations.end();
    globals_.name(id, block.name);
    for (uint32_t f = 0; f < block.fields.size(); ++f) {
      const ir::BlockField& field = block.fields[f];
      globals_.memberName(id, f, field.name);
      if (field.type == ir::Type::Mat4) {
        constexpr uint32_t kColumn = 16;
        decorations.op(spv::OpMemberDecorate, id, f, spv::DecorationColMajor);
        decorations.op(spv::OpMemberDecorate, id, f, spv::DecorationMatrixStride, kColumn);
      }
      decorations.op(spv::OpMemberDecorate, id, f, spv::DecorationOffset, field.offset);
    }
    return id;
  }

  uint32_t block(const ir::Block& block) {
    const bool array = block.plural();
    const auto storage = block.list ? spv::StorageClassStorageBuffer : spv::StorageClassUniform;
    const uint32_t element = structure(block);
    const uint32_t type = array ? arrayBlock(block, element) : element;
    globals_.decorations.op(spv::OpDecorate, type, spv::DecorationBlock);
    if (block.list) globals_.decorations.op(spv::OpMemberDecorate, type, 0, spv::DecorationNonWritable);
    const uint32_t pointer = globals_.newId();
    globals_.declarations.op(spv::OpTypePointer, pointer, storage, type);
    // Like the GLSL's: the block of an array has no instance name, its one member is found by its own.
    const uint32_t id = variable(storage, pointer, array ? "" : block.instance);
    bindAt(id, block.binding);
    return id;
  }

  /// `Lights { Light lights[16]; }`, of a list `Lights { Light lights[]; }`
  uint32_t arrayBlock(const ir::Block& block, uint32_t element) {
    const uint32_t length = block.list ? 0 : globals_.integer(static_cast<int32_t>(block.array));
    const uint32_t elements = globals_.newId();
    if (block.list)
      globals_.declarations.op(spv::OpTypeRuntimeArray, elements, element);
    else
      globals_.declarations.op(spv::OpTypeArray, elements, element, length);
    globals_.decorations.op(spv::OpDecorate, elements, spv::DecorationArrayStride, block.size);
    const uint32_t id = globals_.newId();
    globals_.declarations.op(spv::OpTypeStruct, id, elements);
    globals_.name(id, blockName(block));
    globals_.memberName(id, 0, block.instance + "s");
    globals_.decorations.op(spv::OpMemberDecorate, id, 0, spv::DecorationOffset, 0);
    return id;
  }

  void constant(uint32_t index) {
    const ir::Parameter& p = module_.parameters[index];
    std::array<uint32_t, 4>& components = made_.constant_components[index];
    const int width = ir::componentCount(p.type);
    for (int c = 0; c < width; ++c) {
      const auto at = static_cast<size_t>(c);
      const auto spec_id = static_cast<uint32_t>(p.constant_id + c);
      const ir::Type part = ir::partType(p.type);
      components[at] = part == ir::Type::Bool ? globals_.specBoolean(spec_id, p.neutral[at] != 0)
                       : ir::isWhole(part)    ? globals_.specWhole(spec_id, part, p.neutral[at])
                                              : globals_.specNumber(spec_id, p.neutral[at]);
      if (width > 1) globals_.name(components[at], "lacquer_" + p.constant_name + "_" + "xyzw"[at]);
    }
    // Of truths only components are read.
    if (width > 1 && ir::partType(p.type) == ir::Type::Bool) return;
    made_.constants[index] = width > 1 ? globals_.specVector(p.type, components.data()) : components[0];
    globals_.name(made_.constants[index], p.constant_name);
  }

  /// The textures of an array have one variable.
  uint32_t textureOrArray(const ir::TextureSlot& slot) {
    if (slot.array.empty() && slot.layers.empty()) return texture(slot);
    uint32_t& known = texture_arrays_[slot.array.empty() ? slot.layers : slot.array];
    if (known != 0) return known;
    if (slot.array.empty()) return known = texture(slot);
    globals_.asksForArrays(array_length_ == 0);
    const auto storage = spv::StorageClassUniformConstant;
    const uint32_t element = globals_.type(slot.type);
    const uint32_t length = array_length_ == 0 ? 0 : globals_.integer(static_cast<int32_t>(array_length_));
    const uint32_t type = globals_.newId(), pointer = globals_.newId();
    if (length == 0)
      globals_.declarations.op(spv::OpTypeRuntimeArray, type, element);
    else
      globals_.declarations.op(spv::OpTypeArray, type, element, length);
    globals_.declarations.op(spv::OpTypePointer, pointer, storage, type);
    known = variable(storage, pointer, slot.array);
    bindAt(known, slot.binding);
    return known;
  }

  uint32_t texture(const ir::TextureSlot& slot) {
    const auto storage = spv::StorageClassUniformConstant;
    const uint32_t id = variable(storage, globals_.pointer(storage, kindOf(slot.type)), slot.boundName());
    bindAt(id, slot.binding);
    return id;
  }

  void inputs() {
    const auto in = spv::StorageClassInput;
    for (const uint32_t index : program_.attributes) {
      const ir::Attribute& a = module_.attributes[index];
      made_.attributes[index] = io(in, a.type, attributeName(a), spv::DecorationLocation, a.location);
    }
    if (program_.stage == ir::Stage::Fragment) varyings(in);
    if (!program_.front_facing) return;
    made_.front_facing =
        io(in, ir::Type::Bool, "gl_FrontFacing", spv::DecorationBuiltIn, spv::BuiltInFrontFacing);
  }

  void outputs() {
    const auto out = spv::StorageClassOutput;
    if (program_.stage == ir::Stage::Vertex) varyings(out);
    for (uint32_t index = 0; index < module_.outputs.size(); ++index) {
      const ir::Output& o = module_.outputs[index];
      if (o.kind != ir::OutputKind::Position || o.stage != program_.stage) continue;
      made_.outputs[index] =
          io(out, ir::Type::Vec4, "gl_Position", spv::DecorationBuiltIn, spv::BuiltInPosition);
      globals_.decorations.op(spv::OpDecorate, made_.outputs[index], spv::DecorationInvariant);
    }
    for (const uint32_t index : program_.outputs) {
      const ir::Output& o = module_.outputs[index];
      if (o.kind == ir::OutputKind::Depth) {
        made_.outputs[index] =
            io(out, ir::Type::Float, "gl_FragDepth", spv::DecorationBuiltIn, spv::BuiltInFragDepth);
        continue;
      }
      made_.outputs[index] =
          io(out, module_.dag[o.value].type, outputName(o), spv::DecorationLocation, o.location);
    }
  }

  void varyings(spv::StorageClass storage) {
    for (const uint32_t index : program_.varyings) {
      const ir::Varying& v = module_.varyings[index];
      made_.varyings[index] = io(storage, v.type, varyingName(v), spv::DecorationLocation, v.location);
      if (!ir::isFloating(v.type))
        globals_.decorations.op(spv::OpDecorate, made_.varyings[index], spv::DecorationFlat);
    }
  }

  const ir::Module& module_;
  const schedule::Program& program_;
  Globals& globals_;
  uint32_t array_length_;
  std::map<std::pair<ir::Type, uint32_t>, uint32_t> arrays_;  ///< by element and length
  std::map<std::string, uint32_t> texture_arrays_;            ///< by name
  Interface made_;
};

}  // namespace

Interface declareInterface(const ir::Module& module, const schedule::Program& program, Globals& globals,
                           uint32_t array_length) {
  return Declarer(module, program, globals, array_length).run();
}

}  // namespace lacquer::targets::spirv
