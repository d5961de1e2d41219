#include "api/preshader.h"

#include <cmath>

#include "ir/fold.h"

namespace lacquer {

namespace {

using ir::Components;
using ir::Op;

double dotOf(const Components& a, const Components& b, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += a[static_cast<size_t>(i)] * b[static_cast<size_t>(i)];
  return sum;
}

/// An operand: its type and its value.
struct Operand {
  ir::Type type = ir::Type::Float;
  Components value{};
  int width() const { return ir::componentCount(type); }
};

Components construct(ir::Type type, const std::array<Operand, 4>& parts, size_t count) {
  Components out{};
  if (count == 1 && parts[0].width() == 1) {
    out.fill(parts[0].value[0]);
    for (int i = ir::componentCount(type); i < 4; ++i) out[static_cast<size_t>(i)] = 0;
    return out;
  }
  size_t at = 0;
  for (size_t k = 0; k < count; ++k) {
    for (int i = 0; i < parts[k].width() && at < out.size(); ++i)
      out[at++] = parts[k].value[static_cast<size_t>(i)];
  }
  return out;
}

/// Component by component; a scalar stands for all.
Components mapped(Op op, ir::Type type, const std::array<Operand, 4>& in, size_t count) {
  Components out{};
  for (int i = 0; i < ir::componentCount(type); ++i) {
    std::array<double, 4> x{};
    for (size_t k = 0; k < count; ++k) x[k] = in[k].value[in[k].width() == 1 ? 0 : static_cast<size_t>(i)];
    out[static_cast<size_t>(i)] = ir::foldComponent<double>(op, x[0], x[1], x[2]);
  }
  return out;
}

Components compute(Op op, ir::Type type, uint32_t payload, const std::array<Operand, 4>& in, size_t count) {
  const Components& a = in[0].value;
  const Components& b = in[1].value;
  Components out{};
  if (op == Op::Construct) return construct(type, in, count);
  if (op == Op::Select) return a[0] != 0 ? b : in[2].value;
  if (op == Op::Dot) return {dotOf(a, b, in[0].width())};
  if (op == Op::Length) return {std::sqrt(dotOf(a, a, in[0].width()))};
  if (op == Op::Cross)
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  if (op == Op::Normalize) {
    const double length = std::sqrt(dotOf(a, a, in[0].width()));
    return {a[0] / length, a[1] / length, a[2] / length, a[3] / length};
  }
  if (op == Op::Swizzle) {
    for (int i = 0; i < ir::componentCount(type); ++i) {
      out[static_cast<size_t>(i)] = a[static_cast<size_t>(ir::swizzleComponent(payload, i))];
    }
    return out;
  }
  return mapped(op, type, in, count);
}

}  // namespace

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
    } else {
      std::array<Operand, 4> in{};
      for (size_t k = 0; k < step.count; ++k) in[k] = {steps_[step.args[k]].type, values[step.args[k]]};
      values[s] = compute(step.op, step.type, step.payload, in, step.count);
    }
  }
  std::vector<Components> out;
  for (const Field& field : fields_) {
    out.push_back(values[field.value]);
    for (double& x : out.back()) x = std::isfinite(x) && x != 0 ? x : 0;
  }
  return out;
}

void Preshader::write(BlobWriter& blob) const {
  blob.list(steps_, [&](const Step& step) {
    blob.number(step.op), blob.number(step.type), blob.number(step.count), blob.number(step.payload);
    for (const uint32_t arg : step.args) blob.number(arg);
  });
  blob.list(constants_, [&](const Components& c) {
    for (const double x : c) blob.number(x);
  });
  blob.list(fields_, [&](const Field& f) {
    blob.text(f.name), blob.number(f.type), blob.number(f.offset), blob.number(f.value);
  });
}

Preshader Preshader::read(BlobReader& blob) {
  Preshader made;
  blob.list([&] {
    Step step{};
    step.op = blob.number<ir::Op>(), step.type = blob.number<ir::Type>(), step.count = blob.number<uint8_t>();
    step.payload = blob.number<uint32_t>();
    for (uint32_t& arg : step.args) arg = blob.number<uint32_t>();
    made.steps_.push_back(step);
  });
  blob.list([&] {
    Components c{};
    for (double& x : c) x = blob.number<double>();
    made.constants_.push_back(c);
  });
  blob.list([&] {
    Field field;
    field.name = blob.text(), field.type = blob.number<ir::Type>(), field.offset = blob.number<uint32_t>();
    field.value = blob.number<uint32_t>();
    made.fields_.push_back(std::move(field));
  });
  return made;
}

}  // namespace lacquer
