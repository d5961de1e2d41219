#include "patterns/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "eval/evaluate.h"
#include "ir/module.h"
#include "lower/inline.h"

namespace lacquer::test {

const lang::Library& standardLibrary() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

std::array<double, 4> texelAt(double u, double v) {
  return {0.5 + 0.4 * std::sin(5 * u + v), 0.5 + 0.4 * std::cos(3 * v - u),
          0.6 + 0.3 * std::sin(u * 2 + v * 4), 0.5 + 0.5 * std::sin(u + v)};
}

template <class T>
std::vector<std::vector<T>> runNode(const std::string& form, const Arguments& arguments, size_t points,
                                    const std::string& variant, bool quads, const eval::Sampler& image) {
  const auto found = standardLibrary().node(form);
  if (!found) throw std::runtime_error(format(found.error().at(0)));
  const lang::NodeDecl& node = **found;
  ir::Module module;
  module.template_name = "node";
  eval::Bindings bindings;
  bindings.quads = quads;
  std::vector<ir::ValueId> values;
  size_t used = 0;
  for (const lang::Param& param : node.params) {
    if (ir::isTexture(param.type)) {
      ir::TextureSlot slot;
      slot.name = param.name;
      slot.type = param.type;
      const auto index = static_cast<uint32_t>(module.textures.size());
      module.textures.push_back(slot);
      values.push_back(module.dag.input(
          {ir::InputKind::Texture, slot.name, param.type, ir::Rate::Frame, {0, 1}, 0, index}));
      if (image) {
        bindings.textures[slot.name] = image;
        continue;
      }
      bindings.textures[slot.name] = [](size_t, const std::array<double, 3>& uv, double) {
        return texelAt(uv[0], uv[1]);
      };
      continue;
    }
    const auto argument = arguments.find(param.name);
    if (argument == arguments.end()) {
      values.push_back(ir::kNoValue);
      continue;
    }
    ++used;
    const int components = ir::componentCount(param.type);
    if (argument->second.size() == static_cast<size_t>(components)) {
      ir::Components constant{};
      std::copy(argument->second.begin(), argument->second.end(), constant.begin());
      values.push_back(module.dag.constant(param.type, constant));
      continue;
    }
    const auto index = static_cast<uint32_t>(module.varyings.size());
    const std::string name(param.name);
    module.varyings.push_back({name, param.type, index, ir::kNoValue});
    values.push_back(module.dag.input(
        {ir::InputKind::Varying, name, param.type, ir::Rate::Fragment, param.range, 0, index}));
    bindings.columns[name] = eval::Column::perPoint(components, argument->second);
  }
  if (used != arguments.size()) throw std::runtime_error(form + " lacks one of the parameters");
  lower::Inliner inliner(module.dag);
  const lower::Values results = inliner.call(node, variant, values);
  auto evaluated =
      eval::evaluate<T>(module, std::vector<ir::ValueId>(results.begin(), results.end()), bindings, points);
  if (!evaluated) throw std::runtime_error(format(evaluated.error().at(0)));
  return std::move(*evaluated);
}

template std::vector<std::vector<float>> runNode(const std::string&, const Arguments&, size_t,
                                                 const std::string&, bool, const eval::Sampler&);
template std::vector<std::vector<double>> runNode(const std::string&, const Arguments&, size_t,
                                                  const std::string&, bool, const eval::Sampler&);

std::vector<Place> somePlaces(size_t count, int dimensions, float largest, uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto unit = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  std::vector<Place> places(count);
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < dimensions; ++k) {
      const auto sign = unit() < 0.5 ? -1.0 : 1.0;
      const double whole = std::floor(unit() * 17) - 8;
      float& x = places[i][static_cast<size_t>(k)];
      switch (i % 5) {
        case 0: x = static_cast<float>((unit() - 0.5) * 16); break;
        case 1: x = static_cast<float>(whole); break;
        case 2: x = std::nextafter(static_cast<float>(whole), static_cast<float>(sign) * 1e9F); break;
        case 3: x = static_cast<float>((unit() - 0.5) * 2000); break;
        default: x = static_cast<float>(sign * std::exp2(unit() * std::log2(largest))); break;
      }
      // What a device may lose of a subnormal number is no subject here.
      if (std::abs(x) < 1e-37F) x = 0;
    }
  }
  return places;
}

std::vector<double> componentsOf(const std::vector<Place>& places, int dimensions) {
  std::vector<double> components;
  for (const Place& place : places)
    components.insert(components.end(), place.begin(), place.begin() + dimensions);
  return components;
}

}  // namespace lacquer::test
