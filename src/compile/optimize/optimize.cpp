#include "optimize/optimize.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "analysis/prove.h"
#include "analysis/relax.h"
#include "optimize/extract.h"
#include "optimize/points.h"
#include "optimize/rules.h"
#include "optimize/safety.h"

namespace lacquer::optimize {

namespace {

using analysis::Intervals;
using ir::ValueId;

/// Nothing may have an error twice that of the plain form.
constexpr double kGrowth = 2;

/// How many lights a sum may have.
std::pair<double, double> lightCounts(const ir::Module& module) {
  double most = 1;
  for (const ir::Block& block : module.blocks) {
    if (block.role == ir::BlockRole::Lights) most = std::max<double>(most, block.array);
  }
  bool counted = module.light_groups.empty();
  double fixed = 0;
  for (const ir::LightGroup& group : module.light_groups) {
    counted |= group.count < 0;
    fixed = std::max<double>(fixed, group.count);
  }
  return {0, counted ? most : fixed};
}

/// What the analyses say of the module's values, as facts of classes.
class ModuleFacts {
public:
  explicit ModuleFacts(const ir::Module& module)
      : dag_(module.dag),
        real_(module, {analysis::Arithmetic::Real, analysis::kSceneLimit}),
        natural_(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}),
        lit_(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}) {
    real_.run();
    natural_.run();
    for (const ValueId light : analysis::lightsOf(module)) {
      Ranges ranges;
      ranges.fill({natural_.all(light).lo >= 0 ? 0.0 : -1.0, 1, false});
      lit_.fix(light, ranges);
    }
    lit_.run();
  }

  Facts of(ValueId id) const { return {all(real_, id), all(lit_, id)}; }
  /// In float32, with light as bright as it may be.
  Ranges natural(ValueId id) const { return all(natural_, id); }
  bool known(ValueId id) const { return natural_.known(id) && lit_.known(id) && real_.known(id); }

private:
  Ranges all(const Intervals& intervals, ValueId id) const {
    Ranges ranges;
    const int width = std::max(ir::componentCount(dag_[id].type), 1);
    for (int c = 0; c < 4; ++c) ranges[static_cast<size_t>(c)] = intervals.at(id, std::min(c, width - 1));
    return ranges;
  }

  const ir::Dag& dag_;
  Intervals real_, natural_, lit_;
};

/// A plan with what is known of its nodes.
struct Found {
  Plan plan;
  std::vector<Facts> facts;
  std::vector<bool> known;
};

/// Puts a plan into a graph. Returns the class of each node.
std::vector<Ref> seed(EGraph& graph, const Found& found, std::map<ValueId, Ref>& origins) {
  std::vector<Ref> classes(found.plan.nodes.size(), kNoRef);
  for (Ref at = 0; at < classes.size(); ++at) {
    Node node = found.plan.nodes[at];
    for (size_t k = 0; k < node.count; ++k) node.args[k] = classes[node.args[k]];
    const Ref made = graph.add(node, found.known[at] ? &found.facts[at] : nullptr);
    classes[at] = made;
    const ValueId origin = found.plan.origin[at];
    if (origin == ir::kNoValue) continue;
    const auto [there, fresh] = origins.try_emplace(origin, made);
    if (fresh && graph[made].origin == ir::kNoValue) graph.setOrigin(made, origin);
    if (!fresh) graph.merge(there->second, made);
  }
  graph.rebuild();
  return classes;
}

/// Of each class that a plan has, the plan's node in a graph that has grown since.
std::vector<NodeId> nodesOf(const EGraph& graph, const Plan& plan, std::span<const Ref> classes) {
  std::vector<NodeId> start(graph.classCount(), Extractor::kNoNode);
  for (Ref at = 0; at < classes.size(); ++at) {
    Node node = plan.nodes[at];
    for (size_t k = 0; k < node.count; ++k) node.args[k] = classes[node.args[k]];
    NodeId& chosen = start[graph.find(classes[at])];
    if (chosen == Extractor::kNoNode) chosen = graph.nodeOf(node);
    if (chosen == Extractor::kNoNode) chosen = graph[classes[at]].nodes.front();
  }
  return start;
}

/// What proofs say of a module that a search must not lose.
struct Proved {
  size_t unsafe = 0;
  std::vector<analysis::OutputRange> outputs;

  explicit Proved(const ir::Module& module) {
    const analysis::Proofs proofs = analysis::prove(module);
    for (const analysis::Proof& proof : proofs.operations) unsafe += proof.safe ? 0 : 1;
    outputs = proofs.outputs;
  }
  /// True where nothing is lost of another's.
  bool keeps(const Proved& plain) const {
    if (unsafe > plain.unsafe || outputs.size() != plain.outputs.size()) return false;
    for (size_t i = 0; i < outputs.size(); ++i) {
      const Range& now = outputs[i].reached;
      const Range& before = plain.outputs[i].reached;
      if ((now.nan && !before.nan) || (now.lo < 0 && before.lo >= 0)) return false;
      if (std::isinf(now.hi) && !std::isinf(before.hi)) return false;
    }
    return true;
  }
};

/// How much a level looks at.
struct Plenty {
  size_t nodes;    ///< of a graph
  int ways;        ///< from the plain form
  int steps;       ///< of a way: graphs, each from where the one before it has ended
  int idle;        ///< steps that find nothing, behind which there is no other
  size_t wander;   ///< plans by chance in each of them
  size_t matches;  ///< of one rule in a round of its graph
};
constexpr Plenty kPlenty[] = {{12000, 1, 8, 3, 1000, 12000}, {16000, 8, 8, 4, 3000, 12000}};

/// What differs from one graph to the next, so that they do not all end in the same place.
struct Taste {
  double slack, heat;
  unsigned left_out;  ///< rules of a hundred
};
constexpr Taste kTastes[] = {{2, 0.5, 0}, {2, 0.5, 0}, {8, 1, 30}, {0, 0.5, 0}, {14, 0.5, 0}, {2, 2, 50}};

class Search {
public:
  Search(const ir::Module& module, const Settings& settings)
      : module_(module),
        family_(settings.family != nullptr ? *settings.family : families()[0]),
        plenty_(kPlenty[settings.level >= 2 ? 1 : 0]) {
    std::tie(least_lights_, most_lights_) = lightCounts(module);
    const ModuleFacts facts(module);
    plain_.plan = planOf(module, constants_);
    for (const ValueId origin : plain_.plan.origin) {
      const bool known = origin != ir::kNoValue && facts.known(origin);
      plain_.known.push_back(known);
      plain_.facts.push_back(known ? facts.of(origin) : Facts{});
      natural_.push_back(known ? facts.natural(origin) : Ranges{});
    }
    fill();
  }

  std::vector<Candidate> run() {
    std::vector<Candidate> all;
    all.push_back({module_, {}});
    const Proved proved(module_);
    Counter counter(module_);
    const double plain = planCost(counter, plain_.plan, constants_, family_);
    double best = plain;
    for (int way = 0; way < plenty_.ways; ++way) {
      Found from = plain_;
      double before = plain;
      int idle = 0;
      for (int i = 0; i < plenty_.steps && idle < plenty_.idle; ++i) {
        const Step step = this->step(from, static_cast<uint64_t>(way * plenty_.steps + i));
        from = step.last;
        idle = step.best_cost < before - kGain ? 0 : idle + 1;
        before = std::min(before, step.best_cost);
        if (!(step.best_cost < best - kGain)) continue;
        ir::Module made = module_;
        replaceFragment(made, step.best.plan, constants_);
        // Nothing of a loop's body may stand for what is the same outside of it.
        if (made.dag.hasLoops() && !ir::verify(made).empty()) continue;
        // What the plan's ranges promise the module's must keep.
        if (!Proved(made).keeps(proved)) continue;
        best = step.best_cost;
        all.push_back({std::move(made), {plain, best, step.growth}});
      }
    }
    all.front().outcome = {plain, plain, 1};
    // The last ones are the best by the model.
    if (all.size() > kMostCandidates)
      all.erase(all.begin() + 1, all.end() - static_cast<ptrdiff_t>(kMostCandidates - 1));
    return all;
  }

private:
  static constexpr double kGain = 0.01;  // less is a matter of how many operations there are
  static constexpr size_t kMostCandidates = 12;

  struct Step {
    Found best, last;
    double best_cost = 0, growth = 1;
  };

  /// What the analyses have no value for follows from the operands.
  void fill() {
    const analysis::RangeMath floats(analysis::Arithmetic::Vulkan);
    const analysis::RangeMath reals(analysis::Arithmetic::Real);
    for (Ref at = 0; at < plain_.plan.nodes.size(); ++at) {
      if (plain_.known[at]) continue;
      const Node& node = plain_.plan.nodes[at];
      const auto ranges = [&](const analysis::RangeMath& math, auto of) {
        std::array<Known, 4> operands{};
        for (size_t k = 0; k < node.count; ++k)
          operands[k] = {plain_.plan.nodes[node.args[k]].type, &of(node.args[k])};
        return rangesOf(math, node, {operands.data(), node.count}, constants_, least_lights_, most_lights_);
      };
      natural_[at] = ranges(floats, [&](Ref k) -> const Ranges& { return natural_[k]; });
      plain_.facts[at].real = ranges(reals, [&](Ref k) -> const Ranges& { return plain_.facts[k].real; });
      plain_.facts[at].lit = ranges(floats, [&](Ref k) -> const Ranges& { return plain_.facts[k].lit; });
    }
  }

  static Found foundOf(const EGraph& graph, const Selection& selection) {
    Found found;
    found.plan = selection.plan;
    found.known.assign(selection.classes.size(), true);
    for (const Ref id : selection.classes) found.facts.push_back(graph[id].facts);
    return found;
  }

  /// One graph, and the way through it.
  Step step(const Found& from, uint64_t number) {
    EGraph graph(constants_, least_lights_, most_lights_, plenty_.nodes);
    std::map<ValueId, Ref> origins;
    std::vector<Ref> plain_classes = seed(graph, plain_, origins);
    std::vector<Ref> classes = seed(graph, from, origins);
    const Taste& taste = kTastes[number % std::size(kTastes)];
    saturate(graph, {4, plenty_.matches, taste.left_out, number});
    for (Ref& id : classes) id = graph.find(id);
    for (Ref& id : plain_classes) id = graph.find(id);
    std::vector<Ref> roots;
    for (const Ref root : plain_.plan.roots) roots.push_back(plain_classes[root]);

    const Bounds bounds = boundsOf(plain_.plan, plain_classes, graph, most_lights_);
    Safety safety(graph, module_.dag, plain_.plan, plain_classes, natural_,
                  nodesOf(graph, plain_.plan, plain_classes), least_lights_, most_lights_);
    Points points(graph, plain_.plan, plain_classes);
    const auto growthOf = [&](const Selection& selection) {
      const Bounds now = boundsOf(selection.plan, selection.classes, graph, most_lights_, &bounds);
      return std::max(growth(now, bounds), points.growth(selection.plan, selection.classes));
    };
    const auto allowed = [&](const Selection& selection) {
      return safety.keeps(selection.plan, selection.classes, selection.nodes) &&
             growthOf(selection) < kGrowth;
    };
    Extractor extractor(graph, module_, family_, roots, nodesOf(graph, from.plan, classes));
    Step step;
    Effort effort;
    effort.slack = taste.slack;
    extractor.improve(effort, allowed);
    extractor.wander(plenty_.wander, taste.heat, taste.slack, number + 1, allowed);
    extractor.improve(effort, allowed);
    step.best = foundOf(graph, extractor.selection());
    step.best_cost = extractor.selection().cost;
    step.last = foundOf(graph, extractor.current());
    step.growth = std::max(1.0, growthOf(extractor.selection()));
    return step;
  }

  const ir::Module& module_;
  const Family& family_;
  Plenty plenty_;
  Constants constants_;
  double least_lights_ = 0, most_lights_ = 1;
  Found plain_;
  std::vector<Ranges> natural_;  ///< of the plain plan's nodes
};

}  // namespace

std::vector<Candidate> search(const ir::Module& module, const Settings& settings) {
  return Search(module, settings).run();
}

}  // namespace lacquer::optimize
