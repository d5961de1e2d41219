// What readers and writers of JSON ask beside the library: its own reader, and values whatever their kind.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "json/json.h"
#include "json/report.h"

namespace lacquer::json {
namespace {

/// Text of a random value; `depth` bounds what lies within.
std::string randomText(std::mt19937_64& random, int depth) {
  static const char* const kScalars[] = {"null",
                                         "true",
                                         "false",
                                         "0",
                                         "-1",
                                         "18446744073709551615",
                                         "-9223372036854775808",
                                         "1.5",
                                         "-0.0",
                                         "1e-7",
                                         "1e300",
                                         "123456789012345678901234567890",
                                         "0.1",
                                         "\"\"",
                                         "\"text\"",
                                         "\"\\u0001\\\"\\\\\\n\"",
                                         "\"é€\""};
  const auto below = [&](size_t n) { return static_cast<size_t>(random() % n); };
  const size_t kind = depth == 0 ? 2 : below(3);
  if (kind == 2) return kScalars[below(std::size(kScalars))];
  std::string text(1, kind == 0 ? '[' : '{');
  const size_t count = below(4);
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) text += ',';
    if (kind == 1) text += fmt::format("\"key {} {}\": ", below(100), i);
    text += randomText(random, depth - 1);
  }
  return text + (kind == 0 ? ']' : '}');
}

TEST(Value, isReadAsTheLibraryReadsIt) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 3000; ++round) {
    const std::string text = randomText(random, 5);
    const Result<Json> json = parse(text, "random");
    ASSERT_TRUE(json) << text;
    ASSERT_EQ(*json, Json::parse(text)) << text;
    ASSERT_EQ(reread(dump(*json)), *json) << text;
    ASSERT_EQ(reread(dump(*json, 2)), *json) << text;
  }
}

/// The library's own reader takes the last one, too, in the place of the first.
TEST(Value, theLastOfOneNameCountsInItsPlace) {
  const std::string text = R"({"a": 1, "b": {"c": [0, {"x": 1, "x": 2}]}, "a": 3})";
  const Result<Json> json = parse(text, "a.json");
  ASSERT_TRUE(json);
  EXPECT_EQ(dump(*json), R"({"b":{"c":[0,{"x":2}]},"a":3})");
  const Result<Json> refused = parse(text, "a.json", {}, Doubles::Refused);
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().size(), 2U);
  EXPECT_EQ(refused.error()[0].place.pointer, "/b/c/1/x");
  EXPECT_EQ(refused.error()[1].place.pointer, "/a");
}

TEST(Value, bytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(dump("a\xff"
                 "b"),
            "\"a\xef\xbf\xbd"
            "b\"");
  EXPECT_EQ(dump(std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(quotedText("a\"\xff"), "\"a\\\"\xef\xbf\xbd\"");
}

/// The last chunk of a GLB may be padded; what follows would be read by nobody.
TEST(Value, nothingFollowsANul) {
  using namespace std::string_literals;
  EXPECT_TRUE(parse("{}\0\0"s, "a.json"));
  const Result<Json> more = parse("{\n}\0 [[[ \""s, "a.json");
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error()[0].code, "json-syntax");
  EXPECT_EQ(more.error()[0].place.line, 2U);
  EXPECT_FALSE(parse("{}\0\0{}"s, "a.json"));
  EXPECT_FALSE(parse("{\"a\0\": 1}"s, "a.json"));
}

/// Whatever a file has where a reader looks, and wherever the reader looks in it.
TEST(Value, membersAndElementsOfAnyKind) {
  for (const char* text :
       {"null", "true", "1", "-1", "1.5", "\"a\"", "[]", "[1, 2]", "{}", R"({"a": null})"}) {
    const Json json = *parse(text, "a.json");
    EXPECT_EQ(member(json, "b"), nullptr) << text;
    EXPECT_TRUE(at(json, "a").is_null()) << text;
    EXPECT_EQ(elements(json).size(), json.is_array() ? json.size() : 0U) << text;
    EXPECT_EQ(arraySize(json, "a"), 0U) << text;
    EXPECT_FALSE(describe(json).empty()) << text;
  }
  const Json json = *parse(R"({"a": [1, "x"]})", "a.json");
  EXPECT_EQ(text(elements(at(json, "a"))[1]), "x");
  EXPECT_THROW((void)lacquer::json::text(json), nlohmann::json::type_error);
  EXPECT_THROW((void)reread("[1,"), std::logic_error);
}

/// Members are put in their places at once: the time is in proportion to their number.
TEST(Value, largeObjectsKeepTheirOrder) {
  constexpr size_t kMany = 200'000;
  std::string text = "{";
  for (size_t i = 0; i < kMany; ++i)
    text += fmt::format(R"({}"m{}": {})", i == 0 ? "" : ", ", i * 7919 % kMany, i);
  const Json json = *parse(text + R"(, "m3": "twice"})", "a.json");
  ASSERT_EQ(json.size(), kMany);
  size_t place = 0;
  for (const auto& [name, value] : json.items()) {
    while (place * 7919 % kMany == 3) ++place;
    if (name == "m3") continue;
    ASSERT_EQ(name, fmt::format("m{}", place * 7919 % kMany));
    ASSERT_EQ(value, place++);
  }
  EXPECT_EQ(at(json, "m3"), "twice");
}

/// A large object that was read finds its members by an index; one that is changed, without.
TEST(Value, membersOfLargeObjectsAreFound) {
  constexpr size_t kMany = 1000;
  std::string text = "{";
  for (size_t i = 0; i < kMany; ++i)
    text += fmt::format(R"({}"m{}": {})", i == 0 ? "" : ", ", i * 7919 % kMany, i);
  Json json = *parse(text + R"(, "m3": "twice"})", "a.json");
  const auto all = [&] {
    for (size_t i = 0; i < kMany; ++i) {
      const std::string name = fmt::format("m{}", i * 7919 % kMany);
      ASSERT_NE(member(json, name), nullptr) << name;
      EXPECT_EQ(*member(json, name), name == "m3" ? Json("twice") : Json(i));
    }
    for (const char* absent : {"", "a", "m", "m1000", "z"}) EXPECT_EQ(member(json, absent), nullptr);
  };
  all();
  const Json copy = json;
  EXPECT_EQ(at(copy, "m7"), at(json, "m7"));
  json["new"] = 1;
  EXPECT_EQ(at(json, "new"), 1);
  json.erase("new");
  EXPECT_EQ(member(json, "new"), nullptr);
  all();
  json.push_back({"later", 2});
  EXPECT_EQ(at(json, "later"), 2);
}

/// However long what it names, and however much is wrong.
TEST(JsonReport, isBounded) {
  const std::string file = "a.json";
  Diagnostics said;
  Report report(file, said);
  const Path root;
  const std::string name(100'000, '\xC3');
  const Path path(root, name);
  for (size_t i = 0; i < 3 * kMostDiagnostics; ++i) report.warning("odd", Path(path, i), "it is odd");
  ASSERT_EQ(said.size(), kMostDiagnostics + 1);
  EXPECT_EQ(said.back().code, "more-diagnostics");
  EXPECT_FALSE(hasError(said));
  EXPECT_LT(said[0].place.pointer.size(), 1100U);
  report.error("wrong", path, "it is wrong");
  EXPECT_EQ(said.size(), kMostDiagnostics + 1);
  EXPECT_TRUE(hasError(said));
}

}  // namespace
}  // namespace lacquer::json
