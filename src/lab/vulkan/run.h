// A fragment shader run offscreen: N points in, N colours out. Each point is one pixel of RGBA32F targets,
// covered by a triangle of its own whose three corners have the same inputs: they reach the shader unchanged,
// their derivatives are 0, and the triangle's winding says which side is seen. All points of a chunk are one
// submission. Where derivatives matter, four points are one quad of pixels.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer::vulkan {

using BindingPlace = std::pair<uint32_t, uint32_t>;  ///< descriptor set and binding
using Texel = std::array<float, 4>;

/// A uniform block's bytes, or a storage buffer's: of one for all points, or of each point's, one after the
/// other.
struct UniformBlock {
  BindingPlace place;
  bool per_point = false;
  std::vector<unsigned char> bytes;
};

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

enum class Shape : uint8_t {
  Plane,
  Cube,    ///< one colour on all sides: `texels` holds one for all points, or one for each
  Array,   ///< of as many layers as there are texels for
  Volume,  ///< of one slice
};

/// A texture of one mip level, linear RGBA in 32-bit floats.
struct Texture {
  BindingPlace image, sampler;  ///< equal for a combined image sampler
  Shape shape = Shape::Plane;
  bool compares = false;  ///< a depth map: red is the depth, and a lookup says whether what it is given does
                          ///< not exceed it
  uint32_t width = 1, height = 1;
  std::shared_ptr<const std::vector<Texel>> texels;  ///< row by row from the top, layer by layer
  Wrap s = Wrap::Repeat, t = Wrap::Repeat;
  bool nearest = false;  ///< else bilinear
  /// A plane of one texel, which each point has for itself: `texels` holds one for each.
  bool per_point = false;
};

/// One input of the fragment stage, 1 to 4 floats for each point.
struct Varying {
  uint32_t components = 1;
  std::vector<float> values;
  /// An input of integers has these instead, int or uint: their bits. It is flat, so that the points of a
  /// quad have its first one's.
  std::vector<uint32_t> whole = {};
};

struct Work {
  std::vector<uint32_t> fragment;          ///< SPIR-V; entry points of other stages are not looked at
  std::map<uint32_t, uint32_t> constants;  ///< specialization constants: the bits of the value by id
  size_t points = 0;
  std::vector<Varying> inputs;    ///< in the order of their locations
  std::vector<bool> back_facing;  ///< empty: all are seen from the front
  /// Points stand in fours, as fragments do: (x, y), (x+1, y), (x, y+1), (x+1, y+1). One triangle covers
  /// them, so the inputs must be affine within: those of the fourth are not looked at. All else is the first
  /// one's.
  bool quads = false;
  std::vector<UniformBlock> blocks;
  std::vector<Texture> textures;
};

struct Outcome {
  std::vector<std::vector<float>> outputs;  ///< by location, RGBA of each point
  std::vector<bool> discarded;              ///< by point
};

/// A fragment shader to be timed: each pixel of a square is one invocation.
struct Sweep {
  std::vector<uint32_t> fragment;  ///< SPIR-V
  /// At three corners, upper left, upper right and lower left; affine between them.
  std::vector<Varying> inputs;
  /// What all pixels share. A cube map has one texel.
  std::vector<UniformBlock> blocks = {};
  std::vector<Texture> textures = {};
};

/// A device with a graphics queue, open for the rest of the process. Not to be used by two threads at once.
class Device {
public:
  /// The first one of Vulkan 1.1 that the loader knows. Errors: "vulkan-unavailable", where this program was
  /// built without Vulkan or there is no loader, driver or device.
  static Result<Device> open();

  const std::string& name() const;    ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& driver() const;  ///< "llvmpipe Mesa 22.3.6 …"
  /// Bits of a texture coordinate's fraction within a texel that the filter's weights are made from.
  uint32_t subTexelBits() const;
  /// Inputs that a fragment stage may have in run().
  uint32_t mostInputs() const;
  /// Shaders may have numbers of 16 bits.
  bool halves() const;

  /// Errors: "spirv-reflection"; "vulkan-interface" when `work` lacks what the shader reads;
  /// "vulkan-unsupported" when the device's limits do not suffice; "vulkan-failed" when a call fails. The
  /// module must be valid: drivers trust it.
  Result<Outcome> run(const Work& work) const;

  /// Nanoseconds of processor time, all threads together, that one invocation takes, by sweep: the least of
  /// `rounds`, in each of which every sweep has its turn, so that a slow moment meets them all. Interpolating
  /// the inputs and writing a pixel of four floats are included. Errors: as of run(), and
  /// "vulkan-unsupported" where shaders do not run on the processor.
  Result<std::vector<double>> time(const std::vector<Sweep>& sweeps, int rounds) const;

  struct State;

private:
  std::shared_ptr<const State> state_;
};

}  // namespace lacquer::vulkan
