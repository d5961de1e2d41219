#include "optimize/optimize.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <tuple>

#include "optimize/approximate.h"
#include "optimize/extract.h"
#include "optimize/facts.h"
#include "optimize/points.h"
#include "optimize/rules.h"
#include "optimize/safety.h"

namespace lacquer::optimize {

namespace {

using ir::ValueId;

std::atomic<size_t> modules_searched{0};

/// Nothing may have an error twice that of the plain form.
constexpr double kGrowth = 2;
constexpr double kCheaper = 0.01;  // cycles; less is a matter of how many operations there are

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

/// How much a level looks at.
struct Plenty {
  size_t nodes;    ///< of a graph
  int ways;        ///< from the plain form
  int steps;       ///< of a way: graphs, each from where the one before it has ended
  int idle;        ///< steps that find nothing, behind which there is no other
  size_t wander;   ///< plans by chance in each of them
  size_t matches;  ///< of one rule in a round of its graph
  int rounds;      ///< of a graph's growth
};
constexpr Plenty kPlenty[] = {{16000, 1, 8, 3, 2000, 16000, 5}, {40000, 3, 8, 4, 6000, 40000, 6}};

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
    Plain plain = plainOf(module, constants_);
    plain_ = std::move(plain.found);
    natural_ = std::move(plain.natural);
    least_lights_ = plain.least_lights;
    most_lights_ = plain.most_lights;
  }

  std::vector<Candidate> run() {
    std::vector<Candidate> all;
    all.push_back({module_, {}});
    const Proved proved(module_);
    const size_t faults = ir::verify(module_).size();
    Counter counter(module_);
    const double plain = planCost(counter, plain_.plan, constants_, family_);
    double best = plain;
    // The search drops clamps that are idle in real arithmetic alone, until a proof is lost by that.
    bool floats = false;
    for (int way = 0; way < plenty_.ways; ++way) {
      Found from = plain_;
      Found kept = plain_;
      double before = plain;
      int idle = 0;
      for (int i = 0; i < plenty_.steps && idle < plenty_.idle; ++i) {
        const Step step = this->step(from, static_cast<uint64_t>(way * plenty_.steps + i), floats);
        from = step.last;
        idle = step.best_cost < before - kCheaper ? 0 : idle + 1;
        before = std::min(before, step.best_cost);
        if (!(step.best_cost < best - kCheaper) || !(step.growth < kGrowth)) continue;
        ir::Module made = module_;
        replaceFragment(made, step.best.plan, constants_);
        // Nothing of a loop's body may stand for what is the same outside of it.
        if (made.dag.hasLoops() && ir::verify(made).size() > faults) continue;
        // What the plan's ranges promise the module's must keep.
        if (!Proved(made).keeps(proved)) {
          if (!floats) from = kept, before = best, idle = 0;
          floats = true;
          continue;
        }
        kept = step.last;
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
  static constexpr size_t kMostCandidates = 12;

  struct Step {
    Found best, last;
    double best_cost = 0, growth = 1;
  };

  static Found foundOf(const EGraph& graph, const Selection& selection) {
    Found found;
    found.plan = selection.plan;
    found.known.assign(selection.classes.size(), true);
    for (const Ref id : selection.classes) found.facts.push_back(graph[id].facts);
    return found;
  }

  /// One graph, and the way through it.
  Step step(const Found& from, uint64_t number, bool floats) {
    EGraph graph(constants_, least_lights_, most_lights_, plenty_.nodes);
    std::map<ValueId, Ref> origins;
    std::vector<Ref> plain_classes = seed(graph, plain_, origins);
    std::vector<Ref> classes = seed(graph, from, origins);
    const Taste& taste = kTastes[number % std::size(kTastes)];
    saturate(graph, {plenty_.rounds, plenty_.matches, taste.left_out, number, floats});
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

/// The forms of a level and of the levels below it: by a driver's count a form that the model takes for
/// dearer may be the cheapest.
std::vector<Candidate> equalForms(const ir::Module& module, Settings settings) {
  std::vector<Candidate> all = Search(module, settings).run();
  if (settings.level < 2) return all;
  settings.level = 1;
  std::vector<Candidate> fewer = Search(module, settings).run();
  all.insert(all.end(), std::make_move_iterator(fewer.begin() + 1), std::make_move_iterator(fewer.end()));
  std::stable_sort(all.begin() + 1, all.end(), [](const Candidate& a, const Candidate& b) {
    return a.outcome.cycles > b.outcome.cycles;
  });
  return all;
}

}  // namespace

bool searches() { return true; }
size_t searched() { return modules_searched; }

std::vector<Candidate> search(const ir::Module& module, const Settings& settings) {
  ++modules_searched;
  std::vector<Candidate> all = equalForms(module, settings);
  if (settings.level < 2 || !(settings.error > 0)) return all;
  const Family& family = settings.family != nullptr ? *settings.family : families()[0];
  const double plain = all.front().outcome.cycles;
  const auto take = [&](ir::Module form, Outcome outcome) {
    outcome.plain = plain;
    if (outcome.cycles < all.back().outcome.cycles - kCheaper) all.push_back({std::move(form), outcome});
  };
  // Before the search, which makes the best of what approximations leave, and behind it.
  const Candidate exact = all.back();
  if (std::optional<Approximated> made = approximate(exact.module, family, settings.error))
    take(std::move(made->module), {plain, made->cycles, exact.outcome.growth, made->error, made->count});
  if (const std::optional<Approximated> made = approximate(module, family, settings.error)) {
    for (Candidate& candidate : Search(made->module, settings).run()) {
      candidate.outcome.error = made->error;
      candidate.outcome.approximations = made->count;
      take(std::move(candidate.module), candidate.outcome);
    }
  }
  return all;
}

std::vector<Candidate> front(const ir::Module& module, const Settings& settings,
                             std::span<const double> errors, const std::function<void()>& tried) {
  const Family& family = settings.family != nullptr ? *settings.family : families()[0];
  std::vector<Candidate> all = equalForms(module, settings);
  const Candidate exact = std::move(all.back());
  std::vector<Candidate> front{exact};
  if (tried) tried();
  for (const double error : errors) {
    // Of the plain form other functions of one number are left than of the cheapest one.
    for (const ir::Module* from : {&exact.module, &module}) {
      std::optional<Approximated> made = approximate(*from, family, error);
      if (!made) continue;
      const Outcome& last = front.back().outcome;
      const bool closer = made->cycles < last.cycles + kCheaper && made->error < last.error;
      if (!(made->cycles < last.cycles - kCheaper) && !closer) continue;
      const double growth = from == &module ? 1 : exact.outcome.growth;
      const Outcome outcome{exact.outcome.plain, made->cycles, growth, made->error, made->count};
      // What is cheaper and off by less beats those before it.
      while (front.size() > 1 && front.back().outcome.error >= outcome.error) front.pop_back();
      front.push_back({std::move(made->module), outcome});
    }
    if (tried) tried();
  }
  return front;
}

}  // namespace lacquer::optimize
