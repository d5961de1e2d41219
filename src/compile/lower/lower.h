// From a checked graph and its template to a module: nodes are inlined, one term each.
#pragma once

#include "graph/graph.h"
#include "ir/module.h"
#include "lang/library.h"
#include "lower/inline.h"

namespace lacquer::lower {

enum class ParameterMode : uint8_t {
  Uniform,  ///< parameters stay editable: values of material rate
  Baked,    ///< parameters are constants, but for the animated ones
  Spec,     ///< parameters become specialization constants (Module::spec_constants)
};

struct LowerOptions {
  ParameterMode parameters = ParameterMode::Uniform;
  bool evaluable = false;  ///< the kinds of light come with what fills them: ir::LightKind::fill
  LoopOptions loops = {};
  /// A source of the graph, a number, bool or vector of them, that the only output beside the position has,
  /// in the first of its four components; the others are 0. Of light rate: summed over the lights.
  const graph::Source* shown = nullptr;
  bool shown_whole = false;  ///< integers in two such outputs, whose sum they are exactly (lower/shown.h)
  OnCall on_call = {};       ///< when given, told of the graph's nodes and of what they and the template call
};

/// The graph must have passed graph::check() with the same library (asserted where it shows) and be flat.
/// Nodes in which there is something that vertices do not know stay where they are, whatever the graph says.
/// The result is verified in debug builds, and the same for graphs that differ in ids, in the order of lists
/// and in what nobody asks for. Errors: only those of the library (a node's body that does not check).
Result<ir::Module> lower(const graph::Graph& graph, const lang::Library& library,
                         const LowerOptions& options);

}  // namespace lacquer::lower
