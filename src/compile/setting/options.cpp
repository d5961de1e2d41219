#include "setting/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "optimize/cost.h"
#include "optimize/optimize.h"
#include "setting/language.h"
#include "setting/simplify.h"
#include "targets/target.h"

namespace lacquer {

namespace {

void add(Diagnostics& to, std::string code, std::string message, std::string help) {
  to.push_back({std::move(code), Severity::Error, {}, std::move(message), std::move(help), {}});
}

/// An enumeration may hold any number: `count` of them have a name.
template <class Enum>
void checkEnumerator(std::string_view what, Enum value, size_t count, Diagnostics& wrong) {
  const auto number = static_cast<size_t>(value);
  if (number < count) return;
  add(wrong, "unknown-enumerator", fmt::format("{} is {}, which is no enumerator", what, number),
      fmt::format("they are 0 to {}", count - 1));
}

/// "glsl, spirv and wgsl": the targets of which a fact holds.
std::string namesOf(bool targets::Row::*fact) {
  std::vector<std::string_view> names;
  for (const targets::Row& row : targets::rows()) {
    if (row.*fact) names.push_back(row.name);
  }
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// Whether a JSON pointer leads to a property that some extension declares.
bool isProperty(const Language& language, const Options& options, std::string_view pointer) {
  Options named = options;
  const std::optional<std::string_view> path = watchedPath(pointer);
  if (!path || !resolveNames(language, named)) return false;
  const Result<const model::Model*> model = language.models.of(named.profile);
  return model && (*model)->keeping(*path);
}

/// What the library says of the options' names.
void checkNames(const Options& options, Diagnostics& wrong) {
  const auto language = libraryFor(options);
  if (!language) {
    wrong.insert(wrong.end(), language.error().begin(), language.error().end());
    return;
  }
  const bool documents = options.profile == kMaterialX;
  if (!options.profile.empty() && !documents && !(*language)->has(lang::DeclKind::Profile, options.profile)) {
    return add(wrong, "unknown-profile", fmt::format("there is no profile '{}'", options.profile),
               fmt::format("there are {}, and {} for MaterialX documents",
                           fmt::join((*language)->names(lang::DeclKind::Profile), ", "), kMaterialX));
  }
  if (!options.as.empty() && options.as != "gltf" && options.as != kMaterialX)
    return add(wrong, "unknown-surface", fmt::format("surfaces cannot be read as '{}'", options.as),
               "there are gltf and materialx");
  if (documents && options.as == "gltf")
    return add(wrong, "profile-of-documents", "the profile materialx has MaterialX's own surfaces",
               "leave it out where they are translated to glTF's properties");
  for (const auto& [name, ignored] : options.switches) {
    if ((*language)->has(lang::DeclKind::Switch, name)) continue;
    add(wrong, "unknown-switch", fmt::format("there is no switch '{}'", name),
        fmt::format("there are {}", fmt::join((*language)->names(lang::DeclKind::Switch), ", ")));
  }
  // Only who asks for terms waits here for the parts to be read.
  if (!options.simplify.empty()) {
    const Diagnostics words = checkSimplification(options.simplify, **language);
    wrong.insert(wrong.end(), words.begin(), words.end());
  }
  if (options.live.empty()) return;
  const Strings known = liveTerms(options);
  for (const std::string& term : options.live) {
    if (std::find(known.begin(), known.end(), term) != known.end()) continue;
    if (term.starts_with('/')) {
      if (!isProperty(**language, options, term))
        add(wrong, "unknown-property", fmt::format("'{}' is no property of a material", term),
            "a JSON pointer to a number or a texture, such as /materials/0/emissiveFactor, whose index has "
            "no "
            "leading zeros");
      continue;
    }
    add(wrong, "unknown-term", fmt::format("no term that can be kept live is named '{}'", term),
        fmt::format("there are {}", fmt::join(known, ", ")));
  }
}

}  // namespace

std::string_view version() { return LACQUER_VERSION; }

std::string_view targetName(Target target) {
  return static_cast<size_t>(target) < targets::rows().size() ? targets::row(target).name
                                                              : std::string_view{};
}

Strings optimizeFamilies() {
  Strings names;
  for (const optimize::Family& family : optimize::families()) names.emplace_back(family.name);
  return names;
}

Strings targetNames() {
  Strings names;
  for (const targets::Row& row : targets::rows()) names.emplace_back(row.name);
  return names;
}

bool hasSpecializationConstants(Target target) {
  return static_cast<size_t>(target) < targets::rows().size() && targets::row(target).specialization;
}

bool findTarget(std::string_view name, Target& target) {
  const std::deque<targets::Row>& rows = targets::rows();
  const auto it =
      std::find_if(rows.begin(), rows.end(), [&](const targets::Row& row) { return row.name == name; });
  if (it != rows.end()) target = it->id;
  return it != rows.end();
}

Result<Limits> limitsOf(const Options& options) {
  Limits limits;
  for (const std::string& text : options.limits) {
    if (const Result<void> set = setLimit(text, limits); !set) return tl::make_unexpected(set.error());
  }
  return limits;
}

Diagnostics checkReading(const Options& options) {
  Diagnostics wrong;
  if (const Result<Limits> limits = limitsOf(options); !limits) wrong = limits.error();
  checkNames(options, wrong);
  checkEnumerator("Options::parameters", options.parameters, 3, wrong);
  if (!(options.relaxed >= 0 && options.relaxed <= 0.5)) {
    add(wrong, "out-of-range", fmt::format("Options::relaxed is {}", options.relaxed),
        "it must be from 0 to 0.5");
  }
  if (options.half && options.relaxed == 0) {
    add(wrong, "no-half", "types of 16 bits are asked for, and nothing is relaxed",
        "allow an error by `relaxed` (--relaxed), such as 0.01, or leave `half` out");
  }
  if (options.optimize > 0 && !optimize::searches()) {
    add(wrong, "no-search", "this build of Lacquer does not search for cheaper forms",
        "leave `optimize` at 0; the program and the native library do");
  }
  if (options.optimize > 2) {
    add(wrong, "out-of-range", fmt::format("Options::optimize is {}", options.optimize),
        "it must be from 0 to 2");
  }
  if (!(options.optimize_error >= 0 && options.optimize_error <= 0.5)) {
    add(wrong, "out-of-range", fmt::format("Options::optimize_error is {}", options.optimize_error),
        "it must be from 0 to 0.5");
  }
  if (options.optimize_error > 0 && options.optimize != 2) {
    add(wrong, "no-approximations",
        fmt::format("an error of {} is allowed, and nothing is approximated", options.optimize_error),
        "ask for level 2, or for no error");
  }
  if (!options.optimize_for.empty() && optimize::findFamily(options.optimize_for) == nullptr) {
    add(wrong, "unknown-family", fmt::format("there is no family of GPUs '{}'", options.optimize_for),
        fmt::format("there are {}", fmt::join(optimizeFamilies(), ", ")));
  }
  checkEnumerator("Lights::mode", options.lights.mode, 3, wrong);
  return wrong;
}

Diagnostics checkOptions(const Options& options) {
  Diagnostics wrong = checkReading(options);
  checkEnumerator("Options::spirv_route", options.spirv_route, 2, wrong);
  checkEnumerator("Options::binding", options.binding, 3, wrong);
  if (options.binding == BindingModel::Bindless && options.fallback) {
    add(wrong, "fallback-bindless",
        "a fallback has the places of each material's own shader, whose records are of another length",
        "leave the fallback out, or bind by sets");
  }
  if (knowsSamplers(options) && (options.programs != 0 || options.fallback)) {
    add(wrong, "shared-samplers",
        "materials that share a program have samplers of their own, which are no part of it",
        "leave `programs` and the fallback out, or static samplers and arrays");
  }
  if (options.static_samplers && options.binding == BindingModel::Bindless) {
    add(wrong, "bindless-samplers",
        "an array of textures has a sampler for each of them, none of which is static",
        "leave static samplers out, or bind by sets");
  }
  std::set<Target> seen;
  for (const Target target : options.targets) {
    if (targetName(target).empty()) {
      checkEnumerator("a target", target, targets::rows().size(), wrong);
    } else if (!seen.insert(target).second) {
      add(wrong, "duplicate-target", fmt::format("the target {} is asked for twice", targetName(target)),
          "name each once");
    } else if (options.parameters == Parameters::Spec && !hasSpecializationConstants(target)) {
      add(wrong, "no-specialization-constants",
          fmt::format("the target {} has no specialization constants", targetName(target)),
          fmt::format("{} have them; for the others, parameters are uniform or baked",
                      namesOf(&targets::Row::specialization)));
    } else if (options.binding == BindingModel::Bindless && !targets::row(target).bindless) {
      add(wrong, "no-bindless",
          fmt::format("the target {} has no arrays of textures from which each fragment takes another",
                      targetName(target)),
          fmt::format("{} have them; name those with --target, or bind by sets",
                      namesOf(&targets::Row::bindless)));
    }
  }
  return wrong;
}

Result<void> inRange(std::string_view what, uint64_t value, uint64_t least, uint64_t most,
                     std::string_view unit) {
  if (value >= least && value <= most) return {};
  return fail("out-of-range", {}, fmt::format("{} is {}", what, value),
              fmt::format("it must be from {} to {}{}{}", least, most, unit.empty() ? "" : " ", unit));
}

Result<void> hasPath(std::string_view what, const std::string& path) {
  if (!path.empty()) return {};
  return fail("no-path", {}, fmt::format("{} has no name", what), "name one; the current folder is .");
}

passes::LightFacts lightFacts(const Options& options, const passes::LightFacts& scene) {
  switch (options.lights.mode) {
    case Lights::Mode::Any: return {};
    case Lights::Mode::Scene: return scene;
    case Lights::Mode::Fixed: break;
  }
  return {false, options.lights.counts};
}

optimize::Settings optimization(const Options& options) {
  return {static_cast<int>(options.optimize), options.optimize_error,
          optimize::findFamily(options.optimize_for)};
}

bool knowsSamplers(const Options& options) {
  return options.static_samplers || options.binding == BindingModel::Arrays;
}

lower::ParameterMode parameterMode(const Options& options) {
  switch (options.parameters) {
    case Parameters::Uniform: return lower::ParameterMode::Uniform;
    case Parameters::Baked: return lower::ParameterMode::Baked;
    case Parameters::Spec: return lower::ParameterMode::Spec;
  }
  return lower::ParameterMode::Uniform;
}

}  // namespace lacquer
