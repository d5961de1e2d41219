#include "lod/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "cost/cost.h"
#include "cost/quarter.h"
#include "lod/estimate.h"
#include "lod/share.h"
#include "setting/messages.h"
#include "setting/option_key.h"
#include "setting/simplify.h"
#include "shader/print.h"
#include "support/jobs.h"

namespace lacquer {

namespace {

/// Interpolants that every device takes, of four numbers each.
constexpr size_t kMostVaryings = 15;

// As in cost/cost.cpp: a child that is born while another thread allocates waits for ever with GCC's
// address sanitizer.
#ifdef __SANITIZE_ADDRESS__
constexpr auto kBeside = std::launch::deferred;
#else
constexpr auto kBeside = std::launch::async;
#endif

/// How a texture's texel is made of an image's.
struct Taken {
  bool by_format = false, by_shader = false;  ///< who decodes sRGB, if anybody does
  gltf::Channels channels = gltf::kOwnChannels;
};

Taken takenOf(const material::Material* material, const material::Schema& schema,
              const ir::TextureSlot& slot) {
  Taken taken{slot.srgb, false, gltf::kOwnChannels};
  if (material == nullptr) return taken;
  for (const material::Material::Texture& texture : material->textures) {
    if (texture.info.pointer != slot.pointer) continue;
    taken.channels = texture.info.channels;
    taken.by_shader = schema.properties[texture.property].decl->srgb && !slot.srgb;
  }
  return taken;
}

std::array<double, 4> texelOf(const std::array<double, 4>& stored, const Taken& taken) {
  std::array<double, 4> texel{};
  for (size_t c = 0; c < 4; ++c) {
    const int from = taken.channels[c];
    const double x = from == gltf::kUnused ? 1 : stored[static_cast<size_t>(from)];
    const bool decoded = (taken.by_format && from < 3) || (taken.by_shader && c < 3);
    texel[c] = decoded && from != gltf::kUnused ? eval::decodeSrgb(x) : x;
  }
  return texel;
}

/// The mean over an image, linear.
std::array<double, 4> meanOf(const eval::Image& image, const Taken& taken) {
  std::array<double, 4> sum{};
  for (size_t i = 0; i < image.size(); ++i) {
    const std::array<float, 4> stored = image.at(i);
    const std::array<double, 4> texel = texelOf({stored[0], stored[1], stored[2], stored[3]}, taken);
    for (size_t c = 0; c < 4; ++c) sum[c] += texel[c];
  }
  for (double& x : sum) x /= static_cast<double>(std::max<size_t>(image.size(), 1));
  return sum;
}

Result<cost::Subject> subjectOf(const ir::Module& module, const Options& options) {
  ShaderData data;
  data.id = "level";
  data.has_vertex = hasVertexStage(module);
  data.module = module;
  Options spirv = options;
  spirv.targets = {Target::Spirv};
  spirv.validate = false;
  spirv.debug = false;
  Wrong wrong;
  print(data, spirv, wrong);
  for (Diagnostics& of_target : wrong) {
    if (lacquer::hasError(of_target)) return tl::make_unexpected(std::move(of_target));
  }
  return cost::Subject{"level", std::move(data.spirv[0]), std::move(data.spirv[1])};
}

/// Of all that a material says, its name and its place in the file excepted.
void addMaterial(const material::Material& material, KeyBuilder& key) {
  const auto all = [&](const auto& numbers) {
    key.number(std::size(numbers));
    for (const auto x : numbers) key.number(x);
  };
  key.number(material.numbers.size()).number(material.textures.size());
  for (const material::Material::Number& number : material.numbers) {
    key.number(number.property);
    all(number.value);
  }
  for (const material::Material::Texture& texture : material.textures) {
    const gltf::TextureInfo& info = texture.info;
    key.number(texture.property).number(info.image).number(info.texCoord).text(info.group).text(info.output);
    all(info.channels), all(info.members), all(info.animated.members);
    const gltf::TextureTransform transform = info.transform.value_or(gltf::TextureTransform());
    key.number(info.transform.has_value()).number(transform.rotation);
    all(transform.offset), all(transform.scale);
    for (const bool moves : {info.animated.offset, info.animated.rotation, info.animated.scale})
      key.number(moves);
  }
  all(material.animated), all(material.extensions);
  key.text(material.patterns ? graph::toJson(*material.patterns) : std::string());
  key.text(material.closures).text(material.displacement).number(material.ports.size());
  for (const auto& [port, output] : material.ports) key.text(port).text(output);
}

Key codeOf(const cost::Subject& subject) {
  KeyBuilder key;
  for (const cost::Spirv* words : {&subject.vertex, &subject.fragment})
    key.text({reinterpret_cast<const char*>(words->data()), words->size() * sizeof(uint32_t)});
  return key.finish();
}

}  // namespace

LodMaterial::LodMaterial(const Given& given, uint32_t size)
    : given_(given),
      size_(size),
      radius_(preview::extentOf(given.mesh).value_or(preview::Extent{{}, given.radius}).radius),
      studios_(preview::comparisonStudios(radius_)),
      ball_(preview::ballOf(48, 22, radius_)) {}

Options LodMaterial::optionsOf(const lod::Words& words) const {
  Options options = given_.options;
  options.simplify.insert(options.simplify.end(), words.begin(), words.end());
  return options;
}

Result<graph::Graph> LodMaterial::graphOf(const lod::Words& words) const {
  Diagnostics warnings;
  Result<graph::Graph> graph =
      given_.subject.built(given_.attributes, given_.language, optionsOf(words), warnings);
  if (!graph) return graph;
  if (Diagnostics wrong =
          graph::check(*graph, given_.language, limitsOf(given_.options).value_or(Limits{}).nodes);
      lacquer::hasError(wrong))
    return tl::make_unexpected(std::move(wrong));
  return graph;
}

Result<ir::Module> LodMaterial::module(const lod::Words& words) const {
  const Result<graph::Graph> graph = graphOf(words);
  if (!graph) return tl::make_unexpected(graph.error());
  return toModule(*graph, given_.language, optionsOf(words), given_.lights);
}

Result<std::vector<preview::Shading>> LodMaterial::shadings(const lod::Words& words,
                                                            Messages& messages) const {
  EvalMaterial evaluated(given_.images, optionsOf(words));
  if (Result<void> set = evaluated.setTexels(given_.texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  if (Result<void> lowered = evaluated.lower(given_.subject, given_.language, true, "", messages); !lowered)
    return tl::make_unexpected(std::move(lowered.error()));
  evaluated.place({});
  preview::Look look;
  for (const ir::TextureSlot* slot : evaluated.environments()) {
    const bool specular = slot->name.find("irradiance") == std::string::npos;
    (specular ? look.specular : look.irradiance).push_back(slot->name);
  }
  const auto neutral = [](const ir::TextureSlot& slot, const Diagnostics&) { return neutralTexel(slot); };
  if (Result<void> bound = evaluated.bindTextures(neutral, look.textures); !bound)
    return tl::make_unexpected(std::move(bound.error()));
  look.module = evaluated.module();
  std::vector<preview::Shading> shadings;
  for (const preview::Studio& studio : studios_) {
    Result<preview::Shading> made = preview::Shading::make(look, studio);
    if (!made) return tl::make_unexpected(std::move(made.error()));
    shadings.push_back(std::move(*made));
  }
  return shadings;
}

bool atVertices(const lod::Words& words) {
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word.starts_with("vertex:"); });
}

Result<std::vector<preview::Shot>> LodMaterial::shots(const lod::Words& words, uint32_t size,
                                                      bool triangles) const {
  Messages said_before;
  const Result<std::vector<preview::Shading>> made = shadings(words, said_before);
  if (!made) return tl::make_unexpected(made.error());
  return shotsOf(*made, size, preview::gridOf(size), triangles);
}

const std::vector<preview::Coverage>& LodMaterial::coverages(const preview::Mesh& mesh, uint32_t size,
                                                             uint32_t grid) const {
  const auto [known, fresh] = coverages_.try_emplace({&mesh, size, grid});
  if (!fresh || mesh.triangles.empty()) return known->second;
  // Each studio sees the geometry from another side.
  constexpr double kTurns[] = {0.5, 2.4, -1.7};
  for (size_t i = 0; i < studios_.size(); ++i) {
    std::optional<preview::Coverage> seen =
        preview::coverageOf(mesh, kTurns[i % std::size(kTurns)], size, grid);
    if (!seen) return known->second = {}, known->second;
    known->second.push_back(std::move(*seen));
  }
  return known->second;
}

std::vector<preview::Shot> LodMaterial::shotsOf(const std::vector<preview::Shading>& shadings, uint32_t size,
                                                uint32_t grid, bool triangles) const {
  std::vector<preview::Shot> shots;
  const auto meshed = [&](const preview::Mesh& mesh) {
    const std::vector<preview::Coverage>& seen = coverages(mesh, size, grid);
    for (size_t i = 0; i < seen.size(); ++i) shots.push_back(preview::shoot(shadings[i], seen[i]));
  };
  if (triangles) {
    meshed(ball_);
  } else {
    for (const preview::Shading& shading : shadings)
      shots.push_back(preview::shoot(shading, radius_, size, grid));
  }
  meshed(given_.mesh);
  return shots;
}

void LodMaterial::compare(const std::vector<preview::Shot>& exact, const std::vector<preview::Shot>& simpler,
                          SeenDifference& seen, std::optional<SeenDifference>& on_mesh, bool flip) const {
  seen = preview::compareShots(exact, simpler, flip);
  on_mesh.reset();
  const auto balls = static_cast<ptrdiff_t>(studios_.size());
  if (std::ssize(exact) <= balls) return;
  const auto rest = [&](const std::vector<preview::Shot>& shots) {
    return std::vector<preview::Shot>(shots.begin() + balls, shots.end());
  };
  on_mesh = preview::compareShots(rest(exact), rest(simpler), flip);
}

Result<LevelFigures> LodMaterial::seen(const lod::Words& words, bool flip) {
  if (const auto known = memory_.seen(words, flip)) return known->figures;
  LevelFigures all = figures(words);
  const bool triangles = atVertices(words);
  const auto shot = shots(words, size_, triangles);
  if (!shot) return tl::make_unexpected(shot.error());
  compare(exact_[triangles], *shot, all.error, all.error_on_geometry, flip);
  memory_.keepSeen(words, flip, {ids_.at(words), all});
  return all;
}

/// Which textures have images, and what their means are.
void LodMaterial::readTextures(EvalMaterial& evaluated) {
  const auto absent = [&](const ir::TextureSlot& slot, const Diagnostics&) {
    absent_.insert(propertyOf(slot));
    return neutralTexel(slot);
  };
  eval::Bindings ignored;
  if (!evaluated.bindTextures(absent, ignored)) return;
  const Result<const material::Schema*> schema = given_.language.models.schema();
  if (!schema) return;
  for (const ir::TextureSlot& slot : evaluated.module().textures) {
    const auto bound = evaluated.textures().find(slot.name);
    if (slot.environment || bound == evaluated.textures().end() || absent_.contains(propertyOf(slot)))
      continue;
    const BoundTexture& texture = bound->second;
    Taken taken = takenOf(given_.subject.material(), **schema, slot);
    // A constant is linear where a format would decode.
    if (texture.constant) taken.by_format = false;
    const std::array<double, 4> mean =
        texture.constant ? texelOf(*texture.constant, taken) : meanOf(*texture.image, taken);
    means_.push_back(fmt::format("texel:{}={:.4g},{:.4g},{:.4g},{:.4g}", propertyOf(slot), mean[0], mean[1],
                                 mean[2], mean[3]));
  }
}

/// Everything that results depend on: the build, the material, its images, its geometry, the options, and who
/// counts cycles; nothing of the file's other materials.
Key LodMaterial::keyOf(const EvalMaterial& evaluated) const {
  KeyBuilder key;
  key.text("levels").key(given_.store->base).key(given_.file).text(given_.subject.pointer());
  if (given_.subject.material() != nullptr) addMaterial(*given_.subject.material(), key);
  const gltf::VertexAttributes& has = given_.attributes;
  for (const bool one : {has.normal, has.tangent, has.color0, has.skin[0], has.skin[1], has.morph,
                         has.instances, has.quantized})
    key.number(one);
  for (const bool one : has.texCoord) key.number(one);
  key.text(exact_graph_).text(shaderId(*exact_module_, given_.language));
  addOptions(given_.options, {Decides::Graph, Decides::Module}, key);
  for (const std::string& texel : given_.texels) key.text(texel);
  key.number(size_).number(radius_);
  const bool by_driver = !given_.options.programs_model && cost::unavailable().empty();
  key.number(by_driver).text(by_driver ? cost::driverIdentity() : std::string());
  for (const auto& [name, texture] : evaluated.textures()) {
    key.text(name).number(texture.constant.has_value());
    for (const double x : texture.constant.value_or(std::array<double, 4>())) key.number(x);
    if (texture.constant) continue;
    key.number(texture.lookup.s).number(texture.lookup.t);
    key.number(texture.lookup.nearest).number(texture.lookup.srgb);
    key.number(texture.image->width).number(texture.image->height).number(texture.image->layers);
    std::visit(
        [&](const auto& texels) {
          key.number(sizeof texels[0]);
          const auto* bytes = reinterpret_cast<const char*>(texels.data());
          key.key(lacquer::keyOf({bytes, texels.size() * sizeof texels[0]}));
        },
        texture.image->texels);
  }
  KeyBuilder mesh;
  for (const eval::Point& point : given_.mesh.vertices) {
    const auto all = [&](const auto& numbers) {
      for (const double x : numbers) mesh.number(x);
    };
    all(point.position), all(point.n), all(point.t), all(point.color0);
    for (const auto& uv : point.uv) all(uv);
  }
  for (const uint32_t corner : given_.mesh.triangles) mesh.number(corner);
  return key.key(mesh.finish()).number(given_.mesh.double_sided).finish();
}

Result<lod::Tried> LodMaterial::open(Messages& messages) {
  Result<graph::Graph> graph = graphOf({});
  if (!graph) return tl::make_unexpected(std::move(graph.error()));
  exact_graph_ = graph::toJson(*graph);
  Result<ir::Module> made = toModule(*graph, given_.language, given_.options, given_.lights);
  if (!made) return tl::make_unexpected(std::move(made.error()));
  exact_module_ = std::move(*made);
  if (!exact_module_->sums_lights)
    return fail("lod-template", {},
                fmt::format("the template '{}' shows nothing that is lit", exact_module_->template_name),
                "levels are compared by lit pictures, as the template `forward` makes them");
  EvalMaterial evaluated(given_.images, given_.options);
  if (Result<void> set = evaluated.setTexels(given_.texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  if (Result<void> lowered = evaluated.lower(given_.subject, given_.language, true, "", messages); !lowered)
    return tl::make_unexpected(std::move(lowered.error()));
  readTextures(evaluated);
  if (given_.store != nullptr) memory_ = lod::Memory(*given_.store, keyOf(evaluated));
  for (const bool triangles : {false, true}) {
    Result<std::vector<preview::Shot>> shot = shots({}, size_, triangles);
    if (!shot) return tl::make_unexpected(std::move(shot.error()));
    exact_[triangles] = std::move(*shot);
    Messages said_before;
    if (const auto of = shadings({}, said_before)) {
      small_[triangles] = shotsOf(*of, kSearched, kSearchedGrid, triangles);
      fit_[triangles] = shotsOf(*of, kFitted, kSearchedGrid, triangles);
    }
  }
  const std::vector<std::optional<lod::Tried>> measured = measure({{}});
  if (measured[0]) exact_vertex_ = figures({}).vertex_cycles;
  if (!measured[0]) return fail("cost-unknown", {}, "the material's own shader could not be measured");
  return *measured[0];
}

lod::Words LodMaterial::words() const {
  const Result<graph::Graph> graph = graphOf({});
  lod::Words all = graph ? possibleWords(*graph, given_.subject.material(), given_.language, given_.options)
                         : lod::Words();
  all.insert(all.end(), means_.begin(), means_.end());
  lod::Words good;
  std::set<std::string> seen{exact_graph_};
  for (const std::string& word : all) {
    // Without a picture of it nobody knows what a texture is worth.
    const std::string subject = lacquer::subjectOf(word);
    const bool unknown = subject.starts_with("texture:") && absent_.contains(subject.substr(8));
    if (unknown) continue;
    // What cannot go to the vertices alone may do so beside something else.
    if (word.starts_with("vertex:")) {
      good.push_back(word);
      continue;
    }
    const Result<graph::Graph> simpler = graphOf({word});
    if (simpler && seen.insert(graph::toJson(*simpler)).second) good.push_back(word);
  }
  return good;
}

double LodMaterial::costOf(const LevelFigures& figures) const {
  const uint64_t before = exact_vertex_.value_or(figures.vertex_cycles);
  const uint64_t more = figures.vertex_cycles - std::min(before, figures.vertex_cycles);
  return static_cast<double>(figures.cycles) + kVertexShare * static_cast<double>(more);
}

Result<std::vector<LevelFigures>> LodMaterial::costs(const std::vector<ir::Module>& modules, bool quarters) {
  std::vector<LevelFigures> figures(modules.size());
  if (given_.options.programs_model || !cost::unavailable().empty()) {
    for (size_t i = 0; i < modules.size(); ++i) {
      const lod::Estimate estimate = lod::estimate(modules[i]);
      figures[i].instructions = estimate.instructions;
      figures[i].cycles = estimate.cycles;
      figures[i].quarter_cycles = estimate.quarter_cycles;
      figures[i].vertex_cycles = estimate.vertex_cycles;
      figures[i].cost = costOf(figures[i]);
    }
    return figures;
  }
  // Sets that differ in what the preshader does to numbers have one code.
  std::vector<cost::Subject> subjects;
  std::vector<Key> codes, asked;
  for (const ir::Module& module : modules) {
    Result<cost::Subject> subject = subjectOf(module, given_.options);
    if (!subject) return tl::make_unexpected(std::move(subject.error()));
    codes.push_back(codeOf(*subject));
    const bool known = !quarters && (statistics_.contains(codes.back()) ||
                                     std::find(asked.begin(), asked.end(), codes.back()) != asked.end());
    if (known) continue;
    asked.push_back(codes.back());
    subjects.push_back(std::move(*subject));
  }
  const cost::Measurement measured = compiler_.measure(subjects, quarters);
  if (!measured.driver.empty()) driver_ = measured.driver;
  for (size_t i = 0; i < asked.size(); ++i) {
    const cost::Outcome& outcome = measured.outcomes[i];
    if (!outcome.statistics) return fail("cost-unknown", {}, "no cost: " + outcome.problem);
    statistics_.insert_or_assign(asked[i], *outcome.statistics);
    // With the disassembly all are asked for, in their order.
    if (quarters) figures[i].quarter_cycles = cost::quarterRateCycles(outcome.disassembly);
  }
  for (size_t i = 0; i < figures.size(); ++i) {
    const cost::Statistics& statistics = statistics_.at(codes[i]);
    figures[i].instructions = statistics.instructions;
    figures[i].cycles = statistics.inverse_throughput;
    if (quarters) figures[i].quarter_cycles += figures[i].cycles;
    figures[i].vertex_cycles = statistics.vertex_inverse_throughput;
    figures[i].cost = costOf(figures[i]);
  }
  return figures;
}

const std::string& LodMaterial::idOf(const lod::Words& words) {
  if (const auto measured = ids_.find(words); measured != ids_.end()) return measured->second;
  const auto [known, fresh] = shaders_.try_emplace(words);
  if (!fresh) return known->second;
  if (std::optional<std::string> kept = memory_.shader(words)) return known->second = std::move(*kept);
  if (const Result<ir::Module> made = module(words)) known->second = shaderId(*made, given_.language);
  memory_.keepShader(words, known->second);
  return known->second;
}

bool LodMaterial::same(const lod::Words& a, const lod::Words& b) {
  const std::string& id = idOf(a);
  return !id.empty() && id == idOf(b);
}

/// Whether an earlier run knows enough of a set.
bool LodMaterial::remembers(const lod::Words& set, double most) {
  std::optional<lod::Found> known = memory_.found(set);
  const bool drawn = known.has_value();
  if (!drawn) known = memory_.undrawn(set);
  if (!known || (!drawn && known->figures.cost <= most)) return false;
  ++remembered_;
  if (known->shader.empty()) return true;
  ids_[set] = known->shader;
  (drawn ? figures_ : undrawn_).emplace(known->shader, known->figures);
  return true;
}

/// A set's result once it was measured.
std::optional<lod::Tried> LodMaterial::triedOf(const lod::Words& set, double most, bool remembered) {
  const auto id = ids_.find(set);
  if (id == ids_.end()) return std::nullopt;
  const auto drawn = figures_.find(id->second);
  const auto undrawn = undrawn_.find(id->second);
  if (drawn == figures_.end() && undrawn == undrawn_.end()) return std::nullopt;
  const LevelFigures& figures = drawn == figures_.end() ? undrawn->second : drawn->second;
  if (!remembered) {
    if (drawn == figures_.end())
      memory_.keepUndrawn(set, {id->second, figures});
    else
      memory_.keep(set, {id->second, figures});
  }
  // A search that goes on where it was ended makes the same steps, whatever came after them.
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  return lod::Tried{set, figures.cost, figures.cost > most ? kUnknown : figures.error.delta_e};
}

std::vector<std::optional<lod::Tried>> LodMaterial::measure(const std::vector<lod::Words>& sets,
                                                            double most) {
  std::vector<ir::Module> fresh;
  std::vector<bool> remembered(sets.size(), false);
  std::vector<std::pair<std::string, const lod::Words*>> of_fresh;
  for (size_t i = 0; i < sets.size(); ++i) {
    const lod::Words& set = sets[i];
    remembered[i] = remembers(set, most);
    if (remembered[i]) continue;
    Result<ir::Module> made = module(set);
    if (!made || !lod::texturesWithin(*made, *exact_module_) || made->varyings.size() > kMostVaryings) {
      memory_.keep(set, {});
      continue;
    }
    std::string id = shaderId(*made, given_.language);
    const auto undrawn = undrawn_.find(id);
    const bool known =
        figures_.contains(id) || (undrawn != undrawn_.end() && undrawn->second.cost > most) ||
        std::any_of(of_fresh.begin(), of_fresh.end(), [&](const auto& one) { return one.first == id; });
    ids_[set] = id;
    if (known) continue;
    of_fresh.emplace_back(std::move(id), &set);
    fresh.push_back(std::move(*made));
  }
  draw(fresh, of_fresh, most);
  std::vector<std::optional<lod::Tried>> tried;
  for (size_t i = 0; i < sets.size(); ++i) tried.push_back(triedOf(sets[i], most, remembered[i]));
  return tried;
}

/// Costs of shaders, and pictures of those that cost no more than `most`.
void LodMaterial::draw(const std::vector<ir::Module>& fresh,
                       const std::vector<std::pair<std::string, const lod::Words*>>& of_fresh, double most) {
  // The driver compiles in a process of its own: what pictures need is made beside it. One core does that
  // later, and only for those that are drawn.
  const bool beside = given_.options.jobs != 1;
  std::future<Result<std::vector<LevelFigures>>> costing =
      std::async(beside ? kBeside : std::launch::deferred, [&] { return costs(fresh, false); });
  std::vector<LevelFigures> seen(fresh.size());
  std::vector<uint8_t> drawn(fresh.size(), 0);  // by several threads
  // Images are read by one thread; what is seen of the meshes is known from the exact shader's pictures.
  std::vector<std::optional<std::vector<preview::Shading>>> made(fresh.size());
  const auto prepare = [&](size_t i) {
    Messages said_before;
    if (auto one = shadings(*of_fresh[i].second, said_before)) made[i] = std::move(*one);
  };
  for (size_t i = 0; beside && i < fresh.size(); ++i) prepare(i);
  const Result<std::vector<LevelFigures>> costs = costing.get();
  if (!costs) return;
  for (size_t i = 0; !beside && i < fresh.size(); ++i) {
    if ((*costs)[i].cost <= most) prepare(i);
  }
  inParallel(fresh.size(), [&](size_t i) {
    if (!made[i] || (*costs)[i].cost > most) return;
    const bool triangles = atVertices(*of_fresh[i].second);
    const std::vector<preview::Shot> shot = shotsOf(*made[i], kSearched, kSearchedGrid, triangles);
    compare(small_[triangles], shot, seen[i].error, seen[i].error_on_geometry, false);
    made[i].reset();
    drawn[i] = 1;
  });
  for (size_t i = 0; i < fresh.size(); ++i) {
    if ((*costs)[i].cost > most) undrawn_.emplace(of_fresh[i].first, (*costs)[i]);
    if (drawn[i] == 0) continue;
    LevelFigures& figures = figures_.emplace(of_fresh[i].first, (*costs)[i]).first->second;
    figures.error = seen[i].error;
    figures.error_on_geometry = seen[i].error_on_geometry;
  }
}

// -- fitting --

/// Those that the simpler shader has, may be from 0 to 1, and are neither animated nor 0.
std::vector<LodMaterial::Parameter> LodMaterial::fittable(const lod::Words& words) const {
  constexpr size_t kMost = 8;
  std::vector<Parameter> all;
  const Result<ir::Module> made = module(words);
  if (!made) return all;
  for (const uint32_t index : ir::usedParameters(*made)) {
    const ir::Parameter& p = made->parameters[index];
    const bool unit = p.range.lo == 0 && p.range.hi == 1 && p.range.gap == 0;
    if (!unit || p.animated || p.type == ir::Type::Bool || p.type == ir::Type::Vec2) continue;
    const auto count = static_cast<size_t>(ir::componentCount(p.type));
    const std::vector<double> whole(p.value.begin(), p.value.begin() + static_cast<ptrdiff_t>(count));
    // Alpha is coverage, which stays as it is.
    for (size_t c = 0; c < std::min<size_t>(count, 3); ++c) {
      if (p.value[c] > 0 && all.size() < kMost) all.push_back({p.name, c, count, p.value[c], whole});
    }
  }
  return all;
}

/// Small pictures with some numbers times these.
std::optional<std::vector<preview::Shot>> LodMaterial::shotsWith(
    const std::vector<preview::Shading>& shadings, const std::vector<Parameter>& parameters,
    const std::vector<double>& scales, bool triangles) const {
  std::map<std::string, std::vector<double>> values;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    values.try_emplace(p.name, p.whole).first->second[p.component] = std::min(p.value * scales[i], 1.0);
  }
  std::vector<preview::Shading> made;
  for (const preview::Shading& shading : shadings) {
    Result<preview::Shading> one = shading.with(values);
    if (!one) return std::nullopt;
    made.push_back(std::move(*one));
  }
  return shotsOf(made, kFitted, kSearchedGrid, triangles);
}

namespace {

/// The colours of what the ball covers, in CIE L*a*b*, one after the other.
std::vector<double> labsOf(const std::vector<preview::Shot>& shots) {
  std::vector<double> labs;
  for (const preview::Shot& shot : shots) {
    for (const uint32_t pixel : shot.inside) {
      const picture::Color lab = picture::labOf(shot.pixels.colors[pixel]);
      labs.insert(labs.end(), lab.begin(), lab.end());
    }
  }
  return labs;
}

/// How wrong colours look, CIEDE2000, all together; the weights are such that squares of what they differ by,
/// times these, come to the same.
double differenceOf(const std::vector<double>& a, const std::vector<double>& b,
                    std::vector<double>& weights) {
  constexpr double kLeast = 0.01;  // what is nearly right already has no more weight
  double sum = 0;
  weights.resize(a.size() / 3);
  for (size_t i = 0; i < weights.size(); ++i) {
    const picture::Color one{a[3 * i], a[3 * i + 1], a[3 * i + 2]};
    const picture::Color other{b[3 * i], b[3 * i + 1], b[3 * i + 2]};
    const double seen = picture::deltaE2000(one, other);
    double squares = 0;
    for (size_t c = 0; c < 3; ++c) squares += (one[c] - other[c]) * (one[c] - other[c]);
    weights[i] = std::max(seen, kLeast) / std::max(squares, kLeast * kLeast);
    sum += seen;
  }
  return sum;
}

/// Solves a symmetric system by elimination; rows without a pivot give 0.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
  const size_t n = b.size();
  for (size_t i = 0; i < n; ++i) {
    if (std::abs(a[i][i]) < 1e-12) continue;
    for (size_t row = 0; row < n; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (size_t k = 0; k < n; ++k) a[row][k] -= factor * a[i][k];
      b[row] -= factor * b[i];
    }
  }
  for (size_t i = 0; i < n; ++i) b[i] = std::abs(a[i][i]) < 1e-12 ? 0 : b[i] / a[i][i];
  return b;
}

/// The step of Levenberg and Marquardt's least squares, of weighted colours.
std::vector<double> stepOf(const std::vector<std::vector<double>>& slopes, const std::vector<double>& now,
                           const std::vector<double>& wanted, const std::vector<double>& weights,
                           double damping) {
  const size_t n = slopes.size();
  std::vector<std::vector<double>> normal(n, std::vector<double>(n, 0.0));
  std::vector<double> right(n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      for (size_t k = 0; k < now.size(); ++k) normal[i][j] += weights[k / 3] * slopes[i][k] * slopes[j][k];
      normal[j][i] = normal[i][j];
    }
    for (size_t k = 0; k < now.size(); ++k) right[i] += weights[k / 3] * slopes[i][k] * (wanted[k] - now[k]);
    normal[i][i] *= 1 + damping;
  }
  return solved(normal, right);
}

/// Broyden's: makes slopes those that a step has shown, along it.
void learnSlopes(const std::vector<double>& step, const std::vector<double>& before,
                 const std::vector<double>& after, std::vector<std::vector<double>>& slopes) {
  double length = 0;
  for (const double x : step) length += x * x;
  if (!(length > 0)) return;
  for (size_t k = 0; k < before.size(); ++k) {
    double rest = after[k] - before[k];
    for (size_t i = 0; i < step.size(); ++i) rest -= slopes[i][k] * step[i];
    for (size_t i = 0; i < step.size(); ++i) slopes[i][k] += rest * step[i] / length;
  }
}

}  // namespace

/// What the words that scale numbers say of these; 1 where they say nothing.
std::vector<double> LodMaterial::scalesOf(const lod::Words& words, const std::vector<Parameter>& parameters) {
  std::vector<double> scales(parameters.size(), 1.0);
  const Result<Simplification> simpler = simplificationOf(words);
  for (size_t i = 0; simpler && i < parameters.size(); ++i) {
    const auto found = simpler->scales.find(parameters[i].name);
    if (found != simpler->scales.end() && found->second.size() == parameters[i].components)
      scales[i] = found->second[parameters[i].component];
  }
  return scales;
}

std::optional<lod::Words> LodMaterial::fitted(const lod::Words& words) const {
  if (std::optional<std::optional<lod::Words>> known = memory_.fitted(words)) return std::move(*known);
  std::optional<lod::Words> made = fit(words);
  memory_.keepFitted(words, made);
  return made;
}

/// Least squares over the pictures' colours. A picture for each number gives the slopes, which hold,
/// learning, for a few steps.
std::optional<lod::Words> LodMaterial::fit(const lod::Words& given) const {
  constexpr int kRounds = 2, kSteps = 3;
  constexpr double kStep = 0.02;
  constexpr double kLeast = 0.2;
  constexpr double kMost = 3;
  // Numbers that are fitted already are where this begins.
  lod::Words words = given;
  std::erase_if(words, [](const std::string& word) { return word.starts_with("scale:"); });
  const std::vector<Parameter> parameters = fittable(words);
  if (parameters.empty()) return std::nullopt;
  std::vector<double> scales = scalesOf(given, parameters);
  const bool triangles = atVertices(words);
  Messages ignored;
  const Result<std::vector<preview::Shading>> made = shadings(words, ignored);
  if (!made) return std::nullopt;
  const auto labsWith = [&](const std::vector<double>& with) -> std::vector<double> {
    const auto shots = shotsWith(*made, parameters, with, triangles);
    return shots ? labsOf(*shots) : std::vector<double>();
  };
  const std::vector<double> wanted = labsOf(fit_[triangles]);
  std::vector<double> now = labsWith(scales);
  if (now.size() != wanted.size()) return std::nullopt;
  std::vector<double> weights, weights_then;
  double error = differenceOf(now, wanted, weights);
  double damping = 1e-2;
  bool done = false;
  for (int round = 0; round < kRounds && !done; ++round) {
    std::vector<std::vector<double>> slopes;
    for (size_t i = 0; i < scales.size(); ++i) {
      std::vector<double> moved = scales;
      moved[i] *= parameters[i].value * scales[i] > 0.97 ? 1 - kStep : 1 + kStep;
      std::vector<double> slope = labsWith(moved);
      if (slope.size() != now.size()) return std::nullopt;
      for (size_t k = 0; k < slope.size(); ++k) slope[k] = (slope[k] - now[k]) / (moved[i] - scales[i]);
      slopes.push_back(std::move(slope));
    }
    for (int taken = 0; taken < kSteps && !done; ++taken) {
      std::vector<double> step = stepOf(slopes, now, wanted, weights, damping);
      std::vector<double> next = scales;
      for (size_t i = 0; i < next.size(); ++i) {
        next[i] = std::clamp(next[i] + step[i], kLeast, std::min(kMost, 1 / parameters[i].value));
        step[i] = next[i] - scales[i];
      }
      std::vector<double> then = labsWith(next);
      if (then.size() != now.size()) return std::nullopt;
      learnSlopes(step, now, then, slopes);
      const double with = differenceOf(then, wanted, weights_then);
      if (!(with < error)) {
        damping *= 10;
        continue;
      }
      done = with > 0.999 * error;
      scales = std::move(next);
      now = std::move(then);
      weights = weights_then;
      error = with;
      damping *= 0.3;
    }
  }
  lod::Words result = words;
  for (size_t i = 0; i < parameters.size();) {
    const size_t first = i;
    std::vector<double> by(parameters[first].components, 1.0);
    bool moved = false;
    for (; i < parameters.size() && parameters[i].name == parameters[first].name; ++i) {
      by[parameters[i].component] = scales[i];
      moved |= std::abs(scales[i] - 1) > 0.002;
    }
    if (!moved) continue;
    std::string numbers;
    for (const double x : by) numbers += fmt::format("{}{:.4g}", numbers.empty() ? "" : ",", x);
    result.push_back(fmt::format("scale:{}={}", parameters[first].name, numbers));
  }
  std::sort(result.begin(), result.end());
  if (result == given) return std::nullopt;
  return result;
}

}  // namespace lacquer
