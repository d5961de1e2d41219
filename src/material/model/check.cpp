#include "model/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "lang/checker.h"
#include "lang/reporter.h"
#include "lang/suggest.h"
#include "model/names.h"
#include "model/types.h"

namespace lacquer::model {

namespace {

using lang::LineDecl;
using LineKind = LineDecl::Kind;

class Check {
public:
  Check(const lang::Library& library, const Model& model, const Uses& uses)
      : model_(model), uses_(uses), types_(library, model) {}

  Diagnostics run() {
    paths();
    arguments();
    ports();
    doubles();
    for (const Uses::Placed& placed : uses_.lines) line(placed);
    return std::move(wrong_);
  }

private:
  void error(const Text& text, lang::Span span, std::string code, std::string message,
             std::string help = {}) {
    lang::Reporter reporter(text.file, text.text);
    reporter.error(code, span, std::move(message), std::move(help));
    for (Diagnostic& one : reporter.take()) {
      // A line that is read often is told once.
      const auto same = [&](const Diagnostic& other) { return format(other) == format(one); };
      if (std::none_of(wrong_.begin(), wrong_.end(), same)) wrong_.push_back(std::move(one));
    }
  }

  bool fits(const Value& value, std::string_view path, std::set<uint32_t>& seen) const;
  bool fits(uint32_t id, std::string_view path, std::set<uint32_t>& seen) const;
  void paths();
  void arguments();
  void ports();
  void doubles();
  void line(const Uses::Placed& placed);
  const Uses::Placed* constantLine(const Value& value) const;
  const Uses::Placed* profiles(const Value& value) const;
  bool ownsMistake(const Uses::Argument& use, const Uses::Placed& profile) const;
  std::string imageHelp(const Uses::Argument& use) const;
  void range(const Uses::Argument& use);
  const lang::NodeDecl* several(const Value& value) const;
  void typed(const Uses::Placed& placed, std::optional<ir::Type> wanted, std::string_view what);
  void added(const Uses::Placed& placed);

  const Model& model_;
  const Uses& uses_;
  Types types_;
  Diagnostics wrong_;
};

/// Whether what is behind an id's point is an output of one of its nodes, or a swizzle. `seen`: ids that were
/// asked.
bool Check::fits(uint32_t id, std::string_view path, std::set<uint32_t>& seen) const {
  if (!seen.insert(id).second) return false;
  for (const uint32_t line : model_.ids[id].lines) {
    for (const Alternative& alternative : model_.lines[line].alternatives) {
      if (fits(alternative.value, path, seen)) return true;
    }
  }
  return false;
}

bool Check::fits(const Value& value, std::string_view path, std::set<uint32_t>& seen) const {
  constexpr size_t kMost = 500;  // ids that are other names of one another
  if (path.empty() || isSwizzle(path) || seen.size() > kMost) return true;
  if (value.kind == Value::Kind::Id) return value.path.empty() ? fits(value.index, path, seen) : false;
  if (value.kind == Value::Kind::Below) return true;
  if (value.kind != Value::Kind::Call) return false;
  const std::string_view head = path.substr(0, path.find('.'));
  const std::vector<lang::Param>& results = model_.nodeOf(value).results;
  const bool output = std::any_of(results.begin(), results.end(),
                                  [&](const lang::Param& result) { return result.name == head; });
  return output && (head.size() == path.size() || isSwizzle(path.substr(head.size() + 1)));
}

void Check::paths() {
  for (const Uses::Path& use : uses_.paths) {
    std::set<uint32_t> seen;
    if (fits(use.id, use.path, seen)) continue;
    error(use.text, use.span, "unknown-output",
          fmt::format("'{}' has no output '{}'", model_.ids[use.id].name, use.path));
  }
}

/// The line of a name that stands for a number, and for nothing else.
const Uses::Placed* Check::constantLine(const Value& value) const {
  if (value.kind != Value::Kind::Id || !value.path.empty()) return nullptr;
  const Id& id = model_.ids[value.index];
  if (id.lines.size() != 1 || !id.replaced.empty()) return nullptr;
  const Line& line = model_.lines[id.lines[0]];
  const bool constant =
      line.alternatives.size() == 1 && line.alternatives[0].value.kind == Value::Kind::Constant;
  return constant ? &uses_.lines[id.lines[0]] : nullptr;
}

/// The profile's line that a name stands for, where it stands in place of a part's.
const Uses::Placed* Check::profiles(const Value& value) const {
  if (value.kind != Value::Kind::Id || !model_.ids[value.index].overridden) return nullptr;
  const std::vector<uint32_t>& lines = model_.ids[value.index].lines;
  return lines.empty() ? nullptr : &uses_.lines[lines[0]];
}

/// The library's own profile is right: what does not suit it in another text is wrong there.
bool Check::ownsMistake(const Uses::Argument& use, const Uses::Placed& profile) const {
  const auto built_in = [&](const Text& text) {
    const bool of_profile = model_.profile_origin.built_in && model_.profile_origin.file == text.file;
    return of_profile || std::any_of(model_.parts.begin(), model_.parts.end(), [&](const Part& part) {
             return part.origin.built_in && part.origin.file == text.file;
           });
  };
  return built_in(profile.text) && !built_in(use.text);
}

/// For a texture's name where the texture itself is wanted.
std::string Check::imageHelp(const Uses::Argument& use) const {
  if (use.param->type != ir::Type::Texture2D || use.value.kind != Value::Kind::Role) return {};
  const Role& role = model_.roles[use.value.index];
  const lang::PropertyDecl& decl = *model_.schema->properties[role.providers[0]].decl;
  if (decl.kind != material::Kind::Texture || use.value.member >= 0 || use.value.coordinate) return {};
  return fmt::format("the texture itself, for a node that samples it, is '{}.image'", role.name);
}

void Check::range(const Uses::Argument& use) {
  const Uses::Placed* named = constantLine(use.value);
  const Value& value = named == nullptr ? use.value : model_.lines[named->line].alternatives[0].value;
  if (value.kind != Value::Kind::Constant) return;
  for (int c = 0; c < ir::componentCount(value.type); ++c) {
    const double x = value.constant[static_cast<size_t>(c)];
    if (use.param->range.contains(x)) continue;
    error(named == nullptr ? use.text : named->text,
          named == nullptr ? use.span : named->decl->alternatives[0].value->span, "out-of-range",
          fmt::format("{} is not in the range of '{}'", x, use.param->name),
          fmt::format("the range is {}", ir::rangeText(use.param->range)));
    return;
  }
}

/// The node of a value that names none of its results, where every line for it has a node with several.
const lang::NodeDecl* Check::several(const Value& value) const {
  if (value.kind != Value::Kind::Id || !value.path.empty()) return nullptr;
  const lang::NodeDecl* node = nullptr;
  for (const uint32_t line : model_.ids[value.index].lines) {
    for (const Alternative& one : model_.lines[line].alternatives) {
      if (one.value.kind == Value::Kind::None) continue;
      if (one.value.kind != Value::Kind::Call) return nullptr;
      node = &model_.nodeOf(one.value);
      if (node->results.size() < 2) return nullptr;
    }
  }
  return node;
}

void Check::arguments() {
  for (const Uses::Argument& use : uses_.arguments) {
    if (const lang::NodeDecl* node = several(use.value)) {
      error(use.text, use.span, "unknown-output",
            fmt::format("'{}' has several results", model_.ids[use.value.index].name),
            fmt::format("name one: '{}.{}'", model_.ids[use.value.index].name, node->results[0].name));
      continue;
    }
    const std::optional<ir::Type> type = types_.of(use.value);
    if (!type) continue;
    if (*type != use.param->type) {
      if (const Uses::Placed* by = profiles(use.value); by != nullptr && !ownsMistake(use, *by)) {
        error(by->text, by->decl->alternatives[0].value->span, "wrong-type",
              fmt::format("'{}' goes into '{}', which is {}; this is {}", by->decl->id, use.param->name,
                          lang::aType(use.param->type), lang::aType(*type)));
        continue;
      }
      error(use.text, use.span, "wrong-type",
            fmt::format("'{}' is {}, this is {}", use.param->name, lang::aType(use.param->type),
                        lang::aType(*type)),
            imageHelp(use));
      continue;
    }
    range(use);
  }
}

/// Ports that lines ask for or put out are those of some template, or what a part above reads.
void Check::ports() {
  for (const Uses::Port& use : uses_.ports) {
    if (types_.port(use.name)) continue;
    error(use.text, use.span, "unknown-port", fmt::format("no template has a port '{}'", use.name),
          lang::didYouMean(use.name, types_.ports()));
  }
  for (const Uses::Placed& placed : uses_.lines) {
    if (placed.decl->kind != LineKind::Out) continue;
    const uint32_t out = model_.lines[placed.line].id;
    if (types_.port(placed.decl->id) || uses_.outs.contains(out)) continue;
    error(placed.text, placed.decl->span, "unknown-port",
          fmt::format("no template has a port '{}', and no part reads `below.{}`", placed.decl->id,
                      placed.decl->id),
          lang::didYouMean(placed.decl->id, types_.ports()));
  }
}

/// One term says an id, or what a port takes, in one line: of two, only the first could ever count. Lines of
/// a part are not said again by another part.
void Check::doubles() {
  std::map<std::tuple<LineKind, uint32_t, uint32_t, uint32_t>, const Uses::Placed*> seen;
  std::map<uint32_t, const Uses::Placed*> of_part;
  for (const Uses::Placed& placed : uses_.lines) {
    const Line& line = model_.lines[placed.line];
    if (line.kind == LineKind::Replace || line.kind == LineKind::Require) continue;
    if (uses_.overlays.contains(placed.line)) continue;
    const bool out = line.kind == LineKind::Out;
    const auto [first, fresh] =
        seen.try_emplace({out ? LineKind::Out : LineKind::Value, line.id, line.part, line.term}, &placed);
    if (!fresh) {
      error(placed.text, placed.decl->span, "duplicate-name",
            fmt::format("'{}' is said already in this term", placed.decl->id),
            "what comes instead of it stands in the same line, behind `or`");
      continue;
    }
    if (out) continue;
    const auto [other, alone] = of_part.try_emplace(line.id, &placed);
    if (alone || model_.lines[other->second->line].part == line.part) continue;
    const bool profile = line.part == model_.parts.size();
    // The library's own lines are right.
    const bool library = line.part < model_.parts.size() && model_.parts[line.part].origin.built_in;
    const Uses::Placed& here = library ? *other->second : placed;
    const Uses::Placed& there = library ? placed : *other->second;
    error(here.text, here.decl->span, "duplicate-name",
          fmt::format("'{}' is said already in {}", placed.decl->id, there.text.file),
          profile
              ? ""
              : fmt::format("give this line another name; `replace {} with ...` puts a value in its place",
                            placed.decl->id));
  }
}

void Check::typed(const Uses::Placed& placed, std::optional<ir::Type> wanted, std::string_view what) {
  const Line& line = model_.lines[placed.line];
  for (size_t i = 0; i < line.alternatives.size(); ++i) {
    const Value& value = line.alternatives[i].value;
    const lang::NodeDecl* node = value.kind == Value::Kind::Call ? &model_.nodeOf(value) : several(value);
    if (node != nullptr && node->results.size() > 1) {
      error(placed.text, placed.decl->alternatives[i].value->span, "unknown-output",
            fmt::format("{} takes one value, '{}' has several results", what, node->name),
            value.kind == Value::Kind::Id
                ? fmt::format("name one: '{}.{}'", model_.ids[value.index].name, node->results[0].name)
                : fmt::format("give it a line `id = {}(...);` and name one: 'id.{}'", node->name,
                              node->results[0].name));
      continue;
    }
    if (!wanted) continue;
    const std::optional<ir::Type> type = types_.of(value);
    if (!type || *type == *wanted) continue;
    error(placed.text, placed.decl->alternatives[i].value->span, "wrong-type",
          fmt::format("{} is {}, this is {}", what, lang::aType(*wanted), lang::aType(*type)));
  }
}

void Check::line(const Uses::Placed& placed) {
  // Of a line whose values stand in one of its own, that one is looked at.
  const Line& line = model_.lines[placed.line];
  if (line.carried) return;
  if (placed.decl->kind == LineKind::Out)
    typed(placed, types_.port(placed.decl->id), fmt::format("the port '{}'", placed.decl->id));
  if (placed.decl->kind == LineKind::Replace) {
    const Value& target = model_.lines[line.kind == LineKind::Replace ? placed.line : placed.line + 1].target;
    if (target.kind == Value::Kind::Id)
      typed(placed, types_.of(target), fmt::format("'{}'", model_.ids[target.index].name));
  }
  if (uses_.adds.contains(placed.line)) added(placed);
}

/// What a profile says beside the lines that it replaces must be for something.
void Check::added(const Uses::Placed& placed) {
  const Line& line = model_.lines[placed.line];
  if ((line.kind != LineKind::Value && line.kind != LineKind::Flag) || uses_.ids.contains(line.id)) return;
  std::vector<std::string_view> names;
  for (const Id& id : model_.ids) {
    if (id.name != placed.decl->id) names.push_back(id.name);
  }
  error(placed.text, placed.decl->span, "unknown-line",
        fmt::format("the profile replaces no line '{}', and nothing reads it", placed.decl->id),
        lang::didYouMean(placed.decl->id, names));
}

}  // namespace

Diagnostics withWrongTemplates(const lang::Library& library, const Diagnostics& wrong) {
  Diagnostics all;
  const auto add = [&](const Diagnostics& list) {
    for (const Diagnostic& one : list) {
      if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
    }
  };
  for (const std::string_view name : library.names(lang::DeclKind::Template)) {
    const Result<const lang::TemplateDecl*> decl = library.template_(name);
    if (!decl) add(decl.error());
  }
  add(wrong);
  return all;
}

Diagnostics check(const lang::Library& library, const Model& model, const Uses& uses) {
  return Check(library, model, uses).run();
}

}  // namespace lacquer::model
