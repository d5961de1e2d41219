#include "material/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "lang/suggest.h"
#include "support/letters.h"

namespace lacquer::material {

namespace {

/// `at`: a word of the extension's text.
Diagnostic problem(const lang::ExtensionDecl& decl, std::string_view at, std::string code,
                   std::string message, std::string help = {}) {
  Diagnostic one{std::move(code),    Severity::Error, {std::string(decl.origin.file), 0, 0, {}},
                 std::move(message), std::move(help), {}};
  locate(one, decl.text, static_cast<size_t>(at.data() - decl.text.data()), at.size());
  return one;
}

void addProperties(Schema& schema, uint16_t extension, std::span<const lang::PropertyDecl> decls,
                   const std::string& path) {
  for (const lang::PropertyDecl& decl : decls) {
    const std::string here = path + std::string(decl.name);
    if (decl.kind == Kind::Object) {
      addProperties(schema, extension, decl.members, here + "/");
      continue;
    }
    schema.properties.push_back({&decl, extension, here, {}, {}});
  }
}

void addRows(std::vector<Row>& out, std::string_view object, std::span<const lang::PropertyDecl> decls) {
  for (const lang::PropertyDecl& decl : decls) {
    if (decl.kind != Kind::Object) out.push_back({object, &decl});
    addRows(out, decl.name, decl.members);
  }
}

/// Without `as` the role is the name itself, in the same place of the text.
bool isSaid(const lang::PropertyDecl& decl) { return decl.role.data() != decl.name.data(); }

/// Which properties parts call by one name. To each vendor a name means its own property; what another
/// property says by `as` is a property of its own text or of the library's, else the only one of that name.
void addRoles(Schema& schema) {
  std::map<std::string_view, std::set<std::string_view>> named,
      meant;  // roles, and the vendors that have one
  for (const Property& property : schema.properties) {
    if (!isSaid(*property.decl)) named[property.decl->role].insert(schema.vendorOf(property));
  }
  std::vector<std::string_view> owners;
  for (const Property& property : schema.properties) {
    const std::string_view vendor = schema.vendorOf(property);
    const std::set<std::string_view>& others = named[property.decl->role];
    const bool own = !isSaid(*property.decl) || others.contains(vendor);
    owners.push_back(own                   ? vendor
                     : others.contains("") ? std::string_view{}
                     : others.size() == 1  ? *others.begin()
                                           : vendor);
    meant[property.decl->role].insert(owners.back());
  }
  for (size_t i = 0; i < schema.properties.size(); ++i) {
    Property& property = schema.properties[i];
    const std::string_view role = property.decl->role;
    const bool alone = owners[i].empty() || meant[role].size() == 1;
    property.role = alone ? std::string(role) : fmt::format("{}.{}", owners[i], role);
    property.parameter_name =
        alone ? parameterName(role) : fmt::format("{}_{}", lowered(owners[i]), parameterName(role));
    constexpr std::string_view kTexture = "_texture";
    std::string& name = property.parameter_name;
    if (property.decl->kind == Kind::Texture && name.ends_with(kTexture))
      name.resize(name.size() - kTexture.size());
    schema.roles[property.role].push_back(static_cast<uint16_t>(i));
  }
}

void checkRoles(const Schema& schema, Diagnostics& wrong) {
  for (const auto& [role, all] : schema.roles) {
    // What is wrong is wrong in the text of who came later: the library's own come first.
    std::vector<uint16_t> providers = all;
    std::stable_partition(providers.begin(), providers.end(), [&](uint16_t property) {
      return schema.vendorOf(schema.properties[property]).empty();
    });
    const lang::PropertyDecl& first = *schema.properties[providers[0]].decl;
    // One may be without `as`: it is the one that the others are said to mean.
    bool named = !isSaid(first);
    for (size_t i = 1; i < providers.size(); ++i) {
      const Property& other = schema.properties[providers[i]];
      const bool alike = other.decl->type == first.type && other.decl->kind == first.kind &&
                         other.decl->members.size() == first.members.size();
      const bool meant = isSaid(*other.decl) || !std::exchange(named, true);
      if (alike && meant) continue;
      wrong.push_back(problem(
          *schema.extensions[other.extension], other.decl->name, "duplicate-name",
          fmt::format("two extensions have a property '{}'{}", role, alike ? "" : " of different types"),
          alike ? "where they mean the same, say so by `as`; else give one another name by `as`"
                : "give one of them another name by `as`"));
    }
  }
}

/// Calls `take` with every name that a property has in shaders.
template <class Take>
void forParameterNames(const Property& property, const Take& take) {
  if (property.decl->kind != Kind::Texture) return take(property.parameter_name);
  take(property.parameter_name + "_texture");
  for (const lang::PropertyDecl& member : property.decl->members)
    take(fmt::format("{}_{}", property.parameter_name, parameterName(member.name)));
  for (const char* part : {"offset", "rotation", "scale"})
    take(fmt::format("{}_uv_{}", property.parameter_name, part));
}

/// Where names of two vendors' properties come to one in shaders, both have their extension's name in front.
void distinguishParameterNames(Schema& schema) {
  std::map<std::string, std::set<std::string_view>> owners;  // the names, and the vendors that have them
  for (const Property& property : schema.properties) {
    forParameterNames(property,
                      [&](const std::string& name) { owners[name].insert(schema.vendorOf(property)); });
  }
  std::set<std::string_view> shared;
  for (const Property& property : schema.properties) {
    if (property.role != property.decl->role || schema.vendorOf(property).empty()) continue;
    // What several properties mean is one parameter.
    if (schema.roles.find(property.role)->second.size() > 1) continue;
    bool clash = false;
    forParameterNames(property, [&](const std::string& name) { clash = clash || owners[name].size() > 1; });
    if (clash) shared.insert(property.role);
  }
  for (Property& property : schema.properties) {
    if (shared.contains(property.role))
      property.parameter_name =
          fmt::format("{}_{}", lowered(schema.vendorOf(property)), property.parameter_name);
  }
}

/// Parameters and textures have names of their own, which are made of those of the properties: what one
/// property takes no other may.
void checkParameterNames(const Schema& schema, Diagnostics& wrong) {
  std::map<std::string, const Property*> owners;
  for (const Property& property : schema.properties) {
    forParameterNames(property, [&](const std::string& name) {
      const auto [owner, fresh] = owners.try_emplace(name, &property);
      if (fresh || owner->second->role == property.role) return;
      const bool theirs = schema.vendorOf(property).empty() && !schema.vendorOf(*owner->second).empty();
      const Property& here = theirs ? *owner->second : property;
      const Property& other = theirs ? property : *owner->second;
      wrong.push_back(
          problem(*schema.extensions[here.extension], here.decl->name, "duplicate-name",
                  fmt::format("'{}' and '{}' of {} would both be called '{}' in shaders", here.decl->name,
                              other.decl->name, schema.extensions[other.extension]->name, name),
                  "give this one another name by `as`"));
    });
  }
}

/// The names of other extensions that an extension states are those of some.
void checkRelations(const Schema& schema, const lang::ExtensionDecl& decl, Diagnostics& wrong) {
  std::vector<std::string_view> names;
  for (const lang::ExtensionDecl* one : schema.extensions) {
    if (one->core) continue;
    names.push_back(one->name);
    names.insert(names.end(), one->drafts.begin(), one->drafts.end());
  }
  const auto check = [&](const std::vector<std::string_view>& list) {
    for (const std::string_view name : list) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        wrong.push_back(problem(decl, name, "unknown-extension",
                                fmt::format("there is no extension '{}'", name),
                                lang::didYouMean(name, names)));
      } else if (name == decl.name) {
        wrong.push_back(problem(decl, name, "wrong-extension", "this is the extension itself"));
      }
    }
  };
  for (const auto* list : {&decl.needs, &decl.excludes, &decl.yields_to, &decl.loses_to}) check(*list);
  for (const std::string_view draft : decl.drafts) {
    if (std::count(names.begin(), names.end(), draft) == 1) continue;
    wrong.push_back(
        problem(decl, draft, "duplicate-name", fmt::format("'{}' is another extension's name", draft)));
  }
  for (const std::string_view over : decl.yields_to) {
    const std::optional<uint16_t> other = schema.find(over);
    if (!other) continue;
    const auto& back = schema.extensions[*other]->yields_to;
    if (std::find(back.begin(), back.end(), decl.name) == back.end()) continue;
    wrong.push_back(problem(decl, over, "wrong-extension", fmt::format("'{}' yields to this one, too", over),
                            "neither would have an effect"));
  }
  constexpr std::string_view kStatus[] = {"ratified", "candidate", "draft", "archived", "vendor"};
  if (!decl.status.empty() &&
      std::find(std::begin(kStatus), std::end(kStatus), decl.status) == std::end(kStatus)) {
    wrong.push_back(problem(
        decl, decl.status, "unknown-value", fmt::format("'{}' is no status", decl.status),
        lang::didYouMean(decl.status, kStatus, "there are ratified, candidate, draft, archived and vendor")));
  }
}

}  // namespace

std::string parameterName(std::string_view property) {
  std::string name;
  for (const char c : property) {
    if (isUpper(c) && !name.empty()) name += '_';
    name += lowerCase(c);
  }
  return name;
}

std::optional<uint16_t> Schema::find(std::string_view name) const {
  for (size_t i = 0; i < extensions.size(); ++i) {
    const auto& drafts = extensions[i]->drafts;
    if (extensions[i]->name == name || std::find(drafts.begin(), drafts.end(), name) != drafts.end())
      return static_cast<uint16_t>(i);
  }
  return std::nullopt;
}

std::string Schema::pathOf(uint16_t extension) const {
  const lang::ExtensionDecl& decl = *extensions[extension];
  if (decl.core) return {};
  std::string outer;
  if (const std::optional<uint16_t> around = decl.inside.empty() ? std::nullopt : find(decl.inside))
    outer = pathOf(*around) + "/";
  return outer + "extensions/" + std::string(decl.name);
}

uint16_t Schema::indexOf(const lang::PropertyDecl& decl) const {
  const auto it = std::find_if(properties.begin(), properties.end(),
                               [&](const Property& property) { return property.decl == &decl; });
  return static_cast<uint16_t>(it - properties.begin());
}

std::string_view Schema::vendorOf(const Property& property) const {
  return extensions[property.extension]->origin.vendor;
}

std::vector<Row> Schema::rows() const {
  std::vector<Row> rows;
  for (const lang::ExtensionDecl* extension : extensions)
    addRows(rows, extension->core ? "material" : extension->name, extension->properties);
  return rows;
}

Result<Schema> schemaOf(const lang::Library& library, Diagnostics* aside) {
  Schema schema;
  schema.library = &library;
  Diagnostics wrong;
  for (const std::string_view name : library.names(lang::DeclKind::Extension)) {
    const Result<const lang::ExtensionDecl*> found = library.extension(name);
    const lang::ExtensionDecl* written = found || aside == nullptr ? nullptr : library.writtenExtension(name);
    if (written != nullptr) {
      aside->insert(aside->end(), found.error().begin(), found.error().end());
      schema.extensions.push_back(written);
    } else if (!found) {
      wrong.insert(wrong.end(), found.error().begin(), found.error().end());
    } else {
      schema.extensions.push_back(*found);
    }
  }
  std::stable_partition(schema.extensions.begin(), schema.extensions.end(),
                        [](const lang::ExtensionDecl* decl) { return decl->core; });
  const bool has_core = !schema.extensions.empty() && schema.extensions[0]->core;
  // What is wrong with the file that holds it has been said.
  if (!has_core && wrong.empty()) {
    return fail("unknown-extension", {}, "no node file declares glTF's own material",
                "`material gltf { ... }` does");
  }
  for (size_t i = 1; i < schema.extensions.size(); ++i) {
    const lang::ExtensionDecl& decl = *schema.extensions[i];
    if (decl.core) {
      wrong.push_back(problem(decl, decl.name, "duplicate-name", "there is another `material`",
                              fmt::format("glTF's own is '{}'", schema.extensions[0]->name)));
    }
    // One level is all that glTF has; a longer chain could close in a circle.
    const std::optional<uint16_t> around = decl.inside.empty() ? std::nullopt : schema.find(decl.inside);
    if (!decl.inside.empty() && (!around || !schema.extensions[*around]->inside.empty() || *around == 0)) {
      wrong.push_back(problem(decl, decl.inside, "unknown-extension",
                              fmt::format("there is no extension '{}' for it to stand in", decl.inside),
                              "it must be one that stands in the material itself"));
    }
  }
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  for (size_t i = 0; i < schema.extensions.size(); ++i) {
    const auto index = static_cast<uint16_t>(i);
    const std::string path = schema.pathOf(index);
    addProperties(schema, index, schema.extensions[i]->properties, path.empty() ? "" : path + "/");
  }
  addRoles(schema);
  distinguishParameterNames(schema);
  checkRoles(schema, wrong);
  checkParameterNames(schema, wrong);
  for (const lang::ExtensionDecl* decl : schema.extensions) checkRelations(schema, *decl, wrong);
  if (aside != nullptr) {
    aside->insert(aside->end(), wrong.begin(), wrong.end());
    return schema;
  }
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  return schema;
}

}  // namespace lacquer::material
