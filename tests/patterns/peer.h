// MaterialX's own code for a node, where MaterialX and node.js are there: ../shared/peers/materialx, or the
// folder that LACQUER_MATERIALX names, which has its WebAssembly module.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer::test {

/// A fragment shader that puts the value of a node out as a colour.
struct PeerShader {
  std::string glsl;                 ///< for Vulkan; its inputs are vertex values, each at a location
  std::vector<std::string> inputs;  ///< their names, in the order of locations: texcoord_0, positionObject
};

/// The folder of its module; nothing where that or node.js is absent.
std::optional<std::string> peerFolder();

/// `nodes` is what stands in a nodegraph, of which the node called n has the type `type`. `editable`: inputs
/// are uniforms, as viewers have them; else constants. Throws std::runtime_error with what MaterialX says.
PeerShader peerShader(const std::string& nodes, std::string_view type, bool editable);

/// The shaders of a document's surfaces by their names, all numbers constants. Throws as peerShader().
std::map<std::string, std::string> peerSurfaces(const std::string& document);

/// A surface's shader under one light and a constant environment, whose inputs are vertex values beside
/// `view` and `light`, unit vectors.
PeerShader peerLit(std::string glsl, double light, double environment);

/// The same with its loops marked to be written out.
std::string writtenOut(std::string glsl);

/// SPIR-V by glslang and spirv-opt -O.
std::vector<uint32_t> peerWords(const std::string& glsl);

}  // namespace lacquer::test
