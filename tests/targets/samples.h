// Small modules made by hand, placed and bound as the printers expect them, and what the tests do with their
// texts.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check/check.h"
#include "ir/module.h"
#include "targets/target.h"

namespace lacquer::targets {

inline constexpr std::array kTextTargets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl,
                                            Target::Wgsl};

/// Makes modules by name instead of by index.
class Builder {
public:
  ir::Module module;

  ir::Dag& dag() { return module.dag; }

  /// Adds a block whose fields are laid out by ir::layout; returns its index.
  uint32_t block(ir::BlockRole role, std::string name, std::string instance,
                 std::vector<std::pair<std::string, ir::Type>> fields, uint32_t array = 0);
  /// The field of a block, "frame.exposure"; of an element of a light array when that is not negative.
  ir::ValueId field(std::string_view path, int32_t element = -1);
  ir::ValueId texture(std::string name, ir::Type type, bool environment = false);
  ir::ValueId attribute(std::string name, ir::Type type);
  /// A varying of a vertex value, as the fragment stage reads it.
  ir::ValueId varying(std::string name, ir::ValueId source);
  void color(std::string name, ir::ValueId value, uint32_t location = 0);
  void position(ir::ValueId clip_position);
  void discard(ir::ValueId condition);
  ir::ValueId named(ir::ValueId value, std::string_view name);
  void term(std::string name, std::string source) { dag().setTerm(dag().addTerm(name, source)); }
};

/// A sum over `group` of lights, with textures, a vertex stage and both sides of the surface.
ir::Module litSample(ir::LightGroup group);

/// Two outputs, a fixed light, a discard, no vertex stage.
ir::Module fixedSample();

/// Every component-wise op with a Float in each place beside a vector, every other function once, and all
/// that is spelled in its own way.
ir::Module everyOpSample();

/// Lookups over a footprint, and sizes, of every type of texture; a depth, and colours of one number and of
/// integers.
ir::Module lookupsSample();

/// The text of a stage, legalized for the target.
std::string print(ir::Module module, ir::Stage stage, Target target, std::string_view head = {});

/// Compiles and validates; fails the test, showing the text, if anything is wrong. WGSL is compiled where its
/// compiler is installed; nothing comes of it, nor of ESSL.
check::Spirv expectCompiles(const std::string& text, ir::Stage stage, Target target);

}  // namespace lacquer::targets
