// The shading language of a console as a target of its own: HLSL's texts in other words. The console here is
// invented; the words of a real one stand in its maker's documents, which a studio keeps to itself.
#pragma once

#include <lacquer.h>

/// Adds the target "console", which is asked for as any other from then on.
bool addConsole(lacquer::Target& target, lacquer::Messages& messages);
