// The readers of glTF call it by its short name.
#pragma once

#include "support/text.h"
