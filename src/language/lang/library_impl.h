// The library's files and declarations, with what was found of them so far: for the files that implement
// library.h.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "lang/checker.h"
#include "lang/forms.h"
#include "lang/library.h"
#include "lang/reporter.h"
#include "lang/scan.h"

namespace lacquer::lang {

/// Constants, nodes and templates share one namespace; each other kind has its own.
inline size_t spaceOf(DeclKind kind) {
  return kind <= DeclKind::Template ? 0 : static_cast<size_t>(kind) - static_cast<size_t>(DeclKind::Template);
}
inline constexpr size_t kSpaces =
    static_cast<size_t>(DeclKind::Switch) - static_cast<size_t>(DeclKind::Template) + 1;

/// A text, a user's or one that was there when Lacquer was built.
struct File {
  std::string owned_name, owned_text;  ///< empty for an embedded file
  std::string_view name, text;
  std::string_view vendor;  ///< as in Origin
  /// Whether it was there when Lacquer was built, and so is right.
  bool builtIn() const { return owned_text.empty(); }
};

/// A declaration: where it stands, and what was found of it so far.
struct Entry {
  enum class State : uint8_t { Fresh, Open, Done };
  DeclKind kind = DeclKind::Node;
  State state = State::Fresh;
  bool good = false;  ///< it and all that it uses
  bool parsed = false;
  bool signature = false;  ///< of `node` only parameters and results are there
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
  std::unique_ptr<TemplateDecl> outline;  ///< of a template, as it is written, once it was asked for
  std::unique_ptr<ExtensionDecl> extension;
  std::unique_ptr<PartDecl> part;
  std::unique_ptr<ProfileDecl> profile;
  std::unique_ptr<LayersDecl> layers;
  std::unique_ptr<SwitchDecl> switch_decl;
};

/// Where the entry stands.
Origin originOf(const Entry& entry);

class Library::Impl final : public Surroundings {
public:
  /// Scans the files from `first` on; on an error everything stays as it was.
  Diagnostics scanFrom(size_t first);
  Entry* find(DeclKind kind, std::string_view name, std::string_view vendor = {});
  void demand(Entry& entry);
  const NodeDecl* signature(Entry& entry);
  GivenNames givenNames(std::string_view name_of_template);
  static const TemplateDecl& outline(Entry& entry);
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

  /// A declaration whatever errors it has. Null where there is none, or where it does not parse.
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
  const Entry* default_profile = nullptr;  ///< likewise

private:
  tl::unexpected<Diagnostics> missing(DeclKind kind, std::string_view name);
  void parse(Entry& entry, Reporter& reporter);
  NodeDecl parseHead(const Entry& entry, Reporter& reporter, std::vector<std::string_view>* read = nullptr);
  void check(Entry& entry, Reporter& reporter);
  bool basesOf(const Entry& entry, Reporter& reporter, std::vector<TemplateDecl>& bases);
  void collect(Entry& entry, std::unordered_set<const Entry*>& seen, Diagnostics& out);

  /// Reads the file of the standard nodes that declares the name, if one does; of a form by what stands
  /// before its types.
  bool wake(std::string_view name, bool constants_only);
  bool wakeFile(size_t number);
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

}  // namespace lacquer::lang
