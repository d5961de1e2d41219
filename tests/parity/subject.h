// What is compared: modules ready to print, with values for everything that they read.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eval/gpu.h"
#include "graph/graph.h"
#include "lang/library.h"
#include "lower/lower.h"
#include "parity/enclosure.h"
#include "passes/passes.h"

namespace lacquer::parity {

struct Subject {
  std::string name;
  ir::Module module;  ///< placed and bound
  size_t points = 0;
  eval::Bindings bindings;  ///< every number is a float
  GpuTextures textures;
  std::map<std::string, TextureSize> sizes;  ///< of textures that are no constants
  bool single = false;                       ///< one operation: there is nothing to regroup

  /// The colours, in the order of their locations.
  std::vector<ir::ValueId> roots() const;
};

const lang::Library& library();

/// A node by itself: its arguments are fragment inputs that take values in their declared ranges, the edges
/// among them, its results lie in colours, four numbers in each.
Subject nodeSubject(const lang::NodeDecl& node, std::string_view variant, size_t points);

/// Each operation of ir/ops.def that has an arithmetic, for every type that it takes, a Float beside a vector
/// among them: operands are fragment inputs within the operation's domain.
std::vector<Subject> operationSubjects(size_t points);

struct MaterialSetting {
  std::string template_name = "forward";
  lower::ParameterMode parameters = lower::ParameterMode::Uniform;
  passes::LightFacts lights{false, {{"directional", 1}}};
  bool decode_srgb = false;
  bool tangents = true;
  std::map<std::string, bool, std::less<>> switches{};
  bool quads = false;  ///< points stand in fours; positions and texture coordinates are affine in each
};

struct NamedGraph {
  std::string name;
  graph::Graph graph;
};

/// The materials of examples/*.gltf, on primitives with all attributes.
std::vector<NamedGraph> exampleGraphs(const MaterialSetting& setting);

/// Four materials of each file of random ones (tests/golden/random_material.h).
std::vector<NamedGraph> randomGraphs(const MaterialSetting& setting, uint64_t files);

/// A material at random points, the edges among them: grazing and equal directions, both sides. Textures are
/// small random images with random wrap modes, nearest or bilinear; environments are random colours. With
/// lights that are not known there are three, one of each type.
Subject materialSubject(const NamedGraph& graph, const MaterialSetting& setting, size_t points,
                        uint64_t seed);

/// The same with at most eight colours each, as many as every device takes: as many of them as that needs.
std::vector<Subject> inPasses(Subject subject);

/// What the vertex stage of a material does, as a fragment shader: attributes come as fragment inputs, the
/// clip position and the varyings go out as colours. Matrices are random.
Subject vertexSubject(const NamedGraph& graph, const MaterialSetting& setting, size_t points, uint64_t seed);

/// The device; null where there is none.
const vulkan::Device* device();

/// All outputs, RGBA after RGBA, of each point: by the CPU in float, and by the device.
std::vector<std::vector<float>> onCpu(const Subject& subject);
std::vector<std::vector<float>> onDevice(const Subject& subject, FragmentRoute route);

struct Comparison {
  size_t numbers = 0;  ///< compared
  size_t outside = 0;  ///< beyond the bound
  size_t vague = 0;    ///< of those with a bound that is vague()
  size_t endless = 0;  ///< and with one that is endless()
  std::string first;   ///< the first that is outside
};

/// Whether a bound has no end: it says nothing.
bool endless(const analysis::Range& bound);
/// Whether a bound is wider than a thousandth of its numbers, and than 1e-6.
bool vague(const analysis::Range& bound);

/// Adds a run's outputs to a comparison with the bounds.
void compare(const Subject& subject, const std::vector<std::vector<analysis::Range>>& bounds,
             const std::vector<std::vector<float>>& outputs, std::string_view engine, Comparison& comparison);

/// By point, the numbers of all outputs.
std::vector<std::vector<analysis::Range>> boundsOf(const Subject& subject, bool rounded_parameters = false);

/// The CPU and the three routes against the bounds.
Comparison compareEngines(const Subject& subject);

}  // namespace lacquer::parity
