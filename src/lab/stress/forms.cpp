#include "stress/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/material.h"
#include "material/drawn.h"
#include "model/thresholds.h"
#include "setting/messages.h"
#include "stress/subject.h"
#include "stress/vectors.h"

namespace lacquer {

namespace {

using material::addExtension;
using material::drawNumbers;
using material::Material;
using material::Schema;
using material::setNumber;
using model::Threshold;
using stress::Subject;

/// How far beside a threshold a number is: near, and nearer. A lobe's peak makes slopes of 10^10, so that
/// only what does not shrink with the distance is a jump. Evaluations are in double, whose rounding is far
/// below.
constexpr double kNear = 1e-9, kNearer = 1e-12;
/// A slope shrinks by 1000, the root of the distance by 32.
constexpr double kShrinks = 0.1;
constexpr size_t kSamples = 64;

/// Puts a value where a threshold is; false where the material has no such place.
bool setAt(const Schema& schema, const Threshold& threshold, const ir::Components& value,
           Material& material) {
  if (threshold.member < 0) {
    // It alone has its say: of two properties that mean the same the other would count.
    const std::string& role = schema.properties[threshold.property].role;
    std::erase_if(material.numbers, [&](const Material::Number& number) {
      return schema.properties[number.property].role == role;
    });
    setNumber(material, threshold.property, value);
    return true;
  }
  for (Material::Texture& texture : material.textures) {
    if (texture.property != threshold.property) continue;
    texture.info.members[static_cast<size_t>(threshold.member)] = value[0];
    return true;
  }
  return false;
}

const lang::PropertyDecl& declOf(const Schema& schema, const Threshold& threshold) {
  const lang::PropertyDecl& decl = *schema.properties[threshold.property].decl;
  return threshold.member < 0 ? decl : decl.members[static_cast<size_t>(threshold.member)];
}

/// A number so far beside the threshold, in the range; nothing where there is none.
std::optional<ir::Components> beside(const Schema& schema, const Threshold& threshold, double distance) {
  const lang::PropertyDecl& decl = declOf(schema, threshold);
  ir::Components value = threshold.at;
  for (int c = 0; c < ir::componentCount(decl.type); ++c) {
    double& x = value[static_cast<size_t>(c)];
    const double step = distance * std::max(1.0, std::abs(x));
    x = decl.range.contains(x + step) ? x + step : x - step;
    if (!decl.range.contains(x)) return std::nullopt;
  }
  return value;
}

std::vector<double> listOf(const lang::PropertyDecl& decl, const ir::Components& value) {
  return {value.begin(), value.begin() + std::max(1, ir::componentCount(decl.type))};
}

class Comparing {
public:
  Comparing(const Language& library, const Schema& schema, const model::Model& model, const Options& options,
            const std::string& file, uint64_t seed, double allowed)
      : library_(library),
        schema_(schema),
        model_(model),
        options_(options),
        file_(file),
        seed_(seed),
        allowed_(allowed),
        thresholds_(model::thresholds(model)) {}

  Result<Forms> run(const Material& material) {
    if (Result<void> own = atThresholds(material, {}); !own)
      return tl::make_unexpected(std::move(own.error()));
    for (uint16_t layer = 1; layer < schema_.extensions.size(); ++layer) {
      if (material.has(layer) || !model::isLayer(model_, layer)) continue;
      if (Result<void> laid = under(material, layer); !laid)
        return tl::make_unexpected(std::move(laid.error()));
    }
    return std::move(forms_);
  }

private:
  /// The material's own thresholds and the layer's, the layer's other numbers drawn; then the layer's again,
  /// with its others at theirs: the plainest form that it has.
  Result<void> under(const Material& material, uint16_t layer) {
    std::vector<uint16_t> extensions = material.extensions;
    if (!addExtension(schema_, layer, extensions)) return {};
    std::sort(extensions.begin(), extensions.end());
    Material laid = material;
    laid.extensions = extensions;
    Random random(mixed(seed_, schema_.extensions[layer]->name));
    drawNumbers(schema_, extensions, random, laid);
    const std::string name(schema_.extensions[layer]->name);
    if (Result<void> drawn = atThresholds(laid, name); !drawn) return drawn;
    for (const Threshold& threshold : thresholds_) {
      const bool of_layer = schema_.properties[threshold.property].extension == layer;
      if (of_layer && !threshold.whole_part) setAt(schema_, threshold, threshold.at, laid);
    }
    return atThresholds(laid, name);
  }

  Result<void> atThresholds(const Material& material, const std::string& layer) {
    for (const Threshold& threshold : thresholds_) {
      const uint16_t extension = schema_.properties[threshold.property].extension;
      if (extension != 0 && !material.has(extension)) continue;
      const std::optional<ir::Components> near = beside(schema_, threshold, kNear);
      Material at = material;
      Material off = material;
      if (!near || !setAt(schema_, threshold, threshold.at, at) || !setAt(schema_, threshold, *near, off))
        continue;
      if (Result<void> compared = compare(threshold, at, off, *near, layer); !compared) return compared;
    }
    return {};
  }

  Result<std::unique_ptr<Subject>> lowered(const Material& material) {
    FileImages images(file_, options_);
    EvalMaterial evaluated(images, options_);
    Messages ignored;  // said of the material itself already
    if (Result<void> made = evaluated.lower(material, library_, true, {}, ignored); !made)
      return tl::make_unexpected(std::move(made.error()));
    // Not placed: numbers are doubles from the parameters on.
    return stress::materialSubject(material.name, evaluated.module(), {});
  }

  Result<void> compare(const Threshold& threshold, const Material& at, const Material& off,
                       const ir::Components& near, const std::string& layer) {
    const auto first = lowered(at);
    const auto second = lowered(off);
    if (!first) return tl::make_unexpected(first.error());
    if (!second) return tl::make_unexpected(second.error());
    ++forms_.compared;
    const material::Property& property = schema_.properties[threshold.property];
    std::string variable = property.parameter_name;
    if (threshold.member >= 0) variable += "_" + material::parameterName(declOf(schema_, threshold).name);
    std::vector<double> a(kSamples * (*first)->space.width());
    std::vector<double> b(kSamples * (*second)->space.width());
    draw(**first, **second, a, b);
    for (const auto& [subject, samples] : {std::pair{first->get(), &a}, std::pair{second->get(), &b}}) {
      placeNumbers(*subject, *samples);
      placeFrames(*subject, *samples);
      placeTexels(*subject, *samples);
    }
    place(**second, variable, near, b);
    const StressFinding farther = worst(**first, **second, a, b);
    if (farther.value <= allowed_) return {};
    const ir::Components nearer = *beside(schema_, threshold, kNearer);
    place(**second, variable, nearer, b);
    StressFinding fault = worst(**first, **second, a, b);
    if (!(fault.value <= std::max(allowed_, kShrinks * farther.value))) {
      fault.layer = layer;
      fault.parameter = property.decl->name;
      if (threshold.member >= 0) fault.parameter += fmt::format(".{}", declOf(schema_, threshold).name);
      fault.at = listOf(declOf(schema_, threshold), threshold.at);
      fault.beside = listOf(declOf(schema_, threshold), nearer);
      forms_.faults.push_back(std::move(fault));
    }
    return {};
  }

  /// The same numbers for all that both have.
  void draw(const Subject& first, const Subject& second, std::vector<double>& a,
            std::vector<double>& b) const {
    const size_t wide = first.space.width();
    const size_t other = second.space.width();
    for (size_t i = 0; i < kSamples; ++i) {
      const uint64_t seed = mixed(seed_, i);
      const std::span<double> to = std::span(a).subspan(i * wide, wide);
      const std::span<double> from = std::span(b).subspan(i * other, other);
      first.space.draw(seed, to);
      second.space.draw(seed, from);
      for (const stress::Variable& variable : first.space.variables()) {
        const stress::Variable* same = second.space.find(variable.name);
        if (same == nullptr || same->components != variable.components) continue;
        std::copy_n(from.begin() + static_cast<ptrdiff_t>(same->first), variable.components,
                    to.begin() + static_cast<ptrdiff_t>(variable.first));
      }
    }
  }

  /// The material's own numbers. The ends of their ranges, which are drawn else, make slopes of any
  /// steepness: a medium through which light comes 10^-30 m far.
  static void placeNumbers(const Subject& subject, std::vector<double>& samples) {
    for (const ir::Parameter& parameter : subject.module().parameters)
      place(subject, parameter.name, parameter.value, samples);
  }

  /// Normals and tangents of length 1, at right angles: a frame that is none makes steps as such texels do.
  static void placeFrames(const Subject& subject, std::vector<double>& samples) {
    for (const char* length : {"n_length", "t_length", "interpolated"})
      place(subject, length, ir::Components{1}, samples);
    const stress::Variable* n = subject.space.find("n");
    const stress::Variable* t = subject.space.find("t");
    if (n == nullptr || t == nullptr) return;
    for (size_t i = 0; i < kSamples; ++i) {
      const std::span<double> sample =
          std::span(samples).subspan(i * subject.space.width(), subject.space.width());
      const std::span<const double> normal = sample.subspan(n->first, 3);
      size_t axis = 0;
      for (const size_t c : {size_t{1}, size_t{2}})
        axis = std::abs(normal[c]) < std::abs(normal[axis]) ? c : axis;
      // Across the normal and that axis.
      stress::Vec3 across{};
      across[(axis + 1) % 3] = -normal[(axis + 2) % 3];
      across[(axis + 2) % 3] = normal[(axis + 1) % 3];
      const auto turned = stress::unit(across);
      std::copy(turned.begin(), turned.end(), sample.begin() + static_cast<ptrdiff_t>(t->first));
    }
  }

  /// Texels near the middle, and for a normal map near the normal: one that decodes to no direction, or to
  /// one along the surface, makes steps of its own, which jumps are looked for by.
  void placeTexels(const Subject& subject, std::vector<double>& samples) const {
    for (const ir::TextureSlot& slot : subject.module().textures) {
      const stress::Variable* variable = subject.space.texel(slot.name);
      if (slot.environment || variable == nullptr) continue;
      for (size_t i = 0; i < kSamples; ++i) {
        Random random(mixed(mixed(seed_, slot.name), i));
        const std::span<double> texel =
            std::span(samples).subspan(i * subject.space.width() + variable->first, variable->components);
        for (size_t c = 0; c < texel.size(); ++c) texel[c] = (c == 2 ? 0.8 : 0.55) + 0.2 * random.unit();
      }
    }
  }

  static void place(const Subject& subject, const std::string& name, const ir::Components& value,
                    std::vector<double>& samples) {
    const stress::Variable* variable = subject.space.find(name);
    if (variable == nullptr) return;  // it is a number of the shader's
    for (size_t i = variable->first; i < samples.size(); i += subject.space.width())
      std::copy_n(value.begin(), variable->components, samples.begin() + static_cast<ptrdiff_t>(i));
  }

  /// The largest number of a sample's lights and environments, at least 1.
  static double brightest(const Subject& subject, const std::vector<double>& samples, size_t sample) {
    double most = 1;
    for (const stress::Variable& variable : subject.space.variables()) {
      const bool environment = std::any_of(
          subject.module().textures.begin(), subject.module().textures.end(),
          [&](const ir::TextureSlot& slot) { return slot.environment && slot.name == variable.name; });
      if (!environment && variable.name != "light") continue;
      const auto from =
          samples.begin() + static_cast<ptrdiff_t>(sample * subject.space.width() + variable.first);
      most = std::max(most, *std::max_element(from, from + variable.components));
    }
    return most;
  }

  static StressFinding worst(const Subject& first, const Subject& second, const std::vector<double>& a,
                             const std::vector<double>& b) {
    const stress::Values x = first.evaluate(stress::Arithmetic::Double, a, kSamples);
    const stress::Values y = second.evaluate(stress::Arithmetic::Double, b, kSamples);
    StressFinding fault;
    fault.fault = Fault::Form;
    fault.samples.resize(1);
    for (size_t r = 0; r < first.roots.size(); ++r) {
      const stress::Root& root = first.roots[r];
      const auto same =
          std::find_if(second.roots.begin(), second.roots.end(), [&](const stress::Root& other) {
            return other.kind == stress::Root::Kind::Result && other.name == root.name;
          });
      if (root.kind != stress::Root::Kind::Result || same == second.roots.end()) continue;
      const std::vector<double>& other = y[static_cast<size_t>(same - second.roots.begin())];
      for (size_t i = 0; i < x[r].size(); ++i) {
        const size_t sample = i / static_cast<size_t>(root.components);
        const double scale = std::max({std::abs(x[r][i]), std::abs(other[i]), brightest(second, b, sample)});
        const double differs = std::abs(x[r][i] - other[i]) / scale;
        if (differs <= fault.value) continue;
        fault.value = std::isnan(differs) ? HUGE_VAL : differs;
        fault.what = root.name;
        fault.samples[0].clear();
        for (const stress::Variable& variable : second.space.variables()) {
          const auto from =
              b.begin() + static_cast<ptrdiff_t>(sample * second.space.width() + variable.first);
          fault.samples[0].emplace_back(variable.name, std::vector<double>(from, from + variable.components));
        }
      }
    }
    return fault;
  }

  const Language& library_;
  const Schema& schema_;
  const model::Model& model_;
  const Options& options_;
  const std::string& file_;
  uint64_t seed_;
  double allowed_;
  std::vector<Threshold> thresholds_;
  Forms forms_;
};

}  // namespace

Result<Forms> compareForms(const Material& material, const std::string& file, const Language& library,
                           const Options& options, uint64_t seed, double allowed) {
  Options named = options;
  if (Result<void> resolved = resolveNames(library, named); !resolved)
    return tl::make_unexpected(std::move(resolved.error()));
  const Result<const model::Model*> model = library.models.of(named.profile);
  if (!model) return tl::make_unexpected(model.error());
  return Comparing(library, *(*model)->schema, **model, options, file, seed, allowed).run(material);
}

}  // namespace lacquer
