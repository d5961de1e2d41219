#include "bench/loops.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "cost/cost.h"
#include "graph/graph.h"
#include "ir/loops.h"
#include "ir/work.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "schedule/schedule.h"
#include "targets/target.h"

namespace lacquer::bench {

namespace {

constexpr const char* kShared = R"(
/// The bits of a cell.
/// source: this benchmark
node bench_hash(int x, int y, int z) -> uint {
    uint h = uint(x) * 0x9e3779b9 + uint(y) * 0x85ebca6b + uint(z) * 0xc2b2ae35;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6d;
    h = (h ^ (h >> 12u)) * 0x297a2d39;
    return h ^ (h >> 15u);
}
/// A number in [0, 1] for a cell.
/// source: this benchmark
node bench_number(int x, int y, int z) -> float { return float(bench_hash(x, y, z) & 65535u) / 65535; }
/// Numbers at the corners of a cell, blended.
/// source: this benchmark
node bench_value_noise(vec3 p in [-10000, 10000]) -> float {
    vec3 cell = floor(p);
    vec3 t = (p - cell) * (p - cell) * (3 - 2 * (p - cell));
    int x = int(cell.x);
    int y = int(cell.y);
    int z = int(cell.z);
    float low = mix(mix(bench_number(x, y, z), bench_number(x + 1, y, z), t.x),
                    mix(bench_number(x, y + 1, z), bench_number(x + 1, y + 1, z), t.x), t.y);
    float high = mix(mix(bench_number(x, y, z + 1), bench_number(x + 1, y, z + 1), t.x),
                     mix(bench_number(x, y + 1, z + 1), bench_number(x + 1, y + 1, z + 1), t.x), t.y);
    return mix(low, high, t.z);
}
/// A corner's gradient times the way to it.
/// source: this benchmark
node bench_gradient(int x, int y, int z, vec3 p) -> float {
    uint h = bench_hash(x, y, z);
    float u = (h & 8u) == 0u ? p.x : p.y;
    float v = (h & 12u) == 0u ? p.y : ((h & 13u) == 12u ? p.x : p.z);
    return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}
/// Gradients at the corners of a cell, blended.
/// source: this benchmark
node bench_gradient_noise(vec3 p in [-10000, 10000]) -> float {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec3 t = f * f * f * (f * (f * 6 - 15) + 10);
    int x = int(cell.x);
    int y = int(cell.y);
    int z = int(cell.z);
    float low = mix(mix(bench_gradient(x, y, z, f), bench_gradient(x + 1, y, z, f - vec3(1, 0, 0)), t.x),
                    mix(bench_gradient(x, y + 1, z, f - vec3(0, 1, 0)), bench_gradient(x + 1, y + 1, z, f - vec3(1, 1, 0)), t.x), t.y);
    float high = mix(mix(bench_gradient(x, y, z + 1, f - vec3(0, 0, 1)), bench_gradient(x + 1, y, z + 1, f - vec3(1, 0, 1)), t.x),
                     mix(bench_gradient(x, y + 1, z + 1, f - vec3(0, 1, 1)), bench_gradient(x + 1, y + 1, z + 1, f - vec3(1, 1, 1)), t.x), t.y);
    return mix(low, high, t.z);
}
)";

struct Work {
  const char* name;
  const char* round;  ///< over `p`, `f` in its cell, and `i`; it assigns `sum`, `scale` and `q`
};

constexpr Work kWorks[] = {
    {"waves", "sum += scale * sin(dot(q, vec3(1.7, 2.3, 1.1)) + float(i)); q *= 2; scale *= 0.5;"},
    {"texture", "sum += scale * texture(map, q.xy + vec2(float(i), 1) * 0.01).x; scale *= 0.5; q = q.yzx;"},
    {"cell noise", "sum += scale * bench_number(int(floor(q.x)), int(floor(q.y)), i); q *= 2; scale *= 0.5;"},
    {"Worley row",
     "for (int x = -1; x <= 1; ++x) {"
     "    uint h = bench_hash(int(cell.x) + x, int(cell.y) + i, int(cell.z));"
     "    vec3 d = vec3(float(x), float(i), 0) + vec3(float(h & 1023u), float((h >> 10u) & 1023u),"
     "                                                float((h >> 20u) & 1023u)) / 1023 - q;"
     "    scale = min(scale, dot(d, d));"
     "}"
     "sum = scale; q = q + 0.001;"},
    {"value noise", "sum += scale * bench_value_noise(q); q *= 2; scale *= 0.5;"},
    {"gradient noise", "sum += scale * bench_gradient_noise(q); q *= 2; scale *= 0.5;"},
};

constexpr int kRounds[] = {2, 3, 4, 6, 8, 12, 16, 27};

std::string nodeName(size_t work, int rounds) { return fmt::format("bench_loop_{}_{}", work, rounds); }

std::string sourceOf(size_t work, int rounds) {
  return fmt::format(R"(
/// A loop.
/// source: this benchmark
node {}(sampler2D map, vec2 uv) -> vec3 {{
    vec3 p = clamp(vec3(uv * 8, uv.x * uv.y), -1000, 1000);
    vec3 cell = floor(p);
    vec3 q = p - cell;
    float scale = 0.5;
    float sum = texture(map, uv + cell.xy * 0.0).x;
    for (int i = 0; i < {}; ++i) {{ {} }}
    return vec3(sum + scale * 0.001 + q.x * 0.001);
}}
)",
                     nodeName(work, rounds), rounds, kWorks[work].round);
}

template <class T>
T checked(Result<T> result) {
  if (!result) throw std::runtime_error(format(result.error().at(0)));
  return std::move(*result);
}

ir::Module moduleOf(const lang::Library& library, const std::string& node, double written_cycles) {
  graph::Graph graph;
  graph.template_name = "forward";
  graph::Texture map;
  map.name = "map";
  graph.textures.push_back(map);
  graph.add("loop", node, {{"map", {graph::TextureRef{"map"}, {}}}, {"uv", {graph::GivenRef{"uv0"}, {}}}});
  graph.attributes = {"TEXCOORD_0"};
  auto& [output, source] = graph.outputs.emplace_back();
  output = "emission";
  source.from = graph::NodeRef{"loop", {}};
  lower::LowerOptions options;
  options.loops.written_cycles = written_cycles;
  ir::Module module = checked(lower::lower(graph, library, options));
  passes::runPipeline(module, {});
  return module;
}

/// Of the body of the outermost loop, by the estimate.
double cyclesOf(const ir::Module& module) {
  const std::vector<ir::ValueId> live = ir::reachable(module, ir::Stage::Fragment);
  const ir::Loops loops(module.dag, live);
  double cycles = 0;
  for (const ir::ValueId id : live) {
    if (loops.of(id) >= 0) cycles += ir::cyclesOf(ir::workOf(module.dag, id));
  }
  return cycles;
}

cost::Subject subjectOf(const ir::Module& module, std::string name) {
  return {
      std::move(name), {}, targets::writeSpirv(module, schedule::schedule(module, ir::Stage::Fragment), {})};
}

}  // namespace

int runLoops() {
  if (const std::string why = cost::unavailable(); !why.empty()) {
    fmt::print("{}\n", why);
    return 1;
  }
  lang::Library library = lang::Library::embedded();
  std::string text = kShared;
  for (size_t work = 0; work < std::size(kWorks); ++work) {
    for (const int rounds : kRounds) text += sourceOf(work, rounds);
  }
  if (const auto added = library.add({{"loops.node", text}}); !added)
    throw std::runtime_error(format(added.error().at(0)));
  std::vector<cost::Subject> subjects;
  std::vector<double> cycles;
  for (size_t work = 0; work < std::size(kWorks); ++work) {
    for (const int rounds : kRounds) {
      const std::string node = nodeName(work, rounds);
      const ir::Module written = moduleOf(library, node, std::numeric_limits<double>::infinity());
      const ir::Module kept = moduleOf(library, node, 0);
      subjects.push_back(subjectOf(written, node + " written out"));
      subjects.push_back(subjectOf(kept, node + " kept"));
      cycles.push_back(cyclesOf(kept));
    }
  }
  const cost::Measurement measured = cost::measure(subjects, cost::kFamilies[0], false);
  fmt::print("{}, {}\n\n", measured.driver, cost::kFamilies[0]);
  fmt::print("{:15} {:>6} {:>9} {:>9}   {:>8} {:>8} {:>6}   {:>8} {:>8} {:>6}\n", "body", "rounds",
             "estimate", "all", "instr.", "cycles", "VGPRs", "instr.", "cycles", "VGPRs");
  for (size_t i = 0; i < cycles.size(); ++i) {
    const int rounds = kRounds[i % std::size(kRounds)];
    fmt::print("{:15} {:6} {:9.0f} {:9.0f}", kWorks[i / std::size(kRounds)].name, rounds, cycles[i],
               cycles[i] * rounds);
    for (const size_t form : {2 * i, 2 * i + 1}) {
      const auto& statistics = measured.outcomes[form].statistics;
      if (!statistics) throw std::runtime_error(measured.outcomes[form].problem);
      fmt::print("   {:8} {:8} {:6}", statistics->instructions, statistics->inverse_throughput,
                 statistics->vgprs);
    }
    fmt::print("\n");
  }
  return 0;
}

}  // namespace lacquer::bench
