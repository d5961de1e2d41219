#include "lower/light_fill.h"

#include <utility>
#include <vector>

#include "lower/inline.h"

namespace lacquer::lower {

ir::Module fillOf(const lang::TemplateDecl& decl, const lang::LightKindDecl& kind) {
  ir::Module module;
  std::vector<ir::ValueId> slots(decl.slots, ir::kNoValue);
  for (const lang::LightProperty& property : lang::lightProperties()) {
    ir::Parameter parameter;
    parameter.name = property.name;
    parameter.type = property.type;
    const auto index = static_cast<uint32_t>(module.parameters.size());
    module.parameters.push_back(std::move(parameter));
    slots.push_back(module.dag.input({ir::InputKind::Parameter,
                                      std::string(property.name),
                                      property.type,
                                      ir::Rate::Material,
                                      {},
                                      0,
                                      index}));
  }
  Inliner inliner(module.dag);
  for (const lang::LightFieldDecl& field : kind.fields) {
    module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, std::string(field.name), 0,
                              inliner.evaluate(*field.value, slots)});
  }
  return module;
}

}  // namespace lacquer::lower
