#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "api/gpu.h"
#include "api/internal.h"
#include "api/points.h"
#include "eval/dfg.h"
#include "eval/evaluate.h"
#include "eval/image.h"
#include "gltf/table.h"
#include "gltf/text.h"
#include "gltf/texture_source.h"
#include "lower/lower.h"

namespace lacquer {

namespace {

/// The textures of a material, in an order of its own.
std::vector<gltf::TextureInfo*> texturesOf(gltf::Material& m) {
  std::vector<gltf::Texture*> all = {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                                     &m.occlusionTexture, &m.emissiveTexture};
  if (m.clearcoat) {
    gltf::Clearcoat& c = *m.clearcoat;
    all.insert(all.end(), {&c.clearcoatTexture, &c.clearcoatRoughnessTexture, &c.clearcoatNormalTexture});
    if (c.color) all.push_back(&c.color->clearcoatColorTexture);
    if (c.darkening) all.push_back(&c.darkening->clearcoatDarkeningTexture);
  }
  if (m.clearcoatTint) all.push_back(&m.clearcoatTint->clearcoatTintTexture);
  if (m.coat) {
    gltf::Coat& c = *m.coat;
    all.insert(all.end(), {&c.coatTexture, &c.coatRoughnessTexture, &c.coatNormalTexture, &c.coatColorTexture,
                           &c.coatAnisotropyTexture});
  }
  std::vector<gltf::TextureInfo*> result;
  for (gltf::Texture* texture : all) {
    if (*texture) result.push_back(&**texture);
  }
  return result;
}

std::string propertyOf(const ir::TextureSlot& slot) {
  return slot.pointer.substr(slot.pointer.rfind('/') + 1);
}

struct Texel {
  std::string slot;
  std::array<double, 4> value{};
};

/// "baseColorTexture=0.5,0.5,0.5,1"
Result<Texel> parseTexel(const std::string& text) {
  const auto wrong = [&] {
    return fail("bad-texel", {}, fmt::format("'{}' is no texel", text),
                "write SLOT=r,g,b,a with four numbers");
  };
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return wrong();
  Texel texel;
  texel.slot = text.substr(0, equals);
  std::istringstream numbers(text.substr(equals + 1));
  numbers.imbue(std::locale::classic());
  for (size_t i = 0; i < 4; ++i) {
    char comma = ',';
    if (i > 0 && (!(numbers >> comma) || comma != ',')) return wrong();
    if (!(numbers >> texel.value[i]) || !std::isfinite(texel.value[i])) return wrong();
  }
  if (!(numbers >> std::ws).eof()) return wrong();
  return texel;
}

bool isTextureProperty(const std::string& name) {
  const std::vector<gltf::TableRow> rows = gltf::tableRows();
  return std::any_of(rows.begin(), rows.end(), [&](const gltf::TableRow& row) {
    const bool texture = row.facts.kind == gltf::Kind::Texture ||
                         row.facts.kind == gltf::Kind::NormalTexture ||
                         row.facts.kind == gltf::Kind::OcclusionTexture;
    return texture && row.facts.name == name;
  });
}

eval::Wrap wrapOf(int gl) {
  constexpr int kClamp = 33071;
  constexpr int kMirror = 33648;
  return gl == kClamp ? eval::Wrap::Clamp : gl == kMirror ? eval::Wrap::Mirror : eval::Wrap::Repeat;
}

struct Colors {
  std::vector<double> rgba;     ///< of each point
  std::vector<bool> discarded;  ///< by point; empty when the material discards nothing
  std::string device;           ///< that ran the shader; empty for the CPU
};

std::string_view nameOf(Engine engine) {
  switch (engine) {
    case Engine::Double: return "double";
    case Engine::Float: return "float";
    case Engine::Vulkan: return "vulkan";
  }
  return {};
}

std::string answerOf(const Colors& colors, const std::string& material, const std::string& profile, Engine engine) {
  const auto quoted = [](const std::string& text) {
    return gltf::Json(text).dump(-1, ' ', false, gltf::Json::error_handler_t::replace);
  };
  std::string text =
      fmt::format("{{\n  \"material\": {},\n  \"engine\": \"{}\",\n", quoted(material), nameOf(engine));
  if (!colors.device.empty()) text += fmt::format("  \"device\": {},\n", quoted(colors.device));
  text += fmt::format("  \"profile\": \"{}\",\n  \"rgba\": [", profile);
  for (size_t i = 0; 4 * i < colors.rgba.size(); ++i) {
    text += i == 0 ? "\n    [" : ",\n    [";
    // A device leaves no colour where it has dropped the fragment.
    const bool none = engine == Engine::Vulkan && !colors.discarded.empty() && colors.discarded[i];
    for (size_t c = 0; c < 4; ++c) {
      const double x = colors.rgba[4 * i + c];
      if (c > 0) text += ", ";
      // JSON has no infinity; no input in its range should come here.
      text += none || !std::isfinite(x)  ? "null"
              : engine == Engine::Double ? fmt::format("{:.17g}", x)
                                         : fmt::format("{:.9g}", static_cast<float>(x));
    }
    text += "]";
  }
  text += "\n  ]";
  if (!colors.discarded.empty()) {
    text += ",\n  \"discarded\": [";
    for (size_t i = 0; i < colors.discarded.size(); ++i)
      text += fmt::format("{}{}", i == 0 ? "" : ", ", static_cast<bool>(colors.discarded[i]));
    text += "]";
  }
  return text + "\n}\n";
}

class Evaluating {
public:
  Evaluating(const std::string& file, const Options& options, Engine engine)
      : file_(file), options_(options), on_gpu_(engine == Engine::Vulkan) {}

  Result<void> setTexels(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      Result<Texel> texel = parseTexel(text);
      if (!texel) return tl::make_unexpected(std::move(texel.error()));
      texels_.push_back(std::move(*texel));
    }
    return {};
  }

  /// The module as lowered, for a primitive with every attribute: points are given all of them.
  Result<void> lower(gltf::Material material, const lang::Library& library, bool environment,
                     Messages& messages) {
    // Every use of a texture gets a slot of its own, so that each can be given a texel.
    for (gltf::TextureInfo* info : texturesOf(material)) {
      originals_.push_back(info->texture);
      info->texture = static_cast<int>(originals_.size()) - 1;
    }
    Options options = options_;
    options.template_name = "forward";
    options.ibl = options.ibl && environment;
    options.decode_srgb = false;
    Diagnostics warnings;
    graph::Graph graph =
        graph::build(material, {true, true, true, {true, true, true, true}}, buildOptions(options), warnings);
    report(warnings, file_, messages);
    if (Diagnostics wrong = graph::check(graph, library); lacquer::hasError(wrong)) {
      return tl::make_unexpected(std::move(wrong));
    }
    Result<ir::Module> module = lower::lower(graph, library, {parameterMode(options)});
    if (!module) return tl::make_unexpected(std::move(module.error()));
    module_ = std::move(*module);
    return checkTexels();
  }

  /// What the shader computes: values of the material's rate in the preshader, then floats.
  void place() {
    passes::PipelineOptions pipeline;
    pipeline.lights = {false, 1, 0, 0};
    passes::runPipeline(module_, pipeline);
  }

  Result<void> bind(const EvalPoints& points) {
    eval::bindPoints(points.points, bindings_);
    if (Result<void> block = eval::bindMaterialBlock(module_, bindings_); !block) return block;
    if (Result<void> varyings = eval::bindVaryings<float>(module_, points.points.size(), bindings_);
        !varyings) {
      return varyings;
    }
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
    std::vector<bool> used(module_.textures.size(), false);
    for (const ir::ValueId id : ir::reachable(module_.dag, roots)) {
      if (module_.dag[id].op != ir::Op::Input) continue;
      const ir::Input& input = module_.dag.inputOf(id);
      if (input.kind == ir::InputKind::Texture) used[input.field] = true;
    }
    Diagnostics wrong;
    for (size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      const ir::TextureSlot& slot = module_.textures[i];
      if (slot.name == "environment_dfg") {
        bindings_.textures[slot.name] = eval::environmentDfgSampler();
        gpu_textures_[slot.name] =
            imageOf(*eval::environmentDfgImage(), {eval::Wrap::Clamp, eval::Wrap::Clamp, false, false});
      } else if (slot.environment) {
        bindings_.textures[slot.name] = [&points](size_t point, const std::array<double, 3>&, double) {
          const std::array<double, 3>& e = points.environment[point];
          return std::array<double, 4>{e[0], e[1], e[2], 1};
        };
        gpu_textures_[slot.name] = environmentOf(points);
      } else if (Result<void> bound = bindTexture(slot); !bound) {
        wrong.insert(wrong.end(), bound.error().begin(), bound.error().end());
      }
    }
    if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
    return {};
  }

  template <class T>
  Result<Colors> colors(size_t points) const {
    std::vector<ir::ValueId> roots;
    ir::ValueId color = ir::kNoValue;
    ir::ValueId dropped = ir::kNoValue;
    for (const ir::Output& output : module_.outputs) {
      if (output.kind == ir::OutputKind::Color && output.location == 0) color = output.value;
      if (output.kind == ir::OutputKind::Discard) dropped = output.value;
    }
    roots.push_back(color);
    if (dropped != ir::kNoValue) roots.push_back(dropped);
    const auto values = eval::evaluate<T>(module_, roots, bindings_, points);
    if (!values) return tl::make_unexpected(values.error());
    Colors result{{(*values)[0].begin(), (*values)[0].end()}, {}, {}};
    if (values->size() > 1) {
      for (const T x : (*values)[1]) result.discarded.push_back(x != 0);
    }
    return result;
  }

  Result<Colors> colorsOnGpu(size_t points) const {
    const Result<vulkan::Work> work =
        gpuWork(module_, bindings_, gpu_textures_, points, options_.spirv_route);
    if (!work) return tl::make_unexpected(work.error());
    const Result<vulkan::Device> device = vulkan::Device::open();
    if (!device) return tl::make_unexpected(device.error());
    Result<vulkan::Outcome> outcome = device->run(*work);
    if (!outcome) return tl::make_unexpected(std::move(outcome.error()));
    Colors result{{outcome->outputs[0].begin(), outcome->outputs[0].end()}, {}, device->name()};
    const bool may_discard = std::any_of(module_.outputs.begin(), module_.outputs.end(),
                                         [](const auto& o) { return o.kind == ir::OutputKind::Discard; });
    if (may_discard) result.discarded = std::move(outcome->discarded);
    return result;
  }

private:
  static bool names(const std::string& name, const ir::TextureSlot& slot) {
    return !slot.environment && (name == propertyOf(slot) || name == slot.name);
  }

  /// A texel for a texture that this material does not have is not used; a name that no texture has is a
  /// mistake.
  Result<void> checkTexels() const {
    for (const Texel& texel : texels_) {
      const bool known = isTextureProperty(texel.slot) ||
                         std::any_of(module_.textures.begin(), module_.textures.end(),
                                     [&](const ir::TextureSlot& slot) { return names(texel.slot, slot); });
      if (known) continue;
      std::vector<std::string> slots;
      for (const ir::TextureSlot& slot : module_.textures) {
        if (!slot.environment) slots.push_back(propertyOf(slot));
      }
      return fail("unknown-texture", {}, fmt::format("--texel: there is no texture '{}'", texel.slot),
                  slots.empty() ? "the material has no textures"
                                : fmt::format("the material has {}", fmt::join(slots, ", ")));
    }
    return {};
  }

  static vulkan::Texture environmentOf(const EvalPoints& points) {
    std::vector<vulkan::Texel> texels;
    for (const std::array<double, 3>& e : points.environment) {
      texels.push_back({static_cast<float>(e[0]), static_cast<float>(e[1]), static_cast<float>(e[2]), 1});
    }
    vulkan::Texture texture;
    texture.cube = true;
    texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
    return texture;
  }

  static vulkan::Texture constantOf(const std::array<double, 4>& value) {
    vulkan::Texel texel{};
    for (size_t i = 0; i < 4; ++i) texel[i] = static_cast<float>(value[i]);
    vulkan::Texture texture;
    texture.nearest = true;
    texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, texel);
    return texture;
  }

  /// Decoded here, as the device's sRGB format would before it filters.
  static vulkan::Texture imageOf(const eval::Image& image, const eval::Lookup& lookup) {
    std::vector<vulkan::Texel> texels = image.texels;
    for (size_t i = 0; lookup.srgb && i < texels.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        texels[i][c] = static_cast<float>(eval::decodeSrgb(static_cast<double>(texels[i][c])));
      }
    }
    vulkan::Texture texture;
    texture.width = static_cast<uint32_t>(image.width);
    texture.height = static_cast<uint32_t>(image.height);
    texture.s = static_cast<vulkan::Wrap>(lookup.s);
    texture.t = static_cast<vulkan::Wrap>(lookup.t);
    texture.nearest = lookup.nearest;
    texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
    return texture;
  }

  Result<void> bindTexture(const ir::TextureSlot& slot) {
    for (auto it = texels_.rbegin(); it != texels_.rend(); ++it) {
      if (!names(it->slot, slot)) continue;
      const std::array<double, 4> value = it->value;
      bindings_.textures[slot.name] = [value](size_t, const std::array<double, 3>&, double) { return value; };
      gpu_textures_[slot.name] = constantOf(value);
      return {};
    }
    Result<eval::Sampler> sampler = imageSampler(slot);
    if (sampler) {
      bindings_.textures[slot.name] = std::move(*sampler);
      return {};
    }
    for (Diagnostic& d : sampler.error()) {
      d.message = fmt::format("{} has no image: {}", propertyOf(slot), d.message);
      if (d.help.empty()) d.help = fmt::format("or give a constant: --texel {}=r,g,b,a", propertyOf(slot));
    }
    return tl::make_unexpected(std::move(sampler.error()));
  }

  Result<eval::Sampler> imageSampler(const ir::TextureSlot& slot) {
    if (!opened_) {
      Result<gltf::TextureFile> opened = gltf::TextureFile::open(file_);
      if (!opened) return tl::make_unexpected(std::move(opened.error()));
      opened_ = std::move(*opened);
    }
    const int texture = originals_[static_cast<size_t>(slot.texture)];
    const Result<gltf::TextureSource> source = opened_->texture(texture);
    if (!source) return tl::make_unexpected(source.error());
    std::shared_ptr<const eval::Image>& image = images_[texture];
    if (!image) {
      Result<eval::Image> decoded = eval::decodeImage(source->bytes, source->place);
      if (!decoded) return tl::make_unexpected(std::move(decoded.error()));
      image = std::make_shared<const eval::Image>(std::move(*decoded));
    }
    constexpr int kNearest = 9728;
    const eval::Lookup lookup{wrapOf(source->wrapS), wrapOf(source->wrapT), source->magFilter == kNearest,
                              slot.srgb};
    if (on_gpu_) gpu_textures_[slot.name] = imageOf(*image, lookup);
    return eval::makeSampler(image, lookup);
  }

  const std::string& file_;
  const Options& options_;
  std::vector<Texel> texels_;
  std::vector<int> originals_;  ///< by the slot's texture: the file's
  std::optional<gltf::TextureFile> opened_;
  std::map<int, std::shared_ptr<const eval::Image>> images_;
  ir::Module module_;
  eval::Bindings bindings_;
  bool on_gpu_;
  GpuTextures gpu_textures_;
};

/// The material of that name, or the only one where no name is given.
Result<const gltf::Material*> findMaterial(const gltf::Document& document, const std::string& name) {
  if (name.empty() && document.materials.size() == 1) return document.materials.data();
  std::vector<std::string> names;
  for (const gltf::Material& material : document.materials) {
    if (!name.empty() && material.name == name) return &material;
    names.push_back("'" + gltf::printable(material.name) + "'");
  }
  return fail("unknown-material", {document.path, 0, 0, {}},
              name.empty() ? std::string("the file does not have exactly one material: name one")
                           : fmt::format("no material is named '{}'", gltf::printable(name)),
              names.empty() ? "there are none" : fmt::format("there are {}", fmt::join(names, ", ")));
}

Result<std::string> evaluateOne(const std::string& file, const std::string& material,
                                const EvalPoints& points, Engine engine,
                                const std::vector<std::string>& texels, const Options& options,
                                Messages& messages) {
  const Result<gltf::Document> document = gltf::read(file, {options.permissive});
  if (!document) return tl::make_unexpected(document.error());
  report(document->diagnostics, file, messages);
  const Result<const gltf::Material*> found = findMaterial(*document, material);
  if (!found) return tl::make_unexpected(found.error());
  report((*found)->diagnostics, file, messages);
  if (lacquer::hasError((*found)->diagnostics)) return std::string();
  const auto library = libraryFor(options);
  if (!library) return tl::make_unexpected(library.error());
  Evaluating evaluating(file, options, engine);
  if (Result<void> set = evaluating.setTexels(texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  if (Result<void> lowered = evaluating.lower(**found, **library, points.has_environment, messages);
      !lowered) {
    return tl::make_unexpected(std::move(lowered.error()));
  }
  if (engine != Engine::Double) evaluating.place();
  if (Result<void> bound = evaluating.bind(points); !bound)
    return tl::make_unexpected(std::move(bound.error()));
  const size_t count = points.points.size();
  const Result<Colors> colors = engine == Engine::Double  ? evaluating.colors<double>(count)
                                : engine == Engine::Float ? evaluating.colors<float>(count)
                                                          : evaluating.colorsOnGpu(count);
  if (!colors) return tl::make_unexpected(colors.error());
  return answerOf(*colors, (*found)->name, options.profile, engine);
}

}  // namespace

std::string evaluate(const std::string& file, const std::string& material, const std::string& points,
                     const std::string& points_name, Engine engine, const std::vector<std::string>& texels,
                     const Options& options, Messages& messages) {
  Options checked = options;
  checked.targets = {Target::Spirv};
  checked.spirv_route = SpirvRoute::Direct;  // the engine takes every route
  if (const Diagnostics wrong = checkOptions(checked); !wrong.empty()) {
    report(wrong, {}, messages);
    return {};
  }
  const Result<EvalPoints> read = readPoints(points, points_name);
  if (!read) {
    report(read.error(), points_name, messages);
    return {};
  }
  Result<std::string> text = evaluateOne(file, material, *read, engine, texels, options, messages);
  if (text) return std::move(*text);
  report(text.error(), file, messages);
  return {};
}

}  // namespace lacquer
