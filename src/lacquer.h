/// Lacquer: glTF materials to GLSL, HLSL and SPIR-V.
///
/// The way is Scene -> Graph -> Shader: a file's materials, the node graph of one of them, the code of that
/// graph; generate() walks it for whole files. What holds for every declaration:
///
/// Errors. Bad input and bad arguments give messages, never an exception: a function that can fail takes a
/// Messages, appends to it at least one of Level::Error when it fails, and returns something empty or false.
/// What cannot fail takes none, and says what it returns for an index or an enumerator that does not exist.
/// Only std::bad_alloc and what a callback throws come out of a call. Where there is no memory left even to
/// take a JSON document down, the program ends.
///
/// Empty handles. A Scene, Graph or Shader that was made by its default constructor, was moved from or is the
/// result of a failed call is empty: `operator bool` is false. It may be used like any other. What it is
/// asked for is empty or 0, and where there is a Messages, it says "empty-handle".
///
/// Copies of a Scene, Graph or Shader are the same object: what edits one edits them all.
///
/// Threads. Distinct objects may be used from distinct threads at once, and so may the const functions of one
/// object. A Messages belongs to one call at a time. Functions that say so use Options::jobs threads of their
/// own.
///
/// Equal input gives equal bytes, whatever the number of threads.
#pragma once

#include "lacquer/contract.h"    // what a file is drawn with, as values
#include "lacquer/generate.h"    // scenes, shaders, runs over files
#include "lacquer/graph.h"       // the node graph, to look at and to edit
#include "lacquer/manifest.h"    // a manifest that is read
#include "lacquer/options.h"     // what all calls share: messages, targets, options
#include "lacquer/reflection.h"  // what a shader is bound to
#include "lacquer/results.h"     // what the tools find
#include "lacquer/targets.h"     // targets of one's own
#include "lacquer/tools.h"  // what else is known of a material or a shader: colours, pictures, proofs, costs
#include "lacquer/tune.h"   // run time against error
