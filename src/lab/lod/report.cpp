#include "lod/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "preview/sheet.h"
#include "setting/simplify.h"

namespace lacquer {

namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  }
  return result;
}

constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Levels of detail</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 64em; padding: 0 1em; color: #222 }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums }
th, td { padding: .3em .6em; border-bottom: 1px solid #ddd; text-align: right; vertical-align: top }
th:first-child, td:first-child, td:last-child, th:last-child { text-align: left }
figure { display: inline-block; margin: .6em 1em .6em 0 }
img { image-rendering: pixelated; max-width: 100% }
figcaption, .quiet { color: #666; font-size: 13px }
ul { margin: 0; padding-left: 1.1em }
</style>
)";

/// A round number of steps for an axis that ends at `most`.
double stepOf(double most) {
  const double raw = most / 5;
  const double power = std::pow(10, std::floor(std::log10(std::max(raw, 1e-9))));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10 * power;
}

/// Cost across, error upwards, both from 0: everything that was measured, and the levels on the line of the
/// best.
class Plot {
public:
  explicit Plot(const LodChain& chain) : chain_(chain) {
    for (const lod::Tried& one : chain.tried) cost_ = std::max(cost_, one.cost);
    for (const Level& level : chain.found.levels)
      error_ = std::max(error_, 1.5 * level.figures.error.delta_e);
    cost_ *= 1.05;
    error_ = std::max(error_, 0.5);
  }

  std::string svg() const {
    std::string text = fmt::format(
        "<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" font-size=\"12\" "
        "font-family=\"sans-serif\">\n<title>Error against cost</title>\n",
        kWidth, kHeight, kWidth, kHeight);
    text += axes();
    for (const lod::Tried& one : chain_.tried) {
      if (one.error <= error_)
        text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"#bbb\"/>\n", x(one.cost),
                            y(one.error));
    }
    std::string line;
    for (const lod::Tried& one : chain_.best) {
      if (one.error <= error_) line += fmt::format("{:.1f},{:.1f} ", x(one.cost), y(one.error));
    }
    text += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#888\"/>\n", line);
    for (size_t i = 0; i < chain_.found.levels.size(); ++i) {
      const LevelFigures& f = chain_.found.levels[i].figures;
      const double cost = static_cast<double>(f.cycles);
      text += fmt::format(
          "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\" fill=\"#c33\"/>"
          "<text x=\"{2:.1f}\" y=\"{3:.1f}\" fill=\"#c33\">{4}</text>\n",
          x(cost), y(f.error.delta_e), x(cost) + 8, y(f.error.delta_e) - 6, i);
    }
    return text + "</svg>\n";
  }

private:
  static constexpr int kWidth = 640, kHeight = 320, kLeft = 56, kRight = 16, kTop = 12, kBottom = 40;

  double x(double cost) const { return kLeft + cost / cost_ * (kWidth - kLeft - kRight); }
  double y(double error) const { return kHeight - kBottom - error / error_ * (kHeight - kTop - kBottom); }

  std::string axes() const {
    std::string text;
    for (double c = 0, step = stepOf(cost_); c <= cost_; c += step)
      text += fmt::format(
          "<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" stroke=\"#eee\"/>"
          "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
          x(c), kTop, kHeight - kBottom, kHeight - kBottom + 15, c);
    for (double e = 0, step = stepOf(error_); e <= error_; e += step)
      text += fmt::format(
          "<line x1=\"{1}\" y1=\"{0:.1f}\" x2=\"{2}\" y2=\"{0:.1f}\" stroke=\"#eee\"/>"
          "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
          y(e), kLeft, kWidth - kRight, kLeft - 6, y(e) + 4, e);
    text +=
        fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">cycles of inverse throughput</text>\n",
                    (kLeft + kWidth - kRight) / 2, kHeight - 6);
    text += fmt::format(
        "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">mean colour "
        "difference</text>\n",
        (kTop + kHeight - kBottom) / 2);
    return text;
  }

  const LodChain& chain_;
  double cost_ = 1, error_ = 0;
};

std::string screenText(uint32_t screen) {
  return screen == 0 ? std::string("any size") : fmt::format("{} pixels and less", screen);
}

std::string rowOf(const LodChain& chain, size_t i, const lang::Library& library) {
  const Level& level = chain.found.levels[i];
  const LevelFigures& f = level.figures;
  std::string changes;
  for (const std::string& word : level.simplify)
    changes += fmt::format("<li title=\"{}\">{}</li>", escaped(word), escaped(described(word, library)));
  const double part = 100 * f.cost / chain.found.levels[0].figures.cost;
  std::string on_mesh;
  if (chain.found.triangles > 0) {
    const SeenDifference at_size = level.error_on_geometry_at_screen_size.value_or(SeenDifference{});
    on_mesh = fmt::format("<td>{:.2f}</td><td>{:.2f}</td>",
                          f.error_on_geometry.value_or(SeenDifference{}).delta_e, at_size.delta_e);
  }
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td>{} ({:.0f} %)</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2f} / "
      "{:.2f}</td><td>{:.3f} / "
      "{:.3f}</td><td>{:.2f} / {:.2f}</td>{}<td>{}</td></tr>\n",
      i, screenText(level.screen_size), f.cycles, part, f.vertex_cycles, f.quarter_cycles, f.instructions,
      f.error.delta_e, f.error.delta_e_95, f.error.flip, f.error.flip_95, level.error_at_screen_size.delta_e,
      level.error_at_screen_size.delta_e_95, on_mesh,
      changes.empty() ? std::string("everything") : "<ul>" + changes + "</ul>");
}

std::string chainHtml(const LodChain& chain, uint32_t size, const lang::Library& library) {
  std::string text = fmt::format(
      "<h2>{}</h2>\n<p class=\"quiet\">{}, material {}; {} shaders were measured on {}</p>\n",
      escaped(chain.found.name.empty() ? "(no name)" : chain.found.name), escaped(chain.found.file),
      chain.found.index, chain.tried.size(),
      chain.found.triangles == 0 ? fmt::format("a ball of radius {:.4g}", chain.found.radius)
                                 : fmt::format("the {} triangles of the file that have the material, and "
                                               "on a ball of their size (radius {:.4g})",
                                               chain.found.triangles, chain.found.radius));
  text += fmt::format(
      "<table>\n<tr><th>level</th><th>for</th><th>cycles</th><th title=\"of the vertex stage; what it takes "
      "more than that of level 0 "
      "counts an eighth in the percentage\">at the vertices</th><th>quarter "
      "rate</th><th>instructions</th><th>ΔE at {0}, "
      "mean / 95 %</th><th>FLIP at {0}</th><th>ΔE at its size</th>{1}<th>what is simpler</th></tr>\n",
      size,
      chain.found.triangles == 0
          ? std::string()
          : fmt::format("<th>ΔE on the geometry alone, at {}</th><th>and at its size</th>", size));
  for (size_t i = 0; i < chain.found.levels.size(); ++i) text += rowOf(chain, i, library);
  text += "</table>\n" + Plot(chain).svg();
  for (size_t i = 1; i < chain.found.levels.size(); ++i) {
    const Level& level = chain.found.levels[i];
    text += fmt::format(
        "<h3>Level {}</h3>\n<figure><img src=\"{}\" alt=\"\"><figcaption>exact, level {}, FLIP "
        "between them; one row for each studio{}</figcaption></figure>\n",
        i, escaped(chain.pictures[i].large), i,
        chain.found.triangles == 0 ? "" : ", then the file's own geometry in each");
    text += fmt::format("<figure><img src=\"{}\" alt=\"\"><figcaption>at {} pixels</figcaption></figure>\n",
                        escaped(chain.pictures[i].used), level.screen_size);
  }
  return text;
}

}  // namespace

std::string strip(const std::vector<preview::Shot>& exact, const std::vector<preview::Shot>& level) {
  constexpr uint32_t kGap = 4;
  if (exact.empty()) return {};
  const uint32_t size = exact[0].pixels.width;
  const uint32_t step = size + kGap;
  preview::Picture sheet(3 * step - kGap, static_cast<uint32_t>(exact.size()) * step - kGap,
                         preview::kBackground);
  for (size_t i = 0; i < exact.size(); ++i) {
    const int y = static_cast<int>(i) * static_cast<int>(step);
    sheet.copy(preview::shown(exact[i]), 0, y);
    sheet.copy(preview::shown(level[i]), static_cast<int>(step), y);
    sheet.copy(preview::shownDifference(exact[i], level[i]), 2 * static_cast<int>(step), y);
  }
  return sheet.png();
}

std::string lodPage(const std::vector<LodChain>& chains, const std::string& driver, uint32_t size,
                    const lang::Library& library) {
  std::string text(kHead);
  text += "<h1>Levels of detail</h1>\n";
  text += fmt::format(
      "<p>Costs are those of the level's own fragment shader on navi21, {}. <em>Quarter rate</em> counts "
      "reciprocals, "
      "roots and what is transcendental four times. Differences are measured on a ball with an edge, and on "
      "the file's own geometry at its own size where it has "
      "any, in {} studios: "
      "ΔE is CIEDE2000, FLIP is in [0, 1], both over the pixels that show either. Hover a change for its "
      "word.</p>\n",
      driver.empty() ? std::string("estimated from its operations, since no driver is installed")
                     : "measured with " + escaped(driver),
      preview::comparisonStudios(1).size());
  for (const LodChain& chain : chains) text += chainHtml(chain, size, library);
  return text + "</html>\n";
}

}  // namespace lacquer
