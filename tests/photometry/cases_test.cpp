// cases/*.case: an IES file, and what reading it gives: messages, then what is found, with the candela in
// some directions of the light's node.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>

#include "photometry/distribution.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using photometry::Distribution;
using photometry::Vec3;

std::string valuesOf(const Distribution& distribution) {
  const std::pair<const char*, Vec3> along[] = {
      {"-z", {0, 0, -1}},     {"+z", {0, 0, 1}},      {"+x", {1, 0, 0}},     {"+y", {0, 1, 0}},
      {"-x", {-1, 0, 0}},     {"-y", {0, -1, 0}},     {"+x -z", {1, 0, -1}}, {"+y -z", {0, 1, -1}},
      {"-x -z", {-1, 0, -1}}, {"-y -z", {0, -1, -1}}, {"+x +y", {1, 1, 0}},  {"-x -y", {-1, -1, 0}}};
  std::string text;
  for (const auto& [name, way] : along) {
    const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    text += fmt::format("{}: {:.6g}\n", name,
                        distribution.at({way[0] / length, way[1] / length, way[2] / length}) + 0.0);
  }
  return text;
}

void readCase(Case& file) {
  Diagnostics messages;
  const auto measured =
      photometry::readLm63(file.input(), {file.file().stem().string() + ".ies", 0, 0, {}}, messages);
  if (!measured) messages.insert(messages.end(), measured.error().begin(), measured.error().end());
  std::string text;
  for (const Diagnostic& one : messages) text += format(one) + '\n';
  if (measured) {
    const Distribution distribution(*measured);
    text += fmt::format("{}, type {}\n", measured->standard, "CBA"[static_cast<int>(measured->web)]);
    text += fmt::format("vertical {}; horizontal {}\n", fmt::join(measured->vertical, " "),
                        fmt::join(measured->horizontal, " "));
    text +=
        fmt::format("symmetry {}, peak {:.6g}, lumens {:.6g}\n", static_cast<int>(distribution.symmetry()),
                    distribution.peak(), distribution.lumens());
    text += valuesOf(distribution);
  }
  file.expect("read", text);
}

const bool kRegistered =
    registerCases("IesCase", sourceFolder() / "tests/photometry/cases", ".case", readCase);

TEST(IesCases, areRegistered) { EXPECT_TRUE(kRegistered); }

}  // namespace
}  // namespace lacquer::test
