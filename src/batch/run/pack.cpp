#include "run/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>

#include "lacquer/packed.h"
#include "manifest/read.h"
#include "run/named_shaders.h"
#include "run/packed.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/module.h"
#include "shader/print.h"
#include "support/contain.h"
#include "support/file.h"
#include "support/outputs.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// Reads the code that a manifest names.
class Packing {
public:
  Packing(const std::string& folder, const std::vector<Target>& targets, const Limits& limits)
      : folder_(folder), targets_(targets), limits_(limits) {}

  Result<void> read(const Manifest& manifest);
  const std::vector<PackedShader>& shaders() const { return shaders_; }
  const Strings& paths() const { return paths_; }

private:
  bool isWanted(Target target) const {
    return isShader(target) &&
           (targets_.empty() || std::find(targets_.begin(), targets_.end(), target) != targets_.end());
  }
  Result<void> readCode(const ManifestCode& code, PackedShader& shader);
  Diagnostics absent(const Manifest& manifest) const;

  const std::string& folder_;
  const std::vector<Target>& targets_;
  const Limits limits_;
  std::vector<PackedShader> shaders_;
  std::deque<std::string> texts_;  ///< which the shaders' codes are in
  Strings paths_;
};

Result<void> Packing::readCode(const ManifestCode& code, PackedShader& shader) {
  for (const auto& [stage, path] : code.files) {
    // A link may lead out of the folder.
    std::optional<std::string> file = resolveBelow(folder_, path, {});
    if (!file)
      return fail("manifest-outside",
                  {folder_ + "/manifest.json", 0, 0, "/shaders/" + std::string(shader.id)},
                  fmt::format("{} lies outside of the folder", quote(path)), "put the file itself there");
    paths_.push_back(std::move(*file));
    Result<std::string> bytes = readFile(paths_.back(), limits_.file, Links::None);
    if (!bytes) return tl::make_unexpected(std::move(bytes.error()));
    texts_.push_back(std::move(*bytes));
    shader.codes.push_back(
        {std::string(targetName(code.target)), stage, texts_.back(), code.validated.value_or(false)});
  }
  return {};
}

/// An error for each use whose shader the manifest does not have.
Diagnostics Packing::absent(const Manifest& manifest) const {
  std::set<std::string_view> known;
  for (const ManifestShader& shader : manifest.shaders) known.insert(shader.id);
  Diagnostics wrong;
  for (size_t i = 0; i < manifest.files.size(); ++i) {
    for (const NamedShader& named : shadersNamedIn(manifest.files[i], i)) {
      if (known.contains(named.id)) continue;
      addBounded(wrong, noSuchShader(folder_ + "/manifest.json", named, "pack what `lacquer gen` wrote"));
    }
  }
  return wrong;
}

Result<void> Packing::read(const Manifest& manifest) {
  if (Diagnostics wrong = absent(manifest); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  for (const ManifestShader& from : manifest.shaders) {
    PackedShader& shader = shaders_.emplace_back(
        PackedShader{from.id, &from.reflection, from.argument_buffers || from.reflection.bindless, {}});
    for (const ManifestCode& code : from.targets) {
      if (!isWanted(code.target)) continue;
      if (Result<void> read = readCode(code, shader); !read) return read;
    }
    for (const Target target : targets_) {
      const bool there = std::any_of(from.targets.begin(), from.targets.end(),
                                     [&](const ManifestCode& one) { return one.target == target; });
      if (!there || !isShader(target))
        return fail("no-such-target", {folder_ + "/manifest.json", 0, 0, "/shaders/" + from.id + "/files"},
                    "there is no shader of the target " + quote(targetName(target)),
                    "name targets that the folder was made with");
    }
  }
  return {};
}

Result<bool> packInto(const std::string& folder, const std::vector<Target>& targets, const std::string& file,
                      const Options& options, Messages& messages) {
  Result<void> good = hasPath("the folder", folder);
  if (good) good = hasPath("the output", file);
  if (!good) return tl::make_unexpected(std::move(good.error()));
  const std::string path = folder + "/manifest.json";
  const std::optional<Manifest> manifest = readManifest(path, options, messages);
  if (!manifest) return false;
  if (!manifest->levels.empty())
    return fail("unknown-property", {path, 0, 0, "/levels"}, "levels of detail are not packed",
                "pack what `lacquer gen` wrote");
  const Result<std::string> bytes =
      packedOf(*manifest, folder, targets, file, limitsOf(options).value_or(Limits{}));
  if (!bytes) return tl::make_unexpected(bytes.error());
  return writeFile(file, *bytes, {nullptr, options.sync});
}

}  // namespace

Result<std::string> packedOf(const Manifest& manifest, const std::string& folder,
                             const std::vector<Target>& targets, const std::string& file,
                             const Limits& limits) {
  Packing packing(folder, targets, limits);
  if (Result<void> good = packing.read(manifest); !good) return tl::make_unexpected(std::move(good.error()));
  Strings inputs = packing.paths();
  inputs.push_back(folder + "/manifest.json");
  if (Diagnostics wrong = clashes(inputs, {file}); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  std::vector<const FileContract*> files;
  for (const FileContract& one : manifest.files) files.push_back(&one);
  return packedBytes(files, packing.shaders());
}

Result<std::string> packedOf(std::string_view manifest, const std::string& folder, const std::string& file) {
  Limits limits;  // of what others write: this is our own
  for (const LimitRow& row : limitTable()) limits.*row.member = row.most;
  const Result<Manifest> values = manifest::read(manifest, file, limits);
  if (!values) return tl::make_unexpected(values.error());
  return packedOf(*values, folder, {}, file, limits);
}

/// A text that may be a name: what is longer is none, and is not read.
static std::string nameIn(const lacquer_packed& file, lacquer_packed_text text) {
  constexpr uint32_t kLongest = 1024;
  return text.count <= kLongest ? lacquer_packed_string(&file, text) : "";
}

Strings packedShaders(const std::string& path) {
  Strings paths;
  const Result<std::string> bytes = readFile(path);
  if (!bytes) return paths;
  lacquer_packed file{};
  const lacquer_packed_header* top = lacquer_packed_open(&file, bytes->data(), bytes->size());
  if (top == nullptr) return paths;
  // The file may be anybody's: a list that does not lie in it ends at once, whatever its count.
  const size_t most_codes = 2 * targetNames().size();
  for (uint32_t i = 0; i < top->shaders.count; ++i) {
    const auto* shader = LACQUER_PACKED_AT(&file, top->shaders, lacquer_packed_shader, i);
    if (shader == nullptr) break;
    const std::string id = nameIn(file, shader->id);
    if (!isShaderId(id)) continue;
    for (uint32_t k = 0; k < std::min<size_t>(shader->codes.count, most_codes); ++k) {
      const auto* code = LACQUER_PACKED_AT(&file, shader->codes, lacquer_packed_code, k);
      if (code == nullptr) break;
      Target target{};
      if (!findTarget(nameIn(file, code->target), target)) continue;
      const int stage = nameIn(file, code->stage) == "vert" ? 0 : 1;
      paths.push_back(shaderPath(target, id, stage));
    }
  }
  return paths;
}

bool pack(const std::string& folder, const std::vector<Target>& targets, const std::string& file,
          const Options& options, Messages& messages) {
  const Result<bool> written = packInto(folder, targets, file, options, messages);
  if (!written) report(written.error(), {}, messages);
  return written.has_value() && !hasError(messages);
}

}  // namespace lacquer
