#include "eval/gpu.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "check/check.h"
#include "eval/program.h"
#include "schedule/schedule.h"
#include "setting/language.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer {

namespace {

/// The GLSL or the HLSL of the fragment stage through glslang.
Result<std::vector<uint32_t>> compiledText(ir::Module module, bool hlsl) {
  targets::legalize(module);
  const schedule::Program program = schedule::schedule(module, ir::Stage::Fragment);
  const Target target = hlsl ? Target::Hlsl : Target::Glsl;
  const std::string text = targets::printText(module, program, target, {});
  return check::compile(text, target, check::Stage::Fragment, hlsl ? "eval.hlsl" : "eval.glsl");
}

class WorkBuilder {
public:
  WorkBuilder(const ir::Module& module, const eval::Bindings& bindings, size_t points, FragmentRoute route)
      : module_(module), bindings_(bindings), points_(points), hlsl_(route == FragmentRoute::Hlsl) {
    work_.points = points;
    work_.quads = bindings.quads;
  }

  Result<vulkan::Work> build(const GpuTextures& textures) {
    const schedule::Program program = schedule::schedule(module_, ir::Stage::Fragment);
    for (const uint32_t block : program.blocks) {
      const ir::Block& declared = module_.blocks[block];
      declared.role == ir::BlockRole::List ? addList(block) : addBlock(declared);
    }
    for (const uint32_t texture : program.textures) addTexture(module_.textures[texture], textures);
    for (const uint32_t index : program.varyings) addVarying(module_.varyings[index]);
    for (const uint32_t index : program.parameters) addConstant(module_.parameters[index]);
    if (program.front_facing) addFacing();
    if (!wrong_.empty()) return tl::make_unexpected(std::move(wrong_));
    return std::move(work_);
  }

private:
  vulkan::BindingPlace placeOf(const ir::Binding& binding, uint32_t shift) const {
    return {binding.set, binding.binding + (hlsl_ ? shift : 0)};
  }

  void missing(const std::string& name) {
    const auto error =
        fail("unbound-input", {}, fmt::format("'{}' has no value", name), "bind a column of that name");
    wrong_.insert(wrong_.end(), error.value().begin(), error.value().end());
  }

  const eval::Column* columnOf(const eval::Columns& columns, const std::string& name, ir::Type type) {
    const auto found = columns.find(name);
    const auto width = static_cast<size_t>(ir::componentCount(type));
    if (found != columns.end() && static_cast<size_t>(found->second.components) == width &&
        found->second.values.size() == width * (found->second.per_point ? points_ : 1)) {
      return &found->second;
    }
    missing(name);
    return nullptr;
  }

  static uint32_t bitsOf(double value, ir::Type type) {
    const ir::Type part = ir::partType(type);
    // A UInt may come as the number of its bits as an Int (ir/whole.h).
    if (ir::isWhole(part)) return value < 0 ? ir::int_of(value) : ir::bitsOf(value, part == ir::Type::Int);
    return std::bit_cast<uint32_t>(static_cast<float>(value));
  }

  static void put(double value, ir::Type type, unsigned char* to) {
    const uint32_t bits = bitsOf(value, type);
    std::memcpy(to, &bits, sizeof bits);
  }

  /// Where a field lies among the block's elements, and its values.
  struct Filled {
    const ir::BlockField* field;
    const eval::Column* column;
    size_t offset;
  };

  void addBlock(const ir::Block& block) {
    const bool lights = block.role == ir::BlockRole::Lights;
    const size_t most = block.list ? bindings_.lights.size() : block.array;
    const size_t elements = lights ? std::min(bindings_.lights.size(), most) : 1;
    std::vector<Filled> filled;
    vulkan::UniformBlock made;
    made.place = placeOf(block.binding, block.list ? check::kHlslTextureShift : check::kHlslBufferShift);
    for (size_t element = 0; element < elements; ++element) {
      const eval::Columns& columns = lights ? bindings_.lights[element] : bindings_.columns;
      for (const ir::BlockField& field : block.fields) {
        for (uint32_t k = 0; k < field.elements(); ++k) {
          const eval::Column* column =
              columnOf(columns, block.instance + "." + field.elementName(k), field.type);
          if (column == nullptr) continue;
          filled.push_back({&field, column, element * block.size + field.offset + k * field.stride()});
          made.per_point |= column->per_point;
        }
      }
    }
    const size_t size = size_t{block.size} * (lights ? std::max<size_t>(most, 1) : 1);
    made.bytes.assign(size * (made.per_point ? points_ : 1), 0);
    for (size_t point = 0; point * size < made.bytes.size(); ++point) {
      for (const Filled& f : filled) {
        const auto width = static_cast<size_t>(f.column->components);
        const double* from = f.column->values.data() + (f.column->per_point ? point * width : 0);
        for (size_t c = 0; c < width; ++c)
          put(from[c], f.field->type, &made.bytes[point * size + f.offset + 4 * c]);
      }
    }
    work_.blocks.push_back(std::move(made));
  }

  /// Ranges, and the numbers of lights.
  void addList(uint32_t index) {
    const ir::Block& block = module_.blocks[index];
    vulkan::UniformBlock made;
    made.place = placeOf(block.binding, check::kHlslTextureShift);
    for (uint32_t f = 0; f < block.fields.size(); ++f) {
      const std::vector<double> values = eval::listValues(module_, bindings_, {index, f});
      made.bytes.resize(std::max(made.bytes.size(), std::max<size_t>(values.size(), 1) * block.size), 0);
      for (size_t i = 0; i < values.size(); ++i)
        put(values[i], block.fields[f].type, &made.bytes[i * block.size + block.fields[f].offset]);
    }
    work_.blocks.push_back(std::move(made));
  }

  void addTexture(const ir::TextureSlot& slot, const GpuTextures& textures) {
    const auto found = textures.find(slot.name);
    if (found == textures.end()) return missing(slot.name);
    vulkan::Texture texture = found->second;
    texture.image = placeOf(slot.binding, check::kHlslTextureShift);
    texture.sampler = placeOf(slot.binding, check::kHlslSamplerShift);
    work_.textures.push_back(std::move(texture));
  }

  void addVarying(const ir::Varying& varying) {
    const eval::Column* column = columnOf(bindings_.columns, varying.name, varying.type);
    if (column == nullptr) return;
    vulkan::Varying made;
    made.components = static_cast<uint32_t>(column->components);
    const bool whole = !ir::isFloating(varying.type);
    for (size_t i = 0; i < points_ * made.components; ++i) {
      const double x = column->values[column->per_point ? i : i % made.components];
      if (!whole) {
        made.values.push_back(static_cast<float>(x));
      } else {
        made.whole.push_back(varying.type == ir::Type::Bool ? uint32_t{x != 0} : bitsOf(x, varying.type));
      }
    }
    work_.inputs.push_back(std::move(made));
  }

  void addConstant(const ir::Parameter& parameter) {
    const auto found = bindings_.columns.find(parameter.name);
    for (int c = 0; c < ir::componentCount(parameter.type); ++c) {
      const auto i = static_cast<size_t>(c);
      const double x = found == bindings_.columns.end() ? parameter.value[i] : found->second.values[i];
      const bool truth = ir::partType(parameter.type) == ir::Type::Bool;
      work_.constants[static_cast<uint32_t>(parameter.constant_id + c)] =
          truth ? uint32_t{x != 0} : bitsOf(x, parameter.type);
    }
  }

  void addFacing() {
    const eval::Column* column = columnOf(bindings_.columns, "gl_FrontFacing", ir::Type::Bool);
    if (column == nullptr) return;
    for (size_t i = 0; i < points_; ++i)
      work_.back_facing.push_back(column->values[column->per_point ? i : 0] == 0);
  }

  const ir::Module& module_;
  const eval::Bindings& bindings_;
  size_t points_;
  bool hlsl_;
  vulkan::Work work_;
  Diagnostics wrong_;
};

}  // namespace

Result<std::vector<uint32_t>> fragmentWords(const ir::Module& module, FragmentRoute route) {
  Result<std::vector<uint32_t>> words =
      route == FragmentRoute::Direct
          ? targets::writeSpirv(module, schedule::schedule(module, ir::Stage::Fragment), {})
          : compiledText(module, route == FragmentRoute::Hlsl);
  if (!words) return words;
  // Drivers trust what they are given.
  if (Diagnostics invalid = check::validate(*words, false, "eval"); !invalid.empty()) {
    return tl::make_unexpected(std::move(invalid));
  }
  return words;
}

vulkan::Texture textureFor(ir::Type type) {
  vulkan::Texture texture;
  texture.shape = type == ir::Type::TextureCube      ? vulkan::Shape::Cube
                  : type == ir::Type::Texture2DArray ? vulkan::Shape::Array
                  : type == ir::Type::Texture3D      ? vulkan::Shape::Volume
                                                     : vulkan::Shape::Plane;
  texture.compares = type == ir::Type::Texture2DShadow;
  return texture;
}

Result<vulkan::Work> gpuWork(const ir::Module& module, const eval::Bindings& bindings,
                             const GpuTextures& textures, size_t points, FragmentRoute route) {
  Result<vulkan::Work> work = WorkBuilder(module, bindings, points, route).build(textures);
  if (!work) return work;
  Result<std::vector<uint32_t>> words = fragmentWords(module, route);
  if (!words) return tl::make_unexpected(std::move(words.error()));
  work->fragment = std::move(*words);
  return work;
}

}  // namespace lacquer
