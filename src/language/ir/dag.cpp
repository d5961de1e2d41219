#include "ir/dag.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "ir/simplify.h"
#include "ir/whole.h"

namespace lacquer::ir {

static constexpr std::array<OpInfo, kOpCount> kOps{{
#define OP(e, name, arity, signature, glsl, hlsl, set, inst, fold, prose) \
  {name, arity, Signature::signature, glsl, hlsl, SpirvSet::set, prose},
#include "ir/ops.def"
#undef OP
}};

const OpInfo& info(Op op) { return kOps[static_cast<size_t>(op)]; }

std::optional<Op> findOp(std::string_view name) {
  for (int i = 0; i < kOpCount; ++i) {
    if (kOps[static_cast<size_t>(i)].name == name) return static_cast<Op>(i);
  }
  return std::nullopt;
}

namespace {

std::optional<Type> mapType(std::span<const Type> operands) {
  Type result = Type::Float;
  for (const Type t : operands) {
    if (!isFloating(t)) return std::nullopt;
    if (t == Type::Float) continue;
    if (result != Type::Float && result != t) return std::nullopt;
    result = t;
  }
  return result;
}

std::optional<Type> specialType(Op op, std::span<const Type> operands) {
  const auto from = [&](Type type, Type result) {
    return operands[0] == type ? std::optional(result) : std::nullopt;
  };
  if (op == Op::ToInt) return from(Type::Float, Type::Int);
  if (op == Op::ToUInt) return from(Type::Float, Type::UInt);
  if (op == Op::FromInt) return from(Type::Int, Type::Float);
  if (op == Op::FromUInt) return from(Type::UInt, Type::Float);
  if (op == Op::AsInt) return from(Type::UInt, Type::Int);
  if (op == Op::AsUInt) return from(Type::Int, Type::UInt);
  if (op == Op::Loop) return operands[1] == Type::Int ? from(Type::Int, Type::Int) : std::nullopt;
  if (op == Op::Carry) {
    const bool alike = operands[1] == operands[2] && operands[2] == operands[3];
    return alike && !isTexture(operands[1]) && !isComposite(operands[1]) ? from(Type::Int, Type::Int)
                                                                         : std::nullopt;
  }
  if (op == Op::Column) return isMatrix(operands[0]) ? std::optional(partType(operands[0])) : std::nullopt;
  if (op == Op::MatMul && isMatrix(operands[0]) && operands[1] == partType(operands[0])) return operands[1];
  if (op == Op::TextureSize)
    return isTexture(operands[0]) && operands[1] == Type::Int ? std::optional(Type::Int) : std::nullopt;
  if (op == Op::TextureAt)
    return isTexture(operands[0]) && operands[1] == Type::Int ? std::optional(operands[0]) : std::nullopt;
  const bool lookup =
      operands.size() > 1 && isTexture(operands[0]) && operands[1] == coordinateType(operands[0]);
  if (!lookup) return std::nullopt;
  const bool compares = operands[0] == Type::Texture2DShadow;
  if (op == Op::TextureCompare || op == Op::TextureCompareLod)
    return compares ? std::optional(Type::Float) : std::nullopt;
  if (compares) return std::nullopt;
  if (op == Op::Texture) return Type::Vec4;
  if (op == Op::TextureLod && operands[2] == Type::Float) return Type::Vec4;
  const Type derivative = derivativeType(operands[0]);
  if (op == Op::TextureGrad && operands[2] == derivative && operands[3] == derivative) return Type::Vec4;
  return std::nullopt;
}

/// Integers of one type, which an op may ask for.
std::optional<Type> wholeType(Op op, std::span<const Type> operands) {
  const Type type = operands[0];
  const bool ints = op == Op::IntDiv || op == Op::IntLess || op == Op::IntShiftRight;
  const bool uints = op == Op::UIntDiv || op == Op::UIntLess || op == Op::UIntShiftRight;
  if (!isWhole(type) || (ints && type != Type::Int) || (uints && type != Type::UInt)) return std::nullopt;
  const bool shift = info(op).signature == Signature::Shift;
  if (operands.size() == 2 && operands[1] != (shift ? Type::UInt : type)) return std::nullopt;
  return type;
}

}  // namespace

std::optional<Type> resultType(Op op, std::span<const Type> operands) {
  const OpInfo& row = info(op);
  // A sum over listed lights has the first one's number and how many there are behind what it sums.
  if (op == Op::SumOverLights && operands.size() == 3 && operands[1] == Type::Int && operands[2] == Type::Int)
    operands = operands.first(1);
  if (static_cast<int>(operands.size()) != row.arity) return std::nullopt;
  switch (row.signature) {
    case Signature::Special: return specialType(op, operands);
    case Signature::Map: return mapType(operands);
    case Signature::Reduce2:
      if (!isFloating(operands[0]) || operands[0] != operands[1]) return std::nullopt;
      return Type::Float;
    case Signature::Cross:
      if (operands[0] != Type::Vec3 || operands[1] != Type::Vec3) return std::nullopt;
      return Type::Vec3;
    case Signature::Length:
      if (!isFloating(operands[0])) return std::nullopt;
      return Type::Float;
    case Signature::Same:
      // An integer between the stages is one vertex's.
      if (!isFloating(operands[0]) && !(op == Op::Interpolate && isWhole(operands[0]))) return std::nullopt;
      return operands[0];
    case Signature::Compare:
      if (operands[0] != Type::Float || operands[1] != Type::Float) return std::nullopt;
      return Type::Bool;
    case Signature::Logic:
      for (const Type t : operands) {
        if (t != Type::Bool) return std::nullopt;
      }
      return Type::Bool;
    case Signature::Select:
      if (operands[0] != Type::Bool || operands[1] != operands[2]) return std::nullopt;
      if (!isFloating(operands[1]) && operands[1] != Type::Bool && !isWhole(operands[1])) return std::nullopt;
      return operands[1];
    case Signature::Whole:
    case Signature::Shift: return wholeType(op, operands);
    case Signature::WholeTest: return wholeType(op, operands) ? std::optional(Type::Bool) : std::nullopt;
  }
  return std::nullopt;
}

uint32_t packSwizzle(std::span<const int> components) {
  uint32_t payload = 0;
  for (size_t i = 0; i < components.size(); ++i) payload |= static_cast<uint32_t>(components[i]) << (2 * i);
  return payload;
}

int swizzleComponent(uint32_t payload, int index) { return static_cast<int>(payload >> (2 * index) & 3U); }

/// Slots of a new DAG's tables: what most materials need without growing.
static constexpr size_t kFirstSlots = 2048;
static constexpr size_t kFirstConstantSlots = 256;
static constexpr size_t kFirstTerms = 64;

Dag::Dag() : constant_table_(kFirstConstantSlots, kNoValue), table_(kFirstSlots, kNoValue) {
  terms_.reserve(kFirstTerms);
  terms_.push_back({});
  inputs_.reserve(kFirstTerms);
  input_keys_.reserve(kFirstTerms);
  names_.reserve(kFirstSlots / 8);
  about_.reserve(kFirstSlots / 2);
  values_.reserve(kFirstSlots / 2);
}

namespace {

/// Commutative ops are looked up in either order but keep the order of their first making, which reads best.
bool commutes(Op op) {
  return op == Op::Add || op == Op::Mul || op == Op::Min || op == Op::Max || op == Op::Dot ||
         op == Op::Equal || op == Op::And || op == Op::Or || op == Op::WholeAdd || op == Op::WholeMul ||
         op == Op::BitAnd || op == Op::BitOr || op == Op::BitXor || op == Op::WholeEqual;
}

bool sameContent(const Value& a, const Value& b) {
  if (a.op != b.op || a.type != b.type || a.count != b.count || a.payload != b.payload) return false;
  if (a.args == b.args) return true;
  return commutes(a.op) && a.args[0] == b.args[1] && a.args[1] == b.args[0];
}

size_t hashOf(const Value& value) {
  Value key = value;
  key.rate = Rate::Constant;
  if (commutes(key.op) && key.args[0] > key.args[1]) std::swap(key.args[0], key.args[1]);
  static_assert(sizeof(Value) == 24, "no padding: the bytes are hashed");
  const auto words = std::bit_cast<std::array<uint64_t, 3>>(key);
  // Odd multipliers with bits all over (those of xxHash): enough for a table that is compared anyway.
  uint64_t hash = words[0] * 0x9E3779B185EBCA87U;
  hash = (std::rotl(hash, 31) ^ words[1]) * 0xC2B2AE3D27D4EB4FU;
  hash = (std::rotl(hash, 31) ^ words[2]) * 0x165667B19E3779F9U;
  return hash ^ hash >> 32;
}

}  // namespace

void Dag::rehash(size_t slots) {
  table_.assign(slots, kNoValue);
  for (ValueId id = 0; id < values_.size(); ++id) {
    size_t slot = hashOf(values_[id]) & (slots - 1);
    while (table_[slot] != kNoValue) slot = (slot + 1) & (slots - 1);
    table_[slot] = id;
  }
}

ValueId Dag::intern(const Value& value) {
  if (values_.size() * 2 >= table_.size()) {
    rehash(std::max(table_.size() * 2, std::bit_ceil(values_.size() * 2 + kFirstSlots / 2)));
  }
  size_t slot = hashOf(value) & (table_.size() - 1);
  while (table_[slot] != kNoValue) {
    if (sameContent(values_[table_[slot]], value)) return table_[slot];
    slot = (slot + 1) & (table_.size() - 1);
  }
  const auto id = static_cast<ValueId>(values_.size());
  table_[slot] = id;
  values_.push_back(value);
  about_.push_back({current_term_, 0, 0, current_rank_ == kOwnRank ? id : current_rank_});
  return id;
}

namespace {

Rate rateOf(const Dag& dag, Op op, std::span<const ValueId> operands) {
  Rate rate = Rate::Constant;
  for (const ValueId id : operands) rate = std::max(rate, dag[id].rate);
  if (op == Op::Interpolate || op == Op::SumOverLights) return Rate::Fragment;
  if (op == Op::DFdx || op == Op::DFdy) return std::max(rate, Rate::Fragment);
  if (op == Op::Element) return std::max(rate, Rate::Frame);
  return rate;
}

}  // namespace

ValueId Dag::makeRaw(Op op, Type type, std::span<const ValueId> operands, uint32_t payload) {
  Value value{op, type, rateOf(*this, op, operands), static_cast<uint8_t>(operands.size()), payload, {}};
  std::copy(operands.begin(), operands.end(), value.args.begin());
  return intern(value);
}

void Dag::substitute(ValueId id, std::span<const ValueId> operands) {
  Value& value = values_[id];
  std::copy(operands.begin(), operands.end(), value.args.begin());
  value.rate = rateOf(*this, value.op, operands);
}

ValueId Dag::make(Op op, std::span<const ValueId> operands, uint32_t payload) {
  assert(op != Op::Construct && op != Op::Swizzle && op != Op::Column && op != Op::Carried &&
         op != Op::Constant && op != Op::Input);
  std::array<Type, 4> types{};
  for (size_t i = 0; i < operands.size(); ++i) types[i] = values_[operands[i]].type;
  const std::optional<Type> type = resultType(op, {types.data(), operands.size()});
  assert(type);
  if (const ValueId simpler = Simplifier(*this).simplify(op, *type, operands, payload); simpler != kNoValue) {
    return simpler;
  }
  return makeRaw(op, *type, operands, payload);
}

ValueId Dag::construct(Type type, std::span<const ValueId> parts) {
  if (isMatrix(type)) return makeRaw(Op::Construct, type, parts, 0);
  if (const ValueId simpler = Simplifier(*this).construct(type, parts); simpler != kNoValue) return simpler;
  return makeRaw(Op::Construct, type, parts, 0);
}

ValueId Dag::swizzle(ValueId value, std::span<const int> components) {
  if (const ValueId simpler = Simplifier(*this).swizzle(value, components); simpler != kNoValue) {
    // Taken from what the value is made of, its components are still those of which something is known.
    if (const std::optional<Interval> known = assumed(value); known && !isConstant(simpler))
      assume(simpler, *known);
    return simpler;
  }
  const Type type = vectorType(partType(values_[value].type), static_cast<int>(components.size()));
  if (isComposite(type)) {
    std::vector<ValueId> parts;
    for (const int index : components) parts.push_back(component(value, index));
    return construct(type, parts);
  }
  return makeRaw(Op::Swizzle, type, {{value}}, packSwizzle(components));
}

ValueId Dag::component(ValueId value, int index) { return swizzle(value, {{index}}); }

ValueId Dag::column(ValueId matrix, uint32_t index) {
  const Value& value = values_[matrix];
  assert(isMatrix(value.type));
  if (value.op == Op::Construct) return value.args[index];
  return makeRaw(Op::Column, partType(value.type), {{matrix}}, index);
}

ValueId Dag::select(ValueId condition, ValueId yes, ValueId no) {
  const Type type = values_[yes].type;
  if (!isComposite(type)) return make(Op::Select, {condition, yes, no});
  if (isConstant(condition)) return constantOf(condition)[0] != 0 ? yes : no;
  std::array<ValueId, 4> parts{};
  const auto count = static_cast<size_t>(componentCount(type) / componentCount(partType(type)));
  const auto part = [&](ValueId id, size_t k) {
    return isMatrix(type) ? column(id, static_cast<uint32_t>(k)) : component(id, static_cast<int>(k));
  };
  for (size_t k = 0; k < count; ++k) {
    const ValueId a = part(yes, k);
    const ValueId b = part(no, k);
    parts[k] = make(Op::Select, {condition, a, b});
  }
  return construct(type, {parts.data(), count});
}

ValueId Dag::uinteger(uint32_t i) { return constant(Type::UInt, {whole<double>(i)}); }

ValueId Dag::element(ValueId number, Type type, const ListField& field, ValueId index) {
  assert(values_[number].type == Type::Int);
  const std::array<ValueId, 2> operands = {number, index};
  return makeRaw(Op::Element, type, {operands.data(), index == kNoValue ? 1U : 2U}, field.payload());
}

ValueId Dag::carried(ValueId loop, uint32_t number) {
  ValueId link = loop;
  while (values_[link].op == Op::Carry && inputOf(values_[link].args[3]).index != number)
    link = values_[link].args[0];
  assert(values_[link].op == Op::Carry);
  const Value carry = values_[link];
  if (carry.args[2] == carry.args[3]) return carry.args[1];  // it stays what it was
  while (values_[link].op == Op::Carry) link = values_[link].args[0];
  const ValueId end = values_[link].args[0];
  const bool runs = !isConstant(end) || constantOf(end)[0] > inputOf(values_[link].args[1]).range.lo;
  return runs ? makeRaw(Op::Carried, values_[carry.args[3]].type, {{loop}}, number) : carry.args[1];
}

ValueId Dag::remake(ValueId id, std::span<const ValueId> operands) {
  const Value& now = values_[id];
  bool same = true;
  for (size_t k = 0; k < operands.size(); ++k) same &= operands[k] == now.args[k];
  if (same) return id;
  const Value value = now;
  if (value.op == Op::Construct) return construct(value.type, operands);
  if (value.op == Op::Element) return makeRaw(value.op, value.type, operands, value.payload);
  if (value.op == Op::Column) return column(operands[0], value.payload);
  if (value.op == Op::Carried) return carried(operands[0], value.payload);
  if (value.op != Op::Swizzle) return make(value.op, operands, value.payload);
  std::array<int, 4> picks{};
  const int n = componentCount(value.type);
  for (int i = 0; i < n; ++i) picks[static_cast<size_t>(i)] = swizzleComponent(value.payload, i);
  return swizzle(operands[0], {picks.data(), static_cast<size_t>(n)});
}

ValueId Dag::constant(double x) { return constant(Type::Float, {x}); }

ValueId Dag::constant(Type type, const Components& components) {
  Components key{};
  // +0 and -0 are one constant: no rule here tells them apart and the text would. A UInt may be given as the
  // number that it is.
  const bool unsigned_number = partType(type) == Type::UInt;
  for (int i = 0; i < componentCount(type); ++i) {
    const auto k = static_cast<size_t>(i);
    key[k] = components[k] == 0 ? 0 : components[k];
    if (unsigned_number && key[k] >= 0x1p31) key[k] -= 0x1p32;
  }
  return intern({Op::Constant, type, Rate::Constant, 0, constantIndex(key), {}});
}

uint32_t Dag::constantIndex(const Components& key) {
  const auto slotOf = [this](const Components& c) {
    size_t slot = XXH3_64bits(c.data(), sizeof c) & (constant_table_.size() - 1);
    while (constant_table_[slot] != kNoValue &&
           std::memcmp(&constants_[constant_table_[slot]], &c, sizeof c) != 0) {
      slot = (slot + 1) & (constant_table_.size() - 1);
    }
    return slot;
  };
  if (constants_.size() * 2 >= constant_table_.size()) {
    constant_table_.assign(constant_table_.size() * 2, kNoValue);
    for (uint32_t i = 0; i < constants_.size(); ++i) constant_table_[slotOf(constants_[i])] = i;
  }
  uint32_t& index = constant_table_[slotOf(key)];
  if (index == kNoValue) {
    index = static_cast<uint32_t>(constants_.size());
    constants_.push_back(key);
  }
  return index;
}

/// Of equal inputs the same number; most of others differ in it. Names differ at their ends, if anywhere.
static uint64_t keyOf(const Input& input) {
  uint64_t end = input.name.size();
  const size_t length = std::min(input.name.size(), sizeof(end));
  std::memcpy(&end, input.name.data() + (input.name.size() - length), length);
  uint64_t key = static_cast<uint64_t>(input.kind) + end;
  for (const uint32_t part : {input.field, input.block, input.index}) key = key * 0x9E3779B97F4A7C15U + part;
  return key;
}

void Dag::setInputField(ValueId id, uint32_t field) {
  Input& input = inputs_[values_[id].payload];
  input.field = field;
  input_keys_[values_[id].payload] = keyOf(input);
}

void Dag::setInputType(ValueId id, Type type) {
  inputs_[values_[id].payload].type = type;
  values_[id].type = type;
}

ValueId Dag::input(Input input) {
  const uint64_t key = keyOf(input);
  for (uint32_t i = 0; i < inputs_.size(); ++i) {
    if (input_keys_[i] != key) continue;
    const Input& other = inputs_[i];
    if (other.kind == input.kind && other.field == input.field && other.block == input.block &&
        other.element == input.element && other.group == input.group && other.index == input.index &&
        other.name == input.name) {
      return intern({Op::Input, other.type, other.rate, 0, i, {}});
    }
  }
  inputs_.push_back(std::move(input));
  input_keys_.push_back(key);
  const Input& made = inputs_.back();
  return intern({Op::Input, made.type, made.rate, 0, static_cast<uint32_t>(inputs_.size() - 1), {}});
}

bool Dag::isConstant(ValueId id, double x) const {
  if (!isConstant(id)) return false;
  const Components& c = constantOf(id);
  for (int i = 0; i < componentCount(values_[id].type); ++i) {
    if (c[static_cast<size_t>(i)] != x) return false;
  }
  return true;
}

TermId Dag::addTerm(std::string_view name, std::string_view source, std::string_view file, uint32_t line) {
  terms_.push_back({std::string(name), std::string(source), std::string(file), line});
  return static_cast<TermId>(terms_.size() - 1);
}

void Dag::name(ValueId id, std::string_view name) {
  const Op op = values_[id].op;
  if (op == Op::Constant || op == Op::Input || about_[id].name != 0 || name.empty()) return;
  names_.emplace_back(name);
  about_[id].name = static_cast<uint32_t>(names_.size());
}

std::string_view Dag::nameOf(ValueId id) const {
  return about_[id].name == 0 ? std::string_view{} : std::string_view(names_[about_[id].name - 1]);
}

void Dag::inherit(ValueId id, ValueId from) {
  const Op op = values_[id].op;
  if (about_[id].name == 0 && op != Op::Constant && op != Op::Input) about_[id].name = about_[from].name;
  if (about_[from].fact != 0) assume(id, Interval(facts_[about_[from].fact - 1]));
}

void Dag::relax(ValueId id) {
  if (relaxed_.size() < values_.size()) relaxed_.resize(values_.size(), false);
  relaxed_[id] = true;
}

void Dag::assume(ValueId id, Interval range) {
  // What is said of a splat holds for its Float, which operations on splats are made of.
  const Value& value = values_[id];
  if (value.op == Op::Construct && value.count == 1 && !isConstant(value.args[0]))
    assume(value.args[0], range);
  if (about_[id].fact == 0) {
    facts_.push_back(range);
    about_[id].fact = static_cast<uint32_t>(facts_.size());
    return;
  }
  Interval& fact = facts_[about_[id].fact - 1];
  fact.lo = std::max(fact.lo, range.lo);
  fact.hi = std::min(fact.hi, range.hi);
}

std::optional<Interval> Dag::assumed(ValueId id) const {
  if (about_[id].fact == 0) return std::nullopt;
  return facts_[about_[id].fact - 1];
}

/// Ascending ids by rank; of equal rank they keep their order.
std::vector<ValueId> Dag::byRank(std::span<const ValueId> ids) const {
  std::vector<uint32_t> place(values_.size() + 1, 0);
  for (const ValueId id : ids) ++place[about_[id].rank + 1];
  for (size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<ValueId> sorted(ids.size());
  for (const ValueId id : ids) sorted[place[about_[id].rank]++] = id;
  return sorted;
}

std::vector<ValueId> Dag::live(std::span<const ValueId> roots) const {
  std::vector<uint8_t> seen(values_.size(), 0);
  std::vector<ValueId> open, result;
  const auto see = [&](ValueId id) {
    if (seen[id] == 0) open.push_back(id);
    seen[id] = 1;
  };
  size_t count = 0;
  for (const ValueId root : roots) see(root);
  for (; !open.empty(); ++count) {
    const Value& value = values_[open.back()];
    open.pop_back();
    for (size_t k = 0; k < value.count; ++k) see(value.args[k]);
  }
  result.reserve(count);
  for (ValueId id = 0; id < values_.size(); ++id) {
    if (seen[id] != 0) result.push_back(id);
  }
  return result;
}

std::vector<ValueId> Dag::compact(std::span<const ValueId> roots) {
  std::vector<ValueId> moved(values_.size(), kNoValue);
  std::vector<ValueId> order, pending;
  const std::vector<ValueId> live = byRank(this->live(roots));
  order.reserve(live.size());
  const auto place = [&](ValueId id) {
    moved[id] = static_cast<ValueId>(order.size());
    order.push_back(id);
  };
  // Puts an operand that has no place yet on the stack: false when all have one.
  const auto waits = [&](ValueId id) {
    const size_t before = pending.size();
    for (size_t k = values_[id].count; k-- > 0;) {
      if (moved[values_[id].args[k]] == kNoValue) pending.push_back(values_[id].args[k]);
    }
    return pending.size() != before;
  };
  for (const ValueId start : live) {
    if (moved[start] != kNoValue) continue;
    if (!waits(start)) {
      place(start);
      continue;
    }
    pending.insert(pending.begin(), start);
    while (!pending.empty()) {
      const ValueId id = pending.back();
      if (moved[id] == kNoValue && waits(id)) continue;
      pending.pop_back();
      if (moved[id] == kNoValue) place(id);
    }
  }
  const auto take = [&order](auto& from) {
    std::remove_reference_t<decltype(from)> to(order.size());
    for (size_t i = 0; i < order.size(); ++i) to[i] = from[order[i]];
    from = std::move(to);
  };
  if (anyRelaxed()) relaxed_.resize(moved.size(), false), take(relaxed_);
  take(values_), take(about_);
  for (Value& value : values_) {
    for (size_t k = 0; k < value.count; ++k) value.args[k] = moved[value.args[k]];
  }
  for (ValueId id = 0; id < order.size(); ++id) about_[id].rank = id;
  table_.clear();
  return moved;
}

std::vector<ValueId> reachable(const Dag& dag, std::span<const ValueId> roots) {
  ValueId last = 0;
  for (const ValueId root : roots) last = std::max(last, root + 1);
  std::vector<uint8_t> seen(last, 0);
  for (const ValueId root : roots) seen[root] = 1;
  // Operands have smaller ids, so one descending sweep finds everything: what has been found above fills the
  // end.
  std::vector<ValueId> result(last);
  ValueId first = last;
  for (ValueId i = last; i-- > 0;) {
    if (seen[i] == 0) continue;
    result[--first] = i;
    const Value& value = dag[i];
    switch (value.count) {
      case 4: seen[value.args[3]] = 1; [[fallthrough]];
      case 3: seen[value.args[2]] = 1; [[fallthrough]];
      case 2: seen[value.args[1]] = 1; [[fallthrough]];
      case 1: seen[value.args[0]] = 1; break;
      default: break;
    }
  }
  result.erase(result.begin(), result.begin() + first);
  return result;
}

}  // namespace lacquer::ir
