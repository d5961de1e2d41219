#include "programs/weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

#include "json/json.h"
#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::programs {

namespace {

using json::Json;
using json::Path;

/// One share; its errors go to `report`, whose list is `wrong`.
Share readShare(const Json& row, const Path& path, json::Report& report, const Diagnostics& wrong) {
  Share share;
  if (!row.is_object()) {
    report.wrongType(path, "a share", row, "an object");
    return share;
  }
  for (const auto& [key, value] : row.items()) {
    if (isFull(wrong)) break;  // no more of it is said
    const Path here(path, key);
    if (key == "file") {
      if (!value.is_string()) report.wrongType(here, "file", value, "a string");
      if (value.is_string()) share.file = value.get<std::string>();
    } else if (key == "material") {
      const bool index =
          value.is_number_integer() && value.get<double>() >= -1 && value.get<double>() <= 1 << 30;
      if (!value.is_string() && !index) report.wrongType(here, "material", value, "a name or an index");
      if (value.is_string()) share.material = value.get<std::string>();
      if (index) share.material = value.get<int>();
    } else if (key == "share") {
      // A million of the largest are a number still.
      constexpr double kMost = std::numeric_limits<float>::max();
      const bool good = value.is_number() && value.get<double>() >= 0 && value.get<double>() <= kMost;
      if (!good) report.wrongType(here, "share", value, "a number from 0 to 3.4e38");
      if (good) share.share = value.get<double>();
    } else {
      report.error("unknown-property", here, fmt::format("a share has no {}", quote(key)),
                   "it has file, material and share");
    }
  }
  for (const char* key : {"material", "share"}) {
    if (json::member(row, key) == nullptr)
      report.error("missing-property", path, fmt::format("the share has no \"{}\"", key));
  }
  return share;
}

using Material = std::variant<std::string, int>;

/// Those of one material of one file stand together, and of them the last of the file is the last.
bool before(const Share& a, const Share& b) {
  return std::tie(a.material, a.file, a.place) < std::tie(b.material, b.file, b.place);
}

bool alike(const Share& a, const Share& b) { return a.material == b.material && a.file == b.file; }

/// The last share of that material with that `file`; -1 where there is none.
ptrdiff_t lastOf(const std::vector<Share>& shares, const Material& material, std::string_view file) {
  const auto end =
      std::upper_bound(shares.begin(), shares.end(), file, [&](std::string_view of, const Share& share) {
        return material != share.material ? material < share.material : of < share.file;
      });
  if (end == shares.begin()) return -1;
  const Share& share = *std::prev(end);
  return share.material == material && share.file == file ? end - shares.begin() - 1 : -1;
}

}  // namespace

Result<Weights> Weights::read(std::string_view text, const std::string& file, const Limits& limits) {
  const Result<Json> json = json::parse(text, file, limits);
  if (!json) return tl::make_unexpected(json.error());
  Diagnostics wrong;
  json::Report report(file, wrong);
  const Path root;
  const Path path(root, "weights");
  const Json* rows = json::member(*json, "weights");
  if (rows == nullptr || !rows->is_array()) {
    report.error("missing-property", root, "there is no array \"weights\"",
                 R"(write {"weights": [{"material": "Paint", "share": 0.25}]})");
    return tl::make_unexpected(std::move(wrong));
  }
  Weights weights;
  weights.given_ = true;
  double sum = 0;
  for (size_t i = 0; i < rows->size() && !isFull(wrong); ++i) {
    weights.shares_.push_back(readShare((*rows)[i], Path(path, i), report, wrong));
    weights.shares_.back().place = i;
    sum += weights.shares_.back().share;
  }
  if (wrong.empty() && !(sum > 0)) report.error("out-of-range", path, "no material has a share above 0");
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  std::sort(weights.shares_.begin(), weights.shares_.end(), before);
  weights.used_.resize(weights.shares_.size());
  return weights;
}

double Weights::of(std::string_view file, std::string_view name, size_t index) {
  if (!given_) return 1;
  const Material by_name = std::string(name), by_index = static_cast<int>(index);
  const Share* counts = nullptr;
  const auto look = [&](std::string_view parts) {
    for (const Material* material : {&by_name, &by_index}) {
      const ptrdiff_t at = lastOf(shares_, *material, parts);
      if (at < 0) continue;
      const Share& share = shares_[static_cast<size_t>(at)];
      used_[static_cast<size_t>(at)] = true;
      if (counts == nullptr || counts->place < share.place) counts = &share;
    }
  };
  look({});
  look(file);
  for (size_t slash = file.find('/'); slash != std::string_view::npos; slash = file.find('/', slash + 1))
    look(file.substr(slash + 1));
  return counts != nullptr ? counts->share : 0;
}

Diagnostics Weights::unused(const std::string& file) const {
  std::vector<size_t> places;
  for (size_t i = shares_.size(), last = i; i-- > 0;) {
    if (i + 1 == shares_.size() || !alike(shares_[i], shares_[i + 1])) last = i;
    if (!used_[last]) places.push_back(shares_[i].place);
  }
  std::sort(places.begin(), places.end());
  Diagnostics all;
  for (const size_t place : places) {
    if (isFull(all)) break;
    addBounded(all, {"no-such-material",
                     Severity::Warning,
                     {file, 0, 0, fmt::format("/weights/{}", place)},
                     "the run has no such material",
                     "name a material of the files, and its file where several have the name",
                     {}});
  }
  return all;
}

}  // namespace lacquer::programs
