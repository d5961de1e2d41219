#include "eval/subject.h"

#include <fmt/format.h>

#include <string_view>

#include "setting/options.h"
#include "shader/module.h"
#include "support/file.h"

namespace lacquer {

namespace {

Result<graph::Graph> graphOf(material::Material material, const gltf::VertexAttributes& attributes,
                             const Language& library, const Options& options, std::vector<int>& originals,
                             Diagnostics& warnings) {
  // Every use of a texture gets a slot of its own, so that each can be given a texel.
  for (material::Material::Texture& texture : material.textures) {
    originals.push_back(texture.info.texture);
    texture.info.texture = static_cast<int>(originals.size()) - 1;
  }
  return buildGraph(material, attributes, library, options, warnings);
}

/// What was asked for of a graph and can only be asked for of what a graph is built from.
Result<void> checkBuilt(const Options& options) {
  const std::pair<bool, const char*> asked[] = {{!options.template_name.empty(), "template"},
                                                {!options.profile.empty(), "profile"},
                                                {!options.switches.empty(), "switch"},
                                                {!options.live.empty(), "live"},
                                                {!options.simplify.empty(), "simplify"}};
  for (const auto& [is, name] : asked) {
    if (!is) continue;
    return fail("graph-is-built", {}, fmt::format("'{}' says how a graph is built, and this is one", name),
                "leave it out, or take the glTF file");
  }
  return {};
}

}  // namespace

const std::string& EvalSubject::name() const {
  return std::visit([](const auto* of) -> const std::string& { return of->name; }, of_);
}

std::string EvalSubject::title() const {
  if (!name().empty()) return name();
  const auto* material = std::get_if<const material::Material*>(&of_);
  return material != nullptr ? fmt::format("(material {})", (*material)->index) : "(graph)";
}

std::string EvalSubject::pointer() const {
  const auto* material = std::get_if<const material::Material*>(&of_);
  return material != nullptr ? fmt::format("/materials/{}", (*material)->index) : std::string();
}

const Diagnostics& EvalSubject::diagnostics() const {
  static const Diagnostics kNone;
  const auto* material = std::get_if<const material::Material*>(&of_);
  return material != nullptr ? (*material)->diagnostics : kNone;
}

Result<graph::Graph> EvalSubject::graph(const gltf::VertexAttributes& attributes, const Language& library,
                                        const Options& options, std::vector<int>& originals,
                                        Diagnostics& warnings) const {
  if (const auto* material = std::get_if<const material::Material*>(&of_))
    return graphOf(**material, attributes, library, options, originals, warnings);
  if (Result<void> built = checkBuilt(options); !built) return tl::make_unexpected(std::move(built.error()));
  graph::Graph graph = *std::get<const graph::Graph*>(of_);
  for (ir::TextureSlot& slot : graph.textures) {
    originals.push_back(slot.texture);
    slot.texture = static_cast<int>(originals.size()) - 1;
  }
  return graph;
}

bool isGraphFile(std::string_view path) { return path.ends_with(".json"); }

Result<graph::Graph> readGraphFile(const std::string& path, const Options& options) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> text = readFile(path, limits->file);
  if (!text) return tl::make_unexpected(text.error());
  return graph::fromJson(*text, path, *limits);
}

}  // namespace lacquer
