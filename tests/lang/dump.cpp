#include "lang/dump.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacquer::test {
namespace {

using lang::DeclKind;

std::string dumpNumbers(ir::Type type, const ir::Components& value) {
  if (type == ir::Type::Bool) return value[0] != 0 ? "true" : "false";
  std::string text;
  for (int i = 0; i < ir::componentCount(type); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", value[static_cast<size_t>(i)]);
  }
  return ir::isFloatVector(type) ? fmt::format("{}({})", ir::typeName(type), text) : text;
}

std::string dumpParam(const lang::Param& param) {
  std::string text(ir::typeName(param.type));
  if (!param.name.empty()) text += fmt::format(" {}", param.name);
  if (param.has_range) text += " in " + ir::rangeText(param.range);
  if (param.default_value) text += fmt::format(" = {}", dumpNumbers(param.type, *param.default_value));
  if (!param.prose.empty()) text += fmt::format("  // {}", param.prose);
  return text;
}

std::string dumpDoc(std::string_view doc) {
  std::string text;
  while (!doc.empty()) {
    const size_t end = std::min(doc.find('\n'), doc.size());
    text += fmt::format("  /// {}\n", doc.substr(0, end));
    doc.remove_prefix(std::min(end + 1, doc.size()));
  }
  return text;
}

std::string dumpNode(const lang::NodeDecl& node) {
  std::string text = fmt::format("node {} ({}:{})\n", node.name, node.origin.file, node.origin.line);
  text += dumpDoc(node.doc) + fmt::format("  source {}\n", node.source);
  for (const lang::Param& param : node.params) text += fmt::format("  takes {}\n", dumpParam(param));
  for (const lang::Param& result : node.results) text += fmt::format("  gives {}\n", dumpParam(result));
  for (const lang::Variant& variant : node.variants) {
    text += fmt::format("  variant {}\n", variant.name);
    if (!variant.doc.empty()) text += "  " + dumpDoc(variant.doc);
  }
  for (const lang::Assumption& a : node.assumptions) {
    text += fmt::format("  assumes {} in [{}, {}]: {}{}{} (line {})\n", a.value, a.range.lo, a.range.hi,
                        a.reason, a.variant.empty() ? "" : ", in ", a.variant, a.line);
  }
  return text;
}

std::string prose(std::string_view text) { return text.empty() ? "" : fmt::format("  // {}", text); }

/// Set and binding, then the number where there are no sets.
std::string dumpPlace(const ir::Binding& at) { return fmt::format("{}.{} {}", at.set, at.binding, at.flat); }

std::string dumpTemplate(const lang::TemplateDecl& decl) {
  std::string text = fmt::format("template {} ({}:{}), {} slots\n", decl.name, decl.origin.file,
                                 decl.origin.line, decl.slots);
  text += dumpDoc(decl.doc);
  if (!decl.base.empty()) text += fmt::format("  extends {}\n", decl.base);
  for (const lang::BlockDecl& block : decl.blocks) {
    constexpr std::string_view kRoles[] = {"frame", "lights", "object"};
    text += fmt::format("  block {} {} {}[{}] at {}{}\n", kRoles[static_cast<size_t>(block.role)],
                        block.type_name, block.instance, block.array, dumpPlace(block.binding),
                        prose(block.prose));
    if (block.role == lang::BlockRole::Lights) text += fmt::format("    counted by {}\n", block.count_slot);
    for (const lang::BlockFieldDecl& field : block.fields) {
      const std::string elements = field.array == 0 ? "" : fmt::format("[{}]", field.array);
      text += fmt::format("    {}{}: {}\n", field.slot, elements, dumpParam(field));
    }
  }
  for (const lang::AttributeDecl& a : decl.attributes) {
    text += fmt::format("  attribute {}: {} {} at {}{}\n", a.slot, ir::typeName(a.type), a.name, a.location,
                        prose(a.prose));
  }
  for (const lang::EnvironmentDecl& e : decl.environments) {
    text += fmt::format("  environment {}: {} {} at {}{}\n", e.slot, ir::typeName(e.type), e.name,
                        dumpPlace(e.binding), prose(e.prose));
  }
  text += fmt::format("  the material's textures from {} on\n", decl.material_textures);
  for (const lang::LightKindDecl& kind : decl.light_kinds) {
    text += fmt::format("  light kind {}\n", kind.name);
    for (const lang::LightFieldDecl& field : kind.fields) {
      text += fmt::format("    {}{}\n", field.name, field.constant ? " is always the same" : "");
    }
  }
  if (decl.is_default) text += "  the default\n";
  for (const lang::GivenDecl& given : decl.givens) {
    text += fmt::format("  given {}: {}{}\n", given.slot, given.name, prose(given.prose));
    for (const lang::Param& result : given.results) text += fmt::format("    {}\n", dumpParam(result));
  }
  for (const lang::PortDecl& port : decl.ports) {
    text += fmt::format("  port {}: {}{}\n", port.slot, dumpParam(port.param),
                        port.default_value ? " (has a default)" : "");
  }
  for (const lang::OutputDecl& output : decl.outputs) {
    constexpr std::string_view kRoles[] = {"position", "color", "discard"};
    text += fmt::format("  output {} {} {}{}\n", kRoles[static_cast<size_t>(output.role)],
                        ir::typeName(output.type), output.name, prose(output.prose));
  }
  if (decl.front_facing) text += fmt::format("  gl_FrontFacing {}\n", *decl.front_facing);
  return text;
}

}  // namespace

std::string dumpContracts(const lang::Library& library) {
  std::string text;
  for (const std::string_view name : library.names(DeclKind::Const)) {
    const lang::ConstDecl& decl = **library.constant(name);
    text += fmt::format("const {} {} = {} ({}:{})\n{}", ir::typeName(decl.type), name,
                        dumpNumbers(decl.type, decl.value), decl.origin.file, decl.origin.line,
                        dumpDoc(decl.doc));
  }
  for (const std::string_view name : library.names(DeclKind::Node)) text += dumpNode(**library.node(name));
  for (const std::string_view name : library.names(DeclKind::Template))
    text += dumpTemplate(**library.template_(name));
  return text;
}

std::string dumpValue(const ir::Dag& dag, ir::ValueId id) {
  const ir::Value& value = dag[id];
  if (value.op == ir::Op::Constant) return dumpNumbers(value.type, dag.constantOf(id));
  if (value.op == ir::Op::Input) return dag.inputOf(id).name;
  std::string text;
  for (const ir::ValueId operand : value.operands())
    text += (text.empty() ? "" : ", ") + dumpValue(dag, operand);
  if (value.op == ir::Op::Swizzle) {
    text += ".";
    for (int i = 0; i < ir::componentCount(value.type); ++i) {
      text += "xyzw"[static_cast<size_t>(ir::swizzleComponent(value.payload, i))];
    }
    return text;
  }
  if (value.op == ir::Op::Carried) return fmt::format("carried.{}({})", value.payload, text);
  const std::string_view name = dag.nameOf(id);
  return fmt::format("{}{}{}({})", name, name.empty() ? "" : ":", ir::info(value.op).name, text);
}

}  // namespace lacquer::test
