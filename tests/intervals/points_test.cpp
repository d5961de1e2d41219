// The three evaluators agree: for random points of every node and every variant, what float32 and double give
// lies in the intervals of the very same inputs, evaluated for each point alone and for boxes of several.
// Every value on the way is looked at, not results alone.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "eval/evaluate.h"
#include "intervals/evaluator.h"
#include "ir/loops.h"
#include "lang/library.h"
#include "prove/nodes.h"

namespace lacquer::test::points_test {
namespace {

using analysis::Intervals;
using analysis::Ranges;
using ir::ValueId;

constexpr size_t kPoints = 2048;

/// One body with its inputs at all points, and everything that it computes there.
class Drawn {
public:
  Drawn(const lang::NodeDecl& node, std::string_view variant)
      : name_(std::string(node.name) + "." + std::string(variant)),
        module_(nodeModule(node, variant).module) {
    const std::vector<ValueId> all = everything(module_);
    const ir::Loops loops(module_.dag, all);
    for (const ValueId id : all) {
      // What a loop's rounds compute is a value in each of them, and none behind it: soundness_test looks
      // there.
      const ir::Op op = module_.dag[id].op;
      if (loops.of(id) >= 0 || op == ir::Op::Loop || op == ir::Op::Carry) continue;
      const ir::Type type = module_.dag[id].type;
      if (ir::isTexture(type) || type == ir::Type::Mat4) continue;
      ids_.push_back(id);
      if (op == ir::Op::Input) inputs_.push_back(id);
    }
    for (size_t i = 0; i < kPoints; ++i) worlds_.emplace_back(i, analysis::kSceneLimit);
    bind();
    const auto floats = eval::evaluate<float>(module_, ids_, bindings_, kPoints);
    const auto doubles = eval::evaluate<double>(module_, ids_, bindings_, kPoints);
    if (!floats || !doubles) {
      ADD_FAILURE() << name_ << ": " << format((floats ? doubles.error() : floats.error())[0]);
      return;
    }
    for (const auto& column : *floats) floats_.emplace_back(column.begin(), column.end());
    doubles_ = *doubles;
  }

  /// Values outside of the intervals of boxes around `together` points each; the first is described.
  size_t outside(size_t together, std::string& what) const {
    size_t count = 0;
    for (size_t first = 0; first < kPoints && !doubles_.empty(); first += together) {
      Intervals intervals(module_, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit});
      for (const ValueId id : inputs_) intervals.fix(id, box(id, first, together));
      intervals.run();
      for (size_t i = first; i < first + together; ++i) {
        for (size_t v = 0; v < ids_.size(); ++v) {
          count += misses(intervals, v, i, floats_[v], "float", count == 0 ? &what : nullptr);
          count += misses(intervals, v, i, doubles_[v], "double", count == 0 ? &what : nullptr);
        }
      }
    }
    return count;
  }

  size_t numbers() const { return 2 * kPoints * ids_.size(); }

private:
  size_t width(ValueId id) const { return static_cast<size_t>(ir::componentCount(module_.dag[id].type)); }

  void bind() {
    for (const ValueId id : inputs_) {
      const ir::Input& input = module_.dag.inputOf(id);
      std::vector<double> values;
      for (const World& world : worlds_) {
        const Floats drawn = world.input(input);
        values.insert(values.end(), drawn.begin(), drawn.begin() + static_cast<ptrdiff_t>(width(id)));
      }
      bindings_.columns[input.name] = eval::Column::perPoint(static_cast<int>(width(id)), std::move(values));
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      bindings_.textures[slot.name] = [this, &slot](size_t point, const std::array<double, 3>&, double) {
        const Floats texel = worlds_[point].texel(slot.environment, slot.name, {});
        return std::array<double, 4>{texel[0], texel[1], texel[2], texel[3]};
      };
    }
  }

  /// What an input is at some points.
  Ranges box(ValueId id, size_t first, size_t together) const {
    const std::vector<double>& values = bindings_.columns.at(module_.dag.inputOf(id).name).values;
    Ranges ranges{};
    for (size_t c = 0; c < width(id); ++c) {
      for (size_t i = first; i < first + together; ++i) {
        const double x = values[i * width(id) + c];
        ranges[c] = i == first ? analysis::Range{x, x, false} : analysis::hull(ranges[c], {x, x, false});
      }
    }
    return ranges;
  }

  /// Components of a value that lie outside.
  size_t misses(const Intervals& intervals, size_t v, size_t point, const std::vector<double>& values,
                const char* arithmetic, std::string* what) const {
    const ValueId id = ids_[v];
    size_t count = 0;
    for (size_t c = 0; c < width(id); ++c) {
      double x = values[point * width(id) + c];
      // An integer was read as a float.
      const double off = ir::isWhole(module_.dag[id].type) ? std::abs(x) * 0x1p-24 : 0;
      if (module_.dag[id].type == ir::Type::UInt && x > INT32_MAX) x -= 0x1p32;  // ir/whole.h
      const analysis::Range& r = intervals.at(id, static_cast<int>(c));
      if (std::isnan(x) ? r.nan : x + off >= r.lo && x - off <= r.hi) continue;
      if (++count > 1 || what == nullptr) continue;
      std::ostringstream text;
      text.precision(17);
      text << name_ << ": %" << id << " " << ir::info(module_.dag[id].op).name << " "
           << module_.dag.nameOf(id) << " is " << x << " in " << arithmetic << ", not in [" << r.lo << ", "
           << r.hi << "] (point " << point << ")";
      *what = text.str();
    }
    return count;
  }

  std::string name_;
  ir::Module module_;
  std::vector<ValueId> ids_, inputs_;
  std::vector<World> worlds_;
  eval::Bindings bindings_;
  std::vector<std::vector<double>> floats_, doubles_;  ///< by value, components side by side
};

TEST(IntervalPoints, HoldFloatAndDoubleOfEveryNode) {
  const lang::Library library = lang::Library::embedded();
  size_t numbers = 0;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const lang::NodeDecl& node = **library.node(name);
    if (!drawable(node)) continue;
    std::vector<std::string_view> bodies = {""};
    for (const lang::Variant& variant : node.variants) bodies.push_back(variant.name);
    for (const std::string_view body : bodies) {
      const Drawn drawn(node, body);
      numbers += drawn.numbers();
      for (const size_t together : {1, 2, 8}) {
        std::string what;
        EXPECT_EQ(drawn.outside(together, what), 0U) << "boxes of " << together << " points: " << what;
      }
    }
  }
  EXPECT_GT(numbers, 5000000U);
}

}  // namespace
}  // namespace lacquer::test::points_test
