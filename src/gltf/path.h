// The readers of glTF call it by its short name.
#pragma once

#include "gltf/json.h"
