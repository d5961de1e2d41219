#include "parity/subject.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../golden/random_material.h"
#include "../intervals/sampling.h"
#include "analysis/intervals.h"
#include "eval/dfg.h"
#include "eval/evaluate.h"
#include "eval/image.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "passes/rewrite.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::parity {

using ir::ValueId;

namespace {

/// Portable: the standard fixes this engine's numbers, but not its distributions'.
class Random {
public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  size_t below(size_t n) { return static_cast<size_t>(engine_() % n); }
  std::array<double, 3> direction() {
    const double z = between(-1, 1);
    const double angle = between(0, 6.283185307179586);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

private:
  std::mt19937_64 engine_;
};

double rounded(double x) { return static_cast<double>(static_cast<float>(x)); }

void roundAll(eval::Columns& columns) {
  for (auto& [name, column] : columns) {
    for (double& x : column.values) x = rounded(x);
  }
}

/// A texture of a slot: a small random image, or for a cube map a colour for each point.
void addTexture(Subject& subject, const ir::TextureSlot& slot, Random& random) {
  std::vector<vulkan::Texel> texels;
  vulkan::Texture texture = textureFor(slot.type);
  if (texture.shape == vulkan::Shape::Cube) {
    std::vector<vulkan::Texel> few(8);
    for (vulkan::Texel& texel : few) {
      for (float& x : texel) x = static_cast<float>(random.between(0, 2));
    }
    for (size_t i = 0; i < subject.points; ++i) texels.push_back(few[i / 16 % few.size()]);
  } else if (slot.environment && !slot.texel) {
    const eval::Image& table = *eval::environmentTable(slot.name);
    texture.width = static_cast<uint32_t>(table.width);
    texture.height = static_cast<uint32_t>(table.height);
    texture.s = texture.t = vulkan::Wrap::Clamp;
    texels = std::get<std::vector<vulkan::Texel>>(table.texels);
    subject.sizes[slot.name] = {static_cast<double>(table.width), static_cast<double>(table.height)};
  } else {
    // Tables of numbers hold one and are not filtered: random coordinates between random ones would say
    // nothing of what is made of them. Where they are looked up, tests/vertex tells.
    const bool table = texture.shape == vulkan::Shape::Array || texture.compares || slot.name == "joints";
    texture.width = table ? 1 : static_cast<uint32_t>(2 + random.below(6));
    texture.height = table ? 1 : static_cast<uint32_t>(2 + random.below(6));
    texture.s = static_cast<vulkan::Wrap>(random.below(3));
    texture.t = static_cast<vulkan::Wrap>(random.below(3));
    texture.nearest = random.below(4) != 0 || table;
    texels.resize(size_t{texture.width} * texture.height);
    for (vulkan::Texel& texel : texels) {
      for (float& x : texel) x = static_cast<float>(random.unit());
    }
    if (!table)
      subject.sizes[slot.name] = {static_cast<double>(texture.width), static_cast<double>(texture.height)};
  }
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(texels);
  if (texture.shape == vulkan::Shape::Cube) {
    subject.bindings.textures[slot.name] = [texels](size_t point, const std::array<double, 3>&, double) {
      const vulkan::Texel& t = texels[point];
      return std::array<double, 4>{t[0], t[1], t[2], t[3]};
    };
  } else {
    auto image = std::make_shared<eval::Image>();
    image->width = static_cast<int>(texture.width);
    image->height = static_cast<int>(texture.height);
    image->texels = texels;
    subject.bindings.textures[slot.name] = eval::makeSampler(
        image,
        {static_cast<eval::Wrap>(texture.s), static_cast<eval::Wrap>(texture.t), texture.nearest, false});
  }
  subject.textures[slot.name] = std::move(texture);
}

/// A value as floats of colours.
void addParts(ir::Dag& dag, ValueId value, std::vector<ValueId>& parts) {
  if (dag[value].type == ir::Type::Bool) {
    value = dag.make(ir::Op::Select, {value, dag.constant(1), dag.constant(0)});
  }
  if (const ir::Type type = dag[value].type; ir::isWhole(type)) {  // as halves, which a float holds
    const bool integer = type == ir::Type::Int;
    const ir::Op number = integer ? ir::Op::FromInt : ir::Op::FromUInt;
    const ValueId low = dag.make(ir::Op::BitAnd, {value, dag.constant(type, {65535})});
    const ValueId high = dag.make(integer ? ir::Op::IntShiftRight : ir::Op::UIntShiftRight,
                                  {value, dag.constant(ir::Type::UInt, {16})});
    parts.push_back(dag.make(number, {low}));
    parts.push_back(dag.make(number, {high}));
    return;
  }
  for (int c = 0; c < ir::componentCount(dag[value].type); ++c) parts.push_back(dag.component(value, c));
}

/// Makes the colours of a module from values, four numbers in each.
void setColors(ir::Module& module, std::span<const ValueId> values) {
  std::vector<ValueId> parts;
  for (const ValueId value : values) addParts(module.dag, value, parts);
  while (parts.size() % 4 != 0) parts.push_back(module.dag.constant(0));
  module.outputs.clear();
  for (uint32_t i = 0; 4 * i < parts.size(); ++i) {
    const ValueId color = module.dag.construct(
        ir::Type::Vec4, {parts[4 * i], parts[4 * i + 1], parts[4 * i + 2], parts[4 * i + 3]});
    module.outputs.push_back(
        {ir::OutputKind::Color, ir::Stage::Fragment, fmt::format("part_{}", i), i, color});
  }
}

ValueId argument(ir::Module& module, const lang::Param& param, std::vector<ir::Input>& inputs) {
  const std::string name(param.name);
  if (ir::isTexture(param.type)) {
    ir::TextureSlot slot;
    slot.name = name;
    slot.type = param.type;
    slot.environment = param.type == ir::Type::TextureCube;
    const auto index = static_cast<uint32_t>(module.textures.size());
    module.textures.push_back(slot);
    return module.dag.input({ir::InputKind::Texture, name, param.type, ir::Rate::Frame, {0, 1}, 0, index});
  }
  const bool flag = param.type == ir::Type::Bool;
  const auto index = static_cast<uint32_t>(module.varyings.size());
  const ir::Type type = flag ? ir::Type::Float : param.type;
  ir::Input input{ir::InputKind::Varying, name, type, ir::Rate::Fragment, param.range, 0, index};
  if (flag) input.range = {0, 1};
  module.varyings.push_back({name, type, index, ir::kNoValue});
  const ValueId value = module.dag.input(input);
  input.type = param.type;
  inputs.push_back(input);
  return flag ? module.dag.make(ir::Op::Less, {module.dag.constant(0.5), value}) : value;
}

}  // namespace

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

std::vector<ValueId> Subject::roots() const {
  std::vector<ValueId> values;
  for (uint32_t location = 0; location < module.outputs.size(); ++location) {
    for (const ir::Output& output : module.outputs) {
      if (output.kind == ir::OutputKind::Color && output.location == location) values.push_back(output.value);
    }
  }
  return values;
}

std::vector<Subject> inPasses(Subject subject) {
  constexpr size_t kMost = 8;
  std::vector<ir::Output> colors, others;
  for (const ir::Output& output : subject.module.outputs)
    (output.kind == ir::OutputKind::Color ? colors : others).push_back(output);
  std::sort(colors.begin(), colors.end(),
            [](const auto& a, const auto& b) { return a.location < b.location; });
  std::vector<Subject> passes;
  for (size_t first = 0; first == 0 || first < colors.size(); first += kMost) {
    Subject pass = subject;
    pass.module.outputs = others;
    for (size_t i = first; i < std::min(first + kMost, colors.size()); ++i) {
      colors[i].location = static_cast<uint32_t>(i - first);
      pass.module.outputs.push_back(colors[i]);
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

Subject nodeSubject(const lang::NodeDecl& node, std::string_view variant, size_t points) {
  Subject subject;
  subject.name = variant.empty() ? std::string(node.name) : fmt::format("{}.{}", node.name, variant);
  subject.points = points;
  ir::Module& module = subject.module;
  module.template_name = "node";
  std::vector<ir::Input> inputs;
  std::vector<ValueId> arguments;
  for (const lang::Param& param : node.params) arguments.push_back(argument(module, param, inputs));
  setColors(module, lower::Inliner(module.dag).call(node, variant, arguments));
  module.light_groups = {{0, 2}};  // of nodes that sum over lights: two that are alike
  for (size_t i = 0; i < points; ++i) {
    const test::World world(i, analysis::kSceneLimit);
    for (const ir::Input& input : inputs) {
      eval::Column& column = subject.bindings.columns[input.name];
      column.components = ir::componentCount(input.type);
      column.per_point = true;
      const test::Floats x = world.input(input);
      column.values.insert(column.values.end(), x.begin(), x.begin() + column.components);
    }
  }
  passes::runPipeline(module, {});
  EXPECT_TRUE(ir::verify(module).empty()) << subject.name << ": " << ir::verify(module)[0];
  Random random(1);
  for (const ir::TextureSlot& slot : module.textures) addTexture(subject, slot, random);
  return subject;
}

namespace {

/// Where an operation is defined and Vulkan promises something.
ir::Interval domainOf(ir::Op op, size_t operand) {
  using ir::Op;
  switch (op) {
    case Op::Sqrt:
    case Op::Length: return {0, 1e6};
    case Op::InverseSqrt:
    case Op::Log2:
    case Op::Log: return {1e-6, 1e6};
    case Op::Exp2:
    case Op::Exp: return {-20, 20};
    case Op::Sin:
    case Op::Cos: return {-3.14, 3.14};
    case Op::Acos: return {-1, 1};
    case Op::Pow: return operand == 0 ? ir::Interval{1e-3, 10} : ir::Interval{-4, 4};
    case Op::Div: return operand == 0 ? ir::Interval{-100, 100} : ir::Interval{0.01, 100};
    case Op::Mix: return operand == 2 ? ir::Interval{0, 1} : ir::Interval{-4, 4};
    case Op::Clamp:
      return operand == 0 ? ir::Interval{-4, 4} : operand == 1 ? ir::Interval{-2, 0} : ir::Interval{0, 2};
    case Op::Normalize: return {0.1, 4};
    default: return {-8, 8};
  }
}

const std::vector<ir::Type> kOperandTypes = {ir::Type::Float, ir::Type::Vec2, ir::Type::Vec3, ir::Type::Vec4,
                                             ir::Type::Bool,  ir::Type::Int,  ir::Type::UInt};

/// An integer of any 32 bits, out of two numbers of which each fills a half.
constexpr ir::Interval kHalves{-32768, 65535};

/// Every list of types that the operation takes.
std::vector<std::vector<ir::Type>> typesOf(ir::Op op) {
  std::vector<std::vector<ir::Type>> lists = {{}};
  for (int k = 0; k < ir::info(op).arity; ++k) {
    std::vector<std::vector<ir::Type>> longer;
    for (const std::vector<ir::Type>& list : lists) {
      for (const ir::Type type : kOperandTypes) {
        longer.push_back(list);
        longer.back().push_back(type);
      }
    }
    lists = std::move(longer);
  }
  std::erase_if(lists, [op](const auto& types) { return !ir::resultType(op, types); });
  return lists;
}

/// An operand of any type, out of a Vec4.
ValueId narrowed(ir::Dag& dag, ValueId whole, ir::Type type) {
  if (ir::isWhole(type)) {
    const ValueId high = dag.make(ir::Op::ToInt, {dag.component(whole, 0)});
    const ValueId low = dag.make(ir::Op::ToInt, {dag.component(whole, 1)});
    const ValueId both = dag.make(
        ir::Op::BitXor, {dag.make(ir::Op::ShiftLeft, {high, dag.constant(ir::Type::UInt, {16})}), low});
    return type == ir::Type::Int ? both : dag.make(ir::Op::AsUInt, {both});
  }
  if (type == ir::Type::Bool) return dag.make(ir::Op::Less, {dag.constant(0.5), dag.component(whole, 0)});
  std::vector<int> components;
  for (int c = 0; c < ir::componentCount(type); ++c) components.push_back(c);
  return dag.swizzle(whole, components);
}

/// An operation with some of its lists of types: operands in four components each, a random number of them
/// whole, so that comparisons meet equal operands, or an end of the domain.
Subject operationSubject(ir::Op op, std::span<const std::vector<ir::Type>> lists, size_t points) {
  Subject subject;
  subject.name = fmt::format("{} of {}", ir::info(op).name, ir::typeName(lists[0][0]));
  subject.single = true;
  subject.points = points;
  ir::Module& module = subject.module;
  module.template_name = "operation";
  Random random(1);
  std::vector<ValueId> operands;
  for (uint32_t k = 0; k < lists[0].size(); ++k) {
    const std::string name = fmt::format("operand_{}", k);
    const ir::Type type = lists[0][k];
    const ir::Interval domain = type == ir::Type::Bool ? ir::Interval{0, 1}
                                : ir::isWhole(type)    ? kHalves
                                                       : domainOf(op, k);
    module.varyings.push_back({name, ir::Type::Vec4, k, ir::kNoValue});
    operands.push_back(
        module.dag.input({ir::InputKind::Varying, name, ir::Type::Vec4, ir::Rate::Fragment, domain, 0, k}));
    std::vector<double> values;
    for (size_t i = 0; i < 4 * points; ++i) {
      const double any = random.between(domain.lo, domain.hi);
      const double end = random.below(2) == 0 ? domain.lo : domain.hi;
      const double whole = std::clamp(std::round(any), domain.lo, domain.hi);
      const size_t kind = random.below(8);
      values.push_back(rounded(kind == 0 ? end : kind < 3 ? whole : any));
    }
    subject.bindings.columns[name] = eval::Column::perPoint(4, std::move(values));
  }
  std::vector<ValueId> results;
  for (const std::vector<ir::Type>& types : lists) {
    std::vector<ValueId> narrow;
    for (size_t k = 0; k < types.size(); ++k) narrow.push_back(narrowed(module.dag, operands[k], types[k]));
    if (op == ir::Op::IntDiv || op == ir::Op::UIntDiv) {  // by 0 and by -1 nothing is promised
      narrow[1] = module.dag.make(ir::Op::BitOr, {narrow[1], module.dag.constant(types[1], {1})});
      narrow[1] = module.dag.make(ir::Op::BitAnd, {narrow[1], module.dag.constant(types[1], {0x7fffffff})});
    }
    results.push_back(module.dag.make(op, narrow));
  }
  setColors(module, results);
  passes::runPipeline(module, {});
  EXPECT_TRUE(ir::verify(module).empty()) << subject.name << ": " << ir::verify(module)[0];
  return subject;
}

}  // namespace

std::vector<Subject> operationSubjects(size_t points) {
  constexpr size_t kTogether = 4;  // lists of types: at most four colours, which any device has
  std::vector<Subject> subjects;
  for (int index = 0; index < ir::kOpCount; ++index) {
    const auto op = static_cast<ir::Op>(index);
    const bool special = ir::info(op).signature == ir::Signature::Special;
    if (special || op == ir::Op::SumOverLights || op == ir::Op::Interpolate) continue;
    const std::vector<std::vector<ir::Type>> lists = typesOf(op);
    EXPECT_FALSE(lists.empty()) << ir::info(op).name;
    for (size_t i = 0; i < lists.size(); i += kTogether) {
      const size_t count = std::min(kTogether, lists.size() - i);
      subjects.push_back(operationSubject(op, std::span(lists).subspan(i, count), points));
    }
  }
  return subjects;
}

namespace {

/// Appends the materials of a document that have no errors.
void addGraphs(const material::Document& document, const std::string& name, const MaterialSetting& setting,
               std::vector<NamedGraph>& graphs) {
  for (const material::Material& material : document.materials) {
    test::BuildSetup options;
    options.template_name = setting.template_name;
    options.decode_srgb = setting.decode_srgb;
    options.switches = setting.switches;
    Diagnostics warnings;
    NamedGraph made{fmt::format("{}, {}, {}", name, material.name, setting.template_name),
                    test::buildGraph(material, {true, setting.tangents, true, {true, true, true, true}},
                                     options, warnings)};
    EXPECT_FALSE(hasError(material.diagnostics)) << made.name;
    EXPECT_FALSE(hasError(graph::check(made.graph, library()))) << made.name;
    graphs.push_back(std::move(made));
  }
}

}  // namespace

std::vector<NamedGraph> exampleGraphs(const MaterialSetting& setting) {
  std::vector<NamedGraph> graphs;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "examples")) {
    if (entry.path().extension() == ".gltf") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    const Result<material::Document> document = test::readMaterials(file.string());
    EXPECT_TRUE(document) << file;
    if (document) addGraphs(*document, file.stem().string(), setting, graphs);
  }
  return graphs;
}

std::vector<NamedGraph> randomGraphs(const MaterialSetting& setting, uint64_t files) {
  std::vector<NamedGraph> graphs;
  for (uint64_t seed = 1; seed <= files; ++seed) {
    const std::string text = test::RandomMaterial(seed).valid(4).dump();
    const Result<material::Document> document = test::materialsOf(text, "random.gltf");
    EXPECT_TRUE(document) << text;
    if (document) addGraphs(*document, fmt::format("seed {}", seed), setting, graphs);
  }
  return graphs;
}

namespace {

eval::Point randomPoint(Random& random, size_t i) {
  eval::Point p;
  p.n = random.direction();
  p.v = random.direction();
  p.l = random.direction();
  // Most are in front of the surface; some are equal, opposite or just about grazing.
  const auto facing = [&](std::array<double, 3>& d) {
    const double along = d[0] * p.n[0] + d[1] * p.n[1] + d[2] * p.n[2];
    for (size_t c = 0; along < 0 && c < 3; ++c) d[c] = -d[c];
  };
  const auto graze = [&](std::array<double, 3>& d) {
    const double along = d[0] * p.n[0] + d[1] * p.n[1] + d[2] * p.n[2];
    double length = 0;
    for (size_t c = 0; c < 3; ++c) d[c] -= along * p.n[c];
    for (const double x : d) length += x * x;
    const double raised = std::exp2(-20 * random.unit());
    for (size_t c = 0; c < 3; ++c)
      d[c] = d[c] / std::sqrt(length) * std::sqrt(1 - raised * raised) + raised * p.n[c];
  };
  if (i % 8 != 0) facing(p.v), facing(p.l);
  if (i % 16 == 1) p.v = p.n;
  if (i % 16 == 2) p.l = p.v;
  if (i % 16 == 3) p.l = p.v = p.n;
  if (i % 16 == 4) graze(p.v);
  if (i % 16 == 5) graze(p.l);
  const std::array<double, 3> across = random.direction();
  const double along = across[0] * p.n[0] + across[1] * p.n[1] + across[2] * p.n[2];
  for (size_t c = 0; c < 3; ++c) p.t[c] = across[c] - along * p.n[c];
  p.t[3] = random.below(2) == 0 ? 1 : -1;
  for (auto& uv : p.uv) uv = {random.between(-2, 2), random.between(-2, 2)};
  for (double& x : p.color0) x = random.below(8) == 0 ? std::round(random.unit()) : random.unit();
  for (double& x : p.light) x = random.between(0, 4);
  for (double& x : p.position) x = random.between(-2, 2);
  p.front_facing = random.below(4) != 0;
  return p;
}

/// Makes four equal points a quad: steps of whole 64ths, which a triangle's plane equations keep exactly. The
/// eye stays where it is.
void spread(std::span<eval::Point> quad, Random& random) {
  const auto step = [&] { return std::round(random.between(-16, 16)) / 64; };
  const auto affine = [&](auto&& number) {
    const double first = std::round(number(quad[0]) * 64) / 64;
    const double x = step();
    const double y = step();
    for (size_t k = 0; k < 4; ++k) number(quad[k]) = first + (k % 2 == 0 ? 0 : x) + (k / 2 == 0 ? 0 : y);
  };
  std::array<double, 3> eye{};
  for (size_t c = 0; c < 3; ++c) {
    eye[c] = rounded(quad[0].position[c] + quad[0].v[c]);
    affine([c](eval::Point& p) -> double& { return p.position[c]; });
  }
  for (eval::Point& p : quad) {
    for (size_t c = 0; c < 3; ++c) p.v[c] = eye[c] - p.position[c];
  }
  for (size_t set = 0; set < 4; ++set) {
    for (size_t c = 0; c < 2; ++c) affine([set, c](eval::Point& p) -> double& { return p.uv[set][c]; });
  }
}

/// A point light and a spot beside the directional one.
void addLights(eval::Bindings& bindings, size_t points, Random& random) {
  for (const bool spot : {false, true}) {
    eval::Columns light = bindings.lights[0];
    std::vector<double> positions;
    for (size_t i = 0; i < 3 * points; ++i) positions.push_back(random.between(-4, 4));
    light["light.position"] = eval::Column::perPoint(3, std::move(positions));
    light["light.positional"] = eval::Column::constant({1});
    light["light.inverse_range_4"] = eval::Column::constant({spot ? 0.0 : 1e-4});
    if (spot) {
      light["light.direction"] = eval::Column::constant({0.6, 0, -0.8});
      light["light.spot_scale"] = eval::Column::constant({2.5});
      light["light.spot_offset"] = eval::Column::constant({0.25});
    }
    bindings.lights.push_back(std::move(light));
  }
  bindings.columns["frame.light_count"] = eval::Column::constant({3});
}

/// A rectangle and a disc, beside the other lights or in their place.
void addAreas(const ir::Module& module, eval::Bindings& bindings, size_t points, Random& random, bool alone) {
  if (alone) bindings.lights.clear();
  for (const char* kind : {"rect", "disk"}) {
    std::vector<double> positions;
    for (size_t i = 0; i < 3 * points; ++i) positions.push_back(random.between(-4, 4));
    bindings.lights.push_back(eval::lightOf(module, kind,
                                            {{"position", eval::Column::perPoint(3, std::move(positions))},
                                             {"right", eval::Column::constant({0.6, 0, 0.8})},
                                             {"up", eval::Column::constant({0.48, 0.8, -0.36})},
                                             {"color", eval::Column::constant({1, 0.5, 0.25})},
                                             {"intensity", eval::Column::constant({3})},
                                             {"size", eval::Column::constant({2})},
                                             {"aspect", eval::Column::constant({1.5})}},
                                            points));
  }
  bindings.columns["frame.light_count"] =
      eval::Column::constant({static_cast<double>(bindings.lights.size())});
}

}  // namespace

Subject materialSubject(const NamedGraph& graph, const MaterialSetting& setting, size_t points,
                        uint64_t seed) {
  Subject subject;
  subject.name = graph.name;
  subject.points = points;
  Result<ir::Module> module = lower::lower(graph.graph, library(), {setting.parameters, true});
  EXPECT_TRUE(module) << graph.name;
  if (!module) return subject;
  subject.module = std::move(*module);
  passes::runPipeline(subject.module, {setting.lights, {}});
  Random random(seed);
  std::vector<eval::Point> list;
  for (size_t i = 0; i < points; ++i) {
    list.push_back(setting.quads && i % 4 != 0 ? list.back() : randomPoint(random, i));
    if (setting.quads && i % 4 == 3) spread({list.data() + i - 3, 4}, random);
  }
  eval::Bindings& bindings = subject.bindings;
  eval::bindPoints(subject.module, list, bindings);
  bindings.quads = setting.quads;
  bindings.columns["frame.environment_intensity"] = eval::Column::constant({1.25});
  if (setting.lights.any) addLights(bindings, points, random);
  if (setting.template_name == "forward_area")
    addAreas(subject.module, bindings, points, random, !setting.lights.any);
  roundAll(bindings.columns);
  for (eval::Columns& light : bindings.lights) roundAll(light);
  for (const ir::TextureSlot& slot : subject.module.textures) addTexture(subject, slot, random);
  EXPECT_TRUE(eval::bindMaterialBlock(subject.module, bindings)) << graph.name;
  EXPECT_TRUE(eval::bindVaryings<float>(subject.module, points, bindings)) << graph.name;
  return subject;
}

Subject vertexSubject(const NamedGraph& graph, const MaterialSetting& setting, size_t points, uint64_t seed) {
  Subject subject = materialSubject(graph, setting, points, seed);
  subject.name += ", vertex stage";
  ir::Module& module = subject.module;
  std::vector<ValueId> values;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Position) values.push_back(output.value);
  }
  for (const ir::Varying& varying : module.varyings) values.push_back(varying.source);
  setColors(module, values);
  module.preshader.clear();
  module.varyings.clear();
  for (const ir::Attribute& attribute : module.attributes) {
    module.varyings.push_back({attribute.name, attribute.type, attribute.location, ir::kNoValue});
  }
  passes::Rewriter(module).run([](passes::Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    if (r.dag()[id].op != ir::Op::Input) return r.copy(id, operands);
    ir::Input input = r.dag().inputOf(id);
    if (input.kind == ir::InputKind::Attribute) {
      input.kind = ir::InputKind::Varying;
      input.rate = ir::Rate::Fragment;
    }
    return r.dag().input(input);
  });
  passes::bind(module);
  EXPECT_TRUE(ir::verify(module).empty()) << subject.name << ": " << ir::verify(module)[0];
  Random random(seed);
  for (const char* name : {"object.model", "object.normal_matrix", "frame.view_projection"}) {
    std::vector<double> matrix;
    for (int i = 0; i < 16; ++i) matrix.push_back(rounded(random.between(-2, 2)));
    subject.bindings.columns[name] = eval::Column::constant(std::move(matrix));
  }
  return subject;
}

const vulkan::Device* device() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

std::vector<std::vector<float>> onCpu(const Subject& subject) {
  const auto values =
      eval::evaluate<float>(subject.module, subject.roots(), subject.bindings, subject.points);
  EXPECT_TRUE(values) << subject.name << ": " << (values ? "" : format(values.error()[0]));
  return values.value_or(std::vector<std::vector<float>>{});
}

std::vector<std::vector<float>> onDevice(const Subject& subject, FragmentRoute route) {
  const Result<vulkan::Work> work =
      gpuWork(subject.module, subject.bindings, subject.textures, subject.points, route);
  EXPECT_TRUE(work) << subject.name << ": " << (work ? "" : format(work.error()[0]));
  if (!work) return {};
  Result<vulkan::Outcome> outcome = device()->run(*work);
  EXPECT_TRUE(outcome) << subject.name << ": " << (outcome ? "" : format(outcome.error()[0]));
  if (!outcome) return {};
  // A discarded fragment has no colour: it counts as what the CPU says.
  const std::vector<std::vector<float>> cpu = onCpu(subject);
  for (size_t i = 0; i < subject.points; ++i) {
    for (size_t o = 0; o < cpu.size() && outcome->discarded[i]; ++o) {
      std::copy_n(cpu[o].begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                  outcome->outputs[o].begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
  }
  return std::move(outcome->outputs);
}

bool endless(const analysis::Range& bound) { return !std::isfinite(bound.lo) || !std::isfinite(bound.hi); }

bool vague(const analysis::Range& bound) {
  const double scale = std::max(std::abs(bound.lo), std::abs(bound.hi));
  return !(bound.hi - bound.lo <= std::max(1e-3 * scale, 1e-6));
}

void compare(const Subject& subject, const std::vector<std::vector<analysis::Range>>& bounds,
             const std::vector<std::vector<float>>& outputs, std::string_view engine,
             Comparison& comparison) {
  if (outputs.empty()) return;  // it did not run, and has failed for that
  for (size_t i = 0; i < bounds.size(); ++i) {
    for (size_t k = 0; k < bounds[i].size(); ++k) {
      const analysis::Range& bound = bounds[i][k];
      const auto x = static_cast<double>(outputs[k / 4][4 * i + k % 4]);
      ++comparison.numbers;
      if (endless(bound))
        ++comparison.endless;
      else if (vague(bound))
        ++comparison.vague;
      if (std::isnan(x) ? bound.nan : bound.contains(x)) continue;
      if (comparison.outside++ > 0) continue;
      comparison.first =
          fmt::format("{}: {} gives {:.9g} at point {}, number {}, which must be in [{:.9g}, {:.9g}]",
                      subject.name, engine, x, i, k, bound.lo, bound.hi);
    }
  }
}

std::vector<std::vector<analysis::Range>> boundsOf(const Subject& subject, bool rounded_parameters) {
  EnclosureOptions options;
  if (device() != nullptr) options.sub_texel_bits = device()->subTexelBits();
  options.rounded_parameters = rounded_parameters;
  options.regrouped = !subject.single;
  Enclosure enclosure(subject.module, subject.bindings, subject.sizes, options);
  const std::vector<ValueId> roots = subject.roots();
  std::vector<std::vector<analysis::Range>> bounds;
  for (size_t i = 0; i < subject.points; ++i) bounds.push_back(enclosure.at(i, roots));
  return bounds;
}

Comparison compareEngines(const Subject& subject) {
  const auto bounds = boundsOf(subject);
  Comparison comparison;
  compare(subject, bounds, onCpu(subject), "the CPU", comparison);
  compare(subject, bounds, onDevice(subject, FragmentRoute::Direct), "the direct SPIR-V", comparison);
  compare(subject, bounds, onDevice(subject, FragmentRoute::Glsl), "the GLSL", comparison);
  compare(subject, bounds, onDevice(subject, FragmentRoute::Hlsl), "the HLSL", comparison);
  return comparison;
}

}  // namespace lacquer::parity
