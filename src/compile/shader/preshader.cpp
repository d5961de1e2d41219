#include "shader/preshader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ir/fold.h"
#include "targets/packer.h"

namespace lacquer {

using ir::Components;
using ir::Op;

double packedNumber(const ir::Parameter& parameter, double x, double otherwise) {
  if (std::isnan(x)) return otherwise;
  if (parameter.type == ir::Type::Bool) return x != 0 ? 1 : 0;
  const targets::PackedRange range = targets::packedRange(parameter);
  if (range.or_zero && x == 0) return x;
  const double within = std::clamp(x, range.low, range.high);
  return range.whole ? std::floor(within + 0.5) : within;
}

std::string packedRangeText(const ir::Parameter& parameter) {
  if (parameter.type == ir::Type::Bool) return "0 or 1";
  const targets::PackedRange range = targets::packedRange(parameter);
  if (range.whole) return fmt::format("the integers in [{}, {}]", range.low, range.high);
  return fmt::format("[{}, {}]{}", range.low, range.high, range.or_zero ? " or 0" : "");
}

Preshader::Preshader(const ir::Module& module) {
  std::vector<ir::ValueId> roots;
  for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
  std::vector<uint32_t> step_of(module.dag.size(), 0);
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    const ir::Value& value = module.dag[id];
    Step step{value.op, value.type, value.count, value.payload, {}};
    for (size_t k = 0; k < value.count; ++k) step.args[k] = step_of[value.args[k]];
    if (value.op == Op::Input) step.payload = module.dag.inputOf(id).field;
    if (value.op == Op::Constant) {
      step.payload = static_cast<uint32_t>(constants_.size());
      constants_.push_back(module.dag.constantOf(id));
    }
    step_of[id] = static_cast<uint32_t>(steps_.size());
    steps_.push_back(step);
  }
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    size_ = block.size;
    for (const ir::PreshaderField& p : module.preshader) {
      const ir::BlockField& field = block.fields[p.field];
      fields_.push_back({field.name, field.type, field.offset, step_of[p.value]});
    }
  }
}

std::vector<Components> Preshader::evaluate(
    const std::function<const Components&(uint32_t parameter)>& value) const {
  std::vector<Components> values(steps_.size());
  for (size_t s = 0; s < steps_.size(); ++s) {
    const Step& step = steps_[s];
    if (step.op == Op::Constant) {
      values[s] = constants_[step.payload];
    } else if (step.op == Op::Input) {
      values[s] = value(step.payload);
      if (ir::partType(step.type) == ir::Type::UInt)
        for (double& x : values[s]) x = ir::whole<double>(ir::uint_of(x));
    } else {
      std::array<ir::Operand, 4> in{};
      for (size_t k = 0; k < step.count; ++k) in[k] = {steps_[step.args[k]].type, values[step.args[k]]};
      values[s] = ir::foldNumbers(step.op, step.type, step.payload, {in.data(), step.count});
    }
  }
  std::vector<Components> out;
  for (const Field& field : fields_) {
    out.push_back(values[field.value]);
    for (double& x : out.back())
      x = std::isnan(x) || x == 0 ? 0 : std::clamp(x, -targets::kLargestFloat, targets::kLargestFloat);
  }
  return out;
}

void Preshader::write(std::span<const Components> values, std::span<std::byte> block) const {
  std::fill(block.begin(), block.end(), std::byte{0});
  for (size_t i = 0; i < fields_.size(); ++i) {
    for (int c = 0; c < ir::componentCount(fields_[i].type); ++c) {
      const double number = values[i][static_cast<size_t>(c)];
      const uint32_t x = ir::isWhole(fields_[i].type) ? ir::bits(number)
                                                      : std::bit_cast<uint32_t>(static_cast<float>(number));
      std::memcpy(block.data() + fields_[i].offset + size_t{4} * static_cast<size_t>(c), &x, 4);
    }
  }
}

bool Preshader::sound() const {
  for (size_t s = 0; s < steps_.size(); ++s) {
    if (!sound(steps_[s], s)) return false;
  }
  // What D3D takes, and no other platform takes more (targets::DeviceLimits).
  constexpr uint32_t kMostBytes = 65536;
  if (size_ > kMostBytes) return false;
  return std::all_of(fields_.begin(), fields_.end(), [&](const Field& f) {
    return f.value < steps_.size() && f.offset < size_ &&
           size_ - f.offset >= 4U * static_cast<uint32_t>(ir::componentCount(f.type));
  });
}

/// True when evaluate() can take a step, the one of that number, whatever it comes to.
bool Preshader::sound(const Step& step, size_t number) const {
  if (step.op == Op::Constant) return step.payload < constants_.size();
  if (step.op == Op::Input) return true;  // a parameter: uses() tells which
  if (step.count == 0 || step.count > step.args.size()) return false;
  const auto known = [&](uint32_t arg) { return arg < number; };
  if (!std::all_of(step.args.begin(), step.args.begin() + step.count, known)) return false;
  const int width = ir::componentCount(step.type);
  const auto widthOf = [&](size_t k) { return ir::componentCount(steps_[step.args[k]].type); };
  if (step.op == Op::Construct || step.op == Op::Length) return true;
  if (step.op == Op::Dot) return step.count == 2 && widthOf(0) == widthOf(1);
  if (step.op == Op::Cross) return step.count == 2 && width == 3 && widthOf(0) == 3 && widthOf(1) == 3;
  if (step.op == Op::Normalize) return widthOf(0) == width;
  if (step.op == Op::Swizzle) {
    for (int i = 0; i < width; ++i) {
      if (widthOf(0) > 1 && ir::swizzleComponent(step.payload, i) >= widthOf(0)) return false;
    }
    return true;
  }
  // Component by component.
  for (size_t k = 0; k < step.count; ++k) {
    if (widthOf(k) != 1 && widthOf(k) != width) return false;
  }
  return true;
}

bool Preshader::uses(size_t parameters) const {
  return std::all_of(steps_.begin(), steps_.end(),
                     [&](const Step& step) { return step.op != Op::Input || step.payload < parameters; });
}

}  // namespace lacquer
