// `lacquer convert` of documents: what is written, what is lost, and that no material is.
#include <gtest/gtest.h>

#include <set>

#include "command.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test::convert_test {
namespace {

std::set<std::string> materialsOf(const Workplace& place, const std::string& file) {
  Messages messages;
  const Scene scene = Scene::load((place / file).string(), {}, messages);
  std::set<std::string> names;
  for (size_t i = 0; scene && i < scene.materialCount(); ++i) names.insert(scene.materialName(i));
  return names;
}

const bool kConverted =
    registerCases("Converted", sourceFolder() / "tests/cli/converted", ".case", [](Case& c) {
      const Workplace place;
      place.write("case.mtlx", c.input());
      const std::set<std::string> materials = materialsOf(place, "case.mtlx");
      EXPECT_FALSE(materials.empty());
      for (const std::string as : {"gltf_pbr", "open_pbr_surface"}) {
        const std::string file = as + ".mtlx";
        const Outcome outcome = place.run({"convert", "case.mtlx", "-o", file, "--as", as, "-q"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        c.expect(as, place.read(file));
        c.expect(as + " said", outcome.err);
        EXPECT_EQ(materialsOf(place, file), materials) << as;
      }
    });

}  // namespace
}  // namespace lacquer::test::convert_test
