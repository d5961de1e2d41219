// The library as a whole: laziness, several files, threads, and what is embedded.
#include "lang/library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>
#include <tuple>

#include "lang/embedded.h"

namespace lacquer::lang {
namespace {

std::string node(const std::string& name, const std::string& body) {
  return "/// D.\n/// source: S\nnode " + name + "(float x) -> float { " + body + " }\n";
}

TEST(LangLibrary, ChecksOnlyWhatIsAskedFor) {
  const auto library = Library::fromFiles({{"a.node", node("good", "return x;") + node("bad", "return y;")}});
  ASSERT_TRUE(library);
  EXPECT_TRUE(library->node("good"));
  const auto bad = library->node("bad");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error()[0].code, "unknown-value");
  EXPECT_EQ(library->node("bad").error(), bad.error()) << "it is kept";
}

TEST(LangLibrary, ErrorsOfWhatIsCalledAreTold) {
  const auto library =
      Library::fromFiles({{"a.node", node("outer", "return inner(x);") + node("inner", "return y;")}});
  ASSERT_TRUE(library);
  const auto outer = library->node("outer");
  ASSERT_FALSE(outer);
  ASSERT_EQ(outer.error().size(), 1U);
  EXPECT_EQ(outer.error()[0].place.line, 6U);
}

TEST(LangLibrary, TheDefaultProfileIsKnownByItsHead) {
  const auto of = [](const std::string& text) {
    const auto library = Library::fromFiles({{"a.node", text}});
    const auto found = library->defaultProfile();
    return found ? *found : found.error()[0].code + " at " + std::to_string(found.error()[0].place.line);
  };
  const std::string plain = "/// P.\nprofile plain {}\n";
  EXPECT_EQ(of(plain + "/// D.\nprofile other /* { */ default { what is wrong }\n"), "other");
  EXPECT_EQ(of(plain), "wrong-profile at 2");
  EXPECT_EQ(of(plain + "profile a default {}\nprofile b default {}\n"), "wrong-profile at 4");
  EXPECT_EQ(of(plain + "profile defaults {}\n"), "wrong-profile at 3");
}

TEST(LangLibrary, UnknownNames) {
  const auto library =
      Library::fromFiles({{"a.node", node("schlick", "return x;") + "const float K = 1;\n"}});
  ASSERT_TRUE(library);
  EXPECT_EQ(format(library->node("schlik").error()[0]),
            "error: there is no node 'schlik' [unknown-node]\n  help: did you mean 'schlick'?");
  EXPECT_EQ(format(library->node("K").error()[0]),
            "error: there is no node 'K' [unknown-node]\n  help: 'K' is a constant");
  EXPECT_EQ(format(library->template_("x").error()[0]), "error: there is no template 'x' [unknown-template]");
  EXPECT_TRUE(library->has(DeclKind::Const, "K"));
  EXPECT_FALSE(library->has(DeclKind::Node, "K"));
}

TEST(LangLibrary, ADuplicateNamesBothPlaces) {
  const auto library =
      Library::fromFiles({{"a.node", node("f", "return x;")}, {"b.node", "\nconst float f = 1;\n"}});
  ASSERT_FALSE(library);
  EXPECT_EQ(format(library.error()[0]),
            "b.node:2:13: error: 'f' is declared twice [duplicate-name]\n"
            "  const float f = 1;\n"
            "              ^\n"
            "  help: the other, a node, is at a.node:3");
}

TEST(LangLibrary, AddKeepsPointersAndMendsErrors) {
  auto library = Library::fromFiles({{"a.node", node("f", "return x;") + node("g", "return late(x);")}});
  ASSERT_TRUE(library);
  const NodeDecl* f = *library->node("f");
  EXPECT_FALSE(library->node("g"));
  EXPECT_FALSE(library->add({{"b.node", node("h", "return x;") + node("f", "return x;")}}))
      << "f is there already";
  EXPECT_FALSE(library->has(DeclKind::Node, "h")) << "the library stays as it was";
  ASSERT_TRUE(library->add({{"c.node", node("late", "return x;")}}));
  EXPECT_TRUE(library->node("g"));
  EXPECT_EQ(*library->node("f"), f);
  EXPECT_EQ(f->name, "f");
}

TEST(LangLibrary, NamesAreSorted) {
  const auto library = Library::fromFiles({{"a.node", node("b", "return x;") + node("a", "return x;")}});
  ASSERT_TRUE(library);
  EXPECT_EQ(library->names(DeclKind::Node), (std::vector<std::string_view>{"a", "b"}));
  EXPECT_TRUE(library->names(DeclKind::Template).empty());
}

TEST(LangLibrary, LookupsOnManyThreads) {
  std::string text;
  for (int i = 0; i < 100; ++i) {
    const std::string callee = i == 0 ? "x" : "n" + std::to_string(i - 1) + "(x)";
    text += node("n" + std::to_string(i), "return " + callee + " * 2;");
  }
  const auto library = Library::fromFiles({{"a.node", text}});
  ASSERT_TRUE(library);
  std::vector<std::thread> threads;
  std::vector<int> found(4, 0);
  for (size_t t = 0; t < found.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 99; i >= 0; --i) found[t] += library->node("n" + std::to_string(i)).has_value() ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found, (std::vector<int>{100, 100, 100, 100}));
}

TEST(LangLibrary, ASignatureHasNoBodyUntilTheNodeIsAskedFor) {
  const Library library = Library::embedded();
  const auto head = library.signature("coat_absorption");
  ASSERT_TRUE(head);
  EXPECT_FALSE((*head)->params.empty());
  EXPECT_TRUE((*head)->body.statements.empty());
  const auto whole = library.node("coat_absorption");
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole, *head);
  EXPECT_FALSE((*whole)->body.statements.empty());
  EXPECT_FALSE((*library.signature("coat_absorption"))->body.statements.empty());
}

TEST(LangLibrary, SignaturesAreThoseOfTheNodes) {
  const Library lazy = Library::embedded(), whole = Library::embedded();
  for (const std::string_view name : whole.names(DeclKind::Node)) {
    const auto head = lazy.signature(name);
    const auto node = whole.node(name);
    ASSERT_TRUE(head && node) << name;
    const auto same = [&](const std::vector<Param>& a, const std::vector<Param>& b) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Param& x, const Param& y) {
        return x.type == y.type && x.name == y.name && x.has_range == y.has_range && x.range == y.range &&
               x.default_value == y.default_value && x.matrix_default == y.matrix_default &&
               x.given == y.given;
      });
    };
    EXPECT_TRUE(same((*head)->params, (*node)->params)) << name;
    EXPECT_TRUE(same((*head)->results, (*node)->results)) << name;
    EXPECT_EQ((*head)->name, (*node)->name);
  }
}

TEST(LangLibrary, AUsersSignatureIsCheckedWhole) {
  Library library = Library::embedded();
  ASSERT_TRUE(library.add({{"a.node", node("bad", "return y;")}}));
  const auto bad = library.signature("bad");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error()[0].code, "unknown-value");
}

TEST(LangLibrary, NamesOfGivensNeedNoCheck) {
  const Library lazy = Library::embedded(), whole = Library::embedded();
  ASSERT_TRUE(whole.checkAll().empty());
  const auto all = [](const Library& library) {
    std::set<std::string> names;
    for (const std::string_view one : library.names(DeclKind::Template)) {
      for (std::string& name : library.givenNames(one).names) names.insert(std::move(name));
    }
    return names;
  };
  EXPECT_EQ(all(lazy), all(whole));
  EXPECT_TRUE(all(lazy).contains("light_sample.L"));
}

TEST(LangLibrary, ALongChainIsAnError) {
  std::string text;
  for (int i = 0; i < 2000; ++i)
    text += node("n" + std::to_string(i), "return n" + std::to_string(i + 1) + "(x);");
  text += node("n2000", "return x;");
  const auto library = Library::fromFiles({{"a.node", text}});
  ASSERT_TRUE(library);
  const auto first = library->node("n0");
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error()[0].code, "too-deep");
}

TEST(LangLibrary, ManyErrorsEndInANote) {
  std::string text;
  for (int i = 0; i < 50; ++i) text += node("n" + std::to_string(i), "return y;");
  const auto library = Library::fromFiles({{"a.node", text}});
  ASSERT_TRUE(library);
  const Diagnostics found = library->checkAll();
  ASSERT_EQ(found.size(), 21U);
  EXPECT_EQ(format(found.back()), "note: there are more errors [more-errors]");
}

TEST(LangLibrary, EverythingEmbeddedChecks) {
  const Library library = Library::embedded();
  for (const Diagnostic& diagnostic : library.checkAll()) ADD_FAILURE() << format(diagnostic);
}

/// The table of names, made when the library is built, is what each file declares.
TEST(LangStandard, TheTableNamesWhatTheFilesDeclare) {
  const EmbeddedStandard standard = embeddedStandard();
  ASSERT_GT(standard.names.size(), 50U);
  std::set<std::tuple<std::string_view, uint16_t, bool>> told, declared;
  for (const EmbeddedName& name : standard.names) told.emplace(name.name, name.file, name.constant);
  EXPECT_EQ(told.size(), standard.names.size());
  EXPECT_TRUE(std::is_sorted(standard.names.begin(), standard.names.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
  std::vector<Library> libraries;  // names view into them
  for (size_t i = 0; i < standard.files.size(); ++i) {
    auto library =
        Library::fromFiles({{std::string(standard.files[i].name), std::string(standard.files[i].text)}});
    ASSERT_TRUE(library) << format(library.error()[0]);
    const auto file = static_cast<uint16_t>(i);
    for (const std::string_view name : library->names(DeclKind::Node))
      declared.emplace(name.substr(0, name.find('<')), file, false);
    for (const std::string_view name : library->names(DeclKind::Const)) declared.emplace(name, file, true);
    for (const DeclKind other : {DeclKind::Template, DeclKind::Extension, DeclKind::Part, DeclKind::Switch})
      EXPECT_TRUE(library->names(other).empty()) << "a standard file declares nodes and constants";
    libraries.push_back(std::move(*library));
  }
  EXPECT_EQ(told, declared);
}

TEST(LangStandard, ANodeIsThereWhenItIsNamed) {
  const Library library = Library::embedded();
  EXPECT_TRUE(library.has(DeclKind::Node, "add<vec3>"));
  EXPECT_FALSE(library.has(DeclKind::Node, "add"));
  EXPECT_FALSE(library.has(DeclKind::Node, "add<sampler2D>"));
  EXPECT_EQ(library.forms("add").size(), 12U);
  EXPECT_TRUE(library.node("mix<vec3, float>"));
  const auto near = library.node("subtrakt<vec3>");
  ASSERT_FALSE(near);
  EXPECT_NE(format(near.error()[0]).find("did you mean 'subtract<vec3>'"), std::string::npos);
}

/// Calls mean the built-in function, and names of values never a standard node.
TEST(LangStandard, TextsOfOnesOwnCallStandardNodes) {
  Library library = Library::embedded();
  ASSERT_TRUE(library.add({{"a.node",
                            "/// D.\n/// source: S\nnode mine(float range, vec3 v) -> vec3 {\n"
                            "  float mask = mix(range, 1, 0.5);\n"
                            "  return contrast(v, mask, STANDARD_DIVISOR_MIN);\n}\n"}}));
  const auto mine = library.node("mine");
  ASSERT_TRUE(mine) << format(mine.error()[0]);
  ASSERT_TRUE(library.add({{"b.node", node("more", "return rang;")}}));
  const auto more = library.node("more");
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error()[0].code, "unknown-value");
}

TEST(LangStandard, ANameIsDeclaredOnce) {
  Library library = Library::embedded();
  const auto twice = library.add({{"a.node", node("contrast", "return x;")}});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error()[0].code, "duplicate-name");
  EXPECT_NE(twice.error()[0].help.find("nodes/standard/adjustment.node:"), std::string::npos);
  // What the failure brought in went with it, and comes again.
  EXPECT_TRUE(library.node("contrast<vec2>"));
  EXPECT_FALSE(library.add({{"a.node", node("contrast", "return x;")}}));
  // Another form of one's own is one more of the name.
  const size_t forms = library.forms("contrast").size();
  ASSERT_TRUE(library.add(
      {{"b.node", "/// D.\n/// source: S\nnode contrast<mat3>(mat3 in) -> mat3 { return in; }\n"}}));
  EXPECT_EQ(library.forms("contrast").size(), forms + 1);
}

}  // namespace
}  // namespace lacquer::lang
