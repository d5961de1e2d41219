#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>

#include "api/budget.h"
#include "api/internal.h"
#include "support/file.h"
#include "targets/target.h"

namespace lacquer {

std::string_view version() { return LACQUER_VERSION; }

Message toMessage(const Diagnostic& d) {
  const auto level = d.severity == Severity::Error     ? Message::Level::Error
                     : d.severity == Severity::Warning ? Message::Level::Warning
                                                       : Message::Level::Note;
  return {level,          d.code,    d.place.file, d.place.pointer, d.place.line,
          d.place.column, d.message, d.help,       format(d)};
}

Diagnostic toDiagnostic(const Message& m) {
  const auto severity = m.level == Message::Level::Error     ? Severity::Error
                        : m.level == Message::Level::Warning ? Severity::Warning
                                                             : Severity::Note;
  return {m.code, severity, {m.file, m.line, m.column, m.pointer}, m.message, m.help, {}};
}

void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages) {
  for (Diagnostic d : diagnostics) {
    if (d.place.file.empty()) d.place.file = file;
    messages.push_back(toMessage(d));
  }
}

bool hasError(const Messages& messages) {
  return std::any_of(messages.begin(), messages.end(),
                     [](const Message& m) { return m.level == Message::Level::Error; });
}

static_assert(static_cast<int>(Target::Cpp) == static_cast<int>(targets::TargetId::Cpp));

std::string_view targetName(Target target) {
  if (static_cast<size_t>(target) >= kTargetCount) return {};
  return targets::row(static_cast<targets::TargetId>(target)).name;
}

bool findTarget(std::string_view name, Target& target) {
  const std::optional<targets::TargetId> id = targets::find(name);
  if (id) target = static_cast<Target>(*id);
  return id.has_value();
}

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

std::vector<std::string> passNames() {
  std::vector<std::string> names = {"lower"};
  for (const std::string_view pass : passes::passNames()) names.emplace_back(pass);
  return names;
}

Result<std::vector<lang::SourceFile>> nodeFiles(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<std::string> paths;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".node") paths.push_back(it->path().generic_string());
  }
  if (error)
    return fail("file-unreadable", {folder, 0, 0, {}}, "the folder of nodes cannot be read", error.message());
  std::sort(paths.begin(), paths.end());
  std::vector<lang::SourceFile> files;
  for (const std::string& path : paths) {
    Result<std::string> text = readFile(path);
    if (!text) return tl::make_unexpected(text.error());
    files.push_back({path, std::move(*text)});
  }
  return files;
}

Result<std::shared_ptr<const Language>> libraryFor(const Options& options) {
  if (options.node_directories.empty()) {
    static const auto kBuiltIn = std::make_shared<const Language>(lang::Library::embedded());
    return kBuiltIn;
  }
  lang::Library library = lang::Library::embedded();
  for (const std::string& folder : options.node_directories) {
    Result<std::vector<lang::SourceFile>> files = nodeFiles(folder);
    if (!files) return tl::make_unexpected(files.error());
    if (Result<void> added = library.add(std::move(*files)); !added)
      return tl::make_unexpected(added.error());
  }
  return std::make_shared<const Language>(std::move(library));
}

Result<material::Document> readMaterials(const std::string& path, const Language& language,
                                         const Options& options) {
  const Result<const material::Schema*> schema = language.models.schema();
  if (!schema) return tl::make_unexpected(schema.error());
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> bytes = readFile(path, limits->file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return material::readText(*bytes, path, **schema, {options.permissive, *limits});
}

Result<void> resolveNames(const lang::Library& library, Options& options) {
  if (options.template_name.empty()) {
    Result<std::string> name = library.defaultTemplate();
    if (!name) return tl::make_unexpected(std::move(name.error()));
    options.template_name = std::move(*name);
  }
  if (options.profile.empty()) {
    const auto profiles = model::profiles(library);
    if (!profiles) return tl::make_unexpected(profiles.error());
    options.profile = (*profiles)[0]->name;
  }
  return {};
}

passes::LightFacts lightsOf(const gltf::Scene& scene) {
  const auto count = [&](gltf::LightType type) {
    const auto it = scene.lights.find(type);
    return it == scene.lights.end() ? 0U : static_cast<uint32_t>(it->second);
  };
  return {false,
          {{"directional", count(gltf::LightType::Directional)},
           {"point", count(gltf::LightType::Point)},
           {"spot", count(gltf::LightType::Spot)}}};
}

passes::LightFacts lightFacts(const Options& options, const passes::LightFacts& scene) {
  switch (options.lights.mode) {
    case Lights::Mode::Any: return {};
    case Lights::Mode::Scene: return scene;
    case Lights::Mode::Fixed: break;
  }
  return {false, options.lights.counts};
}

Result<graph::Graph> buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                                const Language& language, const Options& options, Diagnostics& warnings) {
  const Result<const model::Model*> model = language.models.of(options.profile);
  if (!model) return tl::make_unexpected(model.error());
  const Result<const lang::TemplateDecl*> wanted = language.template_(options.template_name);
  if (!wanted) return tl::make_unexpected(wanted.error());
  model::BuildOptions build;
  build.template_name = options.template_name;
  build.decode_srgb = options.decode_srgb;
  build.switches = options.switches;
  build.switches.insert({{"ibl", options.ibl},
                         {"multiple_scattering", options.multiple_scattering},
                         {"dfg_table", options.dfg_table}});
  build.live = {options.live.begin(), options.live.end()};
  Result<graph::Graph> graph = model::build(**model, **wanted, material, attributes, build, warnings);
  if (graph) applyBudget(*graph, options.error_budget);
  return graph;
}

}  // namespace lacquer
