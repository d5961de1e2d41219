#include "model/thresholds.h"

#include <algorithm>
#include <tuple>

namespace lacquer::model {

namespace {

class Collector {
public:
  explicit Collector(const Model& model) : model_(model) {}

  void add(const Condition& condition, bool whole_part) {
    for (const Condition& inner : condition.conditions) add(inner, whole_part);
    if (condition.kind != Condition::Kind::Equal || !condition.name.empty()) return;
    const Value& value = condition.values[0];
    for (const uint16_t property : model_.roles[value.index].providers) {
      if (model_.schema->properties[property].decl->kind == material::Kind::Bool) continue;
      found_.push_back({property, value.member, condition.constant, whole_part});
    }
  }

  std::vector<Threshold> take() {
    const auto key = [](const Threshold& t) { return std::tie(t.property, t.member, t.at); };
    std::stable_sort(found_.begin(), found_.end(),
                     [&](const Threshold& a, const Threshold& b) { return key(a) < key(b); });
    std::vector<Threshold> all;
    for (const Threshold& one : found_) {
      if (all.empty() || key(all.back()) != key(one)) all.push_back(one);
      all.back().whole_part = all.back().whole_part || one.whole_part;
    }
    return all;
  }

private:
  const Model& model_;
  std::vector<Threshold> found_;
};

bool readsBelow(const Value& value) {
  return value.kind == Value::Kind::Below || std::any_of(value.args.begin(), value.args.end(), readsBelow);
}

}  // namespace

std::vector<Threshold> thresholds(const Model& model) {
  Collector collector(model);
  for (const Term& term : model.terms) {
    const bool whole = term.parent == Line::kNone && !model.parts[term.part].of.empty();
    collector.add(term.when, whole);
    collector.add(term.unless, whole);
  }
  for (const Line& line : model.lines) {
    for (const Alternative& one : line.alternatives) collector.add(one.condition, false);
  }
  return collector.take();
}

bool isLayer(const Model& model, uint16_t extension) {
  return std::any_of(model.lines.begin(), model.lines.end(), [&](const Line& line) {
    if (line.part >= model.parts.size()) return false;
    const std::vector<uint16_t>& of = model.parts[line.part].of;
    if (std::find(of.begin(), of.end(), extension) == of.end()) return false;
    return std::any_of(line.alternatives.begin(), line.alternatives.end(),
                       [](const Alternative& one) { return readsBelow(one.value); });
  });
}

}  // namespace lacquer::model
