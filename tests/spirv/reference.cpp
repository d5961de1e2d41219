#include "spirv/reference.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "ir/fold.h"
#include "schedule/schedule.h"
#include "targets/clike.h"

namespace lacquer::spirv_test {

using ir::InputKind;
using ir::Op;
using ir::Type;
using ir::ValueId;

namespace {

uint32_t wordsOf(Type type) { return static_cast<uint32_t>(ir::componentCount(type)); }

class Evaluator {
public:
  Evaluator(const ir::Module& module, const World& world) : module_(module), dag_(module.dag), world_(world) {
    known_.resize(dag_.size());
  }

  const Cell& value(ValueId id) {
    Cell& known = known_[id];
    if (known.empty()) {
      Cell made = compute(id);
      if (dag_[id].rate == ir::Rate::Light) of_this_light_.push_back(id);
      known = std::move(made);
    }
    return known;
  }

private:
  Cell compute(ValueId id) {
    const ir::Value& v = dag_[id];
    const size_t width = wordsOf(v.type);
    if (v.op == Op::Constant) {
      Cell c(dag_.constantOf(id).begin(), dag_.constantOf(id).begin() + static_cast<ptrdiff_t>(width));
      for (double& x : c) x = ir::isWhole(v.type) ? x : static_cast<float>(x);
      return c;
    }
    if (v.op == Op::Input) return input(dag_.inputOf(id));
    if (v.op == Op::SumOverLights) return sum(v);
    if (v.op == Op::Carried) return carried(v);
    std::vector<Cell> x;
    for (const ValueId operand : v.operands()) {
      x.push_back(dag_[operand].type == Type::Texture2D || dag_[operand].type == Type::TextureCube
                      ? Cell{}
                      : value(operand));
    }
    switch (ir::info(v.op).signature) {
      case ir::Signature::Map:
      case ir::Signature::Compare:
      case ir::Signature::Logic:
      case ir::Signature::Whole:
      case ir::Signature::WholeTest:
      case ir::Signature::Shift: {
        Cell result(width);
        for (size_t i = 0; i < width; ++i) {
          const auto at = [&](size_t k) {
            return k >= x.size() ? 0.0 : x[k].size() == 1 ? x[k][0] : x[k].at(i);
          };
          result[i] = ir::foldComponent<double>(v.op, at(0), at(1), at(2));
        }
        return result;
      }
      case ir::Signature::Reduce2: return {dot(x[0], x[1])};
      case ir::Signature::Length: return {std::sqrt(dot(x[0], x[0]))};
      case ir::Signature::Cross:
        return {x[0][1] * x[1][2] - x[0][2] * x[1][1], x[0][2] * x[1][0] - x[0][0] * x[1][2],
                x[0][0] * x[1][1] - x[0][1] * x[1][0]};
      case ir::Signature::Select: return x[0][0] != 0 ? x[1] : x[2];
      case ir::Signature::Same:
      case ir::Signature::Special: return special(v, x);
    }
    return {};
  }

  Cell special(const ir::Value& v, const std::vector<Cell>& x) {
    Cell result;
    if (v.op == Op::Normalize) {
      for (const double c : x[0]) result.push_back(c / std::sqrt(dot(x[0], x[0])));
    } else if (v.op == Op::DFdx) {  // the interpreter's made-up derivatives
      for (const double c : x[0]) result.push_back(c * 0.5 + 1);
    } else if (v.op == Op::DFdy) {
      for (const double c : x[0]) result.push_back(c * 0.25 + 2);
    } else if (v.op == Op::Construct) {
      for (const Cell& part : x) result.insert(result.end(), part.begin(), part.end());
      if (result.size() == 1) result.assign(wordsOf(v.type), result[0]);
    } else if (v.op == Op::Swizzle) {
      for (uint32_t i = 0; i < wordsOf(v.type); ++i) {
        result.push_back(x[0].at(static_cast<size_t>(ir::swizzleComponent(v.payload, static_cast<int>(i)))));
      }
    } else if (v.op == Op::MatMul) {
      result.assign(4, 0);
      for (size_t column = 0; column < 4; ++column) {
        for (size_t row = 0; row < 4; ++row) result[row] += x[0].at(column * 4 + row) * x[1].at(column);
      }
    } else if (v.op == Op::Column) {
      result.assign(x[0].begin() + 4 * v.payload, x[0].begin() + 4 * v.payload + 4);
    } else if (v.op == Op::TextureSize) {
      const ir::Binding at = module_.textures[dag_.inputOf(v.args[0]).field].binding;
      result = {world_.size(at.set, at.binding, x[1][0]).at(v.payload)};
    } else if (v.op == Op::TextureGrad) {
      const ir::Binding at = module_.textures[dag_.inputOf(v.args[0]).field].binding;
      result = world_.texel(at.set, at.binding, x[1], x[2][0] + 3 * x[3][1]);
    } else if (ir::facts(v.op).kind == ir::Kind::Components) {
      result = {ir::foldComponent<double>(v.op, x[0][0], 0, 0)};
    } else {
      EXPECT_TRUE(v.op == Op::Texture || v.op == Op::TextureLod) << ir::info(v.op).name;
      const ir::TextureSlot& slot = module_.textures[dag_.inputOf(v.args[0]).field];
      const ir::Binding at = slot.binding;
      const double implicit = v.rate <= ir::Rate::Vertex && vertex ? 0 : -1;
      result = world_.texel(at.set, at.binding, x[1], v.op == Op::TextureLod ? x[2][0] : implicit);
    }
    return result;
  }

  static double dot(const Cell& a, const Cell& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  Cell input(const ir::Input& in) {
    switch (in.kind) {
      case InputKind::Parameter:
      case InputKind::Texture:
      case InputKind::LoopIndex:
      case InputKind::LoopValue: break;  // known in a loop's rounds
      case InputKind::SpecConstant: return constant(in);
      case InputKind::LightIndex: return {static_cast<double>(light_)};
      case InputKind::FrontFacing: return world_.inputs.at("gl_FrontFacing");
      case InputKind::Attribute:
        return world_.inputs.at(targets::attributeName(module_.attributes[in.field]));
      case InputKind::Varying: return world_.inputs.at(targets::varyingName(module_.varyings[in.field]));
      case InputKind::BlockField: return field(in.block, in.field, in.element >= 0 ? in.element : light_);
    }
    ADD_FAILURE() << in.name << " is not a value";
    return {0};
  }

  /// A specialization constant that the pipeline left alone.
  Cell constant(const ir::Input& in) const {
    const ir::Components& c = module_.parameters[in.field].neutral;
    return {c.begin(), c.begin() + ir::componentCount(in.type)};
  }

  Cell field(uint32_t b, uint32_t f, int32_t element) const {
    const ir::Block& block = module_.blocks[b];
    const ir::Binding at = block.binding;
    const std::vector<uint8_t>& bytes = world_.blocks.at({at.set, at.binding});
    const uint32_t base = block.array == 0 ? 0 : static_cast<uint32_t>(element) * block.size;
    Cell read(wordsOf(block.fields[f].type));
    for (size_t i = 0; i < read.size(); ++i) {
      uint32_t word = 0;
      std::memcpy(&word, bytes.data() + base + block.fields[f].offset + i * 4, 4);
      const bool whole = block.fields[f].type == Type::Int;
      read[i] = whole ? static_cast<double>(static_cast<int32_t>(word)) : std::bit_cast<float>(word);
    }
    return read;
  }

  Cell sum(const ir::Value& v) {
    const ir::LightGroup& group = module_.light_groups[v.payload];
    int32_t end = group.first + group.count;
    for (uint32_t b = 0; b < module_.blocks.size() && group.count < 0; ++b) {
      for (uint32_t f = 0; f < module_.blocks[b].fields.size(); ++f) {
        if (module_.blocks[b].fields[f].name == "light_count") end = static_cast<int32_t>(field(b, f, 0)[0]);
      }
    }
    // Sums that this one needs have loops of their own.
    for (const ValueId id : ir::reachable(dag_, {{v.args[0]}})) {
      if (dag_[id].op == Op::SumOverLights) value(id);
    }
    Cell total(wordsOf(v.type), 0);
    for (light_ = group.first; light_ < end; ++light_) {
      const Cell& term = value(v.args[0]);
      for (size_t i = 0; i < total.size(); ++i) total[i] += term[i];
      for (const ValueId id : of_this_light_) known_[id].clear();
      of_this_light_.clear();
    }
    return total;
  }

  /// Runs the whole loop for one of the values that it carries.
  Cell carried(const ir::Value& v) {
    std::vector<ir::Value> links;
    ValueId link = v.args[0];
    for (; dag_[link].op == Op::Carry; link = dag_[link].args[0]) links.push_back(dag_[link]);
    const ValueId index = dag_[link].args[1];
    // What is made of the loop's inputs, however far from it.
    std::vector<ValueId> inner;
    std::vector<bool> inside(dag_.size(), false);
    for (const ValueId id : ir::reachable(dag_, {{v.args[0]}})) {
      const ir::Value& value = dag_[id];
      bool of_loop = value.op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind) &&
                     dag_.inputOf(id).field == dag_.inputOf(index).field;
      for (const ValueId operand : value.operands()) of_loop = of_loop || inside[operand];
      inside[id] = of_loop;
      if (of_loop) inner.push_back(id);
    }
    const double end = value(dag_[link].args[0])[0];
    std::vector<Cell> state;
    for (const ir::Value& l : links) state.push_back(value(l.args[1]));
    const ir::Interval& range = dag_.inputOf(index).range;
    const auto forget = [&] {
      for (const ValueId id : inner) known_[id].clear();
    };
    for (double round = range.lo; round < end && round <= range.hi; ++round) {
      forget();
      known_[index] = {round};
      for (size_t k = 0; k < links.size(); ++k) known_[links[k].args[3]] = state[k];
      std::vector<Cell> next;
      for (const ir::Value& l : links) next.push_back(value(l.args[2]));
      state = std::move(next);
    }
    forget();
    for (size_t k = 0; k < links.size(); ++k) {
      if (dag_.inputOf(links[k].args[3]).index == v.payload) return state[k];
    }
    ADD_FAILURE() << "nothing carries that";
    return {0};
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  const World& world_;
  std::vector<Cell> known_;
  std::vector<ValueId> of_this_light_;
  int32_t light_ = 0;

public:
  bool vertex = false;
};

}  // namespace

World makeWorld(const ir::Module& module, uint32_t seed, int32_t light_count) {
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<float>(static_cast<int>(random() % 65) - 32) / 16; };
  const auto cell = [&](Type type) {
    Cell c(wordsOf(type));
    for (double& x : c) x = number();
    return c;
  };
  World world;
  for (const ir::Block& block : module.blocks) {
    const ir::Binding at = block.binding;
    const uint32_t elements = std::max(block.array, 1U);
    std::vector<uint8_t>& bytes = world.blocks[{at.set, at.binding}];
    bytes.assign(size_t{elements} * block.size, 0xff);
    for (uint32_t e = 0; e < elements; ++e) {
      for (const ir::BlockField& f : block.fields) {
        for (uint32_t i = 0; i < wordsOf(f.type); ++i) {
          uint32_t word = std::bit_cast<uint32_t>(number());
          if (f.type == Type::Int) word = random() % 4;
          if (f.name == "light_count") word = static_cast<uint32_t>(light_count);
          std::memcpy(bytes.data() + e * block.size + f.offset + i * 4, &word, 4);
        }
      }
    }
  }
  for (const ir::Attribute& a : module.attributes) world.inputs[targets::attributeName(a)] = cell(a.type);
  for (const ir::Varying& v : module.varyings) world.inputs[targets::varyingName(v)] = cell(v.type);
  world.inputs["gl_FrontFacing"] = {static_cast<double>(random() % 2)};
  world.texel = [](uint32_t set, uint32_t binding, const Cell& at, double lod) {
    Cell texel(4, set * 0.5 + binding * 0.25 + lod * 0.125);
    for (size_t i = 0; i < 4; ++i) texel[i] += at[i % at.size()] * (0.5 + 0.25 * static_cast<double>(i));
    return texel;
  };
  world.size = [](uint32_t set, uint32_t binding, double level) {
    return Cell{4 + set + 2.0 * binding + std::fmod(level, 8), 2 + 3.0 * set + binding};
  };
  return world;
}

Outcome evaluate(const ir::Module& module, ir::Stage stage, const World& world) {
  Evaluator evaluator(module, world);
  evaluator.vertex = stage == ir::Stage::Vertex;
  Outcome outcome;
  for (const ir::Output& output : module.outputs) {
    if (output.stage != stage) continue;
    const Cell& value = evaluator.value(output.value);
    switch (output.kind) {
      case ir::OutputKind::Position: outcome.outputs["gl_Position"] = value; break;
      case ir::OutputKind::Depth: outcome.outputs["gl_FragDepth"] = value; break;
      case ir::OutputKind::Color: outcome.outputs[targets::outputName(output)] = value; break;
      case ir::OutputKind::Discard: outcome.dropped |= value[0] != 0; break;
      case ir::OutputKind::Varying:
        outcome.outputs[targets::varyingName(module.varyings[output.location])] = value;
        break;
    }
  }
  return outcome;
}

void expectSame(const Outcome& expected, const Outcome& actual) {
  EXPECT_EQ(expected.dropped, actual.dropped);
  if (expected.dropped) return;
  ASSERT_EQ(expected.outputs.size(), actual.outputs.size());
  for (const auto& [name, cell] : expected.outputs) {
    ASSERT_TRUE(actual.outputs.contains(name)) << name;
    const Cell& got = actual.outputs.at(name);
    ASSERT_EQ(cell.size(), got.size()) << name;
    for (size_t i = 0; i < cell.size(); ++i) {
      EXPECT_NEAR(cell[i], got[i], 1e-9 * (1 + std::abs(cell[i]))) << name << " component " << i;
    }
  }
}

}  // namespace lacquer::spirv_test
