#include "run/receipt.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>

#include "cache/option_key.h"
#include "check/check.h"
#include "run/report_blob.h"
#include "shader/language.h"
#include "shader/module.h"
#include "shader/options.h"

namespace lacquer {

namespace {

/// A file that is changed twice within one tick of its file system's clock looks unchanged the second time.
/// The longest ticks are FAT's, of two seconds.
constexpr auto kTick = std::chrono::seconds(2);

/// From this number on, files are looked at from several threads; starting these takes as long as some
/// hundred looks.
constexpr size_t kMany = 512;

void forEach(size_t count, const std::function<void(size_t)>& work) {
  if (count >= kMany) return tbb::parallel_for(size_t{0}, count, work);
  for (size_t i = 0; i < count; ++i) work(i);
}

/// The keys of the files' bytes; an empty key for a file that cannot be read.
std::vector<Key> contentsOf(const Strings& files, uint64_t largest) {
  std::vector<Key> contents(files.size());
  forEach(files.size(), [&](size_t i) {
    if (const Result<std::string> bytes = readFile(files[i], largest)) contents[i] = keyOf(*bytes);
  });
  return contents;
}

/// The compiler that checks the HLSL a second time, where it does.
std::string dxcOf(const Options& options) {
  const auto& targets = options.targets;
  const bool hlsl = std::find(targets.begin(), targets.end(), Target::Hlsl) != targets.end();
  return hlsl && options.validate ? check::dxcIdentity() : "";
}

void writeMessages(const Messages& messages, BlobWriter& blob) {
  blob.list(messages, [&](const Message& m) {
    blob.number(m.level), blob.text(m.code), blob.text(m.file), blob.text(m.pointer);
    blob.number(m.line), blob.number(m.column);
    blob.text(m.message), blob.text(m.help), blob.text(m.text);
  });
}

void readMessages(BlobReader& blob, Messages& messages) {
  blob.list([&] {
    Message m;
    m.level = blob.choice(Message::Level::Error), m.code = blob.text(), m.file = blob.text(),
    m.pointer = blob.text();
    m.line = blob.number<uint32_t>(), m.column = blob.number<uint32_t>();
    m.message = blob.text(), m.help = blob.text(), m.text = blob.text();
    messages.push_back(std::move(m));
  });
}

void writeReport(const Report& report, BlobWriter& blob) {
  const std::span all(report.materials);
  std::vector<std::span<const MaterialReport>> files;
  for (size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].file == all[first].file) ++end;
    files.push_back(all.subspan(first, end - first));
  }
  blob.list(files, [&](std::span<const MaterialReport> materials) {
    blob.text(materials[0].file);
    writeMaterials(materials, blob);
  });
  blob.list(report.shaders, [&](const ShaderReport& shader) {
    blob.text(shader.id), blob.number(shader.validated);
    blob.list(shader.files, [&](const auto& f) { blob.text(f.first), blob.number<uint64_t>(f.second); });
  });
}

void readReport(BlobReader& blob, Report& report) {
  blob.list([&] {
    const std::string file = blob.text();
    readMaterials(file, blob, report.materials);
  });
  blob.list([&] {
    ShaderReport shader;
    shader.id = blob.text(), shader.validated = blob.number<bool>();
    if (!isShaderId(shader.id)) blob.refuse();
    blob.list([&] {
      std::string path = blob.text();
      if (path.find("..") != std::string::npos || path.starts_with('/')) blob.refuse();
      shader.files.emplace_back(std::move(path), blob.number<uint64_t>());
    });
    report.shaders.push_back(std::move(shader));
  });
}

void writeStamp(const FileStamp& stamp, BlobWriter& blob) {
  blob.number(stamp.device), blob.number(stamp.inode), blob.number(stamp.size);
  blob.number(stamp.modified), blob.number(stamp.changed);
}

FileStamp readStamp(BlobReader& blob) {
  FileStamp stamp;
  stamp.device = blob.number<uint64_t>(), stamp.inode = blob.number<uint64_t>();
  stamp.size = blob.number<uint64_t>();
  stamp.modified = blob.number<int64_t>(), stamp.changed = blob.number<int64_t>();
  return stamp;
}

}  // namespace

Receipt::Receipt(const Strings& files, const Strings& materials, const std::string& folder,
                 const Options& options, const Key& base, Cache& cache)
    : files_(files),
      folder_(folder),
      options_(options),
      cache_(cache),
      begin_(std::chrono::system_clock::now()),
      largest_(limitsOf(options).value_or(Limits{}).file),
      contents_(contentsOf(files, largest_)) {
  if (std::find(contents_.begin(), contents_.end(), Key{}) != contents_.end()) return;
  std::error_code ignored;  // the working folder only keeps projects apart that name theirs alike
  KeyBuilder key;
  key.text("receipt").key(base).text(std::filesystem::current_path(ignored).string()).text(folder);
  addOptions(options, {Decides::Graph, Decides::Module, Decides::Code, Decides::SpirvCode, Decides::Run},
             key);
  key.text(dxcOf(options));
  key.number(materials.size());
  for (const std::string& name : materials) key.text(name);
  for (const std::string& file : files) key.text(file);
  key_ = key.finish();
}

/// First those that belong to no shader.
std::vector<std::string> Receipt::outputs(const Report& report) const {
  std::vector<std::string> paths{folder_ + "/manifest.json"};
  if (!options_.depfile.empty()) paths.push_back(options_.depfile);
  for (const ShaderReport& shader : report.shaders) {
    for (const auto& [path, bytes] : shader.files) paths.push_back(folder_ + "/" + path);
  }
  return paths;
}

/// Notes the shaders that have nothing but files for which `same` says so.
void Receipt::note(Report& report, const std::vector<uint8_t>& same) {
  auto end = same.end();
  for (auto shader = report.shaders.rbegin(); shader != report.shaders.rend(); ++shader) {
    const auto begin = end - static_cast<ptrdiff_t>(shader->files.size());
    if (std::find(begin, end, 0) == end) untouched_.emplace(shader->id, std::move(*shader));
    end = begin;
  }
}

bool Receipt::find(Report& report, Messages& messages) {
  if (!key_) return false;
  // Once in an hour the run is made in full, so that what it needs counts as used and stays in the cache.
  bool rested = false;
  const std::optional<std::string> bytes = cache_.get(*key_, &rested);
  if (!bytes || rested) return false;
  BlobReader blob(*bytes);
  Report earlier;
  Messages said;
  std::vector<Key> contents;
  std::vector<FileStamp> stamps;
  blob.list([&] {
    const auto high = blob.number<uint64_t>();
    contents.push_back({high, blob.number<uint64_t>()});
  });
  readReport(blob, earlier);
  readMessages(blob, said);
  blob.list([&] { stamps.push_back(readStamp(blob)); });
  const std::vector<std::string> paths = outputs(earlier);
  if (!blob.complete() || stamps.size() != paths.size()) return false;
  std::vector<uint8_t> same(paths.size());
  forEach(paths.size(), [&](size_t i) { same[i] = stampOf(paths[i]) == stamps[i] ? 1 : 0; });
  if (contents != contents_ || std::find(same.begin(), same.end(), 0) != same.end()) {
    note(earlier, same);
    return false;
  }
  report = std::move(earlier);
  messages.insert(messages.end(), std::make_move_iterator(said.begin()), std::make_move_iterator(said.end()));
  return true;
}

const ShaderReport* Receipt::untouched(const std::string& id) const {
  const auto it = untouched_.find(id);
  return it == untouched_.end() ? nullptr : &it->second;
}

void Receipt::keep(const Report& report, const Messages& said) const {
  if (!key_ || !report.ok || hasError(said)) return;
  const std::vector<std::string> paths = outputs(report);
  std::vector<std::optional<FileStamp>> stamps(paths.size());
  forEach(paths.size(), [&](size_t i) { stamps[i] = stampOf(paths[i]); });
  const int64_t settled =
      std::chrono::duration_cast<std::chrono::nanoseconds>((begin_ - kTick).time_since_epoch()).count();
  const bool all = std::all_of(stamps.begin(), stamps.end(), [&](const std::optional<FileStamp>& stamp) {
    return stamp && std::max(stamp->modified, stamp->changed) < settled;
  });
  // What the run has read must be what the receipt is for.
  if (!all || contentsOf(files_, largest_) != contents_) return;
  BlobWriter blob;
  blob.list(contents_, [&](const Key& key) { blob.number(key.high), blob.number(key.low); });
  writeReport(report, blob);
  writeMessages(said, blob);
  blob.list(stamps, [&](const std::optional<FileStamp>& stamp) { writeStamp(*stamp, blob); });
  cache_.put(*key_, blob.take(), true);
}

}  // namespace lacquer
