#include "lang/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lang/embedded.h"
#include "lang/lexer.h"
#include "lang/library_impl.h"
#include "lang/suggest.h"
#include "lang/words.h"
#include "support/say_once.h"

namespace lacquer::lang {

std::vector<const NodeDecl*> Library::Impl::forms(std::string_view family) {
  std::vector<Entry*> all;
  if (Entry* one = find(DeclKind::Node, family, here())) {
    all = {one};
  } else if (const auto found = families_.find(family.substr(0, family.find('<')));
             found != families_.end()) {
    for (Entry* entry : found->second) {
      const std::string_view form = entry->plain.empty() ? entry->key : entry->plain;
      if (family == entry->said || family == form || beginsForm(form, family)) all.push_back(entry);
    }
  }
  std::vector<const NodeDecl*> heads;
  for (Entry* entry : all) {
    // A form that another vendor has as well is its vendor's alone.
    if (!entry->plain.empty() && entry->file->vendor != here()) continue;
    if (!entry->head) {
      Reporter silent(entry->file->name, entry->file->text);
      entry->head = std::make_unique<NodeDecl>(parseHead(*entry, silent));
      if (silent.count() != 0) entry->head->results.clear();
    }
    if (!entry->head->results.empty()) heads.push_back(entry->head.get());
  }
  return heads;
}

Surroundings::Found Library::Impl::form(std::string_view key) {
  Entry* entry = find(DeclKind::Node, key);
  Found found;
  found.open = entry->state == Entry::State::Open;
  if (found.open) return found;
  demand(*entry);
  if (!open_.empty()) open_.back()->uses.push_back(entry);
  found.node = entry->good ? entry->node.get() : nullptr;
  return found;
}

Entry* Library::Impl::find(DeclKind kind, std::string_view name, std::string_view vendor) {
  Entry* entry = known(kind, name, vendor);
  if (entry != nullptr || kind > DeclKind::Node) return entry;
  return wake(name, kind == DeclKind::Const) ? known(kind, name, vendor) : nullptr;
}

Entry* Library::Impl::homonym(size_t space, std::string_view name, std::string_view vendor) const {
  const auto alike = homonyms_[space].find(name);
  if (vendor.empty() || alike == homonyms_[space].end()) return nullptr;
  const auto one = std::find_if(alike->second.begin(), alike->second.end(),
                                [&](const Entry* entry) { return entry->file->vendor == vendor; });
  return one == alike->second.end() ? nullptr : *one;
}

Entry* Library::Impl::known(DeclKind kind, std::string_view name, std::string_view vendor) const {
  const size_t space = spaceOf(kind);
  const auto it = index_[space].find(name);
  Entry* entry = it == index_[space].end() ? homonym(space, name, vendor) : it->second;
  return entry == nullptr || entry->kind != kind ? nullptr : entry;
}

std::optional<Surroundings::Found> Library::Impl::find(std::string_view name, bool called) {
  auto it = index_[0].find(name);
  if (it == index_[0].end()) {
    if (wake(name, !called)) it = index_[0].find(name);
  }
  const Entry* own = it == index_[0].end() ? homonym(0, name, here()) : it->second;
  if (own == nullptr) {
    if (!families_.contains(name)) return std::nullopt;
    Found found;
    found.family = true;
    return found;
  }
  const Entry& entry = *own;
  Found found;
  found.kind = entry.kind;
  found.open = entry.state == Entry::State::Open;
  found.constant = entry.good ? entry.constant.get() : nullptr;
  found.node = entry.good ? entry.node.get() : nullptr;
  return found;
}

std::vector<std::string_view> Library::Impl::names(DeclKind kind) {
  if (kind <= DeclKind::Node) wakeAll();
  std::vector<std::string_view> names;
  for (const Entry& entry : entries) {
    if (entry.kind == kind) names.push_back(entry.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string Library::Impl::cycle(std::string_view name) const {
  std::string path;
  for (const Entry* entry : open_) {
    if (path.empty() && entry->name != name) continue;
    path += fmt::format("{} -> ", entry->name);
  }
  return path + std::string(name);
}

tl::unexpected<Diagnostics> Library::Impl::missing(DeclKind kind, std::string_view name) {
  const auto& index = index_[spaceOf(kind)];
  const auto it = index.find(name);
  std::string help = it == index.end() ? didYouMean(name, names(kind))
                                       : fmt::format("'{}' is {}", name, aKind(it->second->kind));
  if (const auto alike = homonyms_[spaceOf(kind)].find(name); alike != homonyms_[spaceOf(kind)].end()) {
    help = "several extensions have one:";
    for (const Entry* entry : alike->second)
      help += fmt::format("{} '{}'", entry == alike->second[0] ? "" : " and", entry->name);
  }
  return fail(fmt::format("unknown-{}", kindName(kind)), {},
              fmt::format("there is no {} '{}'", kindName(kind), name), std::move(help));
}

namespace {

/// More are not worth reading at once.
Diagnostics firstOf(Diagnostics diagnostics) {
  if (diagnostics.size() <= kMostErrors) return diagnostics;
  diagnostics.resize(kMostErrors);
  diagnostics.push_back({"more-errors", Severity::Note, {}, "there are more errors", {}, {}});
  return diagnostics;
}

}  // namespace

Diagnostics Library::Impl::errorsOf(Entry& entry) {
  std::unordered_set<const Entry*> seen;
  Diagnostics diagnostics;
  collect(entry, seen, diagnostics);
  return firstOf(std::move(diagnostics));
}

Library::Library(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Library::Library(Library&&) noexcept = default;
Library& Library::operator=(Library&&) noexcept = default;
Library::~Library() = default;

Result<Library> Library::fromFiles(std::vector<SourceFile> files) {
  Library library(std::make_unique<Impl>());
  if (auto added = library.add(std::move(files)); !added) return tl::make_unexpected(added.error());
  return library;
}

Library Library::embedded() {
  auto impl = std::make_unique<Impl>();
  for (const auto& list : {embeddedNodes(), embeddedTemplates()}) {
    for (const EmbeddedFile& file : list) impl->files.push_back({{}, {}, file.name, file.text, {}});
  }
  impl->scan_errors = impl->scanFrom(0);
  impl->has_standard = true;
  return Library(std::move(impl));
}

Result<void> Library::add(std::vector<SourceFile> files) {
  const std::lock_guard lock(impl_->mutex);
  const size_t first = impl_->files.size();
  for (SourceFile& source : files) {
    File& file = impl_->files.emplace_back();
    file.owned_name = std::move(source.name);
    file.owned_text = std::move(source.text);
    file.name = file.owned_name;
    file.text = file.owned_text;
  }
  Diagnostics errors = impl_->scanFrom(first);
  if (!errors.empty()) return tl::make_unexpected(firstOf(std::move(errors)));
  return {};
}

Result<const ConstDecl*> Library::constant(std::string_view name, std::string_view vendor) const {
  return impl_->get(DeclKind::Const, name, &Entry::constant, vendor);
}

Result<const NodeDecl*> Library::node(std::string_view name, std::string_view vendor) const {
  return impl_->get(DeclKind::Node, name, &Entry::node, vendor);
}

Result<const NodeDecl*> Library::signature(std::string_view name, std::string_view vendor) const {
  {
    const std::lock_guard lock(impl_->mutex);
    Entry* entry = impl_->find(DeclKind::Node, name, vendor);
    const NodeDecl* head = entry == nullptr ? nullptr : impl_->signature(*entry);
    if (head != nullptr) return head;
  }
  return node(name, vendor);
}

Result<const TemplateDecl*> Library::template_(std::string_view name) const {
  return impl_->get(DeclKind::Template, name, &Entry::template_decl);
}

Result<const ExtensionDecl*> Library::extension(std::string_view name) const {
  return impl_->get(DeclKind::Extension, name, &Entry::extension);
}

const TemplateDecl* Library::writtenTemplate(std::string_view name) const {
  return impl_->written(DeclKind::Template, name, &Entry::template_decl);
}

GivenNames Library::givenNames(std::string_view name_of_template) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->givenNames(name_of_template);
}

bool Library::isBuiltIn() const {
  const std::lock_guard lock(impl_->mutex);
  return std::all_of(impl_->files.begin(), impl_->files.end(),
                     [](const File& file) { return file.builtIn(); });
}

const ExtensionDecl* Library::writtenExtension(std::string_view name) const {
  return impl_->written(DeclKind::Extension, name, &Entry::extension);
}

Result<const PartDecl*> Library::part(std::string_view name, std::string_view vendor) const {
  return impl_->get(DeclKind::Part, name, &Entry::part, vendor);
}

Result<const ProfileDecl*> Library::profile(std::string_view name) const {
  return impl_->get(DeclKind::Profile, name, &Entry::profile);
}

Result<const ProfileDecl*> Library::lod(std::string_view name) const {
  return impl_->get(DeclKind::Lod, name, &Entry::profile);
}

Result<const LayersDecl*> Library::layers(std::string_view name) const {
  return impl_->get(DeclKind::Layers, name, &Entry::layers);
}

Result<const SwitchDecl*> Library::switch_(std::string_view name) const {
  return impl_->get(DeclKind::Switch, name, &Entry::switch_decl);
}

Result<std::string> Library::defaultTemplate() const {
  const std::lock_guard lock(impl_->mutex);
  const Entry*& known = impl_->default_template;
  for (auto entry = impl_->entries.rbegin(); known == nullptr && entry != impl_->entries.rend(); ++entry) {
    if (entry->kind != DeclKind::Template) continue;
    if (Impl::outline(*entry).is_default) known = &*entry;
  }
  if (known != nullptr) return std::string(known->name);
  return fail("unknown-template", {}, "no template is named, and none is the default",
              "a template is that which says `default;`");
}

Result<std::string> Library::defaultProfile() const {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->default_profile != nullptr) return std::string(impl_->default_profile->name);
  std::vector<const Entry*> found;
  const Entry* last = nullptr;
  for (const Entry& entry : impl_->entries) {
    if (entry.kind != DeclKind::Profile) continue;
    last = &entry;
    const auto behind = static_cast<uint32_t>(entry.name_begin + entry.said.size());
    Reporter silent(entry.file->name, entry.file->text);
    if (tokenize(silent, behind, entry.end)[0].is("default")) found.push_back(&entry);
  }
  if (found.size() == 1) {
    impl_->default_profile = found[0];
    return std::string(found[0]->name);
  }
  const Entry* shown = found.empty() ? last : found[1];
  Place place;
  if (shown != nullptr) place = {std::string(shown->file->name), shown->line, 0, {}};
  return fail("wrong-profile", place, "one profile must be the default, and only one",
              "say `profile NAME default { ... }` of it");
}

std::vector<const NodeDecl*> Library::forms(std::string_view family) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->forms(family);
}

bool Library::has(DeclKind kind, std::string_view name, std::string_view vendor) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->find(kind, name, vendor) != nullptr;
}

std::vector<std::string_view> Library::names(DeclKind kind) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->names(kind);
}

Diagnostics Library::checkAll() const {
  const std::lock_guard lock(impl_->mutex);
  impl_->wakeAll();
  Diagnostics all = impl_->scan_errors;
  for (Entry& entry : impl_->entries) {
    impl_->demand(entry);
    addOnce(all, entry.diagnostics);
  }
  return firstOf(std::move(all));
}

}  // namespace lacquer::lang
