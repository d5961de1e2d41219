// What a run reports of its materials, as bytes for the cache.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lacquer.h"
#include "structures/structure.h"
#include "support/blob.h"

namespace lacquer {

/// The materials of one file, without its name. Terms that they share are written once.
void writeMaterials(std::span<const MaterialReport> materials, BlobWriter& blob);
/// Appends them, as those of `file`. What is damaged leaves the reader incomplete.
void readMaterials(const std::string& file, BlobReader& blob, std::vector<MaterialReport>& materials);

}  // namespace lacquer
