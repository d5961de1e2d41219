#include "stress/on_device.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/dfg.h"
#include "passes/passes.h"
#include "passes/pipeline.h"
#include "passes/rewrite.h"

namespace lacquer {

namespace {

using ir::ValueId;
using stress::Shown;
using stress::Subject;

/// Where a root's numbers lie among the colours.
struct At {
  size_t root = 0;
  size_t first = 0;  ///< number of the first component, four for each colour
  size_t components = 0;
  ir::Type whole =
      ir::Type::Float;  ///< Int or UInt where each of the root's numbers is two: its upper and its lower half
};

/// A float holds 24 bits exactly: integers go in and come out as two halves.
constexpr uint32_t kHalfBits = 16, kHalfLast = 0xffff;
/// The halves of two numbers from that one on.
std::string halvesName(std::string_view name, int first) { return fmt::format("{}_halves_{}", name, first); }
std::string columnName(std::string_view name, int index) { return fmt::format("{}_column_{}", name, index); }
/// Of a square matrix.
int columnCount(ir::Type matrix) { return ir::componentCount(ir::partType(matrix)); }

/// A subject's module with results for colours.
struct Ready {
  ir::Module module;
  std::vector<At> places;
};

/// A fragment's input of floats.
ValueId varyingOf(passes::Rewriter& r, const std::string& name, ir::Type type, const ir::Interval& range) {
  const auto known = std::find_if(r.module().varyings.begin(), r.module().varyings.end(),
                                  [&](const ir::Varying& varying) { return varying.name == name; });
  const auto location = static_cast<uint32_t>(known - r.module().varyings.begin());
  if (known == r.module().varyings.end()) r.module().varyings.push_back({name, type, location, ir::kNoValue});
  return r.dag().input({ir::InputKind::Varying, name, type, ir::Rate::Fragment, range, 0, location});
}

/// An integer of two halves.
ValueId wholeOf(ir::Dag& dag, ValueId upper, ValueId lower, ir::Type type) {
  const ValueId high = dag.make(ir::Op::ToUInt, {upper});
  const ValueId low = dag.make(ir::Op::ToUInt, {lower});
  const ValueId bits = dag.uinteger(kHalfBits);
  const ValueId shifted = dag.make(ir::Op::ShiftLeft, {high, bits});
  const ValueId both = dag.make(ir::Op::BitOr, {shifted, low});
  return type == ir::Type::Int ? dag.make(ir::Op::AsInt, {both}) : both;
}

/// A parameter as a fragment's inputs.
ValueId parameterOf(passes::Rewriter& r, const ir::Input& input) {
  ir::Dag& dag = r.dag();
  std::vector<ValueId> parts;
  const int n = ir::componentCount(input.type);
  if (ir::isMatrix(input.type)) {
    for (int i = 0; i < columnCount(input.type); ++i)
      parts.push_back(varyingOf(r, columnName(input.name, i), ir::partType(input.type), input.range));
    return dag.construct(input.type, parts);
  }
  const ir::Type part = ir::partType(input.type);
  if (ir::isWhole(part)) {
    // One and two are side by side: devices take so many inputs.
    std::vector<ValueId> halves;
    for (int first = 0; first < n; first += 2) {
      const int numbers = std::min(2, n - first);
      const ValueId both =
          varyingOf(r, halvesName(input.name, first), ir::floatType(2 * numbers), {0, kHalfLast});
      for (int c = 0; c < 2 * numbers; ++c) halves.push_back(dag.component(both, c));
    }
    for (size_t c = 0; c < halves.size(); c += 2)
      parts.push_back(wholeOf(dag, halves[c], halves[c + 1], part));
  } else if (part == ir::Type::Bool) {
    const ValueId value = varyingOf(r, input.name, ir::floatType(n), {0, 1});
    const ValueId half = dag.constant(0.5);
    for (int c = 0; c < n; ++c) {
      const ValueId component = dag.component(value, c);
      parts.push_back(dag.make(ir::Op::Less, {half, component}));
    }
  } else {
    return varyingOf(r, input.name, input.type, input.range);
  }
  return n == 1 ? parts[0] : dag.construct(input.type, parts);
}

/// Adds a value's numbers, as floats.
void addNumbers(ir::Dag& dag, ValueId value, std::vector<ValueId>& to) {
  const ir::Type type = dag[value].type;
  if (ir::isMatrix(type)) {
    for (int i = 0; i < columnCount(type); ++i)
      addNumbers(dag, dag.column(value, static_cast<uint32_t>(i)), to);
    return;
  }
  for (int c = 0; c < ir::componentCount(type); ++c) {
    ValueId part = dag.component(value, c);
    if (ir::isWhole(ir::partType(type))) {
      if (dag[part].type == ir::Type::Int) part = dag.make(ir::Op::AsUInt, {part});
      const ValueId bits = dag.uinteger(kHalfBits);
      const ValueId mask = dag.uinteger(kHalfLast);
      const ValueId upper = dag.make(ir::Op::UIntShiftRight, {part, bits});
      const ValueId lower = dag.make(ir::Op::BitAnd, {part, mask});
      to.push_back(dag.make(ir::Op::FromUInt, {upper}));
      part = dag.make(ir::Op::FromUInt, {lower});
    } else if (dag[part].type == ir::Type::Bool) {
      const ValueId one = dag.constant(1);
      const ValueId zero = dag.constant(0);
      part = dag.make(ir::Op::Select, {part, one, zero});
    }
    to.push_back(part);
  }
}

/// A device writes so many numbers at least, four in each of eight colours.
constexpr size_t kMostNumbers = 32;

/// How many floats a value's numbers are for addNumbers().
size_t floatsOf(ir::Type type) {
  return static_cast<size_t>(ir::componentCount(type)) * (ir::isWhole(ir::partType(type)) ? 2 : 1);
}

/// From a result on, those that one run can put out: behind the last one.
size_t lastOfRun(const ir::Module& module, size_t first) {
  size_t numbers = 0, r = first;
  for (; r < module.outputs.size(); ++r) {
    numbers += floatsOf(module.dag[module.outputs[r].value].type);
    if (numbers > kMostNumbers) break;
  }
  return r;
}

/// The numbers of the results from `first` to before `last`, four in a colour.
void setColors(Ready& ready, size_t first_result, size_t last_result) {
  ir::Dag& dag = ready.module.dag;
  std::vector<ValueId> parts;
  for (size_t r = first_result; r < last_result; ++r) {
    const ValueId value = ready.module.outputs[r].value;
    const ir::Type part = ir::partType(dag[value].type);
    const size_t first = parts.size();
    addNumbers(dag, value, parts);
    ready.places.push_back({r, first, parts.size() - first, ir::isWhole(part) ? part : ir::Type::Float});
  }
  while (parts.size() % 4 != 0) parts.push_back(dag.constant(0));
  ready.module.outputs.clear();
  for (uint32_t i = 0; 4 * i < parts.size(); ++i) {
    const ValueId color =
        dag.construct(ir::Type::Vec4, {parts[4 * i], parts[4 * i + 1], parts[4 * i + 2], parts[4 * i + 3]});
    ready.module.outputs.push_back(
        {ir::OutputKind::Color, ir::Stage::Fragment, fmt::format("part_{}", i), i, color});
  }
}

/// A node by itself: its parameters are the fragment's inputs. Of its results those from `first` to before
/// `last`.
Ready readyNode(const Subject& subject, size_t first, size_t last) {
  Ready ready{subject.module(), {}};
  ready.module.template_name = "node";
  passes::Rewriter(ready.module).run([](passes::Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    if (r.dag()[id].op != ir::Op::Input) return r.copy(id, operands);
    const ir::Input input = r.dag().inputOf(id);
    const bool stays = input.kind == ir::InputKind::Texture || ir::ofLoop(input.kind);
    return stays ? r.copy(id, operands) : parameterOf(r, input);
  });
  ready.module.parameters.clear();
  setColors(ready, first, last);
  passes::runPipeline(ready.module, {});
  return ready;
}

/// All results of a node, in as many runs as it takes.
std::vector<Ready> readyNodes(const Subject& subject) {
  std::vector<Ready> runs;
  for (size_t first = 0; first < subject.module().outputs.size();) {
    const size_t last = lastOfRun(subject.module(), first);
    runs.push_back(readyNode(subject, first, last));
    first = last;
  }
  return runs;
}

Ready readyMaterial(const Subject& subject) {
  Ready ready{subject.module(), {}};
  for (size_t r = 0; r < subject.roots.size(); ++r) {
    for (const ir::Output& output : ready.module.outputs) {
      if (output.kind == ir::OutputKind::Color && subject.roots[r].kind == stress::Root::Kind::Result &&
          output.name == subject.roots[r].name)
        ready.places.push_back(
            {r, size_t{4} * output.location, static_cast<size_t>(subject.roots[r].components)});
    }
  }
  return ready;
}

vulkan::Texture tableOf(const eval::Image& table) {
  vulkan::Texture texture;
  texture.width = static_cast<uint32_t>(table.width);
  texture.height = static_cast<uint32_t>(table.height);
  texture.s = texture.t = vulkan::Wrap::Clamp;
  std::vector<vulkan::Texel> texels(table.size());
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = table.at(i);
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
  return texture;
}

/// One texel for each point: what the samples say.
vulkan::Texture textureOf(const Subject& subject, const ir::TextureSlot& slot,
                          std::span<const double> samples, size_t count) {
  const stress::Variable& variable = *subject.space.texel(slot.name);
  std::vector<vulkan::Texel> texels;
  texels.reserve(count * subject.lanes);
  for (size_t i = 0; i < count; ++i) {
    const double* from = samples.data() + i * subject.space.width() + variable.first;
    vulkan::Texel texel{0, 0, 0, 1};
    for (int c = 0; c < variable.components; ++c) texel[static_cast<size_t>(c)] = static_cast<float>(from[c]);
    texels.insert(texels.end(), subject.lanes, texel);
  }
  vulkan::Texture texture = textureFor(slot.type);
  texture.nearest = true;
  texture.per_point = true;
  texture.s = texture.t = vulkan::Wrap::Clamp;  // coordinates may be anything
  texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(std::move(texels));
  return texture;
}

GpuTextures texturesOf(const Subject& subject, const ir::Module& module, std::span<const double> samples,
                       size_t count) {
  GpuTextures textures;
  for (size_t i = 0; i < module.textures.size(); ++i) {
    // The passes may have given it another name.
    const ir::TextureSlot& slot = subject.module().textures[i];
    const bool given = subject.space.texel(slot.name) != nullptr;
    textures[module.textures[i].name] =
        given ? textureOf(subject, slot, samples, count) : tableOf(*eval::environmentTable(slot.name));
  }
  return textures;
}

/// Adds what the shader has of a parameter that it cannot have as it is.
void addParts(const ir::Parameter& parameter, eval::Columns& columns) {
  const auto found = columns.find(parameter.name);
  if (found == columns.end()) return;
  const eval::Column whole = found->second;
  const auto with = [&](int components, const auto& number) {
    eval::Column made{components, whole.per_point, {}};
    const auto all = static_cast<size_t>(whole.components);
    for (size_t point = 0; point * all < whole.values.size(); ++point) {
      for (size_t c = 0; c < static_cast<size_t>(components); ++c)
        made.values.push_back(number(point * all, c));
    }
    return made;
  };
  if (ir::isMatrix(parameter.type)) {
    const int n = columnCount(parameter.type);
    for (int i = 0; i < n; ++i) {
      columns[columnName(parameter.name, i)] = with(
          n, [&](size_t point, size_t c) { return whole.values[point + static_cast<size_t>(i * n) + c]; });
    }
  } else if (ir::isWhole(ir::partType(parameter.type))) {
    for (int first = 0; first < whole.components; first += 2) {
      const auto half = [&](size_t point, size_t c) {
        const double number = whole.values[point + static_cast<size_t>(first) + c / 2];
        const auto bits = static_cast<uint32_t>(static_cast<int64_t>(number));
        return c % 2 == 0 ? bits >> kHalfBits : bits & kHalfLast;
      };
      columns[halvesName(parameter.name, first)] = with(2 * std::min(2, whole.components - first), half);
    }
  }
}

eval::Bindings inputsOf(const Subject& subject, std::span<const double> samples, size_t count) {
  eval::Bindings inputs = subject.inputs(samples, count);
  if (!subject.is_node) return inputs;
  for (const ir::Parameter& parameter : subject.module().parameters) addParts(parameter, inputs.columns);
  return inputs;
}

/// Adds what one run gives to the answer.
Result<void> run(const Subject& subject, const Ready& ready, const vulkan::Device& device,
                 FragmentRoute route, std::span<const double> samples, size_t count, Shown& answer) {
  Result<vulkan::Work> work =
      gpuWork(ready.module, inputsOf(subject, samples, count),
              texturesOf(subject, ready.module, samples, count), count * subject.lanes, route);
  if (!work) return tl::make_unexpected(std::move(work.error()));
  const Result<vulkan::Outcome> outcome = device.run(*work);
  if (!outcome) return tl::make_unexpected(outcome.error());
  if (answer.dropped.empty()) {
    for (size_t i = 0; i < count; ++i) answer.dropped.push_back(outcome->discarded[i * subject.lanes]);
  }
  for (const At& place : ready.places) {
    std::vector<double>& values = answer.values[place.root];
    for (size_t i = 0; i < count; ++i) {
      const auto number = [&](size_t k) {
        return static_cast<double>(outcome->outputs[k / 4][4 * i * subject.lanes + k % 4]);
      };
      const size_t end = place.first + place.components;
      if (place.whole == ir::Type::Float) {
        for (size_t k = place.first; k < end; ++k) values.push_back(number(k));
      } else {
        for (size_t k = place.first; k < end; k += 2) {
          const auto bits =
              static_cast<uint32_t>(number(k)) << kHalfBits | static_cast<uint32_t>(number(k + 1));
          values.push_back(place.whole == ir::Type::Int ? static_cast<double>(static_cast<int32_t>(bits))
                                                        : bits);
        }
      }
    }
  }
  return {};
}

Result<Shown> shown(const Subject& subject, std::span<const Ready> runs, const vulkan::Device& device,
                    FragmentRoute route, std::span<const double> samples, size_t count) {
  Shown answer;
  answer.values.resize(subject.roots.size());
  for (const Ready& ready : runs) {
    if (Result<void> done = run(subject, ready, device, route, samples, count, answer); !done)
      return tl::make_unexpected(std::move(done.error()));
  }
  return answer;
}

std::string whyNot(const Subject& subject) {
  if (subject.group > 1) return "its samples are each other's neighbours";
  for (const ir::TextureSlot& slot : subject.module().textures) {
    if (slot.type != ir::Type::Texture2D && slot.type != ir::Type::TextureCube &&
        slot.type != ir::Type::Texture2DArray && slot.type != ir::Type::Texture2DShadow)
      return fmt::format("'{}' is a {}", slot.name, ir::typeName(slot.type));
  }
  return {};
}

}  // namespace

DeviceSubject deviceSubject(const Subject& subject, const vulkan::Device& device, FragmentRoute route) {
  if (std::string why = whyNot(subject); !why.empty()) return {{}, std::move(why)};
  auto made = subject.is_node ? readyNodes(subject) : std::vector<Ready>{};
  if (!subject.is_node) made.push_back(readyMaterial(subject));
  for (const Ready& ready : made) {
    if (ready.module.varyings.size() <= device.mostInputs()) continue;
    return {{},
            fmt::format("the device takes {} inputs of a fragment stage, and it has {}", device.mostInputs(),
                        ready.module.varyings.size())};
  }
  const auto runs = std::make_shared<const std::vector<Ready>>(std::move(made));
  return {[&subject, runs, &device, route](std::span<const double> samples, size_t count) {
            return shown(subject, *runs, device, route, samples, count);
          },
          {}};
}

}  // namespace lacquer
