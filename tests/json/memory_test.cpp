// What takes no memory.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "json/json.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
size_t taken = 0;
}

void* operator new(size_t size) {
  ++taken;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace lacquer::json {
namespace {

TEST(JsonMemory, IsFreedWithoutTakingSome) {
  std::optional<Json> json =
      *parse(R"({"a": [1, {"b": [[], "text", {"c": null}]}], "d": {"e": 1.5}})", "a.json");
  size_t before = taken;
  dismantle(*json);
  json.reset();
  EXPECT_EQ(taken, before);
  // As the library frees it, it takes some.
  json = *parse(R"({"a": [1, {"b": 2}]})", "a.json");
  before = taken;
  json.reset();
  EXPECT_GT(taken, before);
}

}  // namespace
}  // namespace lacquer::json

#endif
