#include "lang/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "lang/builtins.h"
#include "lang/checker.h"
#include "lang/embedded.h"
#include "lang/forms.h"
#include "lang/lexer.h"
#include "lang/parser.h"
#include "lang/scan.h"
#include "lang/suggest.h"
#include "lang/words.h"
#include "support/say_once.h"

namespace lacquer::lang {
namespace {

/// How deep declarations may use each other: checking one checks what it uses first.
constexpr size_t kLongestChain = 256;
constexpr size_t kLargestFile = size_t{64} << 20U;

/// Constants, nodes and templates share one namespace; each other kind has its own.
size_t spaceOf(DeclKind kind) {
  return kind <= DeclKind::Template ? 0 : static_cast<size_t>(kind) - static_cast<size_t>(DeclKind::Template);
}
constexpr size_t kSpaces =
    static_cast<size_t>(DeclKind::Switch) - static_cast<size_t>(DeclKind::Template) + 1;

struct File {
  std::string owned_name, owned_text;  ///< empty for an embedded file
  std::string_view name, text;
  std::string_view vendor;  ///< as in Origin
};

struct Entry {
  enum class State : uint8_t { Fresh, Open, Done };
  DeclKind kind = DeclKind::Node;
  State state = State::Fresh;
  bool good = false;  ///< it and all that it uses
  bool parsed = false;
  const File* file = nullptr;
  std::string_view name;
  std::string_view said;  ///< the name in the text
  std::string key;        ///< of a form of a node, and of what two vendors call alike: what `name` views
  std::string plain;      ///< of what two vendors call alike: its name without the vendor
  TypeBindings bindings;
  uint32_t name_begin = 0;  ///< where the declared name stands
  uint32_t begin = 0, end = 0, line = 0;
  std::unique_ptr<NodeDecl> head;  ///< of a form, once it was asked for
  std::vector<Entry*> uses;
  Diagnostics diagnostics;  ///< of itself alone
  std::unique_ptr<ConstDecl> constant;
  std::unique_ptr<NodeDecl> node;
  std::unique_ptr<TemplateDecl> template_decl;
  std::unique_ptr<ExtensionDecl> extension;
  std::unique_ptr<PartDecl> part;
  std::unique_ptr<ProfileDecl> profile;
  std::unique_ptr<LayersDecl> layers;
  std::unique_ptr<SwitchDecl> switch_decl;
};

}  // namespace

class Library::Impl final : public Surroundings {
public:
  /// Scans the files from `first` on; on an error everything stays as it was.
  Diagnostics scanFrom(size_t first);
  Entry* find(DeclKind kind, std::string_view name, std::string_view vendor = {});
  void demand(Entry& entry);
  Diagnostics errorsOf(Entry& entry);

  template <class T>
  Result<const T*> get(DeclKind kind, std::string_view name, std::unique_ptr<T> Entry::*decl,
                       std::string_view vendor = {}) {
    const std::lock_guard lock(mutex);
    Entry* entry = find(kind, name, vendor);
    if (entry == nullptr) return missing(kind, name);
    demand(*entry);
    if (!entry->good) return tl::make_unexpected(errorsOf(*entry));
    return (entry->*decl).get();
  }

  /// What is wrong with it is left aside. Null where there is none, or where it does not parse.
  template <class T>
  const T* written(DeclKind kind, std::string_view name, std::unique_ptr<T> Entry::*decl) {
    const std::lock_guard lock(mutex);
    Entry* entry = find(kind, name);
    if (entry == nullptr) return nullptr;
    demand(*entry);
    return entry->parsed ? (entry->*decl).get() : nullptr;
  }

  std::optional<Found> find(std::string_view name, bool called) override;
  std::vector<const NodeDecl*> forms(std::string_view family) override;
  Found form(std::string_view key) override;
  std::vector<std::string_view> names(DeclKind kind) override;
  /// Reads all of the standard nodes' files.
  void wakeAll();
  std::string cycle(std::string_view name) const override;

  std::mutex mutex;
  std::deque<File> files;
  std::deque<Entry> entries;  ///< by file, then by place
  Diagnostics scan_errors;    ///< of embedded files
  bool has_standard = false;  ///< it has the standard nodes, each file of which is read when it is wanted
  /// The default one, once it was looked for; more files may bring another.
  const Entry* default_template = nullptr;

private:
  tl::unexpected<Diagnostics> missing(DeclKind kind, std::string_view name);
  void parse(Entry& entry, Reporter& reporter);
  void check(Entry& entry, Reporter& reporter);
  bool basesOf(const Entry& entry, Reporter& reporter, std::vector<TemplateDecl>& bases);
  void collect(Entry& entry, std::unordered_set<const Entry*>& seen, Diagnostics& out);

  /// Reads the file of the standard nodes that declares the name, if one does; of a form by what stands
  /// before its types.
  void wake(std::string_view name, bool constants_only);
  void wakeFile(size_t number);
  Entry* known(DeclKind kind, std::string_view name, std::string_view vendor) const;
  /// Of a name that several vendors have: the one of this vendor; null where there is none.
  Entry* homonym(size_t space, std::string_view name, std::string_view vendor) const;
  /// The vendor in whose text names are looked up now.
  std::string_view here() const { return open_.empty() ? std::string_view{} : open_.back()->file->vendor; }
  Entry* enter(DeclKind kind, const std::string& name, const File& file, Span span, Reporter& reporter);
  void distinguish(Entry& entry);
  void scanFile(File& file, Diagnostics& errors);
  bool index(const ScannedDecl& decl, const File& file, uint32_t line, Reporter& reporter);
  bool indexForms(const ScannedDecl& decl, std::vector<Form> forms, const File& file, uint32_t line,
                  Reporter& reporter);
  void twice(std::string_view name, Span span, const Entry& other, Reporter& reporter);
  void forget(size_t old_entries);

  std::array<std::unordered_map<std::string_view, Entry*>, kSpaces> index_;
  /// The names that several vendors have, in the order of the texts.
  std::array<std::map<std::string, std::vector<Entry*>, std::less<>>, kSpaces> homonyms_;
  std::unordered_map<std::string_view, std::vector<Entry*>>
      families_;  ///< by name, in the order of the texts
  std::vector<Entry*> open_;
  struct Awake {
    File file;
    bool awake = false;
  };
  std::vector<std::unique_ptr<Awake>> standard_;  ///< by the file's number; empty before the first is read
  std::vector<std::pair<size_t, Awake*>> woken_;  ///< with how many entries there were before
};

Diagnostics Library::Impl::scanFrom(size_t first) {
  const size_t old_entries = entries.size();
  default_template = nullptr;
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

void Library::Impl::wake(std::string_view name, bool constants_only) {
  if (!has_standard) return;
  name = name.substr(0, name.find('<'));
  const std::span<const EmbeddedName> table = embeddedStandard().names;
  const auto row =
      std::lower_bound(table.begin(), table.end(), name,
                       [](const EmbeddedName& one, std::string_view wanted) { return one.name < wanted; });
  if (row != table.end() && row->name == name && (row->constant || !constants_only)) wakeFile(row->file);
}

void Library::Impl::wakeFile(size_t number) {
  const std::span<const EmbeddedFile> all = embeddedStandard().files;
  if (standard_.empty()) standard_.resize(all.size());
  std::unique_ptr<Awake>& slot = standard_[number];
  if (!slot) {
    slot = std::make_unique<Awake>();
    slot->file.name = all[number].name;
    slot->file.text = all[number].text;
  }
  if (slot->awake) return;
  slot->awake = true;
  woken_.emplace_back(entries.size(), slot.get());
  scanFile(slot->file, scan_errors);
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
      // Its body, which begins behind the first brace that follows its name, is not looked at.
      const size_t brace = entry->file->text.find('{', entry->name_begin);
      const auto end = static_cast<uint32_t>(std::min<size_t>(brace, entry->end));
      Reporter silent(entry->file->name, entry->file->text);
      entry->head = std::make_unique<NodeDecl>(Parser(silent, entry->begin, end, entry->bindings).nodeHead());
      entry->head->name = entry->name;
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
  wake(name, kind == DeclKind::Const);
  return known(kind, name, vendor);
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
    wake(name, !called);
    it = index_[0].find(name);
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

void Library::Impl::check(Entry& entry, Reporter& reporter) {
  Checker checker(reporter, *this);
  switch (entry.kind) {
    case DeclKind::Const: checker.constant(*entry.constant); break;
    case DeclKind::Node: checker.node(*entry.node); break;
    case DeclKind::Template: {
      std::vector<TemplateDecl> bases;
      if (!basesOf(entry, reporter, bases)) break;
      checker.templateDecl(*entry.template_decl, std::move(bases));
      if (reporter.count() == 0) tie(*entry.template_decl, reporter);
      break;
    }
    case DeclKind::Extension: checker.extension(*entry.extension); break;
    case DeclKind::Part: checker.part(*entry.part); break;
    case DeclKind::Profile:
    case DeclKind::Lod: checker.profile(*entry.profile, kindName(entry.kind)); break;
    case DeclKind::Layers:
    case DeclKind::Switch: break;
  }
}

/// What the template extends, parsed again: a template has its own copy of the parts, with its own slots.
/// False when there is no such base, or it is wrong itself.
bool Library::Impl::basesOf(const Entry& entry, Reporter& reporter, std::vector<TemplateDecl>& bases) {
  const std::string_view name = entry.template_decl->base;
  if (name.empty()) return true;
  const Span span{static_cast<uint32_t>(name.data() - entry.file->text.data()),
                  static_cast<uint32_t>(name.size())};
  const Entry* base = find(DeclKind::Template, name);
  if (base == nullptr) {
    reporter.error("unknown-template", span, fmt::format("there is no template '{}'", name),
                   didYouMean(name, names(DeclKind::Template)));
    return false;
  }
  if (base->state == Entry::State::Open) {
    reporter.error("recursion", span, fmt::format("'{}' extends itself: {}", name, cycle(name)));
    return false;
  }
  if (!base->good) return false;
  for (; base != nullptr; base = find(DeclKind::Template, bases.front().base)) {
    Reporter silent(base->file->name, base->file->text);
    bases.insert(bases.begin(), Parser(silent, base->begin, base->end).templateDecl());
  }
  return true;
}

/// Parses the declaration, and checks what it uses, then itself.
void Library::Impl::demand(Entry& entry) {
  if (entry.state != Entry::State::Fresh) return;
  entry.state = Entry::State::Open;
  open_.push_back(&entry);
  Reporter reporter(entry.file->name, entry.file->text);
  parse(entry, reporter);
  if (reporter.count() == 0 && open_.size() > kLongestChain) {
    reporter.error("too-deep", {entry.name_begin, static_cast<uint32_t>(entry.said.size())},
                   fmt::format("more than {} declarations use each other in a chain", kLongestChain));
  }
  bool good = true;
  entry.parsed = reporter.count() == 0;
  if (entry.parsed) {
    for (Entry* used : entry.uses) {
      demand(*used);
      good = good && used->good;
    }
    check(entry, reporter);
    // Forms are chosen as it is checked.
    for (const Entry* used : entry.uses) good = good && used->good;
  }
  // Of a part's nodes each call is looked at by itself, so that one which is wrong hides nothing in other
  // lines.
  entry.good = (good || entry.kind == DeclKind::Part) && reporter.count() == 0;
  entry.diagnostics = reporter.take();
  entry.state = Entry::State::Done;
  open_.pop_back();
}

void Library::Impl::parse(Entry& entry, Reporter& reporter) {
  Parser parser(reporter, entry.begin, entry.end, entry.bindings);
  const Origin origin{entry.file->name, entry.line, entry.file->vendor, entry.file->owned_text.empty()};
  switch (entry.kind) {
    case DeclKind::Const:
      entry.constant = std::make_unique<ConstDecl>(parser.constant());
      entry.constant->origin = origin;
      break;
    case DeclKind::Node:
      entry.node = std::make_unique<NodeDecl>(parser.node());
      entry.node->origin = origin;
      entry.node->name = entry.name;
      break;
    case DeclKind::Template:
      entry.template_decl = std::make_unique<TemplateDecl>(parser.templateDecl());
      entry.template_decl->origin = origin;
      break;
    case DeclKind::Extension:
      entry.extension = std::make_unique<ExtensionDecl>(parser.extension());
      entry.extension->origin = origin;
      break;
    case DeclKind::Part:
      entry.part = std::make_unique<PartDecl>(parser.part());
      entry.part->origin = origin;
      entry.part->name = entry.name;
      break;
    case DeclKind::Profile:
    case DeclKind::Lod:
      entry.profile = std::make_unique<ProfileDecl>(parser.profile());
      entry.profile->origin = origin;
      break;
    case DeclKind::Layers:
      entry.layers = std::make_unique<LayersDecl>(parser.layers());
      entry.layers->origin = origin;
      break;
    case DeclKind::Switch:
      entry.switch_decl = std::make_unique<SwitchDecl>(parser.switchDecl());
      entry.switch_decl->origin = origin;
      break;
  }
  const auto use = [&](std::string_view name, DeclKind kind) {
    // What is built in is meant in bodies; a node of such a name is for graphs.
    if (kind == DeclKind::Node && findFunction(name) != nullptr) return;
    Entry* used = find(kind, name, entry.file->vendor);
    if (used == nullptr || std::find(entry.uses.begin(), entry.uses.end(), used) != entry.uses.end()) return;
    entry.uses.push_back(used);
  };
  if (entry.template_decl && !entry.template_decl->base.empty())
    use(entry.template_decl->base, DeclKind::Template);
  for (const std::string_view name : parser.namesRead()) use(name, DeclKind::Const);
  for (const std::string_view name : parser.namesCalled()) use(name, DeclKind::Node);
}

void Library::Impl::collect(Entry& entry, std::unordered_set<const Entry*>& seen, Diagnostics& out) {
  if (!seen.insert(&entry).second) return;
  addOnce(out, entry.diagnostics);
  for (Entry* used : entry.uses) collect(*used, seen, out);
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

Result<const TemplateDecl*> Library::template_(std::string_view name) const {
  return impl_->get(DeclKind::Template, name, &Entry::template_decl);
}

Result<const ExtensionDecl*> Library::extension(std::string_view name) const {
  return impl_->get(DeclKind::Extension, name, &Entry::extension);
}

const TemplateDecl* Library::writtenTemplate(std::string_view name) const {
  return impl_->written(DeclKind::Template, name, &Entry::template_decl);
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
    Reporter silent(entry->file->name, entry->file->text);
    if (Parser(silent, entry->begin, entry->end).templateDecl().is_default) known = &*entry;
  }
  if (known != nullptr) return std::string(known->name);
  return fail("unknown-template", {}, "no template is named, and none is the default",
              "a template is that which says `default;`");
}

Result<std::string> Library::defaultProfile() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<const Entry*> found;
  const Entry* last = nullptr;
  for (const Entry& entry : impl_->entries) {
    if (entry.kind != DeclKind::Profile) continue;
    last = &entry;
    const auto behind = static_cast<uint32_t>(entry.name_begin + entry.said.size());
    Reporter silent(entry.file->name, entry.file->text);
    if (tokenize(silent, behind, entry.end)[0].is("default")) found.push_back(&entry);
  }
  if (found.size() == 1) return std::string(found[0]->name);
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
