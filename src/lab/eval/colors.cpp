#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "eval/evaluate.h"
#include "eval/gpu.h"
#include "eval/in_memory.h"
#include "eval/material.h"
#include "eval/point_arrays.h"
#include "eval/points_file.h"
#include "graph/graph.h"
#include "graph/text.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/module.h"
#include "support/file.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// "frame.light_count": the field that says how many lights there are. Nothing where no field does: their
/// numbers are fixed, or stand in lists.
std::optional<std::string> lightCountOf(const ir::Module& module) {
  const bool counted =
      !module.light_groups.empty() && module.light_groups[0].count == ir::LightGroup::kCounted;
  if (!counted) return std::nullopt;
  const ir::Block& block = module.blocks[module.light_count.block];
  return block.instance + "." + block.fields[module.light_count.field].name;
}

/// The values that the points' file gives to fields of the template's blocks.
Result<void> bindUniforms(const ir::Module& module, const EvalPoints& points, const std::string& file,
                          eval::Bindings& bindings) {
  const std::optional<std::string> count = lightCountOf(module);
  bool dark = false;
  for (const auto& [name, values] : points.uniforms) {
    const ir::BlockField* field = nullptr;
    for (const ir::Block& block : module.blocks) {
      if (block.role == ir::BlockRole::Material) continue;
      for (const ir::BlockField& f : block.fields) {
        for (uint32_t i = 0; i < f.elements(); ++i) {
          if (block.instance + "." + f.elementName(i) == name) field = &f;
        }
      }
    }
    const auto wrong = [&, &known = name](std::string code, std::string message, std::string help) {
      return fail(std::move(code), {file, 0, 0, "/uniforms/" + known}, std::move(message), std::move(help));
    };
    if (field == nullptr) {
      return wrong("unknown-uniform",
                   fmt::format("the template '{}' has no field '{}'", module.template_name, printable(name)),
                   "write BLOCK.FIELD as the template names them, BLOCK.FIELD[0] of an array");
    }
    const auto width = static_cast<size_t>(ir::componentCount(field->type));
    if (values.size() != width) {
      return wrong("wrong-type", fmt::format("'{}' is given {} numbers", name, values.size()),
                   fmt::format("a {} has {}", ir::typeName(field->type), width));
    }
    for (const double x : values) {
      if (x >= field->range.lo && x <= field->range.hi) continue;
      return wrong("out-of-range", fmt::format("'{}' is {}", name, x),
                   fmt::format("it must be in [{}, {}]", field->range.lo, field->range.hi));
    }
    // The devices' loops end there: the evaluators' end with the lights.
    if (count == name) {
      if (values[0] != 0 && values[0] != 1) {
        return wrong("out-of-range", fmt::format("'{}' is {}", name, values[0]),
                     "an evaluation has one light: it must be 0 or 1");
      }
      dark = values[0] == 0;
    }
    eval::Columns& columns = bindings.lights.at(0).contains(name) ? bindings.lights[0] : bindings.columns;
    columns[name] = eval::Column::constant(values);
  }
  if (dark) bindings.lights.clear();
  return {};
}

/// The points' light is one of KHR_lights_punctual, and directional.
constexpr std::string_view kPointLight = "directional";

bool hasPointLight(const ir::Module& module) {
  return std::any_of(module.light_kinds.begin(), module.light_kinds.end(),
                     [](const ir::LightKind& kind) { return kind.name == kPointLight; });
}

/// Whether the uniforms say something of the light. Its fields are theirs then, so that it may be of any
/// kind, or not there.
bool describesLight(const ir::Module& module, const EvalPoints& points) {
  if (const auto count = lightCountOf(module); count && points.uniforms.contains(*count)) return true;
  return std::any_of(module.blocks.begin(), module.blocks.end(), [&](const ir::Block& block) {
    const auto given = points.uniforms.lower_bound(block.instance + ".");
    return block.role == ir::BlockRole::Lights && given != points.uniforms.end() &&
           given->first.starts_with(block.instance + ".");
  });
}

/// The kind of the one light, by the options and the points: the same for every engine.
passes::LightFacts factsOfLight(const ir::Module& module, const EvalPoints& points, const Options& options) {
  const bool fixed = options.lights.mode == Lights::Mode::Fixed;
  Strings kinds;
  for (const auto& [kind, count] : options.lights.counts) {
    if (count > 0) kinds.push_back(kind);
  }
  if (fixed && kinds.empty()) return {false, {}};
  if (describesLight(module, points) || !hasPointLight(module)) {
    if (fixed && kinds.size() == 1) return {false, {{kinds[0], 1}}};
    return {};
  }
  if (fixed && std::find(kinds.begin(), kinds.end(), kPointLight) == kinds.end()) return {false, {}};
  return {false, {{std::string(kPointLight), 1}}};
}

/// Where the template or the options' counts have other lights alone, nothing is seen of the points' own: the
/// light is what "uniforms" says.
void noteLights(const ir::Module& module, const EvalPoints& points, const Options& options,
                const std::string& file, Messages& messages) {
  if (!module.sums_lights || describesLight(module, points)) return;
  const auto& [mode, counts] = options.lights;
  const bool uncounted = mode == Lights::Mode::Fixed && !counts.empty() && !counts.contains(kPointLight);
  if (hasPointLight(module) && !uncounted) return;
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Lights) continue;
    const std::string why =
        hasPointLight(module)
            ? fmt::format("the lights counted have no '{}'", kPointLight)
            : fmt::format("the template '{}' has no kind of light '{}'", module.template_name, kPointLight);
    std::string fields;
    for (const ir::BlockField& field : block.fields)
      fields += fmt::format("{}\"{}.{}\"", fields.empty() ? "" : ", ", block.instance, field.name);
    report({{"light-unused",
             Severity::Warning,
             {file, 0, 0, {}},
             fmt::format("the points' 'l' and 'light' go nowhere: {}", why),
             fmt::format("say in \"uniforms\" what its light is: {}", fields),
             {}}},
           file, messages);
  }
}

/// Whether a type has a value of those numbers: of integers whole ones in their range.
bool fitsType(ir::Type type, const std::vector<double>& numbers) {
  const ir::Type part = ir::partType(type);
  if (!ir::isWhole(part)) return true;
  const double least = part == ir::Type::Int ? -0x1p31 : 0;
  const double most = part == ir::Type::Int ? 0x1p31 - 1 : 0x1p32 - 1;
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](double x) { return x == std::trunc(x) && x >= least && x <= most; });
}

/// Whether the points have an attribute as the module reads it, if they have it at all.
Result<void> checkAttribute(const std::string& name, ir::Type type, const EvalPoints& points,
                            const std::string& file) {
  const auto column = points.points.columns.find(name);
  if (!graph::isAttributeName(name) || column == points.points.columns.end()) return {};
  const auto given = points.attribute_components.find(name);
  const int count = given == points.attribute_components.end() ? column->second.components : given->second;
  // A colour may lack its alpha, as in glTF.
  const bool opaque = count == 3 && type == ir::Type::Vec4 && name.starts_with("COLOR_");
  if (count != ir::componentCount(type) && !opaque)
    return fail("wrong-type", {file, 0, 0, {}}, fmt::format("{} is given {} numbers", name, count),
                fmt::format("it is {} here", graph::article(type)));
  if (!fitsType(type, column->second.values))
    return fail("wrong-type", {file, 0, 0, {}},
                fmt::format("{} is given what is no {}", name, ir::typeName(ir::partType(type))),
                "its numbers are whole, and have 32 bits");
  return {};
}

/// With a vertex stage attributes are its inputs, and without one the fragment stage's.
Result<void> checkAttributes(const ir::Module& module, const EvalPoints& points, const std::string& file) {
  for (const ir::Attribute& attribute : module.attributes) {
    if (Result<void> fits = checkAttribute(attribute.name, attribute.type, points, file); !fits) return fits;
  }
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source != ir::kNoValue) continue;
    if (Result<void> fits = checkAttribute(varying.name, varying.type, points, file); !fits) return fits;
  }
  return {};
}

/// The points' own values, the environment of each, and what comes from the stages before the fragment's.
Result<void> bind(EvalMaterial& material, const EvalPoints& points, const std::string& file,
                  eval::Bindings& bindings) {
  eval::bindPoints(material.module(), points.points, bindings);
  material.bindClock(bindings);
  for (const ir::TextureSlot* slot : material.environments()) {
    bindings.textures[slot->name] = [&points](size_t point, const std::array<double, 3>&, double) {
      const std::array<double, 3>& e = points.environment[point];
      return std::array<double, 4>{e[0], e[1], e[2], 1};
    };
  }
  // Vertices may look into textures, too.
  if (Result<void> textures = material.bindTextures({}, bindings); !textures) return textures;
  if (Result<void> uniforms = bindUniforms(material.module(), points, file, bindings); !uniforms)
    return uniforms;
  for (const auto& [name, column] : material.columns()) bindings.columns[name] = column;
  if (Result<void> block = eval::bindMaterialBlock(material.module(), bindings, points.points.count); !block)
    return block;
  if (Result<void> varyings = eval::bindVaryings<float>(material.module(), points.points.count, bindings);
      !varyings) {
    return varyings;
  }
  return {};
}

/// The colours alone.
using Colors = Evaluation;

/// `values` holds four for each point.
template <class T>
void takeColors(const std::vector<T>& values, Colors& to) {
  to.rgba.resize(values.size() / 4);
  for (size_t i = 0; i < values.size(); ++i) to.rgba[i / 4][i % 4] = static_cast<double>(values[i]);
}

/// The second output of integers that are looked at.
bool isRest(const ir::Output& output) {
  return output.kind == ir::OutputKind::Color && output.location == 1 && output.name == "shown_rest";
}

template <class T>
void addRest(const std::vector<T>& values, Colors& to) {
  for (size_t i = 0; i < values.size(); ++i) to.rgba[i / 4][i % 4] += static_cast<double>(values[i]);
}

FragmentRoute routeOf(Engine engine) {
  return engine == Engine::VulkanHlsl   ? FragmentRoute::Hlsl
         : engine == Engine::VulkanGlsl ? FragmentRoute::Glsl
                                        : FragmentRoute::Direct;
}

vulkan::Texture environmentOf(const EvalPoints& points) {
  std::vector<vulkan::Texel> texels;
  for (const std::array<double, 3>& e : points.environment) {
    texels.push_back({static_cast<float>(e[0]), static_cast<float>(e[1]), static_cast<float>(e[2]), 1});
  }
  vulkan::Texture texture;
  texture.shape = vulkan::Shape::Cube;
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
  return texture;
}

vulkan::Texture constantOf(const std::array<double, 4>& value, ir::Type type) {
  vulkan::Texel texel{};
  for (size_t i = 0; i < 4; ++i) texel[i] = static_cast<float>(value[i]);
  vulkan::Texture texture = textureFor(type);
  texture.nearest = true;
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, texel);
  return texture;
}

/// Decoded here, as the device's sRGB format would before it filters.
vulkan::Texture imageOf(const eval::Image& image, const eval::Lookup& lookup, ir::Type type) {
  std::vector<vulkan::Texel> texels(image.size());
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = image.at(i);
  for (size_t i = 0; lookup.srgb && i < texels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      texels[i][c] = static_cast<float>(eval::decodeSrgb(static_cast<double>(texels[i][c])));
    }
  }
  vulkan::Texture texture = textureFor(type);
  texture.width = static_cast<uint32_t>(image.width);
  texture.height = static_cast<uint32_t>(image.height);
  texture.s = static_cast<vulkan::Wrap>(lookup.s);
  texture.t = static_cast<vulkan::Wrap>(lookup.t);
  texture.nearest = lookup.nearest;
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
  return texture;
}

GpuTextures gpuTextures(const EvalMaterial& material, const EvalPoints& points) {
  GpuTextures textures;
  for (const ir::TextureSlot* slot : material.environments()) textures[slot->name] = environmentOf(points);
  for (const auto& [name, bound] : material.textures()) {
    textures[name] = bound.constant ? constantOf(*bound.constant, bound.type)
                                    : imageOf(*bound.image, bound.lookup, bound.type);
  }
  return textures;
}

template <class T>
Result<Colors> colors(const ir::Module& module, const eval::Bindings& bindings, size_t points) {
  std::vector<ir::ValueId> roots;
  ir::ValueId color = ir::kNoValue;
  ir::ValueId rest = ir::kNoValue;
  ir::ValueId dropped = ir::kNoValue;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color && output.location == 0) color = output.value;
    if (isRest(output)) rest = output.value;
    if (output.kind == ir::OutputKind::Discard) dropped = output.value;
  }
  roots.push_back(color);
  if (rest != ir::kNoValue) roots.push_back(rest);
  if (dropped != ir::kNoValue) roots.push_back(dropped);
  const auto values = eval::evaluate<T>(module, roots, bindings, points);
  if (!values) return tl::make_unexpected(values.error());
  Colors result;
  takeColors((*values)[0], result);
  if (rest != ir::kNoValue) addRest((*values)[1], result);
  if (dropped != ir::kNoValue) {
    for (const T x : values->back()) result.discarded.push_back(x != 0);
  }
  return result;
}

Result<Colors> colorsOnGpu(const ir::Module& module, const eval::Bindings& bindings,
                           const GpuTextures& textures, size_t points, FragmentRoute route) {
  const Result<vulkan::Work> work = gpuWork(module, bindings, textures, points, route);
  if (!work) return tl::make_unexpected(work.error());
  const Result<vulkan::Device> device = vulkan::Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Result<vulkan::Outcome> outcome = device->run(*work);
  if (!outcome) return tl::make_unexpected(std::move(outcome.error()));
  Colors result;
  takeColors(outcome->outputs[0], result);
  if (std::any_of(module.outputs.begin(), module.outputs.end(), isRest)) addRest(outcome->outputs[1], result);
  result.device = device->name();
  const bool may_discard = std::any_of(module.outputs.begin(), module.outputs.end(),
                                       [](const auto& o) { return o.kind == ir::OutputKind::Discard; });
  if (!may_discard) return result;
  result.discarded = std::move(outcome->discarded);
  for (size_t i = 0; i < result.rgba.size(); ++i) {
    if (result.discarded[i]) result.rgba[i].fill(std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

/// As many points have the columns of the pages that those before them had: for the system to clear pages for
/// all of a million takes longer than their colours. The neighbours of derivatives are in the same one.
constexpr size_t kBatch = size_t{1} << 15;

/// How to evaluate, beside the material.
struct Setup {
  const EvalPoints& points;
  const std::string& points_file;
  const PointArrays* arrays;  ///< that the points are the first of; null where they are all
  Engine engine;
  const Strings& texels;
  const Options& options;
  const Trial& trial;
};

Result<Colors> colorsOf(EvalMaterial& evaluated, const EvalPoints& points, const std::string& points_file,
                        Engine engine) {
  eval::Bindings bindings;
  if (const Result<void> bound = bind(evaluated, points, points_file, bindings); !bound)
    return tl::make_unexpected(bound.error());
  const size_t count = points.points.count;
  const ir::Module& module = evaluated.module();
  if (engine == Engine::Double) return colors<double>(module, bindings, count);
  if (engine == Engine::Float) return colors<float>(module, bindings, count);
  return colorsOnGpu(module, bindings, gpuTextures(evaluated, points), count, routeOf(engine));
}

/// The colours of the points behind those that there are colours of.
Result<void> addBatches(EvalMaterial& evaluated, const Setup& how, Messages& messages, Colors& to) {
  const PointArrays& arrays = *how.arrays;
  to.rgba.reserve(arrays.count);
  while (to.rgba.size() < arrays.count) {
    const size_t first = to.rgba.size();
    Result<EvalPoints> points = pointsOf(arrays, first, std::min(kBatch, arrays.count - first));
    if (!points) {
      report(points.error(), how.points_file, messages);
      return tl::make_unexpected(Diagnostics());  // reported
    }
    if (Result<void> fits = checkAttributes(evaluated.module(), *points, how.points_file); !fits) return fits;
    if (Result<void> set = evaluated.replaceColumns(std::move(points->parameters)); !set) return set;
    const Result<Colors> more = colorsOf(evaluated, *points, how.points_file, how.engine);
    if (!more) return tl::make_unexpected(more.error());
    to.rgba.insert(to.rgba.end(), more->rgba.begin(), more->rgba.end());
    to.discarded.insert(to.discarded.end(), more->discarded.begin(), more->discarded.end());
  }
  return {};
}

Result<Evaluation> evaluateSubject(const EvalSubject& found, const Language& library, FileImages& images,
                                   const Setup& how, Messages& messages) {
  const auto& [points, points_file, arrays, engine, texels, options, trial] = how;
  const std::string& file = images.file();
  report(found.diagnostics(), file, messages);
  if (lacquer::hasError(found.diagnostics())) return tl::make_unexpected(Diagnostics());  // reported
  EvalMaterial evaluated(images, options);
  if (Result<void> set = evaluated.setTexels(texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  evaluated.setTrial(trial);
  evaluated.showWhole();
  const bool on_device = engine != Engine::Double && engine != Engine::Float;
  for (const auto& [name, column] : points.parameters) {
    if (on_device && column.per_point)
      return fail("no-such-engine", {}, fmt::format("'{}' differs from point to point", printable(name)),
                  "a device has one value of a parameter for all points: take the engine double or float");
  }
  evaluated.setColumns(points.parameters);
  Strings attributes;
  for (const auto& [name, column] : points.points.columns) {
    if (graph::isAttributeName(name)) attributes.push_back(name);
  }
  attributes.insert(attributes.end(), points.matrices.begin(), points.matrices.end());
  evaluated.setAttributes(std::move(attributes));
  if (Result<void> lowered = evaluated.lower(found, library, points.has_environment, {}, messages);
      !lowered) {
    return tl::make_unexpected(std::move(lowered.error()));
  }
  const passes::LightFacts counts{options.lights.mode != Lights::Mode::Fixed, options.lights.counts};
  if (Diagnostics wrong = passes::checkLights(evaluated.module(), counts); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  noteLights(evaluated.module(), points, options, points_file, messages);
  if (const Result<void> fits = checkAttributes(evaluated.module(), points, points_file); !fits)
    return tl::make_unexpected(fits.error());
  const passes::LightFacts lights = factsOfLight(evaluated.module(), points, options);
  // Placed, a module's uniforms are floats: in double it stays as it is.
  if (engine == Engine::Double)
    evaluated.countLights(lights);
  else
    evaluated.place(lights);
  if (on_device) report(aboutHalf(evaluated.module(), options), file, messages);
  Result<Colors> answer = colorsOf(evaluated, points, points_file, engine);
  report(images.takeNotes(), file, messages);
  if (!answer) return answer;
  if (arrays != nullptr) {
    if (const Result<void> added = addBatches(evaluated, how, messages, *answer); !added)
      return tl::make_unexpected(added.error());
  }
  answer->material = found.name();
  answer->engine = engine;
  answer->profile = evaluated.profile();
  answer->node = trial.node;
  if (evaluated.shown()) answer->type = ir::typeName(evaluated.shown()->type);
  return answer;
}

Result<Evaluation> evaluateFile(const std::string& file, const std::string& material, const Setup& how,
                                Messages& messages) {
  const auto library = libraryFor(how.options);
  if (!library) return tl::make_unexpected(library.error());
  if (isGraphFile(file)) {
    const Result<graph::Graph> graph = readGraphFile(file, how.options);
    if (!graph) return tl::make_unexpected(graph.error());
    FileImages none = FileImages::ofGraph(file, how.options);
    return evaluateSubject(*graph, **library, none, how, messages);
  }
  const Result<material::Document> document = readMaterials(file, **library, how.options);
  if (!document) return tl::make_unexpected(document.error());
  report(document->diagnostics, file, messages);
  Diagnostics warnings;
  const Result<size_t> place =
      material::findMaterial(*document, material.empty() ? std::nullopt : std::optional(material), warnings);
  if (!place) return tl::make_unexpected(place.error());
  report(warnings, file, messages);
  FileImages images(file, how.options);
  return evaluateSubject(document->materials[*place], **library, images, how, messages);
}

Diagnostics checkEvaluation(Engine engine, const Options& options) {
  Diagnostics wrong = checkReading(options);
  if (engineName(engine).empty()) {
    wrong.push_back({"unknown-enumerator",
                     Severity::Error,
                     {},
                     fmt::format("the engine is {}, which is no enumerator", static_cast<int>(engine)),
                     "they are 0 to 4",
                     {}});
  }
  if (engine == Engine::VulkanHlsl && options.parameters == Parameters::Spec) {
    wrong.push_back({"no-specialization-constants",
                     Severity::Error,
                     {},
                     "HLSL has no specialization constants",
                     "let the parameters be uniform or baked, or go by the direct SPIR-V or the GLSL",
                     {}});
  }
  return wrong;
}

}  // namespace

std::string_view engineName(Engine engine) {
  switch (engine) {
    case Engine::Double: return "double";
    case Engine::Float: return "float";
    case Engine::Vulkan:
    case Engine::VulkanGlsl:
    case Engine::VulkanHlsl: return "vulkan";
  }
  return {};  // no enumerator
}

std::optional<Evaluation> evaluate(const std::string& file, const std::string& material,
                                   const std::string& points, const std::string& points_name, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial) {
  if (const Diagnostics wrong = checkEvaluation(engine, options); !wrong.empty())
    return report(wrong, {}, messages), std::nullopt;
  const Limits limits = *limitsOf(options);
  Result<std::string> text = points;
  if (points.empty())
    text = points_name == "-" ? readStandardInput(limits.file) : readFile(points_name, limits.file);
  const Result<EvalPoints> read =
      text ? readPoints(*text, points_name, limits) : tl::make_unexpected(text.error());
  if (!read) return report(read.error(), points_name, messages), std::nullopt;
  return valueOf(
      evaluateFile(file, material, {*read, points_name, nullptr, engine, texels, options, trial}, messages),
      file, messages);
}

std::optional<Evaluation> evaluateOf(const InMemory& of, const GivenPoints& points, Engine engine,
                                     const Strings& texels, const Options& options, Messages& messages,
                                     const Trial& trial) {
  static const std::string kPoints = "points";
  if (const Diagnostics wrong = checkEvaluation(engine, options); !wrong.empty())
    return report(wrong, {}, messages), std::nullopt;
  const auto* text = std::get_if<const std::string*>(&points);
  const PointArrays* arrays = text == nullptr ? std::get<const PointArrays*>(points) : nullptr;
  const bool on_device = engine != Engine::Double && engine != Engine::Float;
  const Result<EvalPoints> read =
      text != nullptr ? readPoints(**text, kPoints, *limitsOf(options))
                      : pointsOf(*arrays, 0, on_device ? arrays->count : std::min(kBatch, arrays->count));
  if (!read) return report(read.error(), kPoints, messages), std::nullopt;
  FileImages images = of.images(options);
  return valueOf(evaluateSubject(of.subject, of.language, images,
                                 {*read, kPoints, arrays, engine, texels, options, trial}, messages),
                 of.file, messages);
}

}  // namespace lacquer
