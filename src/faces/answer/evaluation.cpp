#include <fmt/format.h>

#include <cmath>

#include "answer/answer.h"
#include "json/text.h"

namespace lacquer {

/// Components of a value, "vec3"; a scalar has one.
static size_t componentsOf(const Evaluation& evaluation) {
  if (evaluation.node.empty()) return 4;
  const char last = evaluation.type.empty() ? '1' : evaluation.type.back();
  return last >= '2' && last <= '4' ? static_cast<size_t>(last - '0') : 1;
}

std::string answerJson(const Evaluation& evaluation) {
  std::string text = fmt::format("{{\n  \"material\": {},\n  \"engine\": \"{}\",\n",
                                 json::quotedText(evaluation.material), engineName(evaluation.engine));
  if (!evaluation.device.empty())
    text += fmt::format("  \"device\": {},\n", json::quotedText(evaluation.device));
  if (!evaluation.profile.empty()) text += fmt::format("  \"profile\": \"{}\",\n", evaluation.profile);
  if (!evaluation.node.empty())
    text += fmt::format("  \"node\": {},\n  \"type\": \"{}\",\n", json::quotedText(evaluation.node),
                        evaluation.type);
  const size_t count = componentsOf(evaluation);
  const bool whole = evaluation.type.starts_with('i') || evaluation.type.starts_with('u');
  text += evaluation.node.empty() ? "  \"rgba\": [" : "  \"values\": [";
  for (const std::array<double, 4>& color : evaluation.rgba) {
    text += &color == evaluation.rgba.data() ? "\n    [" : ",\n    [";
    for (size_t i = 0; i < count; ++i) {
      const double x = color[i];
      if (i > 0) text += ", ";
      text += !std::isfinite(x)                              ? "null"
              : evaluation.engine == Engine::Double || whole ? fmt::format("{:.17g}", x)
                                                             : fmt::format("{:.9g}", static_cast<float>(x));
    }
    text += "]";
  }
  text += "\n  ]";
  if (!evaluation.discarded.empty()) {
    text += ",\n  \"discarded\": [";
    for (size_t i = 0; i < evaluation.discarded.size(); ++i)
      text += fmt::format("{}{}", i == 0 ? "" : ", ", static_cast<bool>(evaluation.discarded[i]));
    text += "]";
  }
  return text + "\n}\n";
}

}  // namespace lacquer
