#include "programs/unite.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "programs/alternatives.h"

namespace lacquer::programs {

using graph::Graph;
using graph::Literal;
using graph::Node;
using graph::NodeRef;
using graph::ParameterRef;
using graph::Source;
using graph::TextureRef;

namespace {

Diagnostics differ(std::string what) {
  return {{"programs-differ",
           Severity::Error,
           {},
           std::move(what),
           "these materials need programs of their own",
           {}}};
}

/// A number that the text of a template's default comes to.
std::optional<ir::Components> constantOf(const lang::Expr& expr) {
  using Kind = lang::Expr::Kind;
  if (expr.kind == Kind::Literal) return ir::Components{expr.number};
  if (expr.kind == Kind::Constant) return expr.constant->value;
  if (expr.kind != Kind::Construct) return std::nullopt;
  ir::Components all{};
  size_t filled = 0;
  for (const lang::ExprPtr& arg : expr.args) {
    const std::optional<ir::Components> part = constantOf(*arg);
    if (!part) return std::nullopt;
    for (int i = 0; i < ir::componentCount(arg->type) && filled < all.size(); ++i)
      all[filled++] = (*part)[static_cast<size_t>(i)];
  }
  if (filled == 1) std::fill_n(all.begin(), ir::componentCount(expr.type), all[0]);
  return all;
}

/// A number that stands for each component of a vector, as that.
Source widened(Source source, ir::Type type) {
  auto* literal = std::get_if<Literal>(&source.from);
  if (literal == nullptr || literal->type != ir::Type::Float || !ir::isFloatVector(type)) return source;
  const double x = literal->value[0];
  literal->type = type;
  std::fill_n(literal->value.begin(), ir::componentCount(type), x);
  source.swizzle.clear();
  return source;
}

class Uniter {
public:
  Uniter(std::span<const Graph* const> members, const lang::Library& library)
      : members_(members), library_(library), choices_(members.size()), united_{} {}

  Result<United> run();

private:
  enum class State : uint8_t { Unknown, Open, Done };
  struct Made {
    State state = State::Unknown;
    std::string id;
  };
  /// Where a value goes.
  struct Place {
    ir::Type type;
    ir::Range range;
    std::string name;  ///< for a parameter that only this place needs
  };

  void index();
  void outputs(const lang::TemplateDecl& decl);
  Source unify(Sources sources, const Place& place);
  void absorb(std::vector<Alternative>& all, const Place& place);
  bool absorbed(const Alternative& literal, const Alternative& by, const Place& place);
  bool byParameter(const Literal& literal, uint32_t member, const std::string& name, ir::Type type);
  bool byTexel(const Literal& literal, uint32_t member, const std::string& slot, const std::string& swizzle);
  Source fresh(const std::vector<const Alternative*>& literals, const Place& place);
  Source emit(const Alternative& alternative);
  std::string node(uint32_t key, const Members& members);
  std::string build(uint32_t key, const Members& members);
  Source choose(const Members& first, const Members& others, Source a, Source b, ir::Type type);
  void parameter(const std::string& name);
  void texture(const std::string& name);
  void fill();
  void skipped();
  void wrong(std::string what) {
    if (wrong_.empty()) wrong_ = differ(std::move(what));
  }
  std::string freeName(std::string name, std::set<std::string>& taken) const;

  std::span<const Graph* const> members_;
  const lang::Library& library_;
  Keys keys_;
  std::vector<Made> made_;                               ///< by key
  std::map<std::pair<uint32_t, Members>, Made> copies_;  ///< of a key, for some of its members
  std::map<std::string, std::vector<std::optional<ir::Components>>> numbers_;  ///< by name and member
  std::map<std::string, std::vector<Texel>> texels_;                           ///< the same
  std::map<std::string, Source> chosen_;
  std::set<std::string> ids_, names_;
  Choices choices_;
  United united_;
  Diagnostics wrong_;
};

std::string Uniter::freeName(std::string name, std::set<std::string>& taken) const {
  std::string free = name;
  for (size_t i = 2; !taken.insert(free).second; ++i) free = fmt::format("{}_{}", name, i);
  return free;
}

void Uniter::index() {
  for (uint32_t m = 0; m < members_.size(); ++m) {
    keys_.add(*members_[m]);
    for (const ir::Parameter& p : members_[m]->parameters) names_.insert(p.name);
    for (const ir::TextureSlot& t : members_[m]->textures) names_.insert(t.name);
  }
  made_.resize(keys_.count());
}

// -- numbers and textures --

void Uniter::parameter(const std::string& name) {
  if (united_.graph.findParameter(name)) return;
  graph::Parameter made;
  bool found = false;
  for (const Graph* member : members_) {
    const std::optional<size_t> at = member->findParameter(name);
    if (!at) continue;
    const graph::Parameter& own = member->parameters[*at];
    if (!found) {
      made = own;
    } else if (own.type != made.type || !(own.range == made.range)) {
      wrong(fmt::format("'{}' is one thing in one material and another in another", name));
    }
    made.animated = made.animated || own.animated;
    found = true;
  }
  made.pointer.clear();
  made.ui.clear();
  united_.graph.parameters.push_back(std::move(made));
}

void Uniter::texture(const std::string& name) {
  std::vector<graph::Texture>& all = united_.graph.textures;
  const auto named = [&](const ir::TextureSlot& slot) { return slot.name == name; };
  if (united_.graph.findTexture(name)) return;
  bool found = false;
  for (const Graph* member : members_) {
    const auto it = std::find_if(member->textures.begin(), member->textures.end(), named);
    if (it == member->textures.end()) continue;
    if (!found) {
      all.push_back(graph::bare(*it));
    } else if (it->srgb != all.back().srgb || it->type != all.back().type) {
      wrong(fmt::format("the texture '{}' has another format in another material", name));
    }
    found = true;
  }
}

bool Uniter::byParameter(const Literal& literal, uint32_t member, const std::string& name, ir::Type type) {
  if (literal.type != type || members_[member]->findParameter(name)) return false;
  const auto owner = std::find_if(members_.begin(), members_.end(),
                                  [&](const Graph* graph) { return graph->findParameter(name).has_value(); });
  const ir::Parameter& own = (*owner)->parameters[*(*owner)->findParameter(name)];
  if (own.type != type) return false;
  for (int i = 0; i < ir::componentCount(type); ++i) {
    if (!own.range.contains(literal.value[static_cast<size_t>(i)])) return false;
  }
  auto& values = numbers_[name];
  values.resize(members_.size());
  if (values[member] && *values[member] != literal.value) return false;
  values[member] = literal.value;
  return true;
}

bool Uniter::byTexel(const Literal& literal, uint32_t member, const std::string& slot,
                     const std::string& swizzle) {
  if (members_[member]->findTexture(slot)) return false;
  std::vector<Texel>& texels = texels_[slot];
  texels.resize(members_.size());
  return texels[member].take(literal, swizzle);
}

// -- what members give one place --

/// Whether all of a literal's members can have it from another alternative instead.
bool Uniter::absorbed(const Alternative& literal, const Alternative& by, const Place& place) {
  const Literal& value = std::get<Literal>(literal.source.from);
  const auto all = [&](auto&& take) {
    return std::all_of(literal.members.begin(), literal.members.end(), take);
  };
  if (const auto* ref = std::get_if<ParameterRef>(&by.source.from)) {
    if (!by.source.swizzle.empty()) return false;
    return all([&](uint32_t member) { return byParameter(value, member, ref->name, place.type); });
  }
  const auto* ref = std::get_if<NodeRef>(&by.source.from);
  if (ref == nullptr) return false;
  const std::string slot = keys_.sampled(by.key);
  if (slot.empty()) return false;
  return all([&](uint32_t member) { return byTexel(value, member, slot, by.source.swizzle); });
}

void Uniter::absorb(std::vector<Alternative>& all, const Place& place) {
  const auto isLiteral = [](const Alternative& one) {
    return std::holds_alternative<Literal>(one.source.from);
  };
  for (size_t i = 0; i < all.size();) {
    bool taken = false;
    for (size_t k = 0; isLiteral(all[i]) && !taken && k < all.size(); ++k) {
      if (isLiteral(all[k]) || !absorbed(all[i], all[k], place)) continue;
      all[k].members = joined(all[k].members, all[i].members);
      taken = true;
    }
    if (taken)
      all.erase(all.begin() + static_cast<ptrdiff_t>(i));
    else
      ++i;
  }
}

/// A parameter for numbers that no member has one for.
Source Uniter::fresh(const std::vector<const Alternative*>& literals, const Place& place) {
  const std::string name = freeName(place.name, names_);
  graph::Parameter made;
  made.name = name;
  made.type = place.type;
  made.range = place.range;
  made.value = made.neutral = std::get<Literal>(literals[0]->source.from).value;
  united_.graph.parameters.push_back(std::move(made));
  auto& values = numbers_[name];
  values.resize(members_.size());
  for (const Alternative* literal : literals) {
    for (const uint32_t member : literal->members)
      values[member] = std::get<Literal>(literal->source.from).value;
  }
  return {ParameterRef{name}, {}};
}

Source Uniter::emit(const Alternative& alternative) {
  Source source = alternative.source;
  if (const auto* ref = std::get_if<ParameterRef>(&source.from)) parameter(ref->name);
  if (auto* ref = std::get_if<NodeRef>(&source.from)) ref->node = node(alternative.key, alternative.members);
  return source;
}

Source Uniter::unify(Sources sources, const Place& place) {
  std::vector<Alternative> all = alternatives(keys_, std::move(sources));
  if (all.size() > 1) absorb(all, place);
  std::vector<const Alternative*> literals;
  std::vector<std::pair<Members, Source>> parts;
  for (const Alternative& one : all) {
    if (std::holds_alternative<Literal>(one.source.from))
      literals.push_back(&one);
    else
      parts.emplace_back(one.members, emit(one));
  }
  if (literals.size() > 1) {
    Members of_all;
    for (const Alternative* literal : literals) of_all = joined(of_all, literal->members);
    parts.emplace_back(of_all, fresh(literals, place));
  } else if (literals.size() == 1) {
    parts.emplace_back(literals[0]->members, literals[0]->source);
  }
  Source result = parts.back().second;
  Members others = parts.back().first;
  for (size_t i = parts.size() - 1; i-- > 0;) {
    result = choose(parts[i].first, others, parts[i].second, result, place.type);
    others = joined(others, parts[i].first);
  }
  return result;
}

Source Uniter::choose(const Members& first, const Members& others, Source a, Source b, ir::Type type) {
  const auto [flag, swapped] = choices_.of(first, others);
  if (swapped) std::swap(a, b);
  const std::string key = fmt::format("{} {} {} {}", ir::typeName(type), flag, textOf(a), textOf(b));
  if (const auto it = chosen_.find(key); it != chosen_.end()) return it->second;
  const std::string id = freeName("either", ids_);
  const std::string name =
      choices_.name(flag, [&](const std::string& wish) { return freeName(wish, names_); });
  united_.graph.add(id, fmt::format("choose_{}", ir::typeName(type)),
                    graph::Inputs{{"on", {ParameterRef{name}, {}}}, {"first", a}, {"second", b}});
  united_.graph.nodes.back().term = id;
  ++united_.choices;
  return chosen_[key] = {NodeRef{id, {}}, {}};
}

// -- nodes --

std::string Uniter::node(uint32_t key, const Members& members) {
  if (made_[key].state == State::Done) return made_[key].id;
  if (made_[key].state == State::Unknown) {
    made_[key].state = State::Open;
    std::string id = build(key, keys_.members(key));
    made_[key] = {State::Done, id};
    return id;
  }
  // What another member has below it stands above it here: these members get a node of their own.
  Members own;
  std::copy_if(members.begin(), members.end(), std::back_inserter(own),
               [&](uint32_t member) { return keys_.nodeOf(key, member) != nullptr; });
  Made& copy = copies_[{key, own}];
  if (copy.state == State::Open) wrong(fmt::format("'{}' needs itself", keys_.node(key).id));
  if (copy.state == State::Unknown) {
    copy.state = State::Open;
    copy.id = build(key, own);
    copy.state = State::Done;
  }
  return copy.id;
}

std::string Uniter::build(uint32_t key, const Members& members) {
  const Node& first = keys_.node(key);
  const Result<const lang::NodeDecl*> decl = library_.node(first.type);
  if (!decl || !wrong_.empty()) {
    wrong(fmt::format("there is no node '{}'", first.type));
    return first.id;
  }
  graph::Inputs inputs;
  for (const lang::Param& param : (*decl)->params) {
    Sources sources;
    bool given = false;
    for (const uint32_t m : members) {
      const Node& own = *keys_.nodeOf(key, m);
      const auto it = std::find_if(own.inputs.begin(), own.inputs.end(),
                                   [&](const auto& input) { return input.first == param.name; });
      given = given || it != own.inputs.end();
      Source by_default{Literal{param.type, param.default_value.value_or(ir::Components{})}, {}};
      sources.emplace_back(m,
                           it != own.inputs.end() ? widened(it->second, param.type) : std::move(by_default));
    }
    if (!given) continue;
    if (const auto* image = std::get_if<TextureRef>(&sources[0].second.from)) {
      texture(image->name);
      inputs.emplace_back(param.name, sources[0].second);
      continue;
    }
    std::string name = fmt::format("{}_{}", first.id, param.name);
    std::replace(name.begin(), name.end(), '.', '_');
    inputs.emplace_back(param.name, unify(std::move(sources), {param.type, param.range, std::move(name)}));
  }
  std::string id = freeName(first.id, ids_);
  const size_t at = united_.graph.add(id, first.type, std::move(inputs));
  Node& made = united_.graph.nodes[at];
  made.variant = first.variant;
  made.at_vertices = first.at_vertices;
  if (!first.term.empty()) made.term = id;
  return id;
}

void Uniter::outputs(const lang::TemplateDecl& decl) {
  for (const lang::PortDecl& port : decl.ports) {
    Sources sources;
    size_t given = 0;
    for (uint32_t m = 0; m < members_.size(); ++m) {
      const auto& own = members_[m]->outputs;
      const auto it = std::find_if(own.begin(), own.end(),
                                   [&](const auto& output) { return output.first == port.param.name; });
      if (it != own.end()) {
        ++given;
        sources.emplace_back(m, widened(it->second, port.param.type));
        continue;
      }
      const std::optional<ir::Components> value =
          port.default_value ? constantOf(*port.default_value) : std::nullopt;
      sources.emplace_back(m, Source{Literal{port.param.type, value.value_or(ir::Components{})}, {}});
      if (!value) sources.back().first = ~uint32_t{0};
    }
    if (given == 0) continue;
    const bool unsaid = std::any_of(sources.begin(), sources.end(),
                                    [](const auto& source) { return source.first == ~uint32_t{0}; });
    if (unsaid) return wrong(fmt::format("the port '{}' has no constant for a default", port.param.name));
    united_.graph.outputs.emplace_back(
        port.param.name, unify(std::move(sources),
                               {port.param.type, port.param.range, fmt::format("port_{}", port.param.name)}));
  }
}

void Uniter::skipped() {
  for (const graph::Skipped& skipped : members_[0]->skipped) {
    const bool everywhere = std::all_of(members_.begin(), members_.end(), [&](const Graph* member) {
      return std::any_of(member->skipped.begin(), member->skipped.end(),
                         [&](const graph::Skipped& other) { return other.term == skipped.term; });
    });
    if (everywhere && !ids_.contains(skipped.term)) united_.graph.skip(skipped.term, skipped.reason);
  }
}

void Uniter::fill() {
  choices_.each([&](const std::string& name, const std::vector<bool>& on) {
    graph::Parameter flag;
    flag.name = name;
    flag.type = ir::Type::Bool;
    united_.graph.parameters.push_back(flag);
    auto& values = numbers_[name];
    values.resize(members_.size());
    for (size_t m = 0; m < on.size(); ++m) values[m] = ir::Components{on[m] ? 1.0 : 0.0};
  });
  united_.fills.resize(members_.size());
  for (uint32_t m = 0; m < members_.size(); ++m) {
    Fill& fill = united_.fills[m];
    for (const ir::Parameter& p : united_.graph.parameters) {
      const auto it = numbers_.find(p.name);
      const bool own = members_[m]->findParameter(p.name).has_value();
      const bool said = it != numbers_.end() && it->second[m];
      fill.numbers.push_back({own, said ? *it->second[m] : p.value});
    }
    for (const ir::TextureSlot& slot : united_.graph.textures) {
      const auto it = texels_.find(slot.name);
      const bool own = members_[m]->findTexture(slot.name).has_value();
      fill.textures.push_back({own, it == texels_.end() ? Texel().value() : it->second[m].value()});
    }
  }
}

Result<United> Uniter::run() {
  const std::string& template_name = members_[0]->template_name;
  for (const Graph* member : members_) {
    if (member->template_name != template_name)
      return tl::make_unexpected(differ("they are for different templates"));
  }
  for (const Graph* member : members_) {
    if (member->attributes != members_[0]->attributes)
      return tl::make_unexpected(differ("the primitives need different vertex stages"));
  }
  const Result<const lang::TemplateDecl*> decl = library_.template_(template_name);
  if (!decl) return tl::make_unexpected(decl.error());
  united_.graph.template_name = template_name;
  united_.graph.attributes = members_[0]->attributes;
  index();
  outputs(**decl);
  if (wrong_.empty()) {
    skipped();
    fill();
    for (size_t i = 0; i < united_.graph.nodes.size(); ++i)
      united_.graph.nodes[i].place = static_cast<uint32_t>(i);
    Diagnostics found = graph::check(united_.graph, library_);
    const auto error = std::find_if(found.begin(), found.end(),
                                    [](const Diagnostic& d) { return d.severity == Severity::Error; });
    if (error != found.end()) wrong(fmt::format("together they are no graph: {}", error->message));
  }
  if (!wrong_.empty()) return tl::make_unexpected(std::move(wrong_));
  return std::move(united_);
}

}  // namespace

Result<United> unite(std::span<const Graph* const> members, const lang::Library& library) {
  return Uniter(members, library).run();
}

Graph instance(const United& united, size_t member, const Graph& own) {
  Graph graph = united.graph;
  graph.name = own.name;
  const Fill& fill = united.fills[member];
  for (size_t i = 0; i < graph.parameters.size(); ++i) {
    ir::Parameter& p = graph.parameters[i];
    const std::optional<size_t> at = fill.numbers[i].own ? own.findParameter(p.name) : std::nullopt;
    p.value = at ? own.parameters[*at].value : fill.numbers[i].value;
    p.pointer = at ? own.parameters[*at].pointer : std::string();
  }
  for (size_t i = 0; i < graph.textures.size(); ++i) {
    graph::Texture& slot = graph.textures[i];
    const std::optional<size_t> at = fill.textures[i].own ? own.findTexture(slot.name) : std::nullopt;
    if (at) slot = own.textures[*at];
  }
  return graph;
}

}  // namespace lacquer::programs
