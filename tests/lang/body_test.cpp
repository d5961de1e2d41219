// A node's values written as a body are the same values again.
#include "lang/body_text.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "lang/library.h"
#include "lower/inline.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// The files of a folder of the source tree, by name.
std::map<std::string, std::string> filesOf(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(sourceFolder() / folder)) {
    if (entry.path().extension() == ".node")
      files[folder + "/" + entry.path().filename().string()] = readFile(entry.path());
  }
  return files;
}

lang::Library libraryOfFiles(const std::map<std::string, std::string>& files) {
  std::vector<lang::SourceFile> sources;
  for (const auto& [name, text] : files) sources.push_back({name, text});
  auto library = lang::Library::fromFiles(std::move(sources));
  EXPECT_TRUE(library);
  return std::move(*library);
}

/// Behind the first body of a node.
size_t endOfBody(const std::string& text, const std::string& node) {
  size_t at = text.find("node " + node + "(");
  EXPECT_NE(at, std::string::npos) << node;
  at = text.find('{', at);
  for (int depth = 0; at < text.size(); ++at) {
    if (text[at] == '{') ++depth;
    if (text[at] == '}' && --depth == 0) return at + 1;
  }
  return text.size();
}

std::vector<ir::ValueId> argumentsOf(ir::Dag& dag, const lang::NodeDecl& node) {
  std::vector<ir::ValueId> arguments;
  for (const lang::Param& param : node.params) {
    const bool texture = ir::isTexture(param.type);
    const auto kind = texture ? ir::InputKind::Texture : ir::InputKind::Parameter;
    const ir::Rate rate = texture ? ir::Rate::Frame : ir::Rate::Fragment;
    arguments.push_back(dag.input({kind, std::string(param.name), param.type, rate, {}}));
  }
  return arguments;
}

TEST(BodyText, IsTheSameValuesAgain) {
  std::map<std::string, std::string> files = filesOf("nodes");
  for (auto& [name, text] : filesOf("templates")) files[name] = text;
  const lang::Library before = libraryOfFiles(files);
  // All bodies of a kind together: one library has them all.
  std::map<std::string, std::vector<std::string>> written;
  size_t wordless = 0;
  for (const std::string_view name : before.names(lang::DeclKind::Node)) {
    const auto node = before.node(name);
    ASSERT_TRUE(node) << name;
    std::vector<std::string> variants{""};
    for (const lang::Variant& variant : (*node)->variants) variants.emplace_back(variant.name);
    for (const std::string& variant : variants) {
      ir::Module module;
      lower::Inliner inliner(module.dag);
      for (const ir::ValueId result : inliner.call(**node, variant, argumentsOf(module.dag, **node))) {
        const ir::Type type = module.dag[result].type;
        const uint32_t columns = type == ir::Type::Mat3 ? 3 : type == ir::Type::Mat4 ? 4 : 0;
        for (uint32_t k = 0; k < std::max(columns, 1U); ++k) {
          module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "", 0,
                                    columns == 0 ? result : module.dag.column(result, k)});
        }
      }
      const auto body = lang::bodyText(module, **node, "it is known");
      if (!body) {
        ++wordless;
        continue;
      }
      std::string& text = files[std::string((*node)->origin.file)];
      text.insert(endOfBody(text, std::string(name)),
                  "\n/// As it was.\nvariant again_" + variant + " {\n" + *body + "}");
      written[std::string(name)].push_back(variant);
    }
  }
  const lang::Library after = libraryOfFiles(files);
  size_t compared = 0;
  for (const auto& [name, variants] : written) {
    const auto node = after.node(name);
    ASSERT_TRUE(node) << name << "\n" << format(node.error()[0]);
    for (const std::string& variant : variants) {
      ir::Dag dag;
      lower::Inliner inliner(dag);
      const std::vector<ir::ValueId> arguments = argumentsOf(dag, **node);
      const lower::Values first = inliner.call(**node, variant, arguments);
      const lower::Values second = inliner.call(**node, "again_" + variant, arguments);
      EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end()))
          << name << " " << variant;
      ++compared;
    }
  }
  EXPECT_GT(compared, 150U);
  EXPECT_LT(wordless, 10U);
}

}  // namespace
}  // namespace lacquer::test
