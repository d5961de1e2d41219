// The node library with what it makes of materials.
#pragma once

#include <memory>

#include "lacquer.h"
#include "lang/library.h"
#include "material/material.h"
#include "model/model.h"

namespace lacquer {

struct Language : lang::Library {
  explicit Language(lang::Library&& library) : lang::Library(std::move(library)), models(*this) {}
  Language(const Language&) = delete;
  Language& operator=(const Language&) = delete;

  model::Models models;
};

/// A file's materials by the library's declarations.
Result<material::Document> readMaterials(const std::string& path, const Language& language,
                                         const Options& options);

/// The built-in library with the options' folders added. The built-in one alone is made once.
Result<std::shared_ptr<const Language>> libraryFor(const Options& options);

}  // namespace lacquer
