// Small inputs for calls of the library, and what they answer.
#pragma once

#include <lacquer.h>

#include <filesystem>
#include <string>

namespace lacquer::test {

/// The codes of the errors, joined by spaces.
std::string errorsOf(const Messages& messages);

/// A file with one material, "Paint", and so many lights.
std::string paintGltf(int lights = 0);
/// The same as a scene, a graph.
Scene paintScene();
Graph paintGraph();

/// Without validation, for one target.
Options quick();

/// The examples' files.
Strings examples();

/// The bytes of a file; empty where there is none.
std::string readBytes(const std::filesystem::path& path);
/// How a manifest of one file names it.
std::string sourceIn(const std::string& manifest);

/// A folder of the test that runs, empty at first.
std::filesystem::path emptyFolder();

}  // namespace lacquer::test
