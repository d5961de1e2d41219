// Many wrong pointers are a few words.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/materials.h"

namespace lacquer::test {
namespace {

TEST(GltfPointers, ManyWrongOnesAreCounted) {
  std::string channels;
  for (int i = 0; i < 40; ++i) {
    channels += fmt::format(R"({}{{"target": {{"path": "pointer", "extensions": {{"KHR_animation_pointer":
                              {{"pointer": "/materials/0/nothing{}"}}}}}}}})",
                            i == 0 ? "" : ", ", i);
  }
  const auto document = materialsOf(R"({"asset": {"version": "2.0"}, "materials": [{}],
                                        "animations": [{"channels": [)" +
                                        channels + "]}]}",
                                    "x.gltf");
  ASSERT_TRUE(document);
  const Diagnostics& said = document->materials.at(0).diagnostics;
  ASSERT_EQ(said.size(), 17U);
  EXPECT_EQ(said.back().message, "24 more pointers aim at no property");
}

}  // namespace
}  // namespace lacquer::test
