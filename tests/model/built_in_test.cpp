// The built-in library is not checked where it is used, as nothing in it is wrong: here it is.
#include <gtest/gtest.h>

#include "model/model.h"

namespace lacquer::test {
namespace {

TEST(BuiltIn, EveryProfilePassesTheChecksOfUsersTexts) {
  lang::Library library = lang::Library::embedded();
  EXPECT_TRUE(library.isBuiltIn());
  ASSERT_TRUE(library.add({{"own.node", "const float OWN = 1;\n"}}));
  EXPECT_FALSE(library.isBuiltIn());
  const model::Models models(library);
  for (const std::string_view profile : library.names(lang::DeclKind::Profile)) {
    const Result<const model::Model*> model = models.of(profile);
    EXPECT_TRUE(model) << profile << ": " << format(model.error()[0]);
    for (const std::string_view lod : library.names(lang::DeclKind::Lod)) {
      const Result<const model::Model*> simpler = models.of(profile, {std::string(lod)});
      EXPECT_TRUE(simpler) << profile << ", " << lod << ": " << format(simpler.error()[0]);
    }
  }
}

}  // namespace
}  // namespace lacquer::test
