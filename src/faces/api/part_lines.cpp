#include "api/part_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ir/dag.h"
#include "lang/builtins.h"

namespace lacquer {

namespace {

using lang::Expr;
using lang::Statement;

constexpr std::string_view kChannels = "rgba";

/// The channels that a body reads of one sampler's texels.
class TexelReads {
public:
  explicit TexelReads(size_t sampler) : sampler_(sampler) {}

  void statements(const std::vector<Statement>& list) {
    for (const Statement& statement : list) {
      for (const lang::ExprPtr& value : statement.values) {
        if (!value) continue;
        if (statement.kind == Statement::Kind::Let && lookup(*value)) texels_.insert(statement.slot);
        if (statement.kind == Statement::Kind::Return && isTexel(*value)) read_ = {0, 1, 2, 3};
        expression(*value);
      }
      statements(statement.body);
      statements(statement.otherwise);
    }
  }

  std::string letters() const {
    std::string text;
    for (const int channel : read_) text += kChannels[static_cast<size_t>(channel)];
    return text;
  }

private:
  bool lookup(const Expr& expr) const {
    return expr.kind == Expr::Kind::Operation && expr.builtin != nullptr &&
           ir::readsTexture(expr.builtin->op) && expr.args[0] && expr.args[0]->kind == Expr::Kind::Slot &&
           expr.args[0]->slot == sampler_;
  }
  bool isTexel(const Expr& expr) const {
    return lookup(expr) || (expr.kind == Expr::Kind::Slot && texels_.contains(expr.slot));
  }
  void expression(const Expr& expr) {
    if (expr.kind == Expr::Kind::Swizzle && isTexel(*expr.args[0]))
      read_.insert(expr.components.begin(), expr.components.end());
    for (const lang::ExprPtr& arg : expr.args) {
      if (arg) expression(*arg);
    }
  }

  size_t sampler_;
  std::set<uint32_t> texels_;  ///< locals that are a texel
  std::set<int> read_;
};

}  // namespace

std::string channelsRead(const lang::NodeDecl& node, size_t slot) {
  TexelReads reads(slot);
  reads.statements(node.body.statements);
  return reads.letters();
}

std::string undeclaredChannels(const model::Model& model, const model::Value& value) {
  if (value.kind != model::Value::Kind::Call) return {};
  for (size_t i = 0; i < value.args.size(); ++i) {
    const model::Value& arg = value.args[i];
    if (arg.kind != model::Value::Kind::Role || !arg.image) continue;
    const lang::PropertyDecl& texture = *model.schema->properties[model.roles[arg.index].providers[0]].decl;
    if (texture.channels.empty()) continue;
    const lang::NodeDecl& node = model.nodeOf(value);
    std::string beyond = channelsRead(node, i);
    std::erase_if(beyond,
                  [&](char letter) { return texture.channels.find(letter) != std::string_view::npos; });
    if (beyond.empty()) continue;
    return fmt::format("'{}' has the channels {}, and '{}' reads {} of it", texture.name, texture.channels,
                       node.name, beyond);
  }
  return {};
}

std::string neverEqual(const model::Model& model, const model::Condition& condition) {
  for (const model::Condition& inner : condition.conditions) {
    if (std::string found = neverEqual(model, inner); !found.empty()) return found;
  }
  if (condition.kind != model::Condition::Kind::Equal || !condition.name.empty()) return {};
  const model::Value& asked = condition.values[0];
  if (asked.kind != model::Value::Kind::Role) return {};
  const lang::PropertyDecl* decl = model.schema->properties[model.roles[asked.index].providers[0]].decl;
  if (asked.member >= 0) decl = &decl->members[static_cast<size_t>(asked.member)];
  for (int c = 0; c < ir::componentCount(decl->type); ++c) {
    const double x = condition.constant[static_cast<size_t>(c)];
    if (decl->has_range && !decl->range.contains(x))
      return fmt::format("'{}' is compared with {}, which is not in its range {}", decl->name, x,
                         ir::rangeText(decl->range));
  }
  return {};
}

}  // namespace lacquer
