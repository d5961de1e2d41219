#include "lacquer/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/internal.h"
#include "lacquer/variant.h"
#include "lang/body_text.h"
#include "lang/parser.h"
#include "lang/words.h"
#include "lod/geometry.h"
#include "lod/moves.h"
#include "prove/nodes.h"
#include "setting/attributes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// The errors that are tried.
constexpr double kErrors[] = {1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1};

constexpr size_t kForms = 1 + std::size(kErrors);

constexpr std::string_view kReason =
    "stated of the reference body, or proved of what stands for a part of it";

struct Front {
  std::string family;
  std::vector<optimize::Candidate> forms;
};

Front frontOf(const ir::Module& module, const Options& options, const Progress& progress = {}) {
  optimize::Settings settings = optimization(options);
  settings.level = std::max(settings.level, 1);
  const std::string family = options.optimize_for.empty() ? optimizeFamilies()[0] : options.optimize_for;
  size_t done = 0;
  const auto tried = [&] {
    if (progress) progress(++done, kForms);
  };
  return {family, optimize::front(module, settings, kErrors, tried)};
}

TunedForm formOf(const optimize::Outcome& outcome) {
  return {outcome.error, std::round(outcome.cycles), outcome.growth,
          static_cast<size_t>(outcome.approximations)};
}

Tuned tuned(std::string name, const ir::Module& module, const Options& options, const Progress& progress) {
  const Front front = frontOf(module, options, progress);
  Tuned made;
  made.name = std::move(name);
  made.family = front.family;
  made.plain = std::round(front.forms.front().outcome.plain);
  for (const optimize::Candidate& form : front.forms) made.forms.push_back(formOf(form.outcome));
  return made;
}

/// A node that is named with or without a variant.
struct Named {
  std::shared_ptr<const Language> library;
  const lang::NodeDecl* node;
  std::string variant;
};

bool hasVariant(const lang::NodeDecl& node, std::string_view name) {
  return std::any_of(node.variants.begin(), node.variants.end(),
                     [&](const lang::Variant& one) { return one.name == name; });
}

std::optional<Named> find(const std::string& name, const Options& options, Messages& messages) {
  const auto wrong = [&](Diagnostics found) {
    report(found, {}, messages);
    return std::nullopt;
  };
  if (Diagnostics found = checkOptions(options); !found.empty()) return wrong(std::move(found));
  const auto library = libraryFor(options);
  if (!library) return wrong(library.error());
  if (Diagnostics found = (*library)->check(); hasError(found)) return wrong(std::move(found));
  // A vendor's node may have a dot of its own, before that of a variant.
  const std::string node = (*library)->node(name) ? name : name.substr(0, name.rfind('.'));
  const std::string variant = node.size() < name.size() ? name.substr(node.size() + 1) : "";
  const auto decl = (*library)->node(node);
  if (!decl) {
    if ((*library)->has(lang::DeclKind::Node, node)) return wrong(decl.error());
    const std::string& help = decl.error().front().help;
    return wrong(fail("no-such-node", {}, fmt::format("there is no node '{}'", printable(node)),
                      help.empty() ? "`lacquer nodes` lists what there is" : help)
                     .value());
  }
  if (!variant.empty() && !hasVariant(**decl, variant)) {
    return wrong(fail("no-such-variant", {},
                      fmt::format("the node {} has no variant '{}'", node, printable(variant)),
                      fmt::format("`lacquer nodes {}` lists what there is", node))
                     .value());
  }
  return Named{*library, *decl, variant};
}

/// Whether a declaration or a statement begins with it.
bool isWord(std::string_view name) {
  const auto begins = [&](const lang::DeclWord& one) { return one.word == name; };
  return std::any_of(std::begin(lang::kDeclWords), std::end(lang::kDeclWords), begins) ||
         std::find(std::begin(lang::kBodyWords), std::end(lang::kBodyWords), name) !=
             std::end(lang::kBodyWords);
}

/// Errors in the name of a new variant.
Diagnostics wrongVariant(const lang::NodeDecl& node, const std::string& name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto good = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !letter(name[0]) || !std::all_of(name.begin(), name.end(), good) ||
      lang::isReserved(name) || isWord(name)) {
    return fail("wrong-variant", {}, fmt::format("'{}' names no variant", printable(name)),
                "small letters, digits and _, a letter first, and no word of the language")
        .value();
  }
  if (!hasVariant(node, name)) return {};
  return fail("wrong-variant", {}, fmt::format("the node {} has a variant '{}'", node.name, name),
              "take another name")
      .value();
}

std::string documentation(const Tuned& tuned, const TunedForm& form) {
  const std::string error =
      form.error > 0
          ? fmt::format(
                "off by at most {:.3g} of a result, or by as much where that is below 1: proved, for\n"
                "/// light of at most 1",
                form.error)
          : std::string("equal in real numbers");
  return fmt::format(
      "/// Found by a search: {}.\n/// {} cycles on {}, of {}; bounds of rounding "
      "errors grow by "
      "{:.2f}.\n",
      error, form.cycles, tuned.family, tuned.plain, form.growth);
}

}  // namespace

std::optional<Tuned> tune(const std::string& name, const Options& options, Messages& messages,
                          const Progress& progress) {
  const std::optional<Named> named = find(name, options, messages);
  if (!named) return std::nullopt;
  return tuned(name, nodeModule(*named->node, named->variant).module, options, progress);
}

std::optional<std::string> variantText(const std::string& node, size_t form, const std::string& variant,
                                       const Options& options, Messages& messages) {
  const std::optional<Named> named = find(node, options, messages);
  if (!named) return std::nullopt;
  const auto wrong = [&](Diagnostics found) {
    report(found, {}, messages);
    return std::nullopt;
  };
  if (Diagnostics found = wrongVariant(*named->node, variant); !found.empty()) return wrong(std::move(found));
  const Front front = frontOf(nodeModule(*named->node, named->variant).module, options);
  const size_t count = front.forms.size();
  if (form > count) {
    return wrong(fail("no-such-form", {}, fmt::format("'{}' has no form {}", printable(node), form),
                      fmt::format("there are {}", count))
                     .value());
  }
  const optimize::Candidate& chosen = front.forms[form == 0 ? count - 1 : form - 1];
  const std::optional<std::string> body = lang::bodyText(chosen.module, *named->node, kReason);
  if (!body) {
    return wrong(fail("no-variant", {},
                      fmt::format("this form of '{}' is no body of a node", printable(node)),
                      "the node language has no word for a loop of the shader or a sum over its lights")
                     .value());
  }
  Tuned plain;
  plain.family = front.family;
  plain.plain = std::round(chosen.outcome.plain);
  return documentation(plain, formOf(chosen.outcome)) + fmt::format("variant {} {{\n{}}}\n", variant, *body);
}

namespace {

/// Adds what goes to the vertices, by pictures as `lacquer lod` makes them when nothing is said.
void addMoves(Tuned& to, const EvalSubject& of, const gltf::VertexAttributes& attributes,
              const passes::LightFacts& lights, FileImages& images, const Language& language,
              const Options& options, const preview::Mesh& mesh, Messages& messages,
              const Progress& progress) {
  const Lod lod;
  const LodMaterial::Given given{of,      attributes, lights, images,    language,
                                 options, lod.texels, mesh,   lod.radius};
  const auto beside = [&](size_t done, size_t known) {
    if (progress) progress(kForms + done, kForms + known);
  };
  const auto found = lod::moves(given, lod.size, messages, beside);
  if (!found) return report(found.error(), images.file(), messages);
  to.has_vertices = found->has_value();
  if (!to.has_vertices) return;
  for (const lod::Moved& one : **found) {
    TunedMove move{one.words, {}, one.shader, one.error, one.cycles, one.more, one.cost};
    if (options.optimize == 0) move.options = {"--optimize", "1"};
    move.options.emplace_back("--model-costs");
    for (const std::string& word : one.words) move.options.insert(move.options.end(), {"--simplify", word});
    to.moves.push_back(std::move(move));
  }
}

/// `Impl` is Graph::Impl, which friends alone may name.
template <class Impl>
std::optional<Tuned> tunedGraph(const Impl& impl, const Options& options, Messages& messages,
                                const Progress& progress) {
  // Up to where the search would begin.
  Options plain = options;
  plain.optimize = 0;
  plain.optimize_error = 0;
  plain.half = false;
  const auto ready = impl.prepared(plain, checkOptions);
  if (!ready) {
    report(ready.error(), impl.file, messages);
    return std::nullopt;
  }
  ir::Module before;
  const auto keep = [&](std::string_view pass, const ir::Module& after) {
    if (pass == "vertex") before = after;
  };
  const Result<ir::Module> module = impl.module(*ready, plain, keep);
  if (!module) {
    report(module.error(), impl.file, messages);
    return std::nullopt;
  }
  return tuned(impl.graph.name, before, options, progress);
}

}  // namespace

std::optional<Tuned> tune(const Graph& graph, const Options& options, Messages& messages,
                          const Progress& progress) {
  if (!filled(graph.impl_.get(), "graph", messages)) return std::nullopt;
  const auto& impl = *graph.impl_;
  std::optional<Tuned> made = tunedGraph(impl, options, messages, progress);
  const auto language = libraryFor(options);
  if (!made || !language || impl.images == ImagesOf::Gltf) return made;
  const InMemory of{impl.graph, **language, impl.file, impl.bytes, impl.images};
  FileImages images = of.images(options);
  const gltf::VertexAttributes any{true, true, false, {true, true, false, false}};
  addMoves(*made, of.subject, any, impl.scene_lights, images, **language, options, {}, messages, progress);
  return made;
}

std::optional<Tuned> tune(const Scene& scene, size_t material, const Attributes& attributes,
                          const Options& options, Messages& messages, const Progress& progress) {
  const Graph graph = scene.graph(material, attributes, options, messages);
  std::optional<Tuned> made = graph ? tune(graph, options, messages, progress) : std::nullopt;
  if (!made) return made;
  const auto& impl = *scene.impl_;
  const material::Material& of = impl.document.materials[material];
  const auto language = libraryFor(options);
  Options named = options;
  if (!language || !resolveNames(**language, named)) return made;
  FileImages images(impl.document.path, options, impl.bytes);
  const preview::Mesh mesh = lod::meshOf(of, images, **language, messages);
  addMoves(*made, of, fromPublic(attributes), lightsOf(impl.document), images, **language, named, mesh,
           messages, progress);
  return made;
}

}  // namespace lacquer
