#include "manifest/levels.h"

#include "interface/entry.h"

namespace lacquer {

namespace {

Json differenceJson(const SeenDifference& seen) {
  return {{"delta_e", {{"mean", seen.delta_e}, {"p95", seen.delta_e_95}}},
          {"flip", {{"mean", seen.flip}, {"p95", seen.flip_95}}}};
}

Json levelJson(const Level& level) {
  const LevelFigures& figures = level.figures;
  Json row = {{"shader", level.shader},
              {"simplify", level.simplify},
              {"cost",
               {{"inverse_throughput", figures.cycles},
                {"quarter_rate", figures.quarter_cycles},
                {"instructions", figures.instructions},
                {"vertex_inverse_throughput", figures.vertex_cycles},
                {"counted", figures.cost}}},
              {"error", differenceJson(figures.error)}};
  const auto add = [&](const char* name, const std::optional<SeenDifference>& seen) {
    if (seen) row[name] = differenceJson(*seen);
  };
  add("error_on_geometry", figures.error_on_geometry);
  if (level.screen_size == 0) return row;
  row["screen_size"] = level.screen_size;
  add("error_at_screen_size", level.error_at_screen_size);
  add("error_on_geometry_at_screen_size", level.error_on_geometry_at_screen_size);
  return row;
}

}  // namespace

Json levelsJson(const std::vector<MaterialLevels>& materials) {
  Json all = Json::array();
  for (const MaterialLevels& material : materials) {
    Json levels = Json::array();
    for (const Level& level : material.levels) levels.push_back(levelJson(level));
    all.push_back({{"source", material.file},
                   {"material", material.index},
                   {"name", material.name},
                   {"uniforms", namedJson(material.uniforms)},
                   {"measured", material.measured},
                   {"triangles", material.triangles},
                   {"radius", material.radius},
                   {"levels", std::move(levels)}});
  }
  return all;
}

}  // namespace lacquer
