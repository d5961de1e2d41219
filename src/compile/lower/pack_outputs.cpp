#include "lower/pack_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lacquer::lower {

namespace {

constexpr int kComponents = 4;

std::string componentName(std::string_view of, int components, int index) {
  if (components == 1) return std::string(of);
  return fmt::format("{}.{}", of, "xyzw"[index]);
}

/// The port's where the output is made of ports, and else the output's: "coat_normal.y", "coat_weight".
std::string nameOf(const lang::TemplateDecl& decl, const lang::OutputDecl& output, int index) {
  int at = 0;
  if (output.value->kind == lang::Expr::Kind::Construct) {
    for (const lang::ExprPtr& arg : output.value->args) {
      const int components = ir::componentCount(arg->type);
      const auto port = std::find_if(decl.ports.begin(), decl.ports.end(), [&](const lang::PortDecl& p) {
        return arg->kind == lang::Expr::Kind::Slot && p.slot == arg->slot;
      });
      if (index < at + components && port != decl.ports.end())
        return componentName(port->param.name, components, index - at);
      at += components;
      if (index < at) break;
    }
  }
  return componentName(output.name, ir::componentCount(output.type), index);
}

}  // namespace

bool packsOutputs(const lang::TemplateDecl& decl) {
  return std::count_if(decl.outputs.begin(), decl.outputs.end(), [](const lang::OutputDecl& output) {
           return output.role == lang::OutputRole::Color;
         }) > static_cast<std::ptrdiff_t>(ir::kMostColors);
}

void OutputPacker::add(const lang::OutputDecl& output, ir::ValueId value, ir::ValueId without) {
  const int components = ir::componentCount(output.type);
  for (int i = 0; i < components; ++i) {
    const ir::ValueId component = components == 1 ? value : dag_.component(value, i);
    if (component == (components == 1 ? without : dag_.component(without, i))) continue;
    components_.push_back({component, nameOf(decl_, output, i), &output});
  }
}

ir::Output OutputPacker::colorOf(size_t number) {
  ir::Output output{ir::OutputKind::Color, ir::Stage::Fragment,
                    fmt::format("{}{}", ir::kPackedPrefix, number), 0, ir::kNoValue};
  std::array<ir::ValueId, kComponents> values;
  values.fill(dag_.constant(0));
  for (size_t i = 0; i < kComponents && number * kComponents + i < components_.size(); ++i) {
    const Component& component = components_[number * kComponents + i];
    values[i] = component.value;
    output.holds.push_back(component.name);
  }
  output.value = dag_.construct(ir::Type::Vec4, values);
  return output;
}

Diagnostics OutputPacker::tooMany(uint32_t fixed) const {
  std::vector<std::string> counts;
  for (auto c = components_.begin(); c != components_.end();) {
    const auto end =
        std::find_if(c, components_.end(), [of = c->of](const Component& o) { return o.of != of; });
    counts.push_back(fmt::format("{} ({})", c->of->name, end - c));
    c = end;
  }
  return {{"over-limit",
           Severity::Error,
           {std::string(decl_.origin.file), decl_.origin.line, 0, {}},
           fmt::format(
               "the material has {} colour outputs in the template '{}': {} with something of it that are "
               "always there, and {} components of others",
               fixed + (components_.size() + kComponents - 1) / kComponents, decl_.name, fixed,
               components_.size()),
           fmt::format("no device has more than {0}. `template NAME extends {1} {{ without output ...; }}` "
                       "leaves some out; the material has components of {2}",
                       ir::kMostColors, decl_.name, fmt::join(counts, ", ")),
           {}}};
}

Diagnostics OutputPacker::finish(uint32_t first, std::vector<ir::Output>& outputs) {
  const size_t needed = (components_.size() + kComponents - 1) / kComponents;
  const size_t behind = std::min(needed, ir::kMostColors - std::min<size_t>(first, ir::kMostColors));
  if (needed - behind > idle_.size()) return tooMany(first - static_cast<uint32_t>(idle_.size()));
  for (size_t i = 0; i < behind; ++i) {
    outputs.push_back(colorOf(i));
    outputs.back().location = first + static_cast<uint32_t>(i);
  }
  for (size_t i = behind; i < needed; ++i) {
    const auto place = std::find_if(outputs.begin(), outputs.end(),
                                    [&](const ir::Output& o) { return o.name == idle_[i - behind]; });
    const uint32_t location = place->location;
    *place = colorOf(i);
    place->location = location;
  }
  return {};
}

}  // namespace lacquer::lower
