#include "bench/error_subjects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include "lower/lower.h"
#include "passes/passes.h"
#include "passes/pipeline.h"
#include "targets/target.h"

namespace lacquer::bench {

namespace {

/// An index of refraction is measured up to here, though contracts let it be anything.
constexpr double kIorMax = 4;
/// Lights and lobes have no end; so far is measured.
constexpr double kBrightest = 1000;

std::string replaced(std::string text, const std::string& by) {
  for (size_t at = 0; (at = text.find('@', at)) != std::string::npos; at += by.size())
    text.replace(at, 1, by);
  return text;
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Inputs of a lobe hang together: they come from three directions.
const std::map<std::string, Subject>& geometric() {
  static const std::map<std::string, Subject> kGeometric = {
      {"ggx_distribution",
       {"",
        {},
        {{"IN_N", 3, -1, 1, true},
         {"IN_V", 3, -1, 1, true},
         {"IN_L", 3, -1, 1, true},
         {"alpha", 1, 0.001, 1}},
        "    given in_half = half_vector(IN_V, IN_L);\n",
        "@(IN_N, in_half.sum, in_half.length2, dot(IN_N, in_half.sum), in_alpha)",
        "@.numerator / max(@.denominator, MIN_LOBE)"}},
  };
  return kGeometric;
}

/// What is measured of a node with several results.
std::string resultOf(const lang::NodeDecl& node) {
  if (node.name == "environment_brdf_fit") return "0.5 * @.scale + @.bias";  // what an F0 of 0.5 reflects
  if (node.name == "smith_visibility_split") return "@.sum / @.weight";
  if (node.name == "film_interference") return "@.first + @.second";
  if (node.name.starts_with("film_fresnel_pair")) return "0.5 * (@.dielectric + @.metal)";
  return node.results[0].type == ir::Type::Vec4 ? "@.rgb" : "@";
}

Subject generic(const lang::NodeDecl& node) {
  Subject subject;
  subject.call = "@(";
  for (const lang::Param& param : node.params) {
    SubjectInput input{std::string(param.name), ir::componentCount(param.type)};
    if (param.has_range) {
      input.lo = param.range.lo;
      input.hi = param.name == "ior" ? kIorMax : std::min(param.range.hi, kBrightest);
      if (param.name == "ior") input.lo = 1;
      if (param.name.find("cos") != std::string_view::npos ||
          param.name.find("dot") != std::string_view::npos)
        input.hi = std::min(input.hi, 1.0);
    }
    subject.call += (subject.inputs.empty() ? "in_" : ", in_") + input.name;
    subject.inputs.push_back(input);
  }
  subject.call += ")";
  subject.result = resultOf(node);
  return subject;
}

std::string typeName(int components) {
  return components == 1 ? std::string("float") : fmt::format("vec{}", components);
}

std::string templateName(const Subject& subject, const std::string& body) {
  std::string node = subject.node;  // a form of an overloaded node has its types behind it: mix<vec3>
  for (char& c : node) c = c == '<' || c == '>' || c == ',' ? '_' : c;
  return fmt::format("bench_{}_{}", node, body.empty() ? "reference" : body);
}

}  // namespace

std::vector<Subject> subjects(const lang::Library& library) {
  std::vector<Subject> all;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const Result<const lang::NodeDecl*> node = library.node(name);
    // The other bodies of patterns are for a pixel's size, not for a point: docs/patterns.md.
    if (!node || (*node)->variants.empty() || !(*node)->category.empty()) continue;
    const auto it = geometric().find(std::string(name));
    Subject subject = it == geometric().end() ? generic(**node) : it->second;
    subject.node = name;
    subject.bodies = {""};
    for (const lang::Variant& variant : (*node)->variants) subject.bodies.emplace_back(variant.name);
    all.push_back(std::move(subject));
  }
  return all;
}

lang::SourceFile wrappers(const std::vector<Subject>& subjects) {
  std::string text;
  for (const Subject& subject : subjects) {
    for (const std::string& body : subject.bodies) {
      text += fmt::format("/// One body.\ntemplate {} {{\n", templateName(subject, body));
      for (const SubjectInput& input : subject.inputs) {
        if (input.unit) {
          text += fmt::format("    attribute vec3 {};\n", input.name);
          continue;
        }
        text += fmt::format("    attribute {} AT_{};\n    given {} in_{} in [{}, {}] = AT_{};\n",
                            typeName(input.components), input.name, typeName(input.components), input.name,
                            input.lo, input.hi, input.name);
      }
      const std::string name = body.empty() ? subject.node : subject.node + "::" + body;
      text += subject.setup;
      text += fmt::format("    given value = {};\n", replaced(subject.call, name));
      // Both a float and a vector multiply a vec3.
      text += fmt::format("    output color vec4 o = vec4(vec3(1) * ({}), 1);\n}}\n",
                          replaced(subject.result, "value"));
    }
  }
  return {"bench.node", text};
}

eval::Columns sampleInputs(const Subject& subject, size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  eval::Columns columns;
  for (const SubjectInput& input : subject.inputs) {
    std::vector<double> values;
    for (size_t i = 0; i < count; ++i) {
      if (input.unit) {
        // The upper half, and often near the pole: a lobe lives where the directions meet.
        const double z = 1 - uniform(random) * (uniform(random) < 0.5 ? 0.02 : 1);
        const double phi = 6.283185307179586 * uniform(random);
        const double s = std::sqrt(std::max(1 - z * z, 0.0));
        values.insert(values.end(), {s * std::cos(phi), s * std::sin(phi), z});
        continue;
      }
      for (int c = 0; c < input.components; ++c) {
        const double kind = uniform(random);
        const double u = uniform(random);
        const double x = kind < 0.03 ? 0 : kind < 0.06 ? 1 : kind < 0.3 ? u * u * u : u;
        values.push_back(input.lo + (input.hi - input.lo) * x);
      }
    }
    columns[input.unit ? input.name : "AT_" + input.name] =
        eval::Column::perPoint(input.unit ? 3 : input.components, std::move(values));
  }
  return columns;
}

eval::Columns roundedInputs(eval::Columns columns) {
  for (auto& [name, column] : columns) {
    for (double& value : column.values) value = static_cast<double>(static_cast<float>(value));
  }
  return columns;
}

std::string describeInputs(const Subject& subject, const eval::Columns& columns, size_t point) {
  std::string text;
  for (const SubjectInput& input : subject.inputs) {
    const eval::Column& column = columns.at(input.unit ? input.name : "AT_" + input.name);
    const auto n = static_cast<size_t>(column.components);
    text += (text.empty() ? "" : ", ") + (input.unit ? input.name.substr(3) : input.name);
    for (size_t c = 0; c < n; ++c) text += fmt::format(" {:.4g}", column.values[point * n + c]);
  }
  return text;
}

Spread spreadOf(std::vector<double> values) {
  Spread spread;
  if (values.empty()) return spread;
  for (size_t i = 0; i < values.size(); ++i) {
    spread.rms += values[i] * values[i] / static_cast<double>(values.size());
    if (!(values[i] > spread.max)) continue;
    spread.max = values[i];
    spread.at = i;
  }
  spread.rms = std::sqrt(spread.rms);
  const auto place = static_cast<ptrdiff_t>(static_cast<double>(values.size() - 1) * 0.999);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  spread.p999 = values[static_cast<size_t>(place)];
  return spread;
}

Difference differenceOf(const std::vector<double>& values, const std::vector<double>& yardstick) {
  std::vector<double> absolute;
  std::vector<double> ulp;
  for (size_t i = 0; i < values.size(); ++i) {
    const double error = std::abs(values[i] - yardstick[i]);
    absolute.push_back(error);
    const int exponent = std::ilogb(std::max(std::abs(yardstick[i]), 1e-6));
    ulp.push_back(error / std::ldexp(1.0, exponent - 23));
  }
  return {spreadOf(std::move(absolute)), spreadOf(std::move(ulp))};
}

ir::Module moduleOf(const lang::Library& library, const Subject& subject, const std::string& body) {
  graph::Graph graph;
  graph.template_name = templateName(subject, body);
  for (const Diagnostic& d : graph::check(graph, library)) {
    if (d.severity == Severity::Error) throw std::runtime_error(format(d));
  }
  Result<ir::Module> module = lower::lower(graph, library, {});
  if (!module) throw std::runtime_error(format(module.error()[0]));
  return std::move(*module);
}

template <class T>
std::vector<double> valuesOf(const ir::Module& module, const eval::Columns& columns, size_t points) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  eval::Bindings bindings;
  bindings.columns = columns;
  const auto result = eval::evaluate<T>(module, roots, bindings, points);
  if (!result) throw std::runtime_error(format(result.error()[0]));
  std::vector<double> values;
  for (size_t i = 0; i < points; ++i) {
    for (size_t c = 0; c < 3; ++c) values.push_back(static_cast<double>((*result)[0][4 * i + c]));
  }
  return values;
}

template std::vector<double> valuesOf<float>(const ir::Module&, const eval::Columns&, size_t);
template std::vector<double> valuesOf<double>(const ir::Module&, const eval::Columns&, size_t);

namespace {

Body written(const ir::Module& module) {
  const schedule::Program program = schedule::schedule(module, ir::Stage::Fragment);
  Body body{targets::writeSpirv(module, program, {}), {}};
  for (const uint32_t index : program.varyings) body.inputs.push_back(module.varyings[index].name);
  return body;
}

}  // namespace

Body bodyOf(ir::Module module) {
  passes::runPipeline(module, {});
  return written(module);
}

Body overheadOf(ir::Module module) {
  passes::runPipeline(module, {});
  ir::Dag& dag = module.dag;
  ir::ValueId sum = dag.constant(0);
  for (const ir::ValueId id : ir::reachable(dag, std::array{module.outputs[0].value})) {
    if (dag[id].op != ir::Op::Input) continue;
    for (int c = 0; c < ir::componentCount(dag[id].type); ++c) sum = dag.add(sum, dag.component(id, c));
  }
  module.outputs[0].value = dag.construct(ir::Type::Vec4, {sum});
  return written(module);
}

}  // namespace lacquer::bench
