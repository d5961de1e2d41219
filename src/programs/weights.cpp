#include "programs/weights.h"

#include <fmt/format.h>

#include <limits>

#include "json/json.h"
#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::programs {

namespace {

using json::Json;
using json::Path;

/// One share; its errors go to `report`.
Share readShare(const Json& row, const Path& path, json::Report& report) {
  Share share;
  if (!row.is_object()) {
    report.wrongType(path, "a share", row, "an object");
    return share;
  }
  for (const auto& [key, value] : row.items()) {
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

bool endsWith(std::string_view path, std::string_view parts) {
  return path == parts || (path.ends_with(parts) && path[path.size() - parts.size() - 1] == '/');
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
  for (size_t i = 0; i < rows->size(); ++i) {
    weights.shares_.push_back(readShare((*rows)[i], Path(path, i), report));
    weights.shares_.back().place = i;
    sum += weights.shares_.back().share;
  }
  if (wrong.empty() && !(sum > 0)) report.error("out-of-range", path, "no material has a share above 0");
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  weights.used_.resize(weights.shares_.size());
  return weights;
}

double Weights::of(std::string_view file, std::string_view name, size_t index) {
  if (!given_) return 1;
  double share = 0;
  for (size_t i = 0; i < shares_.size(); ++i) {
    const Share& one = shares_[i];
    const auto* by_name = std::get_if<std::string>(&one.material);
    const bool named =
        by_name != nullptr ? *by_name == name : std::get<int>(one.material) == static_cast<int>(index);
    if (!named || (!one.file.empty() && !endsWith(file, one.file))) continue;
    share = one.share;
    used_[i] = true;
  }
  return share;
}

Diagnostics Weights::unused(const std::string& file) const {
  Diagnostics all;
  for (size_t i = 0; i < shares_.size(); ++i) {
    if (used_[i]) continue;
    all.push_back({"no-such-material",
                   Severity::Warning,
                   {file, 0, 0, fmt::format("/weights/{}", shares_[i].place)},
                   "the run has no such material",
                   "name a material of the files, and its file where several have the name",
                   {}});
  }
  return all;
}

}  // namespace lacquer::programs
