// The time that making shaders takes, against the compilers that would do the same from text.
#pragma once

#include <cstddef>
#include <string_view>

namespace lacquer::bench {

/// Renews bench/pipeline.json and prints it. 0 when all went well.
int runPipeline();

/// A work's way from the Material struct to SPIR-V, once to be warm and `count` times more: what `./dev bench
/// instructions` runs under callgrind. Of "w1/number" and "w1/structure" the edit of its graph, to the bytes
/// of the block and to SPIR-V. 2 where there is no such work.
int repeat(std::string_view work, size_t count);

}  // namespace lacquer::bench
