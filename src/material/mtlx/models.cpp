#include "mtlx/models.h"

#include <cassert>
#include <utility>

#include "lang/embedded.h"

namespace lacquer::materialx {

const Element& surfaceModels() {
  static const Element kModels = [] {
    Element models;
    models.category = "materialx";
    for (const lang::EmbeddedFile& file : lang::embeddedModels()) {
      Result<Document> document = readXml(file.text, std::string(file.name), Limits{});
      assert(document);
      for (Element& child : document->root.children) models.children.push_back(std::move(child));
    }
    return models;
  }();
  return kModels;
}

}  // namespace lacquer::materialx
