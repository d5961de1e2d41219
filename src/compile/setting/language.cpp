#include "setting/language.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <mutex>

#include "model/order.h"
#include "setting/options.h"
#include "setting/watched.h"
#include "support/file.h"
#include "support/stack.h"
#include "support/text.h"

namespace lacquer {

Strings profiles(const Options& options) {
  const auto language = libraryFor(options);
  if (!language) return {};
  const auto found = model::profiles(**language);
  Strings names;
  if (!found) return names;
  for (const lang::ProfileDecl* profile : *found) names.emplace_back(profile->name);
  return names;
}

Strings liveTerms(const Options& options) {
  Options named = options;
  const auto language = libraryFor(options);
  if (!language || !resolveNames(**language, named)) return {};
  const Result<const model::Model*> model = (*language)->models.of(named.profile);
  if (!model) return {};
  const std::vector<std::string_view> terms = (*model)->liveTerms();
  return {terms.begin(), terms.end()};
}

Diagnostics Language::check() const {
  // A wrong declaration hides no mistake in the parts of other files.
  Diagnostics all = checkAll();
  const auto add = [&](const Diagnostics& found) {
    for (const Diagnostic& one : found) {
      if (std::find(all.begin(), all.end(), one) == all.end()) addBounded(all, one);
    }
  };
  const auto profiles = model::profiles(*this);
  if (!profiles) {
    add(profiles.error());
    return all;
  }
  // Where a property is wrong, the lines of the parts are looked at all the same.
  Diagnostics aside;
  const bool good = models.schema().has_value();
  const Result<material::Schema> written = good ? material::Schema{} : material::schemaOf(*this, &aside);
  if (!good) add(written ? aside : written.error());
  const auto see = [&](std::string_view profile, const std::set<std::string, std::less<>>& lods) {
    if (!good) {
      if (!written) return;
      const Result<model::Model> model = model::compile(*this, *written, profile, lods);
      if (!model) add(model.error());
      return;
    }
    const Result<const model::Model*> model = models.of(profile, lods);
    if (!model) return add(model.error());
    for (const auto& [lower, upper] : (*model)->unordered)
      add({model::unorderedParts((*model)->declOf(lower), (*model)->declOf(upper))});
  };
  for (const lang::ProfileDecl* profile : *profiles) see(profile->name, {});
  for (const std::string_view lod : names(lang::DeclKind::Lod)) see((*profiles)[0]->name, {std::string(lod)});
  return all;
}

/// The files of that extension that an iterator comes to, sorted by path.
template <class Iterator>
static Result<std::vector<lang::SourceFile>> filesOf(const std::string& folder, std::string_view extension,
                                                     const char* what) {
  std::error_code error;
  std::vector<std::string> paths;
  for (Iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == extension) paths.push_back(it->path().generic_string());
  }
  if (error == std::errc::not_a_directory)
    return fail("file-unreadable", {folder, 0, 0, {}},
                fmt::format("it is a file where a folder of {} is asked for", what),
                "name the folder that it lies in; a document is read by every other verb");
  if (error)
    return fail("file-unreadable", {folder, 0, 0, {}}, fmt::format("the folder of {} cannot be read", what),
                error.message());
  std::sort(paths.begin(), paths.end());
  std::vector<lang::SourceFile> files;
  for (const std::string& path : paths) {
    Result<std::string> text = readFile(path);
    if (!text) return tl::make_unexpected(text.error());
    files.push_back({path, std::move(*text)});
  }
  return files;
}

Result<std::vector<lang::SourceFile>> nodeFiles(const std::string& folder) {
  return filesOf<std::filesystem::directory_iterator>(folder, ".node", "nodes");
}

Result<std::vector<lang::SourceFile>> definitionFiles(const std::string& folder) {
  return filesOf<std::filesystem::recursive_directory_iterator>(folder, ".mtlx", "MaterialX definitions");
}

Result<materialx::Definitions> ownDefinitions(const Options& options) {
  if (options.materialx_directories.empty() && options.materialx_texts.empty())
    return materialx::Definitions();
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  std::vector<lang::SourceFile> own;
  for (const std::string& folder : options.materialx_directories) {
    Result<std::vector<lang::SourceFile>> files = definitionFiles(folder);
    if (!files) return tl::make_unexpected(std::move(files.error()));
    std::move(files->begin(), files->end(), std::back_inserter(own));
  }
  for (const auto& [name, text] : options.materialx_texts) own.push_back({name, text});
  return materialx::readDefinitions(own, *limits);
}

std::vector<lang::SourceFile> filesOfFolders(const Options& options, bool* all_known) {
  std::vector<lang::SourceFile> all;
  const auto add = [&](Result<std::vector<lang::SourceFile>> files) {
    if (!files && all_known != nullptr) *all_known = false;
    if (files) std::move(files->begin(), files->end(), std::back_inserter(all));
  };
  for (const std::string& folder : options.node_directories) add(nodeFiles(folder));
  for (const std::string& folder : options.materialx_directories) add(definitionFiles(folder));
  return all;
}

Result<std::vector<lang::SourceFile>> ownNodeFiles(const Options& options) {
  std::vector<lang::SourceFile> own;
  for (const std::string& folder : options.node_directories) {
    Result<std::vector<lang::SourceFile>> files = nodeFiles(folder);
    if (!files) return files;
    std::move(files->begin(), files->end(), std::back_inserter(own));
  }
  const uint64_t largest = Limits{}.file;
  for (const auto& [name, text] : options.node_texts) {
    if (text.size() > largest)
      return fail("file-too-large", {name, 0, 0, {}}, fmt::format("it has more than {} bytes", largest));
    own.push_back({name, text});
  }
  return own;
}

Diagnostics emptyFolders(const Options& options) {
  Diagnostics all;
  const auto look = [&](const std::string& folder, auto filesThere, std::string_view what,
                        std::string_view help) {
    const Result<std::vector<lang::SourceFile>> files = filesThere(folder);
    if (!files || !files->empty()) return;
    all.push_back({"nothing-to-check",
                   Severity::Error,
                   {folder, 0, 0, {}},
                   fmt::format("there is no file {} in this folder", what),
                   std::string(help),
                   {}});
  };
  for (const std::string& folder : options.node_directories)
    look(folder, nodeFiles, "NAME.node", "name the folder itself: those within it are not looked at");
  for (const std::string& folder : options.materialx_directories)
    look(folder, definitionFiles, "NAME.mtlx", "name the folder of the definitions");
  return all;
}

/// The built-in library and the options' own files.
static Result<std::shared_ptr<const Language>> libraryWith(const Options& options) {
  Result<std::vector<lang::SourceFile>> own = ownNodeFiles(options);
  if (!own) return tl::make_unexpected(std::move(own.error()));
  lang::Library library = lang::Library::embedded();
  if (Result<void> added = library.add(std::move(*own)); !added)
    return tl::make_unexpected(std::move(added.error()));
  Result<materialx::Definitions> definitions = ownDefinitions(options);
  if (!definitions) return tl::make_unexpected(std::move(definitions.error()));
  return std::make_shared<const Language>(std::move(library), std::move(*definitions));
}

Result<std::shared_ptr<const Language>> libraryFor(const Options& options) {
  if (!hasStack())
    return fail("stack-too-small", {}, "the thread has too little stack",
                fmt::format("it takes {} KiB: `ulimit -s`, or the size that the thread is made with",
                            kStackNeeded / 1024));
  const bool folders = !options.node_directories.empty() || !options.materialx_directories.empty();
  if (!folders && options.node_texts.empty() && options.materialx_texts.empty()) {
    // It stays to the end of the program, which then need not take it apart.
    static const auto& kBuiltIn = *new auto(std::make_shared<const Language>(lang::Library::embedded()));
    return kBuiltIn;
  }
  // Files of a folder may have changed.
  if (folders) return libraryWith(options);
  static std::mutex mutex;
  static std::vector<std::pair<std::string, std::string>> texts, documents;
  static std::shared_ptr<const Language> kept;
  {
    const std::lock_guard lock(mutex);
    if (kept && texts == options.node_texts && documents == options.materialx_texts) return kept;
  }
  Result<std::shared_ptr<const Language>> made = libraryWith(options);
  if (!made) return made;
  const std::lock_guard lock(mutex);
  texts = options.node_texts;
  documents = options.materialx_texts;
  kept = *made;
  return made;
}

Result<material::Document> readMaterials(const std::string& path, const Language& language,
                                         const Options& options, Links links) {
  const Result<const material::Schema*> schema = language.models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> bytes = readFile(path, limits->file, links);
  if (!bytes) return tl::make_unexpected(bytes.error());
  Result<material::Document> document =
      material::readText(*bytes, path, **schema, {options.permissive, *limits, nullptr, translates(options)});
  if (!document) return document;
  if (Diagnostics wrong = checkWatched(options, document->materials.size()); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  return document;
}

std::optional<std::string_view> watchedPath(std::string_view live, std::optional<int> material) {
  constexpr std::string_view kMaterials = "/materials/";
  if (!live.starts_with(kMaterials)) return std::nullopt;
  live.remove_prefix(kMaterials.size());
  const size_t digits = std::min(live.find_first_not_of("0123456789"), live.size());
  if (digits == 0 || digits == live.size() || live[digits] != '/') return std::nullopt;
  if (digits > 1 && live[0] == '0') return std::nullopt;  // as JSON Pointer (RFC 6901) has it
  if (material && live.substr(0, digits) != fmt::format("{}", *material)) return std::nullopt;
  return live.substr(digits + 1);
}

Diagnostics checkWatched(const Options& options, size_t materials) {
  Diagnostics wrong;
  for (const std::string& live : options.live) {
    const std::optional<std::string_view> path = watchedPath(live);
    if (!path) continue;
    const std::string_view rest = std::string_view(live).substr(std::string_view("/materials/").size());
    const std::string_view index = rest.substr(0, rest.find('/'));
    constexpr size_t kDigits = 9;
    size_t number = 0;
    for (const char c : index.substr(0, kDigits)) number = number * 10 + static_cast<size_t>(c - '0');
    if (index.size() <= kDigits && number < materials) continue;
    wrong.push_back({"no-such-material",
                     Severity::Error,
                     {},
                     fmt::format("{} is to stay live, and there is no material {}", quote(live), index),
                     materials == 0 ? std::string("the file has no materials")
                     : materials == 1
                         ? std::string("the file has one: /materials/0")
                         : fmt::format("the file has /materials/0 to /materials/{}", materials - 1),
                     {}});
  }
  return wrong;
}

bool translates(const Options& options) {
  if (!options.as.empty()) return options.as != kMaterialX;
  return !options.profile.empty() && options.profile != kMaterialX;
}

const std::string& profileOf(const material::Material& material, const Options& options) {
  static const std::string kOwn(kMaterialX);
  return material.closures.empty() ? options.profile : kOwn;
}

Options translating(Options options) {
  options.as = "gltf";
  if (options.profile == kMaterialX) options.profile.clear();
  return options;
}

Result<void> resolveNames(const lang::Library& library, Options& options) {
  if (options.template_name.empty()) {
    Result<std::string> name = library.defaultTemplate();
    if (!name) return tl::make_unexpected(std::move(name.error()));
    options.template_name = std::move(*name);
  }
  options.as = translates(options) ? "gltf" : std::string(kMaterialX);
  if (options.profile.empty() || options.profile == kMaterialX) {
    Result<std::string> name = library.defaultProfile();
    if (!name) return tl::make_unexpected(std::move(name.error()));
    options.profile = std::move(*name);
  }
  return {};
}

}  // namespace lacquer
