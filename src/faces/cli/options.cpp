#include "cli/options.h"

#include "cli/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "cli/checks.h"
#include "lacquer/check.h"
#include "support/letters.h"
#include "support/shown.h"

namespace lacquer::cli {

namespace {

constexpr int kMostJobs = 1024;  ///< more threads than that are a mistyped number

/// CLI11 takes a sign and more digits than there is room for.
const CLI::Validator kPlainSize(
    [](const std::string& text) {
      constexpr size_t kDigits = 19;
      const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
      return digits == 0 || digits > kDigits ? "must be a whole number of bytes, such as 500MB" : "";
    },
    "");

/// "NAME=on" or "NAME=off", each.
std::string parseSwitches(const std::vector<std::string>& texts,
                          std::map<std::string, bool, std::less<>>& switches) {
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (equals == 0 || (value != "on" && value != "off"))
      return fmt::format("--switch: '{}' is neither NAME=on nor NAME=off", shown(text));
    switches[text.substr(0, equals)] = value == "on";
  }
  return {};
}

/// "any", "scene", "none" or "directional:1,point:4".
std::string parseLights(const std::string& text, Lights& lights) {
  using Mode = Lights::Mode;
  lights.mode = text == "any" ? Mode::Any : text == "scene" ? Mode::Scene : Mode::Fixed;
  if (lights.mode != Mode::Fixed || text == "none") return {};
  constexpr unsigned long kMostLights = 4096;  // of a block in the node language
  std::stringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const size_t colon = part.find(':');
    const std::string type = part.substr(0, colon);
    const std::string number = colon == std::string::npos ? "1" : part.substr(colon + 1);
    const bool digits = !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
    const unsigned long count = digits && number.size() < 5 ? std::stoul(number) : kMostLights + 1;
    const bool name = !type.empty() && std::all_of(type.begin(), type.end(),
                                                   [](char c) { return isLetterOrDigit(c) || c == '_'; });
    if (!name || count > kMostLights) {
      return fmt::format("--lights: '{}' is not KIND:COUNT with a kind of the template's and up to {}",
                         shown(part), kMostLights);
    }
    if (!lights.counts.emplace(type, static_cast<uint32_t>(count)).second)
      return fmt::format("--lights: '{}' is counted twice", type);
  }
  return {};
}

/// --target: names to targets, those that the parameters can be for.
std::string parseTargets(const Strings& names, Options& options) {
  const bool spec = options.parameters == Parameters::Spec;
  if (spec) std::erase_if(options.targets, [](Target one) { return !hasSpecializationConstants(one); });
  if (!names.empty()) options.targets.clear();
  for (const std::string& name : names) {
    Target target{};
    if (!findTarget(name, target)) {
      return fmt::format("--target: there is no '{}'; targets are {}", shown(name),
                         fmt::join(targetNames(), ", "));
    }
    if (spec && !hasSpecializationConstants(target)) {
      Strings with = targetNames();
      std::erase_if(with, [](const std::string& one) {
        Target id{};
        return !findTarget(one, id) || !hasSpecializationConstants(id);
      });
      return fmt::format("--target: {} has no specialization constants; --params spec is for {}", name,
                         fmt::join(with, ", "));
    }
    if (std::find(options.targets.begin(), options.targets.end(), target) == options.targets.end())
      options.targets.push_back(target);
  }
  return {};
}

}  // namespace

void addMaterialFlags(CLI::App& verb, OptionFlags& flags) {
  verb.add_option("--template", flags.options.template_name,
                  "a template of `lacquer nodes`; without it the default")
      ->check(kNotEmpty);
  verb.add_option("--profile", flags.options.profile,
                  "the reading of the specification, one of `lacquer nodes`, or materialx of MaterialX "
                  "documents; without it the default")
      ->check(kNotEmpty);
  verb.add_option(
          "--as", flags.options.as,
          "surfaces of MaterialX documents: materialx, by MaterialX's formulas, which is the default without "
          "another profile, or gltf, by glTF's properties")
      ->check(CLI::IsMember({"materialx", "gltf"}));
  verb.add_option("--params", flags.params,
                  "uniform: numbers stay editable; baked: they are constants; spec: they are specialization "
                  "constants")
      ->check(CLI::IsMember({"uniform", "baked", "spec"}))
      ->capture_default_str();
  verb.add_option("--lights", flags.lights, "any, scene, none, or fixed counts such as directional:1,point:4")
      ->check(kNotEmpty)
      ->capture_default_str();
  // Options that may be repeated take one argument each time: the next one may be a file.
  verb.add_option("--live", flags.options.live,
                  "terms to keep though today's value would remove them, and properties by JSON pointer")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--simplify", flags.options.simplify,
                  "what is left out or made simpler, such as without:coat.absorption (may be repeated)")
      ->allow_extra_args(false);
  verb.add_option("--switch", flags.switches,
                  "NAME=on or NAME=off: a switch of the node library (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--no-ibl", flags.no_ibl, "no image-based light");
  verb.add_flag("--no-multiple-scattering", flags.no_multiple_scattering,
                "do not compensate image-based light for multiple scattering");
  verb.add_option("--dfg", flags.dfg,
                  "the split sum's factors: from the texture environment_dfg, or a fit without one")
      ->check(CLI::IsMember({"table", "fit"}))
      ->capture_default_str();
  verb.add_option("--relaxed", flags.options.relaxed,
                  "the part of a colour, such as 0.01, that half precision may change (docs/intervals.md)")
      ->check(numberFrom(0, 0.5));
  verb.add_flag("--half", flags.options.half,
                "types of 16 bits for what --relaxed allows, where they are cheaper (docs/intervals.md)");
  verb.add_option("--optimize", flags.options.optimize,
                  "how hard fragment stages are searched for cheaper forms, 0 to 2 (docs/optimize.md)")
      ->check(CLI::Range(0, 2))
      ->check(kWhole);
  if (verb.get_option_no_throw("--error") == nullptr) {  // levels of detail have errors of their own
    verb.add_option("--error", flags.options.optimize_error,
                    "the part of the light that approximations of --optimize 2 may change, such as 0.001")
        ->check(numberFrom(0, 0.5));
  }
  verb.add_option("--optimize-for", flags.options.optimize_for, "the GPUs whose cycles --optimize counts")
      ->check(CLI::IsMember(optimizeFamilies()));
  verb.add_flag("--decode-srgb", flags.options.decode_srgb, "decode colour textures in the shader");
  verb.add_flag("--permissive", flags.options.permissive,
                "drop an extension that must not be there instead of failing");
  addNodeFolders(verb, flags);
  addLimit(verb, flags);
}

void addTargetFlags(CLI::App& verb, OptionFlags& flags) {
  verb.add_option("--target", flags.targets,
                  fmt::format("of {}, with commas between or repeated; the first five when absent",
                              fmt::join(targetNames(), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_flag("--no-validate", flags.no_validate, "do not compile and validate what was written");
}

void addSyncFlag(CLI::App& verb, OptionFlags& flags) {
  verb.add_flag("--no-sync", flags.no_sync,
                "do not wait for the disk: after a power cut files may be broken");
}

void addJobs(CLI::App& verb, OptionFlags& flags) {
  verb.add_option("-j,--jobs", flags.options.jobs, "threads; one for each core when absent")
      ->check(CLI::Range(0, kMostJobs))
      ->check(kWhole);
}

void addCache(CLI::App& verb, OptionFlags& flags) {
  verb.add_option("--cache", flags.options.cache, "a folder that keeps results between runs")
      ->check(kNotEmpty);
  verb.add_option("--cache-size", flags.options.cache_size, "bytes that it may take, such as 500MB (1 GiB)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(kPlainSize);
  verb.add_option("--cache-key", flags.options.cache_key,
                  "a file: entries of the cache count only when they were written with its bytes")
      ->check(kNotEmpty);
}

void addAllow(CLI::App& verb, OptionFlags& flags, const char* what) {
  verb.add_option("--allow", flags.options.allow,
                  fmt::format("a folder in which {} may lie, beside the file's own (may be repeated)", what))
      ->check(kNotEmpty)
      ->allow_extra_args(false);
}

void addNodeFolders(CLI::App& verb, OptionFlags& flags) {
  verb.add_option("--nodes", flags.options.node_directories,
                  "a folder with more node files (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
  verb.add_option("--materialx", flags.options.materialx_directories,
                  "a folder with MaterialX definitions that documents may use (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
}

void addLimit(CLI::App& verb, OptionFlags& flags) {
  verb.add_option(
          "--limit", flags.options.limits,
          "NAME=NUMBER: what an input may be at most, such as images=1G (docs/security.md; may be repeated)")
      ->check(kLimit)
      ->allow_extra_args(false);
}

bool haveGoodWords(const Options& options) {
  if (options.live.empty() && options.simplify.empty() && options.switches.empty() && options.profile.empty())
    return true;
  Messages wrong;
  if (checkOptions(options, wrong)) return true;
  if (std::any_of(wrong.begin(), wrong.end(), [](const Message& one) { return !one.file.empty(); }))
    return true;
  print(wrong);
  return false;
}

std::string finish(OptionFlags& flags) {
  Options& options = flags.options;
  options.validate = !flags.no_validate;
  options.sync = !flags.no_sync;
  options.ibl = !flags.no_ibl;
  options.multiple_scattering = !flags.no_multiple_scattering;
  options.dfg_table = flags.dfg == "table";
  options.parameters = flags.params == "baked"  ? Parameters::Baked
                       : flags.params == "spec" ? Parameters::Spec
                                                : Parameters::Uniform;
  options.binding = flags.binding == "sets"       ? BindingModel::Sets
                    : flags.binding == "bindless" ? BindingModel::Bindless
                                                  : BindingModel::Arrays;
  options.spirv_route = flags.spirv_from == "direct" ? SpirvRoute::Direct : SpirvRoute::Glslang;
  for (const auto& wrong :
       {parseTargets(flags.targets, options), parseSwitches(flags.switches, options.switches),
        parseLights(flags.lights, options.lights)}) {
    if (!wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace lacquer::cli
