// A module's DAG as a straight list of scalar instructions on registers. Vectors are taken apart here, so
// that constructing and swizzling cost nothing and a register is one array of a number type, one lane per
// point.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "eval/bindings.h"
#include "ir/module.h"
#include "support/diagnostic.h"

namespace lacquer::eval {

enum class Step : uint8_t {
  Map,          ///< out = fold of `op` on the arguments
  Literal,      ///< out = literals[payload]
  Load,         ///< out = component `component` of columns[payload]
  Light,        ///< out = component `component` of light_fields[payload], of `element` or the loop's light
  LightIndex,   ///< out = the place of the loop's light: its number, or in lists that of its number
  ListedLight,  ///< out = component `component` of light_fields[payload], of the light whose number is
                ///< args[0]
  Listed,       ///< out = lists[payload] at args[0]
  AddListed,    ///< out += args[1] where the loop's turn is one of the point's
  Texture,  ///< out … out+3 (outs) = textures[payload] at args[0…2], level args[3] (kNoRegister: implicit)
  TextureSize,  ///< out = the size of textures[payload] along the axis `component`, of the level args[0]
  DerivativeX,  ///< out = difference to the neighbour along x
  DerivativeY,  ///< the same along y
  LoopBegin,    ///< over the lights of light_groups[payload]; of listed ones args[1] from place args[0] on
  LoopEnd,
  RoundsBegin,  ///< out, an Int, from `element` on, up to before the highest of args[0], `payload` rounds at
                ///< most
  Copy,         ///< out = args[0]
  Keep,         ///< out = args[0] where the round args[1] is before args[2]
  RoundsEnd,    ///< the next round of args[0] up to before the highest of args[1]; payload: rounds to begin
                ///< with
};

using Register = uint32_t;
inline constexpr Register kNoRegister = ~Register{0};

struct Instruction {
  Step step;
  ir::Op op = ir::Op::Constant;
  uint8_t component = 0;
  int32_t element = -1;
  uint32_t payload = 0;
  std::array<Register, 4> outs{kNoRegister, kNoRegister, kNoRegister, kNoRegister};
  std::array<Register, 4> args{kNoRegister, kNoRegister, kNoRegister, kNoRegister};
  bool half = false;   ///< of a value that the Dag says is relaxed
  bool whole = false;  ///< of an integer, which nothing rounds (ir/whole.h)
  bool fuses = false;  ///< a sum of sums or products, which devices may regroup or fuse
};

/// Holds for every Bindings that gives the same inputs as those that it was compiled for, each per point or
/// not as there.
struct Program {
  std::vector<Instruction> uniform;  ///< the same for every point: run once
  std::vector<Instruction> body;     ///< run for every batch of points
  std::vector<double> literals;
  std::vector<std::string> columns, light_fields, textures;  ///< names, looked up in the bindings
  std::vector<std::pair<std::string, Column>> defaults;  ///< today's values of parameters that are not bound
  std::vector<ir::LightGroup> light_groups;
  std::vector<std::vector<double>> lists;      ///< of each field that is read, by element
  std::vector<std::vector<Register>> results;  ///< by root, the registers of its components
  std::vector<ir::Type> types;                 ///< by root, the type of a component
  uint32_t registers = 0;
};

/// What a list of ints has in a field: what is bound, or the one range that has all lights, in their order.
std::vector<double> listValues(const ir::Module& module, const Bindings& bindings,
                               const ir::ListField& field);

/// Compiles what `roots` reach. Works on a module as lowered, as placed, and on anything between: an
/// Interpolate passes its operand through. Errors: "unbound-input" and "wrong-binding", which name the input.
Result<Program> compile(const ir::Module& module, std::span<const ir::ValueId> roots,
                        const Bindings& bindings, size_t points);

}  // namespace lacquer::eval
