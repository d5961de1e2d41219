// Options from their JSON form, a row for each key.
#include "c/handles.h"
#include "c/rows.h"
#include "setting/messages.h"

namespace lacquer::c {

namespace {

using json::Json;

lacquer_options defaults() {
  lacquer_options options;
#ifdef LACQUER_NO_CHECK
  options.options.validate = false;
#endif
  return options;
}

template <bool Options::*Member>
bool setBool(const Json& value, lacquer_options& to) {
  if (value.is_boolean()) to.options.*Member = value.get<bool>();
  return value.is_boolean();
}

template <std::string Options::*Member>
bool setText(const Json& value, lacquer_options& to) {
  if (value.is_string()) to.options.*Member = value.get<std::string>();
  return value.is_string();
}

template <Strings Options::*Member>
bool setStrings(const Json& value, lacquer_options& to) {
  return readStrings(value, to.options.*Member);
}

bool setTargets(const Json& value, lacquer_options& to) {
  Strings names;
  if (!readStrings(value, names)) return false;
  std::vector<Target> targets;
  for (const std::string& name : names) {
    Target target{};
    if (!findTarget(name, target)) return false;
    targets.push_back(target);
  }
  to.options.targets = std::move(targets);
  return true;
}

bool setParameters(const Json& value, lacquer_options& to) {
  constexpr std::pair<std::string_view, Parameters> kNames[] = {
      {"uniform", Parameters::Uniform}, {"baked", Parameters::Baked}, {"spec", Parameters::Spec}};
  for (const auto& [name, parameters] : kNames) {
    if (value != name) continue;
    to.options.parameters = parameters;
    return true;
  }
  return false;
}

bool setRoute(const Json& value, lacquer_options& to) {
  if (value == "direct") to.options.spirv_route = SpirvRoute::Direct;
  if (value == "glslang") to.options.spirv_route = SpirvRoute::Glslang;
  return value == "direct" || value == "glslang";
}

bool setBinding(const Json& value, lacquer_options& to) {
  if (value == "sets") to.options.binding = BindingModel::Sets;
  if (value == "bindless") to.options.binding = BindingModel::Bindless;
  if (value == "arrays") to.options.binding = BindingModel::Arrays;
  return value == "sets" || value == "bindless" || value == "arrays";
}

bool setLights(const Json& value, lacquer_options& to) {
  Lights lights;
  if (value == "scene") lights.mode = Lights::Mode::Scene;
  if (value.is_object()) {
    lights.mode = Lights::Mode::Fixed;
    for (const auto& [kind, count] : value.items()) {
      if (!wholeNumber(count, lights.counts[kind])) return false;
    }
  } else if (value != "any" && value != "scene") {
    return false;
  }
  to.options.lights = std::move(lights);
  return true;
}

bool setSwitches(const Json& value, lacquer_options& to) {
  if (!value.is_object()) return false;
  for (const auto& [name, on] : value.items()) {
    if (!on.is_boolean()) return false;
    to.options.switches[name] = on.get<bool>();
  }
  return true;
}

bool setTexts(const Json& value, std::vector<std::pair<std::string, std::string>>& to) {
  if (!value.is_object()) return false;
  for (const auto& [name, text] : value.items()) {
    if (!text.is_string()) return false;
    to.emplace_back(name, text.get<std::string>());
  }
  return true;
}

/// Numbers by name; a single one, and true and false, stand without brackets.
bool setValues(const Json& value, lacquer_options& to) {
  if (!value.is_object()) return false;
  for (const auto& [name, json] : value.items()) {
    std::vector<double> numbers;
    const auto add = [&](const Json& one) {
      if (one.is_boolean()) numbers.push_back(one.get<bool>() ? 1 : 0);
      if (one.is_number()) numbers.push_back(one.get<double>());
      return one.is_boolean() || one.is_number();
    };
    if (!(json.is_array() ? std::all_of(json.begin(), json.end(), add) : add(json))) return false;
    to.trial.parameters.emplace_back(name, std::move(numbers));
  }
  return true;
}

bool setLook(const Json& value, lacquer_options& to) {
  using As = ValueLook::As;
  constexpr std::pair<std::string_view, As> kNames[] = {
      {"color", As::Color}, {"vector", As::Vector}, {"grey", As::Grey}};
  for (const auto& [name, as] : kNames) {
    if (value != name) continue;
    to.look.as = as;
    return true;
  }
  return false;
}

constexpr Row<lacquer_options> kRows[] = {
    {"profile", "a string", setText<&Options::profile>},
    {"as", "\"materialx\" or \"gltf\"", setText<&Options::as>},
    {"simplify", kTexts, setStrings<&Options::simplify>},
    {"template", "a string", setText<&Options::template_name>},
    {"targets", "an array of names of targets", setTargets},
    {"parameters", "\"uniform\", \"baked\" or \"spec\"", setParameters},
    {"binding", "\"sets\", \"bindless\" or \"arrays\"", setBinding},
    {"static_samplers", kTruth, setBool<&Options::static_samplers>},
    {"lights", "\"any\", \"scene\" or an object of counts", setLights},
    {"switches", "an object of true and false", setSwitches},
    {"ibl", kTruth, setBool<&Options::ibl>},
    {"multiple_scattering", kTruth, setBool<&Options::multiple_scattering>},
    {"dfg_table", kTruth, setBool<&Options::dfg_table>},
    {"decode_srgb", kTruth, setBool<&Options::decode_srgb>},
    {"permissive", kTruth, setBool<&Options::permissive>},
    {"validate", kTruth, setBool<&Options::validate>},
    {"spirv_route", "\"direct\" or \"glslang\"", setRoute},
    {"relaxed", "a number",
     [](const Json& value, lacquer_options& to) {
       if (value.is_number()) to.options.relaxed = value.get<double>();
       return value.is_number();
     }},
    {"half", kTruth, setBool<&Options::half>},
    {"optimize", "a whole number",
     [](const Json& value, lacquer_options& to) { return wholeNumber(value, to.options.optimize); }},
    {"optimize_error", "a number",
     [](const Json& value, lacquer_options& to) {
       if (value.is_number()) to.options.optimize_error = value.get<double>();
       return value.is_number();
     }},
    {"optimize_for", "a string", setText<&Options::optimize_for>},
    {"debug", kTruth, setBool<&Options::debug>},
    {"live", kTexts, setStrings<&Options::live>},
    {"node_directories", kTexts, setStrings<&Options::node_directories>},
    {"node_texts", "an object of texts by their names",
     [](const Json& value, lacquer_options& to) { return setTexts(value, to.options.node_texts); }},
    {"materialx_directories", kTexts, setStrings<&Options::materialx_directories>},
    {"materialx_texts", "an object of texts by their names",
     [](const Json& value, lacquer_options& to) { return setTexts(value, to.options.materialx_texts); }},
    {"document_texts", "an object of texts by their names",
     [](const Json& value, lacquer_options& to) { return setTexts(value, to.options.document_texts); }},
    {"jobs", "a whole number",
     [](const Json& value, lacquer_options& to) { return wholeNumber(value, to.options.jobs); }},
    {"limits", kTexts, setStrings<&Options::limits>},
    {"allow", kTexts, setStrings<&Options::allow>},
    {"unused", kTruth, setBool<&Options::unused>},
    {"properties", kTruth, setBool<&Options::properties>},
    {"cache", "a string", setText<&Options::cache>},
    {"programs", "a whole number",
     [](const Json& value, lacquer_options& to) { return wholeNumber(value, to.options.programs); }},
    {"fallback", kTruth, setBool<&Options::fallback>},
    {"programs_model", kTruth, setBool<&Options::programs_model>},
    {"values", "an object of numbers and arrays of numbers", setValues},
    {"node", "a string",
     [](const Json& value, lacquer_options& to) {
       if (value.is_string()) to.trial.node = value.get<std::string>();
       return value.is_string();
     }},
    {"time", "a number",
     [](const Json& value, lacquer_options& to) {
       if (value.is_number()) to.trial.time = value.get<double>();
       return value.is_number();
     }},
    {"frame", "a number",
     [](const Json& value, lacquer_options& to) {
       if (value.is_number()) to.trial.frame = value.get<double>();
       return value.is_number();
     }},
    {"as", "\"color\", \"vector\" or \"grey\"", setLook},
    {"scale", "a number",
     [](const Json& value, lacquer_options& to) {
       if (value.is_number()) to.look.scale = value.get<double>();
       return value.is_number();
     }},
    {"texels", kTexts, [](const Json& value, lacquer_options& to) { return readStrings(value, to.texels); }},
};

Result<lacquer_options> readOptions(std::string_view text) {
  lacquer_options options = defaults();
  if (const Result<void> read = readRows(text, "options", kRows, options); !read)
    return tl::make_unexpected(read.error());
  return options;
}

}  // namespace

const lacquer_options& optionsOf(const lacquer_options* options) {
  static const lacquer_options kDefaults = defaults();
  return options == nullptr ? kDefaults : *options;
}

}  // namespace lacquer::c

using namespace lacquer::c;

lacquer_options* lacquer_options_new(const char* json, size_t size, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_options*>(nullptr),
                 [&](lacquer::Messages& to) -> lacquer_options* {
                   auto options = readOptions(bytesOf(json, size));
                   if (options) return new lacquer_options(std::move(*options));
                   lacquer::report(options.error(), "options", to);
                   return nullptr;
                 });
}
void lacquer_options_free(lacquer_options* options) { delete options; }
