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

std::string_view portUnit(const Element& document, std::string_view category, std::string_view input) {
  for (const Element* definitions : {&document, &surfaceModels()}) {
    for (const Element& child : definitions->children) {
      if (child.category != "nodedef" || child.get("node") != category) continue;
      const Element* port = child.child("input", input);
      if (port != nullptr && !port->get("unit").empty()) return port->get("unit");
    }
  }
  return {};
}

}  // namespace lacquer::materialx
