#include "model/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/attributes.h"
#include "model/names.h"
#include "model/order.h"

namespace lacquer::model {

using lang::LineDecl;
using material::Kind;

namespace {

const Line kNoLine{};

}  // namespace

Resolver::Resolver(const Model& model, const lang::TemplateDecl& template_decl,
                   const material::Material& material, const gltf::VertexAttributes& attributes,
                   const BuildOptions& options, Diagnostics& warnings)
    : model_(model),
      template_(template_decl),
      material_(material),
      attributes_(attributes),
      options_(options),
      warnings_(warnings),
      states_(model.ids.size()),
      values_(model.ids.size()),
      nodes_(model.ids.size()),
      taken_(model.lines.size()),
      absent_(model.givens.size(), -1),
      terms_(model.terms.size(), Life::Unknown),
      uniform_(model.ids.size(), -1),
      line_states_(model.lines.size()),
      line_values_(model.lines.size()),
      unmet_(model.terms.size()) {}

namespace {

/// The components of a texel that a swizzle names, all without one.
Found constantTexel(const ir::Components& texel, std::string_view swizzle) {
  constexpr std::string_view kLetters = "xyzwrgbastpq";
  if (swizzle.empty()) return Found::of(Found::Kind::Constant, ir::Type::Vec4, texel);
  ir::Components picked{};
  for (size_t i = 0; i < swizzle.size(); ++i) picked[i] = texel[kLetters.find(swizzle[i]) % 4];
  return Found::of(Found::Kind::Constant, ir::floatType(static_cast<int>(swizzle.size())), picked);
}

}  // namespace

// -- the material's values --

/// The property that has a say: of an extension that the material has, one that the file names (an animation
/// names it, too) before one that it leaves out, and of those one that stands inside of another; else of one
/// that stands inside of such, whose place is known; else the first that needs nothing which is not there,
/// one that is neutral at its default before others.
uint16_t Resolver::provider(const Role& role) const {
  const material::Schema& schema = *model_.schema;
  if (role.providers.size() == 1) return role.providers[0];
  const auto find = [&](const auto& good) -> std::optional<uint16_t> {
    for (const uint16_t property : role.providers) {
      if (good(schema.properties[property].extension)) return property;
    }
    return std::nullopt;
  };
  const auto given = [&](uint16_t property, bool inside) {
    return schema.extensions[schema.properties[property].extension]->inside.empty() != inside &&
           (material_.number(property) != nullptr || material_.texture(property) != nullptr ||
            material_.isAnimated(property));
  };
  for (const bool inside : {true, false}) {
    for (const uint16_t property : role.providers) {
      if (given(property, inside)) return property;
    }
  }
  if (const auto there = find([&](uint16_t extension) { return material_.has(extension); })) return *there;
  const auto within = find([&](uint16_t extension) {
    const std::string_view around = schema.extensions[extension]->inside;
    return !around.empty() && material_.has(*schema.find(around));
  });
  if (within) return *within;
  const auto free = [&](uint16_t extension) {
    const lang::ExtensionDecl& decl = *schema.extensions[extension];
    return decl.inside.empty() && decl.needs.empty();
  };
  for (const uint16_t property : role.providers) {
    const material::Property& row = schema.properties[property];
    if (free(row.extension) && !row.decl->neutral) return property;
  }
  return find(free).value_or(role.providers[0]);
}

ir::Components Resolver::numberOf(uint16_t property) const {
  if (const ir::Components* given = material_.number(property)) return *given;
  const material::Property& row = model_.schema->properties[property];
  const ir::Components by_default = row.decl->default_value.value_or(ir::Components{});
  return material_.has(row.extension) ? by_default : row.decl->neutral.value_or(by_default);
}

bool Resolver::live(const std::vector<std::string_view>& terms) const {
  return std::any_of(terms.begin(), terms.end(),
                     [&](std::string_view term) { return options_.live.contains(term); });
}

Found Resolver::number(const Role& role, const Value& value) {
  Found out;
  out.property = provider(role);
  const lang::PropertyDecl* decl = model_.schema->properties[out.property].decl;
  ir::Components now{};
  if (value.member >= 0) {
    const gltf::TextureInfo* info = material_.texture(out.property);
    if (info == nullptr) return {};
    decl = &decl->members[static_cast<size_t>(value.member)];
    now[0] = info->members[static_cast<size_t>(value.member)];
    const std::vector<size_t>& animated = info->animated.members;
    out.animated = std::find(animated.begin(), animated.end(), value.member) != animated.end();
  } else {
    const bool optional = decl->kind == Kind::Number && !decl->default_value;
    if (optional && material_.number(out.property) == nullptr) return {};
    now = numberOf(out.property);
    out.animated = material_.isAnimated(out.property);
  }
  // What it is without the extension is no more to be changed than what it is by default.
  ir::Components rest = decl->default_value.value_or(ir::Components{});
  if (!material_.has(model_.schema->properties[out.property].extension)) rest = decl->neutral.value_or(rest);
  const auto member = static_cast<size_t>(value.member);
  const bool kept =
      value.member < 0 ? live(role.live) : member < role.member_live.size() && live(role.member_live[member]);
  const bool folded = decl->folded && now == rest && !kept && !out.animated;
  const bool fixed = decl->kind == Kind::Bool || decl->kind == Kind::Choice;
  out.type = decl->type;
  out.constant = now;
  out.member = value.member;
  out.kind = folded || fixed     ? Found::Kind::Constant
             : value.member >= 0 ? Found::Kind::Member
                                 : Found::Kind::Number;
  return out;
}

/// The texture itself, which a node samples where it likes. What a group of nodes computes is none; the image
/// that a file has beside it is taken.
Found Resolver::image(Found texture, const gltf::TextureInfo& info) {
  texture.kind = Found::Kind::Image;
  texture.type = ir::Type::Texture2D;
  const lang::PropertyDecl& decl = *model_.schema->properties[texture.property].decl;
  const bool encoded = decl.srgb && options_.decode_srgb;
  const bool moved = info.channels != gltf::kOwnChannels;
  if ((info.group.empty() || info.texture >= 0) && !encoded && !moved) return texture;
  if (told_.insert(texture.property).second) {
    warnings_.push_back(
        {"no-image",
         Severity::Warning,
         {{}, 0, 0, info.pointer},
         fmt::format("a part samples '{}' itself, which {}", decl.name,
                     moved     ? "has channels of its image in another order"
                     : encoded ? "is encoded in this shader"
                               : "nodes compute in place of an image"),
         moved     ? "give it an image that has them in order; what needs it is left out"
         : encoded ? "give it a format that decodes sRGB; what needs it is left out"
                   : "give it an image beside the nodes, as `lacquer bake` does; what needs it is left out",
         {}});
  }
  return {};
}

Found Resolver::role(const Value& value) {
  const Role& role = model_.roles[value.index];
  const lang::PropertyDecl& decl = *model_.schema->properties[role.providers[0]].decl;
  if (decl.kind != Kind::Texture || value.member >= 0) return behind(number(role, value), value.path);
  Found out;
  out.property = provider(role);
  const gltf::TextureInfo* info = material_.texture(out.property);
  if (info == nullptr) return {};
  if (value.image) return image(std::move(out), *info);
  out.kind = value.coordinate ? Found::Kind::Uv : Found::Kind::Texel;
  if (value.coordinate) {
    // A coordinate that the primitive lacks has no derivatives either.
    if (!attributes_.texCoord[static_cast<size_t>(info->texCoord)]) return {};
    out.type = ir::Type::Vec2;
    return out;
  }
  out.type = ir::Type::Vec4;
  const lang::PropertyDecl& texture = *model_.schema->properties[out.property].decl;
  out.swizzle = Letters(texture.channels);
  if (!value.path.empty()) out.swizzle = Letters(value.path);
  const auto texel = options_.texels.find(texture.name);
  return texel == options_.texels.end() ? out : constantTexel(texel->second, out.swizzle.view());
}

Found Resolver::given(const Value& value) {
  const std::string& name = model_.givens[value.index];
  Found out;
  out.index = value.index;
  for (const lang::EnvironmentDecl& one : template_.environments) {
    if (one.name != name) continue;
    out.kind = Found::Kind::Texture;
    out.type = one.type;
    return out;
  }
  const std::optional<lang::GivenResult> result = template_.find(name);
  if (!result) return {};
  signed char& absent = absent_[value.index];
  if (absent < 0) absent = needsAbsent(template_, *result->given, attributes_) ? 1 : 0;
  if (absent == 1) return {};
  out.kind = Found::Kind::Given;
  out.type = result->given->results[result->index].type;
  return behind(std::move(out), value.path);
}

// -- lines --

/// What stands behind a point: an output of a node, or a swizzle.
Found Resolver::behind(Found value, std::string_view path) const {
  if (!value || path.empty()) return value;
  if (value.kind == Found::Kind::Node && value.output.empty() && value.swizzle.empty()) {
    const std::string_view head = path.substr(0, path.find('.'));
    for (const lang::Param& result : nodes_[value.index].decl->results) {
      if (result.name != head || head.empty()) continue;
      value.output = result.name;
      return behind(std::move(value),
                    head.size() == path.size() ? std::string_view{} : path.substr(head.size() + 1));
    }
    if (nodes_[value.index].decl->results.size() > 1) return {};
  }
  if (!isSwizzle(path) || !value.swizzle.empty()) return {};
  value.swizzle = Letters(path);
  return value;
}

/// Whether something stands for a parameter that nothing is connected to: a constant, or what the template
/// gives.
bool Resolver::hasDefault(const lang::Param& param) const {
  return param.hasConstantDefault() ||
         (graph::isAttributeName(param.given) ? hasAttribute(attributes_, param.given)
                                              : !param.given.empty() && template_.find(param.given));
}

Found Resolver::call(const Value& value, const Line& line) {
  Node node;
  node.decl = &model_.nodeOf(value);
  node.variant = value.variant;
  node.shared = line.shared;
  node.order = line.order;
  node.inputs.reserve(value.args.size());
  for (size_t i = 0; i < value.args.size(); ++i) {
    node.inputs.push_back(value.args[i].absent ? Found{} : found(value.args[i], line));
    if (!node.inputs.back() && !hasDefault(node.decl->params[i])) return {};
  }
  nodes_[line.id] = std::move(node);
  Found out;
  out.kind = Found::Kind::Node;
  out.index = line.id;
  return out;
}

Found Resolver::found(const Value& value, const Line& line) {
  switch (value.kind) {
    case Value::Kind::None: return Found::of(Found::Kind::Void);
    case Value::Kind::Constant: return Found::of(Found::Kind::Constant, value.type, value.constant);
    case Value::Kind::Id: return replaced(value, line.part, behind(id(value.index), value.path));
    case Value::Kind::Below: return below(value, line.part);
    case Value::Kind::Role: return role(value);
    case Value::Kind::Given: return given(value);
    case Value::Kind::Call: return call(value, line);
  }
  return {};
}

/// The value that parts have put in place of another. A part that replaces it sees what the parts below it
/// see.
Found Resolver::replacement(const Value& value, uint32_t part) {
  if (model_.ids[value.index].light) return behind(dimmed(value.index, part), value.path);
  const std::vector<uint32_t>& lines = model_.ids[value.index].replaced;
  // What stands in the place of a whole value stands in that of its parts, too.
  const auto names = [&](const Line& line) {
    return line.target.path.empty() || line.target.path == value.path;
  };
  const bool own = std::any_of(lines.begin(), lines.end(), [&](uint32_t i) {
    return model_.lines[i].part == part && names(model_.lines[i]);
  });
  for (auto it = lines.rbegin(); it != lines.rend(); ++it) {
    const Line& line = model_.lines[*it];
    if (!names(line) || (own && line.part >= part)) continue;
    if (line.term != Line::kNone && !alive(line.term)) continue;
    Found instead = fromLine(line);
    if (line.target.path.empty()) instead = behind(std::move(instead), value.path);
    if (instead) return instead;
  }
  return {};
}

/// The light that reaches a part, where a layer above it lets less than all of it through: what the nearest
/// one says, which itself sees what those above it let through.
Found Resolver::dimmed(uint32_t id, uint32_t part) {
  for (const uint32_t index : model_.ids[id].replaced) {
    const Line& line = model_.lines[index];
    if (line.part <= part || (line.term != Line::kNone && !alive(line.term))) continue;
    Found instead = fromLine(line);
    if (!instead) continue;
    checkDimmed(line);
    return instead;
  }
  return {};
}

/// The first of what the parts below put out for a port that does not scale with the light that may be
/// dimmed.
const Line* Resolver::undimmed(uint32_t out, uint32_t part) {
  for (const uint32_t index : model_.outs[out].lines) {
    const Line& line = model_.lines[index];
    if (line.part >= part || model_.scales(index)) continue;
    if (line.term != Line::kNone && !alive(line.term)) continue;
    // Not with all that a material could have; perhaps with what this one has.
    if (!dimming_) dimming_.emplace(model_, [this](uint32_t p) { return alive(model_.parts[p].term); });
    if (!dimming_->scales(index)) return &line;
  }
  return nullptr;
}

/// A layer that dims the light below itself must not lie over a part that would not notice.
void Resolver::checkDimmed(const Line& line) {
  for (uint32_t out = 0; out < model_.outs.size() && wrong_.empty(); ++out) {
    const Line* other = model_.outs[out].dimmed ? undimmed(out, line.part) : nullptr;
    if (other == nullptr) continue;
    const std::string_view port = model_.outs[out].name;
    wrong(line.part, "light-not-dimmed",
          fmt::format(
              "'{}' is dimmed for the parts below, but what '{}' puts out as '{}' does not scale with it",
              model_.ids[line.target.index].name, model_.parts[other->part].name, port),
          fmt::format("replace it only when dimmable({}), and dim 'below.{}' else", port, port));
  }
}

Found Resolver::replaced(const Value& value, uint32_t part, Found original) {
  Found instead = replacement(value, part);
  return instead ? instead : original;
}

/// Lines that need each other, and chains that no stack has room for, are errors of the text.
bool Resolver::enter(uint32_t part) {
  constexpr int kDeepest = 500;  // of the library's lines: some thirty
  if (depth_ < kDeepest) return true;
  wrong(part, "limit", fmt::format("more than {} lines need one another", kDeepest),
        "put some of them into one node");
  return false;
}

/// What a line comes to. Of `out` and `replace` it is kept; that of other lines is by their ids.
Found Resolver::fromLine(const Line& line) {
  const auto index = static_cast<size_t>(&line - model_.lines.data());
  const bool kept = line.kind == LineDecl::Kind::Out || line.kind == LineDecl::Kind::Replace;
  if (kept && line_states_[index] == State::Done) return line_values_[index];
  if (kept && line_states_[index] == State::Open) {
    wrong(line.part, "recursion", "what stands in the place of a line needs that line",
          "give it a value that does not need what it replaces");
    return {};
  }
  if (!enter(line.part)) return {};
  ++depth_;
  if (kept) line_states_[index] = State::Open;
  Found value = chosen(line);
  --depth_;
  if (!kept) return value;
  line_states_[index] = State::Done;
  return line_values_[index] = std::move(value);
}

/// The first of a line's values whose condition holds and which is there.
Found Resolver::chosen(const Line& line) {
  const bool live = line.term != Line::kNone && options_.live.contains(model_.terms[line.term].name);
  for (const Alternative& alternative : line.alternatives) {
    const bool asks = !alternative.unless || !live;
    if (asks && holds(alternative.condition, line) == alternative.unless) continue;
    const Found value = found(alternative.value, line);
    if (value || value.kind == Found::Kind::Void) return value;
  }
  return {};
}

void Resolver::circle(uint32_t id) {
  std::string path;
  for (const uint32_t open : open_) {
    if (path.empty() && open != id) continue;
    path += fmt::format("{} -> ", model_.ids[open].name);
  }
  wrong(model_.lines[model_.ids[id].lines[0]].part, "recursion",
        fmt::format("lines need each other: {}{}", path, model_.ids[id].name),
        "give one of them a value that does not need the other");
}

/// An error of a part's text, once.
void Resolver::wrong(uint32_t part, std::string code, std::string message, std::string help) {
  if (!wrong_.empty()) return;
  const lang::Origin& origin = part < model_.parts.size() ? model_.parts[part].origin : model_.profile_origin;
  wrong_.push_back({std::move(code),
                    Severity::Error,
                    {std::string(origin.file), origin.line, 0, {}},
                    std::move(message),
                    std::move(help),
                    {}});
}

Found Resolver::id(uint32_t id) {
  if (states_[id] == State::Done) return values_[id];
  if (states_[id] == State::Open) {
    circle(id);
    return {};
  }
  states_[id] = State::Open;
  open_.push_back(id);
  Found value;
  for (const uint32_t index : model_.ids[id].lines) {
    const Line& line = model_.lines[index];
    if (line.term != Line::kNone && !alive(line.term)) continue;
    value = fromLine(line);
    if (value || value.kind == Found::Kind::Void) break;
  }
  open_.pop_back();
  states_[id] = State::Done;
  return values_[id] = std::move(value);
}

Found Resolver::below(const Value& value, uint32_t part, uint32_t* from) {
  const std::vector<uint32_t>& lines = model_.outs[value.index].lines;
  for (auto it = lines.rbegin(); it != lines.rend(); ++it) {
    const Line& line = model_.lines[*it];
    if (line.part >= part) continue;
    if (line.term != Line::kNone && !alive(line.term)) continue;
    Found found = fromLine(line);
    if (found.kind == Found::Kind::Void) return {};
    if (!found) continue;
    if (from != nullptr) *from = *it;
    return behind(std::move(found), value.path);
  }
  return {};
}

Found Resolver::port(std::string_view name) {
  for (uint32_t i = 0; i < model_.outs.size(); ++i) {
    Value value;
    value.index = i;
    if (model_.outs[i].name != name) continue;
    uint32_t line = Line::kNone;
    Found found = below(value, Line::kNone, &line);
    if (line != Line::kNone) taken_[line] = true;
    return found;
  }
  return {};
}

// -- conditions --

bool Resolver::uniform(const Found& value) {
  switch (value.kind) {
    case Found::Kind::Nothing:
    case Found::Kind::Void:
    case Found::Kind::Constant:
    case Found::Kind::Number:
    case Found::Kind::Member: return true;
    case Found::Kind::Texel:
    case Found::Kind::Uv:
    case Found::Kind::Image:
    case Found::Kind::Given:
    case Found::Kind::Texture: return false;
    case Found::Kind::Node: break;
  }
  signed char& known = uniform_[value.index];
  if (known < 0) {
    const std::vector<Found>& inputs = nodes_[value.index].inputs;
    known =
        std::all_of(inputs.begin(), inputs.end(), [&](const Found& input) { return uniform(input); }) ? 1 : 0;
  }
  return known != 0;
}

bool Resolver::equal(const Condition& condition, const Line&) {
  const Found value = number(model_.roles[condition.values[0].index], condition.values[0]);
  // What an animation changes may be anything: no term goes, and no other comes, because of its value today.
  if (!value || value.animated) return false;
  const auto count = static_cast<size_t>(std::max(1, ir::componentCount(value.type)));
  return std::equal(value.constant.begin(), value.constant.begin() + static_cast<ptrdiff_t>(count),
                    condition.constant.begin());
}

bool Resolver::flag(uint32_t id) {
  if (states_[id] == State::Open) {
    circle(id);
    return false;
  }
  if (states_[id] == State::Unknown) {
    if (!enter(model_.lines[model_.ids[id].lines[0]].part)) return false;
    ++depth_;
    states_[id] = State::Open;
    open_.push_back(id);
    for (const uint32_t index : model_.ids[id].lines) {
      const Line& line = model_.lines[index];
      if (line.term != Line::kNone && !alive(line.term)) continue;
      for (const Alternative& one : line.alternatives) {
        if (holds(one.condition, line)) values_[id] = Found::of(Found::Kind::Constant, ir::Type::Bool, {1});
      }
    }
    open_.pop_back();
    states_[id] = State::Done;
    --depth_;
  }
  return static_cast<bool>(values_[id]);
}

bool Resolver::holds(const Condition& condition, const Line& line) {
  const auto inner = [&](const Condition& one) { return holds(one, line); };
  switch (condition.kind) {
    case Condition::Kind::Always: return true;
    case Condition::Kind::And:
      return std::all_of(condition.conditions.begin(), condition.conditions.end(), inner);
    case Condition::Kind::Or:
      return std::any_of(condition.conditions.begin(), condition.conditions.end(), inner);
    case Condition::Kind::Not: return !holds(condition.conditions[0], line);
    case Condition::Kind::Present: {
      const Found value = found(condition.values[0], line);
      if (value.kind == Found::Kind::Constant && value.type == ir::Type::Bool) return value.constant[0] != 0;
      return static_cast<bool>(value);
    }
    case Condition::Kind::Same: return found(condition.values[0], line) == found(condition.values[1], line);
    case Condition::Kind::Equal: return equal(condition, line);
    case Condition::Kind::Flag: return flag(condition.index);
    case Condition::Kind::Switch: {
      const auto it = options_.switches.find(model_.switches[condition.index]);
      return it == options_.switches.end() ? model_.switch_defaults[condition.index] : it->second;
    }
    case Condition::Kind::Extension: return material_.has(static_cast<uint16_t>(condition.index));
    case Condition::Kind::Term: return alive(condition.index);
    case Condition::Kind::Uniform: return uniform(found(condition.values[0], line));
    case Condition::Kind::Replaced:
      return model_.ids[condition.values[0].index].overridden ||
             static_cast<bool>(replacement(condition.values[0], line.part));
    case Condition::Kind::Dimmable: return undimmed(condition.index, line.part) == nullptr;
    case Condition::Kind::Takes:
      return std::any_of(template_.ports.begin(), template_.ports.end(),
                         [&](const lang::PortDecl& port) { return port.param.name == condition.name; });
  }
  return false;
}

// -- terms --

bool Resolver::has(const Part& part) const {
  return part.of.empty() || std::any_of(part.of.begin(), part.of.end(),
                                        [&](uint16_t extension) { return material_.has(extension); });
}

/// False when something that the term needs is not there; that is a warning, once.
bool Resolver::required(const Term& term) {
  for (const uint32_t index : term.requirements) {
    const Line& line = model_.lines[index];
    if (fromLine(line)) continue;
    std::string pointer = fmt::format("/materials/{}", material_.index);
    if (line.place.kind == Value::Kind::Role) {
      const uint16_t property = provider(model_.roles[line.place.index]);
      const gltf::TextureInfo* info = material_.texture(property);
      pointer = info != nullptr
                    ? info->pointer
                    : fmt::format("{}/{}", pointer,
                                  model_.schema->pathOf(model_.schema->properties[property].extension));
    }
    warnings_.push_back({std::string(line.code),
                         Severity::Warning,
                         {{}, 0, 0, std::move(pointer)},
                         std::string(line.message),
                         std::string(line.help),
                         {}});
    unmet_[static_cast<size_t>(&term - model_.terms.data())] = line.reason;
    return false;
  }
  return true;
}

bool Resolver::alive(uint32_t index) {
  Life& life = terms_[index];
  if (life == Life::Dead || life == Life::Alive) return life == Life::Alive;
  const Term& term = model_.terms[index];
  if (life == Life::Asked) {
    wrong(term.part, "recursion", fmt::format("whether '{}' is there depends on itself", term.name),
          "its conditions must not ask for its own lines");
    return false;
  }
  if (!enter(term.part)) return false;
  ++depth_;
  life = Life::Asked;
  Line context = kNoLine;
  context.part = term.part;
  context.term = index;
  const bool inner = term.parent != Line::kNone;
  bool good = inner ? alive(term.parent) : has(model_.parts[term.part]);
  good = good && !options_.without.contains(term.name);
  good = good && holds(term.when, context);
  good = good && (!term.has_unless || options_.live.contains(term.name) || !holds(term.unless, context));
  life = good ? Life::Alive : Life::Dead;
  if (good && !term.requirements.empty()) {
    // The requirements are lines of the term, so they are looked at as if it were alive.
    good = required(term);
    life = good ? Life::Alive : Life::Dead;
  }
  --depth_;
  return good;
}

bool Resolver::gives(uint32_t term) {
  const bool whole = model_.terms[term].parent == Line::kNone;
  bool last = false;
  for (const Line& line : model_.lines) {
    if (line.term != term || line.kind != LineDecl::Kind::Value) continue;
    last = static_cast<bool>(id(line.id));
    if (whole && last) return true;
  }
  return last;
}

std::string Resolver::missing(const Value& value, const Line& line, int depth) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest || value.absent || (value.kind != Value::Kind::Call && found(value, line))) return {};
  switch (value.kind) {
    case Value::Kind::Role: {
      const uint16_t role = provider(model_.roles[value.index]);
      const gltf::TextureInfo* info = material_.texture(role);
      if (value.coordinate && info != nullptr)
        return fmt::format("the primitive has no TEXCOORD_{}", info->texCoord);
      return fmt::format("there is no {}", model_.schema->properties[role].decl->name);
    }
    case Value::Kind::Given: return fmt::format("there is no {}", model_.givens[value.index]);
    case Value::Kind::Id:
      for (const uint32_t index : model_.ids[value.index].lines) {
        const Line& inner = model_.lines[index];
        if (inner.term != Line::kNone && !alive(inner.term)) continue;
        for (const Alternative& one : inner.alternatives) {
          if (std::string why = missing(one.value, inner, depth + 1); !why.empty()) return why;
        }
      }
      return {};
    case Value::Kind::Call:
      for (size_t i = 0; i < value.args.size(); ++i) {
        if (hasDefault(model_.nodeOf(value).params[i])) continue;
        if (std::string why = missing(value.args[i], line, depth + 1); !why.empty()) return why;
      }
      return {};
    case Value::Kind::None:
    case Value::Kind::Constant:
    case Value::Kind::Below: break;
  }
  return {};
}

std::string Resolver::unmade(const Line& line) {
  const bool asked = line.kind == LineDecl::Kind::Value && states_[line.id] == State::Done;
  if (!asked || values_[line.id].kind != Found::Kind::Nothing) return {};
  for (const Alternative& one : line.alternatives) {
    if (holds(one.condition, line) == one.unless) continue;
    if (std::string why = missing(one.value, line, 0); !why.empty()) return why;
  }
  return {};
}

std::string Resolver::missing(uint32_t term) {
  for (const Line& line : model_.lines) {
    if (line.term != term || line.kind != LineDecl::Kind::Value) continue;
    for (const Alternative& one : line.alternatives) {
      if (std::string why = missing(one.value, line, 0); !why.empty()) return why;
    }
  }
  return {};
}

std::string Resolver::shown(const Condition& equal) const {
  const Value& value = equal.values[0];
  const Role& role = model_.roles[value.index];
  const lang::PropertyDecl* decl = model_.schema->properties[provider(role)].decl;
  const lang::ExtensionDecl& extension =
      *model_.schema->extensions[model_.schema->properties[provider(role)].extension];
  if (!extension.core && !material_.has(*model_.schema->find(extension.name)))
    return fmt::format("the material has no {}", extension.name);
  std::string name(decl->name);
  if (value.member >= 0) {
    decl = &decl->members[static_cast<size_t>(value.member)];
    name += fmt::format(".{}", decl->name);
  }
  if (!equal.name.empty()) return fmt::format("{} is {}", name, equal.name);
  if (decl->type == ir::Type::Vec3 && equal.constant[0] == 1) return fmt::format("{} is white", name);
  if (decl->type == ir::Type::Vec3 && equal.constant[0] == 0) return fmt::format("{} is black", name);
  return fmt::format("{} is {}", name, equal.constant[0]);
}

/// Why a condition holds, or does not.
std::string Resolver::because(const Condition& condition, const Line& line, bool as) {
  switch (condition.kind) {
    case Condition::Kind::Not: return because(condition.conditions[0], line, !as);
    case Condition::Kind::And:
    case Condition::Kind::Or: {
      const bool all = (condition.kind == Condition::Kind::And) == as;
      std::string text;
      for (const Condition& one : condition.conditions) {
        if (holds(one, line) != as) continue;
        if (!all) return because(one, line, as);
        const std::string next = because(one, line, as);
        // One reason that says it all is enough.
        if (next == text || next.starts_with("the material has no")) return next;
        text += (text.empty() ? "" : " and ") + next;
      }
      return text;
    }
    case Condition::Kind::Equal: return shown(condition);
    case Condition::Kind::Extension:
      return fmt::format("the material has {}{}", as ? "" : "no ",
                         model_.schema->extensions[condition.index]->name);
    case Condition::Kind::Present: {
      const Value& value = condition.values[0];
      if (value.kind == Value::Kind::Role) {
        const std::string_view name =
            model_.schema->properties[provider(model_.roles[value.index])].decl->name;
        return fmt::format("there is {} {}", as ? "a" : "no", name);
      }
      return as ? "something else is there" : "nothing gives what it needs";
    }
    case Condition::Kind::Switch:
      return fmt::format("{} is {}", model_.switches[condition.index], as ? "on" : "off");
    case Condition::Kind::Takes:
      return fmt::format("the template takes {} '{}'", as ? "a" : "no", condition.name);
    case Condition::Kind::Always:
    case Condition::Kind::Same:
    case Condition::Kind::Flag:
    case Condition::Kind::Term:
    case Condition::Kind::Uniform:
    case Condition::Kind::Replaced:
    case Condition::Kind::Dimmable: break;
  }
  return "the material does not ask for it";
}

std::vector<graph::Skipped> Resolver::skipped() {
  std::vector<graph::Skipped> out;
  for (uint32_t i = 0; i < model_.terms.size(); ++i) {
    const Term& term = model_.terms[i];
    const bool inner = term.parent != Line::kNone;
    if (!(inner ? alive(term.parent) : has(model_.parts[term.part])) || alive(i)) continue;
    Line context = kNoLine;
    context.part = term.part;
    std::string reason;
    if (options_.without.contains(term.name)) {
      reason = "it is left out";
    } else if (!holds(term.when, context)) {
      // A `when` without a reason is a matter of which material it is, not of its values.
      if (term.when_reason.empty()) continue;
      reason = term.when_reason;
    } else if (!unmet_[i].empty()) {
      reason = unmet_[i];
    } else {
      reason =
          term.unless_reason.empty() ? because(term.unless, context, true) : std::string(term.unless_reason);
    }
    out.push_back({std::string(term.name), std::move(reason)});
  }
  return out;
}

Diagnostics Resolver::unordered() {
  Diagnostics warnings;
  for (const auto& [lower, upper] : model_.unordered) {
    const Part& below = model_.parts[lower];
    const Part& above = model_.parts[upper];
    if (!has(below) || !has(above) || !alive(below.term) || !alive(above.term)) continue;
    warnings.push_back(unorderedParts(model_.declOf(lower), model_.declOf(upper)));
    warnings.back().place = {{}, 0, 0, fmt::format("/materials/{}", material_.index)};
    warnings.back().excerpt.clear();
  }
  return warnings;
}

}  // namespace lacquer::model
