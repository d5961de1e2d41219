#include "cli/tune_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/text.h"

namespace lacquer::cli {

namespace {

constexpr double kWidth = 640, kHeight = 360, kLeft = 70, kRight = 150, kTop = 44, kBottom = 56;
/// Where an error of 0 lies: this far before the first decade.
constexpr double kExact = 40;

struct Point {
  double error, cycles;
  std::string says;
};

/// Errors to the right in decades, cycles upwards.
struct Scale {
  int low = 99, high = -99;
  double most = 1;

  Scale(const std::vector<Point>& points, double plain) : most(std::max(plain, 1.0)) {
    for (const Point& point : points) {
      if (point.error <= 0) continue;
      low = std::min(low, static_cast<int>(std::floor(std::log10(point.error))));
      high = std::max(high, static_cast<int>(std::ceil(std::log10(point.error))));
    }
    if (high < low) low = -7, high = 0;  // nothing is off
    if (high == low) ++high;
  }

  double x(double error) const {
    if (error <= 0) return kLeft;
    const double at = (std::log10(error) - low) / (high - low);
    return kLeft + kExact + (kWidth - kLeft - kRight - kExact) * std::clamp(at, 0.0, 1.0);
  }
  double y(double cycles) const { return kHeight - kBottom - (kHeight - kTop - kBottom) * cycles / most; }
};

std::string text(double x, double y, const char* anchor, const std::string& what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, what);
}

std::string line(double x0, double y0, double x1, double y1, const char* color) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0,
                     y0, x1, y1, color);
}

std::string axesOf(const Scale& scale, const char* errors) {
  const double bottom = scale.y(0), right = kWidth - kRight;
  std::string svg;
  for (int part = 0; part <= 4; ++part) {
    const double y = scale.y(scale.most * part / 4);
    svg += line(kLeft, y, right, y, part == 0 ? "#333" : "#ddd");
    svg += text(kLeft - 6, y + 4, "end", fmt::format("{:.0f}", scale.most * part / 4));
  }
  svg += text(kLeft, bottom + 18, "middle", "0");
  const int step = (scale.high - scale.low + 5) / 6;
  for (int decade = scale.low; decade <= scale.high; decade += step) {
    const double x = scale.x(std::pow(10, decade));
    svg += line(x, kTop, x, bottom, "#eee");
    svg += text(x, bottom + 18, "middle", fmt::format("1e{}", decade));
  }
  svg += text((kLeft + right) / 2, bottom + 40, "middle", errors);
  svg += fmt::format(
      "<text transform=\"translate(18 {:.1f}) rotate(-90)\" text-anchor=\"middle\">cycles</text>\n",
      (kTop + bottom) / 2);
  return svg;
}

/// A name as XML has it.
std::string escaped(const std::string& name) {
  std::string made;
  for (const char c : printable(name)) {
    made += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  }
  return made;
}

/// A step for each point, from the shader as it is.
std::string frontOf(const std::vector<Point>& front, double plain, const char* errors) {
  const Scale scale(front, plain);
  std::string svg = axesOf(scale, errors);
  double x = kLeft, y = scale.y(plain);
  std::string steps = fmt::format("M {:.1f} {:.1f}", x, y), points, names;
  double last_name = -100;
  for (const Point& point : front) {
    x = scale.x(point.error);
    y = scale.y(point.cycles);
    steps += fmt::format(" H {:.1f} V {:.1f}", x, y);
    points += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"#06c\"><title>error {:.2g}, {:.0f} "
        "cycles, {}</title></circle>\n",
        x, y, point.error, point.cycles, point.says);
    // What is named stands beside what is named, not over it.
    if (y - last_name < 13) continue;
    last_name = y;
    names += text(x + 8, y - 6, "start", fmt::format("{:.0f} ({:.2g})", point.cycles, point.error));
  }
  steps += fmt::format(" H {:.1f}", kWidth - kRight);
  svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#06c\" stroke-width=\"2\"/>\n", steps);
  return svg + points + names;
}

}  // namespace

std::string pictureOf(const Tuned& tuned) {
  std::vector<Point> forms, moves;
  for (const TunedForm& form : tuned.forms)
    forms.push_back({form.error, form.cycles, fmt::format("{} approximations", form.approximations)});
  for (const TunedMove& move : tuned.moves)
    moves.push_back(
        {move.error.delta_e, move.cost, escaped(fmt::format("{}", fmt::join(move.simplify, " ")))});
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      kWidth, moves.empty() ? kHeight : 2 * kHeight);
  svg += fmt::format(
      "<text x=\"{}\" y=\"22\" font-size=\"14\">{}: {:.0f} cycles on {} as it is, by the model</text>\n",
      kLeft, escaped(tuned.name), tuned.plain, escaped(tuned.family));
  svg += frontOf(forms, tuned.plain, "error, proved");
  if (!moves.empty()) {
    svg += fmt::format("<g transform=\"translate(0 {})\">\n", kHeight);
    svg += frontOf(moves, tuned.plain, "nodes computed at the vertices: colour difference in pictures");
    svg += "</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace lacquer::cli
