// Forms: a colour at a value that leaves terms out, or takes cheaper ones, and a hair beside it, with every
// extension of the library and of forms/ laid over every other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "material/drawn.h"
#include "stress/forms.h"
#include "support/cases.h"

namespace lacquer::test::forms_test {
namespace {

Options optionsWith(const std::string& nodes, const std::string& profile) {
  Options options;
  if (!nodes.empty()) options.node_directories = {(sourceFolder() / "tests/stress" / nodes).string()};
  options.profile = profile;
  return options;
}

/// What was found with every extension, or with the one of that name.
std::vector<StressFinding> faultsOf(const Options& options, std::string_view only, double allowed,
                                    size_t& compared) {
  const auto library = libraryFor(options);
  if (!library) throw std::runtime_error(format(library.error().front()));
  const Result<const material::Schema*> found = (*library)->models.schema();
  if (!found) throw std::runtime_error(format(found.error().front()));
  const material::Schema& schema = **found;
  std::vector<StressFinding> faults;
  for (uint16_t i = 1; i < schema.extensions.size(); ++i) {
    if (!only.empty() && schema.extensions[i]->name != only) continue;
    const auto material = material::materialWith(schema, i, 1);
    if (!material) continue;
    Result<Forms> forms = compareForms(*material, {}, **library, options, 1, allowed);
    if (!forms) throw std::runtime_error(format(forms.error().front()));
    compared += forms->compared;
    faults.insert(faults.end(), forms->faults.begin(), forms->faults.end());
  }
  return faults;
}

std::string shown(const StressFinding& fault) {
  return fmt::format("{} at {}, under {}: {}", fault.parameter, fault.at[0], fault.layer, fault.value);
}

class OfEveryProfile : public testing::TestWithParam<const char*> {};

/// A coat's colour, tint or darkening, whose limit is the clear coat.
bool ofCoat(const std::string& parameter) {
  const auto has = [&](const char* text) { return parameter.find(text) != std::string::npos; };
  return has("coat") && (has("ColorFactor") || has("TintFactor") || has("DarkeningFactor"));
}

TEST_P(OfEveryProfile, NoColourNoticesTheForm) {
  size_t compared = 0;
  for (const StressFinding& fault : faultsOf(optionsWith("forms", GetParam()), {}, 1e-6, compared)) {
    if (ofCoat(fault.parameter) || fault.value > kFormsAllowed) ADD_FAILURE() << shown(fault);
  }
  EXPECT_GT(compared, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Forms, OfEveryProfile, testing::Values("khr", "openpbr", "physical"),
                         [](const auto& info) { return std::string(info.param); });

TEST(FaultyForms, AreFound) {
  size_t compared = 0;
  const std::vector<StressFinding> faults =
      faultsOf(optionsWith("forms_faulty", "khr"), "EXAMPLE_step", kFormsAllowed, compared);
  ASSERT_FALSE(faults.empty());
  for (const StressFinding& fault : faults) {
    EXPECT_EQ(fault.parameter, "stepTint") << shown(fault);
    EXPECT_GT(fault.value, 1e-3) << shown(fault);
  }
}

}  // namespace
}  // namespace lacquer::test::forms_test
