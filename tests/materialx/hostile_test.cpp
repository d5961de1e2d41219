// Documents of others: whatever they hold, there is a message or a material.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "material/material.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

std::string codesOf(const std::string& text, const std::string& name = "hostile.mtlx") {
  const auto document = materialsOf(text, name);
  std::string codes;
  const auto add = [&](const Diagnostics& list) {
    for (const Diagnostic& one : list) codes += (codes.empty() ? "" : " ") + one.code;
  };
  add(document ? document->diagnostics : document.error());
  if (document) {
    for (const material::Material& material : document->materials) add(material.diagnostics);
  }
  return codes;
}

std::string inDocument(const std::string& text) {
  return "<materialx version=\"1.39\">" + text + "</materialx>";
}

TEST(MaterialXHostile, entitiesAreOff) {
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b "
      "\"&a;&a;&a;&a;&a;&a;&a;&a;\">]>"
      "<materialx version=\"1.39\"><surface_unlit name=\"&b;\" type=\"surfaceshader\"/></materialx>";
  EXPECT_EQ(codesOf(bomb), "xml-syntax");
}

TEST(MaterialXHostile, bytesAreNoUtf8) {
  const auto with = [](std::string bytes) {
    return codesOf("<materialx version=\"1.39\"><!-- " + std::move(bytes) +
                   " --><output name=\"o\" type=\"float\" value=\"1\"/></materialx>");
  };
  for (const char* bad :
       {"\xE9", "\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x01", "\xEF\xBF\xBF"})
    EXPECT_EQ(with(bad), "xml-syntax") << bad;
  for (const char* good : {"\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "& < \""})
    EXPECT_NE(with(good), "xml-syntax") << good;
}

TEST(MaterialXHostile, elementsLieTooDeep) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  for (int i = 0; i < 100'000; ++i) deep += "</a>";
  EXPECT_EQ(codesOf(inDocument(deep)), "xml-too-deep");
}

/// UTF-8 alone is read, with its mark or without; of others the message names the encoding.
TEST(MaterialXHostile, encodings) {
  const std::string body = inDocument("<gltf_pbr name=\"s\" type=\"surfaceshader\"/>");
  const auto said = [](const std::string& text) {
    const auto document = materialsOf(text, "encoded.mtlx");
    return document ? std::string() : document.error()[0].code + ": " + document.error()[0].message;
  };
  const auto wide = [&](size_t bytes, bool big) {
    std::string text;
    for (const char c : "\x01" + body) {  // the first stands for the mark
      std::string unit(bytes, '\0');
      unit[big ? bytes - 1 : 0] = c == '\x01' ? '\xFF' : c;
      if (c == '\x01') unit[big ? bytes - 2 : 1] = '\xFE';
      text += unit;
    }
    return text;
  };
  EXPECT_EQ(said("\xEF\xBB\xBF" + body), "");
  EXPECT_EQ(said("<?xml version='1.0' encoding='utf-8'?>" + body), "");
  for (const bool big : {false, true}) {
    EXPECT_EQ(said(wide(2, big)), "xml-encoding: the document is in the encoding \"UTF-16\"");
    EXPECT_EQ(said(wide(2, big).substr(2)), "xml-encoding: the document is in the encoding \"UTF-16\"");
    EXPECT_EQ(said(wide(4, big).substr(4)), "xml-encoding: the document is in the encoding \"UTF-32\"");
  }
  EXPECT_EQ(said(wide(4, false)), "xml-encoding: the document is in the encoding \"UTF-32\"");
  EXPECT_EQ(said("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + body),
            "xml-encoding: the document is in the encoding \"ISO-8859-1\"");
}

TEST(MaterialXHostile, halfAFile) {
  const std::string whole = inDocument(
      "<gltf_pbr name=\"s\" type=\"surfaceshader\"><input name=\"metallic\" type=\"float\" "
      "value=\"0.5\"/></gltf_pbr>"
      "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
      "nodename=\"s\"/></surfacematerial>");
  EXPECT_EQ(codesOf(whole), "");
  for (size_t size = 1; size < whole.size(); ++size) EXPECT_NE(codesOf(whole.substr(0, size)), "") << size;
}

/// A hundred thousand nodes, one behind the other.
TEST(MaterialXHostile, nodesInARow) {
  std::string nodes =
      "<texel_product name=\"n0\" type=\"float\"><input name=\"a\" type=\"float\" value=\"1\"/>"
      "<input name=\"b\" type=\"float\" value=\"1\"/></texel_product>";
  constexpr int kCount = 100'000;
  for (int i = 1; i < kCount; ++i)
    nodes += fmt::format(
        "<texel_product name=\"n{}\" type=\"float\"><input name=\"a\" type=\"float\" nodename=\"n{}\"/>"
        "<input name=\"b\" type=\"float\" nodename=\"n{}\"/></texel_product>",
        i, i - 1, i - 1);
  nodes += fmt::format("<output name=\"o\" type=\"float\" nodename=\"n{}\"/>", kCount - 1);
  EXPECT_NE(codesOf(inDocument(nodes)).find("too-many"), std::string::npos)
      << codesOf(inDocument(nodes)).substr(0, 400);
}

/// Outputs, inputs and attributes without end are refused before each is compared with all others.
TEST(MaterialXHostile, portsWithoutEnd) {
  constexpr int kCount = 60'000;
  std::string outputs = "<nodegraph name=\"NG\"><constant name=\"c\" type=\"float\"/>";
  for (int i = 0; i < kCount; ++i)
    outputs += fmt::format("<output name=\"o{}\" type=\"float\" nodename=\"c\"/>", i);
  EXPECT_EQ(codesOf(inDocument(outputs + "</nodegraph>")), "too-many");
  std::string ports, given;
  for (int i = 0; i < kCount; ++i) {
    ports += fmt::format("<input name=\"i{}\" type=\"float\" value=\"0.5\"/>", i);
    given += fmt::format("<input name=\"i{}\" type=\"float\" value=\"0.25\"/>", kCount - 1 - i);
  }
  const std::string definition =
      "<nodedef name=\"ND_own\" node=\"own\">" + ports + "<output name=\"out\" type=\"float\"/></nodedef>" +
      "<nodegraph name=\"NG_own\" nodedef=\"ND_own\"><output name=\"out\" type=\"float\" "
      "interfacename=\"i7\"/></nodegraph>";
  EXPECT_EQ(codesOf(inDocument(definition + "<nodegraph name=\"NG\"><own name=\"n\" type=\"float\">" + given +
                               "</own><output name=\"out\" type=\"float\" nodename=\"n\"/></nodegraph>")),
            "too-many wrong-pattern");
  std::string attributes = "<nodegraph name=\"NG\"";
  for (int i = 0; i < kCount; ++i) attributes += fmt::format(" a{}=\"\"", i);
  EXPECT_EQ(codesOf(inDocument(attributes + "/>")), "xml-too-many");
}

/// Disabled nodes of a name with many definitions, which are of other types: each gives 0, soon.
TEST(MaterialXHostile, disabledNodesWithoutEnd) {
  constexpr int kCount = 60'000;
  std::string document, nodes;
  for (int i = 0; i < kCount; ++i) {
    document += fmt::format(
        "<nodedef name=\"ND_{0}\" node=\"own\"><output name=\"out\" type=\"vector2\"/></nodedef>", i);
    nodes += fmt::format(
        "<own name=\"n{}\" type=\"float\"><input name=\"disable\" type=\"boolean\" value=\"true\"/></own>",
        i);
  }
  EXPECT_EQ(codesOf(inDocument(document + "<nodegraph name=\"NG\">" + nodes +
                               "<output name=\"out\" type=\"float\" nodename=\"n7\"/></nodegraph>")),
            "");
}

/// Definitions of two of the one before each: the place is that of the node with which they are too many.
TEST(MaterialXHostile, definitionsThatDouble) {
  std::string document =
      "<nodedef name=\"ND_d0\" node=\"d0\"><output name=\"out\" type=\"float\"/></nodedef>"
      "<nodegraph name=\"NG_d0\" nodedef=\"ND_d0\"><constant name=\"c\" type=\"float\"/>"
      "<output name=\"out\" type=\"float\" nodename=\"c\"/></nodegraph>";
  for (int i = 1; i < 20; ++i)
    document += fmt::format(
        "<nodedef name=\"ND_d{0}\" node=\"d{0}\"><output name=\"out\" type=\"float\"/></nodedef>"
        "<nodegraph name=\"NG_d{0}\" nodedef=\"ND_d{0}\"><d{1} name=\"x\" type=\"float\"/>"
        "<d{1} name=\"y\" type=\"float\"/><add name=\"sum\" type=\"float\"><input name=\"in1\" "
        "type=\"float\" "
        "nodename=\"x\"/><input name=\"in2\" type=\"float\" nodename=\"y\"/></add>"
        "<output name=\"out\" type=\"float\" nodename=\"sum\"/></nodegraph>\n",
        i, i - 1);
  document +=
      "<nodegraph name=\"NG\"><d19 name=\"v\" type=\"float\"/>"
      "<output name=\"out\" type=\"float\" nodename=\"v\"/></nodegraph>";
  EXPECT_EQ(codesOf(inDocument(document)), "graph-too-large wrong-pattern");
}

/// Looks that inherit from each other, collections in a ring, groups of groups, and every variant for every
/// material: each is told, and none takes long.
TEST(MaterialXHostile, looksWithoutEnd) {
  const std::string material =
      "<surface_unlit name=\"s\" type=\"surfaceshader\"/>"
      "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
      "nodename=\"s\"/></surfacematerial>";
  constexpr int kCount = 20'000;
  std::string looks = material, circle = material, ring = material, groups = material + "<look name=\"z\"/>";
  std::string variants = material + "<variantset name=\"v\" node=\"surface_unlit\">";
  for (int i = 0; i < kCount; ++i) {
    looks += fmt::format(
        "<look name=\"l{}\" inherit=\"l{}\"><materialassign material=\"m\" geom=\"/a\"/></look>", i, i + 1);
    circle +=
        fmt::format("<look name=\"l{}\" inherit=\"l{}\"><materialassign material=\"m\" geom=\"/a\"/></look>",
                    i, (i + 1) % kCount);
    ring += fmt::format("<collection name=\"c{}\" includecollection=\"c{}\"/>", i, (i + 1) % kCount);
    groups += fmt::format("<lookgroup name=\"g{}\" looks=\"g{},g{},z\"/>", i, i + 1, i + 2);
    variants += fmt::format(
        "<variant name=\"x{}\"><input name=\"emission\" type=\"float\" value=\"1\"/></variant>", i);
  }
  EXPECT_EQ(codesOf(inDocument(looks)), "too-many no-such-look");
  EXPECT_EQ(codesOf(inDocument(circle)), "look-cycle too-many");
  EXPECT_EQ(codesOf(inDocument(ring)), "collection-cycle");
  EXPECT_NE(codesOf(inDocument(groups)).find("too-many"), std::string::npos);
  EXPECT_EQ(codesOf(inDocument(variants + "</variantset>")), "too-many");
}

TEST(MaterialXHostile, circles) {
  EXPECT_NE(
      codesOf(inDocument(
                  "<nodegraph name=\"g\"><texel_normal name=\"a\" type=\"vector3\"><input name=\"normal\" "
                  "type=\"vector3\" nodename=\"b\"/></texel_normal><texel_normal name=\"b\" "
                  "type=\"vector3\"><input name=\"normal\" type=\"vector3\" nodename=\"a\"/></texel_normal>"
                  "<output name=\"o\" type=\"vector3\" nodename=\"a\"/></nodegraph>"))
          .find("cycle"),
      std::string::npos);
  EXPECT_NE(codesOf(inDocument("<nodegraph name=\"g\"><output name=\"a\" type=\"float\" output=\"b\"/>"
                               "<output name=\"b\" type=\"float\" output=\"a\"/></nodegraph>"))
                .find("too-deep"),
            std::string::npos);
  EXPECT_NE(
      codesOf(
          inDocument("<nodedef name=\"d\" node=\"mine\" type=\"float\"/><nodegraph name=\"g\" nodedef=\"d\">"
                     "<mine name=\"m\" type=\"float\"/><output name=\"out\" type=\"float\" nodename=\"m\"/>"
                     "</nodegraph><mine name=\"top\" type=\"float\"/>"
                     "<output name=\"out\" type=\"float\" nodename=\"top\"/>"))
          .find("cycle"),
      std::string::npos);
  // Surfaces whose definitions are each other.
  std::string surfaces = "<a name=\"s\" type=\"surfaceshader\"/>";
  for (const auto& [own, other] : {std::pair("a", "b"), std::pair("b", "a")})
    surfaces += fmt::format(
        "<nodedef name=\"ND_{0}\" node=\"{0}\"><output name=\"out\" type=\"surfaceshader\"/></nodedef>"
        "<nodegraph name=\"NG_{0}\" nodedef=\"ND_{0}\"><{1} name=\"x\" type=\"surfaceshader\"/>"
        "<output name=\"out\" type=\"surfaceshader\" nodename=\"x\"/></nodegraph>",
        own, other);
  EXPECT_NE(codesOf(inDocument(surfaces)).find("cycle"), std::string::npos);
}

/// Names that no target takes, and none at all.
TEST(MaterialXHostile, names) {
  for (const std::string name :
       {"float", "1", "a b", "*/ }", "\xC3\xA4", "__", "gl_Position", "main", "in", "$", "a.b/c"}) {
    const auto document = materialsOf(
        inDocument("<nodegraph name=\"" + name + "\"><texel_normal name=\"" + name +
                   "\" type=\"vector3\"><input "
                   "name=\"normal\" type=\"vector3\" value=\"1, 0, 0\"/></texel_normal><output name=\"" +
                   name + "\" type=\"vector3\" nodename=\"" + name + "\"/></nodegraph>"),
        "names.mtlx");
    ASSERT_TRUE(document || document.error()[0].code != "") << name;
    if (!document) continue;
    for (const material::Material& material : document->materials)
      EXPECT_FALSE(hasError(material.diagnostics)) << name;
  }
}

TEST(MaterialXHostile, numbers) {
  for (const std::string value :
       {"nan", "inf", "-inf", "1e999", "0,5", "1;2", "0x10", "", "1 2", "1,", "\xD9\xA1"}) {
    const std::string codes = codesOf(inDocument(
        "<gltf_pbr name=\"s\" type=\"surfaceshader\"><input name=\"metallic\" type=\"float\" value=\"" +
        value + "\"/></gltf_pbr>"));
    EXPECT_EQ(codes, "wrong-value") << value;
  }
}

class Folder {
public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("lacquer-mtlx-{}", std::chrono::steady_clock::now().time_since_epoch().count())) {
    std::filesystem::create_directories(path_ / "inner");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

private:
  std::filesystem::path path_;
};

TEST(MaterialXHostile, includes) {
  const Folder folder;
  const std::string surface = "<surface_unlit name=\"s\" type=\"surfaceshader\"/>";
  const auto included = [](const std::string& href) {
    return inDocument("<xi:include href=\"" + href + "\"/>");
  };
  (void)folder.write("surface.mtlx", inDocument(surface));
  (void)folder.write("inner/up.mtlx", included("../surface.mtlx"));
  const auto codes = [&](const std::string& text) { return codesOf(text, folder.write("top.mtlx", text)); };
  EXPECT_EQ(codes(included("surface.mtlx")), "");
  EXPECT_EQ(codes(included("inner/up.mtlx")), "");
  EXPECT_EQ(codes(included("missing.mtlx")), "include-missing");
  EXPECT_EQ(codes(included("../outside.mtlx")), "include-outside");
  EXPECT_EQ(codes(included("/etc/passwd")), "include-outside");
  EXPECT_EQ(codes(included("https://example.com/a.mtlx")), "include-outside");
  (void)folder.write("circle.mtlx", included("circle.mtlx"));
  EXPECT_EQ(codes(included("circle.mtlx")), "include-cycle");
}

}  // namespace
}  // namespace lacquer::test
