#include "manifest/manifest.h"

#include "lacquer/options.h"

namespace lacquer {

Json diagnosticJson(const Diagnostic& d) {
  Json json = {{"code", d.code}, {"severity", severityName(d.severity)}};
  if (!d.place.pointer.empty()) json["pointer"] = d.place.pointer;
  json["message"] = d.message;
  if (!d.help.empty()) json["help"] = d.help;
  return json;
}

ManifestText::ManifestText(std::function<void(std::string_view)> append) : append_(std::move(append)) {
  JsonText name(1);
  append_("{\n  \"lacquer\": " + name.string(version()).take() +
          ",\n  \"schema\": " + std::to_string(kManifestSchema) + ",\n  \"files\": [");
}

void ManifestText::file(std::string_view entry) {
  append_(files_++ == 0 ? "\n    " : ",\n    ");
  append_(entry);
}

void ManifestText::shader(std::string_view id, std::string_view entry) {
  if (shaders_ == 0) append_(files_ == 0 ? "],\n  \"shaders\": {" : "\n  ],\n  \"shaders\": {");
  append_(shaders_++ == 0 ? "\n    " : ",\n    ");
  append_(JsonText().string(id).take() + ": ");
  append_(entry);
}

void ManifestText::end() {
  if (shaders_ == 0)
    append_(files_ == 0 ? "],\n  \"shaders\": {}\n}\n" : "\n  ],\n  \"shaders\": {}\n}\n");
  else
    append_("\n  }\n}\n");
}

}  // namespace lacquer
