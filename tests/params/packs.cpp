#include "packs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ir/facts.h"
#include "ir/names.h"
#include "ir/whole.h"
#include "shader/preshader.h"

namespace lacquer::test {

using Json = nlohmann::json;

namespace {

std::vector<std::string> exampleFiles() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(LACQUER_EXAMPLES)) {
    if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<double> valueOf(const Json& parameter) {
  const Json& value = parameter["value"];
  if (value.is_boolean()) return {value.get<bool>() ? 1.0 : 0.0};
  return value.is_array() ? value.get<std::vector<double>>() : std::vector<double>{value.get<double>()};
}

/// A preshader of every operation on every type, with names that mean something in the targets.
class RandomPreshader {
public:
  RandomPreshader(uint32_t seed, const std::vector<ir::Op>& ops) : random_(seed), ops_(ops) {
    const char* names[] = {"double",   "p",   "min_of", "block", "detail",
                           "to_float", "mix", "store",  "Block", "length"};
    for (uint32_t i = 0; i < std::size(names); ++i)
      addParameter(names[i], ir::floatType(1 + static_cast<int>(i % 4)));
    addParameter("flag", ir::Type::Bool);
    addParameter("register", ir::Type::Bool);
    for (const double x : {0.5, -2.0, 1e-7, 3.0, -0.125}) keep(dag().constant(x));
    keep(dag().constant(ir::Type::Vec3, {0.1, 0.2, -0.3}));
    keep(dag().constant(ir::Type::Vec2, {4, 4}));
    addParameter("whole", ir::Type::Int);
    addParameter("bits", ir::Type::UInt);
    addParameter("int_of", ir::Type::UVec3);
    addParameter("true_of", ir::Type::BVec3);
    for (const int32_t i : {3, -7, 0}) keep(dag().integer(i));
    for (const uint32_t i : {5U, 4000000000U}) keep(dag().uinteger(i));
  }

  ir::Module make(int operations) {
    for (int i = 0; i < operations; ++i) {
      dag().setTerm(dag().addTerm(fmt::format("term.{}", i / 7), "a \"source\" \\"));
      operation();
    }
    module_.template_name = "random";
    ir::Block block{ir::BlockRole::Material, "Material", "material", {}, 0, 0};
    ir::Names names;
    for (const ir::ValueId id : all_) {
      const bool boolean = dag()[id].type == ir::Type::Bool;
      const ir::ValueId value =
          boolean ? dag().make(ir::Op::Select, {id, dag().constant(1), dag().constant(0)}) : id;
      module_.preshader.push_back({static_cast<uint32_t>(block.fields.size()), value});
      block.fields.push_back({names.pick("field"), dag()[value].type, 0, {}, {}});
    }
    block.size = ir::layout(block.fields);
    module_.blocks.push_back(block);
    return std::move(module_);
  }

private:
  ir::Dag& dag() { return module_.dag; }
  uint32_t below(uint32_t n) { return random_() % n; }

  void addParameter(const std::string& name, ir::Type type) {
    const auto index = static_cast<uint32_t>(module_.parameters.size());
    ir::Parameter parameter{name, type, {}, {-4, 4}, {}};
    parameter.neutral = {0.25, -1, 2, 1e-9};
    module_.parameters.push_back(parameter);
    const ir::ValueId input =
        dag().input({ir::InputKind::Parameter, name, type, ir::Rate::Material, {}, 0, index});
    if (!ir::isComposite(type)) return keep(input);
    for (int i = 0; i < ir::componentCount(type); ++i) keep(dag().component(input, i));
  }

  void keep(ir::ValueId id) {
    all_.push_back(id);
    constexpr std::array kNames = {"pow", "class", "p", "block", "value", "x", "sqrt"};
    if (below(2) == 0) dag().name(id, kNames[below(kNames.size())]);
  }

  ir::ValueId pick(ir::Type type) {
    std::vector<ir::ValueId> fitting;
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(fitting),
                 [&](ir::ValueId id) { return dag()[id].type == type; });
    return fitting[below(static_cast<uint32_t>(fitting.size()))];
  }

  void operation() {
    const ir::Op op = ops_[turn_++ % ops_.size()];
    const ir::Type vector = ir::floatType(1 + static_cast<int>(below(4)));
    if (op == ir::Op::Construct) return keep(construct(ir::floatType(2 + static_cast<int>(below(3)))));
    if (op == ir::Op::Swizzle) return keep(swizzle());
    std::array<ir::Type, 3> types{vector, vector, vector};
    switch (ir::info(op).signature) {
      case ir::Signature::Map:
        for (ir::Type& type : types) type = below(3) == 0 ? ir::Type::Float : vector;
        break;
      case ir::Signature::Cross: types.fill(ir::Type::Vec3); break;
      case ir::Signature::Compare: types.fill(ir::Type::Float); break;
      case ir::Signature::Logic: types.fill(ir::Type::Bool); break;
      case ir::Signature::Select: types[0] = ir::Type::Bool; break;
      case ir::Signature::Whole:
      case ir::Signature::WholeTest:
      case ir::Signature::Shift: types = integers(op); break;
      case ir::Signature::Reduce2:
      case ir::Signature::Length:
      case ir::Signature::Same: break;
      case ir::Signature::Special: types.fill(converted(op)); break;
    }
    std::array<ir::ValueId, 3> operands{};
    const auto count = static_cast<size_t>(ir::info(op).arity);
    for (size_t k = 0; k < count; ++k) operands[k] = pick(types[k]);
    keep(dag().make(op, {operands.data(), count}));
  }

  std::array<ir::Type, 3> integers(ir::Op op) {
    using ir::Op;
    const bool ints = op == Op::IntDiv || op == Op::IntLess || op == Op::IntShiftRight;
    const bool uints = op == Op::UIntDiv || op == Op::UIntLess || op == Op::UIntShiftRight;
    const ir::Type type = ints || (!uints && below(2) == 0) ? ir::Type::Int : ir::Type::UInt;
    const bool shift = ir::info(op).signature == ir::Signature::Shift;
    return {type, shift ? ir::Type::UInt : type, type};
  }

  /// Of what a conversion makes something.
  static ir::Type converted(ir::Op op) {
    if (op == ir::Op::FromInt || op == ir::Op::AsUInt) return ir::Type::Int;
    return op == ir::Op::FromUInt || op == ir::Op::AsInt ? ir::Type::UInt : ir::Type::Float;
  }

  ir::ValueId construct(ir::Type type) {
    if (below(4) == 0) return dag().construct(type, {pick(ir::Type::Float)});
    std::vector<ir::ValueId> parts;
    for (int left = ir::componentCount(type); left > 0;) {
      const int width = 1 + static_cast<int>(below(static_cast<uint32_t>(std::min(left, 3))));
      parts.push_back(pick(ir::floatType(width)));
      left -= width;
    }
    return dag().construct(type, parts);
  }

  ir::ValueId swizzle() {
    const ir::Type from = ir::floatType(2 + static_cast<int>(below(3)));
    std::vector<int> components(1 + below(4));
    for (int& c : components) c = static_cast<int>(below(static_cast<uint32_t>(ir::componentCount(from))));
    return dag().swizzle(pick(from), components);
  }

  std::mt19937 random_;
  const std::vector<ir::Op>& ops_;
  ir::Module module_;
  std::vector<ir::ValueId> all_;
  size_t turn_ = 0;
};

}  // namespace

Options packingOptions(Target target) {
  Options options;
  options.targets = {target};
  options.validate = false;
  options.unused = true;
  return options;
}

/// Every graph of the examples, with its shader.
void eachExample(const Options& options, const std::function<void(Graph&, const Shader&)>& call) {
  Messages messages;
  for (const std::string& file : exampleFiles()) {
    const Scene scene = Scene::load(file, options, messages);
    ASSERT_TRUE(scene) << file;
    for (size_t m = 0; m < scene.materialCount(); ++m) {
      std::vector<Attributes> uses = scene.uses(m);
      if (uses.empty()) uses.push_back({true, true, false, {true, true, false, false}});
      for (const Attributes& attributes : uses) {
        Graph graph = scene.graph(m, attributes, options, messages);
        if (!graph) continue;
        const Shader shader = graph.generate(options, messages);
        ASSERT_TRUE(shader) << file << " " << m;
        call(graph, shader);
      }
    }
  }
}

Numbers valuesOf(const Json& parameters) {
  Numbers numbers;
  for (const auto& [name, parameter] : parameters.items()) numbers[name] = valueOf(parameter);
  return numbers;
}

/// Numbers in the ranges, and at their ends.
Numbers randomValues(const Json& parameters, std::mt19937& random) {
  Numbers numbers = valuesOf(parameters);
  for (auto& [name, components] : numbers) {
    const Json range = parameters[name].value("range", Json::array({nullptr, nullptr}));
    const auto end = [&](size_t i, double open) {
      return range[i].is_number() ? range[i].get<double>() : open;
    };
    const double lo = std::max(end(0, -10), -10.0);
    const double hi = std::min(end(1, 10), 10.0);
    for (double& x : components) {
      const uint32_t kind = random() % 10;
      x = kind == 0 ? lo : kind == 1 ? hi : std::uniform_real_distribution<double>(lo, hi)(random);
    }
  }
  return numbers;
}

Numbers outsideValues(const Json& parameters, std::mt19937& random) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Numbers numbers = valuesOf(parameters);
  for (auto& [name, components] : numbers) {
    const Json range = parameters[name].value("range", Json::array({nullptr, nullptr}));
    const auto end = [&](size_t i, double open) {
      return range[i].is_number() ? range[i].get<double>() : open;
    };
    const double kinds[] = {end(0, -1) - 1, end(1, 1) + 1, 0.5,       3.5e38,    -3.5e38,
                            1e308,          -1e308,        kInfinite, -kInfinite};
    for (double& x : components) x = kinds[random() % std::size(kinds)];
  }
  return numbers;
}

std::string hexOf(const std::vector<uint8_t>& bytes) {
  std::string text;
  for (const uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::string packedByLibrary(const Shader& shader, const Numbers& numbers) {
  std::vector<uint8_t> bytes(shader.uniformSize());
  const bool packed = shader.pack(
      [&](std::string_view name, std::span<double> components) {
        const auto& values = numbers.at(std::string(name));
        std::copy_n(values.begin(), components.size(), components.begin());
        return true;
      },
      std::as_writable_bytes(std::span(bytes)));
  EXPECT_TRUE(packed);
  for (size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    float x = 0;
    std::memcpy(&x, bytes.data() + at, 4);
    EXPECT_TRUE(std::isfinite(x)) << shader.id() << " at " << at;
  }
  return hexOf(bytes);
}

const std::vector<ir::Op>& preshaderOps() {
  static const std::vector<ir::Op> kOps = [] {
    std::vector<ir::Op> ops;
    for (const ir::Facts& facts : ir::kFacts) {
      if (facts.kind != ir::Kind::Surroundings) ops.push_back(facts.op);
    }
    return ops;
  }();
  return kOps;
}

ir::Module randomPreshader(uint32_t seed, int operations, const std::vector<ir::Op>& ops) {
  return RandomPreshader(seed, ops).make(operations);
}

Numbers randomNumbers(const ir::Module& module, std::mt19937& random, bool whole) {
  Numbers numbers;
  for (const ir::Parameter& p : module.parameters) {
    std::vector<double>& values = numbers[p.name];
    for (int c = 0; c < ir::componentCount(p.type); ++c) {
      const double x = std::uniform_real_distribution<double>(-4, 4)(random);
      const ir::Type part = ir::partType(p.type);
      const double rounded = part == ir::Type::UInt ? std::abs(std::round(x)) : std::round(x);
      values.push_back(part == ir::Type::Bool       ? static_cast<double>(x > 0)
                       : whole || ir::isWhole(part) ? rounded
                                                    : x);
    }
  }
  return numbers;
}

std::string evaluated(const ir::Module& module, const Numbers& numbers) {
  const Preshader preshader(module);
  std::vector<ir::Components> parameters;
  for (const ir::Parameter& p : module.parameters) {
    ir::Components components{};
    const std::vector<double>& values = numbers.at(p.name);
    std::copy(values.begin(), values.end(), components.begin());
    parameters.push_back(components);
  }
  std::vector<uint8_t> bytes(module.blocks[0].size);
  const auto values = preshader.evaluate([&](uint32_t i) -> const ir::Components& { return parameters[i]; });
  for (size_t i = 0; i < values.size(); ++i) {
    const Preshader::Field& field = preshader.fields()[i];
    for (int c = 0; c < ir::componentCount(field.type); ++c) {
      const double number = values[i][static_cast<size_t>(c)];
      const auto x = static_cast<float>(number);
      const uint32_t bits = ir::isWhole(field.type) ? ir::bits(number) : std::bit_cast<uint32_t>(x);
      std::memcpy(bytes.data() + field.offset + 4 * c, &bits, 4);
    }
  }
  return hexOf(bytes);
}

}  // namespace lacquer::test
