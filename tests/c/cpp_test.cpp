// Each function of the C++ headers is there to link with; that they work is tested elsewhere.
#include <gtest/gtest.h>

#include <vector>

#include "lacquer.h"

namespace lacquer::test::cpp_test {
namespace {

template <class Function>
void have(std::vector<bool>& there, Function function) {
  there.push_back(function != nullptr);
}

TEST(Cpp, everyFunctionOfTheHeadersCanBeLinked) {
  std::vector<bool> there;
  const auto all = [&](auto... functions) { (have(there, functions), ...); };
  all(&version, static_cast<bool (*)(const Messages&)>(&hasError), &targetName, &targetNames, &findTarget,
      &addTarget, &hasSpecializationConstants, &liveTerms, &profiles, &passNames);
  all(&Scene::load, &Scene::fromMemory, &Scene::materialCount, &Scene::materialName, &Scene::findMaterial,
      &Scene::uses, &Scene::graph, &Scene::properties);
  all(&Graph::fromJson, &Graph::toJson, &Graph::toDot, &Graph::parameters, &Graph::textures, &Graph::addNode,
      &Graph::removeNode, &Graph::connect, &Graph::setOutput, &Graph::setParameter, &Graph::setRange,
      &Graph::name, &Graph::check, &Graph::generate, &Graph::dump, &Graph::prove, &Graph::groups,
      &Graph::nodes, &Graph::outputs, &Graph::sockets, &Graph::addInstance, &Graph::renameNode,
      &Graph::disconnect, &Graph::removeOutput, &Graph::makeGroup, &Graph::addGroup, &Graph::expand,
      &Graph::edit, &Graph::changes, &Graph::structure);
  all(&Shader::id, &Shader::hasVertexStage, &Shader::vertexText, &Shader::fragmentText, &Shader::vertexSpirv,
      &Shader::fragmentSpirv, &Shader::fileText, &Shader::headerText, &Shader::moduleText,
      &Shader::moduleTypes, &Shader::reflection, &Shader::interfaceJson, &Shader::uniformSize,
      static_cast<bool (Shader::*)(const Shader::Values&, std::span<std::byte>) const>(&Shader::pack),
      static_cast<bool (Shader::*)(const Shader::Values&, std::span<std::byte>, Messages&) const>(
          &Shader::pack),
      &Shader::packGraph);
  all(&generate, &generateGraphs, &plan, &merge);
  all(static_cast<std::optional<Evaluation> (*)(const Scene&, size_t, const std::string&, Engine,
                                                const Strings&, const Options&, Messages&, const Trial&)>(
          &evaluate),
      static_cast<std::optional<Evaluation> (*)(const std::string&, const std::string&, const std::string&,
                                                const std::string&, Engine, const Strings&, const Options&,
                                                Messages&, const Trial&)>(&evaluate),
      static_cast<std::optional<Evaluation> (*)(const Graph&, const std::string&, Engine, const Strings&,
                                                const Options&, Messages&, const Trial&)>(&evaluate),
      static_cast<std::vector<uint8_t> (*)(const Scene&, size_t, uint32_t, const Strings&, const Options&,
                                           Messages&, const Trial&, const ValueLook&)>(&drawBall),
      static_cast<std::vector<uint8_t> (*)(const Graph&, uint32_t, const Strings&, const Options&, Messages&,
                                           const Trial&, const ValueLook&)>(&drawBall),
      &isGraphFile, &Graph::load, &drawPreview, &writeView, &makeLevels, &stressNodes,
      static_cast<std::vector<ShaderCost> (*)(const Strings&, bool, Messages&)>(&measureCost),
      static_cast<std::vector<ShaderCost> (*)(const std::vector<Shader>&, bool, Messages&)>(&measureCost),
      &environmentDfg, &writeEnvironmentDfg, &environmentSheen, &writeEnvironmentSheen, &writeEnvironment,
      &filterEnvironment, &lightProfiles, &lightProfile, &nodesJson, &checkNodes, &proveNodes, &engineName,
      &faultName);
  for (const bool one : there) EXPECT_TRUE(one);
}

}  // namespace
}  // namespace lacquer::test::cpp_test
