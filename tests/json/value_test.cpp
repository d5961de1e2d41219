// The tree of JSON: what it reads, writes and says is what nlohmann::json does, except that it is destroyed
// without asking for memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <random>

#include "json/json.h"
#include "json/report.h"

namespace {
std::atomic<bool> no_memory{false};
}  // namespace

[[gnu::noinline]] void* operator new(size_t size) {
  void* const at = no_memory ? nullptr : std::malloc(size == 0 ? 1 : size);
  if (at == nullptr) throw std::bad_alloc();
  return at;
}
[[gnu::noinline]] void operator delete(void* at) noexcept { std::free(at); }
[[gnu::noinline]] void operator delete(void* at, size_t) noexcept { std::free(at); }

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

TEST(Value, isWrittenAsTheLibraryWritesIt) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 3000; ++round) {
    const std::string text = randomText(random, 5);
    const Result<Json> json = parse(text, "random");
    ASSERT_TRUE(json) << text;
    const auto other = nlohmann::ordered_json::parse(text);
    ASSERT_EQ(json->dump(), other.dump()) << text;
    ASSERT_EQ(json->dump(2), other.dump(2)) << text;
    EXPECT_EQ(reread(json->dump()), *json) << text;
    const Json copy = *json;
    EXPECT_EQ(copy, *json) << text;
  }
}

/// As when one allocation has failed and what was made until then is taken down.
TEST(Value, isDestroyedWithoutMemory) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 300; ++round) {
    Json json = *parse("[" + randomText(random, 6) + ", {\"a\": [1, [2, {\"b\": [3]}]]}]", "random");
    no_memory = true;
    json = Json();
    no_memory = false;
    EXPECT_TRUE(json.is_null());
  }
}

TEST(Value, bracesMakeObjectsOfPairs) {
  const std::string name = "n";
  const std::vector<std::string_view> words = {"a", "b"};
  const Json json = {{"name", name}, {"list", {1, 2U, 0.5}}, {"words", words}, {"inner", {{"x", true}}}};
  EXPECT_EQ(json.dump(), R"({"name":"n","list":[1,2,0.5],"words":["a","b"],"inner":{"x":true}})");
  EXPECT_EQ((Json{"a", "b"}).dump(), R"(["a","b"])");
  EXPECT_EQ(Json::array({Json("a")}).dump(), R"(["a"])");
  EXPECT_EQ(Json::object().dump(2) + Json::array().dump(2), "{}[]");
}

TEST(Value, bytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(Json("a\xff"
                 "b")
                .dump(),
            "\"a\xef\xbf\xbd"
            "b\"");
  EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
}

TEST(Value, membersAreFoundAddedAndRemoved) {
  Json json;
  json["b"]["c"] = 1;
  json["a"] = "x";
  json["b"]["c"] = 2;
  EXPECT_EQ(json.dump(), R"({"b":{"c":2},"a":"x"})");
  json.update({{"a", 3}, {"d", nullptr}});
  json.erase("b");
  EXPECT_EQ(json.dump(), R"({"a":3,"d":null})");
  const Json& same = json;
  EXPECT_TRUE(same["nothing"].is_null());
  EXPECT_TRUE(same["a"][5].is_null());
  EXPECT_TRUE(same.contains("d"));
  EXPECT_FALSE(same.contains("b"));
  EXPECT_EQ(same.size(), 2U);
}

TEST(Value, numbersBecomeEachOther) {
  EXPECT_EQ(Json(-1).get<uint32_t>(), 0U);
  EXPECT_EQ(Json(1e300).get<int64_t>(), std::numeric_limits<int64_t>::max());
  EXPECT_EQ(Json(-1e300).get<int>(), std::numeric_limits<int>::min());
  EXPECT_EQ(Json(uint64_t{1} << 63).get<int64_t>(), std::numeric_limits<int64_t>::max());
  EXPECT_EQ(Json(2.9).get<int>(), 2);
  EXPECT_EQ(Json(7U), Json(7));
  EXPECT_EQ(Json(7U), Json(7.0));
  EXPECT_FALSE(Json(-1) == Json(std::numeric_limits<uint64_t>::max()));
}

TEST(Value, anotherKindIsRefused) {
  EXPECT_THROW((void)Json("1").get<double>(), std::logic_error);
  EXPECT_THROW((void)Json(1).get<bool>(), std::logic_error);
  EXPECT_THROW((void)Json(1).text(), std::logic_error);
  EXPECT_THROW((void)Json::array().items(), std::logic_error);
  EXPECT_THROW((void)reread("[1,"), std::logic_error);
}

/// A large object that was read finds its members by an index; one that is changed, without.
TEST(JsonValue, membersOfLargeObjectsAreFound) {
  constexpr size_t kMany = 1000;
  std::string text = "{";
  for (size_t i = 0; i < kMany; ++i)
    text += fmt::format(R"({}"m{}": {})", i == 0 ? "" : ", ", i * 7919 % kMany, i);
  Json json = *parse(text + R"(, "m3": "twice"})", "a.json", {}, Doubles::LastCounts);
  const auto all = [&] {
    for (size_t i = 0; i < kMany; ++i) {
      const std::string name = fmt::format("m{}", i * 7919 % kMany);
      ASSERT_NE(json.find(name), nullptr) << name;
      EXPECT_EQ(*json.find(name), name == "m3" ? Json("twice") : Json(i));
    }
    for (const char* absent : {"", "a", "m", "m1000", "z"}) EXPECT_EQ(json.find(absent), nullptr);
  };
  all();
  const Json copy = json;
  EXPECT_EQ(copy["m7"], json["m7"]);
  json["new"] = 1;
  EXPECT_EQ(json["new"], Json(1));
  json.erase("new");
  EXPECT_EQ(json.find("new"), nullptr);
  all();
  json.index();
  json.items().insert(json.items().begin(), {"first", Json(2)});
  EXPECT_EQ(json["first"], Json(2));
  all();
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
