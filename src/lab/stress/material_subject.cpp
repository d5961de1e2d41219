#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/intervals.h"
#include "eval/dfg.h"
#include "eval/points.h"
#include "ir/loops.h"
#include "stress/subject.h"
#include "stress/vectors.h"

namespace lacquer::stress {

namespace {

using eval::Column;

/// Lengths that a file's normals and tangents may have; 0 is one of them.
constexpr ir::Interval kLengths{0, 1e4};
/// Interpolation between unit normals 120 degrees apart leaves half.
constexpr ir::Interval kInterpolated{0.5, 1};
constexpr double kBrightest = 1e4;
/// Open ends of parameters: larger emission strengths and the like come from mistakes.
constexpr double kLimit = 1e6;

Vec3 unitOf(const double* a) { return unit(Vec3{a[0], a[1], a[2]}); }

class Material final : public Subject {
public:
  static Result<std::unique_ptr<Subject>> make(std::string name, ir::Module module, Layers layers) {
    auto material = std::make_unique<Material>();
    material->name = std::move(name);
    material->is_node = false;
    material->module_ = std::move(module);
    for (ir::Output& output : material->module_.outputs) {
      ir::Dag& dag = material->module_.dag;
      if (!ir::isWhole(dag[output.value].type)) continue;
      const bool integer = dag[output.value].type == ir::Type::Int;
      output.value = dag.make(integer ? ir::Op::FromInt : ir::Op::FromUInt, {output.value});
    }
    material->layers = std::move(layers);
    material->lanes = takesDerivatives(material->module_) ? 4 : 1;
    material->makeSpace();
    material->makeRoots();
    std::vector<double> sample(material->space.width());
    material->space.draw(0, sample);
    if (Result<void> compiled = material->compile(sample); !compiled)
      return tl::make_unexpected(std::move(compiled.error()));
    return material;
  }

  Values evaluate(Arithmetic arithmetic, std::span<const double> samples, size_t count) const override {
    const size_t points = count * lanes;
    if (arithmetic == Arithmetic::Double) {
      eval::Bindings bindings = bind(samples, points);
      preshade(bindings, points);
      vary<double>(samples, points, bindings);
      return taken(eval::run<double>(fragment_, bindings, points));
    }
    const eval::Bindings bindings = inputs(samples, count);
    return taken(arithmetic == Arithmetic::Half ? eval::runHalf(fragment_, bindings, points)
                                                : eval::run<float>(fragment_, bindings, points));
  }

  Values evaluateRough(std::span<const double> samples, size_t count, uint64_t seed) const override {
    eval::Bindings bindings = inputs(samples, count);
    const uint64_t own = mixed(seed, name);
    for (const ir::TextureSlot& slot : module_.textures) {
      if (isTable(slot)) bindings.textures[slot.name] = blurred(slot.name, own);
    }
    return taken(eval::runRough(fragment_, bindings, count * lanes, own));
  }

  const ir::Module& module() const override { return module_; }

  eval::Bindings inputs(std::span<const double> samples, size_t count) const override {
    eval::Bindings bindings = bind(samples, count * lanes);
    preshade(bindings, count * lanes);
    vary<float>(samples, count * lanes, bindings);
    return bindings;
  }

  std::vector<bool> defined(std::span<const double> samples, size_t count) const override {
    std::vector<bool> answer(count, true);
    if (lanes == 1) return answer;
    const eval::Bindings bindings = inputs(samples, count);
    for (const ir::Varying& varying : module_.varyings) {
      const auto column = bindings.columns.find(varying.name);
      if (column == bindings.columns.end() || (varying.type != ir::Type::Vec2 && varying.name != "position"))
        continue;
      const auto n = static_cast<size_t>(column->second.components);
      for (size_t i = 0; i < count; ++i)
        answer[i] = answer[i] && spansArea({column->second.values.data() + lanes * n * i, 3 * n});
    }
    return answer;
  }

private:
  /// Three neighbours' places, one after the other: not on a line, by more than a thousandth of their
  /// distances.
  static bool spansArea(std::span<const double> places) {
    const size_t n = places.size() / 3;
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (size_t c = 0; c < n; ++c) {
      const double x = places[n + c] - places[c];
      const double y = places[2 * n + c] - places[c];
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
    return xx * yy - xy * xy > 1e-6 * xx * yy;
  }

  /// Of each sample's points the first.
  template <class T>
  Values taken(const std::vector<std::vector<T>>& results) const {
    Values values;
    for (size_t r = 0; r < results.size(); ++r) {
      const auto n = static_cast<size_t>(roots[r].components);
      std::vector<double>& column = values.emplace_back();
      for (size_t i = 0; i < results[r].size(); i += n * lanes)
        column.insert(column.end(), results[r].begin() + static_cast<ptrdiff_t>(i),
                      results[r].begin() + static_cast<ptrdiff_t>(i + n));
    }
    return values;
  }

  /// A table as a device looks into it, whose filter has 8 bits of a texel's width.
  static eval::Sampler blurred(const std::string& table, uint64_t seed) {
    const std::shared_ptr<const eval::Image> image = eval::environmentTable(table);
    return
        [image, seed, sampler = eval::environmentSampler(table)](size_t point, const Vec3& at, double lod) {
          Random random(mixed(seed, point));
          const double x = (2 * random.unit() - 1) / (256.0 * image->width);
          const double y = (2 * random.unit() - 1) / (256.0 * image->height);
          return sampler(point, {at[0] + x, at[1] + y, at[2]}, lod);
        };
  }

  static bool takesDerivatives(const ir::Module& module) {
    const std::vector<ir::ValueId> live = ir::reachable(module, ir::Stage::Fragment);
    return std::any_of(live.begin(), live.end(), [&](ir::ValueId id) {
      return module.dag[id].op == ir::Op::DFdx || module.dag[id].op == ir::Op::DFdy;
    });
  }

  /// The environment's factors are what they are.
  static bool isTable(const ir::TextureSlot& slot) {
    return slot.environment && slot.type == ir::Type::Texture2D &&
           eval::environmentTable(slot.name) != nullptr;
  }

  void makeSpace() {
    // The directions of a sample are named as a point's are (docs/eval.md).
    for (const char* direction : {"n", "v", "l", "t"}) space.add(direction, 3, {}, Nature::Direction, 1);
    space.add("n_length", 1, kLengths, Nature::Number, kBrightest);
    space.add("t_length", 1, kLengths, Nature::Number, kBrightest);
    space.add("interpolated", 1, kInterpolated, Nature::Number, 1);
    space.add("t_sign", 1, {}, Nature::Flag, 1);
    space.add("front_facing", 1, {}, Nature::Flag, 1);
    space.add("color0", 4, {0, 1}, Nature::Number, 1);
    space.add("light", 3, {0, kBrightest}, Nature::Number, kBrightest);
    if (lanes > 1) {
      for (const char* step : {"position_dx", "position_dy"}) space.add(step, 3, {}, Nature::Step, 1);
      for (const char* step : {"uv_dx", "uv_dy"}) space.add(step, 2, {}, Nature::Step, 1);
    }
    for (const uint32_t index : ir::usedParameters(module_)) {
      const ir::Parameter& parameter = module_.parameters[index];
      ir::Interval range = parameter.range;
      if (ir::partType(parameter.type) == ir::Type::UInt) range.lo = std::max(range.lo, 0.0);
      space.add(parameter.name, ir::componentCount(parameter.type), range,
                natureOf(parameter.type, parameter.name, parameter.range), kLimit);
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      if (isTable(slot)) continue;
      if (slot.environment)
        space.addTexel(slot.name, 3, {0, 65504}, Nature::Number, kLimit);
      else
        space.addTexel(slot.name, 4, {0, 1}, Nature::Texel, 1);
    }
  }

  void makeRoots() {
    ir::Dag& dag = module_.dag;
    const double inf = std::numeric_limits<double>::infinity();
    std::vector<ir::ValueId> outputs;
    for (const ir::Output& output : module_.outputs) {
      // Whether a fragment is dropped is no number; its colour counts all the same.
      if (output.kind != ir::OutputKind::Color) continue;
      outputs.push_back(output.value);
      ids_.push_back(output.value);
      roots.push_back({Root::Kind::Result,
                       output.name,
                       ir::componentCount(dag[output.value].type),
                       false,
                       {0, inf, false}});
    }
    const std::vector<ir::ValueId> live = ir::reachable(dag, outputs);
    const ir::Loops loops(dag, live);
    for (const ir::ValueId id : live) {
      // Inside of a loop there is no value to look at; with one light there is no loop over lights.
      if (dag[id].rate == ir::Rate::Light || loops.of(id) >= 0) continue;
      if (dag[id].op != ir::Op::Less && dag[id].op != ir::Op::LessEqual && dag[id].op != ir::Op::Equal)
        continue;
      const std::string term = dag.terms().empty() ? "" : dag.terms()[dag.termOf(id)].name + ": ";
      addCondition(module_, id, term + conditionName(module_, id), roots, ids_);
    }
  }

  /// A variable's numbers, by point: the points of one sample share them.
  struct Numbers {
    const double* first;
    size_t width;  ///< of a sample
    size_t lanes;

    const double* operator[](size_t point) const { return first + point / lanes * width; }
  };

  Numbers numbers(std::span<const double> samples, std::string_view variable) const {
    return {samples.data() + space.find(variable)->first, space.width(), lanes};
  }

  /// Adds where neighbours lie, and their texture coordinates.
  void step(std::span<const double> samples, eval::PointColumns& points) const {
    const auto put = [&](std::string_view column, int components, Numbers dx, Numbers dy) {
      const auto n = static_cast<size_t>(components);
      std::vector<double> values(points.count * n);
      for (size_t i = 0; i < points.count; ++i) {
        const double x = static_cast<double>(i % 2);
        const double y = static_cast<double>(i / 2 % 2);
        for (size_t c = 0; c < n; ++c) values[i * n + c] = x * dx[i][c] + y * dy[i][c];
      }
      points.columns[std::string(column)] = Column::perPoint(components, std::move(values));
    };
    put("position", 3, numbers(samples, "position_dx"), numbers(samples, "position_dy"));
    for (const char* uv : {"uv0", "uv1", "uv2", "uv3"}) {
      put(uv, 2, numbers(samples, "uv_dx"), numbers(samples, "uv_dy"));
    }
  }

  /// `count` points, `lanes` of which are of one sample.
  eval::PointColumns pointsOf(std::span<const double> samples, size_t count) const {
    eval::PointColumns points{count, {}};
    const auto put = [&](std::string_view column, int components, const auto& write) {
      std::vector<double> values(count * static_cast<size_t>(components));
      for (size_t i = 0; i < count; ++i) write(i, values.data() + i * static_cast<size_t>(components));
      points.columns[std::string(column)] = Column::perPoint(components, std::move(values));
    };
    const auto unit = [&](std::string_view name) {
      return [from = numbers(samples, name)](size_t i, double* to) {
        const Vec3 direction = unitOf(from[i]);
        std::copy(direction.begin(), direction.end(), to);
      };
    };
    const auto scaled = [&](std::string_view name, std::string_view length_name) {
      return [write = unit(name), length = numbers(samples, length_name)](size_t i, double* to) {
        write(i, to);
        for (size_t c = 0; c < 3; ++c) to[c] *= *length[i];
      };
    };
    put("n", 3, scaled("n", "n_length"));
    put("t", 4, [tangent = scaled("t", "t_length"), sign = numbers(samples, "t_sign")](size_t i, double* to) {
      tangent(i, to);
      to[3] = *sign[i] != 0 ? 1 : -1;
    });
    put("v", 3, unit("v"));
    put("l", 3, unit("l"));
    const Numbers color0 = numbers(samples, "color0");
    put("color0", 4, [&](size_t i, double* to) { std::copy_n(color0[i], 4, to); });
    const Numbers light = numbers(samples, "light");
    put("light", 3, [&](size_t i, double* to) { std::copy_n(light[i], 3, to); });
    const Numbers front_facing = numbers(samples, "front_facing");
    put("front_facing", 1, [&](size_t i, double* to) { *to = *front_facing[i] != 0 ? 1 : 0; });
    if (lanes > 1) step(samples, points);
    return points;
  }

  eval::Bindings bind(std::span<const double> samples, size_t count) const {
    eval::Bindings bindings;
    bindings.quads = lanes > 1;
    eval::bindPoints(module_, pointsOf(samples, count), bindings);
    const size_t width = space.width();
    for (const Variable& variable : space.variables()) {
      if (variable.nature != Nature::Number && variable.nature != Nature::Index &&
          variable.nature != Nature::Whole)
        continue;
      std::vector<double> values;
      values.reserve(count * static_cast<size_t>(variable.components));
      for (size_t i = 0; i < count; ++i) {
        const double* from = samples.data() + i / lanes * width + variable.first;
        values.insert(values.end(), from, from + variable.components);
      }
      bindings.columns[variable.name] = Column::perPoint(variable.components, std::move(values));
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      if (isTable(slot)) {
        bindings.textures[slot.name] = eval::environmentSampler(slot.name);
        continue;
      }
      const Variable& texel = *space.texel(slot.name);
      bindings.textures[slot.name] = [samples, width, &texel, this](size_t point, const Vec3&, double) {
        const double* from = samples.data() + point / lanes * width + texel.first;
        return std::array<double, 4>{from[0], from[1], from[2], texel.components > 3 ? from[3] : 1.0};
      };
    }
    return bindings;
  }

  /// Every sample is a material of its own: the fields of its block, rounded to float.
  void preshade(eval::Bindings& bindings, size_t count) const {
    const std::vector<std::vector<double>> values = eval::run<double>(preshader_, bindings, count);
    for (const ir::Block& block : module_.blocks) {
      if (block.role != ir::BlockRole::Material) continue;
      for (size_t i = 0; i < values.size(); ++i) {
        const ir::BlockField& field = block.fields[module_.preshader[i].field];
        std::vector<double> rounded = values[i];
        const bool whole = ir::isWhole(ir::partType(field.type));
        for (double& x : rounded) x = whole ? x : static_cast<double>(static_cast<float>(x));
        bindings.columns[block.instance + "." + field.name] =
            Column::perPoint(ir::componentCount(field.type), std::move(rounded));
      }
    }
  }

  /// Interpolation makes unit vectors shorter.
  template <class T>
  void vary(std::span<const double> samples, size_t count, eval::Bindings& bindings) const {
    const std::vector<std::vector<T>> values = eval::run<T>(vertex_, bindings, count);
    for (size_t i = 0; i < values.size(); ++i) {
      const ir::Varying& varying = *varyings_[i];
      const auto components = static_cast<size_t>(ir::componentCount(varying.type));
      std::vector<double> column(values[i].begin(), values[i].end());
      if (varying.name == "normal" || varying.name == "tangent") {
        const Numbers interpolated = numbers(samples, "interpolated");
        for (size_t k = 0; k < column.size(); ++k) {
          if (k % components < 3) column[k] *= *interpolated[k / components];
        }
      }
      bindings.columns[varying.name] = Column::perPoint(static_cast<int>(components), std::move(column));
    }
  }

  Result<void> compile(std::span<const double> sample) {
    const size_t count = lanes;
    eval::Bindings bindings = bind(sample, count);
    std::vector<ir::ValueId> fields;
    for (const ir::PreshaderField& field : module_.preshader) fields.push_back(field.value);
    Result<eval::Program> preshader = eval::compile(module_, fields, bindings, count);
    if (!preshader) return tl::make_unexpected(std::move(preshader.error()));
    preshader_ = std::move(*preshader);
    preshade(bindings, count);
    std::vector<ir::ValueId> sources;
    for (const ir::Varying& varying : module_.varyings) {
      if (varying.source == ir::kNoValue) continue;
      sources.push_back(varying.source);
      varyings_.push_back(&varying);
    }
    Result<eval::Program> vertex = eval::compile(module_, sources, bindings, count);
    if (!vertex) return tl::make_unexpected(std::move(vertex.error()));
    vertex_ = std::move(*vertex);
    vary<double>(sample, count, bindings);
    Result<eval::Program> fragment = eval::compile(module_, ids_, bindings, count);
    if (!fragment) return tl::make_unexpected(std::move(fragment.error()));
    fragment_ = std::move(*fragment);
    return {};
  }

  ir::Module module_;
  std::vector<ir::ValueId> ids_;  ///< by root
  std::vector<const ir::Varying*> varyings_;
  eval::Program preshader_, vertex_, fragment_;
};

}  // namespace

Result<std::unique_ptr<Subject>> materialSubject(std::string name, ir::Module module, Layers layers) {
  return Material::make(std::move(name), std::move(module), std::move(layers));
}

}  // namespace lacquer::stress
