#include "lang/builtins.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

namespace lacquer::lang {
namespace {

using ir::Dag;
using ir::Op;
using ir::Type;
using ir::ValueId;
using Types = std::span<const Type>;
using Values = std::span<const ValueId>;

std::optional<Type> typeOfOp(const Builtin& builtin, Types types) {
  return ir::resultType(builtin.op, types);
}
ValueId makeOp(const Builtin& builtin, Dag& dag, Values args) { return dag.make(builtin.op, args); }

/// Map: operands of one type, or Float beside a vector.
std::optional<Type> typeOfMap(const Builtin&, Types types) {
  Type result = Type::Float;
  for (const Type type : types) {
    if (!ir::isFloating(type)) return std::nullopt;
    if (type == Type::Float) continue;
    if (result != Type::Float && result != type) return std::nullopt;
    result = type;
  }
  return result;
}

std::optional<Type> typeOfNumbers(const Builtin& builtin, Types types) {
  bool integers = true;
  for (const Type type : types) integers = integers && type == Type::Int;
  return integers ? Type::Int : typeOfMap(builtin, types);
}

/// Ints are loop counters and literals, known when loops are unrolled (checked).
double counterOf(const Dag& dag, ValueId id) {
  assert(dag.isConstant(id));
  return dag.constantOf(id)[0];
}

ValueId makeArithmetic(const Builtin& builtin, Dag& dag, Values args) {
  if (dag[args[0]].type != Type::Int) return dag.make(builtin.op, args);
  const double a = counterOf(dag, args[0]);
  const double b = args.size() > 1 ? counterOf(dag, args[1]) : 0;
  const auto wrapped = [](int64_t x) {
    return static_cast<double>(static_cast<int32_t>(static_cast<uint32_t>(x)));
  };
  const auto x = static_cast<int64_t>(a);
  const auto y = static_cast<int64_t>(b);
  const int64_t result = builtin.op == Op::Neg   ? -x
                         : builtin.op == Op::Add ? x + y
                         : builtin.op == Op::Sub ? x - y
                                                 : x * y;
  return dag.constant(Type::Int, {wrapped(result)});
}

std::optional<Type> typeOfProduct(const Builtin& builtin, Types types) {
  if (types[0] == Type::Mat4) return ir::resultType(Op::MatMul, types);
  return typeOfNumbers(builtin, types);
}

ValueId makeProduct(const Builtin& builtin, Dag& dag, Values args) {
  if (dag[args[0]].type == Type::Mat4) return dag.make(Op::MatMul, args);
  return makeArithmetic(builtin, dag, args);
}

std::optional<Type> typeOfPlus(const Builtin& builtin, Types types) { return typeOfNumbers(builtin, types); }
ValueId makePlus(const Builtin&, Dag&, Values args) { return args[0]; }

std::optional<Type> typeOfComparison(const Builtin&, Types types) { return ir::resultType(Op::Less, types); }
ValueId makeGreater(const Builtin&, Dag& dag, Values args) { return dag.make(Op::Less, {args[1], args[0]}); }
ValueId makeGreaterEqual(const Builtin&, Dag& dag, Values args) {
  return dag.make(Op::LessEqual, {args[1], args[0]});
}

/// Bools have no comparison of their own: a == b is a ? b : !b.
std::optional<Type> typeOfEqual(const Builtin& builtin, Types types) {
  if (types[0] == Type::Bool && types[1] == Type::Bool) return Type::Bool;
  return typeOfComparison(builtin, types);
}
ValueId makeEqual(const Builtin&, Dag& dag, Values args) {
  if (dag[args[0]].type != Type::Bool) return dag.make(Op::Equal, args);
  return dag.make(Op::Select, {args[0], args[1], dag.make(Op::Not, {args[1]})});
}
ValueId makeNotEqual(const Builtin& builtin, Dag& dag, Values args) {
  return dag.make(Op::Not, {makeEqual(builtin, dag, args)});
}

ValueId makeMod(const Builtin&, Dag& dag, Values args) {
  const ValueId whole = dag.make(Op::Floor, {dag.div(args[0], args[1])});
  return dag.sub(args[0], dag.mul(args[1], whole));
}

/// Comparisons take floats, so a vector is made component by component.
ValueId makeStep(const Builtin&, Dag& dag, Values args) {
  const int size = std::max(ir::componentCount(dag[args[0]].type), ir::componentCount(dag[args[1]].type));
  const auto component = [&](ValueId id, int i) {
    return dag[id].type == Type::Float ? id : dag.component(id, i);
  };
  std::vector<ValueId> parts;
  for (int i = 0; i < size; ++i) {
    const ValueId below = dag.make(Op::Less, {component(args[1], i), component(args[0], i)});
    parts.push_back(dag.make(Op::Select, {below, dag.constant(0), dag.constant(1)}));
  }
  return size == 1 ? parts[0] : dag.construct(ir::floatType(size), parts);
}

ValueId saturated(Dag& dag, ValueId x) { return dag.make(Op::Clamp, {x, dag.constant(0), dag.constant(1)}); }
ValueId makeSaturate(const Builtin&, Dag& dag, Values args) { return saturated(dag, args[0]); }

ValueId makeSmoothstep(const Builtin&, Dag& dag, Values args) {
  const ValueId width = dag.sub(args[1], args[0]);
  const ValueId t = saturated(dag, dag.div(dag.sub(args[2], args[0]), width));
  const ValueId twice = dag.mul(dag.constant(2), t);
  const ValueId slope = dag.sub(dag.constant(3), twice);
  return dag.mul(dag.mul(t, t), slope);
}

/// Known at generation time, so that of `?:` and `if` one arm alone is left.
std::optional<Type> typeOfUniform(const Builtin&, Types types) {
  return ir::isFloating(types[0]) || types[0] == Type::Bool ? std::optional(Type::Bool) : std::nullopt;
}
ValueId makeUniform(const Builtin&, Dag& dag, Values args) {
  return dag.boolean(dag[args[0]].rate <= ir::Rate::Object);
}

std::optional<Type> typeOfReflect(const Builtin&, Types types) {
  if (!ir::isFloatVector(types[0]) || types[0] != types[1]) return std::nullopt;
  return types[0];
}
ValueId makeReflect(const Builtin&, Dag& dag, Values args) {
  const ValueId along = dag.make(Op::Dot, {args[1], args[0]});
  const ValueId twice = dag.mul(dag.constant(2), along);
  return dag.sub(args[0], dag.mul(twice, args[1]));
}

std::optional<Type> typeOfDistance(const Builtin&, Types types) { return ir::resultType(Op::Dot, types); }
ValueId makeDistance(const Builtin&, Dag& dag, Values args) {
  return dag.make(Op::Length, {dag.sub(args[0], args[1])});
}

constexpr double kPi = 3.14159265358979323846;
ValueId makeRadians(const Builtin&, Dag& dag, Values args) {
  return dag.mul(args[0], dag.constant(kPi / 180));
}
ValueId makeDegrees(const Builtin&, Dag& dag, Values args) {
  return dag.mul(args[0], dag.constant(180 / kPi));
}
ValueId makeTan(const Builtin&, Dag& dag, Values args) {
  const ValueId cosine = dag.make(Op::Cos, args);
  return dag.div(dag.make(Op::Sin, args), cosine);
}

/// A lookup of a depth map compares; which of two operations it is follows from the texture.
Op lookupOf(const Builtin& builtin, Type texture) {
  if (texture != Type::Texture2DShadow) return builtin.op;
  return builtin.op == Op::Texture ? Op::TextureCompare : Op::TextureCompareLod;
}
std::optional<Type> typeOfLookup(const Builtin& builtin, Types types) {
  const Op op = lookupOf(builtin, types[0]);
  if (op == Op::TextureCompareLod && types[2] != Type::Float) return std::nullopt;
  return ir::resultType(op, types.first(static_cast<size_t>(ir::info(op).arity)));
}
ValueId makeLookup(const Builtin& builtin, Dag& dag, Values args) {
  const Op op = lookupOf(builtin, dag[args[0]].type);
  return dag.make(op, args.first(static_cast<size_t>(ir::info(op).arity)));
}

std::string_view shapeOf(ir::Signature signature) {
  switch (signature) {
    case ir::Signature::Map: return "floats or vectors of one size";
    case ir::Signature::Reduce2: return "two vectors of one size";
    case ir::Signature::Cross: return "two vec3";
    case ir::Signature::Length:
    case ir::Signature::Same: return "a float or a vector";
    case ir::Signature::Compare: return "two floats or two ints";
    case ir::Signature::Logic: return "bools";
    case ir::Signature::Select:
    case ir::Signature::Special: return "";
  }
  return "";
}

Builtin ofOp(std::string_view name, Op op, bool is_operator) {
  const ir::OpInfo& row = ir::info(op);
  return {name, row.arity, is_operator, row.prose, shapeOf(row.signature), op, typeOfOp, makeOp};
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::vector<Builtin> makeTable() {
  constexpr std::string_view kNumbers = "floats or vectors of one size";
  constexpr std::string_view kLookup = "a sampler2D and a vec2, or another sampler and a vec3";
  std::vector<Builtin> table;
  const auto arithmetic = [&](std::string_view spelling, Op op, auto type, auto make) {
    table.push_back({spelling, ir::info(op).arity, true, ir::info(op).prose, kNumbers, op, type, make});
  };
  table.push_back({"+", 1, true, "itself", kNumbers, Op::Constant, typeOfPlus, makePlus});
  arithmetic("-", Op::Neg, typeOfNumbers, makeArithmetic);
  arithmetic("+", Op::Add, typeOfNumbers, makeArithmetic);
  arithmetic("-", Op::Sub, typeOfNumbers, makeArithmetic);
  arithmetic("*", Op::Mul, typeOfProduct, makeProduct);
  table.back().shape = "floats or vectors of one size, or a mat4 and a vec4";
  table.push_back(ofOp("/", Op::Div, true));
  const auto comparison = [&](std::string_view spelling, auto type, auto make, std::string_view prose) {
    table.push_back({spelling, 2, true, prose, "two floats or two ints", Op::Constant, type, make});
  };
  table.push_back(ofOp("<", Op::Less, true));
  table.push_back(ofOp("<=", Op::LessEqual, true));
  comparison(">", typeOfComparison, makeGreater, "a > b");
  comparison(">=", typeOfComparison, makeGreaterEqual, "a >= b");
  comparison("==", typeOfEqual, makeEqual, "a == b");
  comparison("!=", typeOfEqual, makeNotEqual, "a != b");
  for (const auto& [spelling, op] : {std::pair{"&&", Op::And}, {"||", Op::Or}, {"!", Op::Not}}) {
    table.push_back(ofOp(spelling, op, true));
  }

  for (int i = 0; i < ir::kOpCount; ++i) {
    const auto op = static_cast<Op>(i);
    const ir::OpInfo& row = ir::info(op);
    const bool callable = row.signature == ir::Signature::Map || row.signature == ir::Signature::Reduce2 ||
                          row.signature == ir::Signature::Cross || row.signature == ir::Signature::Length ||
                          row.signature == ir::Signature::Same;
    // What has an operator is written with it.
    const bool spelled = !row.glsl.empty() && !isLetter(row.glsl.front());
    if (callable && !spelled) table.push_back(ofOp(row.name, op, false));
  }
  table.push_back(ofOp("atan", Op::Atan2, false));
  for (const auto& [name, op] : {std::pair{"texture", Op::Texture}, {"textureLod", Op::TextureLod}}) {
    table.push_back(
        {name, ir::info(op).arity, false, ir::info(op).prose,
         op == Op::Texture ? kLookup : "a sampler2D and a vec2, or another sampler and a vec3; a float", op,
         typeOfLookup, makeLookup});
  }

  const auto derived = [&](std::string_view name, int arity, std::string_view shape, auto type, auto make,
                           std::string_view prose) {
    table.push_back({name, arity, false, prose, shape, Op::Constant, type, make});
  };
  derived("mod", 2, kNumbers, typeOfMap, makeMod, "x - y * floor(x / y)");
  derived("step", 2, kNumbers, typeOfMap, makeStep, "0 where x < edge, else 1");
  derived("smoothstep", 3, kNumbers, typeOfMap, makeSmoothstep, "0 to 1 between two edges, smooth at both");
  derived("saturate", 1, kNumbers, typeOfMap, makeSaturate, "clamp(x, 0, 1)");
  derived("reflect", 2, "two vectors of one size", typeOfReflect, makeReflect, "i - 2 * dot(n, i) * n");
  derived("distance", 2, "two vectors of one size", typeOfDistance, makeDistance, "length(a - b)");
  derived("radians", 1, kNumbers, typeOfMap, makeRadians, "of degrees");
  derived("degrees", 1, kNumbers, typeOfMap, makeDegrees, "of radians");
  derived("tan", 1, kNumbers, typeOfMap, makeTan, "tangent of radians");
  derived("uniform", 1, "a bool, a float or a vector", typeOfUniform, makeUniform,
          "whether x is the same all over the picture: no texture, no vertex and no light goes into it");
  return table;
}

const std::vector<Builtin>& table() {
  static const std::vector<Builtin> kTable = makeTable();
  return kTable;
}

}  // namespace

std::span<const Builtin> builtins() { return table(); }

const Builtin* findFunction(std::string_view name, int arity) {
  for (const Builtin& builtin : table()) {
    if (!builtin.is_operator && builtin.name == name && builtin.arity == arity) return &builtin;
  }
  return nullptr;
}

const Builtin* findFunction(std::string_view name) {
  for (const Builtin& builtin : table()) {
    if (!builtin.is_operator && builtin.name == name) return &builtin;
  }
  return nullptr;
}

const Builtin* findOperator(std::string_view spelling, int arity) {
  for (const Builtin& builtin : table()) {
    if (builtin.is_operator && builtin.name == spelling && builtin.arity == arity) return &builtin;
  }
  return nullptr;
}

}  // namespace lacquer::lang
