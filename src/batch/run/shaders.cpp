#include "run/shaders.h"

#include <atomic>

#include "manifest/text.h"
#include "structures/code.h"
#include "support/jobs.h"

namespace lacquer {

namespace {

class Maker {
public:
  Maker(const Setting& setting, const std::string& folder, const Scratch& scratch, const Receipt* receipt)
      : setting_(setting),
        folder_(folder),
        writing_{&scratch, setting.options.sync},
        receipt_(receipt),
        coder_(setting) {}

  MadeShader make(const std::string& id, Distinct& shader) const;

private:
  void write(const std::string& id, const Structure& structure, const std::map<Target, TargetCode>& codes,
             MadeShader& made) const;
  std::string entry(const std::string& id, const Structure& structure,
                    const std::map<Target, TargetCode>& codes) const;

  const Setting& setting_;
  const std::string& folder_;
  Writing writing_;
  const Receipt* receipt_;
  Coder coder_;
};

void Maker::write(const std::string& id, const Structure& structure,
                  const std::map<Target, TargetCode>& codes, MadeShader& made) const {
  const StageTimer timer(setting_.times, StageOfRun::Write);
  for (const Target target : setting_.options.targets) {
    for (int stage = firstStage(target, structure.has_vertex); stage < 2; ++stage) {
      const std::string path = shaderPath(target, id, stage);
      const std::string& bytes = codes.at(target).bytes[stage];
      const Result<bool> written = writeFile(folder_ + "/" + path, bytes, writing_);
      if (!written)
        made.wrong.insert(made.wrong.end(), written.error().begin(), written.error().end());
      else
        made.written += *written ? 1 : 0;
      made.files.emplace_back(path, bytes.size());
      if (receipt_ != nullptr) made.contents.push_back(outputKey(bytes));
    }
  }
}

std::string Maker::entry(const std::string& id, const Structure& structure,
                         const std::map<Target, TargetCode>& codes) const {
  std::vector<ManifestCode> made;
  for (const Target target : setting_.options.targets)
    made.push_back(manifest::codeOf(target, id, structure.has_vertex, codes.at(target).validated));
  json::JsonText json(manifest::kEntryDepth);
  manifest::writeShader(made, structure.reflection, setting_.options.argument_buffers, json);
  return json.take();
}

MadeShader Maker::make(const std::string& id, Distinct& shader) const {
  MadeShader made;
  made.id = id;
  const bool arrays = hasArrays(shader.structure->reflection);
  if (const ShaderReport* left = receipt_ == nullptr ? nullptr : receipt_->untouched(id)) {
    made.cached = true;
    made.validated = left->validated;
    made.files = left->files;
    std::map<Target, TargetCode> codes;
    for (const Target target : setting_.options.targets)
      codes[target].validated = left->validated && hasValidator(target, arrays);
    made.text = entry(id, *shader.structure, codes);
    shader.module.reset();
    return made;
  }
  ShaderCode code = coder_.code(id, shader);
  shader.module.reset();
  made.cached = code.cached;
  for (Diagnostic& wrong : code.wrong) {
    if (!wrong.place.file.empty()) wrong.place.file = folder_ + "/" + wrong.place.file;
    made.wrong.push_back(std::move(wrong));
  }
  made.validated = setting_.options.validate;
  if (!code.complete()) return made;
  // Of what nothing here compiles the manifest says so.
  for (const auto& [target, one] : code.targets)
    made.validated &= one.validated || !hasValidator(target, arrays);
  write(id, *shader.structure, code.targets, made);
  made.text = entry(id, *shader.structure, code.targets);
  return made;
}

}  // namespace

std::vector<MadeShader> makeShaders(std::map<std::string, Distinct>& shaders, const Setting& setting,
                                    const std::string& folder, const Scratch& scratch, const Receipt* receipt,
                                    const std::function<void(size_t done)>& progress) {
  std::vector<std::pair<const std::string*, Distinct*>> list;
  for (auto& [id, shader] : shaders) list.emplace_back(&id, &shader);
  std::vector<MadeShader> made(list.size());
  std::atomic<size_t> done{0};
  std::atomic_flag reporting;  // not a mutex: what is called may wait by taking work of this very loop
  const Maker maker(setting, folder, scratch, receipt);
  inParallel(list.size(), [&](size_t i) {
    made[i] = maker.make(*list[i].first, *list[i].second);
    const size_t finished = ++done;
    if (reporting.test_and_set(std::memory_order_acquire)) return;
    progress(finished);  // when it throws, nothing is reported any more
    reporting.clear(std::memory_order_release);
  });
  return made;
}

}  // namespace lacquer
