#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "api/internal.h"
#include "check/check.h"
#include "lower/lower.h"
#include "passes/legalize.h"
#include "passes/pipeline.h"
#include "targets/target.h"

namespace lacquer {

Result<ir::Module> toModule(const graph::Graph& graph, const lang::Library& library, const Options& options,
                            const passes::LightFacts& scene_lights,
                            const std::function<void(std::string_view, const ir::Module&)>& after) {
  Result<ir::Module> module = lower::lower(graph, library, {parameterMode(options)});
  if (!module) return module;
  if (after) after("lower", *module);
  return throughPasses(std::move(*module), {lightFacts(options, scene_lights), after});
}

Result<ir::Module> throughPasses(ir::Module module, const passes::PipelineOptions& options) {
  if (Diagnostics wrong = passes::checkLights(module, options.lights); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  passes::runPipeline(module, options);
  if (Diagnostics wrong = passes::checkPlaces(module); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  return module;
}

lower::ParameterMode parameterMode(const Options& options) {
  switch (options.parameters) {
    case Parameters::Uniform: return lower::ParameterMode::Uniform;
    case Parameters::Baked: return lower::ParameterMode::Baked;
    case Parameters::Spec: return lower::ParameterMode::Spec;
  }
  return lower::ParameterMode::Uniform;
}

Diagnostics checkOptions(const Options& options) {
  Diagnostics wrong;
  if (graph::findProfile(options.profile) == nullptr) {
    std::string known;
    for (const graph::Profile& profile : graph::profiles()) {
      known += (known.empty() ? "" : ", ") + std::string(profile.name);
    }
    wrong.push_back({"unknown-profile",
                     Severity::Error,
                     {},
                     fmt::format("there is no profile '{}'", options.profile),
                     "there are " + known,
                     {}});
  }
  if (options.spirv_route == SpirvRoute::Hlsl) {
    wrong.push_back({"wrong-route",
                     Severity::Error,
                     {},
                     "SPIR-V by way of the HLSL has other bindings than Lacquer's",
                     "it is written directly or by way of the GLSL; evaluate() alone takes this way",
                     {}});
  }
  if (!(options.error_budget >= 0 && options.error_budget <= 1)) {
    wrong.push_back({"bad-error-budget",
                     Severity::Error,
                     {},
                     fmt::format("the error budget is {}", options.error_budget),
                     "it is a relative error from 0 to 1",
                     {}});
  }
  for (const Target target : options.targets) {
    if (options.parameters != Parameters::Spec || target == Target::Glsl || target == Target::Spirv) continue;
    wrong.push_back({"no-specialization-constants",
                     Severity::Error,
                     {},
                     fmt::format("the target {} has no specialization constants", targetName(target)),
                     "glsl and spirv have them; for the others, parameters are uniform or baked",
                     {}});
  }
  return wrong;
}

bool hasVertexStage(const ir::Module& module) {
  return std::any_of(module.outputs.begin(), module.outputs.end(),
                     [](const ir::Output& o) { return o.stage == ir::Stage::Vertex; });
}

std::string shaderId(const ir::Module& module) {
  bool coat = false;
  bool lit = false;
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    const std::string& term = module.dag.terms()[module.dag.termOf(id)].name;
    coat |= term.starts_with("coat.");
    lit |= term.starts_with("base.direct") || term.starts_with("base.indirect");
  }
  const std::string_view kind = coat ? "coat" : lit || !module.sums_lights ? "base" : "unlit";
  return fmt::format("{}-{}-{}", module.template_name, kind, passes::contentAddress(module));
}

std::string shaderPath(Target target, const std::string& id, int stage) {
  const targets::Target& row = targets::row(static_cast<targets::TargetId>(target));
  if (target == Target::Cpp) return fmt::format("{}/{}.{}", row.name, id, row.extension);
  return fmt::format("{}/{}.{}.{}", row.name, id, stage == 0 ? "vert" : "frag", row.extension);
}

namespace {

constexpr ir::Stage kStages[] = {ir::Stage::Vertex, ir::Stage::Fragment};

check::Language languageOf(Target target) {
  switch (target) {
    case Target::Glsl: return check::Language::GlslVulkan;
    case Target::GlslGl: return check::Language::GlslOpenGl;
    case Target::Essl: return check::Language::Essl300;
    case Target::Hlsl: return check::Language::Hlsl;
    case Target::Spirv:
    case Target::Cpp: break;
  }
  assert(false && "no text of a stage");
  return check::Language::GlslVulkan;
}

void append(Diagnostics& to, const Diagnostics& from) { to.insert(to.end(), from.begin(), from.end()); }

/// Compiles one text; whatever a compiler says is a bug of ours.
void checkText(const std::string& text, Target target, int stage, const std::string& name,
               Diagnostics& wrong) {
  const auto check_stage = stage == 0 ? check::Stage::Vertex : check::Stage::Fragment;
  const check::Language language = languageOf(target);
  const Result<check::Spirv> words = check::compile(text, language, check_stage, name);
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
        case Target::Essl: text(glsl(), target); break;
        case Target::Hlsl: {
          ir::Module hlsl = shader_.module;
          passes::legalizeHlsl(hlsl);
          text(hlsl, target);
          break;
        }
        case Target::Spirv: spirv(); break;
        case Target::Cpp: header(); break;
      }
    }
  }

private:
  int firstStage() const { return shader_.has_vertex ? 0 : 1; }

  std::string print(const ir::Module& module, Target target, int stage) const {
    const passes::Program program = passes::schedule(module, kStages[stage]);
    return targets::printText(module, program, static_cast<targets::TargetId>(target), head());
  }

  std::string head() const {
    return fmt::format("{}\nLacquer {}, template {}", shader_.id, version(), shader_.module.template_name);
  }

  /// Nothing checks it here: the tests compile it.
  void header() {
    const StageTimer timer(times_, StageOfRun::Print, Target::Cpp);
    shader_.text[static_cast<int>(Target::Cpp)][1] = targets::headerText(shader_.module, shader_.id, head());
  }

  void text(const ir::Module& module, Target target) {
    for (int stage = firstStage(); stage < 2; ++stage) {
      std::string& text = shader_.text[static_cast<int>(target)][stage];
      {
        const StageTimer timer(times_, StageOfRun::Print, target);
        text = print(module, target, stage);
      }
      if (!options_.validate) continue;
      const StageTimer timer(times_, StageOfRun::Validate, target);
      checkText(text, target, stage, shaderPath(target, shader_.id, stage), wrongOf(target));
    }
  }

  std::vector<uint32_t> words(int stage, const std::string& path) {
    const StageTimer timer(times_, StageOfRun::Print, Target::Spirv);
    if (options_.spirv_route == SpirvRoute::Direct) {
      return targets::writeSpirv(shader_.module, passes::schedule(shader_.module, kStages[stage]),
                                 {options_.debug});
    }
    const auto check_stage = stage == 0 ? check::Stage::Vertex : check::Stage::Fragment;
    Result<check::Spirv> made =
        check::compile(print(glsl(), Target::Glsl, stage), check::Language::GlslVulkan, check_stage, path);
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

  /// Legalized once for all its dialects.
  const ir::Module& glsl() {
    if (!glsl_) {
      glsl_ = shader_.module;
      passes::legalizeGlsl(*glsl_);
    }
    return *glsl_;
  }

  Diagnostics& wrongOf(Target target) { return wrong_[static_cast<size_t>(target)]; }

  ShaderData& shader_;
  const Options& options_;
  Wrong& wrong_;
  StageTimes* times_;
  std::optional<ir::Module> glsl_;
};

}  // namespace

void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times) {
  Printing(shader, options, wrong, times).run();
}

const std::string& Shader::id() const { return impl_->id; }
bool Shader::hasVertexStage() const { return impl_->has_vertex; }
const std::vector<uint32_t>& Shader::vertexSpirv() const { return impl_->spirv[0]; }
const std::vector<uint32_t>& Shader::fragmentSpirv() const { return impl_->spirv[1]; }
const std::string& Shader::headerText() const { return impl_->text[static_cast<int>(Target::Cpp)][1]; }
const std::string& Shader::interfaceJson() const { return impl_->interface; }

static const std::string& textOf(const std::string (&text)[kTargetCount][2], Target target, int stage) {
  static const std::string kNone;
  return target == Target::Spirv || target == Target::Cpp ? kNone : text[static_cast<int>(target)][stage];
}

const std::string& Shader::vertexText(Target target) const { return textOf(impl_->text, target, 0); }
const std::string& Shader::fragmentText(Target target) const { return textOf(impl_->text, target, 1); }

size_t Shader::uniformSize() const {
  for (const ir::Block& block : impl_->module.blocks) {
    if (block.role == ir::BlockRole::Material) return block.size;
  }
  return 0;
}

void Shader::pack(const std::function<bool(std::string_view, double*)>& value, void* bytes) const {
  std::vector<ir::Components> parameters;
  for (const ir::Parameter& parameter : impl_->module.parameters) {
    ir::Components components = parameter.value;
    parameters.push_back(value && value(parameter.name, components.data()) ? components : parameter.value);
  }
  std::memset(bytes, 0, uniformSize());
  const Preshader& preshader = impl_->preshader;
  const std::vector<ir::Components> values =
      preshader.evaluate([&](uint32_t i) -> const ir::Components& { return parameters[i]; });
  for (size_t i = 0; i < values.size(); ++i) {
    const Preshader::Field& field = preshader.fields()[i];
    for (int c = 0; c < ir::componentCount(field.type); ++c) {
      const auto x = static_cast<float>(values[i][static_cast<size_t>(c)]);
      std::memcpy(static_cast<char*>(bytes) + field.offset + size_t{4} * static_cast<size_t>(c), &x, 4);
    }
  }
}

}  // namespace lacquer
