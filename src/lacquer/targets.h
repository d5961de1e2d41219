/// Targets of one's own. lacquer.h says what holds for every declaration.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "lacquer/options.h"

namespace lacquer {

/// A language that one of the library's targets comes near to: a console's, a house's dialect of HLSL. Its
/// texts are that target's, with other words. Bindings, limits and the manifest's entry are that target's,
/// too.
struct TargetDescription {
  std::string name;            ///< of a-z, 0-9 and '-', beginning with a letter; the folder of its files, too
  std::string extension;       ///< of its files, of a-z and 0-9: ID.frag.pssl
  std::string prose;           ///< what it is, for people
  Target like = Target::Hlsl;  ///< any but Spirv, Cpp, Js and registered ones
  /// What stands for an identifier of those texts, keywords and functions among them: {"cbuffer",
  /// "ConstantBuffer"}. One line of any text but comments. Comments and lines with '#' stay as they are.
  std::map<std::string, std::string, std::less<>> words;
  /// Lines that stand in place of the text's `#version`, or where there is none above its code.
  std::string opening;
  /// Says what is wrong with the text of a stage; nothing when all is well. Called from several threads, anew
  /// in each process: the cache keeps no such text. Without it nothing validates the texts.
  std::function<Strings(const std::string& text, bool vertex)> check;
};

/// Adds a target for the rest of the process; `target` is what Options::targets takes then. At the beginning:
/// not beside any other call. Errors: "target-name" (wrong, or there is one of that name), "target-like",
/// "target-words", "target-extension", "too-many-targets". A shader that has one of the words as a name of
/// its own is an error of that shader, "target-words".
bool addTarget(const TargetDescription& description, Target& target, Messages& messages);

}  // namespace lacquer
