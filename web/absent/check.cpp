// In place of src/compile/check/: this build has no compilers and validators of others.
#include "check/check.h"

#include "targets/target.h"

namespace lacquer::check {

static tl::unexpected<Diagnostics> absent() {
  return fail("no-validator", {}, "this build of Lacquer has no validators of shaders",
              "let the option `validate` be false, and the SPIR-V come from the DAG");
}

bool canCheck(Target target) {
  const targets::Checker checker = targets::row(target).checker;
  return checker != targets::Checker::None && checker != targets::Checker::Tint;
}
std::string_view howToCheck(Target) { return {}; }
std::string programsOf(Target) { return {}; }
Diagnostics checkText(const std::string&, Target, Stage, const std::string&) { return absent().value(); }
Diagnostics checkWords(const Spirv&, const std::string&) { return absent().value(); }
Result<Spirv> compile(std::string_view, Target, Stage, const std::string&) { return absent(); }
Diagnostics validate(const Spirv&, bool, const std::string&) { return absent().value(); }
Diagnostics checkSlots(const Spirv&, bool, const std::string&) { return {}; }
Result<Spirv> optimize(const Spirv&, const std::string&) { return absent(); }
std::string toolVersions() { return {}; }
bool haveDxc() { return false; }
std::string dxcIdentity() { return {}; }
Diagnostics compileWithDxc(const std::string&, Stage, const std::string&) { return absent().value(); }
bool haveTint() { return false; }
std::string tintIdentity() { return {}; }
Diagnostics compileWithTint(const std::string&, const std::string&) { return absent().value(); }

}  // namespace lacquer::check
