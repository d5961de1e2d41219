// Entries of the cache: damaged ones, and whole ones that hold something else, as somebody could write them
// who may write to an unkeyed cache.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include "cache/cache.h"
#include "feeds.h"
#include "structures/structure.h"
#include "support/file.h"

namespace lacquer::fuzz {

namespace fs = std::filesystem;

namespace {

constexpr size_t kHeader = 80;
constexpr uint64_t kRoom = uint64_t{1} << 30;
constexpr size_t kKey = 8;  ///< where the key begins in the header
constexpr std::string_view kMaterial =
    R"({"asset": {"version": "2.0"}, "materials": [{"emissiveFactor": [0.5, 0, 0]}]})";

struct Entry {
  std::string path, bytes;
  Key key;
  bool receipt = false;
};

/// A run that has filled a cache, and its entries: a receipt, a file, a structure, and two targets' code.
class Filled {
public:
  Filled() : folder_(workFolder() + "/cache") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/in.gltf") << kMaterial;
    options.targets = {Target::Glsl, Target::Spirv};
    options.validate = false;
    options.jobs = 1;
    options.sync = false;
    options.template_name = "bsdf";
    options.cache = folder_ + "/cache";
    (void)run();
    note(false);
    // A receipt is written for outputs alone that have rested for two ticks of the slowest clock.
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));
    (void)run();
    note(true);
  }

  Report run() {
    Messages messages;
    return generate({folder_ + "/in.gltf"}, {}, folder_ + "/out", options, messages);
  }

  /// The cache as it was, but for one entry; the receipt only when it is that one.
  void restore(const Entry& but, std::string_view bytes) const {
    for (const Entry& entry : entries) {
      const bool is = &entry == &but;
      if (entry.receipt && !is)
        fs::remove(entry.path);
      else
        std::ofstream(entry.path, std::ios::binary) << (is ? bytes : std::string_view(entry.bytes));
    }
  }

  /// Names in the work folder and in the output folder, which no entry may change.
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& file : fs::directory_iterator(folder_)) all.insert(file.path().string());
    for (const auto& file : fs::directory_iterator(workFolder())) all.insert(file.path().string());
    return all;
  }

  const std::string& folder() const { return folder_; }
  Options options;
  std::vector<Entry> entries;

private:
  void note(bool receipt) {
    std::vector<std::string> paths;
    for (const auto& file : fs::recursive_directory_iterator(folder_ + "/cache")) {
      if (file.is_regular_file()) paths.push_back(file.path().string());
    }
    std::sort(paths.begin(), paths.end());
    for (const std::string& path : paths) {
      const bool known =
          std::any_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.path == path; });
      if (known) continue;
      Entry entry{path, *readFile(path), {}, receipt};
      std::memcpy(&entry.key, entry.bytes.data() + kKey, sizeof entry.key);
      entries.push_back(std::move(entry));
    }
  }

  std::string folder_;
};

}  // namespace

namespace {

/// Without a run, which is made of one input in sixteen of these: a damaged entry is not there, and a forged
/// structure is read or it is not. Nothing where it takes a run to say.
std::optional<std::string> withoutARun(const Filled& filled, const Entry& entry, bool damaged,
                                       std::string_view payload) {
  constexpr uint64_t kRuns = 16;
  if (numberOf(payload) % kRuns == 0) return std::nullopt;
  if (damaged) {
    const std::optional<std::string> got = Cache(filled.options.cache, kRoom, "").get(entry.key);
    const bool taken = got && *got != std::string_view(entry.bytes).substr(kHeader);
    return taken ? "a damaged entry of the cache was taken" : std::string();
  }
  Structure whole;
  if (!fromBlob(std::string_view(entry.bytes).substr(kHeader), whole)) return std::nullopt;
  Structure structure;
  (void)fromBlob(payload, structure);
  return std::string();
}

}  // namespace

/// The first byte says which entry it is and whether it has the right checksum; the rest is what it holds.
/// With bit 6 the rest stands in place of the true payload from there on, so that damage deep in an entry
/// needs no copy of what is before it: two bytes say from where. With bit 5 a damaged one begins with the
/// true header.
std::string feedEntry(std::string_view bytes) {
  static Filled filled;
  if (filled.entries.size() < 5) return "the run has not filled the cache";
  if (bytes.size() < 3) return {};
  const auto head = static_cast<unsigned char>(bytes[0]);
  const Entry& entry = filled.entries[head % 8 % filled.entries.size()];
  std::string payload(bytes.substr(3));
  if ((head & 0x40) != 0) {
    std::string whole = entry.bytes.substr(kHeader);
    const size_t from = (static_cast<unsigned char>(bytes[1]) * 256U + static_cast<unsigned char>(bytes[2])) %
                        (whole.size() + 1);
    const size_t length = std::min(payload.size(), whole.size() - from);
    whole.replace(from, length, payload);
    payload = std::move(whole);
  }
  const bool damaged = (head & 0x80) != 0;
  if (damaged && (head & 0x20) != 0) payload.insert(0, entry.bytes, 0, kHeader);
  filled.restore(entry, damaged ? std::string_view(payload) : std::string_view(entry.bytes));
  if (!damaged) Cache(filled.options.cache, kRoom, "").put(entry.key, payload);
  if (std::optional<std::string> said = withoutARun(filled, entry, damaged, payload)) return std::move(*said);
  const std::set<std::string> before = filled.names();
  const Report report = filled.run();
  if (filled.names() != before) return "an entry of the cache made a file elsewhere";
  for (const ShaderReport& shader : report.shaders) {
    if (shader.id.find('/') != std::string::npos) return "an entry of the cache named a path";
  }
  if (damaged && !report.ok) return "a damaged entry of the cache broke a run";
  return {};
}

}  // namespace lacquer::fuzz
