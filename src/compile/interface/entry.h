// The interface as its entry in manifest.json says it (docs/manifest.md).
#pragma once

#include <string>
#include <string_view>

#include "json/json.h"
#include "lacquer/reflection.h"

namespace lacquer {

using json::Json;

/// Whether a member of entryOf() is in the manifest with these options.
bool isShown(std::string_view member, const Options& options);

/// All members: "template", "uniforms", "parameters", "textures", "inputs", "outputs" and so on. Those that
/// are there for some targets alone are last, some under two names: "metal" and "metal argument_buffers", of
/// which the part up to the blank is the name in the manifest.
Json entryOf(const Reflection& of);
/// Those that are in the manifest with these options: the shader's entry without "files" and "validated".
Json shownOf(const Reflection& of, const Options& options);
/// The same as a text.
std::string entryText(const Reflection& of, const Options& options);

/// A number, or an array of several.
Json numbersJson(const std::vector<double>& numbers);
/// An object of these.
Json namedJson(const NamedNumbers& named);
/// [low, high], infinite ends as texts, with "nan" behind them for what may be NaN.
Json reachedJson(const Reached& reached);
Json operationJson(const OperationProof& operation);
Json outputJson(const ShaderOutput& output);

}  // namespace lacquer
