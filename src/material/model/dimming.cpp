#include "model/dimming.h"

#include <algorithm>
#include <utility>

#include "model/names.h"

namespace lacquer::model {

using lang::either;
using lang::Scaling;

Dimming::Dimming(const Model& model, std::function<bool(uint32_t part)> counts)
    : model_(model), counts_(std::move(counts)) {}

bool Model::scales(uint32_t line) const {
  std::call_once(found_scales->asked, [this] {
    std::vector<bool>& of_line = found_scales->of_line;
    of_line.resize(lines.size());
    Dimming dimming(*this, [](uint32_t) { return true; });
    for (const Out& out : outs) {
      for (const uint32_t index : out.lines) of_line[index] = out.dimmed && dimming.scales(index);
    }
  });
  return found_scales->of_line[line];
}

bool Dimming::there(const Line& line) const { return line.part >= model_.parts.size() || counts_(line.part); }

bool Dimming::scales(uint32_t index) {
  const Scaling all = line(index, {});
  return all == Scaling::Scaled || all == Scaling::Zero;
}

Scaling Dimming::line(uint32_t index, std::string_view path) {
  // Lines that need each other are an error where they are used; until then nothing is known of them.
  const auto [it, fresh] = lines_.try_emplace({index, path}, Scaling::Other);
  if (!fresh) return it->second;
  const Line& line = model_.lines[index];
  Scaling all = Scaling::Zero;
  for (const Alternative& one : line.alternatives) all = either(all, value(one.value, path, line.part));
  return lines_[{index, path}] = all;
}

Scaling Dimming::value(const Value& value, std::string_view path, uint32_t part) {
  switch (value.kind) {
    case Value::Kind::None: return Scaling::Zero;
    case Value::Kind::Constant: return lang::scalingOf(value.constant);
    case Value::Kind::Role:
    case Value::Kind::Given: return Scaling::Fixed;
    case Value::Kind::Id: return id(value, value.path.empty() ? path : value.path, part);
    case Value::Kind::Below: return below(value, value.path.empty() ? path : value.path, part);
    case Value::Kind::Call: return call(value, path, part);
  }
  return Scaling::Other;
}

/// With all that could stand in its place for a line of that part.
Scaling Dimming::id(const Value& value, std::string_view path, uint32_t part) {
  const Id& id = model_.ids[value.index];
  if (id.light) return Scaling::Scaled;
  Scaling all = Scaling::Zero;
  for (const uint32_t index : id.lines) {
    if (there(model_.lines[index])) all = either(all, line(index, path));
  }
  const auto names = [&](uint32_t index) {
    const std::string_view target = model_.lines[index].target.path;
    return target.empty() || target == path;
  };
  // A part that replaces a value sees what the parts below it have put there.
  const bool own = std::any_of(id.replaced.begin(), id.replaced.end(),
                               [&](uint32_t i) { return model_.lines[i].part == part && names(i); });
  for (const uint32_t index : id.replaced) {
    const Line& other = model_.lines[index];
    if (!names(index) || (own && other.part >= part) || !there(other)) continue;
    all = either(all, line(index, other.target.path.empty() ? path : std::string_view{}));
  }
  return all;
}

Scaling Dimming::below(const Value& value, std::string_view path, uint32_t part) {
  const Out& out = model_.outs[value.index];
  if (out.dimmed) return Scaling::Scaled;
  Scaling all = Scaling::Zero;
  for (const uint32_t index : out.lines) {
    if (model_.lines[index].part < part && there(model_.lines[index])) all = either(all, line(index, path));
  }
  return all;
}

Scaling Dimming::call(const Value& value, std::string_view path, uint32_t part) {
  // What a line calls has its bodies once it is asked for them.
  const lang::NodeDecl& node = **model_.library->node(model_.nodes[value.index].name());
  std::vector<Scaling> args;
  for (size_t i = 0; i < value.args.size(); ++i) {
    const lang::Param& param = node.params[i];
    // What comes to nothing is the default.
    Scaling arg = Scaling::Zero;
    if (param.hasDefault()) arg = lang::scalingOf(param);
    if (!value.args[i].absent) {
      const Scaling given = this->value(value.args[i], {}, part);
      arg = param.hasDefault() ? either(arg, given) : given;
    }
    args.push_back(arg);
  }
  const std::vector<Scaling>& results = nodes_.of(node, value.variant, args);
  const std::string_view head = path.substr(0, path.find('.'));
  for (size_t i = 0; i < results.size(); ++i) {
    if (!head.empty() && node.results[i].name == head) return results[i];
  }
  // A name of no output, and a whole node of several, come to nothing.
  const bool whole = results.size() == 1 && (path.empty() || isSwizzle(path));
  return whole ? results[0] : Scaling::Zero;
}

}  // namespace lacquer::model
