#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/eval_material.h"
#include "api/internal.h"
#include "api/points.h"
#include "eval/evaluate.h"
#include "gltf/text.h"

namespace lacquer {

namespace {

/// The points' own values, the environment of each, and what comes from the stages before the fragment's.
Result<void> bind(EvalMaterial& material, const EvalPoints& points, eval::Bindings& bindings) {
  eval::bindPoints(points.points, bindings);
  if (Result<void> block = eval::bindMaterialBlock(material.module(), bindings); !block) return block;
  if (Result<void> varyings = eval::bindVaryings<float>(material.module(), points.points.size(), bindings);
      !varyings) {
    return varyings;
  }
  for (const ir::TextureSlot* slot : material.environments()) {
    bindings.textures[slot->name] = [&points](size_t point, const std::array<double, 3>&, double) {
      const std::array<double, 3>& e = points.environment[point];
      return std::array<double, 4>{e[0], e[1], e[2], 1};
    };
  }
  return material.bindTextures({}, bindings);
}

/// The values of the points as JSON.
template <class T>
Result<std::string> answer(const ir::Module& module, const eval::Bindings& bindings,
                           const std::string& material, size_t points) {
  std::vector<ir::ValueId> roots;
  ir::ValueId color = ir::kNoValue;
  ir::ValueId dropped = ir::kNoValue;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color && output.location == 0) color = output.value;
    if (output.kind == ir::OutputKind::Discard) dropped = output.value;
  }
  roots.push_back(color);
  if (dropped != ir::kNoValue) roots.push_back(dropped);
  const auto values = eval::evaluate<T>(module, roots, bindings, points);
  if (!values) return tl::make_unexpected(values.error());
  constexpr bool kSingle = sizeof(T) == sizeof(float);
  std::string text =
      fmt::format("{{\n  \"material\": {},\n  \"engine\": \"{}\",\n  \"profile\": \"khr\",\n  \"rgba\": [",
                  gltf::Json(material).dump(-1, ' ', false, gltf::Json::error_handler_t::replace),
                  kSingle ? "float" : "double");
  for (size_t i = 0; i < points; ++i) {
    text += i == 0 ? "\n    [" : ",\n    [";
    for (size_t c = 0; c < 4; ++c) {
      const T x = (*values)[0][4 * i + c];
      if (c > 0) text += ", ";
      // JSON has no infinity; no input in its range should come here.
      text += std::isfinite(x) ? fmt::format(kSingle ? "{:.9g}" : "{:.17g}", x) : "null";
    }
    text += "]";
  }
  text += "\n  ]";
  if (values->size() > 1) {
    text += ",\n  \"discarded\": [";
    for (size_t i = 0; i < points; ++i) text += fmt::format("{}{}", i == 0 ? "" : ", ", (*values)[1][i] != 0);
    text += "]";
  }
  return text + "\n}\n";
}

/// The material of that name, or the only one where no name is given.
Result<const gltf::Material*> findMaterial(const gltf::Document& document, const std::string& name) {
  if (name.empty() && document.materials.size() == 1) return document.materials.data();
  std::vector<std::string> names;
  for (const gltf::Material& material : document.materials) {
    if (!name.empty() && material.name == name) return &material;
    names.push_back("'" + gltf::printable(material.name) + "'");
  }
  return fail("unknown-material", {document.path, 0, 0, {}},
              name.empty() ? std::string("the file does not have exactly one material: name one")
                           : fmt::format("no material is named '{}'", gltf::printable(name)),
              names.empty() ? "there are none" : fmt::format("there are {}", fmt::join(names, ", ")));
}

Result<std::string> evaluateOne(const std::string& file, const std::string& material,
                                const EvalPoints& points, bool in_float,
                                const std::vector<std::string>& texels, const Options& options,
                                Messages& messages) {
  const Result<gltf::Document> document = gltf::read(file, {options.permissive});
  if (!document) return tl::make_unexpected(document.error());
  report(document->diagnostics, file, messages);
  const Result<const gltf::Material*> found = findMaterial(*document, material);
  if (!found) return tl::make_unexpected(found.error());
  report((*found)->diagnostics, file, messages);
  if (lacquer::hasError((*found)->diagnostics)) return std::string();
  const auto library = libraryFor(options);
  if (!library) return tl::make_unexpected(library.error());
  FileImages images(file);
  EvalMaterial evaluated(images, options);
  if (Result<void> set = evaluated.setTexels(texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  if (Result<void> lowered = evaluated.lower(**found, **library, points.has_environment, {}, messages);
      !lowered) {
    return tl::make_unexpected(std::move(lowered.error()));
  }
  if (in_float) evaluated.place({false, 1, 0, 0});
  eval::Bindings bindings;
  if (Result<void> bound = bind(evaluated, points, bindings); !bound)
    return tl::make_unexpected(std::move(bound.error()));
  const size_t count = points.points.size();
  return in_float ? answer<float>(evaluated.module(), bindings, (*found)->name, count)
                  : answer<double>(evaluated.module(), bindings, (*found)->name, count);
}

}  // namespace

std::string evaluate(const std::string& file, const std::string& material, const std::string& points,
                     const std::string& points_name, bool in_float, const std::vector<std::string>& texels,
                     const Options& options, Messages& messages) {
  const Result<EvalPoints> read = readPoints(points, points_name);
  if (!read) {
    report(read.error(), points_name, messages);
    return {};
  }
  Result<std::string> text = evaluateOne(file, material, *read, in_float, texels, options, messages);
  if (text) return std::move(*text);
  report(text.error(), file, messages);
  return {};
}

}  // namespace lacquer
