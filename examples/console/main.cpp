// Shaders of glTF files in the console's language, and the manifest, in a folder.
#include <cstdio>

#include "console.h"

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "usage: console FOLDER FILE.gltf...\n"), 2;
  lacquer::Messages messages;
  lacquer::Target console;
  bool ok = addConsole(console, messages);
  if (ok) {
    lacquer::Options options;
    options.targets = {console};
    const lacquer::Report report = lacquer::generate({argv + 2, argv + argc}, {}, argv[1], options, messages);
    for (const lacquer::ShaderReport& shader : report.shaders)
      std::printf("%s%s\n", shader.id.c_str(), shader.validated ? "" : ": not validated");
    ok = report.ok;
  }
  for (const lacquer::Message& message : messages) std::fprintf(stderr, "%s\n", message.text.c_str());
  return ok ? 0 : 1;
}
