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

ManifestFile::ManifestFile(const std::string& path, const Writing& how) : file_(path, how) {
  JsonText name(1);
  file_.append("{\n  \"lacquer\": " + name.string(version()).take() +
               ",\n  \"schema\": " + std::to_string(kManifestSchema) + ",\n  \"files\": [");
}

void ManifestFile::file(std::string_view entry) {
  file_.append(files_++ == 0 ? "\n    " : ",\n    ");
  file_.append(entry);
}

void ManifestFile::shader(std::string_view id, std::string_view entry) {
  if (shaders_ == 0) file_.append(files_ == 0 ? "],\n  \"shaders\": {" : "\n  ],\n  \"shaders\": {");
  file_.append(shaders_++ == 0 ? "\n    " : ",\n    ");
  file_.append(JsonText().string(id).take() + ": ");
  file_.append(entry);
}

Result<bool> ManifestFile::finish() {
  if (shaders_ == 0)
    file_.append(files_ == 0 ? "],\n  \"shaders\": {}\n}\n" : "\n  ],\n  \"shaders\": {}\n}\n");
  else
    file_.append("\n  }\n}\n");
  return file_.finish();
}

}  // namespace lacquer
