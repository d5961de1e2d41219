#include "model/types.h"

#include "model/names.h"

namespace lacquer::model {

namespace {

constexpr int kDeepest = 32;

std::optional<ir::Type> swizzled(ir::Type type, std::string_view swizzle) {
  if (swizzle.empty()) return type;
  if (!ir::isFloatVector(type) || !isSwizzle(swizzle)) return std::nullopt;
  constexpr ir::Type kTypes[] = {ir::Type::Float, ir::Type::Vec2, ir::Type::Vec3, ir::Type::Vec4};
  return kTypes[swizzle.size() - 1];
}

}  // namespace

Types::Types(const lang::Library& library, const Model& model) : model_(model) {
  for (const std::string_view name : library.names(lang::DeclKind::Template)) {
    const lang::TemplateDecl* decl = library.writtenTemplate(name);
    if (decl == nullptr) continue;  // says so where it is used
    templates_.push_back(decl);
    for (const lang::PortDecl& port : decl->ports) ports_.emplace(port.param.name, port.param.type);
  }
}

std::optional<ir::Type> Types::port(std::string_view name) const {
  const auto it = ports_.find(name);
  return it == ports_.end() ? std::nullopt : std::optional(it->second);
}

std::vector<std::string_view> Types::ports() const {
  std::vector<std::string_view> names;
  for (const auto& [name, type] : ports_) names.push_back(name);
  return names;
}

std::optional<ir::Type> Types::of(const Value& value, int depth) const {
  if (depth > kDeepest) return std::nullopt;
  switch (value.kind) {
    case Value::Kind::None: return std::nullopt;
    case Value::Kind::Constant: return value.type;
    case Value::Kind::Id: return id(value.index, value.path, depth);
    case Value::Kind::Below: {
      const std::optional<ir::Type> whole = port(model_.outs[value.index].name);
      return whole ? swizzled(*whole, value.path) : std::nullopt;
    }
    case Value::Kind::Role: return role(value);
    case Value::Kind::Given: return given(value);
    case Value::Kind::Call: return call(value, {});
  }
  return std::nullopt;
}

std::optional<ir::Type> Types::id(uint32_t id, std::string_view path, int depth) const {
  const auto [it, fresh] = known_.try_emplace({id, path});
  if (fresh) it->second = agreed(id, path, depth);
  return it->second;
}

/// What all lines that say the id agree on.
std::optional<ir::Type> Types::agreed(uint32_t id, std::string_view path, int depth) const {
  std::optional<ir::Type> agreed;
  for (const uint32_t line : model_.ids[id].lines) {
    if (model_.lines[line].kind == lang::LineDecl::Kind::Flag) return ir::Type::Bool;
    for (const Alternative& alternative : model_.lines[line].alternatives) {
      const Value& value = alternative.value;
      if (value.kind == Value::Kind::None) continue;
      std::optional<ir::Type> type;
      if (value.kind == Value::Kind::Call) {
        type = call(value, path);
      } else if (const std::optional<ir::Type> whole = of(value, depth + 1)) {
        type = swizzled(*whole, path);
      }
      if (!type) continue;
      if (agreed && *agreed != *type) return std::nullopt;
      agreed = type;
    }
  }
  return agreed;
}

std::optional<ir::Type> Types::call(const Value& value, std::string_view path) const {
  const std::vector<lang::Param>& results = model_.nodeOf(value).results;
  const std::string_view head = path.substr(0, path.find('.'));
  for (const lang::Param& result : results) {
    if (head.empty() || result.name != head) continue;
    return swizzled(result.type,
                    head.size() == path.size() ? std::string_view{} : path.substr(head.size() + 1));
  }
  return results.size() == 1 ? swizzled(results[0].type, path) : std::nullopt;
}

std::optional<ir::Type> Types::role(const Value& value) const {
  const lang::PropertyDecl& decl = *model_.schema->properties[model_.roles[value.index].providers[0]].decl;
  if (decl.kind != material::Kind::Texture) return swizzled(decl.type, value.path);
  if (value.member >= 0) return decl.members[static_cast<size_t>(value.member)].type;
  if (value.coordinate) return ir::Type::Vec2;
  if (value.image) return ir::Type::Texture2D;
  const std::string_view read = value.path.empty() ? decl.channels : value.path;
  return swizzled(ir::Type::Vec4, read);
}

std::optional<ir::Type> Types::given(const Value& value) const {
  const std::string& name = model_.givens[value.index];
  for (const lang::TemplateDecl* decl : templates_) {
    for (const lang::EnvironmentDecl& one : decl->environments) {
      if (one.name == name) return value.path.empty() ? std::optional(one.type) : std::nullopt;
    }
    if (const std::optional<lang::GivenResult> result = decl->find(name))
      return swizzled(result->given->results[result->index].type, value.path);
  }
  return std::nullopt;
}

}  // namespace lacquer::model
