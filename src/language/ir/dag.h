// The DAG: pure, hash-consed, typed, with rates. Values are made through Dag::make alone, which folds
// constants, applies the algebraic rules (simplify.cpp) and returns the existing value if there is one. A
// value's id is larger than its operands', so ascending ids are an evaluation order.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/types.h"

namespace lacquer::ir {

enum class Op : uint8_t {
#define OP(e, ...) e,
#include "ir/ops.def"
#undef OP
};

enum class Signature : uint8_t {
  Special,
  Map,
  Reduce2,
  Cross,
  Length,
  Same,
  Compare,
  Logic,
  Select,
  Whole,
  WholeTest,
  Shift,
};

/// Whether an op of that signature is one of integers.
constexpr bool ofWholes(Signature signature) {
  return signature == Signature::Whole || signature == Signature::WholeTest || signature == Signature::Shift;
}
enum class SpirvSet : uint8_t { None, Core, Ext };

/// One row of ops.def without its fold.
struct OpInfo {
  std::string_view name;
  int arity;  ///< Construct: the maximum
  Signature signature;
  std::string_view glsl, hlsl;
  SpirvSet spirv_set;
  std::string_view prose;
};

constexpr int kOpCount = 0
#define OP(...) +1
#include "ir/ops.def"
#undef OP
    ;

const OpInfo& info(Op op);

/// Whether the value depends on its neighbours on the screen.
constexpr bool takesDerivatives(Op op) {
  return op == Op::Texture || op == Op::TextureCompare || op == Op::DFdx || op == Op::DFdy;
}
/// Whether languages may leave an operand behind the first uncomputed: `a && b`, `a || b`, `a ? b : c`.
constexpr bool leavesOut(Op op) { return op == Op::And || op == Op::Or || op == Op::Select; }
/// Whether it is a lookup of a texture, its first operand.
constexpr bool readsTexture(Op op) {
  return op == Op::Texture || op == Op::TextureLod || op == Op::TextureGrad || op == Op::TextureCompare ||
         op == Op::TextureCompareLod;
}

/// The op of that name in the node language or a dump.
std::optional<Op> findOp(std::string_view name);

/// The result type, or nothing when the operand types do not fit. Not for Constant, Input, Construct and
/// Swizzle.
std::optional<Type> resultType(Op op, std::span<const Type> operands);

using ValueId = uint32_t;
inline constexpr ValueId kNoValue = ~ValueId{0};

enum class InputKind : uint8_t {
  Parameter,     ///< of the material, editable: rate Material (the preshader reads it)
  BlockField,    ///< a member of a uniform block (Module::blocks): rate Frame, Light for an array of lights,
                 ///< Material for the material block that the place pass makes, Vertex for the object block
  Attribute,     ///< of the vertex: rate Vertex
  Texture,       ///< a texture with its sampler: rate Frame
  FrontFacing,   ///< Bool, rate Fragment
  LightIndex,    ///< Int, rate Light
  Varying,       ///< what the place pass puts in for Interpolate: rate Fragment
  SpecConstant,  ///< a parameter whose value the pipeline gets (Module::spec_constants), put in by the place
                 ///< pass: rate Frame
  LoopIndex,  ///< the round of a loop, an Int; its range is that of the rounds that there may be (ir/loops.h)
  LoopValue,  ///< what a loop has carried into a round
};

/// Whether an input is one of a loop's.
constexpr bool ofLoop(InputKind kind) { return kind == InputKind::LoopIndex || kind == InputKind::LoopValue; }
/// Whether an op makes a loop, which is a value like others but one that no variable holds.
constexpr bool makesLoop(Op op) { return op == Op::Loop || op == Op::Carry; }

/// What an Input value stands for. Two inputs are one value when kind, name, block and field are equal.
struct Input {
  InputKind kind;
  std::string name;  ///< unique within its kind, e.g. "coat_roughness", "TEXCOORD_0", "light.position"
  Type type;
  Rate rate;
  Interval range;        ///< every component
  uint32_t block = 0;    ///< BlockField: index into Module::blocks
  uint32_t field = 0;    ///< BlockField: index into the block's fields; Parameter, SpecConstant, Texture,
                         ///< Attribute, Varying: index into the module's table of that kind;
                         ///< LoopIndex, LoopValue: the loop's number
  int32_t element = -1;  ///< light array: a fixed element, or -1 for the loop's index
  int32_t group = 0;     ///< light array: which SumOverLights (its payload) it belongs to
  uint32_t index =
      0;  ///< BlockField that is an array: which element of it; LoopValue: its number in the loop
};

struct Value {
  Op op;
  Type type;
  Rate rate;
  uint8_t count;     ///< number of operands
  uint32_t payload;  ///< Constant: into constants; Input: into inputs; Swizzle: two bits a component, first
                     ///< lowest; SumOverLights: the light group; Element: ListField::payload(); Column,
                     ///< Carried: its number; TextureSize: the axis
  std::array<ValueId, 4> args;
  std::span<const ValueId> operands() const { return {args.data(), count}; }
};

/// An Int and a UInt are the number of the Int with their 32 bits (ir/whole.h), a Bool is 0 or 1.
using Components = std::array<double, 4>;

/// A field of a list's elements: which one Op::Element reads.
struct ListField {
  uint32_t block = 0, field = 0;  ///< into Module::blocks, and into the block's fields

  uint32_t payload() const { return block << 16 | field; }
  static ListField of(const Value& element) { return {element.payload >> 16, element.payload & 0xffff}; }
};

using TermId = uint32_t;

/// A term of the specification: one node of the graph. Printed as a section of the generated code.
struct Term {
  std::string name;    ///< the graph node's id, "coat.absorption"
  std::string source;  ///< the node's source line, `KHR_materials_coat, "Colored Absorption"`
  std::string file{};  ///< where the node is written; empty when it is not known
  uint32_t line = 0;
};

class Dag {
public:
  Dag();

  size_t size() const { return values_.size(); }
  const Value& operator[](ValueId id) const { return values_[id]; }

  /// The one constructor of values. Operand types must fit (asserted).
  ValueId make(Op op, std::span<const ValueId> operands, uint32_t payload = 0);
  ValueId make(Op op, std::initializer_list<ValueId> operands, uint32_t payload = 0) {
    return make(op, std::span<const ValueId>(operands.begin(), operands.size()), payload);
  }

  /// A vector from scalars and vectors whose components add up, or a splat of one Float.
  ValueId construct(Type type, std::span<const ValueId> parts);
  ValueId construct(Type type, std::initializer_list<ValueId> parts) {
    return construct(type, std::span<const ValueId>(parts.begin(), parts.size()));
  }
  /// `components` names positions 0 to 3, one to four of them.
  ValueId swizzle(ValueId value, std::span<const int> components);
  ValueId component(ValueId value, int index);
  /// A column of a matrix.
  ValueId column(ValueId matrix, uint32_t index);
  /// `yes` where the Bool holds, else `no`: two values of one type, of any but textures.
  ValueId select(ValueId condition, ValueId yes, ValueId no);
  /// What a list's element of that number, an Int, has in a field of that type.
  /// `index`: of a field that is an array, a constant.
  ValueId element(ValueId number, Type type, const ListField& field, ValueId index = kNoValue);

  /// The number of another loop, for its inputs.
  uint32_t openLoop() { return loops_++; }
  /// Whether a loop was ever opened.
  bool hasLoops() const { return loops_ != 0; }
  /// What the loop has made of the LoopValue of that number.
  ValueId carried(ValueId loop, uint32_t number);

  /// A value like `id` on other operands: `id` itself when they are its own.
  ValueId remake(ValueId id, std::span<const ValueId> operands);

  ValueId constant(double x);
  ValueId constant(Type type, const Components& components);
  ValueId boolean(bool b) { return constant(Type::Bool, {b ? 1.0 : 0.0}); }
  ValueId integer(int32_t i) { return constant(Type::Int, {static_cast<double>(i)}); }
  ValueId uinteger(uint32_t i);
  ValueId input(Input input);

  bool isConstant(ValueId id) const { return values_[id].op == Op::Constant; }
  const Components& constantOf(ValueId id) const { return constants_[values_[id].payload]; }
  /// True when every component of a constant equals x.
  bool isConstant(ValueId id, double x) const;
  const Input& inputOf(ValueId id) const { return inputs_[values_[id].payload]; }

  // Sugar for C++ callers; each is make().
  ValueId add(ValueId a, ValueId b) { return make(Op::Add, {a, b}); }
  ValueId sub(ValueId a, ValueId b) { return make(Op::Sub, {a, b}); }
  ValueId mul(ValueId a, ValueId b) { return make(Op::Mul, {a, b}); }
  ValueId div(ValueId a, ValueId b) { return make(Op::Div, {a, b}); }

  // Provenance. It never takes part in identity: a value keeps the term and the name of its first making.
  TermId addTerm(std::string_view name, std::string_view source, std::string_view file = {},
                 uint32_t line = 0);
  void setTerm(TermId term) { current_term_ = term; }
  TermId currentTerm() const { return current_term_; }
  const std::vector<Term>& terms() const { return terms_; }
  TermId termOf(ValueId id) const { return about_[id].term; }
  /// Names a value if it has no name yet. Constants and inputs are never named.
  void name(ValueId id, std::string_view name);
  std::string_view nameOf(ValueId id) const;
  /// Gives a value the name and the facts of another.
  void inherit(ValueId id, ValueId from);

  /// States a fact that the operations cannot show (a node's declared range, an `assume`): every component
  /// lies in the range. Facts about one value are intersected.
  void assume(ValueId id, Interval range);
  std::optional<Interval> assumed(ValueId id) const;

  /// States that an operation may be done at half precision: its operands may be rounded to it, and so may
  /// its result. A swizzle, a constructor, a sign: all that they move is at half precision. It never takes
  /// part in identity.
  void relax(ValueId id);
  bool relaxed(ValueId id) const { return id < relaxed_.size() && relaxed_[id]; }
  bool anyRelaxed() const { return !relaxed_.empty(); }
  void relaxNothing() { relaxed_.clear(); }

  // Order. A rewrite appends values, yet what replaces an early value belongs where that stood: values have a
  // rank, which is their id unless setRank() gave another. It never takes part in identity.
  static constexpr uint32_t kOwnRank = ~uint32_t{0};
  void setRank(uint32_t rank) { current_rank_ = rank; }
  uint32_t rankOf(ValueId id) const { return about_[id].rank; }
  /// Ascending ids in the order of their ranks.
  std::vector<ValueId> byRank(std::span<const ValueId> ids) const;
  /// Drops what `roots` do not reach and numbers the rest by rank, operands first. Returns the new id of
  /// every old one (kNoValue: dropped).
  std::vector<ValueId> compact(std::span<const ValueId> roots);

  // What may change in a value that is there, since neither is seen by the algebra.
  /// Exchanges the operands of an operation that commutes.
  void exchangeOperands(ValueId id) { std::swap(values_[id].args[0], values_[id].args[1]); }
  /// Puts other operands of the same types into a value. No rule looks at it again, and it is not found to be
  /// equal to another one. The operands may have larger ids; only compact() may follow such values then.
  void substitute(ValueId id, std::span<const ValueId> operands);
  /// Renumbers an input: its index in the module's table of that kind.
  void setInputField(ValueId id, uint32_t field);
  /// Makes a texture of an input another type of texture. Who reads it must be made anew.
  void setInputType(ValueId id, Type type);

private:
  friend class Simplifier;
  ValueId intern(const Value& value);
  void rehash(size_t slots);
  /// reachable() for operands in any order.
  std::vector<ValueId> live(std::span<const ValueId> roots) const;
  uint32_t constantIndex(const Components& key);
  ValueId makeRaw(Op op, Type type, std::span<const ValueId> operands, uint32_t payload);

  std::vector<Value> values_;
  std::vector<Components> constants_;
  std::vector<Input> inputs_;
  std::vector<uint64_t> input_keys_;  ///< of their numbers: they are told apart by these before their names
  /// A value's provenance, name, facts and rank.
  struct About {
    TermId term;
    uint32_t name;  ///< 1 + index into names_, 0 for none
    uint32_t fact;  ///< 1 + index into facts_, 0 for none
    uint32_t rank;
  };
  std::vector<About> about_;
  std::vector<Term> terms_;
  std::vector<std::string> names_;
  std::vector<uint32_t> constant_table_;  ///< open addressing over constants_; a power of two
  std::vector<Interval> facts_;
  std::vector<bool> relaxed_;   ///< empty where no value is
  std::vector<ValueId> table_;  ///< open addressing over values_, by content; a power of two; empty after
                                ///< compact() until a value is made
  uint32_t loops_ = 0;          ///< numbers that are given
  TermId current_term_ = 0;
  uint32_t current_rank_ = kOwnRank;
};

/// Swizzle payloads.
uint32_t packSwizzle(std::span<const int> components);
int swizzleComponent(uint32_t payload, int index);

/// The values reachable from `roots`, ascending.
std::vector<ValueId> reachable(const Dag& dag, std::span<const ValueId> roots);

}  // namespace lacquer::ir
