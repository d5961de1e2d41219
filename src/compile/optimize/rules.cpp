#include "optimize/rules.h"

#include <algorithm>
#include <array>

namespace lacquer::optimize {

using ir::Op;
using ir::Type;

namespace {

/// (x op y).xy = x.xy op y.xy
void swizzled(EGraph& graph, NodeId id, std::vector<Ref>& equal) {
  const Node swizzle = graph.node(id);
  if (swizzle.op != Op::Swizzle || swizzle.opaque()) return;
  const std::vector<NodeId> inner = graph[swizzle.args[0]].nodes;
  for (const NodeId of : inner) {
    const Node node = graph.node(of);
    if (node.opaque() || node.count == 0) continue;
    if (node.op == Op::Construct && node.count == 1) {
      equal.push_back(graph.as(swizzle.type, node.args[0]));
      continue;
    }
    constexpr std::array kThese{Op::Add, Op::Mul, Op::Neg,   Op::Div, Op::Abs,
                                Op::Max, Op::Min, Op::Clamp, Op::Sqrt};
    if (std::find(kThese.begin(), kThese.end(), node.op) == kThese.end()) continue;
    std::array<Ref, 4> args{};
    bool good = true;
    for (size_t k = 0; k < node.count; ++k) {
      const Class& operand = graph[node.args[k]];
      if (operand.type == Type::Float) {
        args[k] = node.args[k];
        continue;
      }
      Node part = swizzle;
      part.args[0] = node.args[k];
      part.rate = operand.rate;
      args[k] = graph.add(part);
      good = good && args[k] != kNoRef;
    }
    if (!good) continue;
    Ref made = kNoRef;
    if (node.count == 1) made = graph.make(node.op, {args[0]});
    if (node.count == 2) made = graph.make(node.op, {args[0], args[1]});
    if (node.count == 3) made = graph.make(node.op, {args[0], args[1], args[2]});
    equal.push_back(graph.as(swizzle.type, made));
  }
}

/// dot(a, b) + c = a.x * b.x + (a.y * b.y + (a.z * b.z + c)): the first product finds a sum, too.
void chained(EGraph& graph, NodeId id, std::vector<Ref>& equal) {
  const Node sum = graph.node(id);
  if (sum.op != Op::Add || sum.opaque() || sum.type != Type::Float) return;
  for (const size_t k : {size_t{0}, size_t{1}}) {
    const std::vector<NodeId> inner = graph[sum.args[k]].nodes;
    for (const NodeId of : inner) {
      const Node dot = graph.node(of);
      if (dot.op != Op::Dot || dot.opaque()) continue;
      Ref made = graph.find(sum.args[1 - k]);
      for (int c = graph.width(dot.args[0]); c-- > 0;) {
        const Ref a = graph.component(dot.args[0], c);
        const Ref b = graph.component(dot.args[1], c);
        made = graph.make(Op::Add, {graph.make(Op::Mul, {a, b}), made});
      }
      equal.push_back(made);
    }
  }
}

/// The direction of a lookup of a cube map has no length: a positive factor goes.
void directed(EGraph& graph, NodeId id, std::vector<Ref>& equal) {
  const Node lookup = graph.node(id);
  if (!lookup.opaque() || !ir::readsTexture(lookup.op) || lookup.op == Op::TextureGrad) return;
  if (graph[lookup.args[0]].type != Type::TextureCube) return;
  const std::vector<NodeId> inner = graph[lookup.args[1]].nodes;
  for (const NodeId of : inner) {
    const Node node = graph.node(of);
    if (node.opaque() || node.op != Op::Mul) continue;
    for (const size_t k : {size_t{0}, size_t{1}}) {
      const Ref factor = node.args[k];
      if (graph[factor].type != Type::Float || !(graph.range(factor, 0).lo > 0) || graph.range(factor, 0).nan)
        continue;
      Node without = lookup;
      without.args[1] = node.args[1 - k];
      equal.push_back(graph.add(without));
    }
  }
}

/// What does not change from light to light leaves their sum.
void summed(EGraph& graph, NodeId id, std::vector<Ref>& equal) {
  const Node sum = graph.node(id);
  if (sum.op != Op::SumOverLights || sum.opaque()) return;
  const auto over = [&](Ref term) {
    if (term == kNoRef) return kNoRef;
    Node node = sum;
    node.args[0] = term;
    node.type = graph[term].type;
    return graph.add(node);
  };
  const std::vector<NodeId> inner = graph[sum.args[0]].nodes;
  for (const NodeId of : inner) {
    const Node node = graph.node(of);
    if (node.opaque()) continue;
    if (node.op == Op::Mul) {
      for (const size_t k : {size_t{0}, size_t{1}}) {
        if (graph[node.args[k]].rate == ir::Rate::Light) continue;
        equal.push_back(graph.as(sum.type, graph.make(Op::Mul, {node.args[k], over(node.args[1 - k])})));
      }
    } else if (node.op == Op::Add && graph[node.args[0]].type == graph[node.args[1]].type) {
      const Ref first = over(node.args[0]);
      const Ref second = over(node.args[1]);
      equal.push_back(graph.make(Op::Add, {first, second}));
    }
  }
}

constexpr CodedRule kCoded[] = {
    {"swizzled", "(a + b).xy", "a.xy + b.xy", "what is not read of a vector is not computed", swizzled},
    {"chained", "dot(a, b) + c", "a.x * b.x + (a.y * b.y + (a.z * b.z + c))",
     "the sum takes the first product in", chained},
    {"directed", "texture(cube, a * s)", "texture(cube, a) for s > 0", "a direction has no length", directed},
    {"summed", "sum_over_lights(a * b + c)", "a * sum_over_lights(b) + sum_over_lights(c)",
     "what is the same for all lights is computed once", summed},
};

/// The nodes of a graph that rules may start at, by operation.
std::vector<std::vector<NodeId>> byOperation(const EGraph& graph) {
  std::vector<std::vector<NodeId>> lists(static_cast<size_t>(ir::kOpCount));
  for (NodeId id = 0; id < graph.nodeCount(); ++id) {
    // What costs nothing needs no other form.
    if (!graph.live(id) || graph[graph.classOf(id)].rate <= ir::Rate::Material) continue;
    lists[static_cast<size_t>(graph.node(id).op)].push_back(id);
  }
  return lists;
}

struct Found {
  uint32_t rule;
  NodeId node;
  Letters letters;
};

/// Whether a growth has a rule.
bool has(const Growth& growth, uint64_t rule) {
  uint64_t x = (growth.seed * 0x9E3779B97F4A7C15U) ^ ((rule + 1) * 0xC2B2AE3D27D4EB4FU);
  x = (x ^ x >> 29U) * 0x165667B19E3779F9U;
  return (x ^ x >> 32U) % 100 >= growth.left_out;
}

void applyTexts(EGraph& graph, const std::vector<std::vector<NodeId>>& nodes, const Growth& growth) {
  std::vector<Found> all;
  const std::span<const Rule> texts = rules();
  for (uint32_t r = 0; r < texts.size(); ++r) {
    const Rule& rule = texts[r];
    if (!has(growth, r)) continue;
    size_t count = 0;
    const Op op = rule.from.terms[rule.from.root].op;
    for (const NodeId id : nodes[static_cast<size_t>(op)]) {
      match(graph, rule.from, id, [&](const Letters& letters) {
        if (holds(graph, rule.when, letters, growth.floats)) all.push_back({r, id, letters}), ++count;
        return count < growth.matches;
      });
      if (count >= growth.matches) break;
    }
  }
  // What has been there for long comes first, by whichever rule: a graph that gets full has grown everywhere.
  std::stable_sort(all.begin(), all.end(), [](const Found& a, const Found& b) { return a.node < b.node; });
  for (const Found& found : all) {
    if (graph.full()) break;
    const Ref made = build(graph, texts[found.rule].to, found.letters);
    const Ref id = graph.classOf(found.node);
    graph.merge(id, graph.as(graph[id].type, made));
  }
}

void applyCoded(EGraph& graph, const std::vector<std::vector<NodeId>>& nodes) {
  std::vector<Ref> equal;
  for (const CodedRule& rule : kCoded) {
    for (const std::vector<NodeId>& list : nodes) {
      for (const NodeId id : list) {
        if (graph.full()) return;
        equal.clear();
        rule.apply(graph, id, equal);
        for (const Ref other : equal) graph.merge(graph.classOf(id), other);
      }
    }
  }
}

}  // namespace

std::span<const Rule> rules() {
  static const std::vector<Rule> all = {
#define RULE(name, from, to, conditions, why) ruleOf(#name, from, to, conditions, why),
#include "optimize/rules.def"
#undef RULE
  };
  return all;
}

std::span<const CodedRule> codedRules() { return kCoded; }

void saturate(EGraph& graph, const Growth& growth) {
  for (int round = 0; round < growth.rounds && !graph.full(); ++round) {
    const size_t before = graph.nodeCount();
    const std::vector<std::vector<NodeId>> nodes = byOperation(graph);
    applyTexts(graph, nodes, growth);
    applyCoded(graph, nodes);
    graph.rebuild();
    if (graph.nodeCount() == before) break;
  }
}

}  // namespace lacquer::optimize
