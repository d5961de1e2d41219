// Error against cost, one panel for each term.
#pragma once

#include <string>
#include <vector>

namespace lacquer::bench {

struct PlotPoint {
  std::string name;
  double cost = 0, error = 0;
};

struct Panel {
  std::string title;
  std::vector<PlotPoint> points;
};

/// True for the points that no other one beats: none is as cheap and as exact, and one of both better.
std::vector<bool> paretoFront(const std::vector<PlotPoint>& points);

/// An SVG. Costs are linear, errors logarithmic, 0 at the bottom.
std::string plot(const std::vector<Panel>& panels, const std::string& cost_label,
                 const std::string& error_label);

}  // namespace lacquer::bench
