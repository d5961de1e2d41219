// The works: the shading that peers are compared at (docs/cost.md), each a glTF file in bench/works/ with one
// material.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cost/cost.h"
#include "lacquer.h"

namespace lacquer::bench {

/// What a shader costs on navi21.
struct Numbers {
  uint64_t instructions = 0, inverse_throughput = 0;
};

struct Work {
  std::string name;  ///< "W0L"
  std::string file;  ///< in bench/works/
  bool ibl = true;
  std::string what;  ///< for the table
  Numbers goal;      ///< ours: at most
};
extern const std::vector<Work> kWorks;

/// How a work's SPIR-V is made.
enum class Route : uint8_t {
  Direct,     ///< as the product writes it
  Optimized,  ///< through glslang, then spirv-opt -O, as the peers' were made
};

/// The pipeline of a work: uniform mode, one directional light. Empty modules with a message on an error.
cost::Subject build(const Work& work, const std::string& folder, bool multiple_scattering, Route route,
                    Messages& messages);

struct Row {
  size_t spirv_instructions = 0;
  std::map<std::string, cost::Outcome> gpus;  ///< by family
};

/// All works of one mode and route, in the order of kWorks.
struct Table {
  std::string driver;
  std::vector<Row> rows;
};
Table measureWorks(const std::string& folder, bool multiple_scattering, Route route,
                   const std::vector<std::string>& families, Messages& messages);

}  // namespace lacquer::bench
