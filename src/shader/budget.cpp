#include "shader/budget.h"

#include <algorithm>

namespace lacquer {

namespace {

constexpr VariantRow kTable[] = {
#include "shader/variants.def"
};

/// The IORs of base and coat are the numbers 1.5, not editable and not another.
bool fixedIor(const graph::Graph& graph) {
  return std::all_of(graph.nodes.begin(), graph.nodes.end(), [](const graph::Node& node) {
    return std::all_of(node.inputs.begin(), node.inputs.end(), [](const auto& input) {
      if (input.first != "ior") return true;
      const auto* literal = std::get_if<graph::Literal>(&input.second.from);
      return literal != nullptr && literal->value[0] == 1.5;
    });
  });
}

double errorOf(const VariantRow& row, bool fixed) { return fixed ? row.ior_1_5 : row.any_ior; }

/// The choices, by node type. Exhaustive, less what cannot come out better: there are few.
class Choice {
public:
  Choice(std::vector<std::vector<const VariantRow*>> options, bool fixed, double budget)
      : options_(std::move(options)), fixed_(fixed), budget_(budget) {}

  std::vector<const VariantRow*> run() {
    std::vector<const VariantRow*> taken;
    visit(0, taken, 0, 0);
    return best_;
  }

private:
  double bestLeft(size_t from) const {
    double saved = 0;
    for (size_t i = from; i < options_.size(); ++i) {
      double most = 0;
      for (const VariantRow* row : options_[i]) most = std::max(most, row->saved);
      saved += most;
    }
    return saved;
  }

  void visit(size_t i, std::vector<const VariantRow*>& taken, double error, double saved) {
    if (i == options_.size()) {
      if (saved < saved_ || (saved == saved_ && error >= error_)) return;
      best_ = taken;
      saved_ = saved;
      error_ = error;
      return;
    }
    if (saved + bestLeft(i) < saved_) return;
    for (const VariantRow* row : options_[i]) {
      const double with = combined(error, errorOf(*row, fixed_));
      if (with > budget_) continue;
      taken.push_back(row);
      visit(i + 1, taken, with, saved + row->saved);
      taken.pop_back();
    }
    visit(i + 1, taken, error, saved);
  }

  std::vector<std::vector<const VariantRow*>> options_;
  bool fixed_;
  double budget_;
  std::vector<const VariantRow*> best_;
  double saved_ = 0, error_ = 0;
};

}  // namespace

std::span<const VariantRow> variantTable() { return kTable; }

void applyBudget(graph::Graph& graph, double budget) {
  if (!(budget > 0)) return;
  const bool fixed = fixedIor(graph);
  std::vector<std::vector<const VariantRow*>> options;
  for (const VariantRow& row : variantTable()) {
    const bool used = std::any_of(graph.nodes.begin(), graph.nodes.end(), [&](const graph::Node& node) {
      return node.type == row.node && node.variant.empty();
    });
    if (!used || errorOf(row, fixed) > budget) continue;
    if (options.empty() || options.back()[0]->node != row.node) options.emplace_back();
    options.back().push_back(&row);
  }
  for (const VariantRow* row : Choice(std::move(options), fixed, budget).run()) {
    for (graph::Node& node : graph.nodes) {
      if (node.type == row->node && node.variant.empty()) node.variant = row->variant;
    }
  }
}

std::vector<MaterialTerms::Variant> variantsOf(const graph::Graph& graph) {
  std::vector<MaterialTerms::Variant> variants;
  const bool fixed = fixedIor(graph);
  for (const VariantRow& row : variantTable()) {
    MaterialTerms::Variant variant{
        std::string(row.node), std::string(row.variant), {}, errorOf(row, fixed), row.saved};
    for (const graph::Node& node : graph.nodes) {
      if (node.type == row.node && node.variant == row.variant) variant.terms.push_back(node.id);
    }
    if (!variant.terms.empty()) variants.push_back(std::move(variant));
  }
  return variants;
}

double expectedError(const std::vector<MaterialTerms::Variant>& variants) {
  double error = 0;
  for (const MaterialTerms::Variant& variant : variants) error = combined(error, variant.error);
  return error;
}

}  // namespace lacquer
