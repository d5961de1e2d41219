#include "shader/print.h"

#include <fmt/format.h>

#include <cassert>
#include <optional>

#include "check/check.h"
#include "schedule/schedule.h"
#include "shader/language.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer {

std::string shaderPath(Target target, const std::string& id, int stage) {
  const targets::Row& row = targets::row(target);
  if (target == Target::Cpp) return fmt::format("{}/{}.{}", row.name, id, row.extension);
  if (target == Target::Js) return fmt::format("{}/{}.{}", row.name, id, stage == 0 ? "d.ts" : row.extension);
  return fmt::format("{}/{}.{}.{}", row.name, id, stage == 0 ? "vert" : "frag", row.extension);
}

std::string_view fileKind(Target target, int stage) {
  if (target == Target::Cpp) return "header";
  if (target == Target::Js) return stage == 0 ? "types" : "module";
  return stage == 0 ? "vert" : "frag";
}

bool hasValidator(Target target) {
  if (target == Target::Wgsl) return check::haveTint();
  return isShader(target) && target != Target::Msl;
}

namespace {

constexpr ir::Stage kStages[] = {ir::Stage::Vertex, ir::Stage::Fragment};

void append(Diagnostics& to, const Diagnostics& from) { to.insert(to.end(), from.begin(), from.end()); }

/// Compiles one text; whatever a compiler says is a bug of ours.
void checkText(const std::string& text, Target target, int stage, const std::string& name,
               Diagnostics& wrong) {
  if (target == Target::Wgsl) {
    for (Diagnostic& said : check::compileWithTint(text, name)) {
      if (said.severity == Severity::Error) wrong.push_back(std::move(said));
    }
    return;
  }
  const auto check_stage = stage == 0 ? check::Stage::Vertex : check::Stage::Fragment;
  const Result<check::Spirv> words = check::compile(text, target, check_stage, name);
  if (!words) return append(wrong, words.error());
  if (target != Target::Essl) {
    append(wrong, check::validate(*words, target == Target::GlslGl, name));
    append(wrong, check::checkSlots(*words, target == Target::GlslGl, name));
  }
  if (target == Target::Hlsl && check::haveDxc())
    append(wrong, check::compileWithDxc(text, check_stage, name));
}

class Printing {
public:
  Printing(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times)
      : shader_(shader), options_(options), wrong_(wrong), times_(times) {}

  void run() {
    for (const Target target : options_.targets) {
      switch (target) {
        case Target::Glsl:
        case Target::GlslGl:
        case Target::Essl:
        case Target::Hlsl:
        case Target::Wgsl: text(legalized(), target); break;
        case Target::Spirv: spirv(); break;
        case Target::Msl: msl(); break;
        case Target::Cpp: header(); break;
        case Target::Js: esModule(); break;
      }
    }
  }

private:
  int firstStage() const { return shader_.has_vertex ? 0 : 1; }

  std::string print(const ir::Module& module, Target target, int stage) const {
    const schedule::Program program = schedule::schedule(module, kStages[stage]);
    return targets::printText(module, program, target, head());
  }

  std::string head() const {
    return fmt::format("{}\nLacquer {}, template {}", shader_.id, version(), shader_.module.template_name);
  }

  /// Nothing checks it here: the tests compile it.
  void header() {
    const StageTimer timer(times_, StageOfRun::Print, Target::Cpp);
    shader_.text[static_cast<int>(Target::Cpp)][1] = targets::headerText(shader_.module, shader_.id, head());
  }

  /// As the header.
  void esModule() {
    const StageTimer timer(times_, StageOfRun::Print, Target::Js);
    targets::ModuleText made = targets::moduleText(shader_.module, shader_.id, head());
    std::string(&text)[2] = shader_.text[static_cast<int>(Target::Js)];
    text[0] = std::move(made.types);
    text[1] = std::move(made.code);
  }

  void text(const ir::Module& module, Target target) {
    for (int stage = firstStage(); stage < 2; ++stage) {
      std::string& text = shader_.text[static_cast<int>(target)][stage];
      {
        const StageTimer timer(times_, StageOfRun::Print, target);
        text = print(module, target, stage);
      }
      if (!options_.validate || !hasValidator(target)) continue;
      const StageTimer timer(times_, StageOfRun::Validate, target);
      checkText(text, target, stage, shaderPath(target, shader_.id, stage), wrongOf(target));
    }
  }

  std::vector<uint32_t> words(int stage, const std::string& path) {
    const StageTimer timer(times_, StageOfRun::Print, Target::Spirv);
    if (options_.spirv_route == SpirvRoute::Direct) {
      return targets::writeSpirv(shader_.module, schedule::schedule(shader_.module, kStages[stage]),
                                 {options_.debug});
    }
    const auto check_stage = stage == 0 ? check::Stage::Vertex : check::Stage::Fragment;
    Result<check::Spirv> made =
        check::compile(print(legalized(), Target::Glsl, stage), Target::Glsl, check_stage, path);
    if (made) return std::move(*made);
    append(wrongOf(Target::Spirv), made.error());
    return {};
  }

  void spirv() {
    for (int stage = firstStage(); stage < 2; ++stage) {
      const std::string path = shaderPath(Target::Spirv, shader_.id, stage);
      shader_.spirv[stage] = words(stage, path);
      if (!options_.validate) continue;
      const StageTimer timer(times_, StageOfRun::Validate, Target::Spirv);
      append(wrongOf(Target::Spirv), check::validate(shader_.spirv[stage], false, path));
      append(wrongOf(Target::Spirv), check::checkSlots(shader_.spirv[stage], false, path));
    }
  }

  /// Of the direct words, however `spirv` gets its own.
  void msl() {
    for (int stage = firstStage(); stage < 2; ++stage) {
      const StageTimer timer(times_, StageOfRun::Print, Target::Msl);
      const schedule::Program program = schedule::schedule(shader_.module, kStages[stage]);
      Result<std::string> text = targets::mslText(shader_.module, program, options_.argument_buffers, head());
      if (text) {
        shader_.text[static_cast<int>(Target::Msl)][stage] = std::move(*text);
      } else {
        append(wrongOf(Target::Msl), text.error());
      }
    }
  }

  /// Legalized once for all texts.
  const ir::Module& legalized() {
    if (!legalized_) {
      legalized_ = shader_.module;
      targets::legalize(*legalized_);
    }
    return *legalized_;
  }

  Diagnostics& wrongOf(Target target) { return wrong_[static_cast<size_t>(target)]; }

  ShaderData& shader_;
  const Options& options_;
  Wrong& wrong_;
  StageTimes* times_;
  std::optional<ir::Module> legalized_;
};

}  // namespace

void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times) {
  Printing(shader, options, wrong, times).run();
}

}  // namespace lacquer
