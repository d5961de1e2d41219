// What is proved of the samples, as of every node: each operation is safe for all inputs, and each argument
// is what the node that takes it says.
#include <gtest/gtest.h>

#include <string_view>

#include "inputs.h"
#include "support/answers.h"

namespace lacquer::test {
namespace {

size_t occurrences(std::string_view text, std::string_view of) {
  size_t count = 0;
  for (size_t at = text.find(of); at != std::string_view::npos; at = text.find(of, at + 1)) ++count;
  return count;
}

struct Claims {
  size_t materials = 0, proved = 0;
};

void prove(const Scene& scene, const Options& options, Claims& claims) {
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    Messages messages;
    Graph graph = scene.graph(i, kUnusedAttributes, options, messages);
    const std::string proofs = jsonOf(graph.prove(options, messages));
    ASSERT_EQ(errorsOf(messages), "");
    claims.proved += occurrences(proofs, R"("safe": true)") + occurrences(proofs, R"("proved": true)");
    ++claims.materials;
    EXPECT_EQ(occurrences(proofs, R"("safe": false)") + occurrences(proofs, R"("proved": false)"), 0U)
        << scene.materialName(i) << ", " << options.template_name << ", " << options.profile << "\n"
        << proofs;
  }
}

TEST(Proved, EverySampleInEveryTemplateAndProfile) {
  Claims claims;
  for (const std::string& file : examples()) {
    Messages messages;
    const Scene scene = Scene::load(file, {}, messages);
    ASSERT_TRUE(scene) << file;
    for (const std::string& profile : profiles()) {
      for (const char* name : {"forward", "surface", "bsdf"}) {
        Options options = quick();
        options.template_name = name;
        options.profile = profile;
        prove(scene, options, claims);
      }
    }
  }
  EXPECT_GT(claims.materials, 200U);
  EXPECT_GT(claims.proved, 10 * claims.materials);
}

}  // namespace
}  // namespace lacquer::test
