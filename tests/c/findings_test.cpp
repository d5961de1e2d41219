// What instruments find, as rows of C, is what the values of C++ say.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "handle.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test::findings_test {
namespace {

namespace fs = std::filesystem;

using CProofs = std::unique_ptr<lacquer_proofs, Freer<lacquer_proofs_free>>;
using CStress = std::unique_ptr<lacquer_stress, Freer<lacquer_stress_free>>;
using CLevels = std::unique_ptr<lacquer_levels, Freer<lacquer_levels_free>>;
using CSheet = std::unique_ptr<lacquer_sheet, Freer<lacquer_sheet_free>>;

class Findings : public testing::Test {
protected:
  Findings() { fs::create_directories(folder_); }
  ~Findings() override { fs::remove_all(folder_); }

  Graph graph() {
    const Scene scene = Scene::load(file_, {}, messages_);
    return scene.graph(0, kUnusedAttributes, {}, messages_);
  }
  CGraph graphOfC() {
    const CScene scene(lacquer_scene_load(file_.c_str(), nullptr, c_messages_));
    return CGraph(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, nullptr, c_messages_));
  }

  const std::string file_ = (sourceFolder() / "examples/coat.gltf").string();
  const fs::path folder_ = fs::path(testing::TempDir()) / "lacquer_c_findings";
  Messages messages_;
  CMessages c_messages_;
};

TEST_F(Findings, ofEvaluations) {
  const std::string points = R"([{"v": [0, 0, 1], "l": [0, 0.6, 0.8], "env": [1, 1, 1]}, {}])";
  const Scene scene = Scene::load(file_, {}, messages_);
  const CScene of_c(lacquer_scene_load(file_.c_str(), nullptr, c_messages_));
  const auto expected = evaluate(scene, 0, points, Engine::Double, {}, {}, messages_);
  ASSERT_TRUE(expected);
  std::vector<std::array<double, 4>> rgba(2);
  std::vector<uint8_t> discarded(2, 7);
  EXPECT_EQ(lacquer_scene_colors(of_c.get(), 0, points.data(), points.size(), LACQUER_DOUBLE, rgba[0].data(),
                                 discarded.data(), 2, nullptr, c_messages_),
            2U);
  EXPECT_EQ(rgba, expected->rgba);
  EXPECT_EQ(discarded, (std::vector<uint8_t>{0, 0}));
  EXPECT_EQ(lacquer_scene_colors(of_c.get(), 0, points.data(), points.size(), LACQUER_DOUBLE, rgba[0].data(),
                                 nullptr, 1, nullptr, c_messages_),
            0U);
  EXPECT_EQ(lacquer_graph_colors(nullptr, points.data(), points.size(), LACQUER_DOUBLE, rgba[0].data(),
                                 nullptr, 2, nullptr, c_messages_),
            0U);
  EXPECT_EQ(lacquer_graph_colors(nullptr, points.data(), points.size(), 5, rgba[0].data(), nullptr, 2,
                                 nullptr, c_messages_),
            0U);
  EXPECT_EQ(c_messages_.takeCodes(), "block-too-small, empty-handle, unknown-enumerator");
}

TEST_F(Findings, ofEvaluationsOfArrays) {
  const std::string points =
      R"([{"v": [0, 0, 1], "l": [0, 0.6, 0.8], "env": [1, 1, 1]}, {"v": [0, 0.6, 0.8], "l": [0, 0, 1], "env": [1, 1, 1]}])";
  const Scene scene = Scene::load(file_, {}, messages_);
  const CScene of_c(lacquer_scene_load(file_.c_str(), nullptr, c_messages_));
  const auto expected = evaluate(scene, 0, points, Engine::Double, {}, {}, messages_);
  ASSERT_TRUE(expected);
  const double v[] = {0, 0, 1, 0, 0.6, 0.8};
  // Each in a struct of the caller's, backwards.
  struct Sample {
    double other, l[3];
  } samples[] = {{9, {0, 0, 1}}, {9, {0, 0.6, 0.8}}};
  const float white[] = {1, 1, 1};
  const auto backwards = -static_cast<ptrdiff_t>(sizeof(Sample));
  const lacquer_array arrays[] = {
      {"v", v, 1, 3, 3 * sizeof(double)}, {"l", samples[1].l, 1, 3, backwards}, {"env", white, 0, 3, 0}};
  std::array<std::array<double, 5>, 2> rgba{};
  const lacquer_colors to = {rgba.data(), 1, sizeof rgba[0], nullptr};
  ASSERT_EQ(lacquer_scene_colors_of(of_c.get(), 0, arrays, 3, 2, LACQUER_DOUBLE, &to, nullptr, c_messages_),
            1);
  for (size_t i = 0; i < 2; ++i)
    EXPECT_TRUE(std::equal(expected->rgba[i].begin(), expected->rgba[i].end(), rgba[i].begin())) << i;
  const double roughness[] = {0.25, 2, 0.5};
  const lacquer_array swept[] = {{"coat_roughness_factor", roughness, 1, 1, sizeof(double)}};
  const CGraph graph = graphOfC();
  EXPECT_EQ(lacquer_graph_colors_of(graph.get(), swept, 1, 1, LACQUER_FLOAT, &to, nullptr, c_messages_), 1);
  EXPECT_EQ(lacquer_graph_colors_of(graph.get(), swept, 1, 2, LACQUER_FLOAT, &to, nullptr, c_messages_), 0);
  const lacquer_array long_one[] = {
      {"v", v, 1, 3, 0}, {"v", v, 1, 3, 0}, {"uv0", v, 1, 5, 0}, {"l", nullptr, 1, 3, 0}};
  EXPECT_EQ(lacquer_graph_colors_of(graph.get(), long_one, 4, 1, LACQUER_FLOAT, &to, nullptr, c_messages_),
            0);
  EXPECT_EQ(lacquer_graph_colors_of(graph.get(), nullptr, 1, 1, LACQUER_FLOAT, &to, nullptr, c_messages_), 0);
  EXPECT_EQ(
      lacquer_graph_colors_of(graph.get(), swept, 0, SIZE_MAX, LACQUER_FLOAT, &to, nullptr, c_messages_), 0);
  EXPECT_EQ(c_messages_.takeCodes(),
            "out-of-range, duplicate-name, wrong-type, null-argument, null-argument, too-many-points");
}

TEST_F(Findings, ofProofs) {
  const auto expected = graph().prove({}, messages_, Precision::Mediump);
  ASSERT_TRUE(expected);
  const CProofs proofs(
      lacquer_graph_prove(graphOfC().get(), LACQUER_PRECISION_MEDIUMP, nullptr, c_messages_));
  ASSERT_EQ(lacquer_proofs_operation_count(proofs.get()), expected->operations.size());
  ASSERT_EQ(lacquer_proofs_claim_count(proofs.get()), expected->contracts.size());
  ASSERT_EQ(lacquer_proofs_output_count(proofs.get()), expected->outputs.size());
  size_t unsafe = 0;
  for (size_t i = 0; i < expected->operations.size(); ++i) {
    const OperationProof& proof = expected->operations[i];
    lacquer_operation row;
    ASSERT_EQ(lacquer_proofs_operation(proofs.get(), i, &row, sizeof row), 1);
    EXPECT_EQ(row.term, proof.term);
    EXPECT_EQ(row.operand, proof.operand);
    EXPECT_EQ(row.safe, proof.safe ? 1 : 0);
    EXPECT_EQ((Reached{row.low, row.high, row.nan != 0}), proof.reached);
    unsafe += proof.safe ? 0 : 1;
  }
  EXPECT_GT(unsafe, 0U) << "half precision proves less";
  for (size_t i = 0; i < expected->contracts.size(); ++i) {
    lacquer_claim row;
    ASSERT_EQ(lacquer_proofs_claim(proofs.get(), i, &row, sizeof row), 1);
    EXPECT_EQ(row.what, expected->contracts[i].what);
    EXPECT_EQ(row.proved, expected->contracts[i].proved ? 1 : 0);
  }
  lacquer_range output;
  ASSERT_EQ(lacquer_proofs_output(proofs.get(), 0, &output, sizeof output), 1);
  EXPECT_EQ(output.name, expected->outputs[0].name);
  EXPECT_EQ(lacquer_proofs_output(proofs.get(), expected->outputs.size(), &output, sizeof output), 0);
  EXPECT_EQ(lacquer_graph_prove(nullptr, LACQUER_PRECISION_IEEE, nullptr, c_messages_), nullptr);
  EXPECT_EQ(lacquer_nodes_prove(3, nullptr, c_messages_), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "empty-handle, unknown-enumerator");
}

TEST_F(Findings, ofStressTestsRunAgain) {
  const std::string faulty = (sourceFolder() / "tests/stress/faulty").string();
  const COptions options = optionsFrom("{\"node_directories\": [\"" + faulty + "\"]}", c_messages_);
  Options same;
  same.node_directories = {faulty};
  Stress stress;
  stress.samples = 2000;
  const Strings names = {"faulty_nan", "schlick"};
  const auto expected = stressNodes(stress, names, same, messages_);
  ASSERT_TRUE(expected) << messages_[0].text;
  const char* subjects[] = {"faulty_nan", "schlick"};
  const CStress found(lacquer_stress_run(subjects, 2, 2000, 1, LACQUER_FLOAT, options.get(), c_messages_));
  ASSERT_NE(found, nullptr) << c_messages_.takeCodes();
  EXPECT_EQ(lacquer_stress_subject_count(found.get()), expected->subjects.size());
  EXPECT_EQ(lacquer_stress_fault_count(found.get()), expected->faults);
  ASSERT_GT(lacquer_stress_finding_count(found.get()), 0U);
  lacquer_finding finding;
  ASSERT_EQ(lacquer_stress_finding(found.get(), 0, &finding, sizeof finding), 1);
  EXPECT_EQ(finding.node, names[0]);
  EXPECT_EQ(finding.fault, faultName(expected->subjects[0].findings[0].fault));
  EXPECT_EQ(finding.count, expected->subjects[0].findings[0].count);
  // Its case shows it again.
  const std::string path = (folder_ / "case.json").string();
  std::ofstream(path) << finding.test;
  const char* again[] = {path.c_str()};
  const CStress replayed(lacquer_stress_run(again, 1, 1, 1, LACQUER_FLOAT, options.get(), c_messages_));
  EXPECT_EQ(lacquer_stress_fault_count(replayed.get()), 1U) << c_messages_.takeCodes();
  EXPECT_EQ(lacquer_stress_run(subjects, 2, 2000, 1, LACQUER_DOUBLE, options.get(), c_messages_), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "unknown-enumerator");
}

TEST_F(Findings, ofLightProfiles) {
  const std::string lamp = (folder_ / "lamp.ies").string(), output = (folder_ / "lamp.dds").string();
  std::ofstream(lamp) << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n100 50\n";
  const char* files[] = {lamp.c_str(), lamp.c_str()};
  const CText found(lacquer_light_profiles(output.c_str(), files, 2, 0, 4, nullptr, c_messages_));
  ASSERT_NE(found, nullptr) << c_messages_.takeCodes();
  const auto json = nlohmann::json::parse(textOf(found));
  EXPECT_EQ(json["output"], output);
  EXPECT_EQ(json["profiles"][1]["width"], 256);
  EXPECT_EQ(json["profiles"][1]["height"], 4);
  EXPECT_EQ(json["profiles"][1]["peak"], 100.0);
  EXPECT_TRUE(fs::exists(output));
  EXPECT_NE(CText(lacquer_light_profiles(nullptr, files, 1, 0, 0, nullptr, c_messages_)), nullptr);
  EXPECT_EQ(CText(lacquer_light_profiles(nullptr, files, 1, 1, 0, nullptr, c_messages_)), nullptr);
  EXPECT_EQ(c_messages_.takeCodes(), "out-of-range");
}

TEST_F(Findings, ofSheetsAndLevels) {
  const std::string png = (folder_ / "sheet.png").string();
  const char* files[] = {file_.c_str()};
  const CSheet sheet(lacquer_sheet_draw(files, 1, png.c_str(), 16, "float", "double", nullptr, c_messages_));
  ASSERT_NE(sheet, nullptr) << c_messages_.takeCodes();
  EXPECT_TRUE(fs::exists(png));
  ASSERT_EQ(lacquer_sheet_difference_count(sheet.get()), lacquer_sheet_material_count(sheet.get()));
  lacquer_difference difference;
  ASSERT_EQ(lacquer_sheet_difference(sheet.get(), 0, &difference, sizeof difference), 1);
  EXPECT_EQ(difference.file, file_);
  EXPECT_GT(difference.largest, 0);
  EXPECT_EQ(lacquer_sheet_draw(files, 1, png.c_str(), 16, "float", nullptr, nullptr, c_messages_), nullptr);
  (void)c_messages_.takeCodes();

  const std::string work = (sourceFolder() / "bench/works/w0.gltf").string();
  const char* works[] = {work.c_str()};
  const std::string out = (folder_ / "levels").string();
  const COptions quick =
      optionsFrom(R"({"targets": ["spirv"], "lights": {"directional": 1}, "ibl": false, "validate": false})");
  const CLevels levels(lacquer_levels_make(works, 1, out.c_str(), 2, 1.0, 16, quick.get(), c_messages_));
  ASSERT_NE(levels, nullptr) << c_messages_.takeCodes();
  ASSERT_EQ(lacquer_levels_count(levels.get()), 2U);
  lacquer_level exact, simpler;
  ASSERT_EQ(lacquer_levels_level(levels.get(), 0, &exact, sizeof exact), 1);
  ASSERT_EQ(lacquer_levels_level(levels.get(), 1, &simpler, sizeof simpler), 1);
  EXPECT_EQ(exact.level, 0U);
  EXPECT_STREQ(exact.simplify, "");
  EXPECT_STRNE(simpler.simplify, "");
  EXPECT_LT(simpler.cost, exact.cost);
  EXPECT_GT(simpler.screen_size, 0U);
  EXPECT_TRUE(fs::exists(out + "/spirv/" + simpler.shader + ".frag.spv"));
  EXPECT_EQ(lacquer_levels_level(levels.get(), 2, &simpler, sizeof simpler), 0);
}

}  // namespace
}  // namespace lacquer::test::findings_test
