// What an engine makes ahead of time: the distinct pipelines of a run, in the order of use.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lacquer/contract.h"

namespace lacquer {

/// What a primitive stores for an attribute of the shader's: of its name, or the matrix that it is a column
/// of, `_M` for `_M_0`. Null where there is nothing.
const StoredAttribute* storedFor(const std::vector<StoredAttribute>& attributes, std::string_view name);

/// A vertex attribute as a primitive stores it.
struct PipelineInput {
  std::string name;
  uint32_t location = 0;
  std::string kind;       ///< what the shader reads: "float", "int", "uint"
  std::string component;  ///< "FLOAT"
  uint32_t count = 1;     ///< components
  bool normalized = false;
  bool stand_in = false;  ///< the primitive has none: one value in a buffer with a step of 0
};

struct Pipeline {
  std::string shader;
  bool has_vertex = false;
  std::vector<PipelineInput> inputs;
  std::optional<Blend> blend;
  bool double_sided = false, depth_write = true;
  std::vector<ShaderOutput> outputs;
  std::vector<SpecConstant> specialization;  ///< `neutral` is the material's number

  uint64_t uses = 0;
  /// The first use: a primitive of the file, or a material that nothing draws in it.
  std::string source;
  int32_t mesh = -1, primitive = -1, material = -1;
};

/// Distinct pipelines; each use that is added counts.
class Pipelines {
public:
  /// Of a use of a material. `attributes`: of the primitive; null where nothing draws it.
  void add(const DrawState& state, const std::string& shader, const std::vector<UsedParameter>& parameters,
           const Reflection& reflection, bool has_vertex, const std::vector<StoredAttribute>* attributes,
           const Pipeline& first);
  void add(Pipeline pipeline);

  const std::vector<Pipeline>& all() const { return all_; }
  /// The text of docs/pipelines.schema.json.
  std::string text() const;

private:
  std::vector<Pipeline> all_;
  std::map<std::string, size_t> places_;  ///< by everything but the uses
};

}  // namespace lacquer
