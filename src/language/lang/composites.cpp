#include "lang/composites.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace lacquer::lang {

using ir::Dag;
using ir::Op;
using ir::Type;

ValueId componentOf(Dag& dag, ValueId id, int index) {
  return ir::componentCount(dag[id].type) == 1 ? id : dag.component(id, index);
}

int columnCount(Type type) { return type == Type::Mat3 ? 3 : 4; }

ValueId byComponent(Dag& dag, Type result, Values args, const OnScalars& f) {
  const int width = ir::componentCount(result);
  std::array<ValueId, 4> parts{};
  for (int i = 0; i < width; ++i) {
    std::array<ValueId, 4> scalars{};
    for (size_t k = 0; k < args.size(); ++k) scalars[k] = componentOf(dag, args[k], i);
    parts[static_cast<size_t>(i)] = f({scalars.data(), args.size()});
  }
  return width == 1 ? parts[0] : dag.construct(result, {parts.data(), static_cast<size_t>(width)});
}

ValueId byColumn(Dag& dag, Type result, Values args, const OnScalars& f) {
  std::array<ValueId, 4> columns{};
  const auto count = static_cast<size_t>(columnCount(result));
  for (size_t c = 0; c < count; ++c) {
    std::array<ValueId, 4> parts{};
    for (size_t k = 0; k < args.size(); ++k)
      parts[k] = ir::isMatrix(dag[args[k]].type) ? dag.column(args[k], static_cast<uint32_t>(c)) : args[k];
    columns[c] = f({parts.data(), args.size()});
  }
  return dag.construct(result, {columns.data(), count});
}

ValueId converted(Dag& dag, ValueId scalar, Type type) {
  const Type from = dag[scalar].type;
  if (from == type) return scalar;
  if (from == Type::Bool) {
    const auto number = [&](double x) { return dag.constant(type, {x}); };
    return dag.make(Op::Select, {scalar, number(1), number(0)});
  }
  if (type == Type::Bool) {
    const Op equal = from == Type::Float ? Op::Equal : Op::WholeEqual;
    return dag.make(Op::Not, {dag.make(equal, {scalar, dag.constant(from, {0})})});
  }
  if (type == Type::Float) return dag.make(from == Type::Int ? Op::FromInt : Op::FromUInt, {scalar});
  if (from == Type::Float) return dag.make(type == Type::Int ? Op::ToInt : Op::ToUInt, {scalar});
  return dag.make(type == Type::Int ? Op::AsInt : Op::AsUInt, {scalar});
}

ValueId interpolated(Dag& dag, ValueId value) {
  const Type type = dag[value].type;
  if (ir::isFloating(type)) return dag.make(Op::Interpolate, {value});
  return byComponent(dag, type, {&value, 1}, [&](Values parts) {
    const Type part = dag[parts[0]].type;
    const ValueId whole = part == Type::Bool ? converted(dag, parts[0], Type::Int) : parts[0];
    return converted(dag, dag.make(Op::Interpolate, {whole}), part);
  });
}

bool constructible(Type type, std::span<const Type> args) {
  if (args.empty() || ir::isTexture(type)) return false;
  for (const Type arg : args) {
    if (ir::isTexture(arg) || (ir::isMatrix(arg) && args.size() > 1)) return false;
  }
  int have = 0;
  for (const Type arg : args) have += ir::componentCount(arg);
  if (ir::isMatrix(type)) {
    if (args.size() == 1) return ir::isMatrix(args[0]) || ir::componentCount(args[0]) == 1;
    return have == ir::componentCount(type);
  }
  if (ir::isMatrix(args[0])) return false;
  return have == ir::componentCount(type) || (args.size() == 1 && have == 1);
}

namespace {

/// A part of the identity.
ValueId identityColumn(Dag& dag, Type column, size_t index, ValueId diagonal) {
  std::array<ValueId, 4> parts{};
  const auto width = static_cast<size_t>(ir::componentCount(column));
  for (size_t i = 0; i < width; ++i) parts[i] = i == index ? diagonal : dag.constant(0);
  return dag.construct(column, {parts.data(), width});
}

ValueId constructedMatrix(Dag& dag, Type type, Values args) {
  const Type column = ir::partType(type);
  const auto count = static_cast<size_t>(columnCount(type));
  std::array<ValueId, 4> columns{};
  if (args.size() == 1 && ir::isMatrix(dag[args[0]].type)) {
    // The upper left part, or what it is with the identity about it.
    const auto given = static_cast<size_t>(columnCount(dag[args[0]].type));
    const ValueId one = dag.constant(1);
    for (size_t c = 0; c < count; ++c) {
      if (c >= given) {
        columns[c] = identityColumn(dag, column, c, one);
        continue;
      }
      const ValueId from = dag.column(args[0], static_cast<uint32_t>(c));
      if (given > count) columns[c] = dag.swizzle(from, std::array{0, 1, 2});
      if (given == count) columns[c] = from;
      if (given < count) columns[c] = dag.construct(column, {from, dag.constant(0)});
    }
    return dag.construct(type, {columns.data(), count});
  }
  if (args.size() == 1) {
    const ValueId diagonal = converted(dag, args[0], Type::Float);
    for (size_t c = 0; c < count; ++c) columns[c] = identityColumn(dag, column, c, diagonal);
    return dag.construct(type, {columns.data(), count});
  }
  std::vector<ValueId> scalars;
  for (const ValueId arg : args) {
    for (int i = 0; i < ir::componentCount(dag[arg].type); ++i)
      scalars.push_back(converted(dag, componentOf(dag, arg, i), Type::Float));
  }
  for (size_t c = 0; c < count; ++c)
    columns[c] = dag.construct(column, Values(scalars).subspan(c * count, count));
  return dag.construct(type, {columns.data(), count});
}

}  // namespace

ValueId constructed(Dag& dag, Type type, Values args) {
  if (args.size() == 1 && dag[args[0]].type == type) return args[0];
  if (ir::isMatrix(type)) return constructedMatrix(dag, type, args);
  const Type part = ir::partType(type);
  if (ir::componentCount(type) == 1) return converted(dag, args[0], type);
  const bool alike =
      std::all_of(args.begin(), args.end(), [&](ValueId id) { return ir::partType(dag[id].type) == part; });
  if (alike && !ir::isComposite(type)) return dag.construct(type, args);
  std::vector<ValueId> scalars;
  for (const ValueId arg : args) {
    for (int i = 0; i < ir::componentCount(dag[arg].type); ++i)
      scalars.push_back(converted(dag, componentOf(dag, arg, i), part));
  }
  if (scalars.size() == 1) scalars.resize(static_cast<size_t>(ir::componentCount(type)), scalars[0]);
  return dag.construct(type, scalars);
}

ValueId matrixOf(Dag& dag, Type type, std::span<const double> components) {
  const auto count = static_cast<size_t>(columnCount(type));
  std::array<ValueId, 4> columns{};
  for (size_t c = 0; c < count; ++c) {
    ir::Components column{};
    std::copy_n(components.begin() + static_cast<ptrdiff_t>(c * count), count, column.begin());
    columns[c] = dag.constant(ir::partType(type), column);
  }
  return dag.construct(type, {columns.data(), count});
}

ValueId multiplied(Dag& dag, ValueId a, ValueId b) {
  const Type left = dag[a].type;
  const Type right = dag[b].type;
  if (right == Type::Float || left == Type::Float) {
    return byColumn(dag, left == Type::Float ? right : left, std::array{a, b},
                    [&](Values x) { return dag.mul(x[0], x[1]); });
  }
  if (!ir::isMatrix(left)) {  // a row times a matrix
    std::array<ValueId, 4> parts{};
    const auto count = static_cast<size_t>(columnCount(right));
    for (size_t c = 0; c < count; ++c)
      parts[c] = dag.make(Op::Dot, {a, dag.column(b, static_cast<uint32_t>(c))});
    return dag.construct(left, {parts.data(), count});
  }
  if (!ir::isMatrix(right)) return dag.make(Op::MatMul, {a, b});
  return byColumn(dag, left, std::array{b}, [&](Values x) { return dag.make(Op::MatMul, {a, x[0]}); });
}

ValueId transposed(Dag& dag, ValueId matrix) {
  const Type type = dag[matrix].type;
  const auto count = static_cast<size_t>(columnCount(type));
  std::array<ValueId, 4> columns{};
  for (size_t c = 0; c < count; ++c) {
    std::array<ValueId, 4> parts{};
    for (size_t r = 0; r < count; ++r)
      parts[r] = dag.component(dag.column(matrix, static_cast<uint32_t>(r)), static_cast<int>(c));
    columns[c] = dag.construct(ir::partType(type), {parts.data(), count});
  }
  return dag.construct(type, {columns.data(), count});
}

namespace {

/// A part of a matrix that is left when rows and columns are taken away; entries by column and row.
class Minor {
public:
  Minor(Dag& dag, ValueId matrix) : dag_(dag), size_(static_cast<size_t>(columnCount(dag[matrix].type))) {
    for (size_t c = 0; c < size_; ++c) {
      for (size_t r = 0; r < size_; ++r)
        entries_[c][r] = dag.component(dag.column(matrix, static_cast<uint32_t>(c)), static_cast<int>(r));
    }
  }

  size_t size() const { return size_; }
  ValueId determinant() const { return determinant(all(), all()); }

  /// With its sign.
  ValueId cofactor(size_t column, size_t row) const {
    const ValueId minor = determinant(all() & ~(1U << column), all() & ~(1U << row));
    return (column + row) % 2 == 0 ? minor : dag_.make(Op::Neg, {minor});
  }

private:
  uint32_t all() const { return (1U << size_) - 1; }

  /// Of the columns and rows in the sets, along the first of the rows.
  ValueId determinant(uint32_t columns, uint32_t rows) const {
    const auto row = static_cast<size_t>(std::countr_zero(rows));
    const uint32_t below = rows & (rows - 1);
    if (below == 0) return entries_[static_cast<size_t>(std::countr_zero(columns))][row];
    ValueId sum = ir::kNoValue;
    bool negative = false;
    for (uint32_t left = columns; left != 0; left &= left - 1, negative = !negative) {
      const auto column = static_cast<size_t>(std::countr_zero(left));
      const ValueId minor = determinant(columns & ~(1U << column), below);
      const ValueId term = dag_.mul(entries_[column][row], minor);
      if (sum == ir::kNoValue)
        sum = term;
      else
        sum = negative ? dag_.sub(sum, term) : dag_.add(sum, term);
    }
    return sum;
  }

  Dag& dag_;
  size_t size_;
  std::array<std::array<ValueId, 4>, 4> entries_{};
};

}  // namespace

ValueId determinantOf(Dag& dag, ValueId matrix) { return Minor(dag, matrix).determinant(); }

ValueId inverseOf(Dag& dag, ValueId matrix) {
  const Minor minor(dag, matrix);
  const Type type = dag[matrix].type;
  const ValueId determinant = minor.determinant();
  const ValueId scale = dag.div(dag.constant(1), determinant);
  std::array<ValueId, 4> columns{};
  for (size_t c = 0; c < minor.size(); ++c) {
    std::array<ValueId, 4> parts{};
    for (size_t r = 0; r < minor.size(); ++r) parts[r] = minor.cofactor(r, c);
    const ValueId column = dag.construct(ir::partType(type), {parts.data(), minor.size()});
    columns[c] = dag.mul(column, scale);
  }
  return dag.construct(type, {columns.data(), minor.size()});
}

ValueId indexed(Dag& dag, ValueId value, ValueId index) {
  const Type type = dag[value].type;
  const bool matrix = ir::isMatrix(type);
  const int count = matrix ? columnCount(type) : ir::componentCount(type);
  const auto part = [&](int i) {
    return matrix ? dag.column(value, static_cast<uint32_t>(i)) : dag.component(value, i);
  };
  if (dag.isConstant(index))
    return part(static_cast<int>(std::clamp(dag.constantOf(index)[0], 0.0, count - 1.0)));
  ValueId chosen = part(count - 1);
  for (int i = count - 1; i-- > 0;) {
    const ValueId is = i == 0 ? dag.make(Op::IntLess, {index, dag.integer(1)})
                              : dag.make(Op::WholeEqual, {index, dag.integer(i)});
    chosen = dag.select(is, part(i), chosen);
  }
  return chosen;
}

}  // namespace lacquer::lang
