#include "programs/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "json/text.h"

namespace lacquer::programs {

namespace {

/// The scale of every so many programs, from a place on; 0 for none.
double scaleOf(const std::vector<Compared>& programs, size_t first, size_t step) {
  double ratios = 0;
  double squares = 0;
  for (size_t i = first; i < programs.size(); i += step) {
    const double ratio = programs[i].model / programs[i].driver;
    ratios += ratio;
    squares += ratio * ratio;
  }
  return squares > 0 ? ratios / squares : 0;
}

}  // namespace

ModelError fitModel(const std::vector<Compared>& programs) {
  ModelError error;
  const double scale = scaleOf(programs, 0, 1);
  if (scale > 0) error.scale = scale;
  const std::array<double, 2> unseen{scaleOf(programs, 1, 2), scaleOf(programs, 0, 2)};
  if (unseen[0] == 0) return error;
  for (size_t i = 0; i < programs.size(); ++i) {
    const double off = std::abs(unseen[i % 2] * programs[i].model / programs[i].driver - 1);
    error.mean += off / static_cast<double>(programs.size());
    ++error.compared;
    if (off < error.largest) continue;
    error.largest = off;
    error.largest_structures = programs[i].structures;
  }
  return error;
}

std::vector<Point> pointsOf(const std::vector<Item>& items, const Merging& merging,
                            const std::vector<Division>& divisions) {
  double weight = 0;
  for (const Item& item : items) weight += item.weight;
  const auto name = [&](uint32_t group) {
    return group < items.size() ? items[group].name : fmt::format("merged-{}", group - items.size() + 1);
  };
  std::vector<Point> points;
  for (size_t step = 0; step < divisions.size(); ++step) {
    const Division& division = divisions[step];
    Point point;
    point.programs = items.size() - step;  // it may take fewer
    if (step > 0) {
      point.made = name(static_cast<uint32_t>(items.size() + step - 1));
      point.first = name(merging.steps[step - 1].first);
      point.second = name(merging.steps[step - 1].second);
    }
    point.cost = weight > 0 ? weightedCost(items, division) / weight : 0;
    for (size_t g = 0; g < division.groups.size(); ++g) {
      for (const uint32_t item : division.groups[g]) {
        const double own = items[item].program.cost;
        const double rise = own > 0 ? division.costs[g] / own - 1 : 0;
        if (rise <= point.largest_rise) continue;
        point.largest_rise = rise;
        point.worst = items[item].name;
      }
    }
    points.push_back(std::move(point));
  }
  return points;
}

namespace {

double rounded(double x, double digits) { return std::round(x * digits) / digits; }

std::string costsText(const Curve& curve) {
  if (!curve.driver.empty()) return fmt::format("measured with {} for navi21", curve.driver);
  if (curve.error.compared == 0) return "estimated by the model, which was compared with no driver";
  return fmt::format(
      "estimated by the model, which is off the driver's by {:.1f} % in the mean over {} programs that its "
      "fit "
      "has not seen, and by {:.1f} % at most, for a program of {} structures",
      100 * curve.error.mean, curve.error.compared, 100 * curve.error.largest,
      curve.error.largest_structures);
}

}  // namespace

std::string toJson(const Curve& curve) {
  json::JsonText json;
  json.beginObject().key("materials").integer(static_cast<int64_t>(curve.materials));
  json.key("structures").integer(static_cast<int64_t>(curve.structures));
  json.key("programs").integer(static_cast<int64_t>(curve.made));
  json.key("merges_tried").integer(static_cast<int64_t>(curve.measured));
  json.key("costs").beginObject().key("unit").string("cycles of inverse throughput, navi21");
  json.key("by").string(curve.driver.empty() ? "model" : "driver");
  if (!curve.driver.empty()) json.key("driver").string(curve.driver);
  if (curve.error.compared > 0) {
    json.key("model").beginObject().key("compared").integer(static_cast<int64_t>(curve.error.compared));
    json.key("mean_error").number(rounded(curve.error.mean, 1e4));
    json.key("largest_error").number(rounded(curve.error.largest, 1e4));
    json.key("largest_error_structures").integer(static_cast<int64_t>(curve.error.largest_structures));
    json.endObject();
  }
  json.endObject().key("curve").beginArray();
  for (const Point& point : curve.points) {
    json.beginObject().key("programs").integer(static_cast<int64_t>(point.programs));
    json.key("cost").number(rounded(point.cost, 1e3));
    json.key("largest_rise").number(rounded(point.largest_rise, 1e4));
    if (!point.worst.empty()) json.key("worst").string(point.worst);
    if (!point.made.empty()) {
      json.key("merge").beginObject().key("made").string(point.made);
      json.key("first").string(point.first).key("second").string(point.second).endObject();
    }
    json.endObject();
  }
  return json.endArray().endObject().take() + "\n";
}

std::string toMarkdown(const Curve& curve) {
  std::string text = fmt::format(
      "# Programs\n\n{} materials of {} structures; {} programs were made. Costs are cycles for a pixel, the "
      "mean over the "
      "materials, {}.\n\n| programs | cost | more than with all | largest rise | of | merge "
      "|\n|---|---|---|---|---|---|\n",
      curve.materials, curve.structures, curve.made, costsText(curve));
  for (const Point& point : curve.points) {
    const double more = curve.points[0].cost > 0 ? point.cost / curve.points[0].cost - 1 : 0;
    const std::string merge =
        point.made.empty() ? "" : fmt::format("{} = {} + {}", point.made, point.first, point.second);
    text += fmt::format("| {} | {:.1f} | {:.1f} % | {:.1f} % | {} | {} |\n", point.programs, point.cost,
                        100 * more, 100 * point.largest_rise, point.worst, merge);
  }
  return text;
}

std::string toSvg(const Curve& curve) {
  constexpr double kWidth = 720, kHeight = 400, kLeft = 70, kRight = 70, kTop = 40, kBottom = 50;
  const double most_programs = static_cast<double>(std::max<size_t>(curve.structures, 2));
  double most_cost = 1;
  double most_rise = 0.01;
  for (const Point& point : curve.points) {
    most_cost = std::max(most_cost, point.cost);
    most_rise = std::max(most_rise, point.largest_rise);
  }
  // The logarithm, since most happens where programs are few.
  const auto x = [&](size_t programs) {
    // Without materials there are none.
    const auto count = static_cast<double>(std::max<size_t>(programs, 1));
    return kLeft + (kWidth - kLeft - kRight) * std::log(count) / std::log(most_programs);
  };
  const auto y = [&](double part) { return kHeight - kBottom - (kHeight - kTop - kBottom) * part; };
  const auto line = [&](const char* color, auto&& part) {
    std::string points;
    for (const Point& point : curve.points)
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x(point.programs), y(part(point)));
    return fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" points=\"{}\"/>\n", color,
                       points);
  };
  const auto label = [](double px, double py, const char* anchor, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", px, py, anchor,
                       text);
  };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth, kHeight);
  for (int i = 0; i <= 4; ++i) {
    const double part = i / 4.0;
    svg += fmt::format("<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n", kLeft,
                       kWidth - kRight, y(part), y(part));
    svg += label(kLeft - 8, y(part) + 4, "end", fmt::format("{:.0f}", part * most_cost));
    svg += label(kWidth - kRight + 8, y(part) + 4, "start", fmt::format("{:.0f} %", 100 * part * most_rise));
  }
  for (size_t n = 1; n < curve.structures; n *= 2)
    svg += label(x(n), kHeight - kBottom + 18, "middle", fmt::format("{}", n));
  svg += label(x(curve.structures), kHeight - kBottom + 18, "middle", fmt::format("{}", curve.structures));
  svg += label(kWidth / 2, kHeight - 10, "middle", "programs");
  svg += label(kLeft, 20, "start", "cycles for a pixel (blue), largest rise for one structure (red)");
  svg += line("#1f6fb4", [&](const Point& point) { return point.cost / most_cost; });
  svg += line("#c23b22", [&](const Point& point) { return point.largest_rise / most_rise; });
  return svg + "</svg>\n";
}

}  // namespace lacquer::programs
