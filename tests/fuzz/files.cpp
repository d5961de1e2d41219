// Inputs that are read from files: textures of a glTF file, cases, manifests and shards.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "feeds.h"
#include "gltf/texture_source.h"
#include "json/json.h"
#include "support/file.h"

namespace lacquer::fuzz {

namespace fs = std::filesystem;

namespace {

/// A separator within an input that stands for several files: no JSON holds it.
constexpr std::string_view kNextFile = "\n\x1c\n";

struct Work {
  std::string path;
  Work() {
    std::error_code ignored;
    const fs::path root = fs::is_directory("/dev/shm", ignored) ? "/dev/shm" : fs::temp_directory_path();
    path = (root / ("lacquer-fuzz-" + std::to_string(getpid()))).string();
    fs::remove_all(path, ignored);
    fs::create_directories(path);
  }
  ~Work() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

const std::string& workFolder() {
  static const Work kWork;
  return kWork.path;
}

std::string put(const std::string& name, std::string_view bytes) {
  std::string path = workFolder() + "/" + name;
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

std::string feedTexture(std::string_view bytes) {
  static const std::string kOutside = [] {
    fs::create_directories(workFolder() + "/textures");
    put("textures/inside.png", "inside");
    return put("outside.png", "outside");
  }();
  const auto file = gltf::TextureFile::open(put("textures/fuzz.gltf", bytes), {});
  if (!file) return file.error().empty() ? "a file is refused without an error" : "";
  for (int i = 0; i < 4; ++i) {
    const Result<gltf::TextureSource> source = file->texture(i);
    const Result<std::string> image = source ? file->image(*source) : tl::make_unexpected(source.error());
    if (image && *image == "outside") return "an image outside of the file's folder was read";
  }
  return {};
}

std::string feedCase(std::string_view bytes) {
  const std::string path = put("case.json", bytes);
  Options options;
  options.jobs = 1;
  Messages messages;
  return !stressNodes({}, {path}, options, messages) && !hasError(messages)
             ? "a case is refused without an error"
             : "";
}

std::string feedManifest(std::string_view bytes) {
  Strings shards;
  for (size_t at = 0; shards.size() < 4;) {
    const size_t end = std::min(bytes.find(kNextFile, at), bytes.size());
    shards.push_back(put("shard" + std::to_string(shards.size()) + ".json", bytes.substr(at, end - at)));
    if (end == bytes.size()) break;
    at = end + kNextFile.size();
  }
  const std::string once = workFolder() + "/once";
  const std::string twice = workFolder() + "/twice";
  Messages messages;
  if (!merge(shards, once, messages)) return hasError(messages) ? "" : "a merge fails without an error";
  // What is merged is a manifest, and stays what it is.
  const Result<std::string> merged = readFile(once + "/manifest.json");
  if (!merged || !json::parse(*merged, "merged")) return "a merged manifest is no JSON";
  if (!merge({once + "/manifest.json"}, twice, messages)) return "a merged manifest does not merge";
  if (readFile(twice + "/manifest.json").value_or("") != *merged) return "merging changes a merged manifest";
  // There is no SPIR-V beside it, nor may it name some elsewhere.
  messages.clear();
  if (!measureCost({once}, false, messages).empty()) return "a manifest names code outside of its folder";
  return {};
}

}  // namespace lacquer::fuzz
