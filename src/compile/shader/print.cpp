#include "shader/print.h"

#include <fmt/format.h>

#include <optional>

#include "check/check.h"
#include "schedule/schedule.h"
#include "setting/language.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer {

std::string shaderPath(Target target, const std::string& id, int stage) {
  const targets::Row& row = targets::row(target);
  return fmt::format("{}/{}.{}", row.name, id, row.files[static_cast<size_t>(stage)].suffix);
}

std::string_view fileKind(Target target, int stage) {
  return targets::row(target).files[static_cast<size_t>(stage)].kind;
}

bool packsBlock(Target target) { return targets::row(target).packer != nullptr; }

int firstStage(Target target, bool has_vertex) {
  const bool first = packsBlock(target) ? !fileKind(target, 0).empty() : has_vertex;
  return first ? 0 : 1;
}

bool hasValidator(Target target, bool arrays) {
  return check::canCheck(target) && (!arrays || targets::row(target).checker != targets::Checker::Tint);
}

Diagnostics withoutValidator(const Options& options) {
  Diagnostics all;
  for (const Target target : options.targets) {
    if (!options.validate || !isShader(target) || hasValidator(target)) continue;
    all.push_back({"not-validated",
                   Severity::Warning,
                   {},
                   fmt::format("nothing here compiles the target {}: its shaders are not validated",
                               targetName(target)),
                   std::string(check::howToCheck(target)),
                   {}});
  }
  return all;
}

std::string takeBytes(ShaderData& shader, Target target, int file) {
  if (!targets::row(target).words) return std::move(shader.text[static_cast<size_t>(target)][file]);
  std::string bytes;
  bytes.reserve(shader.spirv[file].size() * 4);
  for (const uint32_t word : shader.spirv[file]) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xFF);
  }
  return bytes;
}

void putBytes(std::string bytes, ShaderData& shader, Target target, int file) {
  if (!targets::row(target).words) {
    shader.text[static_cast<size_t>(target)][file] = std::move(bytes);
    return;
  }
  std::vector<uint32_t>& words = shader.spirv[file];
  words.assign(bytes.size() / 4, 0);
  for (size_t i = 0; i < 4 * words.size(); ++i)
    words[i / 4] |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[i])) << 8 * (i % 4);
}

namespace {

constexpr ir::Stage kStages[] = {ir::Stage::Vertex, ir::Stage::Fragment};
constexpr check::Stage kCheckStages[] = {check::Stage::Vertex, check::Stage::Fragment};

void append(Diagnostics& to, const Diagnostics& from) { to.insert(to.end(), from.begin(), from.end()); }

class Printing {
public:
  Printing(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times)
      : shader_(shader), options_(options), wrong_(wrong), times_(times) {}

  void run() {
    for (const Target target : options_.targets) {
      const targets::Row& row = targets::row(target);
      if (row.packer != nullptr) {
        pack(row);
        continue;
      }
      for (int stage = lacquer::firstStage(target, shader_.has_vertex); stage < 2; ++stage)
        row.words ? words(row, stage) : text(row, stage);
    }
  }

private:
  std::string head() const {
    return fmt::format("{}\nLacquer {}, template {}", shader_.id, version(), shader_.module.template_name);
  }

  bool validates(Target target) const {
    const auto& all = shader_.module.textures;
    const bool arrays =
        std::any_of(all.begin(), all.end(), [](const ir::TextureSlot& slot) { return !slot.array.empty(); });
    return options_.validate && hasValidator(target, arrays);
  }

  /// Nothing checks it here: the tests compile and run it.
  void pack(const targets::Row& row) {
    const StageTimer timer(times_, StageOfRun::Print, row.id);
    targets::PackerText made = row.packer(shader_.module, shader_.id, head());
    std::string(&text)[2] = shader_.text[static_cast<size_t>(row.id)];
    text[0] = std::move(made.types);
    text[1] = std::move(made.code);
  }

  Result<std::string> printed(const targets::Row& row, int stage) {
    const ir::Module& module = row.dialect != nullptr ? legalized() : shader_.module;
    return targets::stageText(module, schedule::schedule(module, kStages[stage]), row.id,
                              {head(), options_.argument_buffers || module.bindless});
  }

  void text(const targets::Row& row, int stage) {
    std::string& text = shader_.text[static_cast<size_t>(row.id)][stage];
    {
      const StageTimer timer(times_, StageOfRun::Print, row.id);
      Result<std::string> made = printed(row, stage);
      if (!made) {
        for (Diagnostic& wrong : made.error()) wrong.place.file = shaderPath(row.id, shader_.id, stage);
        return append(wrongOf(row.id), made.error());
      }
      text = std::move(*made);
    }
    if (!validates(row.id)) return;
    const StageTimer timer(times_, StageOfRun::Validate, row.id);
    append(wrongOf(row.id),
           check::checkText(text, row.id, kCheckStages[stage], shaderPath(row.id, shader_.id, stage)));
  }

  std::vector<uint32_t> written(const targets::Row& row, int stage, const std::string& path) {
    const StageTimer timer(times_, StageOfRun::Print, row.id);
    if (options_.spirv_route == SpirvRoute::Direct) {
      return targets::writeSpirv(shader_.module, schedule::schedule(shader_.module, kStages[stage]),
                                 {options_.debug});
    }
    const schedule::Program program = schedule::schedule(legalized(), kStages[stage]);
    Result<check::Spirv> made = check::compile(targets::printText(legalized(), program, Target::Glsl, head()),
                                               Target::Glsl, kCheckStages[stage], path);
    if (made) return std::move(*made);
    append(wrongOf(row.id), made.error());
    return {};
  }

  void words(const targets::Row& row, int stage) {
    const std::string path = shaderPath(row.id, shader_.id, stage);
    shader_.spirv[stage] = written(row, stage, path);
    if (!validates(row.id)) return;
    const StageTimer timer(times_, StageOfRun::Validate, row.id);
    append(wrongOf(row.id), check::checkWords(shader_.spirv[stage], path));
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
