#include "check/check.h"

#include "targets/target.h"

namespace lacquer::check {

using targets::Checker;

namespace {

void append(Diagnostics& to, Diagnostics from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Whatever a compiler says is a bug of ours.
Diagnostics checkWithGlslang(const std::string& text, const targets::Row& row, Stage stage,
                             const std::string& name) {
  const Result<Spirv> words = compile(text, row.id, stage, name);
  if (!words) return words.error();
  Diagnostics wrong;
  const bool open_gl = row.checker == Checker::OpenGl;
  if (row.checker != Checker::Es) {
    append(wrong, validate(*words, open_gl, name));
    append(wrong, checkSlots(*words, open_gl, name));
  }
  if (row.checker == Checker::Direct3d && haveDxc()) append(wrong, compileWithDxc(text, stage, name));
  return wrong;
}

}  // namespace

bool canCheck(Target target) {
  const Checker checker = targets::row(target).checker;
  return checker == Checker::Tint ? haveTint() : checker != Checker::None;
}

std::string_view howToCheck(Target target) {
  return targets::row(target).checker == Checker::Tint ? "`lacquer-wgsl-check` on the PATH does (checks/wgsl)"
                                                       : "";
}

std::string programsOf(Target target) {
  const Checker checker = targets::row(target).checker;
  if (checker == Checker::Direct3d) return dxcIdentity();
  return checker == Checker::Tint ? tintIdentity() : "";
}

Diagnostics checkText(const std::string& text, Target target, Stage stage, const std::string& name) {
  const targets::Row& row = targets::row(target);
  switch (row.checker) {
    case Checker::None:
    case Checker::Words: return {};
    case Checker::Registered: {
      Diagnostics said = row.check(text, stage == Stage::Vertex ? ir::Stage::Vertex : ir::Stage::Fragment);
      for (Diagnostic& one : said) one.place.file = name;
      return said;
    }
    case Checker::Tint: {
      Diagnostics said = compileWithTint(text, name);
      std::erase_if(said, [](const Diagnostic& one) { return one.severity != Severity::Error; });
      return said;
    }
    case Checker::Vulkan:
    case Checker::OpenGl:
    case Checker::Es:
    case Checker::Direct3d: return checkWithGlslang(text, row, stage, name);
  }
  return {};
}

Diagnostics checkWords(const Spirv& words, const std::string& name) {
  Diagnostics wrong = validate(words, false, name);
  append(wrong, checkSlots(words, false, name));
  return wrong;
}

}  // namespace lacquer::check
