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
                            const passes::LightFacts& scene_lights, const AfterPass& after) {
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

bool hasVertexStage(const ir::Module& module) {
  return std::any_of(module.outputs.begin(), module.outputs.end(),
                     [](const ir::Output& o) { return o.stage == ir::Stage::Vertex; });
}

/// The outermost layer that an extension has brought, or else the innermost of all.
std::string shaderId(const ir::Module& module, const lang::Library& library) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  const std::vector<ir::ValueId> values = ir::reachable(module.dag, roots);
  const auto has = [&](std::string_view part) {
    const std::string prefix = std::string(part) + ".";
    return std::any_of(values.begin(), values.end(), [&](ir::ValueId id) {
      return module.dag.terms()[module.dag.termOf(id)].name.starts_with(prefix);
    });
  };
  std::string_view kind = "graph";
  for (const std::string_view name : library.names(lang::DeclKind::Layers)) {
    const Result<const lang::LayersDecl*> layers = library.layers(name);
    if (!layers || (*layers)->parts.empty()) continue;
    kind = (*layers)->parts[0];
    for (const std::string_view part : (*layers)->parts) {
      const Result<const lang::PartDecl*> decl = library.part(part);
      if (decl && !(*decl)->of.empty() && has(part)) kind = part;
    }
  }
  return fmt::format("{}-{}-{}", module.template_name, kind, passes::contentAddress(module));
}

bool isShaderId(std::string_view id) {
  constexpr size_t kLongest = 255 - std::string_view(".frag.glsl").size();
  return !id.empty() && id.size() <= kLongest &&
         id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
             std::string_view::npos;
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

const Shader::Impl& Shader::impl() const {
  static const Impl kNone;
  return impl_ ? *impl_ : kNone;
}

const std::string& Shader::id() const { return impl().id; }
bool Shader::hasVertexStage() const { return impl().has_vertex; }
const std::vector<uint32_t>& Shader::vertexSpirv() const { return impl().spirv[0]; }
const std::vector<uint32_t>& Shader::fragmentSpirv() const { return impl().spirv[1]; }
const std::string& Shader::headerText() const { return impl().text[static_cast<size_t>(Target::Cpp)][1]; }
const std::string& Shader::interfaceJson() const { return impl().interface; }

static const std::string& textOf(const std::string (&text)[kTargetCount][2], Target target, int stage) {
  static const std::string kNone;
  const auto row = static_cast<size_t>(target);
  return target == Target::Cpp || row >= kTargetCount ? kNone : text[row][stage];
}

const std::string& Shader::vertexText(Target target) const { return textOf(impl().text, target, 0); }
const std::string& Shader::fragmentText(Target target) const { return textOf(impl().text, target, 1); }

size_t Shader::uniformSize() const {
  for (const ir::Block& block : impl().module.blocks) {
    if (block.role == ir::BlockRole::Material) return block.size;
  }
  return 0;
}

bool Shader::pack(const Values& value, std::span<std::byte> block) const {
  const size_t size = uniformSize();
  if (block.size() < size) return false;
  std::vector<ir::Components> parameters;
  for (const ir::Parameter& parameter : impl().module.parameters) {
    ir::Components components = parameter.value;
    const std::span<double> numbers(components.data(),
                                    static_cast<size_t>(ir::componentCount(parameter.type)));
    parameters.push_back(value && value(parameter.name, numbers) ? components : parameter.value);
  }
  std::fill_n(block.begin(), size, std::byte{0});
  const Preshader& preshader = impl().preshader;
  const std::vector<ir::Components> values =
      preshader.evaluate([&](uint32_t i) -> const ir::Components& { return parameters[i]; });
  for (size_t i = 0; i < values.size(); ++i) {
    const Preshader::Field& field = preshader.fields()[i];
    for (int c = 0; c < ir::componentCount(field.type); ++c) {
      const auto x = static_cast<float>(values[i][static_cast<size_t>(c)]);
      std::memcpy(block.data() + field.offset + size_t{4} * static_cast<size_t>(c), &x, 4);
    }
  }
  return true;
}

}  // namespace lacquer
