// The lights of EXT_lights_area: rectangles and discs. The draft's text and its schema disagree about the
// name of `type`, and its table both requires it and gives it a default: here it is `type`, and must be
// there.
#include <fmt/format.h>

#include <string_view>

#include "gltf/reading.h"
#include "json/path.h"
#include "json/report.h"

namespace lacquer::gltf {

namespace {

/// A number that the light may have, above 0, or from 0 on where that is allowed, and a float.
void checkPositive(Report& report, const Json& owner, const Path& path, std::string_view name, bool or_zero) {
  const Json* value = member(owner, name);
  if (value == nullptr) return;
  const Path here(path, name);
  const std::string_view right =
      or_zero ? "a number from 0 to about 3.4e38" : "a number above 0, to about 3.4e38";
  if (!value->is_number()) return report.wrongType(here, name, *value, right);
  const double number = value->get<double>();
  if ((number > 0 || (or_zero && number == 0)) && number <= kMostFloat) return;
  report.error("out-of-range", here, fmt::format("{} is {}", name, number),
               fmt::format("it must be {}", right));
}

void checkColor(Report& report, const Json& light, const Path& path) {
  const Json* color = member(light, "color");
  if (color == nullptr) return;
  const Path here(path, "color");
  if (!color->is_array() || color->size() != 3)
    return report.wrongType(here, "color", *color, "an array of three numbers");
  for (size_t i = 0; i < 3; ++i) {
    const Json& channel = (*color)[i];
    if (!channel.is_number()) {
      report.wrongType(Path(here, i), "the channel", channel, "a number");
    } else if (const double value = channel.get<double>(); !(value >= 0 && value <= 1)) {
      report.error("out-of-range", Path(here, i), fmt::format("the channel is {}", value),
                   "it must be in [0, 1]");
    }
  }
}

}  // namespace

Json readAreaLight(Report& report, const Json& light, const Path& path) {
  static constexpr std::string_view kAreaTypes[] = {"rect", "disk"};
  checkColor(report, light, path);
  checkPositive(report, light, path, "intensity", true);
  checkPositive(report, light, path, "size", false);
  if (const Json* rect = member(light, "rect")) {
    if (rect->is_object())
      checkPositive(report, *rect, Path(path, "rect"), "aspect", false);
    else
      report.wrongType(Path(path, "rect"), "rect", *rect, "an object");
  }
  return readLightType(report, light, path, kAreaTypes);
}

}  // namespace lacquer::gltf
