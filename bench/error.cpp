#include "bench/error.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "bench/error_colors.h"
#include "bench/error_physics.h"
#include "bench/error_plot.h"
#include "bench/error_subjects.h"
#include "bench/error_times.h"
#include "bench/error_wholes.h"
#include "bench/page.h"
#include "cost/cost.h"
#include "lacquer.h"
#include "support/file.h"

namespace lacquer::bench {
namespace {

using Json = nlohmann::ordered_json;

const std::string kRoot = LACQUER_SOURCE_FOLDER;
constexpr size_t kPoints = 100000;
constexpr uint64_t kSeed = 5;
constexpr const char* kFamily = "navi21";
/// The search for the worst colour may miss a little.
constexpr double kMargin = 1.1;

struct Measured {
  std::string node, variant;
  Difference e1;
  std::string e1_at;
  std::optional<Difference> e2, e3;
  std::string e2_at, e3_what;
  std::array<double, 2> color{};                     ///< worst relative error of a colour, with the margin
  cost::Statistics alone;                            ///< around the body alone
  std::optional<double> nanoseconds;                 ///< of the body alone on lavapipe
  int64_t instructions = 0, inverse_throughput = 0;  ///< more in a whole material than with the reference
  std::string in;  ///< the profile of that material; empty when none uses the node
};

// -- errors --

Measured errorsOf(const lang::Library& library, const Subject& subject, const std::string& body) {
  Measured m;
  m.node = subject.node;
  m.variant = body;
  const ir::Module module = moduleOf(library, subject, body);
  const eval::Columns columns = sampleInputs(subject, kPoints, kSeed);
  const auto at = [&](const Spread& spread) { return describeInputs(subject, columns, spread.at / 3); };
  const eval::Columns floats = roundedInputs(columns);
  m.e1 = differenceOf(valuesOf<float>(module, floats, kPoints), valuesOf<double>(module, floats, kPoints));
  m.e1_at = at(m.e1.ulp);
  if (!body.empty()) {
    const ir::Module reference = moduleOf(library, subject, "");
    m.e2 = differenceOf(valuesOf<double>(module, columns, kPoints),
                        valuesOf<double>(reference, columns, kPoints));
    m.e2_at = at(m.e2->absolute);
    for (const bool any_ior : {true, false}) {
      m.color[any_ior ? 0 : 1] = worstColorError(library, subject.node, body, any_ior) * kMargin;
    }
  }
  if (const std::optional<Truth> truth = truthOf(subject)) {
    m.e3 = differenceOf(valuesOf<double>(module, truth->columns, truth->points), truth->values);
    m.e3_what = truth->what;
  }
  return m;
}

/// Of every body, in their order; nodes side by side.
std::vector<Measured> allErrors(const lang::Library& library, const std::vector<Subject>& all) {
  std::vector<std::vector<Measured>> of(all.size());
  std::vector<std::future<void>> workers;
  std::atomic<size_t> next = 0;
  for (unsigned i = 0; i < std::max(std::thread::hardware_concurrency(), 1U); ++i) {
    workers.push_back(std::async(std::launch::async, [&] {
      for (size_t k = next++; k < all.size(); k = next++) {
        for (const std::string& body : all[k].bodies) {
          fmt::print(stderr, "{} {}\n", all[k].node, body);
          of[k].push_back(errorsOf(library, all[k], body));
        }
      }
    }));
  }
  for (std::future<void>& worker : workers) worker.get();
  std::vector<Measured> measured;
  for (std::vector<Measured>& one : of) measured.insert(measured.end(), one.begin(), one.end());
  return measured;
}

// -- costs --

cost::Statistics statistics(const cost::Outcome& outcome, const std::string& what) {
  if (!outcome.statistics) throw std::runtime_error(what + ": " + outcome.problem);
  return *outcome.statistics;
}

/// A whole material to measure a node in.
struct Work {
  const char* file;
  const char* profile;
  bool decode_srgb, dfg_table;
};
constexpr std::array kWorks = {Work{"w3.gltf", "khr", false, true}, Work{"w3.gltf", "openpbr", false, true},
                               Work{"w2.gltf", "khr", true, true}, Work{"w3.gltf", "khr", false, false}};

/// The work with every use of a node in a variant; nothing when its graph has none.
std::optional<cost::Subject> materialWith(const Work& work, const std::string& node,
                                          const std::string& variant) {
  Options options;
  options.profile = work.profile;
  options.decode_srgb = work.decode_srgb;
  options.dfg_table = work.dfg_table;
  options.targets = {Target::Spirv};
  options.lights.mode = Lights::Mode::Fixed;
  options.lights.counts = {{"directional", 1}};
  options.validate = false;
  Messages messages;
  const Scene scene = Scene::load(kRoot + "/bench/works/" + work.file, options, messages);
  if (!scene) throw std::runtime_error(std::string(work.file) + " cannot be read");
  Json json = Json::parse(scene.graph(0, scene.uses(0)[0], options, messages).toJson());
  bool used = false;
  for (Json& one : json["nodes"]) {
    if (one["node"] != node) continue;
    used = true;
    if (!variant.empty()) one["variant"] = variant;
  }
  if (!used) return std::nullopt;
  const lacquer::Shader shader =
      Graph::fromJson(json.dump(), work.file, messages).generate(options, messages);
  if (!shader) throw std::runtime_error(node + "::" + variant + ": " + messages.at(0).text);
  return cost::Subject{node + " " + variant, shader.vertexSpirv(), shader.fragmentSpirv()};
}

/// What W3 costs under each profile, by profile.
std::map<std::string, cost::Statistics> profileCosts(const lang::Library& library) {
  std::vector<cost::Subject> whole;
  std::vector<std::string> names;
  for (const std::string_view profile : library.names(lang::DeclKind::Profile)) {
    names.emplace_back(profile);
    std::optional<cost::Subject> material =
        materialWith({"w3.gltf", names.back().c_str(), false, true}, "half_vector", "");
    if (!material) throw std::runtime_error("W3 has no half vector");
    whole.push_back(std::move(*material));
  }
  const cost::Measurement measurement = cost::measure(whole, kFamily, false);
  std::map<std::string, cost::Statistics> costs;
  for (size_t i = 0; i < names.size(); ++i) costs[names[i]] = statistics(measurement.outcomes[i], names[i]);
  return costs;
}

/// How long each body runs on this machine's processor; the driver's name.
std::string measureTimes(const lang::Library& library, const std::vector<Subject>& all,
                         std::vector<Measured>& measured) {
  const Times times = lavapipeTimes(library, all);
  if (!times.problem.empty()) fmt::print(stderr, "no times: {}\n", times.problem);
  for (size_t i = 0; i < times.nanoseconds.size(); ++i) measured[i].nanoseconds = times.nanoseconds[i];
  return times.device;
}

/// Every body alone, and in a whole material, in two runs of the driver.
std::string measureCosts(const lang::Library& library, const std::vector<Subject>& all,
                         std::vector<Measured>& measured) {
  std::vector<cost::Subject> alone;
  std::vector<cost::Subject> whole;
  std::vector<std::pair<size_t, size_t>> pairs;  // of `whole`, with the variant and with the reference
  size_t row = 0;
  for (const Subject& subject : all) {
    std::optional<size_t> reference;
    for (const std::string& body : subject.bodies) {
      Measured& m = measured[row++];
      alone.push_back({subject.node + " " + body, {}, bodyOf(moduleOf(library, subject, body)).spirv});
      pairs.emplace_back(0, 0);
      for (const Work& work : kWorks) {
        std::optional<cost::Subject> material = materialWith(work, subject.node, body);
        if (!material) continue;
        m.in = fmt::format("{}, {}", work.file, work.profile);
        if (!reference) reference = whole.size();
        pairs.back() = {whole.size(), *reference};
        whole.push_back(std::move(*material));
        break;
      }
    }
  }
  const cost::Measurement small = cost::measure(alone, kFamily, false);
  const cost::Measurement large = cost::measure(whole, kFamily, false);
  for (size_t i = 0; i < measured.size(); ++i) {
    measured[i].alone = statistics(small.outcomes[i], alone[i].name);
    if (measured[i].in.empty()) continue;
    const auto& [with, without] = pairs[i];
    const cost::Statistics a = statistics(large.outcomes[with], whole[with].name);
    const cost::Statistics b = statistics(large.outcomes[without], whole[without].name);
    measured[i].instructions = static_cast<int64_t>(a.instructions) - static_cast<int64_t>(b.instructions);
    measured[i].inverse_throughput =
        static_cast<int64_t>(a.inverse_throughput) - static_cast<int64_t>(b.inverse_throughput);
  }
  return small.driver;
}

// -- what is written --

/// Three digits: what lies behind them may be another on another machine.
double rounded(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double scale = std::pow(10, 2 - std::floor(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

/// Upwards, so that a bound stays one.
double roundedUp(double x) {
  if (x == 0) return x;
  const double scale = std::pow(10, 2 - std::floor(std::log10(x)));
  return std::ceil(x * scale) / scale;
}

std::string number(double x) { return x == 0 ? "0" : fmt::format("{:.3g}", rounded(x)); }

Json toJson(const Spread& s) {
  return {{"max", number(s.max)}, {"p999", number(s.p999)}, {"rms", number(s.rms)}};
}

Json toJson(const Difference& d, const std::string& at) {
  Json json = {{"absolute", toJson(d.absolute)}, {"ulp", toJson(d.ulp)}};
  if (!at.empty()) json["at"] = at;
  return json;
}

/// Times are not the same twice: two digits.
std::string timeText(const std::optional<double>& nanoseconds) {
  return nanoseconds ? fmt::format("{:.{}f}", *nanoseconds, *nanoseconds < 10 ? 1 : 0) : "";
}

Json toJson(const std::vector<Measured>& measured, const std::vector<Whole>& whole, const std::string& driver,
            const std::string& device) {
  Json json;
  json["driver"] = driver;
  json["device"] = device;
  json["gpu"] = kFamily;
  json["points"] = kPoints;
  for (const Whole& one : whole) {
    json["profiles"][one.profile][one.environment ? "environment" : "light"] = {{"e1", toJson(one.rounding)},
                                                                                {"e3", toJson(one.physics)}};
  }
  for (const Measured& m : measured) {
    Json& row = json["nodes"][m.node][m.variant.empty() ? "reference" : m.variant];
    row["e1"] = toJson(m.e1, m.e1_at);
    if (m.e2) row["e2"] = toJson(*m.e2, m.e2_at);
    if (m.e3) row["e3"] = toJson(*m.e3, "");
    if (m.e3) row["e3"]["against"] = m.e3_what;
    if (!m.variant.empty()) {
      row["color"] = {{"any_ior", fmt::format("{:.3g}", roundedUp(m.color[0]))},
                      {"ior_1.5", fmt::format("{:.3g}", roundedUp(m.color[1]))}};
    }
    row["alone"] = {{"instructions", m.alone.instructions},
                    {"inverse_throughput", m.alone.inverse_throughput}};
    if (m.nanoseconds) row["alone"]["lavapipe_ns"] = timeText(m.nanoseconds);
    if (!m.in.empty()) {
      row["in_material"] = {
          {"material", m.in}, {"instructions", m.instructions}, {"inverse_throughput", m.inverse_throughput}};
    }
  }
  return json;
}

/// "max / 99.9 % / RMS"
std::string triple(const Spread& s) {
  return fmt::format("{} / {} / {}", number(s.max), number(s.p999), number(s.rms));
}

/// What whole shaders are wrong by.
std::string wholeTable(const std::vector<Whole>& whole) {
  std::string text =
      "\n### Whole shaders\n\n"
      "| profile | under | E1 of the colour | E3 of the coat's transmission |\n|---|---|---|---|\n";
  for (const Whole& one : whole) {
    text += fmt::format("| `{}` | {} | {} | {} |\n", one.profile,
                        one.environment ? "a white environment" : "one light", triple(one.rounding),
                        triple(one.physics));
  }
  return text;
}

/// The page has the variants that a reader may choose, with what decides; bench/error.json has all.
std::string markdown(const std::vector<Measured>& measured, const std::vector<Whole>& whole,
                     const std::string& driver) {
  std::string text = fmt::format("{}, {}; {} points.\n", driver, kFamily, kPoints);
  text += wholeTable(whole);
  text +=
      "\n### Variants that are cheaper or nearer to physics\n\n"
      "| node | variant | E2: largest / RMS | E3, RMS: its / the reference's | colour | cycles | in a "
      "material |\n"
      "|---|---|---|---|---|---|---|\n";
  const Measured* reference = nullptr;
  for (const Measured& m : measured) {
    if (m.variant.empty()) {
      reference = &m;
      continue;
    }
    const bool used = !m.in.empty();
    const bool cheaper = m.alone.inverse_throughput < reference->alone.inverse_throughput ||
                         (used && m.inverse_throughput < 0);
    const bool nearer = m.e3 && reference->e3 && m.e3->absolute.rms < 0.99 * reference->e3->absolute.rms;
    if (!cheaper && !nearer) continue;
    text += fmt::format(
        "| `{}` | `{}` | {} | {} | {} | {} of {} | {} |\n", m.node, m.variant,
        m.e2 ? fmt::format("{} / {}", number(m.e2->absolute.max), number(m.e2->absolute.rms)) : "",
        m.e3 ? fmt::format("{} / {}", number(m.e3->absolute.rms), number(reference->e3->absolute.rms)) : "",
        used ? fmt::format("{:.3g} / {:.3g}", roundedUp(m.color[0]), roundedUp(m.color[1])) : "",
        m.alone.inverse_throughput, reference->alone.inverse_throughput,
        used ? fmt::format("{:+} / {:+}", m.instructions, m.inverse_throughput) : "");
  }
  return text;
}

/// Rounding in double is no error of a body.
double shown(double error) { return error < 1e-9 ? 0 : rounded(error); }

std::string svg(const std::vector<Measured>& measured) {
  std::vector<Panel> panels;
  for (const Measured& m : measured) {
    if (panels.empty() || panels.back().title != m.node) panels.push_back({m.node, {}});
    panels.back().points.push_back({m.variant.empty() ? "reference" : m.variant,
                                    static_cast<double>(m.alone.inverse_throughput),
                                    shown(m.e2 ? m.e2->absolute.rms : 0)});
  }
  return plot(panels, "cycles of inverse throughput", "E2, RMS");
}

std::string wholeSvg(const std::vector<Whole>& whole, const std::map<std::string, cost::Statistics>& costs) {
  std::vector<Panel> panels = {{"W3 under one light", {}}, {"W3 under an environment", {}}};
  for (const Whole& one : whole) {
    panels[one.environment ? 1 : 0].points.push_back(
        {one.profile, static_cast<double>(costs.at(one.profile).inverse_throughput), shown(one.physics.rms)});
  }
  return plot(panels, "cycles of inverse throughput", "E3, RMS");
}

}  // namespace

int runError() {
  if (const std::string reason = cost::unavailable(); !reason.empty()) {
    fmt::print(stderr, "bench error: {}\n", reason);
    return 1;
  }
  lang::Library library = lang::Library::embedded();
  const std::vector<Subject> all = subjects(library);
  if (const Result<void> added = library.add({wrappers(all)}); !added) {
    for (const Diagnostic& d : added.error()) fmt::print(stderr, "{}\n", format(d));
    return 1;
  }
  std::vector<Measured> measured = allErrors(library, all);
  const std::string driver = measureCosts(library, all, measured);
  const std::string device = measureTimes(library, all, measured);
  fmt::print(stderr, "whole shaders\n");
  const std::vector<Whole> whole = wholes(library, kPoints);
  const std::string page = markdown(measured, whole, driver);
  fmt::print("{}", page);
  const bool written =
      writeFile(kRoot + "/bench/error.json", toJson(measured, whole, driver, device).dump(2) + "\n") &&
      writeFile(kRoot + "/docs/images/error.svg", svg(measured)) &&
      writeFile(kRoot + "/docs/images/error-coats.svg", wholeSvg(whole, profileCosts(library))) &&
      renewPage(kRoot + "/docs/error.md", page);
  if (written) return 0;
  fmt::print(stderr, "bench error: the files could not be renewed\n");
  return 1;
}

}  // namespace lacquer::bench
