// What the tests of the packing targets share: shaders with blocks, numbers for them, and the library's
// bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <random>
#include <string>
#include <vector>

#include "ir/module.h"
#include "lacquer.h"

namespace lacquer::test {

using Numbers = std::map<std::string, std::vector<double>>;  ///< components of parameters, by name

/// Options for one target that packs.
Options packingOptions(Target target);

/// Every graph of the examples, with its shader.
void eachExample(const Options& options, const std::function<void(Graph&, const Shader&)>& call);

/// Of a graph's `parameters`, today's values.
Numbers valuesOf(const nlohmann::json& parameters);
/// Numbers in the ranges, and at their ends.
Numbers randomValues(const nlohmann::json& parameters, std::mt19937& random);

/// Numbers outside of the ranges, some of which no float holds, and infinities.
Numbers outsideValues(const nlohmann::json& parameters, std::mt19937& random);

/// Bytes in hexadecimal.
std::string hexOf(const std::vector<uint8_t>& bytes);
/// The block of Shader::pack(), in hexadecimal. All of it is finite, or the test fails.
std::string packedByLibrary(const Shader& shader, const Numbers& numbers);

/// A placed module of nothing but a preshader: so many operations on every type, each of `ops` in turn, with
/// names that mean something in the targets.
ir::Module randomPreshader(uint32_t seed, int operations, const std::vector<ir::Op>& ops);
/// All operations that a preshader may have.
const std::vector<ir::Op>& preshaderOps();
/// Numbers for a random preshader's parameters, in [-4, 4]; whole ones where asked.
Numbers randomNumbers(const ir::Module& module, std::mt19937& random, bool whole);
/// The block of the library's preshader, in hexadecimal.
std::string evaluated(const ir::Module& module, const Numbers& numbers);

}  // namespace lacquer::test
