// Work and memory follow the input: twice as much of it costs twice the allocations and bytes, and not more
// than n log n of them. Counted, not timed: the numbers are the same on every machine.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <new>

#include "build/processes.h"
#include "lacquer.h"

namespace {

std::atomic<uint64_t> allocations{0};
std::atomic<uint64_t> allocated{0};

void* counted(std::size_t size) {
  ++allocations;
  allocated += size;
  void* at = std::malloc(size == 0 ? 1 : size);
  if (at == nullptr) throw std::bad_alloc();
  return at;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* at) noexcept { std::free(at); }
void operator delete[](void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
void operator delete[](void* at, std::size_t) noexcept { std::free(at); }

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

struct Cost {
  uint64_t allocations = 0, bytes = 0;
};

template <class Work>
Cost costOf(Work work) {
  const Cost before{allocations, allocated};
  work();
  return {allocations - before.allocations, allocated - before.bytes};
}

/// n log n from n to 2n costs 2 + 2 / log2(n), which is below 2.2 from a thousand on; a container that
/// doubles may just have done so.
constexpr double kMost = 2.6;

/// `work` for n, 2n and 4n; what is fixed has been paid before, by a run that does not count.
template <class Work>
void grows(const char* what, size_t n, Work work) {
  work(n / 10);
  std::array<Cost, 3> costs;
  for (size_t i = 0; i < costs.size(); ++i) costs[i] = costOf([&] { work(n << i); });
  for (size_t i = 0; i + 1 < costs.size(); ++i) {
    const double calls =
        static_cast<double>(costs[i + 1].allocations) / static_cast<double>(costs[i].allocations + 1);
    const double bytes = static_cast<double>(costs[i + 1].bytes) / static_cast<double>(costs[i].bytes + 1);
    EXPECT_LE(calls, kMost) << what << ": allocations, from " << (n << i);
    EXPECT_LE(bytes, kMost) << what << ": bytes, from " << (n << i);
  }
  std::cout << fmt::format("{}: {} to {}: {}, {}, {} allocations, {}, {}, {} KiB\n", what, n, 4 * n,
                           costs[0].allocations, costs[1].allocations, costs[2].allocations,
                           costs[0].bytes >> 10, costs[1].bytes >> 10, costs[2].bytes >> 10);
}

std::string listOf(size_t n, const std::function<std::string(size_t)>& item) {
  std::string text;
  for (size_t i = 0; i < n; ++i) text += (i == 0 ? "" : ",") + item(i);
  return text;
}

std::string materials(size_t n) {
  return R"({"asset":{"version":"2.0"},"materials":[)" +
         listOf(n,
                [](size_t i) {
                  return fmt::format(R"({{"name":"m{}","emissiveFactor":[{},0,0]}})", i,
                                     static_cast<double>(i % 997 + 1) / 1000);
                }) +
         "]}";
}

TEST(Growth, materials) {
  const fs::path folder = freshFolder("growth");
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.jobs = 1;
  options.sync = false;
  grows("materials", 10000, [&](size_t n) {
    writeText(folder / "in.gltf", materials(n));
    Messages messages;
    fs::remove_all(folder / "out");
    EXPECT_TRUE(
        generate({(folder / "in.gltf").string()}, {}, (folder / "out").string(), options, messages).ok);
  });
  fs::remove_all(folder.parent_path());
}

TEST(Growth, textures) {
  grows("textures", 10000, [](size_t n) {
    const std::string text = R"({"asset":{"version":"2.0"},"images":[{"uri":"a.png"}],"textures":[)" +
                             listOf(n, [](size_t) { return R"({"source":0})"; }) +
                             R"(],"materials":[{"normalTexture":{"index":)" + std::to_string(n - 1) + "}}]}";
    Messages messages;
    const Scene scene = Scene::fromMemory(text, "a.gltf", {}, messages);
    EXPECT_TRUE(scene.graph(0, kUnusedAttributes, {}, messages))
        << (messages.empty() ? "" : messages[0].text);
  });
}

/// A run over a file with so many entries of one kind, all of which the manifest lists.
void listed(const char* what, const std::function<std::string(size_t)>& text) {
  const fs::path folder = freshFolder("growth");
  Options options;
  options.targets = {Target::Spirv};
  options.validate = false;
  options.jobs = 1;
  options.sync = false;
  grows(what, 5000, [&](size_t n) {
    writeText(folder / "in.gltf",
              R"({"asset":{"version":"2.0"},"accessors":[{"count":3,"type":"VEC3","componentType":5126}],)" +
                  text(n) + "}");
    Messages messages;
    fs::remove_all(folder / "out");
    EXPECT_TRUE(
        generate({(folder / "in.gltf").string()}, {}, (folder / "out").string(), options, messages).ok)
        << (messages.empty() ? "" : messages[0].text);
  });
  fs::remove_all(folder.parent_path());
}

TEST(Growth, listedTextures) {
  listed("listed textures", [](size_t n) {
    return R"("images":[)" + listOf(n, [](size_t i) { return fmt::format(R"({{"uri":"{}.png"}})", i); }) +
           R"(],"samplers":[)" + listOf(n, [](size_t) { return R"({"wrapS":10497})"; }) +
           R"(],"textures":[)" +
           listOf(n, [](size_t i) { return fmt::format(R"({{"source":{},"sampler":{}}})", i, i); }) +
           R"(],"materials":[)" +
           listOf(n, [](size_t i) { return fmt::format(R"({{"emissiveTexture":{{"index":{}}}}})", i); }) +
           "]";
  });
}

TEST(Growth, primitives) {
  listed("primitives", [](size_t n) {
    return R"("materials":[{}],"meshes":[{"primitives":[)" +
           listOf(n, [](size_t) { return R"({"attributes":{"POSITION":0},"material":0})"; }) + "]}]";
  });
  listed("meshes", [](size_t n) {
    return R"("materials":[{}],"meshes":[)" +
           listOf(n,
                  [](size_t) { return R"({"primitives":[{"attributes":{"POSITION":0},"material":0}]})"; }) +
           "]";
  });
}

/// A name that stands in one object again and again.
TEST(Growth, doubledNames) {
  grows("doubled names", 10000, [](size_t n) {
    const std::string text = R"({"asset":{"version":"2.0"},"extras":{)" +
                             listOf(n, [](size_t i) { return fmt::format(R"("a{}":1,"a{}":2)", i, i); }) +
                             "}}";
    Messages messages;
    EXPECT_TRUE(Scene::fromMemory(text, "a.gltf", {}, messages));
    EXPECT_EQ(messages.size(), 20U);
  });
}

/// A chain of nodes, each over the one before, the last of them first in the file.
std::string chain(size_t n) {
  return R"({"lacquer_graph":1,"template":"bsdf","parameters":{"x":{"type":"float","value":0.5,"range":[0,1]}},"nodes":[)" +
         listOf(n,
                [n](size_t i) {
                  const size_t id = n - 1 - i;
                  const std::string from =
                      id == 0 ? R"({"parameter":"x"})" : fmt::format(R"({{"node":"n{}"}})", id - 1);
                  return fmt::format(R"({{"id":"n{}","node":"f0_from_ior","inputs":{{"ior":{}}}}})", id,
                                     from);
                }) +
         R"(],"outputs":{}})";
}

TEST(Growth, nodes) {
  // The limit of a graph stands at 10,000.
  grows("nodes", 2500, [](size_t n) {
    Messages messages;
    Graph graph = Graph::fromJson(chain(n), "a.json", messages);
    ASSERT_TRUE(graph) << messages[0].text;
    messages.clear();
    (void)graph.check(messages);
  });
}

/// Locals of one node; from 4,096 on there are too many, which costs no more to find.
TEST(Growth, locals) {
  const fs::path folder = freshFolder("growth");
  Options options;
  options.node_directories = {folder.string()};
  grows("locals", 10000, [&](size_t n) {
    std::string text =
        "/// D.\n/// source: S\nnode many(float x in [0, 1]) -> float in [0, 1] {\n    float v0 = x;\n";
    for (size_t i = 1; i < n; ++i) text += fmt::format("    float v{} = v{} * 0.5;\n", i, i - 1);
    writeText(folder / "many.node", text + fmt::format("    return clamp(v{}, 0, 1);\n}}\n", n - 1));
    Messages messages;
    (void)nodesJson(options, messages);
    EXPECT_EQ(messages.size(), n > 4096 ? 1U : 0U) << (messages.empty() ? "" : messages[0].text);
  });
  fs::remove_all(folder.parent_path());
}

}  // namespace
}  // namespace lacquer::test
