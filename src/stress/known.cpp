#include "stress/attack.h"

namespace lacquer::stress {

namespace {

/// Steps that the texts have, or that no formula can avoid. A test sees that each still occurs.
struct Known {
  std::string_view node;       ///< of the library; in a material, a part of the term's name
  std::string_view condition;  ///< as conditionName() writes it
  std::string_view why;
};

constexpr Known kKnown[] = {
    {"distribution", "0 < NdotSum",
     "Appendix B's D ends with a step at N.H = 0; it is seen past the horizon alone"},
    {"anisotropy_texel", "1e-12 < length2",
     "a texel of no length has no direction; the tangent stands for it"},
    {"flat_normal", "dot < 0", "a triangle seen from its edge turns its other side"},
    {"tangent_frame_from_derivatives", "mul < mul", "texture coordinates without an area have no tangent"},
    {"film", " < 0", "a film's wave turns over where the base becomes the thinner medium"},
};

}  // namespace

std::string_view knownJump(std::string_view subject, std::string_view condition) {
  for (const Known& known : kKnown) {
    const bool here = subject.find(known.node) != std::string_view::npos ||
                      condition.find(known.node) != std::string_view::npos;
    if (here && condition.ends_with(known.condition)) return known.why;
  }
  return {};
}

}  // namespace lacquer::stress
