// A file's own geometry, for pictures.
#pragma once

#include "eval/material.h"
#include "preview/shot.h"

namespace lacquer::lod {

/// What has the material, in the file of `images`; a note where some of it is left out.
preview::Mesh meshOf(const material::Material& material, FileImages& images, const Language& language,
                     Messages& messages);

}  // namespace lacquer::lod
