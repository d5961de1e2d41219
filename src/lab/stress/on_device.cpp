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
};

/// A subject's module with results for colours.
struct Ready {
  ir::Module module;
  std::vector<At> places;
};

/// A parameter as a fragment's input.
ValueId varyingOf(passes::Rewriter& r, ir::Input input) {
  const bool flag = input.type == ir::Type::Bool;
  const auto known = std::find_if(r.module().varyings.begin(), r.module().varyings.end(),
                                  [&](const ir::Varying& varying) { return varying.name == input.name; });
  const auto location = static_cast<uint32_t>(known - r.module().varyings.begin());
  if (flag) {
    input.type = ir::Type::Float;
    input.range = {0, 1};
  }
  if (known == r.module().varyings.end())
    r.module().varyings.push_back({input.name, input.type, location, ir::kNoValue});
  const ValueId value = r.dag().input(
      {ir::InputKind::Varying, input.name, input.type, ir::Rate::Fragment, input.range, 0, location});
  return flag ? r.dag().make(ir::Op::Less, {r.dag().constant(0.5), value}) : value;
}

/// The results' numbers, four in a colour.
void setColors(Ready& ready) {
  ir::Dag& dag = ready.module.dag;
  std::vector<ValueId> parts;
  for (size_t r = 0; r < ready.module.outputs.size(); ++r) {
    ValueId value = ready.module.outputs[r].value;
    if (dag[value].type == ir::Type::Bool)
      value = dag.make(ir::Op::Select, {value, dag.constant(1), dag.constant(0)});
    const int n = ir::componentCount(dag[value].type);
    ready.places.push_back({r, parts.size(), static_cast<size_t>(n)});
    for (int c = 0; c < n; ++c) parts.push_back(dag.component(value, c));
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

/// A node by itself: its parameters are the fragment's inputs.
Ready readyNode(const Subject& subject) {
  Ready ready{subject.module(), {}};
  ready.module.template_name = "node";
  passes::Rewriter(ready.module).run([](passes::Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    if (r.dag()[id].op != ir::Op::Input) return r.copy(id, operands);
    const ir::Input input = r.dag().inputOf(id);
    const bool stays = input.kind == ir::InputKind::Texture || ir::ofLoop(input.kind);
    return stays ? r.copy(id, operands) : varyingOf(r, input);
  });
  ready.module.parameters.clear();
  setColors(ready);
  passes::runPipeline(ready.module, {});
  return ready;
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
  const stress::Variable& variable = *subject.space.find(slot.name);
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
    const bool given = subject.space.find(slot.name) != nullptr;
    textures[module.textures[i].name] =
        given ? textureOf(subject, slot, samples, count) : tableOf(*eval::environmentTable(slot.name));
  }
  return textures;
}

Result<Shown> shown(const Subject& subject, const Ready& ready, const vulkan::Device& device,
                    FragmentRoute route, std::span<const double> samples, size_t count) {
  Result<vulkan::Work> work =
      gpuWork(ready.module, subject.inputs(samples, count), texturesOf(subject, ready.module, samples, count),
              count * subject.lanes, route);
  if (!work) return tl::make_unexpected(std::move(work.error()));
  const Result<vulkan::Outcome> outcome = device.run(*work);
  if (!outcome) return tl::make_unexpected(outcome.error());
  Shown answer;
  answer.values.resize(subject.roots.size());
  for (size_t i = 0; i < count; ++i) answer.dropped.push_back(outcome->discarded[i * subject.lanes]);
  for (const At& place : ready.places) {
    std::vector<double>& values = answer.values[place.root];
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = place.first; k < place.first + place.components; ++k)
        values.push_back(static_cast<double>(outcome->outputs[k / 4][4 * i * subject.lanes + k % 4]));
    }
  }
  return answer;
}

std::string whyNot(const Subject& subject) {
  if (subject.group > 1) return "its samples are each other's neighbours";
  for (const ir::Parameter& parameter : subject.module().parameters) {
    if (subject.is_node && (ir::isMatrix(parameter.type) || ir::isWhole(ir::partType(parameter.type))))
      return fmt::format("'{}' is a {}", parameter.name, ir::typeName(parameter.type));
  }
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
  const auto ready =
      std::make_shared<const Ready>(subject.is_node ? readyNode(subject) : readyMaterial(subject));
  return {[&subject, ready, &device, route](std::span<const double> samples, size_t count) {
            return shown(subject, *ready, device, route, samples, count);
          },
          {}};
}

}  // namespace lacquer
