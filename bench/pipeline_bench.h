// The time that making shaders takes, against the compilers that would do the same from text.
#pragma once

namespace lacquer::bench {

/// Renews bench/pipeline.json and prints it. 0 when all went well.
int runPipeline();

}  // namespace lacquer::bench
