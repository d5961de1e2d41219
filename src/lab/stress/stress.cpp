#include "stress/attack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "eval/material.h"
#include "material/drawn.h"
#include "prove/nodes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "stress/called.h"
#include "stress/forms.h"
#include "stress/on_device.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/text.h"

namespace lacquer {

namespace {

using json::Json;
using stress::Finding;
using stress::Subject;

constexpr uint64_t kMostSamples = uint64_t{1} << 40;

/// Stand for every node and for every extension of the library.
constexpr std::string_view kNodes = "nodes", kExtensions = "extensions";

bool ends(const std::string& text, std::string_view end) { return text.ends_with(end); }

/// A sample by the names of its variables.
NamedNumbers inputsOf(const Subject& subject, std::span<const double> sample) {
  NamedNumbers inputs;
  for (const stress::Variable& variable : subject.space.variables()) {
    const auto numbers = sample.subspan(variable.first, static_cast<size_t>(variable.components));
    inputs.emplace_back(variable.name, std::vector<double>(numbers.begin(), numbers.end()));
  }
  return inputs;
}

tl::unexpected<Diagnostics> inFile(Diagnostics wrong, const std::string& file) {
  for (Diagnostic& one : wrong) {
    if (one.place.file.empty()) one.place.file = file;
  }
  return tl::make_unexpected(std::move(wrong));
}

/// A finding that is no known one.
bool isFault(const StressFinding& finding) { return finding.known.empty(); }

class Stressing {
public:
  Stressing(const Stress& stress, const Options& options, Messages& messages, const Progress& progress)
      : options_(options), messages_(messages), progress_(progress) {
    plan_ = {stress.samples, stress.seed, stress.mediump};
    total_ = stress.total;
    engine_ = stress.engine;
  }

  Result<StressReport> make(const Strings& names) {
    if (Diagnostics wrong = checkReading(options_); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    if (Result<void> samples = inRange("the number of samples", plan_.samples, 1, kMostSamples, {}); !samples)
      return tl::make_unexpected(std::move(samples.error()));
    if (Result<void> total = inRange("the number of all samples", total_, 0, kMostSamples, {}); !total)
      return tl::make_unexpected(std::move(total.error()));
    if (Result<void> opened = openDevice(); !opened) return tl::make_unexpected(std::move(opened.error()));
    auto library = libraryFor(options_);
    if (!library) return tl::make_unexpected(std::move(library.error()));
    library_ = std::move(*library);
    Diagnostics found = library_->check();
    if (lacquer::hasError(found)) return tl::make_unexpected(std::move(found));
    report(found, {}, messages_);
    if (Result<void> added = addAll(names); !added) return tl::make_unexpected(std::move(added.error()));
    if (total_ > 0) plan_.samples = (total_ + work_.size() - 1) / std::max<size_t>(work_.size(), 1);
    StressReport made{plan_.seed, plan_.samples, plan_.half, device_ ? device_->name() : std::string(), {},
                      0};
    for (size_t i = 0; i < work_.size(); ++i) {
      Result<StressSubject> one = work_[i]();
      if (!one) return tl::make_unexpected(std::move(one.error()));
      made.faults += static_cast<size_t>(std::count_if(one->findings.begin(), one->findings.end(), isFault));
      made.subjects.push_back(std::move(*one));
      if (progress_) progress_(i + 1, work_.size());
    }
    return made;
  }

private:
  Result<void> openDevice() {
    if (engine_ == Engine::Float) return {};
    if (engine_ != Engine::Vulkan && engine_ != Engine::VulkanGlsl && engine_ != Engine::VulkanHlsl) {
      return fail("unknown-enumerator", {},
                  fmt::format("the engine is {}, which nothing is attacked with", static_cast<int>(engine_)),
                  "floats on the CPU (1), or a Vulkan device (2 to 4)");
    }
    if (plan_.half) {
      return fail("contradicting-options", {}, "half precision is rounded on the CPU, not on a device",
                  "leave out one of them");
    }
    Result<vulkan::Device> device = vulkan::Device::open();
    if (!device) return tl::make_unexpected(std::move(device.error()));
    device_ = std::move(*device);
    return {};
  }

  FragmentRoute route() const {
    return engine_ == Engine::VulkanHlsl   ? FragmentRoute::Hlsl
           : engine_ == Engine::VulkanGlsl ? FragmentRoute::Glsl
                                           : FragmentRoute::Direct;
  }

  Result<void> addAll(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      Result<void> added;
      if (ends(name, ".json"))
        added = addJson(name);
      else if (ends(name, ".gltf") || ends(name, ".glb") || ends(name, ".mtlx"))
        added = addFile(name);
      else if (name == kNodes && !library_->node(name))
        added = addNodes();
      else if (name == kExtensions && !library_->node(name))
        added = addExtensions({});
      else if (library_->has(lang::DeclKind::Extension, name))
        added = addExtensions(name);
      else
        added = addNode(name);
      if (!added) return added;
    }
    if (!names.empty()) return {};
    if (Result<void> added = addNodes(); !added) return added;
    return addExtensions({});
  }

  /// Materials that have one extension, at the values where their shaders have other forms. Without a name
  /// all.
  Result<void> addExtensions(const std::string& name) {
    // What is compared are doubles: devices and half precision have nothing to say of it.
    if (device_ || plan_.half) return {};
    const Result<const material::Schema*> schema = library_->models.schema();
    if (!schema) return tl::make_unexpected(schema.error());
    for (uint16_t i = 1; i < (*schema)->extensions.size(); ++i) {
      const std::string_view own = (*schema)->extensions[i]->name;
      if (!name.empty() && own != name) continue;
      const std::optional<material::Material> material = material::materialWith(**schema, i, plan_.seed);
      if (!material) continue;
      StressSubject about;
      about.extension = own;
      addForms(*material, {}, std::move(about));
    }
    return {};
  }

  void addForms(const material::Material& material, const std::string& file, StressSubject about) {
    work_.emplace_back([this, material, file, about = std::move(about)]() mutable -> Result<StressSubject> {
      Result<Forms> forms = compareForms(material, file, *library_, options_, plan_.seed);
      if (!forms) return tl::make_unexpected(std::move(forms.error()));
      about.forms = forms->compared;
      about.findings = std::move(forms->faults);
      return std::move(about);
    });
  }

  Result<void> addNodes() {
    for (const std::string_view name : library_->names(lang::DeclKind::Node)) {
      if (Result<void> added = addNode(std::string(name)); !added) return added;
    }
    return {};
  }

  Result<std::unique_ptr<Subject>> nodeSubject(const std::string& name, const std::string& variant) {
    const Result<const lang::NodeDecl*> found = library_->node(name);
    if (!found && !library_->has(lang::DeclKind::Node, name)) {
      const std::string& help = found.error().front().help;
      return fail("unknown-node", {}, fmt::format("there is no node '{}'", printable(name)),
                  help.empty() ? "`lacquer nodes` lists them" : help);
    }
    if (!found || (*found)->find(variant) == nullptr) {
      return fail("unknown-node", {}, fmt::format("there is no node '{}'", printable(name)),
                  "`lacquer nodes` lists them");
    }
    const lang::NodeDecl& node = **found;
    stress::NodeSource source{
        variant.empty() ? name : name + "." + variant, nodeModule(node, variant).module, {}};
    for (const lang::Param& result : node.results) {
      const std::string called = result.name.empty() ? "the result" : std::string(result.name);
      const uint32_t outputs = outputCount(result.type);
      for (uint32_t k = 0; k < outputs; ++k)
        source.results.emplace_back(outputs == 1 ? called : fmt::format("{}[{}]", called, k), result.range);
    }
    return stress::nodeSubject(std::move(source));
  }

  /// Of a name with several forms all of them.
  Result<void> addNode(const std::string& name) {
    if (!library_->has(lang::DeclKind::Node, name)) {
      const std::vector<const lang::NodeDecl*> forms = library_->forms(name);
      for (const lang::NodeDecl* form : forms) {
        if (Result<void> added = addNode(std::string(form->name)); !added) return added;
      }
      if (!forms.empty()) return {};
    }
    const Result<const lang::NodeDecl*> found = library_->node(name);
    std::vector<std::string> variants = {""};
    if (found) {
      for (const lang::Variant& variant : (*found)->variants) variants.emplace_back(variant.name);
    }
    for (const std::string& variant : variants) {
      Result<std::unique_ptr<Subject>> subject = nodeSubject(name, variant);
      if (!subject) return tl::make_unexpected(std::move(subject.error()));
      StressSubject about;
      about.node = name;
      about.variant = variant;
      add(std::move(*subject), std::move(about));
    }
    return {};
  }

  void add(std::unique_ptr<Subject> subject, StressSubject about) {
    const std::shared_ptr<const Subject> kept = std::move(subject);
    work_.emplace_back([this, kept, about = std::move(about)]() mutable -> Result<StressSubject> {
      if (!device_) return reported(*kept, stress::attack(*kept, plan_), std::move(about));
      DeviceSubject shown = deviceSubject(*kept, *device_, route());
      about.skipped = std::move(shown.skipped);
      if (!about.skipped.empty()) return std::move(about);
      const Result<stress::Report> report = stress::attackOnDevice(*kept, plan_, shown.show);
      if (!report) return tl::make_unexpected(report.error());
      return reported(*kept, *report, std::move(about));
    });
  }

  Result<std::unique_ptr<Subject>> materialSubject(const std::string& file, const EvalSubject& subject,
                                                   bool tangents = true) {
    FileImages images(file, options_);
    EvalMaterial evaluated(images, options_);
    if (!tangents) evaluated.leaveOutTangents();
    if (Result<void> lowered = evaluated.lower(subject, *library_, true, {}, messages_); !lowered)
      return tl::make_unexpected(std::move(lowered.error()));
    evaluated.place({false, {{"directional", 1}}});
    Options named = options_;
    if (Result<void> resolved = resolveNames(*library_, named); !resolved)
      return tl::make_unexpected(std::move(resolved.error()));
    const Result<const model::Model*> model = library_->models.of(named.profile);
    if (!model) return tl::make_unexpected(model.error());
    Result<std::unique_ptr<Subject>> made =
        stress::materialSubject(subject.name(), evaluated.module(), (*model)->layers());
    if (!by_place_) by_place_.emplace(*library_);
    if (made) by_place_->nameTerms(**made);
    return made;
  }

  /// A graph, or a case of one input.
  Result<void> addJson(const std::string& path) {
    const Result<std::optional<graph::Graph>> graph = graphIn(path);
    if (!graph) return tl::make_unexpected(graph.error());
    if (!*graph) {
      work_.emplace_back([this, path] { return replay(path); });
      return {};
    }
    Result<std::unique_ptr<Subject>> subject = materialSubject(path, **graph);
    if (!subject) return inFile(std::move(subject.error()), path);
    StressSubject about;
    about.graph = path;
    about.name = (*graph)->name;
    add(std::move(*subject), std::move(about));
    return {};
  }

  /// The graph that a JSON file is; nothing for one that does not say that it is one.
  Result<std::optional<graph::Graph>> graphIn(const std::string& path, Links links = Links::Follow) {
    const Result<Limits> limits = limitsOf(options_);
    if (!limits) return tl::make_unexpected(limits.error());
    const Result<std::string> text = readFile(path, limits->file, links);
    if (!text) return tl::make_unexpected(text.error());
    const Result<Json> json = json::parse(*text, path, *limits);
    if (!json) return tl::make_unexpected(json.error());
    if (json::member(*json, "lacquer_graph") == nullptr) return std::nullopt;
    Result<graph::Graph> graph = graph::fromJson(*text, path, *limits);
    if (!graph) return tl::make_unexpected(std::move(graph.error()));
    return std::move(*graph);
  }

  Result<material::Document> read(const std::string& file, Links links = Links::Follow) {
    Result<material::Document> document = readMaterials(file, *library_, options_, links);
    if (document) report(document->diagnostics, file, messages_);
    return document;
  }

  Result<void> addFile(const std::string& file) {
    const Result<material::Document> document = read(file);
    if (!document) return tl::make_unexpected(document.error());
    for (const material::Material& material : document->materials) {
      report(material.diagnostics, file, messages_);
      if (lacquer::hasError(material.diagnostics)) continue;
      Result<std::unique_ptr<Subject>> subject = materialSubject(file, material);
      if (!subject) return inFile(std::move(subject.error()), file);
      StressSubject about;
      about.file = file;
      about.material = static_cast<size_t>(material.index);
      about.name = material.name;
      add(std::move(*subject), about);
      if (!device_ && !plan_.half) addForms(material, file, about);
      // Where frames come of derivatives it is another function.
      subject = materialSubject(file, material, false);
      if (!subject) return inFile(std::move(subject.error()), file);
      if ((*subject)->lanes == 1) continue;
      about.tangents = false;
      (*subject)->name += " without tangents";
      add(std::move(*subject), std::move(about));
    }
    return {};
  }

  static StressSubject reported(const Subject& subject, const stress::Report& report, StressSubject about) {
    about.energy = report.energy;
    for (const Finding& finding : report.findings) {
      StressFinding one{
          finding.fault, finding.what, finding.count, finding.value, finding.known, {}, {}, {}, {}, {}};
      const size_t width = subject.space.width();
      for (size_t i = 0; i + width <= finding.input.size(); i += width)
        one.samples.push_back(inputsOf(subject, std::span(finding.input).subspan(i, width)));
      about.findings.push_back(std::move(one));
    }
    return about;
  }

  // A case: what a finding's "case" is, in a file.

  Result<std::unique_ptr<Subject>> subjectOf(const Json& test, const std::string& path) {
    const auto wrong = [&](const char* what) {
      return fail("bad-case", {path, 0, 0, {}}, what, "docs/stress.md");
    };
    if (test.contains("node") && test["node"].is_string()) {
      const bool variant = test.contains("variant") && test["variant"].is_string();
      return nodeSubject(test["node"].get<std::string>(), variant ? test["variant"].get<std::string>() : "");
    }
    const bool is_graph = test.contains("graph") && test["graph"].is_string();
    if (!is_graph && (!test.contains("file") || !test["file"].is_string() || !test.contains("material") ||
                      !test["material"].is_number_unsigned()))
      return wrong("a case has a \"node\", a \"graph\", or a \"file\" and the index of a \"material\"");
    // A case may come from others: where a file lies elsewhere nobody looks at it.
    const std::string named = test[is_graph ? "graph" : "file"].get<std::string>();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const std::optional<std::string> inside =
        named.find('\0') == std::string::npos ? resolveBelow(folder, named, options_.allow) : std::nullopt;
    if (!inside)
      return fail("case-outside", {path, 0, 0, {}},
                  fmt::format("{} leads out of the case's folder", quote(named)),
                  "--allow DIR lets it lie in another folder, too");
    if (is_graph) {
      const Result<std::optional<graph::Graph>> graph = graphIn(*inside, Links::None);
      if (!graph) return tl::make_unexpected(graph.error());
      if (!*graph) return wrong("the file of its \"graph\" is none");
      return materialSubject(*inside, **graph);
    }
    const Result<material::Document> document = read(*inside, Links::None);
    if (!document) return tl::make_unexpected(document.error());
    const auto index = test["material"].get<size_t>();
    if (index >= document->materials.size()) return wrong("the file has no material of that index");
    const bool tangents = !test.contains("tangents") || test["tangents"] != false;
    return materialSubject(*inside, document->materials[index], tangents);
  }

  Result<std::vector<double>> inputOf(const Subject& subject, const Json& test,
                                      const std::string& path) const {
    const auto wrong = [&](std::string what) {
      return fail("bad-case", {path, 0, 0, {}}, std::move(what), "docs/stress.md");
    };
    const size_t width = subject.space.width();
    const Json* samples = json::member(test, "samples");
    const size_t least = subject.group;
    if (samples == nullptr || !samples->is_array() || samples->empty() || samples->size() > 2 * least ||
        samples->size() % least != 0)
      return wrong(fmt::format("\"samples\" must hold {} samples, or twice as many for a jump", least));
    std::vector<double> input(samples->size() * width);
    for (size_t i = 0; i < samples->size(); ++i) {
      for (const stress::Variable& variable : subject.space.variables()) {
        const Json* value = json::member((*samples)[i], variable.name);
        if (value == nullptr) return wrong(fmt::format("a sample lacks \"{}\"", variable.name));
        const auto n = static_cast<size_t>(variable.components);
        for (size_t c = 0; c < n; ++c) {
          const bool list = value->is_array() && value->size() == n;
          const Json& number = list ? (*value)[c] : *value;
          if (!number.is_number() || (!list && n > 1))
            return wrong(fmt::format("\"{}\" must be {} numbers", variable.name, n));
          input[i * width + variable.first + c] = number.get<double>();
        }
      }
    }
    return input;
  }

  Result<StressSubject> replay(const std::string& path) {
    const Result<Limits> limits = limitsOf(options_);
    if (!limits) return tl::make_unexpected(limits.error());
    const Result<std::string> text = readFile(path, limits->file);
    if (!text) return tl::make_unexpected(text.error());
    const Result<Json> test = json::parse(*text, path, *limits);
    if (!test) return tl::make_unexpected(test.error());
    if (!test->is_object())
      return fail("bad-case", {path, 0, 0, {}}, "a case is an object", "docs/stress.md");
    Result<std::unique_ptr<Subject>> subject = subjectOf(*test, path);
    if (!subject) return tl::make_unexpected(std::move(subject.error()));
    const Result<std::vector<double>> input = inputOf(**subject, *test, path);
    if (!input) return tl::make_unexpected(input.error());
    StressSubject about;
    about.test = path;
    if (!device_) return reported(**subject, stress::replay(**subject, *input), std::move(about));
    DeviceSubject shown = deviceSubject(**subject, *device_, route());
    about.skipped = std::move(shown.skipped);
    if (!about.skipped.empty()) return about;
    const Result<stress::Report> report = stress::replayOnDevice(**subject, *input, shown.show);
    if (!report) return tl::make_unexpected(report.error());
    return reported(**subject, *report, std::move(about));
  }

  const Options& options_;
  Messages& messages_;
  const Progress& progress_;
  stress::Plan plan_;
  uint64_t total_ = 0;
  Engine engine_ = Engine::Float;
  std::optional<vulkan::Device> device_;
  std::shared_ptr<const Language> library_;
  std::optional<stress::NodesByPlace> by_place_;
  std::vector<std::function<Result<StressSubject>()>> work_;
};

}  // namespace

std::optional<StressReport> stressNodes(const Stress& stress, const Strings& subjects, const Options& options,
                                        Messages& messages, const Progress& progress) {
  Result<StressReport> made;
  withJobs(options.jobs, [&] { made = Stressing(stress, options, messages, progress).make(subjects); });
  return valueOf(std::move(made), {}, messages);
}

}  // namespace lacquer
