// The models that were made of the library's own texts when it was built.
#include <gtest/gtest.h>

#include "model/bytes.h"
#include "setting/prepared.h"

namespace lacquer::test {
namespace {

using model::Model;

/// What follows from the lines: it is not in the bytes.
std::vector<std::vector<uint32_t>> listsOf(const Model& model) {
  std::vector<std::vector<uint32_t>> all{model.ordered};
  for (const model::Id& id : model.ids) {
    all.push_back(id.lines);
    all.push_back(id.replaced);
  }
  for (const model::Out& out : model.outs) all.push_back(out.lines);
  for (const model::Term& term : model.terms) all.push_back(term.requirements);
  return all;
}

std::vector<std::vector<std::string_view>> liveOf(const Model& model) {
  std::vector<std::vector<std::string_view>> all;
  for (const model::Role& role : model.roles) {
    all.push_back(role.live);
    all.insert(all.end(), role.member_live.begin(), role.member_live.end());
  }
  return all;
}

TEST(Prepared, ModelsAreThoseOfTheTexts) {
  const lang::Library library = lang::Library::embedded();
  const Result<material::Schema> schema = material::schemaOf(library);
  ASSERT_TRUE(schema);
  EXPECT_EQ(preparedModels().size(), library.names(lang::DeclKind::Profile).size());
  for (const model::Prepared& one : preparedModels()) {
    SCOPED_TRACE(one.profile);
    const Result<Model> compiled = model::compile(library, *schema, one.profile);
    ASSERT_TRUE(compiled);
    EXPECT_TRUE(model::toBytes(*compiled) == one.bytes);
    const Model read = model::fromBytes(one.bytes, library, *schema);
    EXPECT_TRUE(model::toBytes(read) == one.bytes);
    EXPECT_EQ(listsOf(read), listsOf(*compiled));
    EXPECT_EQ(liveOf(read), liveOf(*compiled));
    EXPECT_EQ(read.profile_origin.file, compiled->profile_origin.file);
    for (size_t i = 0; i < read.nodes.size(); ++i)
      EXPECT_EQ(&read.nodes[i].of(library), &compiled->nodes[i].of(library)) << read.nodes[i].name();
  }
}

/// A text of one's own may say other lines: nothing prepared stands for it.
TEST(Prepared, ModelsAreOfTheLibrarysOwnTextsAlone) {
  lang::Library library = lang::Library::embedded();
  const model::Models own(library, {}, preparedModels());
  ASSERT_TRUE(own.of("khr"));
  lang::Library more = lang::Library::embedded();
  ASSERT_TRUE(
      more.add({{"x.node", "/// Pearls.\npart pearl over coat {\nsurface:\n    pearl.value = 1;\n}\n"}}));
  const model::Models models(more, {}, preparedModels());
  const Result<const Model*> found = models.of("khr");
  ASSERT_TRUE(found) << format(found.error()[0]);
  EXPECT_EQ((*found)->parts.size(), (*own.of("khr"))->parts.size() + 1);
}

}  // namespace
}  // namespace lacquer::test
