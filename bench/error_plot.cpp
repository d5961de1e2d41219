#include "bench/error_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lacquer::bench {

namespace {

constexpr int kColumns = 2;
constexpr double kWidth = 430, kHeight = 250;  ///< of a panel
constexpr double kLeft = 58, kRight = 14, kTop = 32, kBottom = 44;
/// Where 0 lies, below the decades: this much of a panel's height.
constexpr double kNone = 0.12;

struct Axes {
  double x0, y0, cost_min, cost_max;
  int low, high;  ///< decades

  double x(double cost) const {
    return x0 + kLeft + (kWidth - kLeft - kRight) * (cost - cost_min) / (cost_max - cost_min);
  }
  double y(double error) const {
    const double t = error > 0 ? (std::log10(error) - low) / (high - low) : 0;
    const double up = error > 0 ? kNone + (1 - kNone) * std::clamp(t, 0.0, 1.0) : 0;
    return y0 + kHeight - kBottom - (kHeight - kTop - kBottom) * up;
  }
};

Axes axesOf(const Panel& panel, double x0, double y0) {
  Axes axes{x0, y0, panel.points[0].cost, panel.points[0].cost, 99, -99};
  for (const PlotPoint& p : panel.points) {
    axes.cost_min = std::min(axes.cost_min, p.cost);
    axes.cost_max = std::max(axes.cost_max, p.cost);
    if (p.error <= 0) continue;
    const double decade = std::log10(p.error);
    axes.low = std::min(axes.low, static_cast<int>(std::floor(decade)));
    axes.high = std::max(axes.high, static_cast<int>(std::ceil(decade)));
  }
  if (axes.high < axes.low) axes.low = axes.high = -3;  // no body has an error
  if (axes.high <= axes.low) axes.high = axes.low + 1;
  // Names stand beside the points.
  const double margin = std::max(2.0, 0.45 * (axes.cost_max - axes.cost_min));
  axes.cost_min = std::max(0.0, axes.cost_min - margin);
  axes.cost_max += margin;
  return axes;
}

std::string grid(const Axes& a, const std::string& cost_label, const std::string& error_label) {
  std::string svg;
  const double bottom = a.y0 + kHeight - kBottom;
  svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='end'>0</text>\n",
                     a.x(a.cost_min) - 4, a.y(0) + 4);
  const int step = (a.high - a.low + 3) / 4;
  for (int decade = a.low; decade <= a.high; decade += step) {
    const double y = a.y(std::pow(10, decade));
    svg += fmt::format("<line class='grid' x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}'/>\n",
                       a.x(a.cost_min), y, a.x(a.cost_max), y);
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='end'>1e{}</text>\n",
                       a.x(a.cost_min) - 4, y + 3, decade);
  }
  for (int i = 0; i <= 2; ++i) {
    const double cost = a.cost_min + (a.cost_max - a.cost_min) * i / 2;
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='middle'>{:.0f}</text>\n",
                       a.x(cost), bottom + 15, cost);
  }
  svg += fmt::format("<line class='axis' x1='{0:.1f}' y1='{1:.1f}' x2='{0:.1f}' y2='{2:.1f}'/>\n",
                     a.x(a.cost_min), a.y0 + kTop, bottom);
  svg += fmt::format("<line class='axis' x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}'/>\n",
                     a.x(a.cost_min), bottom, a.x(a.cost_max), bottom);
  svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n",
                     a.x((a.cost_min + a.cost_max) / 2), bottom + 33, cost_label);
  const double middle = a.y0 + kHeight / 2;
  svg += fmt::format(
      "<text class='tick' x='{0:.1f}' y='{1:.1f}' text-anchor='middle' "
      "transform='rotate(-90 {0:.1f} {1:.1f})'>{2}</text>\n",
      a.x0 + 14, middle, error_label);
  return svg;
}

/// A name beside its point: the first of a few places where it covers no other one.
class Names {
public:
  std::string place(const std::string& name, double x, double y) {
    const double width = 6.8 * static_cast<double>(name.size());
    for (int i = 0; i < 12; ++i) {
      const bool left = i % 2 == 1;
      const double up = (i / 2 % 2 == 0 ? -1 : 1) * (4 + 13.0 * (i / 4)) + (i / 2 % 2 == 0 ? 0 : 8);
      const Box box{left ? x - 6 - width : x + 6, y + up, width};
      if (i < 11 && std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return meet(b, box); })) {
        continue;
      }
      taken_.push_back(box);
      return fmt::format("<text class='name' x='{:.1f}' y='{:.1f}'>{}</text>\n", box.x, box.y, name);
    }
    return {};
  }

private:
  struct Box {
    double x, y, width;
  };
  static bool meet(const Box& a, const Box& b) {
    return std::abs(a.y - b.y) < 12 && a.x < b.x + b.width && b.x < a.x + a.width;
  }
  std::vector<Box> taken_;
};

std::string panelText(const Panel& panel, const Axes& a) {
  std::string svg = fmt::format("<text class='title' x='{:.1f}' y='{:.1f}'>{}</text>\n", a.x(a.cost_min),
                                a.y0 + kTop - 10, panel.title);
  const std::vector<bool> front = paretoFront(panel.points);
  std::vector<PlotPoint> best;
  for (size_t i = 0; i < panel.points.size(); ++i) {
    if (front[i]) best.push_back(panel.points[i]);
  }
  std::sort(best.begin(), best.end(), [](const PlotPoint& l, const PlotPoint& r) { return l.cost < r.cost; });
  std::string line;
  for (const PlotPoint& p : best) line += fmt::format("{:.1f},{:.1f} ", a.x(p.cost), a.y(p.error));
  svg += fmt::format("<polyline class='front' points='{}'/>\n", line);
  Names names;
  for (size_t i = 0; i < panel.points.size(); ++i) {
    const PlotPoint& p = panel.points[i];
    svg += fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='3.5'/>\n", front[i] ? "best" : "beaten",
                       a.x(p.cost), a.y(p.error));
    svg += names.place(p.name, a.x(p.cost), a.y(p.error));
  }
  return svg;
}

}  // namespace

std::vector<bool> paretoFront(const std::vector<PlotPoint>& points) {
  std::vector<bool> front;
  for (const PlotPoint& p : points) {
    front.push_back(std::none_of(points.begin(), points.end(), [&](const PlotPoint& q) {
      return q.cost <= p.cost && q.error <= p.error && (q.cost < p.cost || q.error < p.error);
    }));
  }
  return front;
}

std::string plot(const std::vector<Panel>& panels, const std::string& cost_label,
                 const std::string& error_label) {
  const auto rows = static_cast<double>((panels.size() + kColumns - 1) / kColumns);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' "
      "viewBox='0 0 {0:.0f} {1:.0f}' font-family='sans-serif'>\n"
      "<style>.title{{font-size:14px;font-weight:bold}}.tick{{font-size:11px;fill:#444}}.name{{font-size:"
      "12px}"
      "}"
      ".grid{{stroke:#ddd}}.axis{{stroke:#666}}.front{{fill:none;stroke:#06c}}.best{{fill:#06c}}"
      ".beaten{{fill:#aaa}}</style>\n<rect width='100%' height='100%' fill='white'/>\n",
      kColumns * kWidth, rows * kHeight);
  for (size_t i = 0; i < panels.size(); ++i) {
    const Axes axes = axesOf(panels[i], kWidth * static_cast<double>(i % kColumns),
                             kHeight * static_cast<double>(i / kColumns));
    svg += grid(axes, cost_label, error_label) + panelText(panels[i], axes);
  }
  return svg + "</svg>\n";
}

}  // namespace lacquer::bench
