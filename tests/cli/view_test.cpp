// `lacquer view`: files go into a page whole, with what they name, and nothing of theirs becomes markup.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test::view_test {
namespace {

using nlohmann::json;

const std::string kHead = R"(<html><script type="application/json" id="files">)";
const std::string kTail = "</script></html>\n";

class View : public testing::Test {
protected:
  void SetUp() override {
    place_.write("page.html", kHead + "[]" + kTail);
    place_.write("a/data.bin", "four");
  }
  Outcome view(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"view", "-o", "out.html", "--page", "page.html"});
    return place_.run(arguments);
  }
  /// What stands in the page's place for files.
  json files() const {
    const std::string page = place_.read("out.html");
    EXPECT_TRUE(page.starts_with(kHead));
    EXPECT_TRUE(page.ends_with(kTail));
    return json::parse(page.substr(kHead.size(), page.size() - kHead.size() - kTail.size()), nullptr, false);
  }
  static std::string naming(const std::string& uri) {
    return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": ")" + uri + R"("}]})";
  }

  Workplace place_;
};

TEST_F(View, aFileIsPutInWithWhatItNames) {
  place_.write("a/file.gltf", naming("data.bin"));
  const Outcome good = view({"a/file.gltf"});
  EXPECT_EQ(good.status, 0) << good.all();
  EXPECT_EQ(good.out, "1 file in out.html\n");
  const json expected = {
      {{"name", "file.gltf"},
       {"bytes",
        "eyJhc3NldCI6IHsidmVyc2lvbiI6ICIyLjAifSwgImJ1ZmZlcnMiOiBbeyJieXRlTGVuZ3RoIjogNCwgInVyaSI6"
        "ICJkYXRhLmJpbiJ9XX0="},
       {"resources", {{{"uri", "data.bin"}, {"bytes", "Zm91cg=="}}}}}};
  EXPECT_EQ(files(), expected);
}

TEST_F(View, whatIsAbsentIsLeftOutWithAWarning) {
  place_.write("file.gltf", naming("absent.bin"));
  const Outcome outcome = view({"file.gltf"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(outcome.err.find("warning: \"absent.bin\" cannot be read"), std::string::npos) << outcome.err;
  EXPECT_EQ(files()[0]["resources"], json::array());
}

TEST_F(View, noFileOutsideOfTheFoldersIsPutIn) {
  place_.write("secret.bin", "secret");
  place_.write("a/file.gltf", naming("../secret.bin"));
  const Outcome outcome = view({"a/file.gltf"});
  EXPECT_NE(outcome.err.find("[image-outside]"), std::string::npos) << outcome.err;
  EXPECT_EQ(files()[0]["resources"], json::array());
  EXPECT_EQ(view({"a/file.gltf", "--allow", "."}).status, 0);
  EXPECT_EQ(files()[0]["resources"][0]["bytes"], "c2VjcmV0");
}

TEST_F(View, whatShadersCostIsPutInByTheirIds) {
  const std::string costs = R"(<script type="application/json" id="costs">)";
  place_.write("page.html", kHead + "[]</script>" + costs + "{}" + kTail);
  place_.write("file.gltf", R"({"asset": {"version": "2.0"}, "materials": [{"name": "plain"}]})");
  const auto put_in = [&] {
    const std::string page = place_.read("out.html");
    const size_t from = page.find(costs) + costs.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from), nullptr, false);
  };
  ASSERT_EQ(view({"file.gltf", "--no-cost"}).status, 0);
  EXPECT_EQ(put_in(), json::object());
  ASSERT_EQ(view({"file.gltf"}).status, 0);
  const json measured = put_in();
  ASSERT_EQ(measured.size(), 1U) << measured;
  EXPECT_TRUE(measured.begin().key().starts_with("forward-base-")) << measured;
  EXPECT_GT((*measured.begin())["spirv"], 50);
}

TEST_F(View, namesDoNotBecomeMarkup) {
  const std::string name = "<script>x.gltf";
  place_.write(name, naming("<!--.bin"));
  place_.write("<!--.bin", "four");
  const Outcome outcome = view({name});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(place_.read("out.html").find('<', kHead.size()), place_.read("out.html").find(kTail));
  EXPECT_EQ(files()[0]["name"], name);
  EXPECT_EQ(files()[0]["resources"][0]["uri"], "<!--.bin");
}

TEST_F(View, withoutThePageOrTheFileItSaysSo) {
  place_.write("file.gltf", naming("x"));
  place_.write("other.html", "<html></html>");
  for (const char* page : {"no-page.html", "other.html"}) {
    const Outcome outcome = place_.run({"view", "file.gltf", "-o", "out.html", "--page", page});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    EXPECT_NE(outcome.err.find("[no-page]"), std::string::npos) << outcome.err;
  }
  place_.write("broken.gltf", "{");
  for (const char* file : {"absent.gltf", "broken.gltf"}) EXPECT_EQ(view({file}).status, 1) << file;
  EXPECT_FALSE(place_.has("out.html"));
  const Outcome over = place_.run({"view", "file.gltf", "-o", "file.gltf", "--page", "page.html"});
  EXPECT_EQ(over.status, 1) << over.all();
  EXPECT_EQ(place_.read("file.gltf"), naming("x"));
}

}  // namespace
}  // namespace lacquer::test::view_test
