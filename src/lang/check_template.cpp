#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "lang/checker.h"

namespace lacquer::lang {

using ir::Type;
using ir::typeName;

namespace {

/// What the base declares goes before what the template itself does.
template <class T>
void prepend(std::vector<T>& list, std::vector<T>&& base) {
  list.insert(list.begin(), std::make_move_iterator(base.begin()), std::make_move_iterator(base.end()));
}

}  // namespace

void Checker::templateDecl(TemplateDecl& decl, std::vector<TemplateDecl> bases) {
  template_ = &decl;
  if (decl.doc.empty()) {
    reporter_.error("missing-doc", decl.span,
                    fmt::format("the template '{}' has no documentation", decl.name),
                    "say what it is in a line `/// ...` above it");
  }
  uint32_t slots = 0;
  names_.push_back({"gl_FrontFacing", Name::Kind::Builtin, Type::Bool, slots++, decl.span, true, false, {}});
  auto locations = uint32_t{0};
  for (TemplateDecl& base : bases) {
    parts(base, slots);
    for (AttributeDecl& attribute : base.attributes) attribute.location = locations++;
  }
  for (Name& name : names_) name.inherited = true;
  parts(decl, slots);
  for (AttributeDecl& attribute : decl.attributes) attribute.location = locations++;
  decl.slots = slots;
  for (auto base = bases.rbegin(); base != bases.rend(); ++base) {
    prepend(decl.blocks, std::move(base->blocks));
    prepend(decl.attributes, std::move(base->attributes));
    prepend(decl.environments, std::move(base->environments));
    prepend(decl.givens, std::move(base->givens));
    prepend(decl.ports, std::move(base->ports));
    prepend(decl.outputs, std::move(base->outputs));
  }
  for (size_t i = 0; i < decl.outputs.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (decl.outputs[i].name != decl.outputs[j].name) continue;
      reporter_.error("duplicate-name", decl.outputs[i].span,
                      fmt::format("there are two outputs '{}'", decl.outputs[i].name));
    }
  }
  if (decl.outputs.empty()) {
    reporter_.error("no-output", decl.span, fmt::format("the template '{}' puts nothing out", decl.name),
                    "end it with an `output color vec4 NAME = ...;` or another output");
  }
}

void Checker::parts(TemplateDecl& decl, uint32_t& slots) {
  // In the order of the text, so that each part sees what stands before it.
  size_t b = 0, a = 0, e = 0, g = 0, p = 0, o = 0;
  const auto offset = [](const auto& list, size_t i) {
    return i < list.size() ? list[i].span.offset : ~uint32_t{0};
  };
  while (true) {
    const uint32_t next =
        std::min({offset(decl.blocks, b), offset(decl.attributes, a), offset(decl.environments, e),
                  offset(decl.givens, g), offset(decl.outputs, o),
                  p < decl.ports.size() ? decl.ports[p].param.span.offset : ~uint32_t{0}});
    if (next == ~uint32_t{0}) break;
    if (next == offset(decl.blocks, b)) {
      block(decl.blocks[b++], slots);
    } else if (next == offset(decl.attributes, a)) {
      AttributeDecl& item = decl.attributes[a++];
      if (!ir::isFloating(item.type)) {
        reporter_.error("wrong-type", item.span, fmt::format("an attribute cannot be {}", aType(item.type)),
                        "attributes are floats and vectors");
      }
      item.slot = slots++;
      declare({item.name, Name::Kind::Attribute, item.type, item.slot, item.span, true, false, {}});
    } else if (next == offset(decl.environments, e)) {
      EnvironmentDecl& item = decl.environments[e++];
      if (!ir::isTexture(item.type)) {
        reporter_.error("wrong-type", item.span, fmt::format("an environment cannot be {}", aType(item.type)),
                        "it is a sampler2D or a samplerCube");
      }
      item.slot = slots++;
      declare({item.name, Name::Kind::Environment, item.type, item.slot, item.span, true, false, {}});
    } else if (next == offset(decl.givens, g)) {
      given(decl.givens[g++], slots);
    } else if (p < decl.ports.size() && next == decl.ports[p].param.span.offset) {
      port(decl.ports[p++], slots);
    } else {
      output(decl.outputs[o++]);
    }
  }
}

void Checker::block(BlockDecl& decl, uint32_t& slots) {
  if (decl.array_syntax) {
    const std::optional<int> count = constantInt(decl.array_syntax, "the number of elements");
    if (count && (*count < 1 || *count > 4096)) {
      reporter_.error("wrong-count", decl.array_syntax->span,
                      fmt::format("a block cannot have {} elements", *count), "1 to 4096 are possible");
    }
    decl.array = count ? static_cast<uint32_t>(std::max(*count, 1)) : 1;
  }
  if (decl.array_syntax && decl.role != BlockRole::Lights) {
    reporter_.error("wrong-block", decl.span, "only the lights can be an array");
  }
  if (!decl.array_syntax && decl.role == BlockRole::Lights) {
    reporter_.error("wrong-block", decl.span, "the lights must be an array",
                    fmt::format("write how many there can be: `{}[16]`", decl.instance));
  }
  for (const auto& [role, instance] : blocks_) {
    if (role != decl.role) continue;
    reporter_.error("wrong-block", decl.span, "the template has a block of this role already",
                    fmt::format("it is '{}'", instance));
  }
  blocks_.emplace_back(decl.role, decl.instance);
  Name instance{decl.instance, Name::Kind::Instance, Type::Float, slots, decl.span, true, true, {}};
  for (BlockFieldDecl& field : decl.fields) {
    const bool good = ir::isFloating(field.type) || field.type == Type::Int || field.type == Type::Mat4;
    if (!good) {
      reporter_.error("wrong-type", field.span, fmt::format("a field cannot be {}", aType(field.type)),
                      "fields are ints, floats, vectors and matrices");
    }
    for (const auto& [name, type] : instance.members) {
      if (name != field.name) continue;
      reporter_.error("duplicate-name", field.span, fmt::format("there are two fields '{}'", name));
    }
    rangeOf(field);
    field.slot = slots++;
    instance.members.emplace_back(field.name, field.type);
  }
  declare(std::move(instance));
}

/// Whether a value is of another type than the one it is to have; reports it.
bool Checker::unlike(const Param& param, const Expr& value, std::string_view what) {
  if (ir::isFloating(param.type) || param.type == Type::Bool) return false;
  reporter_.error("wrong-type", value.span, fmt::format("{} cannot be {}", what, aType(param.type)),
                  "bools, floats and vectors are possible");
  return true;
}

void Checker::given(GivenDecl& decl, uint32_t& slots) {
  Name name{decl.name, Name::Kind::Given, Type::Float, slots, decl.span, true, false, {}};
  Param& first = decl.results[0];
  decl.slot = slots;
  bool good = false;
  if (decl.has_type) {
    rangeOf(first);
    good = typed(decl.value, first.type, fmt::format("'{}'", decl.name));
    good = good && !unlike(first, *decl.value, "a given");
  } else if (expression(decl.value)) {
    makeFloat(*decl.value);
    const Expr& value = *decl.value;
    decl.multiple = value.kind == Expr::Kind::Call && value.node->results.size() > 1;
    first.type = value.type;
    good = decl.multiple || !unlike(first, value, "a given");
    if (value.kind == Expr::Kind::Call) {
      decl.results.clear();
      for (const Param& result : value.node->results) {
        Param& copy = decl.results.emplace_back();
        copy.type = result.type;
        copy.name = decl.multiple ? result.name : std::string_view{};
        copy.has_range = result.has_range;
        copy.range = result.range;
        copy.prose = result.prose;
        copy.span = decl.span;
        if (decl.multiple) name.members.emplace_back(result.name, result.type);
      }
    }
  }
  slots += static_cast<uint32_t>(decl.results.size());
  name.multiple = decl.multiple;
  name.type = decl.results[0].type;
  name.broken = !good && !decl.has_type;
  declare(std::move(name));
}

void Checker::port(PortDecl& decl, uint32_t& slots) {
  Param& param = decl.param;
  rangeOf(param);
  if (!ir::isFloating(param.type) && param.type != Type::Bool) {
    reporter_.error("wrong-type", param.span, fmt::format("a port cannot be {}", aType(param.type)),
                    "ports are bools, floats and vectors");
  }
  if (decl.default_value)
    typed(decl.default_value, param.type, fmt::format("the default of '{}'", param.name));
  decl.slot = slots++;
  declare({param.name, Name::Kind::Port, param.type, decl.slot, param.span, true, false, {}});
}

void Checker::output(OutputDecl& decl) {
  const Type wanted = decl.role == OutputRole::Discard ? Type::Bool : Type::Vec4;
  if (decl.type != wanted) {
    reporter_.error("wrong-type", decl.span,
                    fmt::format("'{}' is {} and must be {}", decl.name, aType(decl.type), aType(wanted)));
    return;
  }
  ports_allowed_ = true;
  typed(decl.value, decl.type, fmt::format("'{}'", decl.name));
  ports_allowed_ = false;
}

}  // namespace lacquer::lang
