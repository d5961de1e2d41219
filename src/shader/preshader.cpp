#include "shader/preshader.h"

#include <cmath>

#include "ir/fold.h"

namespace lacquer {

using ir::Components;
using ir::Op;

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
      std::array<ir::Operand, 4> in{};
      for (size_t k = 0; k < step.count; ++k) in[k] = {steps_[step.args[k]].type, values[step.args[k]]};
      values[s] = ir::foldNumbers(step.op, step.type, step.payload, {in.data(), step.count});
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
