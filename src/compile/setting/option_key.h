// What each option decides: the one place that knows, for everything that is kept between runs.
#pragma once

#include <initializer_list>

#include "lacquer/options.h"
#include "support/key.h"

namespace lacquer {

/// The first thing on the way from a file to its outputs that depends on an option.
enum class Decides : uint8_t {
  Graph,      ///< a material's graph, and what is said of the material
  Module,     ///< what becomes of a graph
  Code,       ///< what is printed of a module, or known of it
  SpirvCode,  ///< the same, of SPIR-V alone
  MslCode,    ///< the same, of Metal's language alone
  Run,        ///< which outputs a run has
  Nothing,    ///< neither outputs nor what is reported
};

/// Calls `each(Decides, value)` for every option. An option that is added stops here until it has its place:
/// the names must be all of Options.
template <class Each>
void eachOption(const Options& options, Each each) {
  const auto& [profile, as, simplify, template_name, targets, parameters, binding, static_samplers, lights,
               switches, ibl, multiple_scattering, dfg_table, decode_srgb, permissive, validate, unused,
               properties, spirv_route, relaxed, half, optimize, optimize_error, optimize_for, debug, live,
               node_directories, node_texts, materialx_directories, materialx_texts, document_texts, jobs,
               cache, cache_size, depfile, packed, shard, limits, allow, cache_key, argument_buffers, sync,
               programs, fallback, weights, programs_report, programs_model, pipelines] = options;
  each(Decides::Graph, profile);
  each(Decides::Graph, as);
  each(Decides::Graph, simplify);
  each(Decides::Graph, template_name);
  each(Decides::Run, targets);
  each(Decides::Module, parameters);
  each(Decides::Module, binding);
  each(Decides::Module, static_samplers);
  each(Decides::Graph, lights);
  each(Decides::Graph, switches);
  each(Decides::Graph, ibl);
  each(Decides::Graph, multiple_scattering);
  each(Decides::Graph, dfg_table);
  each(Decides::Graph, decode_srgb);
  each(Decides::Graph, permissive);
  each(Decides::Code, validate);
  each(Decides::Graph, unused);
  each(Decides::Graph, properties);
  each(Decides::SpirvCode, spirv_route);
  each(Decides::Module, relaxed);
  each(Decides::Module, half);
  each(Decides::Module, optimize);
  each(Decides::Module, optimize_error);
  each(Decides::Module, optimize_for);
  each(Decides::SpirvCode, debug);
  each(Decides::Graph, live);
  // What is in them goes into every key; the depfile has their names.
  each(Decides::Run, node_directories);
  each(Decides::Run, node_texts);
  each(Decides::Run, materialx_directories);
  each(Decides::Run, materialx_texts);
  each(Decides::Nothing, document_texts);
  each(Decides::Nothing, jobs);
  each(Decides::Nothing, cache);
  each(Decides::Nothing, cache_size);
  each(Decides::Run, depfile);
  each(Decides::Run, packed);
  each(Decides::Run, shard);
  each(Decides::Graph, limits);
  each(Decides::Nothing, allow);
  each(Decides::Nothing, cache_key);
  each(Decides::MslCode, argument_buffers);
  each(Decides::Nothing, sync);
  // What comes of them depends on all the inputs together: it goes into the keys by itself.
  each(Decides::Run, programs);
  each(Decides::Run, fallback);
  each(Decides::Run, weights);
  each(Decides::Run, programs_report);
  each(Decides::Run, programs_model);
  each(Decides::Run, pipelines);
}

/// Puts the options in that decide one of these.
void addOptions(const Options& options, std::initializer_list<Decides> what, KeyBuilder& key);

}  // namespace lacquer
