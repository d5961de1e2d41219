// Tables that docs/error.md shows, and what they have of the cost of the works.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#include "cost/cost.h"
#include "lacquer.h"
#include "support/file.h"

namespace lacquer::physics {

inline Options workOptions(const std::map<std::string, uint32_t, std::less<>>& lights) {
  Options options;
  options.targets = {Target::Spirv};
  options.lights.mode = Lights::Mode::Fixed;
  for (const auto& [kind, count] : lights) options.lights.counts[kind] = count;
  options.validate = false;
  return options;
}

/// A work of bench/works.
inline cost::Subject workOf(const std::string& name, const Options& options) {
  Messages messages;
  const Scene scene =
      Scene::load(std::string(LACQUER_SOURCE_FOLDER) + "/bench/works/" + name, options, messages);
  EXPECT_TRUE(scene) << name;
  if (!scene) return {};
  const Shader shader = scene.graph(0, scene.uses(0)[0], options, messages).generate(options, messages);
  EXPECT_TRUE(shader) << name;
  return {name, shader.vertexSpirv(), shader.fragmentSpirv()};
}

/// The page has the text between `<!-- NAME: -->` and `<!-- :NAME -->`, or gets it with LACQUER_BLESS. What
/// another driver measured is not compared.
inline void expectOnPage(std::string_view name, const std::string& now, const std::string& driver) {
  const std::string path = std::string(LACQUER_SOURCE_FOLDER) + "/docs/error.md";
  const std::string before = "<!-- " + std::string(name) + ": -->\n";
  Result<std::string> page = readFile(path);
  ASSERT_TRUE(page);
  const size_t begin = page->find(before);
  const size_t end = page->find("<!-- :" + std::string(name) + " -->\n");
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos && begin < end);
  const size_t first = begin + before.size();
  if (std::getenv("LACQUER_BLESS") != nullptr) {
    page->replace(first, end - first, now);
    ASSERT_TRUE(writeFile(path, *page));
    return;
  }
  const std::string shown = page->substr(first, end - first);
  if (!shown.starts_with(driver)) GTEST_SKIP() << "measured with another driver: " << driver;
  EXPECT_EQ(shown, now) << "LACQUER_BLESS=1 renews it";
}

}  // namespace lacquer::physics
