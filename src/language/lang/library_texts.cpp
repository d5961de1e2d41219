// The library's files: which declarations they have, under which names.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lang/embedded.h"
#include "lang/library_impl.h"
#include "lang/words.h"

namespace lacquer::lang {

namespace {

constexpr size_t kLargestFile = size_t{64} << 20U;

}  // namespace

Diagnostics Library::Impl::scanFrom(size_t first) {
  const size_t old_entries = entries.size();
  default_template = nullptr;
  default_profile = nullptr;
  Diagnostics errors;
  for (size_t i = first; i < files.size(); ++i) {
    File& file = files[i];
    if (file.text.size() > kLargestFile) {
      errors.push_back({"file-too-large",
                        Severity::Error,
                        {std::string(file.name), 0, 0, {}},
                        "this file has more than 64 MiB",
                        {},
                        {}});
      continue;
    }
    scanFile(file, errors);
  }
  if (errors.empty()) {
    // What was wrong may be right now.
    for (Entry& entry : entries) {
      if (entry.state != Entry::State::Done || entry.good) continue;
      entry.state = Entry::State::Fresh;
      entry.uses.clear();
      entry.diagnostics.clear();
    }
    return errors;
  }
  forget(old_entries);
  while (files.size() > first) files.pop_back();
  return errors;
}

void Library::Impl::scanFile(File& file, Diagnostics& errors) {
  Reporter reporter(file.name, file.text);
  uint32_t line = 1;
  const char* counted = file.text.data();
  const std::vector<ScannedDecl> declared = scan(reporter);
  const auto first = std::find_if(declared.begin(), declared.end(),
                                  [](const ScannedDecl& decl) { return decl.kind == DeclKind::Extension; });
  if (!file.owned_text.empty() && first != declared.end()) file.vendor = first->name;
  for (const ScannedDecl& decl : declared) {
    line += static_cast<uint32_t>(std::count(counted, decl.name.data(), '\n'));
    counted = decl.name.data();
    // A standard node of that name comes first, so that the two meet in one order.
    if (spaceOf(decl.kind) == 0) wake(decl.name, false);
    const auto after = static_cast<uint32_t>(decl.name.data() + decl.name.size() - file.text.data());
    std::vector<Form> forms;
    if (decl.kind == DeclKind::Node) forms = formsOf(reporter, decl.name, after, decl.end);
    if (forms.empty())
      index(decl, file, line, reporter);
    else
      indexForms(decl, std::move(forms), file, line, reporter);
  }
  Diagnostics found = reporter.take();
  errors.insert(errors.end(), found.begin(), found.end());
}

bool Library::Impl::wake(std::string_view name, bool constants_only) {
  if (!has_standard) return false;
  static const auto kNames = [] {
    std::unordered_map<std::string_view, const EmbeddedName*> names;
    const std::span<const EmbeddedName> all = embeddedStandard().names;
    names.reserve(all.size());
    for (const EmbeddedName& one : all) names.emplace(one.name, &one);
    return names;
  }();
  const auto row = kNames.find(name.substr(0, name.find('<')));
  if (row == kNames.end() || (constants_only && !row->second->constant)) return false;
  return wakeFile(row->second->file);
}

bool Library::Impl::wakeFile(size_t number) {
  const std::span<const EmbeddedFile> all = embeddedStandard().files;
  if (standard_.empty()) standard_.resize(all.size());
  std::unique_ptr<Awake>& slot = standard_[number];
  if (!slot) {
    slot = std::make_unique<Awake>();
    slot->file.name = all[number].name;
    slot->file.text = all[number].text;
  }
  if (slot->awake) return false;
  slot->awake = true;
  woken_.emplace_back(entries.size(), slot.get());
  scanFile(slot->file, scan_errors);
  return true;
}

void Library::Impl::wakeAll() {
  if (!has_standard) return;
  for (size_t i = 0; i < embeddedStandard().files.size(); ++i) wakeFile(i);
}

namespace {

/// Kinds of declarations whose names two vendors may share. All others are named by users.
bool isVendors(DeclKind kind) {
  return kind == DeclKind::Const || kind == DeclKind::Node || kind == DeclKind::Part;
}

void rename(Entry& entry, std::string name) {
  entry.key = std::move(name);
  entry.name = entry.key;
  if (entry.node) entry.node->name = entry.name;
  if (entry.head) entry.head->name = entry.name;
  if (entry.part) entry.part->name = entry.name;
}

}  // namespace

void Library::Impl::forget(size_t old_entries) {
  for (; !woken_.empty() && woken_.back().first >= old_entries; woken_.pop_back())
    woken_.back().second->awake = false;
  while (entries.size() > old_entries) {
    Entry& last = entries.back();
    const size_t space = spaceOf(last.kind);
    index_[space].erase(last.name);
    if (!last.plain.empty()) {
      const auto alike = homonyms_[space].find(last.plain);
      alike->second.pop_back();
      if (alike->second.size() == 1) {
        Entry& alone = *alike->second[0];
        index_[space].erase(alone.name);
        rename(alone, std::exchange(alone.plain, {}));
        index_[space].emplace(alone.name, &alone);
        homonyms_[space].erase(alike);
      }
    }
    const auto family = families_.find(last.said);
    const bool form = family != families_.end() && family->second.back() == &last;
    if (form) {
      family->second.pop_back();
      if (family->second.empty()) families_.erase(family);
    }
    entries.pop_back();
  }
}

void Library::Impl::twice(std::string_view name, Span span, const Entry& other, Reporter& reporter) {
  reporter.error("duplicate-name", span, fmt::format("'{}' is declared twice", name),
                 fmt::format("the other, {}, is at {}:{}", aKind(other.kind), other.file->name, other.line));
}

bool Library::Impl::index(const ScannedDecl& decl, const File& file, uint32_t line, Reporter& reporter) {
  const Span span{static_cast<uint32_t>(decl.name.data() - file.text.data()),
                  static_cast<uint32_t>(decl.name.size())};
  const size_t space = spaceOf(decl.kind);
  if (const auto family = families_.find(decl.name); space == 0 && family != families_.end()) {
    twice(decl.name, span, *family->second[0], reporter);
    return false;
  }
  Entry* entry = enter(decl.kind, std::string(decl.name), file, span, reporter);
  if (entry == nullptr) return false;
  entry->said = decl.name;
  entry->begin = decl.begin;
  entry->end = decl.end;
  entry->line = line;
  return true;
}

/// Gives an entry the name that others than its vendor call it by.
void Library::Impl::distinguish(Entry& entry) {
  const size_t space = spaceOf(entry.kind);
  entry.plain = entry.name;
  if (const auto it = index_[space].find(entry.plain); it != index_[space].end() && it->second == &entry)
    index_[space].erase(it);
  rename(entry, fmt::format("{}.{}", entry.file->vendor, entry.plain));
  index_[space].emplace(entry.name, &entry);
  homonyms_[space][entry.plain].push_back(&entry);
}

/// A new entry under a name; null, and an error, where the name is another's of the same text, of the library
/// or of a file that all share.
Entry* Library::Impl::enter(DeclKind kind, const std::string& name, const File& file, Span span,
                            Reporter& reporter) {
  const size_t space = spaceOf(kind);
  const auto apart = [&](const Entry& other) {
    return isVendors(kind) && isVendors(other.kind) && !file.vendor.empty() && !other.file->vendor.empty() &&
           other.file != &file;
  };
  const auto alone = index_[space].find(name);
  Entry* const other = alone == index_[space].end() ? nullptr : alone->second;
  const auto alike = homonyms_[space].find(name);
  std::vector<const Entry*> others;
  if (other != nullptr) others = {other};
  if (alike != homonyms_[space].end()) others.assign(alike->second.begin(), alike->second.end());
  for (const Entry* one : others) {
    if (apart(*one)) continue;
    twice(name, span, *one, reporter);
    return nullptr;
  }
  Entry& entry = entries.emplace_back();
  entry.kind = kind;
  entry.file = &file;
  entry.name_begin = span.offset;
  entry.key = name;
  entry.name = entry.key;
  if (others.empty()) {
    index_[space].emplace(entry.name, &entry);
    return &entry;
  }
  if (other != nullptr) distinguish(*other);
  distinguish(entry);
  return &entry;
}

/// A node for each form, all of one name.
bool Library::Impl::indexForms(const ScannedDecl& decl, std::vector<Form> forms, const File& file,
                               uint32_t line, Reporter& reporter) {
  const Span span{static_cast<uint32_t>(decl.name.data() - file.text.data()),
                  static_cast<uint32_t>(decl.name.size())};
  const auto single = index_[0].find(decl.name);
  const auto alike = homonyms_[0].find(decl.name);
  if (single != index_[0].end() || alike != homonyms_[0].end()) {
    twice(decl.name, span, single != index_[0].end() ? *single->second : *alike->second[0], reporter);
    return false;
  }
  for (Form& form : forms) {
    Entry* entry = enter(DeclKind::Node, form.key, file, span, reporter);
    if (entry == nullptr) return false;
    entry->said = decl.name;
    entry->bindings = std::move(form.bindings);
    entry->begin = decl.begin;
    entry->end = decl.end;
    entry->line = line;
    families_[decl.name].push_back(entry);
  }
  return true;
}

}  // namespace lacquer::lang
