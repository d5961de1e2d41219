#include <fmt/format.h>

#include <cmath>

#include "answer/answer.h"
#include "json/text.h"

namespace lacquer {

std::string answerJson(const Evaluation& evaluation) {
  std::string text = fmt::format("{{\n  \"material\": {},\n  \"engine\": \"{}\",\n",
                                 json::quotedText(evaluation.material), engineName(evaluation.engine));
  if (!evaluation.device.empty())
    text += fmt::format("  \"device\": {},\n", json::quotedText(evaluation.device));
  if (!evaluation.profile.empty()) text += fmt::format("  \"profile\": \"{}\",\n", evaluation.profile);
  text += "  \"rgba\": [";
  for (const std::array<double, 4>& color : evaluation.rgba) {
    text += &color == evaluation.rgba.data() ? "\n    [" : ",\n    [";
    for (const double& x : color) {
      if (&x != color.data()) text += ", ";
      text += !std::isfinite(x)                     ? "null"
              : evaluation.engine == Engine::Double ? fmt::format("{:.17g}", x)
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
