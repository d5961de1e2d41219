#include "run/receipt.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>

#include "check/check.h"
#include "cost/cost.h"
#include "run/report_blob.h"
#include "setting/language.h"
#include "setting/option_key.h"
#include "setting/options.h"
#include "shader/module.h"
#include "support/jobs.h"
#include "targets/target.h"

namespace lacquer {

template <>
struct LastEnumerator<Message::Level> {
  static constexpr Message::Level value = Message::Level::Error;
};

template <class Archive>
static void fields(Archive& archive, Message& m) {
  archive(m.level, m.code, m.file, m.pointer, m.line, m.column, m.message, m.help, m.text);
}

template <class Archive>
static void fields(Archive& archive, ShaderReport& shader) {
  archive(shader.id, shader.validated, shader.files);
}

template <class Archive>
static void fields(Archive& archive, FileStamp& stamp) {
  archive(stamp.device, stamp.inode, stamp.size, stamp.modified, stamp.changed);
}

namespace {

/// A file that is changed twice within one tick of its file system's clock looks unchanged the second time.
/// The longest ticks are FAT's, of two seconds.
constexpr auto kTick = std::chrono::seconds(2);

/// An output that was written: its bytes count where its stamp alone says too little.
struct Left {
  FileStamp stamp;
  Key content;  ///< Key{}: the stamp is enough
};

template <class Archive>
void fields(Archive& archive, Left& left) {
  archive(left.stamp, left.content);
}

/// Bytes that a digest is taken of at a time, of files that are written piece by piece.
constexpr size_t kOutputBlock = size_t{1} << 20;

/// From this number on, files are looked at from several threads; starting these takes as long as some
/// hundred looks.
constexpr size_t kMany = 512;

void forEach(size_t count, const std::function<void(size_t)>& work) {
  if (count >= kMany) return inParallel(count, work);
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

/// The programs that check the targets' code.
std::string compilersOf(const Options& options) {
  std::string compilers;
  for (const Target target : options.targets) {
    if (options.validate) compilers += check::programsOf(target) + '\n';
    compilers += targets::row(target).identity;
  }
  return compilers;
}

/// What decides which structures share a program, and which form of a shader is taken, is a driver's word.
bool asksDriver(const Options& options) {
  return (options.programs > 0 || !options.programs_report.empty() || options.optimize > 0 || options.half) &&
         !options.programs_model;
}

Strings inputsOf(Strings files, const Options& options) {
  if (!options.weights.empty()) files.push_back(options.weights);
  return files;
}

void writeReport(const Report& report, BlobWriter& blob) {
  const std::span all(report.materials);
  std::vector<std::span<const MaterialReport>> files;
  for (size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].file == all[first].file) ++end;
    files.push_back(all.subspan(first, end - first));
  }
  blob(static_cast<uint64_t>(files.size()));
  for (const std::span<const MaterialReport> materials : files) {
    blob(materials[0].file);
    writeMaterials(materials, blob);
  }
  blob(report.shaders);
}

void readReport(BlobReader& blob, Report& report) {
  uint64_t files = 0;
  blob(files);
  for (uint64_t i = 0; i < files && blob.good(); ++i) {
    std::string file;
    blob(file);
    readMaterials(file, blob, report.materials);
  }
  blob(report.shaders);
  for (const ShaderReport& shader : report.shaders) {
    if (!isShaderId(shader.id)) blob.refuse();
    for (const auto& [path, bytes] : shader.files) {
      if (path.find("..") != std::string::npos || path.starts_with('/')) blob.refuse();
    }
  }
}

}  // namespace

void OutputKey::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const size_t taken = std::min(bytes.size(), kOutputBlock - block_.size());
    block_.append(bytes.data(), taken);
    bytes.remove_prefix(taken);
    if (block_.size() < kOutputBlock) return;
    const Digest digest = digestOf(block_);
    digests_.append(digest.begin(), digest.end());
    block_.clear();
  }
}

Key OutputKey::finish() {
  const Digest last = digestOf(block_);
  digests_.append(last.begin(), last.end());
  return keyOf(digests_);
}

Key outputKey(std::string_view bytes) {
  OutputKey key;
  key.append(bytes);
  return key.finish();
}

Receipt::Receipt(const Strings& files, const Strings& materials, const std::string& folder,
                 const Options& options, const Key& base, Cache& cache)
    : files_(inputsOf(files, options)),
      folder_(folder),
      options_(options),
      cache_(cache),
      begin_(std::chrono::system_clock::now()),
      largest_(limitsOf(options).value_or(Limits{}).file),
      contents_(contentsOf(files_, largest_)) {
  if (std::find(contents_.begin(), contents_.end(), Key{}) != contents_.end()) return;
  std::error_code ignored;  // the working folder only keeps projects apart that name theirs alike
  KeyBuilder key;
  key.text("receipt").key(base).text(std::filesystem::current_path(ignored).string()).text(folder);
  addOptions(
      options,
      {Decides::Graph, Decides::Module, Decides::Code, Decides::SpirvCode, Decides::MslCode, Decides::Run},
      key);
  key.text(compilersOf(options));
  if (asksDriver(options)) key.text(cost::unavailable()).text(cost::driverIdentity());
  key.number(materials.size());
  for (const std::string& name : materials) key.text(name);
  for (const std::string& file : files) key.text(file);
  key_ = key.finish();
}

bool Receipt::covers(const Options& options) {
  return !asksDriver(options) || !cost::unavailable().empty() || !cost::driverIdentity().empty();
}

/// First those that belong to no shader.
std::vector<std::string> Receipt::outputs(const Report& report) const {
  std::vector<std::string> paths{options_.packed.empty() ? folder_ + "/manifest.json" : options_.packed};
  for (const std::string& one : {options_.depfile, options_.programs_report, options_.pipelines}) {
    if (!one.empty()) paths.push_back(one);
  }
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

bool Receipt::settled(const FileStamp& stamp) const {
  const int64_t before =
      std::chrono::duration_cast<std::chrono::nanoseconds>((begin_ - kTick).time_since_epoch()).count();
  return std::max(stamp.modified, stamp.changed) < before;
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
  std::vector<Left> left;
  blob(contents);
  readReport(blob, earlier);
  blob(said, left);
  const std::vector<std::string> paths = outputs(earlier);
  if (!blob.complete() || left.size() != paths.size()) return false;
  std::vector<uint8_t> same(paths.size());
  forEach(paths.size(), [&](size_t i) {
    same[i] = stampOf(paths[i]) == left[i].stamp ? 1 : 0;
    if (same[i] == 0 || left[i].content == Key{}) return;
    const Result<std::string> there = readFile(paths[i]);
    same[i] = there && outputKey(*there) == left[i].content ? 1 : 0;
  });
  bool settles = false;
  for (size_t i = 0; i < paths.size(); ++i) {
    if (left[i].content == Key{}) continue;
    if (same[i] != 0) written_[paths[i]] = left[i].content;
    settles |= settled(left[i].stamp);
  }
  if (contents != contents_ || std::find(same.begin(), same.end(), 0) != same.end()) {
    note(earlier, same);
    return false;
  }
  report = std::move(earlier);
  if (settles) keep(report, said);  // from now on the stamps of what has settled are enough
  messages.insert(messages.end(), std::make_move_iterator(said.begin()), std::make_move_iterator(said.end()));
  return true;
}

const Key* Receipt::contentOf(const std::string& path) const {
  const auto it = written_.find(path);
  return it == written_.end() ? nullptr : &it->second;
}

const ShaderReport* Receipt::untouched(const std::string& id) const {
  const auto it = untouched_.find(id);
  return it == untouched_.end() ? nullptr : &it->second;
}

void Receipt::keep(const Report& report, const Messages& said) const {
  if (!key_ || !report.ok || hasError(said)) return;
  const std::vector<std::string> paths = outputs(report);
  std::vector<Left> left(paths.size());
  std::vector<uint8_t> known(paths.size());
  forEach(paths.size(), [&](size_t i) {
    const std::optional<FileStamp> stamp = stampOf(paths[i]);
    if (!stamp) return;
    left[i].stamp = *stamp;
    const Key* written = settled(*stamp) ? nullptr : contentOf(paths[i]);
    if (written != nullptr) left[i].content = *written;
    known[i] = written != nullptr || settled(*stamp) ? 1 : 0;
  });
  const bool all = std::find(known.begin(), known.end(), 0) == known.end();
  // What the run has read must be what the receipt is for.
  if (!all || contentsOf(files_, largest_) != contents_) return;
  BlobWriter blob;
  blob(contents_);
  writeReport(report, blob);
  blob(said, left);
  cache_.put(*key_, blob.take(), true);
}

}  // namespace lacquer
