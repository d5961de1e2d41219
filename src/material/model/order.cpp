#include "model/order.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "lang/reporter.h"
#include "lang/suggest.h"

namespace lacquer::model {

using lang::LineDecl;
using lang::PartDecl;

namespace {

using Parts = std::vector<const PartDecl*>;
using ByName = std::map<std::string_view, const PartDecl*>;

/// The part that a name means in another part's text.
const PartDecl* find(const ByName& parts, const PartDecl& in, std::string_view name) {
  auto it = parts.find(name);
  if (it == parts.end() && !in.origin.vendor.empty())
    it = parts.find(fmt::format("{}.{}", in.origin.vendor, name));
  return it == parts.end() ? nullptr : it->second;
}

/// Whether `upper` says, or one of those over which it lies, that it lies over `lower`.
bool liesOver(const PartDecl& upper, const PartDecl& lower, const ByName& parts) {
  std::vector<const PartDecl*> left{&upper};
  std::set<const PartDecl*> seen;
  while (!left.empty()) {
    const PartDecl* part = left.back();
    left.pop_back();
    if (part == &lower) return true;
    if (!seen.insert(part).second) continue;
    for (const std::string_view name : part->over) {
      if (const PartDecl* below = find(parts, *part, name)) left.push_back(below);
    }
  }
  return false;
}

/// The place for a part among those that have one; nothing where it lies over one that has none, or over
/// none.
std::optional<size_t> placeOf(const PartDecl& part, const Parts& placed, const ByName& names) {
  Parts below;
  for (const std::string_view name : part.over) {
    const PartDecl* found = find(names, part, name);
    if (found == nullptr) return std::nullopt;
    below.push_back(found);
  }
  if (below.empty()) return std::nullopt;
  const auto highest = std::find_if(placed.rbegin(), placed.rend(), [&](const PartDecl* one) {
    return std::find(below.begin(), below.end(), one) != below.end();
  });
  auto at = highest.base();
  while (at != placed.end() && liesOver(**at, **highest, names)) ++at;
  return static_cast<size_t>(at - placed.begin());
}

void reportUnplaced(const lang::Library& library, const Parts& left, Diagnostics& wrong) {
  for (const PartDecl* part : left) {
    lang::Reporter reporter(part->origin.file, part->text);
    const auto unknown = std::find_if(part->over.begin(), part->over.end(), [&](std::string_view name) {
      return !library.has(lang::DeclKind::Part, name, part->origin.vendor);
    });
    if (part->over.empty()) {
      reporter.error("unknown-part", part->span,
                     fmt::format("the part '{}' has no place among the layers", part->name),
                     "say `over PART` behind its name");
    } else if (unknown != part->over.end()) {
      reporter.error("unknown-part", part->span,
                     fmt::format("there is no part '{}' for it to lie over", *unknown),
                     lang::didYouMean(*unknown, library.names(lang::DeclKind::Part)));
    } else {
      reporter.error(
          "recursion", part->span,
          fmt::format("the part '{}' lies over a part that has no place or lies over it", part->name),
          "the lowest of them names a part of the layers");
    }
    Diagnostics one = reporter.take();
    wrong.insert(wrong.end(), one.begin(), one.end());
  }
}

/// What a part puts out, reads from below and puts something in the place of. Of a light also whether it is
/// read: what replaces one acts on the parts below.
struct Touched {
  std::set<uint32_t> put, read, replaced, light;

  void add(const Model& model, const Value& value) {
    if (value.kind == Value::Kind::Below) read.insert(value.index);
    if (value.kind == Value::Kind::Id && model.ids[value.index].light) light.insert(value.index);
    for (const Value& arg : value.args) add(model, arg);
  }
};

bool meet(const std::set<uint32_t>& a, const std::set<uint32_t>& b) {
  return std::any_of(a.begin(), a.end(), [&](uint32_t x) { return b.contains(x); });
}

bool orderMatters(const Touched& a, const Touched& b) {
  return meet(a.put, b.put) || meet(a.put, b.read) || meet(b.put, a.read) || meet(a.replaced, b.replaced) ||
         meet(a.replaced, b.light) || meet(b.replaced, a.light);
}

std::map<uint32_t, Touched> touchedBy(const Model& model, const std::vector<uint32_t>& parts) {
  std::map<uint32_t, Touched> all;
  for (const uint32_t part : parts) all[part];
  for (const Line& line : model.lines) {
    const auto it = all.find(line.part);
    if (it == all.end()) continue;
    if (line.kind == LineDecl::Kind::Out) it->second.put.insert(line.id);
    if (line.kind == LineDecl::Kind::Replace) it->second.replaced.insert(line.target.index);
    for (const Alternative& one : line.alternatives) it->second.add(model, one.value);
  }
  return all;
}

}  // namespace

Parts withInserted(const lang::Library& library, Parts listed, Diagnostics& wrong) {
  Parts left;
  for (const std::string_view name : library.names(lang::DeclKind::Part)) {
    const Result<const PartDecl*> part = library.part(name);
    if (!part) {
      wrong.insert(wrong.end(), part.error().begin(), part.error().end());
    } else if (std::find(listed.begin(), listed.end(), *part) == listed.end()) {
      left.push_back(*part);
    }
  }
  ByName names;
  for (const PartDecl* part : listed) names.emplace(part->name, part);
  for (bool found = true; found && !left.empty();) {
    found = false;
    for (auto it = left.begin(); it != left.end();) {
      const std::optional<size_t> at = placeOf(**it, listed, names);
      if (!at) {
        ++it;
        continue;
      }
      listed.insert(listed.begin() + static_cast<ptrdiff_t>(*at), *it);
      names.emplace((*it)->name, *it);
      it = left.erase(it);
      found = true;
    }
  }
  reportUnplaced(library, left, wrong);
  return listed;
}

std::vector<std::pair<uint32_t, uint32_t>> findUnordered(const Model& model, const lang::Library& library) {
  std::set<std::string_view> listed;
  for (const std::string_view name : library.names(lang::DeclKind::Layers)) {
    if (const auto layers = library.layers(name))
      listed.insert((*layers)->parts.begin(), (*layers)->parts.end());
  }
  ByName names;
  std::vector<uint32_t> inserted;
  for (uint32_t i = 0; i < model.parts.size(); ++i) {
    names.emplace(model.parts[i].name, &model.declOf(i));
    if (!listed.contains(model.parts[i].name)) inserted.push_back(i);
  }
  const std::map<uint32_t, Touched> touched = touchedBy(model, inserted);
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  for (size_t k = 0; k < inserted.size(); ++k) {
    // Those up to the next listed part are over the same one.
    for (size_t j = k + 1; j < inserted.size() && inserted[j] - inserted[k] == j - k; ++j) {
      const uint32_t lower = inserted[k], upper = inserted[j];
      if (liesOver(model.declOf(upper), model.declOf(lower), names)) continue;
      if (orderMatters(touched.at(lower), touched.at(upper))) pairs.emplace_back(lower, upper);
    }
  }
  return pairs;
}

Diagnostic unorderedParts(const PartDecl& lower, const PartDecl& upper) {
  std::string over;
  for (const std::string_view name : upper.over) over += fmt::format("{}, ", name);
  Diagnostic warning{
      "unordered-parts",
      Severity::Warning,
      {std::string(upper.origin.file), 0, 0, {}},
      fmt::format("the parts '{}' and '{}' lie over the same part, and nothing says which is above; "
                  "by their names it is '{}'",
                  lower.name, upper.name, upper.name),
      fmt::format("say `over {}{}` of '{}', or `over` '{}' of the other", over, lower.name, upper.name,
                  upper.name),
      {}};
  locate(warning, upper.text, upper.span.offset, upper.span.length);
  return warning;
}

}  // namespace lacquer::model
