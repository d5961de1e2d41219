#include "lang/builtins.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "lang/composites.h"

namespace lacquer::lang {
namespace {

using ir::Dag;
using ir::Op;
using ir::Type;
using Types = std::span<const Type>;

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

bool integral(Type type) { return ir::isWhole(ir::partType(type)); }

/// Integers of one kind, a scalar beside a vector of any size.
std::optional<Type> typeOfIntegers(Types types) {
  const Type part = ir::partType(types[0]);
  if (!ir::isWhole(part)) return std::nullopt;
  int width = 1;
  for (const Type type : types) {
    const int own = ir::componentCount(type);
    if (ir::partType(type) != part || (own != 1 && width != 1 && own != width)) return std::nullopt;
    width = std::max(width, own);
  }
  return ir::vectorType(part, width);
}

/// Integers, or what Map takes.
std::optional<Type> typeOfNumbers(const Builtin& builtin, Types types) {
  return integral(types[0]) ? typeOfIntegers(types) : typeOfMap(builtin, types);
}

std::optional<Type> typeOfWholes(const Builtin&, Types types) { return typeOfIntegers(types); }

Type resultOf(Dag& dag, Values args) {
  std::array<Type, 4> types{};
  for (size_t i = 0; i < args.size(); ++i) types[i] = dag[args[i]].type;
  return *typeOfIntegers({types.data(), args.size()});
}

/// Component by component, by an op on integers.
ValueId wholes(Dag& dag, Op op, Values args) {
  return byComponent(dag, resultOf(dag, args), args, [&](Values x) { return dag.make(op, x); });
}

ValueId below(Dag& dag, ValueId a, ValueId b) {
  return dag.make(dag[a].type == Type::Int ? Op::IntLess : Op::UIntLess, {a, b});
}

/// Defined for all operands: by 0 it is 0, and the least Int by -1 is itself, as integers wrap.
ValueId quotientOf(Dag& dag, ValueId a, ValueId b) {
  const Type type = dag[a].type;
  const bool known = dag.isConstant(b) && !dag.isConstant(b, 0);
  if (type == Type::UInt) {
    if (known) return dag.make(Op::UIntDiv, {a, b});
    const ValueId zero = dag.make(Op::WholeEqual, {b, dag.uinteger(0)});
    const ValueId divisor = dag.make(Op::Select, {zero, dag.uinteger(1), b});
    return dag.make(Op::Select, {zero, dag.uinteger(0), dag.make(Op::UIntDiv, {a, divisor})});
  }
  if (dag.isConstant(b, -1)) return dag.make(Op::WholeSub, {dag.integer(0), a});
  if (known) return dag.make(Op::IntDiv, {a, b});
  // 1 takes the place of 0 and of -1, of which the quotient is made otherwise.
  const ValueId zero = dag.make(Op::WholeEqual, {b, dag.integer(0)});
  const ValueId minus = dag.make(Op::WholeEqual, {b, dag.integer(-1)});
  const ValueId divisor = dag.make(Op::Select, {dag.make(Op::Or, {zero, minus}), dag.integer(1), b});
  const ValueId quotient = dag.make(Op::IntDiv, {a, divisor});
  const ValueId negated = dag.make(Op::WholeSub, {dag.integer(0), a});
  return dag.make(Op::Select, {zero, dag.integer(0), dag.make(Op::Select, {minus, negated, quotient})});
}

Op wholeOf(Op op) { return op == Op::Add ? Op::WholeAdd : op == Op::Sub ? Op::WholeSub : Op::WholeMul; }

ValueId makeArithmetic(const Builtin& builtin, Dag& dag, Values args) {
  const Type type = dag[args[0]].type;
  if (ir::isMatrix(type) || (args.size() > 1 && ir::isMatrix(dag[args[1]].type))) {
    const Type result = ir::isMatrix(type) ? type : dag[args[1]].type;
    return byColumn(dag, result, args, [&](Values x) { return dag.make(builtin.op, x); });
  }
  if (!integral(type)) return dag.make(builtin.op, args);
  if (args.size() == 1)
    return wholes(dag, Op::WholeSub, std::array{dag.constant(ir::partType(type), {}), args[0]});
  if (builtin.op != Op::Div) return wholes(dag, wholeOf(builtin.op), args);
  return byComponent(dag, resultOf(dag, args), args, [&](Values x) { return quotientOf(dag, x[0], x[1]); });
}

/// Sums, differences and quotients: of matrices column by column, with a float beside.
std::optional<Type> typeOfSum(const Builtin& builtin, Types types) {
  for (const Type type : types) {
    if (!ir::isMatrix(type)) continue;
    const auto fits = [&](Type other) { return other == type || other == Type::Float; };
    return std::all_of(types.begin(), types.end(), fits) ? std::optional(type) : std::nullopt;
  }
  return typeOfNumbers(builtin, types);
}

std::optional<Type> typeOfProduct(const Builtin& builtin, Types types) {
  const auto [a, b] = std::pair{types[0], types[1]};
  if (ir::isMatrix(a) && b == ir::partType(a)) return b;
  if (ir::isMatrix(b) && a == ir::partType(b)) return a;
  return typeOfSum(builtin, types);
}

ValueId makeProduct(const Builtin& builtin, Dag& dag, Values args) {
  if (ir::isMatrix(dag[args[0]].type) || ir::isMatrix(dag[args[1]].type))
    return multiplied(dag, args[0], args[1]);
  return makeArithmetic(builtin, dag, args);
}

ValueId makeRemainder(const Builtin&, Dag& dag, Values args) {
  return byComponent(dag, resultOf(dag, args), args, [&](Values x) {
    const ValueId whole = dag.make(Op::WholeMul, {x[1], quotientOf(dag, x[0], x[1])});
    return dag.make(Op::WholeSub, {x[0], whole});
  });
}

template <Op op>
ValueId makeBits(const Builtin&, Dag& dag, Values args) {
  return wholes(dag, op, args);
}

/// Counts are taken modulo 32, as no device but in the range knows them.
std::optional<Type> typeOfShift(const Builtin&, Types types) {
  const int width = ir::componentCount(types[0]);
  const int counts = ir::componentCount(types[1]);
  return integral(types[0]) && integral(types[1]) && (counts == 1 || counts == width)
             ? std::optional(types[0])
             : std::nullopt;
}
template <bool left>
ValueId makeShift(const Builtin&, Dag& dag, Values args) {
  return byComponent(dag, dag[args[0]].type, args, [&](Values x) {
    const ValueId count = dag.make(Op::BitAnd, {converted(dag, x[1], Type::UInt), dag.uinteger(31)});
    const Op right = dag[x[0]].type == Type::Int ? Op::IntShiftRight : Op::UIntShiftRight;
    return dag.make(left ? Op::ShiftLeft : right, {x[0], count});
  });
}

std::optional<Type> typeOfPlus(const Builtin& builtin, Types types) { return typeOfSum(builtin, types); }
ValueId makePlus(const Builtin&, Dag&, Values args) { return args[0]; }

/// Two floats, or two integers of one kind.
std::optional<Type> typeOfComparison(const Builtin&, Types types) {
  if (types[0] != types[1] || (types[0] != Type::Float && !ir::isWhole(types[0]))) return std::nullopt;
  return Type::Bool;
}
ValueId less(Dag& dag, ValueId a, ValueId b) {
  return dag[a].type == Type::Float ? dag.make(Op::Less, {a, b}) : below(dag, a, b);
}
ValueId lessEqual(Dag& dag, ValueId a, ValueId b) {
  return dag[a].type == Type::Float ? dag.make(Op::LessEqual, {a, b}) : dag.make(Op::Not, {below(dag, b, a)});
}
/// Bools have no comparison of their own: a == b is a ? b : !b.
ValueId equal(Dag& dag, ValueId a, ValueId b) {
  const Type type = dag[a].type;
  if (type == Type::Bool) return dag.make(Op::Select, {a, b, dag.make(Op::Not, {b})});
  return dag.make(type == Type::Float ? Op::Equal : Op::WholeEqual, {a, b});
}
ValueId notEqual(Dag& dag, ValueId a, ValueId b) { return dag.make(Op::Not, {equal(dag, a, b)}); }
ValueId greater(Dag& dag, ValueId a, ValueId b) { return less(dag, b, a); }
ValueId greaterEqual(Dag& dag, ValueId a, ValueId b) { return lessEqual(dag, b, a); }

using Compare = ValueId (*)(Dag&, ValueId, ValueId);
template <Compare compare>
ValueId makeComparison(const Builtin&, Dag& dag, Values args) {
  return compare(dag, args[0], args[1]);
}

/// Scalars or vectors of one type.
std::optional<Type> typeOfEqual(const Builtin&, Types types) {
  if (types[0] != types[1] || ir::isTexture(types[0]) || ir::isMatrix(types[0])) return std::nullopt;
  return Type::Bool;
}
ValueId makeEqual(const Builtin&, Dag& dag, Values args) {
  ValueId all = ir::kNoValue;
  for (int i = 0; i < ir::componentCount(dag[args[0]].type); ++i) {
    const ValueId a = componentOf(dag, args[0], i);
    const ValueId one = equal(dag, a, componentOf(dag, args[1], i));
    all = i == 0 ? one : dag.make(Op::And, {all, one});
  }
  return all;
}
ValueId makeNotEqual(const Builtin& builtin, Dag& dag, Values args) {
  return dag.make(Op::Not, {makeEqual(builtin, dag, args)});
}

/// `lessThan` and its like: a Bool for each component.
std::optional<Type> typeOfEach(const Builtin&, Types types) {
  const int width = ir::componentCount(types[0]);
  if (types[0] != types[1] || width < 2 || width > 4) return std::nullopt;
  return ir::vectorType(Type::Bool, width);
}
template <Compare compare>
ValueId makeEach(const Builtin&, Dag& dag, Values args) {
  const Type result = ir::vectorType(Type::Bool, ir::componentCount(dag[args[0]].type));
  return byComponent(dag, result, args, [&](Values x) { return compare(dag, x[0], x[1]); });
}

std::optional<Type> typeOfTruths(const Builtin&, Types types) {
  return ir::partType(types[0]) == Type::Bool && types[0] != Type::Bool ? std::optional(Type::Bool)
                                                                        : std::nullopt;
}
template <Op op>
ValueId makeTruths(const Builtin&, Dag& dag, Values args) {
  ValueId all = dag.component(args[0], 0);
  for (int i = 1; i < ir::componentCount(dag[args[0]].type); ++i)
    all = dag.make(op, {all, dag.component(args[0], i)});
  return all;
}
std::optional<Type> typeOfNot(const Builtin&, Types types) {
  return ir::partType(types[0]) == Type::Bool ? std::optional(types[0]) : std::nullopt;
}
ValueId makeNot(const Builtin&, Dag& dag, Values args) {
  return byComponent(dag, dag[args[0]].type, args, [&](Values x) { return dag.make(Op::Not, x); });
}

/// Functions of floats that are there for integers, too.
ValueId makeExtremum(const Builtin& builtin, Dag& dag, Values args) {
  if (!integral(dag[args[0]].type)) return dag.make(builtin.op, args);
  return byComponent(dag, resultOf(dag, args), args, [&](Values x) {
    const ValueId smaller = below(dag, x[1], x[0]);
    const bool least = builtin.op == Op::Min;
    return dag.make(Op::Select, {smaller, x[least ? 1 : 0], x[least ? 0 : 1]});
  });
}
ValueId makeClamp(const Builtin& builtin, Dag& dag, Values args) {
  if (!integral(dag[args[0]].type)) return dag.make(builtin.op, args);
  return byComponent(dag, resultOf(dag, args), args, [&](Values x) {
    const ValueId raised = dag.make(Op::Select, {below(dag, x[0], x[1]), x[1], x[0]});
    return dag.make(Op::Select, {below(dag, x[2], raised), x[2], raised});
  });
}
std::optional<Type> typeOfSigned(const Builtin& builtin, Types types) {
  const auto type = typeOfNumbers(builtin, types);
  return type && ir::partType(*type) == Type::UInt ? std::nullopt : type;
}
ValueId makeSigned(const Builtin& builtin, Dag& dag, Values args) {
  if (!integral(dag[args[0]].type)) return dag.make(builtin.op, args);
  return byComponent(dag, dag[args[0]].type, args, [&](Values x) {
    const ValueId zero = dag.integer(0);
    const ValueId negative = dag.make(Op::IntLess, {x[0], zero});
    if (builtin.op == Op::Abs)
      return dag.make(Op::Select, {negative, dag.make(Op::WholeSub, {zero, x[0]}), x[0]});
    const ValueId positive =
        dag.make(Op::Select, {dag.make(Op::IntLess, {zero, x[0]}), dag.integer(1), zero});
    return dag.make(Op::Select, {negative, dag.integer(-1), positive});
  });
}

/// With a Bool, or one for each component, for the place between: a choice.
std::optional<Type> typeOfMix(const Builtin& builtin, Types types) {
  const Type part = ir::partType(types[2]);
  if (part != Type::Bool) return typeOfMap(builtin, types);
  const int width = ir::componentCount(types[2]);
  if (types[0] != types[1] || ir::isTexture(types[0]) || ir::isMatrix(types[0])) return std::nullopt;
  return width == 1 || width == ir::componentCount(types[0]) ? std::optional(types[0]) : std::nullopt;
}
ValueId makeMix(const Builtin& builtin, Dag& dag, Values args) {
  if (ir::partType(dag[args[2]].type) != Type::Bool) return dag.make(builtin.op, args);
  return byComponent(dag, dag[args[0]].type, args, [&](Values x) {
    return dag.make(Op::Select, {x[2], x[1], x[0]});
  });
}

std::optional<Type> typeOfMatrix(const Builtin&, Types types) {
  return ir::isMatrix(types[0]) ? std::optional(types[0]) : std::nullopt;
}
std::optional<Type> typeOfDeterminant(const Builtin&, Types types) {
  return ir::isMatrix(types[0]) ? std::optional(Type::Float) : std::nullopt;
}
ValueId makeTranspose(const Builtin&, Dag& dag, Values args) { return transposed(dag, args[0]); }
ValueId makeDeterminant(const Builtin&, Dag& dag, Values args) { return determinantOf(dag, args[0]); }
ValueId makeInverse(const Builtin&, Dag& dag, Values args) { return inverseOf(dag, args[0]); }

/// By Snell's law; the zero vector where all is reflected. A root of what is not negative, for both arms
/// count.
std::optional<Type> typeOfRefract(const Builtin&, Types types) {
  if (!ir::isFloatVector(types[0]) || types[0] != types[1] || types[2] != Type::Float) return std::nullopt;
  return types[0];
}
ValueId makeRefract(const Builtin&, Dag& dag, Values args) {
  const auto [i, n, eta] = std::tuple{args[0], args[1], args[2]};
  const ValueId cosine = dag.make(Op::Dot, {n, i});
  const ValueId one = dag.constant(1);
  const ValueId sine2 = dag.sub(one, dag.mul(cosine, cosine));
  const ValueId sin2 = dag.mul(dag.mul(eta, eta), sine2);
  const ValueId k = dag.sub(one, sin2);
  const ValueId root = dag.make(Op::Sqrt, {dag.make(Op::Max, {k, dag.constant(0)})});
  const ValueId along = dag.mul(dag.add(dag.mul(eta, cosine), root), n);
  const ValueId bent = dag.sub(dag.mul(eta, i), along);
  const ValueId nothing = dag.constant(dag[i].type, {});
  return dag.make(Op::Select, {dag.make(Op::Less, {k, dag.constant(0)}), nothing, bent});
}

ValueId makeFwidth(const Builtin&, Dag& dag, Values args) {
  const auto change = [&](Op op) { return dag.make(Op::Abs, {dag.make(op, args)}); };
  const ValueId x = change(Op::DFdx);
  return dag.add(x, change(Op::DFdy));
}
std::optional<Type> typeOfSame(const Builtin&, Types types) {
  return ir::isFloating(types[0]) ? std::optional(types[0]) : std::nullopt;
}
/// What goes from stage to stage: all but matrices and textures.
std::optional<Type> typeOfInterpolated(const Builtin&, Types types) {
  return ir::isTexture(types[0]) || ir::isMatrix(types[0]) ? std::nullopt : std::optional(types[0]);
}
ValueId makeInterpolated(const Builtin&, Dag& dag, Values args) { return interpolated(dag, args[0]); }
ValueId makeAtan(const Builtin&, Dag& dag, Values args) {
  return dag.make(Op::Atan2, {args[0], dag.constant(1)});
}

/// About the origin, or about a unit axis (Rodrigues), by an angle in radians.
std::optional<Type> typeOfRotation(const Builtin&, Types types) {
  if (types.size() == 2) {
    return types[0] == Type::Vec2 && types[1] == Type::Float ? std::optional(Type::Vec2) : std::nullopt;
  }
  const bool fits = types[0] == Type::Vec3 && types[1] == Type::Vec3 && types[2] == Type::Float;
  return fits ? std::optional(Type::Vec3) : std::nullopt;
}
ValueId makeRotation(const Builtin&, Dag& dag, Values args) {
  const ValueId angle = args.back();
  const ValueId sine = dag.make(Op::Sin, {angle});
  const ValueId cosine = dag.make(Op::Cos, {angle});
  const ValueId v = args[0];
  if (args.size() == 2) {
    const ValueId x = dag.component(v, 0);
    const ValueId y = dag.component(v, 1);
    const ValueId cosine_x = dag.mul(cosine, x);
    const ValueId turned_x = dag.sub(cosine_x, dag.mul(sine, y));
    const ValueId sine_x = dag.mul(sine, x);
    const ValueId turned_y = dag.add(sine_x, dag.mul(cosine, y));
    return dag.construct(Type::Vec2, {turned_x, turned_y});
  }
  const ValueId axis = args[1];
  const ValueId projected = dag.make(Op::Dot, {axis, v});
  const ValueId along = dag.mul(projected, dag.sub(dag.constant(1), cosine));
  const ValueId about = dag.mul(dag.make(Op::Cross, {axis, v}), sine);
  const ValueId turned = dag.add(dag.mul(v, cosine), about);
  return dag.add(turned, dag.mul(axis, along));
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

std::optional<Type> typeOfTextureSize(const Builtin&, Types types) {
  if (!ir::isTexture(types[0]) || types[1] != Type::Int) return std::nullopt;
  return ir::vectorType(Type::Int, ir::sizeCount(types[0]));
}
/// Of a level that may not be there targets say different things, which are taken into what a size can be.
ValueId makeTextureSize(const Builtin&, Dag& dag, Values args) {
  std::array<ValueId, 3> sizes{};
  const int count = ir::sizeCount(dag[args[0]].type);
  const bool first = dag.isConstant(args[1]) && dag.constantOf(args[1])[0] == 0;
  for (int c = 0; c < count; ++c) {
    ValueId& size = sizes.at(static_cast<size_t>(c));
    size = dag.make(Op::TextureSize, args, static_cast<uint32_t>(c));
    if (first) continue;
    const ValueId one = dag.integer(1);
    const ValueId most = dag.integer(ir::kLargestTexture);
    size = dag.make(Op::Select, {dag.make(Op::IntLess, {size, one}), one, size});
    size = dag.make(Op::Select, {dag.make(Op::IntLess, {most, size}), most, size});
  }
  return dag.construct(ir::vectorType(Type::Int, count), std::span(sizes).first(static_cast<size_t>(count)));
}

std::string_view shapeOf(ir::Signature signature) {
  switch (signature) {
    case ir::Signature::Map: return "floats or vectors of one size";
    case ir::Signature::Reduce2: return "two vectors of one size";
    case ir::Signature::Cross: return "two vec3";
    case ir::Signature::Length:
    case ir::Signature::Same: return "a float or a vector";
    case ir::Signature::Logic: return "bools";
    case ir::Signature::Compare:
    case ir::Signature::Whole:
    case ir::Signature::WholeTest:
    case ir::Signature::Shift:
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

constexpr std::string_view kNumbers = "floats or vectors of one size";
constexpr std::string_view kWholes = "ints or uints, or vectors of one size of them";

void addOperators(std::vector<Builtin>& table) {
  const auto arithmetic = [&](std::string_view spelling, Op op, auto type, auto make) {
    table.push_back({spelling, ir::info(op).arity, true, ir::info(op).prose, kNumbers, op, type, make});
  };
  table.push_back({"+", 1, true, "itself", kNumbers, Op::Constant, typeOfPlus, makePlus});
  arithmetic("-", Op::Neg, typeOfSum, makeArithmetic);
  arithmetic("+", Op::Add, typeOfSum, makeArithmetic);
  arithmetic("-", Op::Sub, typeOfSum, makeArithmetic);
  arithmetic("*", Op::Mul, typeOfProduct, makeProduct);
  table.back().shape = "numbers or vectors of one size, or a matrix and what it is multiplied with";
  arithmetic("/", Op::Div, typeOfSum, makeArithmetic);
  const auto whole = [&](std::string_view spelling, int arity, auto type, auto make, std::string_view prose) {
    table.push_back({spelling, arity, true, prose, kWholes, Op::Constant, type, make});
  };
  whole("%", 2, typeOfWholes, makeRemainder,
        "what a quotient towards zero leaves; of a division by 0 the dividend");
  whole("&", 2, typeOfWholes, makeBits<Op::BitAnd>, ir::info(Op::BitAnd).prose);
  whole("|", 2, typeOfWholes, makeBits<Op::BitOr>, ir::info(Op::BitOr).prose);
  whole("^", 2, typeOfWholes, makeBits<Op::BitXor>, ir::info(Op::BitXor).prose);
  whole("~", 1, typeOfWholes, makeBits<Op::BitNot>, ir::info(Op::BitNot).prose);
  whole("<<", 2, typeOfShift, makeShift<true>, "bits moved up by a count modulo 32");
  whole(">>", 2, typeOfShift, makeShift<false>,
        "bits moved down by a count modulo 32, of an int its sign before them");
  const auto comparison = [&](std::string_view spelling, auto type, auto make, std::string_view prose) {
    table.push_back({spelling, 2, true, prose, "two floats or two ints", Op::Constant, type, make});
  };
  comparison("<", typeOfComparison, makeComparison<less>, "a < b");
  comparison("<=", typeOfComparison, makeComparison<lessEqual>, "a <= b");
  comparison(">", typeOfComparison, makeComparison<greater>, "a > b");
  comparison(">=", typeOfComparison, makeComparison<greaterEqual>, "a >= b");
  comparison("==", typeOfEqual, makeEqual, "a == b");
  comparison("!=", typeOfEqual, makeNotEqual, "a != b");
  for (Builtin* last = &table.back(); last != &table.back() - 2; --last)
    last->shape = "two values of one type";
  for (const auto& [spelling, op] : {std::pair{"&&", Op::And}, {"||", Op::Or}, {"!", Op::Not}}) {
    table.push_back(ofOp(spelling, op, true));
  }
}

/// Functions that are ops, with what they do for integers beside.
void addOps(std::vector<Builtin>& table) {
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
  for (Builtin& builtin : table) {
    if (builtin.is_operator) continue;
    const auto takes = [&](auto type, auto make, std::string_view shape) {
      builtin.type = type, builtin.make = make, builtin.shape = shape;
    };
    constexpr std::string_view kEither = "floats, ints or uints, or vectors of one size";
    if (builtin.op == Op::Min || builtin.op == Op::Max) takes(typeOfNumbers, makeExtremum, kEither);
    if (builtin.op == Op::Clamp) takes(typeOfNumbers, makeClamp, kEither);
    if (builtin.op == Op::Abs || builtin.op == Op::Sign)
      takes(typeOfSigned, makeSigned, "a float or an int, or a vector of them");
    if (builtin.op == Op::Interpolate)
      takes(typeOfInterpolated, makeInterpolated, "a number, a bool or a vector");
    if (builtin.op == Op::Mix)
      takes(typeOfMix, makeMix,
            "floats or vectors of one size, or two equal types and a bool or one for each component");
  }
  table.push_back(ofOp("atan", Op::Atan2, false));
}

std::vector<Builtin> makeTable() {
  constexpr std::string_view kLookup = "a sampler2D and a vec2, or another sampler and a vec3";
  std::vector<Builtin> table;
  addOperators(table);
  addOps(table);
  for (const auto& [name, op] : {std::pair{"texture", Op::Texture}, {"textureLod", Op::TextureLod}}) {
    table.push_back(
        {name, ir::info(op).arity, false, ir::info(op).prose,
         op == Op::Texture ? kLookup : "a sampler2D and a vec2, or another sampler and a vec3; a float", op,
         typeOfLookup, makeLookup});
  }
  const ir::OpInfo& grad = ir::info(Op::TextureGrad);
  table.push_back({"textureGrad", grad.arity, false, grad.prose,
                   "a sampler2D and three vec2, a sampler2DArray, a vec3 and two vec2, or a samplerCube or a "
                   "sampler3D and three vec3",
                   Op::TextureGrad, typeOfOp, makeOp});

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
  derived("atan", 1, kNumbers, typeOfMap, makeAtan, "angle of a tangent");
  derived("textureSize", 2, "a sampler and an int", typeOfTextureSize, makeTextureSize,
          "texels of a level, of an array the layers behind them");
  derived("fwidth", 1, "a float or a vector", typeOfSame, makeFwidth, "abs(dFdx(x)) + abs(dFdy(x))");
  derived("refract", 3, "two vectors of one size and a float", typeOfRefract, makeRefract,
          "i bent at n by the ratio eta of the indices of refraction, 0 where all is reflected");
  derived("rotate", 2, "a vec2 and a float", typeOfRotation, makeRotation,
          "turned about the origin by radians");
  derived("rotate", 3, "two vec3 and a float", typeOfRotation, makeRotation,
          "turned about a unit axis by radians");
  derived("transpose", 1, "a matrix", typeOfMatrix, makeTranspose, "rows as columns");
  derived("determinant", 1, "a matrix", typeOfDeterminant, makeDeterminant, "");
  derived("inverse", 1, "a matrix", typeOfMatrix, makeInverse,
          "by cofactors; undefined where the determinant is 0");
  constexpr std::string_view kVectors = "two vectors of one type";
  derived("lessThan", 2, kVectors, typeOfEach, makeEach<less>, "a < b, for each component");
  derived("lessThanEqual", 2, kVectors, typeOfEach, makeEach<lessEqual>, "a <= b, for each component");
  derived("greaterThan", 2, kVectors, typeOfEach, makeEach<greater>, "a > b, for each component");
  derived("greaterThanEqual", 2, kVectors, typeOfEach, makeEach<greaterEqual>, "a >= b, for each component");
  derived("equal", 2, kVectors, typeOfEach, makeEach<equal>, "a == b, for each component");
  derived("notEqual", 2, kVectors, typeOfEach, makeEach<notEqual>, "a != b, for each component");
  derived("any", 1, "a vector of bools", typeOfTruths, makeTruths<Op::Or>, "whether one holds");
  derived("all", 1, "a vector of bools", typeOfTruths, makeTruths<Op::And>, "whether each holds");
  derived("not", 1, "a bool or a vector of bools", typeOfNot, makeNot, "the negation of each");
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
  static const std::unordered_map<std::string_view, const Builtin*> kFirst = [] {
    std::unordered_map<std::string_view, const Builtin*> first;
    for (const Builtin& builtin : table()) {
      if (!builtin.is_operator) first.emplace(builtin.name, &builtin);
    }
    return first;
  }();
  const auto found = kFirst.find(name);
  return found == kFirst.end() ? nullptr : found->second;
}

const Builtin* findOperator(std::string_view spelling, int arity) {
  for (const Builtin& builtin : table()) {
    if (builtin.is_operator && builtin.name == spelling && builtin.arity == arity) return &builtin;
  }
  return nullptr;
}

}  // namespace lacquer::lang
