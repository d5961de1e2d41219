#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/intervals.h"
#include "ir/loops.h"
#include "stress/subject.h"

namespace lacquer::stress {

namespace {

using eval::Column;

template <class T>
using Vector = std::array<T, 3>;

template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Vector<T> normalized(const Vector<T>& a) {
  const T length = std::sqrt(dot(a, a));
  // A vertex normal of no length is normalized to one of no length.
  if (!(length > 0)) return {};
  return {a[0] / length, a[1] / length, a[2] / length};
}

template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// What parameters of these names have in common, in the arithmetic of T.
template <class T>
struct Geometry {
  Vector<T> n, v, l, t, b, sum;

  explicit Geometry(const double* of) {
    const auto direction = [&](size_t i) {
      return normalized<T>(
          {static_cast<T>(of[3 * i]), static_cast<T>(of[3 * i + 1]), static_cast<T>(of[3 * i + 2])});
    };
    n = direction(0);
    v = direction(1);
    l = direction(2);
    t = direction(3);
    // Across the normal after rounding too: two steps of Gram and Schmidt.
    for (int i = 0; i < 2; ++i) {
      const T along = dot(n, t);
      t = normalized<T>({t[0] - n[0] * along, t[1] - n[1] * along, t[2] - n[2] * along});
    }
    b = cross(n, t);
    sum = {v[0] + l[0], v[1] + l[1], v[2] + l[2]};
  }

  std::vector<T> of(std::string_view name) const {
    const auto vector = [](const Vector<T>& a) { return std::vector<T>{a[0], a[1], a[2]}; };
    const T n_dot_l = std::clamp(dot(n, l), T(0), T(1));
    if (name == "N") return vector(n);
    if (name == "V") return vector(v);
    if (name == "L") return vector(l);
    if (name == "T") return vector(t);
    if (name == "B") return vector(b);
    if (name == "sum") return vector(sum);
    if (name == "length2") return {dot(sum, sum)};
    if (name == "NdotL") return {n_dot_l};
    if (name == "NdotV") return {std::abs(dot(n, v))};
    if (name == "NdotSum") return {n_dot_l + dot(n, v)};
    if (name == "BdotV") return {dot(b, v)};
    if (name == "BdotL") return {dot(b, l)};
    return {};
  }
};

bool isPositional(const ir::Parameter& parameter) {
  return parameter.name == "positional" && parameter.type == ir::Type::Float;
}

/// By name and type: a node may call anything `N`.
bool isGeometry(const ir::Parameter& parameter) {
  const double any[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  const size_t components = Geometry<double>(any).of(parameter.name).size();
  return components == (parameter.type == ir::Type::Vec3    ? 3
                        : parameter.type == ir::Type::Float ? 1
                                                            : ~size_t{0});
}

class Node final : public Subject {
public:
  static Result<std::unique_ptr<Subject>> make(NodeSource source) {
    auto node = std::make_unique<Node>();
    node->name = source.name;
    node->module_ = std::move(source.module);
    node->makeSpace();
    node->makeRoots(source.results);
    std::vector<double> sample(node->space.width() * node->group);
    for (size_t i = 0; i < node->group; ++i)
      node->space.draw(0, std::span(sample).subspan(i * node->space.width(), node->space.width()));
    const eval::Bindings bindings = node->bind<double>(sample, node->group);
    Result<eval::Program> program = eval::compile(node->module_, node->ids_, bindings, node->group);
    if (!program) return tl::make_unexpected(std::move(program.error()));
    node->program_ = std::move(*program);
    return node;
  }

  Values evaluate(Arithmetic arithmetic, std::span<const double> samples, size_t count) const override {
    Values values;
    const auto take = [&](const auto& results) {
      for (const auto& column : results) values.emplace_back(column.begin(), column.end());
    };
    switch (arithmetic) {
      case Arithmetic::Float: take(eval::run<float>(program_, bind<float>(samples, count), count)); break;
      case Arithmetic::Double: take(eval::run<double>(program_, bind<double>(samples, count), count)); break;
      case Arithmetic::Half: take(eval::runHalf(program_, bind<float>(samples, count), count)); break;
    }
    return values;
  }

  Values evaluateRough(std::span<const double> samples, size_t count, uint64_t seed) const override {
    return eval::runRough(program_, bind<float>(samples, count), count, mixed(seed, name));
  }

  const ir::Module& module() const override { return module_; }

  eval::Bindings inputs(std::span<const double> samples, size_t count) const override {
    return bind<float>(samples, count);
  }

  std::vector<bool> defined(std::span<const double>, size_t count) const override {
    return std::vector<bool>(count, true);
  }

private:
  void makeSpace() {
    if (std::any_of(module_.parameters.begin(), module_.parameters.end(), isGeometry)) {
      geometric_ = true;
      for (const char* base : {"N", "V", "L", "T"}) space.add(base, 3, {}, Nature::Direction, 1);
    }
    for (const ir::Parameter& parameter : module_.parameters) {
      if (isGeometry(parameter)) continue;
      const bool unit = parameter.range.lo == -1 && parameter.range.hi == 1;
      // A light is positional or not: what stands between has no meaning.
      const bool flag = isPositional(parameter);
      const bool texel = parameter.name == "texel" && parameter.range == ir::Interval{0, 1};
      const Nature nature = flag    ? Nature::Flag
                            : texel ? Nature::Texel
                            : unit && parameter.type == ir::Type::Vec3
                                ? Nature::Direction
                                : natureOf(parameter.type, parameter.name, parameter.range);
      ir::Interval range = parameter.range;
      if (ir::partType(parameter.type) == ir::Type::UInt) range.lo = std::max(range.lo, 0.0);
      space.add(parameter.name, ir::componentCount(parameter.type), range, nature, analysis::kSceneLimit);
    }
    for (const ir::TextureSlot& slot : module_.textures) {
      if (slot.type == ir::Type::TextureCube)
        space.addTexel(slot.name, 4, {0, 65504}, Nature::Number, analysis::kSceneLimit);
      else
        space.addTexel(slot.name, 4, {0, 1}, Nature::Texel, 1);
    }
  }

  void makeRoots(const std::vector<std::pair<std::string, ir::Interval>>& results) {
    const analysis::RangeMath math(analysis::Arithmetic::Vulkan);
    const ir::Dag& dag = module_.dag;
    std::vector<ir::ValueId> outputs;
    for (size_t i = 0; i < module_.outputs.size(); ++i) {
      const ir::ValueId id = module_.outputs[i].value;
      outputs.push_back(id);
      ids_.push_back(id);
      const bool flag = dag[id].type == ir::Type::Bool;
      roots.push_back({Root::Kind::Result, results[i].first, ir::componentCount(dag[id].type), flag,
                       math.fact(flag ? ir::Interval{0, 1} : results[i].second)});
    }
    std::vector<ir::ValueId> all(dag.size());
    std::iota(all.begin(), all.end(), ir::ValueId{0});
    const ir::Loops loops(dag, all);
    for (const ir::ValueId id : all) {
      const std::optional<ir::Interval> fact = dag.assumed(id);
      // Inside of a loop there is no value to look at.
      if (!fact || loops.of(id) >= 0) continue;
      ids_.push_back(id);
      const std::string_view named = dag.nameOf(id);
      roots.push_back({Root::Kind::Fact, named.empty() ? fmt::format("%{}", id) : std::string(named),
                       ir::componentCount(dag[id].type), false, math.fact(*fact)});
    }
    for (const ir::ValueId id : ir::reachable(dag, outputs)) {
      if (dag[id].op == ir::Op::DFdx || dag[id].op == ir::Op::DFdy) group = 4;
      const bool condition =
          dag[id].op == ir::Op::Less || dag[id].op == ir::Op::LessEqual || dag[id].op == ir::Op::Equal;
      if (!condition || loops.of(id) >= 0) continue;
      addCondition(module_, id, conditionName(module_, id), roots, ids_);
    }
  }

  template <class T>
  eval::Bindings bind(std::span<const double> samples, size_t count) const {
    eval::Bindings bindings;
    bindings.quads = group == 4;
    const size_t width = space.width();
    for (const ir::Parameter& parameter : module_.parameters) {
      const auto components = static_cast<size_t>(ir::componentCount(parameter.type));
      std::vector<double> values(count * components);
      const Variable* variable = space.find(parameter.name);
      const bool derived = geometric_ && isGeometry(parameter);
      for (size_t i = 0; i < count; ++i) {
        const double* sample = samples.data() + i * width;
        if (derived) {
          const std::vector<T> own = Geometry<T>(sample).of(parameter.name);
          std::copy(own.begin(), own.end(), values.begin() + static_cast<ptrdiff_t>(i * components));
        } else if (variable->nature == Nature::Direction) {
          const double* d = sample + variable->first;
          const Vector<T> own =
              normalized<T>({static_cast<T>(d[0]), static_cast<T>(d[1]), static_cast<T>(d[2])});
          std::copy(own.begin(), own.end(), values.begin() + static_cast<ptrdiff_t>(i * components));
        } else {
          std::copy_n(sample + variable->first, components, values.data() + i * components);
        }
      }
      bindings.columns[parameter.name] = Column::perPoint(static_cast<int>(components), std::move(values));
    }
    keepPairs<T>(count, bindings);
    for (const ir::TextureSlot& slot : module_.textures) {
      const size_t first = space.texel(slot.name)->first;
      bindings.textures[slot.name] = [samples, width, first](size_t point, const std::array<double, 3>&,
                                                             double) {
        const double* texel = samples.data() + point * width + first;
        return std::array<double, 4>{texel[0], texel[1], texel[2], texel[3]};
      };
    }
    return bindings;
  }

  /// What contracts say in words: a pair in [-1, 1] is a unit vector, and so is a directional light's
  /// position.
  template <class T>
  void keepPairs(size_t count, eval::Bindings& bindings) const {
    const auto normalize = [](double* d, size_t n) {
      Vector<T> own{};
      for (size_t c = 0; c < n; ++c) own[c] = static_cast<T>(d[c]);
      own = normalized<T>(own);
      std::copy_n(own.begin(), n, d);
    };
    const auto light = std::find_if(module_.parameters.begin(), module_.parameters.end(), isPositional);
    for (const ir::Parameter& parameter : module_.parameters) {
      const bool pair = parameter.type == ir::Type::Vec2 && parameter.range == ir::Interval{-1, 1};
      const bool position = parameter.type == ir::Type::Vec3 && parameter.name == "position" &&
                            light != module_.parameters.end();
      if (!pair && !position) continue;
      const size_t n = pair ? 2 : 3;
      Column& column = bindings.columns[parameter.name];
      for (size_t i = 0; i < count; ++i) {
        if (pair || bindings.columns["positional"].values[i] == 0) normalize(column.values.data() + n * i, n);
      }
    }
    keepSplitSum(count, bindings);
  }

  /// The two parts of a lobe's directional albedo, which is 0.25 at least
  /// (base_indirect_multiple_scattering).
  static void keepSplitSum(size_t count, eval::Bindings& bindings) {
    const auto scale = bindings.columns.find("scale");
    const auto bias = bindings.columns.find("bias");
    if (scale == bindings.columns.end() || bias == bindings.columns.end()) return;
    if (scale->second.components != 1 || bias->second.components != 1) return;
    for (size_t i = 0; i < count; ++i) {
      double& a = scale->second.values[i];
      double& b = bias->second.values[i];
      const double sum = a + b;
      const double kept = std::clamp(sum, 0.25, 1.0);
      a = sum > 0 ? a * (kept / sum) : kept;
      b = sum > 0 ? b * (kept / sum) : 0;
    }
  }

  ir::Module module_;
  bool geometric_ = false;
  std::vector<ir::ValueId> ids_;  ///< by root
  eval::Program program_;
};

std::string operandName(const ir::Module& module, ir::ValueId id) {
  const ir::Dag& dag = module.dag;
  if (dag.isConstant(id)) return fmt::format("{:g}", dag.constantOf(id)[0]);
  if (dag[id].op == ir::Op::Input) return dag.inputOf(id).name;
  if (!dag.nameOf(id).empty()) return std::string(dag.nameOf(id));
  return std::string(ir::info(dag[id].op).name);
}

}  // namespace

Result<std::unique_ptr<Subject>> nodeSubject(NodeSource source) { return Node::make(std::move(source)); }

void addCondition(ir::Module& module, ir::ValueId id, std::string name, std::vector<Root>& roots,
                  std::vector<ir::ValueId>& ids) {
  ids.push_back(id);
  roots.push_back({Root::Kind::Condition, std::move(name), 1, true, {0, 1, false}});
  const ir::Value value = module.dag[id];
  if (module.dag[value.args[0]].type != ir::Type::Float) return;
  ids.push_back(module.dag.sub(value.args[0], value.args[1]));
  roots.push_back({Root::Kind::Gap, "", 1, true, {}});
}

std::string conditionName(const ir::Module& module, ir::ValueId id) {
  const ir::Value& value = module.dag[id];
  const char* const sign = value.op == ir::Op::Less ? "<" : value.op == ir::Op::LessEqual ? "<=" : "==";
  return fmt::format("{} {} {}", operandName(module, value.args[0]), sign,
                     operandName(module, value.args[1]));
}

}  // namespace lacquer::stress
