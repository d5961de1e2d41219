#include "eval/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cost/choose.h"
#include "eval/dfg.h"
#include "graph/check_parts.h"
#include "graph/contracts.h"
#include "graph/text.h"
#include "lang/suggest.h"
#include "lower/lower.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "support/text.h"

namespace lacquer {

namespace {

bool isTextureProperty(const material::Schema& schema, const std::string& name) {
  return std::any_of(schema.properties.begin(), schema.properties.end(),
                     [&](const material::Property& property) {
                       return property.decl->kind == material::Kind::Texture && property.decl->name == name;
                     });
}

/// Tiles have the numbers 1001 to 1100: ten columns of ten rows.
constexpr size_t kMostTiles = 100;

eval::Wrap wrapOf(int gl) {
  constexpr int kClamp = 33071;
  constexpr int kMirror = 33648;
  return gl == kClamp ? eval::Wrap::Clamp : gl == kMirror ? eval::Wrap::Mirror : eval::Wrap::Repeat;
}

}  // namespace

static std::string_view lastPart(std::string_view pointer) { return pointer.substr(pointer.rfind('/') + 1); }

std::string propertyOf(const ir::TextureSlot& slot) {
  return slot.pointer.empty() ? slot.name : std::string(lastPart(slot.pointer));
}

std::array<double, 4> neutralTexel(const ir::TextureSlot& slot) {
  const std::string property = propertyOf(slot);
  const auto ends = [&](std::string_view end) {
    return property.size() >= end.size() &&
           property.compare(property.size() - end.size(), end.size(), end) == 0;
  };
  if (ends("ormalTexture")) return {0.5, 0.5, 1, 1};
  if (ends("nisotropyTexture")) return {1, 0.5, 1, 1};
  return {1, 1, 1, 1};
}

FileImages::FileImages(std::string file, const Options& options, std::shared_ptr<const std::string> bytes)
    : file_(std::move(file)),
      bytes_(std::move(bytes)),
      access_{limitsOf(options).value_or(Limits{}), options.allow} {}

FileImages FileImages::ofGraph(std::string file, const Options& options, bool in_memory) {
  FileImages images(std::move(file), options);
  images.of_graph_ = true;
  images.in_memory_ = in_memory;
  return images;
}

bool FileImages::makeRoom(uint64_t pixels) {
  while (pixels > access_.limits.images - std::min(held_, access_.limits.images)) {
    auto oldest = images_.end();
    for (auto it = images_.begin(); it != images_.end(); ++it) {
      const bool free = it->second.image.use_count() == 1;
      if (free && (oldest == images_.end() || it->second.used < oldest->second.used)) oldest = it;
    }
    if (oldest == images_.end()) return false;
    held_ -= oldest->second.pixels;
    images_.erase(oldest);
  }
  return true;
}

Result<FileImages::Held> FileImages::decode(const Result<std::string>& bytes, const Place& place) {
  if (!bytes) return tl::make_unexpected(bytes.error());
  const Result<eval::ImageSize> size = eval::sizeOfImage(*bytes, place);
  if (!size) return tl::make_unexpected(size.error());
  const uint64_t pixels = size->pixels() * (size->wide ? 2 : 1);
  const bool alone = size->pixels() > access_.limits.image;  // which decoding says
  if (!alone && !makeRoom(pixels)) {
    return fail("image-too-large", place,
                fmt::format("the material's images together have more than {} pixels (of 8 bits per channel)",
                            access_.limits.images),
                raising("images"));
  }
  Result<eval::Image> image = eval::decodeImage(*bytes, access_.limits.image, place);
  if (!image) return tl::make_unexpected(std::move(image.error()));
  return Held{std::make_shared<const eval::Image>(std::move(*image)), pixels, 0};
}

template <class Bytes>
Result<std::shared_ptr<const eval::Image>> FileImages::image(const std::string& key, const Place& place,
                                                             Bytes bytes) {
  auto it = images_.find(key);
  if (it == images_.end()) {
    Result<Held> decoded = decode(bytes(), place);
    if (!decoded) return tl::make_unexpected(std::move(decoded.error()));
    held_ += decoded->pixels;
    it = images_.emplace(key, std::move(*decoded)).first;
  }
  it->second.used = ++uses_;
  return it->second.image;
}

/// An image of an extension's that there is another one for.
void FileImages::passedOver(int texture, const gltf::TextureSource& source) {
  const std::vector<gltf::Texture::Source>& others = source.texture.sources;
  if (source.texture.source < 0 || others.empty() || !noted_.insert(texture).second) return;
  notes_.push_back({"image-fallback",
                    Severity::Note,
                    {file_, 0, 0, fmt::format("/textures/{}/extensions/{}", texture, others[0].extension)},
                    fmt::format("image {} of {} is not decoded here: image {} is looked into",
                                others[0].image, others[0].extension, source.texture.source),
                    "an engine may show the other",
                    {}});
}

Result<void> FileImages::open() {
  if (opened_) return {};
  if (of_graph_ || isMaterialX()) {
    opened_ = gltf::TextureFile::beside(file_, access_, in_memory_ || bytes_ != nullptr);
    return {};
  }
  Result<gltf::TextureFile> opened = bytes_ ? gltf::TextureFile::fromMemory(*bytes_, file_, access_)
                                            : gltf::TextureFile::open(file_, access_);
  if (!opened) return tl::make_unexpected(std::move(opened.error()));
  opened_ = std::move(*opened);
  return {};
}

gltf::Geometry FileImages::geometry(size_t material) {
  if (of_graph_ || isMaterialX() || !open()) return {};
  return gltf::geometryOf(*opened_, material);
}

Result<FileImages::Loaded> FileImages::load(int texture, bool srgb) {
  if (of_graph_)
    return fail("image-missing", {file_, 0, 0, {}}, "a graph without its glTF file has none of its images",
                {});
  if (Result<void> opened = open(); !opened) return tl::make_unexpected(std::move(opened.error()));
  const Result<gltf::TextureSource> source = opened_->texture(texture);
  if (!source) return tl::make_unexpected(source.error());
  passedOver(texture, *source);
  Result<std::shared_ptr<const eval::Image>> found =
      image(std::to_string(source->image), source->place, [&] { return opened_->image(*source); });
  if (!found) return tl::make_unexpected(std::move(found.error()));
  constexpr int kNearest = 9728;
  const gltf::Texture& of = source->texture;
  return Loaded{std::move(*found), {wrapOf(of.wrapS), wrapOf(of.wrapT), of.magFilter == kNearest, srgb}};
}

/// How a graph's texture is looked up.
static eval::Lookup lookupOf(const graph::Texture& texture) {
  const auto wrap = [&](size_t i) { return static_cast<eval::Wrap>(texture.wrap[i]); };
  return {wrap(0), wrap(1), texture.nearest, texture.srgb};
}

static Diagnostics at(const Place& place, Diagnostics said) {
  for (Diagnostic& one : said) one.place = place;
  return said;
}

/// Where a texture's file is named: in the document that was read, or in a graph.
Place FileImages::placeOf(const graph::Texture& texture) const {
  if (texture.place.line > 0) return texture.place;
  const bool read = !of_graph_ && !texture.pointer.empty();
  return {file_, 0, 0, read ? texture.pointer : fmt::format("/textures/{}/file", texture.name)};
}

Result<FileImages::Loaded> FileImages::load(const graph::Texture& texture) {
  if (Result<void> opened = open(); !opened) return tl::make_unexpected(std::move(opened.error()));
  if (!graph::tileToken(texture.file).empty()) return loadTiles(texture);
  const Place place = placeOf(texture);
  Result<std::shared_ptr<const eval::Image>> found =
      image("uri " + texture.file, place, [&] { return opened_->fileBytes(texture.file, place.pointer); });
  if (!found) return tl::make_unexpected(at(place, std::move(found.error())));
  return Loaded{std::move(*found), lookupOf(texture)};
}

Result<FileImages::Loaded> FileImages::loadTiles(const graph::Texture& texture) {
  const Place place = placeOf(texture);
  const std::string key = "tiles " + texture.file;
  const eval::Lookup lookup = lookupOf(texture);
  if (const auto known = images_.find(key); known != images_.end()) {
    known->second.used = ++uses_;
    return Loaded{known->second.image, lookup};
  }
  std::vector<std::shared_ptr<const eval::Image>> layers;
  for (size_t n = 0; n < kMostTiles; ++n) {
    const std::string uri = graph::tileFile(texture.file, n);
    Result<std::string> bytes = opened_->fileBytes(uri, place.pointer);
    if (!bytes && bytes.error()[0].code == "image-missing") continue;
    Result<std::shared_ptr<const eval::Image>> found =
        image("uri " + uri, place, [&] { return std::move(bytes); });
    if (!found) return tl::make_unexpected(at(place, std::move(found.error())));
    layers.resize(n + 1);
    layers[n] = std::move(*found);
  }
  if (layers.empty()) {
    return fail("image-missing", place,
                fmt::format("no tile from {} to {} is there", quote(graph::tileFile(texture.file, 0)),
                            quote(graph::tileFile(texture.file, kMostTiles - 1))),
                {});
  }
  const auto first = std::find_if(layers.begin(), layers.end(), [](const auto& l) { return l != nullptr; });
  // With a layer that is missing they are floats.
  const bool gaps = std::find(layers.begin(), layers.end(), nullptr) != layers.end();
  const uint64_t pixels = (*first)->size() * layers.size() * (gaps ? sizeof(float) : 1);
  if (!makeRoom(pixels)) {
    return fail("image-too-large", place,
                fmt::format("the material's images together have more than {} pixels (of 8 bits per channel)",
                            access_.limits.images),
                raising("images"));
  }
  std::array<double, 4> missing{0, 0, 0, 1};
  if (texture.color) std::copy_n(texture.color->begin(), 4, missing.begin());
  for (size_t c = 0; lookup.srgb && c < 3; ++c) missing[c] = eval::encodedSrgb(missing[c]);
  Result<eval::Image> made = eval::layered(layers, missing, place);
  if (!made) return tl::make_unexpected(std::move(made.error()));
  Held held{std::make_shared<const eval::Image>(std::move(*made)), pixels, ++uses_};
  held_ += pixels;
  return Loaded{images_.emplace(key, std::move(held)).first->second.image, lookup};
}

void EvalMaterial::bindClock(eval::Bindings& bindings) const {
  eval::bindClock(trial_.time, trial_.frame, bindings);
}

Result<EvalMaterial::Texel> EvalMaterial::parseTexel(const std::string& text) {
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

Result<void> EvalMaterial::setTexels(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    Result<Texel> texel = parseTexel(text);
    if (!texel) return tl::make_unexpected(std::move(texel.error()));
    texels_.push_back(std::move(*texel));
  }
  return {};
}

Result<void> EvalMaterial::lower(const EvalSubject& subject, const Language& library, bool environment,
                                 const std::string& variant, Messages& messages) {
  constexpr double kLast = 16777216;  // a float counts no single pictures beyond
  for (const auto& [what, value] : {std::pair("time", trial_.time), std::pair("frame", trial_.frame)}) {
    if (!(value >= 0 && value <= kLast))
      return fail("out-of-range", {}, fmt::format("the {} is {}", what, value),
                  fmt::format("from 0 to {}", kLast));
  }
  Options options = options_;
  if (!subject.isGraph()) {
    if (Result<void> named = resolveNames(library, options); !named) return named;
    profile_ = profileOf(*subject.material(), options);
  }
  options.ibl = options.ibl && environment;
  options.decode_srgb = false;
  Diagnostics warnings;
  graph::FlatOutputs outputs;
  gltf::VertexAttributes attributes{true, tangents_, true, {true, true, true, true}};
  attributes.application = attributes_;
  Result<graph::Graph> built = subject.graph(attributes, library, options, originals_, warnings, &outputs);
  report(warnings, images_.file(), messages);
  if (!built) return tl::make_unexpected(std::move(built.error()));
  graph::Graph graph = std::move(*built);
  for (graph::Node& node : graph.nodes) {
    const Result<const lang::NodeDecl*> decl = library.node(node.type);
    if (decl && !variant.empty() && (*decl)->find(variant) != nullptr) node.variant = variant;
  }
  if (Result<void> set = setParameters(library, graph); !set) return set;
  if (Diagnostics wrong = graph::check(graph, library, limitsOf(options).value_or(Limits{}).nodes);
      lacquer::hasError(wrong)) {
    return tl::make_unexpected(std::move(wrong));
  }
  lower::LowerOptions how = loweringOf(options, true);
  Result<graph::Source> shown;
  if (!trial_.node.empty()) {
    shown = look(graph, library, outputs);
    if (!shown) return tl::make_unexpected(std::move(shown.error()));
    how.shown = &*shown;
    how.shown_whole = whole_;
  }
  Result<ir::Module> module = lower::lower(graph, library, how);
  if (!module) return tl::make_unexpected(std::move(module.error()));
  module_ = std::move(*module);
  widenColors(module_);
  return checkTexels(**library.models.schema());
}

/// As a texture of one channel or two is read: what is not there is 0, and alpha 1.
void widenColors(ir::Module& module) {
  ir::Dag& dag = module.dag;
  for (ir::Output& output : module.outputs) {
    if (output.kind != ir::OutputKind::Color || dag[output.value].type == ir::Type::Vec4) continue;
    if (dag[output.value].type == ir::Type::Int) output.value = dag.make(ir::Op::FromInt, {output.value});
    if (dag[output.value].type == ir::Type::UInt) output.value = dag.make(ir::Op::FromUInt, {output.value});
    std::vector<ir::ValueId> parts{output.value};
    for (int c = ir::componentCount(dag[output.value].type); c < 4; ++c)
      parts.push_back(dag.constant(c == 3 ? 1 : 0));
    output.value = dag.construct(ir::Type::Vec4, parts);
  }
}

namespace {

/// The parameter of that name or JSON pointer.
Result<size_t> parameterOf(const graph::Graph& graph, const std::string& wanted) {
  const auto found =
      std::find_if(graph.parameters.begin(), graph.parameters.end(), [&](const graph::Parameter& p) {
        return p.name == wanted || (!p.pointer.empty() && p.pointer == wanted);
      });
  if (found != graph.parameters.end()) return static_cast<size_t>(found - graph.parameters.begin());
  std::vector<std::string_view> names;
  for (const graph::Parameter& p : graph.parameters) names.push_back(p.name);
  return fail("no-such-parameter", {}, fmt::format("there is no parameter '{}'", printable(wanted)),
              lang::didYouMean(wanted, names));
}

/// Whether a parameter may be these numbers, of any number of points.
Result<void> checkNumbers(const graph::Parameter& parameter, const ir::Range& range, const std::string& name,
                          std::span<const double> numbers) {
  const ir::Type part = ir::partType(parameter.type);
  for (const double x : numbers) {
    const bool fits = part == ir::Type::Bool ? x == 0 || x == 1 : !ir::isWhole(part) || x == std::trunc(x);
    if (!fits)
      return fail("wrong-type", {}, fmt::format("'{}' is given {}", printable(name), x),
                  part == ir::Type::Bool ? "it is a bool, 0 or 1" : "it is a whole number");
    if (range.contains(x) && graph::fitsFloat(x)) continue;
    return fail("out-of-range", {}, fmt::format("'{}' is given {}", printable(name), x),
                fmt::format("the range is {}", ir::rangeText(range)));
  }
  return {};
}

Result<void> checkCount(const graph::Parameter& parameter, const std::string& name, size_t count) {
  if (count == static_cast<size_t>(ir::componentCount(parameter.type))) return {};
  return fail("wrong-count", {}, fmt::format("'{}' is given {} numbers", printable(name), count),
              fmt::format("it is {}", graph::article(parameter.type)));
}

/// A matrix, which the graph has as its columns: as many numbers for each of them.
Result<NamedNumbers> byColumn(const graph::Graph& graph, const NamedNumbers& parameters) {
  NamedNumbers all;
  for (const auto& [name, numbers] : parameters) {
    std::vector<const graph::Parameter*> columns;
    for (const graph::Parameter& p : graph.parameters) {
      if (!p.column_of.empty() && p.column_of == name) columns.push_back(&p);
    }
    if (columns.empty()) {
      all.emplace_back(name, numbers);
      continue;
    }
    const size_t side = columns.size();
    if (numbers.size() != side * side)
      return fail("wrong-count", {}, fmt::format("'{}' is given {} numbers", printable(name), numbers.size()),
                  fmt::format("it is a mat{0}, {1} numbers column by column", side, side * side));
    for (size_t c = 0; c < side; ++c) {
      const auto from = numbers.begin() + static_cast<ptrdiff_t>(c * side);
      all.emplace_back(columns[c]->name, std::vector<double>(from, from + static_cast<ptrdiff_t>(side)));
    }
  }
  return all;
}

}  // namespace

/// Values in place of today's.
Result<void> EvalMaterial::setParameters(const Language& library, graph::Graph& graph) {
  if (trial_.parameters.empty() && columns_.empty()) return {};
  const std::vector<ir::Range> limits = graph::parameterLimits(graph, library);
  const Result<NamedNumbers> given = byColumn(graph, trial_.parameters);
  if (!given) return tl::make_unexpected(given.error());
  for (const auto& [name, numbers] : *given) {
    const Result<size_t> place = parameterOf(graph, name);
    if (!place && anyway_) continue;
    if (!place) return tl::make_unexpected(place.error());
    graph::Parameter& found = graph.parameters[*place];
    // One number for each component of a vector, as in graphs.
    std::vector<double> value = numbers;
    if (value.size() == 1 && ir::isFloatVector(found.type))
      value.assign(static_cast<size_t>(ir::componentCount(found.type)), numbers[0]);
    if (Result<void> wrong = checkCount(found, name, value.size()); !wrong) return wrong;
    if (Result<void> wrong = checkNumbers(found, limits[*place], name, value); !wrong) return wrong;
    std::copy(value.begin(), value.end(), found.value.begin());
    changed_.push_back(name);
  }
  return checkColumns(graph, limits);
}

Result<void> EvalMaterial::checkColumns(const graph::Graph& graph, const std::vector<ir::Range>& limits) {
  std::map<std::string, eval::Column> by_name;
  for (auto& [name, column] : columns_) {
    const Result<size_t> place = parameterOf(graph, name);
    if (!place) return tl::make_unexpected(place.error());
    const graph::Parameter& found = graph.parameters[*place];
    const auto components = static_cast<size_t>(column.components);
    if (Result<void> wrong = checkCount(found, name, components); !wrong) return wrong;
    if (Result<void> wrong = checkNumbers(found, limits[*place], name, column.values); !wrong) return wrong;
    if (options_.parameters != Parameters::Uniform)
      return fail("parameters-are-constants", {}, fmt::format("'{}' is given an array", printable(name)),
                  "the options' parameters must be uniforms");
    if (!by_name.emplace(found.name, std::move(column)).second)
      return fail("duplicate-name", {}, fmt::format("'{}' is given twice", printable(found.name)), {});
    columns_of_.insert_or_assign(name, std::pair(found, limits[*place]));
  }
  columns_ = std::move(by_name);
  return {};
}

Result<void> EvalMaterial::replaceColumns(std::map<std::string, eval::Column> columns) {
  for (auto& [name, column] : columns) {
    const auto& [parameter, limits] = columns_of_.find(name)->second;
    if (Result<void> wrong = checkNumbers(parameter, limits, name, column.values); !wrong) return wrong;
    columns_.insert_or_assign(parameter.name, std::move(column));
  }
  return {};
}

/// The source of the output that is to be looked at.
Result<graph::Source> EvalMaterial::look(const graph::Graph& graph, const Language& library,
                                         const graph::FlatOutputs& outputs) {
  Result<graph::Source> source = graph::outputAt(outputs, trial_.node);
  // A material that is a nodegraph's pattern alone is called as the graph, whose nodes are its own.
  const std::string within = graph.name.substr(0, graph.name.find('/')) + "/";
  if (!source && trial_.node.starts_with(within)) {
    Result<graph::Source> own = graph::outputAt(outputs, trial_.node.substr(within.size()));
    if (own) source = std::move(own);
  }
  if (!source) return source;
  const graph::Contracts contracts(graph, library);
  const std::optional<graph::Offer> offer = contracts.offer(*source, contracts.main());
  if (!offer)
    return fail("no-such-node", {},
                fmt::format("the node '{}' is not there any more", printable(trial_.node)),
                "what was to be simpler has removed it");
  if (ir::isMatrix(offer->type) || ir::isTexture(offer->type))
    return fail("wrong-type", {},
                fmt::format("the output of '{}' is {}", printable(trial_.node), graph::article(offer->type)),
                "a number, a bool or a vector can be looked at");
  shown_ = Shown{offer->type, offer->has_range ? std::optional(offer->range) : std::nullopt};
  return source;
}

passes::LightFacts EvalMaterial::lit(passes::LightFacts lights) const {
  // A shader for fixed counts of lights has none of a kind that is not counted.
  if (options_.lights.mode != Lights::Mode::Fixed) return lights;
  if (options_.lights.counts.empty()) lights.any = false;
  for (auto& [kind, count] : lights.counts) {
    const auto fixed = options_.lights.counts.find(kind);
    count = std::min(count, fixed == options_.lights.counts.end() ? 0U : fixed->second);
  }
  return lights;
}

void EvalMaterial::place(const passes::LightFacts& lights) {
  passes::PipelineOptions pipeline;
  pipeline.lights = lit(lights);
  pipeline.relaxed = options_.relaxed;
  pipeline.half = options_.half;
  pipeline.optimize = optimization(options_);
  pipeline.choose = cost::chooserOf(options_);
  passes::runPipeline(module_, pipeline);
}

void EvalMaterial::countLights(const passes::LightFacts& lights) {
  const passes::LightFacts facts = lit(lights);
  if (options_.lights.mode == Lights::Mode::Fixed && !facts.any) passes::specializeLights(module_, facts);
}

std::vector<const ir::TextureSlot*> EvalMaterial::usedTextures() const {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
  std::vector<bool> used(module_.textures.size(), false);
  for (const ir::ValueId id : ir::reachable(module_.dag, roots)) {
    if (module_.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module_.dag.inputOf(id);
    if (input.kind == ir::InputKind::Texture) used[input.field] = true;
  }
  std::vector<const ir::TextureSlot*> slots;
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i]) slots.push_back(&module_.textures[i]);
  }
  return slots;
}

std::vector<const ir::TextureSlot*> EvalMaterial::environments() const {
  std::vector<const ir::TextureSlot*> slots = usedTextures();
  std::erase_if(slots,
                [&](const ir::TextureSlot* slot) { return !isMap(*slot) || texelOf(*slot) != nullptr; });
  return slots;
}

Result<void> EvalMaterial::bindTextures(const Substitute& substitute, eval::Bindings& bindings) {
  Diagnostics wrong;
  for (const ir::TextureSlot* slot : usedTextures()) {
    if (isMap(*slot) && texelOf(*slot) == nullptr) continue;
    Result<BoundTexture> bound = slot->environment ? environmentOf(*slot) : textureOf(*slot, substitute);
    if (!bound) {
      wrong.insert(wrong.end(), bound.error().begin(), bound.error().end());
      continue;
    }
    if (bound->constant) {
      const std::array<double, 4> value = *bound->constant;
      bindings.textures[slot->name] = [value](size_t, const std::array<double, 3>&, double) { return value; };
    } else {
      bindings.textures[slot->name] = eval::makeSampler(bound->image, bound->lookup);
    }
    bound->type = slot->type;
    bound_[slot->name] = std::move(*bound);
  }
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  return {};
}

/// An environment map, which points have for themselves where it is given no constant.
bool EvalMaterial::isMap(const ir::TextureSlot& slot) {
  return slot.environment && slot.type == ir::Type::TextureCube;
}

/// The pointers of its property, and of others that have the same texel.
std::vector<std::string> EvalMaterial::pointersOf(const ir::TextureSlot& slot) const {
  if (slot.environment) return {};
  std::vector<std::string> pointers = originals_[static_cast<size_t>(slot.texture)].also;
  if (!slot.pointer.empty()) pointers.push_back(slot.pointer);
  return pointers;
}

namespace {

/// "ACME_stain.stainTexture" of "/materials/0/extensions/ACME_stain/stainTexture"; empty for what stands in
/// no extension.
std::string ofExtension(std::string_view pointer) {
  constexpr std::string_view kExtensions = "/extensions/";
  const size_t at = pointer.rfind(kExtensions);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = pointer.substr(at + kExtensions.size());
  return fmt::format("{}.{}", rest.substr(0, rest.find('/')), lastPart(rest));
}

}  // namespace

/// By its name alone, or as one of all textures: with the extension before the property, or by the pointer.
bool EvalMaterial::namesOne(const std::string& name, const ir::TextureSlot& slot) const {
  if (name == slot.name) return true;
  const std::vector<std::string> pointers = pointersOf(slot);
  return std::any_of(pointers.begin(), pointers.end(), [&](const std::string& pointer) {
    return pointer == name || ofExtension(pointer) == name;
  });
}

/// By its name, its property's or that of another property that has the same texel.
bool EvalMaterial::names(const std::string& name, const ir::TextureSlot& slot) const {
  if (namesOne(name, slot)) return true;
  const std::vector<std::string> pointers = pointersOf(slot);
  return std::any_of(pointers.begin(), pointers.end(),
                     [&](const std::string& pointer) { return lastPart(pointer) == name; });
}

/// The last one that is given for it.
const EvalMaterial::Texel* EvalMaterial::texelOf(const ir::TextureSlot& slot) const {
  const auto found = std::find_if(texels_.rbegin(), texels_.rend(),
                                  [&](const Texel& texel) { return names(texel.slot, slot); });
  return found == texels_.rend() ? nullptr : &*found;
}

/// A property's name may be that of several extensions' textures.
Result<void> EvalMaterial::checkAmbiguity() const {
  for (const Texel& texel : texels_) {
    std::vector<std::string> meant;
    bool exact = false;
    for (const ir::TextureSlot& slot : module_.textures) {
      if (!names(texel.slot, slot)) continue;
      exact = exact || namesOne(texel.slot, slot);
      for (const std::string& pointer : pointersOf(slot)) {
        if (lastPart(pointer) != texel.slot) continue;
        const std::string of_extension = ofExtension(pointer);
        meant.push_back(of_extension.empty() ? pointer : of_extension);
        break;
      }
    }
    if (exact || meant.size() < 2) continue;
    return fail("ambiguous-texture", {},
                fmt::format("--texel: {} textures are called '{}'", meant.size(), printable(texel.slot)),
                fmt::format("name one: {}", fmt::join(meant, ", ")));
  }
  return {};
}

/// One texel has one value, whichever of its properties names it. Of one name the last counts.
Result<void> EvalMaterial::checkAgreement() const {
  for (const ir::TextureSlot& slot : module_.textures) {
    if (slot.environment) continue;
    std::map<std::string_view, const Texel*> given;
    for (const Texel& texel : texels_) {
      if (names(texel.slot, slot)) given[texel.slot] = &texel;
    }
    for (const auto& [name, texel] : given) {
      const Texel& first = *given.begin()->second;
      if (texel->value == first.value) continue;
      return fail("texels-differ", {},
                  fmt::format("--texel: {} and {} are one texel, and are given {} and {}", first.slot, name,
                              fmt::join(first.value, ","), fmt::join(texel->value, ",")),
                  "give it one constant");
    }
  }
  return {};
}

/// A texel for a texture that this material does not have is not used; a name that no texture has is a
/// mistake.
Result<void> EvalMaterial::checkTexels(const material::Schema& schema) const {
  for (const Texel& texel : texels_) {
    const bool known = isTextureProperty(schema, texel.slot) ||
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
  if (Result<void> one = checkAmbiguity(); !one) return one;
  return checkAgreement();
}

/// A texture of the template's: a constant that is given, a table of factors, or a depth map in which
/// nothing stands.
Result<BoundTexture> EvalMaterial::environmentOf(const ir::TextureSlot& slot) const {
  if (const Texel* texel = texelOf(slot)) return BoundTexture{texel->value, {}, {}};
  if (const auto table = eval::environmentTable(slot.name); table && slot.type == ir::Type::Texture2D)
    return BoundTexture{{}, table, {eval::Wrap::Clamp, eval::Wrap::Clamp, false, false}};
  if (slot.texel) return BoundTexture{*slot.texel, {}, {}};
  if (slot.type == ir::Type::Texture2DShadow) return BoundTexture{std::array<double, 4>{1, 0, 0, 0}, {}, {}};
  return fail("image-missing", {},
              fmt::format("the template '{}' is given a texture '{}' that has no texels here",
                          module_.template_name, slot.name),
              fmt::format("give a constant: --texel {}=r,g,b,a", slot.name));
}

Result<BoundTexture> EvalMaterial::textureOf(const ir::TextureSlot& slot, const Substitute& substitute) {
  if (const Texel* texel = texelOf(slot)) return BoundTexture{texel->value, {}, {}};
  const graph::Texture& original = originals_[static_cast<size_t>(slot.texture)];
  const bool nothing = original.texture < 0 && original.file.empty();
  if (original.color && nothing) return BoundTexture{*original.color, {}, {}};
  Result<FileImages::Loaded> loaded =
      original.file.empty() ? images_.load(original.texture, slot.srgb) : images_.load(original);
  if (loaded && original.own_sampler) loaded->lookup = lookupOf(original);
  if (loaded) return BoundTexture{{}, loaded->image, loaded->lookup};
  if (original.color) {
    for (Diagnostic& d : loaded.error()) {
      d.severity = Severity::Warning;
      d.help = "its default colour stands for it";
      images_.note(std::move(d));
    }
    return BoundTexture{*original.color, {}, {}};
  }
  if (substitute) {
    if (const std::optional<std::array<double, 4>> value = substitute(slot, loaded.error()))
      return BoundTexture{value, {}, {}};
  }
  for (Diagnostic& d : loaded.error()) {
    d.message = fmt::format("{} has no image: {}", propertyOf(slot), d.message);
    if (d.help.empty()) d.help = fmt::format("or give a constant: --texel {}=r,g,b,a", propertyOf(slot));
  }
  return tl::make_unexpected(std::move(loaded.error()));
}

}  // namespace lacquer
