#include "prove/nodes.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/refine.h"
#include "interface/proofs.h"

namespace lacquer {

namespace {

using analysis::Arithmetic;
using ir::ValueId;

/// A contract's range is that of the exact function. Facts about rounded numbers (a cosine of at
/// most 1.000001) come into it, so that an end may be passed by this part of it. An end of 0 may not.
constexpr double kContractSlack = 1e-5;

bool open(const ir::Interval& range) { return std::isinf(range.lo) && std::isinf(range.hi); }

ir::Interval loosened(const ir::Interval& range) {
  return {range.lo - kContractSlack * std::abs(range.lo), range.hi + kContractSlack * std::abs(range.hi)};
}

/// That a value of the exact function lies in a range.
Claim claimOf(const ir::Module& module, const analysis::Intervals& exact, ValueId value,
              const ir::Interval& range, std::string what, int budget) {
  Claim claim{std::move(what), rangeText(range), {}, true};
  const analysis::Range all = exact.all(value);
  const ir::Interval allowed = loosened(range);
  for (int c = 0; c < ir::componentCount(module.dag[value].type); ++c) {
    const analysis::Range& reached = exact.at(value, c);
    const bool simple = reached.lo >= allowed.lo && reached.hi <= allowed.hi && !reached.nan;
    analysis::RefineOptions refine;
    refine.budget = budget;
    claim.proved &= simple || analysis::proveWithin(module, value, c, allowed, refine);
  }
  claim.reached = reachedOf(claim.proved ? meet(all, {range.lo, range.hi, false}) : all);
  return claim;
}

ValueId parameterInput(ir::Module& module, const lang::Param& param, ir::Rate rate) {
  const std::string name(param.name);
  if (ir::isTexture(param.type)) {
    ir::TextureSlot slot;
    slot.name = name;
    slot.type = param.type;
    // A cube map is an environment: nothing is known of what it holds.
    slot.environment = param.type == ir::Type::TextureCube;
    const auto index = static_cast<uint32_t>(module.textures.size());
    module.textures.push_back(slot);
    return module.dag.input({ir::InputKind::Texture, name, param.type, ir::Rate::Frame, {0, 1}, 0, index});
  }
  ir::Range range = param.range;
  if (param.type == ir::Type::Bool) range = {{0, 1}, 0};
  const auto index = static_cast<uint32_t>(module.parameters.size());
  module.parameters.push_back({name, param.type, {}, range, {}});
  return module.dag.input({ir::InputKind::Parameter, name, param.type, rate, range, 0, index});
}

Claim operationClaim(const ir::Module& module, const analysis::Proof& proof, const std::string& operand,
                     Arithmetic arithmetic) {
  Claim claim{fmt::format("{} of {}", ir::info(module.dag[proof.id].op).name, operand),
              std::string(proof.need), reachedOf(proof.reached), proof.safe};
  if (claim.proved) return claim;
  // One evaluation may not see it; the same on pieces of the ranges may.
  analysis::RefineOptions refine;
  refine.arithmetic = arithmetic;
  refine.computed_inputs = true;
  refine.budget = 4000;
  const double least = std::max(1e-30, analysis::RangeMath(arithmetic).least());
  ir::Interval wanted;
  if (proof.need == ">= 0")
    wanted.lo = 0;
  else if (proof.need == "> 0" || proof.need == "!= 0")
    wanted.lo = least;
  else
    return claim;
  claim.proved = true;
  for (int c = 0; c < ir::componentCount(module.dag[proof.operand].type); ++c) {
    claim.proved &= analysis::proveWithin(module, proof.operand, c, wanted, refine);
  }
  return claim;
}

}  // namespace

std::string rangeText(const ir::Interval& range) { return fmt::format("in [{}, {}]", range.lo, range.hi); }

NodeModule nodeModule(const lang::NodeDecl& node, std::string_view variant, ir::Rate rate) {
  NodeModule result;
  std::vector<ValueId> arguments;
  for (const lang::Param& param : node.params)
    arguments.push_back(parameterInput(result.module, param, rate));
  bool outermost = true;
  lower::Inliner inliner(result.module.dag, [&](const lang::NodeDecl& callee, std::span<const ValueId> args) {
    if (!std::exchange(outermost, false)) result.calls.push_back({&callee, {args.begin(), args.end()}});
  });
  inliner.sumOverOne();
  const lower::Values results = inliner.call(node, variant, arguments);
  const auto put = [&](std::string name, ValueId value) {
    const auto place = static_cast<uint32_t>(result.module.outputs.size());
    result.module.outputs.push_back(
        {ir::OutputKind::Color, ir::Stage::Fragment, std::move(name), place, value});
  };
  for (size_t i = 0; i < results.size(); ++i) {
    const std::string name(node.results[i].name);
    const uint32_t outputs = outputCount(node.results[i].type);
    if (outputs == 1) put(name, results[i]);
    for (uint32_t k = 0; outputs > 1 && k < outputs; ++k)
      put(fmt::format("{}[{}]", name, k), result.module.dag.column(results[i], k));
  }
  return result;
}

uint32_t outputCount(ir::Type type) { return type == ir::Type::Mat3 ? 3 : type == ir::Type::Mat4 ? 4 : 1; }

void proveCall(const ir::Module& module, const NodeModule::Call& call, int budget,
               std::vector<Claim>& claims) {
  analysis::Intervals exact(module, {Arithmetic::Real, analysis::kSceneLimit});
  exact.run(ir::reachable(module.dag, call.arguments));
  for (size_t i = 0; i < call.arguments.size(); ++i) {
    const lang::Param& param = call.node->params[i];
    if (open(param.range) || !ir::isFloating(param.type)) continue;
    claims.push_back(claimOf(module, exact, call.arguments[i], param.range,
                             fmt::format("{}.{}", call.node->name, param.name), budget));
  }
}

namespace {

/// Whether both compute the same, but for the rate of what goes in.
bool sameOperations(const ir::Dag& a, const ir::Dag& b) {
  if (a.size() != b.size()) return false;
  for (ValueId id = 0; id < a.size(); ++id) {
    const auto args = a[id].operands();
    const auto others = b[id].operands();
    if (a[id].op != b[id].op || a[id].type != b[id].type ||
        !std::equal(args.begin(), args.end(), others.begin(), others.end()))
      return false;
    if (a.isConstant(id) && a.constantOf(id) != b.constantOf(id)) return false;
  }
  return true;
}

void proveModule(const lang::NodeDecl& node, const NodeModule& made, Arithmetic arithmetic,
                 NodeProof& proof) {
  const ir::Module& module = made.module;
  const std::vector<analysis::Proof> operations =
      analysis::prove(module, {arithmetic, analysis::kSceneLimit, true}).operations;
  const std::vector<std::string> operands = operandTexts(module, operations);
  for (size_t i = 0; i < operands.size(); ++i)
    proof.operations.push_back(operationClaim(module, operations[i], operands[i], arithmetic));
  analysis::Intervals exact(module, {Arithmetic::Real});
  exact.run();
  size_t output = 0;
  for (const lang::Param& result : node.results) {
    const ValueId value = module.outputs[output].value;
    output += outputCount(result.type);
    if (open(result.range) || !ir::isFloating(result.type)) continue;
    const std::string what = result.name.empty() ? "the result" : fmt::format("the result {}", result.name);
    proof.results.push_back(claimOf(module, exact, value, result.range, what, 20000));
  }
  for (const NodeModule::Call& call : made.calls) proveCall(module, call, 20000, proof.calls);
}

}  // namespace

NodeProof proveNode(const lang::NodeDecl& node, std::string_view variant, Arithmetic arithmetic) {
  NodeProof proof{std::string(node.name), std::string(variant), {}, {}, {}};
  const NodeModule made = nodeModule(node, variant);
  proveModule(node, made, arithmetic, proof);
  // `uniform(x)` chooses another body where nothing changes from pixel to pixel.
  const NodeModule even = nodeModule(node, variant, ir::Rate::Material);
  if (!sameOperations(made.module.dag, even.module.dag)) proveModule(node, even, arithmetic, proof);
  return proof;
}

std::vector<NodeProof> proveNodes(const lang::Library& library, Arithmetic arithmetic) {
  std::vector<NodeProof> proofs;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const lang::NodeDecl& node = **library.node(name);
    proofs.push_back(proveNode(node, {}, arithmetic));
    for (const lang::Variant& variant : node.variants)
      proofs.push_back(proveNode(node, variant.name, arithmetic));
  }
  return proofs;
}

}  // namespace lacquer
