#include "eval/point_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "graph/graph.h"
#include "support/text.h"

namespace lacquer {

namespace {

using eval::Column;

/// How often one array is said to be wrong.
constexpr size_t kMostMessages = 8;
/// Their columns take some gigabytes.
constexpr size_t kMostPoints = size_t{1} << 26;

/// What a member of a point may be.
struct Member {
  std::string_view name;
  int least, most;  ///< components
  enum class Kind : uint8_t { Any, Normal, Unit, Tangent, Portion, NotNegative, Truth } kind;
};
constexpr Member kMembers[] = {{"n", 3, 3, Member::Kind::Normal},
                               {"t", 4, 4, Member::Kind::Tangent},
                               {"v", 3, 3, Member::Kind::Unit},
                               {"l", 3, 3, Member::Kind::Unit},
                               {"uv0", 2, 2, Member::Kind::Any},
                               {"uv1", 2, 2, Member::Kind::Any},
                               {"uv2", 2, 2, Member::Kind::Any},
                               {"uv3", 2, 2, Member::Kind::Any},
                               {"color0", 3, 4, Member::Kind::Portion},
                               {"light", 3, 3, Member::Kind::NotNegative},
                               {"env", 3, 3, Member::Kind::NotNegative},
                               {"position", 3, 3, Member::Kind::Any},
                               {"front_facing", 1, 1, Member::Kind::Truth},
                               {"inside", 1, 1, Member::Kind::Truth},
                               {"surrounding_ior", 1, 1, Member::Kind::Any},
                               {"channel", 1, 1, Member::Kind::Any},
                               {"random", 3, 3, Member::Kind::Any}};

class ArrayReader {
public:
  ArrayReader(const PointArrays& arrays, size_t first, size_t count)
      : arrays_(arrays), first_(first), count_(count) {
    points_.points.count = count;
  }

  Result<EvalPoints> run() {
    for (const PointArray& array : arrays_.arrays) take(array);
    if (!wrong_.empty()) return tl::make_unexpected(std::move(wrong_));
    addMissing();
    return std::move(points_);
  }

private:
  void fail(const PointArray& array, std::optional<size_t> point, std::string code, std::string message,
            std::string help) {
    std::string pointer = "/" + array.name;
    if (point) pointer += fmt::format("/{}", first_ + *point);
    wrong_.push_back({std::move(code),
                      Severity::Error,
                      {{}, 0, 0, std::move(pointer)},
                      std::move(message),
                      std::move(help),
                      {}});
  }

  void take(const PointArray& array) {
    const auto* member = std::find_if(std::begin(kMembers), std::end(kMembers),
                                      [&](const Member& one) { return one.name == array.name; });
    const bool known = member != std::end(kMembers);
    const int least = known ? member->least : 1;
    const int most = known ? member->most : 4;
    const auto components = static_cast<int>(std::min<size_t>(array.components, 99));
    const bool matrix = !known && matrixSide(array.components) != 0;
    if (!matrix && (components < least || components > most)) {
      return fail(
          array, std::nullopt, "wrong-type",
          fmt::format("{} is given {} numbers for a point", quote(array.name), array.components),
          (least == most ? fmt::format("it is {}", least) : fmt::format("it is {} to {}", least, most)) +
              (known ? "" : ", of a matrix 9 or 16"));
    }
    if (array.numbers == nullptr && arrays_.count > 0)
      return fail(array, std::nullopt, "null-argument", fmt::format("{} has no numbers", quote(array.name)),
                  {});
    if (std::find(names_.begin(), names_.end(), array.name) != names_.end())
      return fail(array, std::nullopt, "duplicate-name", fmt::format("{} is given twice", quote(array.name)),
                  {});
    names_.push_back(array.name);
    Column column = columnOf(array);
    const size_t before = wrong_.size();
    if (known) check(array, member->kind, column);
    if (wrong_.size() > before) return;
    place(array, known, std::move(column));
  }

  Column columnOf(const PointArray& array) {
    const size_t rows = array.stride == 0 ? 1 : count_;
    Column column{static_cast<int>(array.components), array.stride != 0, {}};
    column.values.resize(rows * array.components);
    const auto* from = static_cast<const unsigned char*>(array.numbers);
    if (array.stride != 0 && from != nullptr) from += static_cast<ptrdiff_t>(first_) * array.stride;
    size_t said = 0;
    for (size_t i = 0; i < rows && count_ > 0; ++i, from += array.stride) {
      double* to = &column.values[i * array.components];
      if (array.is_double) {
        std::memcpy(to, from, array.components * sizeof(double));
      } else {
        std::array<float, 16> floats{};
        std::memcpy(floats.data(), from, array.components * sizeof(float));
        std::copy_n(floats.begin(), array.components, to);
      }
      const bool finite = std::all_of(to, to + array.components, [](double x) { return std::isfinite(x); });
      if (!finite && said++ < kMostMessages)
        fail(array, i, "not-finite", fmt::format("{} is not finite", array.name), {});
    }
    return column;
  }

  /// Makes directions unit, and says what is not as it must be.
  void check(const PointArray& array, Member::Kind kind, Column& column) {
    const auto components = static_cast<size_t>(column.components);
    size_t said = 0;
    for (size_t i = 0; i * components < column.values.size() && said < kMostMessages; ++i) {
      double* x = &column.values[i * components];
      const auto wrong = [&](std::string code, std::string message, std::string help) {
        ++said;
        fail(array, i, std::move(code), std::move(message), std::move(help));
      };
      switch (kind) {
        case Member::Kind::Any: break;
        case Member::Kind::Normal:
        case Member::Kind::Tangent:
        case Member::Kind::Unit: {
          const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
          if (!(length > eval::kShortestDirection && length < eval::kLongestDirection)) {
            wrong("zero-length", fmt::format("{} has no length", array.name), "any length does, but for 0");
          } else if (kind == Member::Kind::Unit && !(std::abs(length - 1) <= eval::kUnitTolerance)) {
            wrong("not-unit", fmt::format("{} has the length {:.6g}", array.name, length),
                  "it must be a unit vector, to a thousandth");
          } else if (kind == Member::Kind::Tangent && std::abs(x[3]) != 1) {
            wrong("out-of-range", fmt::format("the tangent's sign is {}", x[3]), "it must be 1 or -1");
          }
          for (size_t c = 0; c < 3; ++c) x[c] /= length;
          break;
        }
        case Member::Kind::Portion:
        case Member::Kind::NotNegative: {
          const double most = kind == Member::Kind::Portion ? 1 : HUGE_VAL;
          const double* bad =
              std::find_if(x, x + components, [&](double y) { return !(y >= 0 && y <= most); });
          if (bad == x + components) break;
          wrong("out-of-range", fmt::format("{} is {}", array.name, *bad),
                kind == Member::Kind::Portion ? "it must be in [0, 1]" : "it must not be negative");
          break;
        }
        case Member::Kind::Truth:
          if (*x != 0 && *x != 1)
            wrong("wrong-type", fmt::format("{} is {}", array.name, *x), "it is 0 or 1");
          break;
      }
    }
  }

  /// A matrix as its columns.
  void placeColumns(const PointArray& array, const Column& matrix) {
    const size_t side = matrixSide(array.components);
    const bool attribute = graph::isAttributeName(array.name);
    if (attribute) points_.matrices.insert(array.name);
    for (size_t c = 0; c < side; ++c) {
      Column column{static_cast<int>(side), matrix.per_point, {}};
      for (size_t at = c * side; at < matrix.values.size(); at += side * side)
        column.values.insert(column.values.end(), &matrix.values[at], &matrix.values[at] + side);
      const std::string name = graph::columnName(array.name, static_cast<int>(c));
      (attribute ? points_.points.columns[name] : points_.parameters[name]) = std::move(column);
    }
  }

  void place(const PointArray& array, bool known, Column column) {
    if (!known && matrixSide(array.components) != 0 && array.name.find('.') == std::string::npos) {
      placeColumns(array, column);
    } else if (array.name == "env") {
      points_.has_environment = true;
      points_.environment.resize(count_);
      for (size_t i = 0; i < count_; ++i)
        std::copy_n(&column.values[column.per_point ? 3 * i : 0], 3, points_.environment[i].begin());
    } else if (known || graph::isAttributeName(array.name)) {
      if (array.name == "color0" && column.components == 3) column = withAlpha(column);
      points_.points.columns[array.name] = std::move(column);
    } else if (array.name.find('.') != std::string::npos) {
      if (column.per_point)
        return fail(array, std::nullopt, "wrong-type",
                    fmt::format("{} differs from point to point", quote(array.name)),
                    "a field of a block has one value: a stride of 0");
      points_.uniforms[array.name] = std::move(column.values);
    } else {
      points_.parameters[array.name] = std::move(column);
    }
  }

  Column withAlpha(const Column& color) const {
    return eval::combined(color, Column::constant({1}), count_, 4,
                          [](const double* rgb, const double* alpha, double* to) {
                            std::copy_n(rgb, 3, to);
                            to[3] = *alpha;
                          });
  }

  /// What is not given is made of the normal.
  void addMissing() {
    eval::Columns& columns = points_.points.columns;
    if (points_.environment.empty()) points_.environment.resize(count_);
    const auto n = columns.find("n");
    if (n == columns.end()) return;
    for (const char* name : {"v", "l"}) {
      if (!columns.contains(name)) columns[name] = n->second;
    }
    if (columns.contains("t")) return;
    columns["t"] =
        eval::combined(n->second, n->second, count_, 4, [](const double* normal, const double*, double* to) {
          const auto t = eval::across({normal[0], normal[1], normal[2]});
          std::copy(t.begin(), t.end(), to);
          to[3] = 1;
        });
  }

  const PointArrays& arrays_;
  size_t first_, count_;
  EvalPoints points_;
  Diagnostics wrong_;
  std::vector<std::string> names_;
};

}  // namespace

Result<EvalPoints> pointsOf(const PointArrays& arrays, size_t first, size_t count) {
  if (arrays.count > kMostPoints)
    return lacquer::fail("too-many-points", {}, fmt::format("there are {} points", arrays.count),
                         fmt::format("at most {} are evaluated at once", kMostPoints));
  return ArrayReader(arrays, first, count).run();
}

}  // namespace lacquer
