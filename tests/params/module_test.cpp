// The js target: what Node makes of its modules must be what the library packs, to the bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "../build/processes.h"
#include "packs.h"
#include "support/cases.h"
#include "targets/target.h"

namespace lacquer::test::module_test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kNoNode = "NOT TESTED: there is no node (Debian: nodejs)";

bool haveProgram(const char* name) {
  return runProgram({"sh", "-c", fmt::format("command -v {}", name)}, fs::temp_directory_path()) == 0;
}

struct ModuleCase {
  std::string id, code, types;
  std::vector<Numbers> rows;
  std::vector<std::string> expected;  ///< bytes, row by row
};

/// JSON has no infinities.
Json numberOf(double x) { return std::isfinite(x) ? Json(x) : Json(x > 0 ? "Infinity" : "-Infinity"); }

/// A row as an object: vectors as arrays, truths as truths.
Json objectOf(const Numbers& numbers, const std::set<std::string>& truths) {
  Json object = Json::object();
  for (const auto& [name, values] : numbers) {
    if (truths.contains(name)) {
      object[name] = values[0] != 0;
    } else if (values.size() == 1) {
      object[name] = numberOf(values[0]);
    } else {
      for (const double x : values) object[name].push_back(numberOf(x));
    }
  }
  return object;
}

/// Packs into the middle of a buffer at an odd address, and looks at what lies around it.
constexpr const char* kProgram = R"(import { readFileSync } from "node:fs";
for (const one of JSON.parse(readFileSync("cases.json", "utf8"))) {
  const module = await import(`./${one.id}.js`);
  const read = (x) => Array.isArray(x) ? x.map(read) : typeof x === "string" ? Number(x) : x;
  for (const written of one.rows) {
    const row = Object.fromEntries(Object.entries(written).map(([name, x]) => [name, read(x)]));
    const all = new Uint8Array(module.blockSize + 2).fill(0x5a);
    const bytes = all.subarray(1, module.blockSize + 1);
    if (module.pack(row, bytes) !== bytes) throw new Error("pack returns what it was given");
    if (all[0] !== 0x5a || all.at(-1) !== 0x5a) throw new Error("written too far");
    if (Buffer.compare(Buffer.from(module.pack(row)), Buffer.from(bytes)) !== 0) throw new Error("two blocks");
    console.log(Buffer.from(bytes).toString("hex"));
  }
}
)";

/// The bytes that Node packs, row by row of all cases; empty, and the test failed, when something goes wrong.
std::vector<std::string> packedByNode(const std::vector<ModuleCase>& cases,
                                      const std::set<std::string>& truths) {
  const fs::path folder = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  Json list = Json::array();
  for (const ModuleCase& one : cases) {
    writeText(folder / (one.id + ".js"), one.code);
    Json rows = Json::array();
    for (const Numbers& row : one.rows) rows.push_back(objectOf(row, truths));
    list.push_back({{"id", one.id}, {"rows", rows}});
  }
  writeText(folder / "package.json", R"({"type": "module"})");
  writeText(folder / "cases.json", list.dump());
  writeText(folder / "main.js", kProgram);
  std::string said;
  const int ran = runProgram({"node", "main.js"}, folder, &said);
  EXPECT_EQ(ran, 0) << said.substr(0, 4000);
  std::vector<std::string> lines;
  std::istringstream stream(ran == 0 ? said : "");
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  fs::remove_all(folder.parent_path());
  return lines;
}

void expectSame(const std::vector<ModuleCase>& cases, const std::set<std::string>& truths) {
  const std::vector<std::string> packed = packedByNode(cases, truths);
  size_t at = 0;
  for (const ModuleCase& one : cases) {
    for (const std::string& expected : one.expected) {
      ASSERT_LT(at, packed.size());
      EXPECT_EQ(packed[at++], expected) << one.id << "\n" << one.code.substr(0, 4000);
    }
  }
  EXPECT_EQ(at, packed.size());
}

/// Modules of all examples, with so many rows of numbers for each material.
std::vector<ModuleCase> exampleCases(const Options& options, int rows) {
  std::vector<ModuleCase> cases;
  std::map<std::string, size_t> index;
  std::mt19937 random(2);
  eachExample(options, [&](Graph& graph, const Shader& shader) {
    const auto [it, fresh] = index.emplace(shader.id(), cases.size());
    if (fresh) cases.push_back({shader.id(), shader.moduleText(), shader.moduleTypes(), {}, {}});
    ModuleCase& one = cases[it->second];
    // Materials that share a shader share its module, whatever their numbers are.
    EXPECT_EQ(one.code, shader.moduleText());
    EXPECT_EQ(one.types, shader.moduleTypes());
    const Json parameters = Json::parse(graph.toJson())["parameters"];
    for (int row = 0; row < rows; ++row) {
      one.rows.push_back(row == 0       ? valuesOf(parameters)
                         : row % 3 != 0 ? randomValues(parameters, random)
                                        : outsideValues(parameters, random));
      one.expected.push_back(packedByLibrary(shader, one.rows.back()));
    }
  });
  return cases;
}

ModuleCase randomCase(const std::string& id, const ir::Module& module, uint32_t seed) {
  const targets::PackerText text = targets::moduleText(module, id, "a head");
  ModuleCase one{id, text.code, text.types, {}, {}};
  std::mt19937 random(seed);
  for (int row = 0; row < 40; ++row) {
    one.rows.push_back(randomNumbers(module, random, row % 5 == 0));
    one.expected.push_back(evaluated(module, one.rows.back()));
  }
  return one;
}

const std::set<std::string> kFlags = {"flag", "register"};

}  // namespace

TEST(Module, BytesOfTheExamplesAreTheLibrarys) {
  if (!haveProgram("node")) GTEST_SKIP() << kNoNode;
  const std::vector<ModuleCase> cases = exampleCases(packingOptions(Target::Js), 20);
  ASSERT_GT(cases.size(), 10U);
  expectSame(cases, {});
}

/// Where each number is rounded as IEEE says, nothing may differ, however long the way is.
TEST(Module, EveryRoundedOperationIsTheLibrarys) {
  if (!haveProgram("node")) GTEST_SKIP() << kNoNode;
  std::vector<ir::Op> rounded;
  const std::set<ir::Op> others = {ir::Op::Exp2,  ir::Op::Log2, ir::Op::Exp,  ir::Op::Log,
                                   ir::Op::Sin,   ir::Op::Cos,  ir::Op::Acos, ir::Op::Pow,
                                   ir::Op::Atan2, ir::Op::Asin, ir::Op::Tanh};
  for (const ir::Op op : preshaderOps()) {
    if (!others.contains(op)) rounded.push_back(op);
  }
  std::vector<ModuleCase> cases;
  for (uint32_t seed = 0; seed < 6; ++seed)
    cases.push_back(randomCase(fmt::format("random-{}", seed), randomPreshader(seed, 180, rounded), seed));
  expectSame(cases, kFlags);
}

/// The others are JavaScript's own: their last bit in double is below what a float shows.
TEST(Module, EveryFunctionIsTheLibrarys) {
  if (!haveProgram("node")) GTEST_SKIP() << kNoNode;
  std::vector<ModuleCase> cases;
  uint32_t seed = 0;
  for (const ir::Op op : preshaderOps()) {
    ++seed;
    cases.push_back(
        randomCase(fmt::format("op-{}", ir::info(op).name), randomPreshader(seed, 1, {op}), seed));
  }
  expectSame(cases, kFlags);
}

TEST(Module, BakedHasNoBlock) {
  Options options = packingOptions(Target::Js);
  options.parameters = Parameters::Baked;
  std::vector<ModuleCase> cases = exampleCases(options, 1);
  cases.resize(1);
  EXPECT_NE(cases[0].code.find("export const blockSize = 0;"), std::string::npos) << cases[0].code;
  if (!haveProgram("node")) GTEST_SKIP() << kNoNode;
  EXPECT_EQ(packedByNode(cases, {}), std::vector<std::string>{""});
}

/// What an engine asks of the module besides: the defaults, short buffers, the tables.
TEST(Module, TheRestOfItIsWhatTheTypesSay) {
  if (!haveProgram("node")) GTEST_SKIP() << kNoNode;
  const std::vector<ModuleCase> cases = exampleCases(packingOptions(Target::Js), 1);
  const fs::path folder = freshFolder("rest");
  std::string ids;
  for (const ModuleCase& one : cases) {
    writeText(folder / (one.id + ".mjs"), one.code);
    ids += fmt::format("\"{}\",", one.id);
  }
  writeText(folder / "main.mjs", "import assert from \"node:assert\";\nfor (const id of [" + ids + R"(]) {
  const m = await import(`./${id}.mjs`);
  assert(m.id === id);
  assert.deepEqual(m.pack(), m.pack(m.defaults));
  assert.deepEqual(m.outside(m.defaults), []);
  for (const name of Object.keys(m.defaults).filter((name) => typeof m.defaults[name] === "number")) {
    assert.deepEqual(m.pack({ [name]: NaN }), m.pack());
    assert.deepEqual(m.pack({ [name]: "text" }), m.pack());
    assert.deepEqual(m.outside({ [name]: NaN }), [name]);
    assert.deepEqual(m.outside({ [name]: -1e39 }), [name]);
  }
  assert.throws(() => m.pack({}, new Uint8Array(m.blockSize - 1)), RangeError);
  for (const { offset, components } of Object.values(m.fields)) assert(offset + 4 * components <= m.blockSize);
  for (const list of [m.blocks, m.textures]) {
    for (const { name, set, binding, flat } of list) assert(name && set >= 0 && binding >= 0 && flat >= 0);
  }
  assert(m.blocks.some((block) => block.name === "Material" && block.size === m.blockSize));
  console.log(JSON.stringify({ exports: Object.keys(m).sort(), defaults: Object.keys(m.defaults) }));
}
)");
  std::string said;
  ASSERT_EQ(runProgram({"node", "main.mjs"}, folder, &said), 0) << said;
  std::istringstream lines(said);
  for (const ModuleCase& one : cases) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    const Json names = Json::parse(line);
    for (const Json& name : names["exports"]) {
      const auto exported = name.get<std::string>();
      const std::string declared = exported == "pack" ? "export declare function pack<"
                                   : exported == "outside"
                                       ? "export declare function outside("
                                       : fmt::format("export declare const {}:", exported);
      EXPECT_NE(one.types.find(declared), std::string::npos) << declared << "\n" << one.types;
    }
    for (const Json& name : names["defaults"])
      EXPECT_NE(one.types.find(fmt::format("    {}: ", name.get<std::string>())), std::string::npos)
          << name << one.types;
  }
  fs::remove_all(folder.parent_path());
}

TEST(Module, TheTypesAreTypeScript) {
  if (!haveProgram("tsc")) GTEST_SKIP() << "NOT TESTED: there is no tsc (Debian: node-typescript)";
  const ModuleCase one = exampleCases(packingOptions(Target::Js), 1)[0];
  const fs::path folder = freshFolder("types");
  writeText(folder / "m.d.ts", one.types);
  const std::string use =
      "import { pack, blockSize, defaults, textures, Parameters } from \"./m\";\n"
      "const p: Partial<Parameters> = { ...defaults };\n"
      "const bytes: Uint8Array = pack(p);\n"
      "const floats: Float32Array = pack(p, new Float32Array(blockSize / 4));\n"
      "export const names: string[] = textures.map((t) => t.name);\n";
  writeText(folder / "good.ts", use);
  writeText(folder / "bad.ts", use + "pack({ no_such_parameter: 1 });\n");
  std::string said;
  EXPECT_NE(
      runProgram({"tsc", "--noEmit", "--strict", "--target", "es2020", "good.ts", "bad.ts"}, folder, &said),
      0);
  EXPECT_NE(said.find("no_such_parameter"), std::string::npos) << said;
  EXPECT_EQ(said.find("good.ts"), std::string::npos) << said;
  EXPECT_EQ(said.find("m.d.ts"), std::string::npos) << said;
  fs::remove_all(folder.parent_path());
}

/// The texts of both packing targets for one example, whole.
TEST(Module, TextsOfAnExample) {
  Options options = packingOptions(Target::Js);
  options.targets.push_back(Target::Cpp);
  Messages messages;
  const Scene scene = Scene::load(std::string(LACQUER_EXAMPLES) + "/coat.gltf", options, messages);
  ASSERT_TRUE(scene);
  Graph graph = scene.graph(0, scene.uses(0).at(0), options, messages);
  const Shader shader = graph.generate(options, messages);
  ASSERT_TRUE(shader);
  const fs::path folder = sourceFolder() / "tests/params/expected";
  expectFile(folder / "coat.js", shader.moduleText());
  expectFile(folder / "coat.d.ts", shader.moduleTypes());
  expectFile(folder / "coat.header", shader.headerText());
}

}  // namespace lacquer::test::module_test
