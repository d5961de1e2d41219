#include "physics/node_values.h"

#include <gtest/gtest.h>

#include "eval/evaluate.h"
#include "prove/nodes.h"
#include "support/materials.h"

namespace lacquer::physics {

template <class T>
std::vector<std::vector<T>> nodeValues(std::string_view node, std::string_view variant,
                                       const eval::Columns& columns, size_t points,
                                       const std::map<std::string, eval::Sampler, std::less<>>& textures) {
  const Result<const lang::NodeDecl*> declared = test::builtInLibrary().node(node);
  EXPECT_TRUE(declared) << node;
  if (!declared) return {};
  const NodeModule made = nodeModule(**declared, variant);
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : made.module.outputs) roots.push_back(output.value);
  eval::Bindings bindings;
  bindings.columns = columns;
  bindings.textures = textures;
  auto values = eval::evaluate<T>(made.module, roots, bindings, points);
  EXPECT_TRUE(values) << format(values.error()[0]);
  return values ? std::move(*values) : std::vector<std::vector<T>>();
}

template std::vector<std::vector<float>> nodeValues<float>(
    std::string_view, std::string_view, const eval::Columns&, size_t,
    const std::map<std::string, eval::Sampler, std::less<>>&);
template std::vector<std::vector<double>> nodeValues<double>(
    std::string_view, std::string_view, const eval::Columns&, size_t,
    const std::map<std::string, eval::Sampler, std::less<>>&);

}  // namespace lacquer::physics
