// The JSON form of what the instruments find: what `--json` prints and the C header's texts hold.
#pragma once

#include <string>
#include <vector>

#include "lacquer/results.h"

namespace lacquer {

/// docs/eval.md. With 17 digits for double, 9 for float; null in place of what is not finite.
std::string answerJson(const Evaluation& evaluation);

/// docs/intervals.md; without a line's end.
std::string answerJson(const Proofs& proofs);
std::string answerJson(const std::vector<NodeProof>& nodes);
/// docs/preview.md
std::string answerJson(const PreviewSheet& sheet);
/// docs/lod.md
std::string answerJson(const Levels& levels);
/// docs/stress.md. Findings have their "case", which is what `lacquer stress` reads.
std::string answerJson(const StressReport& report);
/// On one line: a finding's case; of Fault::Form, its sample.
std::string caseText(const StressFinding& finding, const StressSubject& subject);
/// The text of environment.json.
std::string answerJson(const EnvironmentMaps& maps);
/// docs/light-profiles.md; without the texels.
std::string answerJson(const LightProfiles& profiles);

}  // namespace lacquer
