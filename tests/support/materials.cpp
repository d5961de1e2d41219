#include "support/materials.h"

#include <stdexcept>

namespace lacquer::test {

namespace {

template <class T>
T orThrow(Result<T> result) {
  if (result) return *std::move(result);
  throw std::runtime_error(format(result.error().at(0)));
}

}  // namespace

const lang::Library& builtInLibrary() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

const model::Models& builtInModels() {
  static const model::Models kModels(builtInLibrary());
  return kModels;
}

const material::Schema& builtInSchema() {
  static const material::Schema& kSchema = *orThrow(builtInModels().schema());
  return kSchema;
}

Result<material::Document> readMaterials(const std::string& path, bool permissive) {
  return material::read(path, builtInSchema(), {permissive});
}

Result<material::Document> materialsOf(const std::string& text, const std::string& name, bool permissive) {
  return material::readText(text, name, builtInSchema(), {permissive});
}

graph::Graph buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                        const BuildSetup& setup, Diagnostics& warnings) {
  model::BuildOptions options;
  options.template_name = setup.template_name;
  options.decode_srgb = setup.decode_srgb;
  options.live.insert(setup.live.begin(), setup.live.end());
  options.switches = {{"ibl", setup.ibl},
                      {"dfg_table", setup.dfg_table},
                      {"multiple_scattering", setup.multiple_scattering},
                      {"direct_multiple_scattering", setup.direct_multiple_scattering}};
  options.switches.insert(setup.switches.begin(), setup.switches.end());
  const model::Model& model = *orThrow(builtInModels().of(setup.profile));
  const lang::TemplateDecl& wanted = *orThrow(builtInLibrary().template_(setup.template_name));
  return orThrow(model::build(model, wanted, material, attributes, options, warnings));
}

}  // namespace lacquer::test
