#include "accuracy/tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accuracy/antialiasing.h"
#include "accuracy/grid.h"
#include "accuracy/openpbr.h"
#include "accuracy/profiles.h"

namespace lacquer::accuracy {

namespace {

constexpr double kIors[] = {1, 1.2, 1.5, 2, 3};
constexpr const char* kProfiles[] = {"khr", "openpbr", "physical"};
constexpr size_t kPaths = 40000;  ///< the walk's mean is within a few thousandths then
constexpr uint64_t kSeed = 20230713;

struct Errors {
  double square_mean = 0, largest = 0;
  Query at;  ///< of the largest
};

Errors errorsOf(const std::vector<double>& model, const std::vector<double>& exact,
                const std::vector<Query>& queries) {
  Errors errors;
  for (size_t i = 0; i < queries.size(); ++i) {
    const double error = std::abs(model[i] - exact[i]);
    errors.square_mean += error * error / static_cast<double>(queries.size());
    if (!(error > errors.largest)) continue;
    errors.largest = error;
    errors.at = queries[i];
  }
  return errors;
}

double exactOf(Light light, const Query& q) {
  return light == Light::Direct ? smoothDirect(q.coating, q.cosine_view, q.cosine_light)
                                : smoothEnvironment(q.coating, q.cosine_view);
}

/// Everything but the IOR and the tint, the point that the table shows by itself first.
std::vector<Query> grid(Light light, double ior, double tint) {
  std::vector<Query> queries = {{{ior, 0.5, tint, 0}, 1, 1}};
  for (const double albedo : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    for (int view = 1; view <= 10; ++view) {
      for (int from = 1; from <= (light == Light::Direct ? 10 : 1); ++from) {
        queries.push_back({{ior, albedo, tint, 0}, view / 10.0, from / 10.0});
      }
    }
  }
  return queries;
}

std::string smoothTable(Light light, double tint) {
  std::string text =
      "| IOR | exact | khr | openpbr | physical | khr: RMS | largest | openpbr: RMS | largest | physical: "
      "RMS | "
      "largest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const double ior : kIors) {
    const std::vector<Query> queries = grid(light, ior, tint);
    std::vector<double> exact;
    for (const Query& q : queries) exact.push_back(exactOf(light, q));
    std::string shown;
    std::string errors;
    for (const char* profile : kProfiles) {
      const std::vector<double> model = transmissions(profile, light, queries);
      const Errors e = errorsOf(model, exact, queries);
      shown += fmt::format(" {:.3f} |", model[0]);
      std::string where = fmt::format("albedo {}, view {}", e.at.coating.albedo, e.at.cosine_view);
      if (light == Light::Direct) where += fmt::format(", light {}", e.at.cosine_light);
      if (e.largest < 5e-4) where.clear();
      errors += fmt::format(" {:.4f} | {:.4f}{} |", std::sqrt(e.square_mean), e.largest,
                            where.empty() ? "" : " (" + where + ")");
    }
    text += fmt::format("| {} | {:.3f} |{}{}\n", ior, exact[0], shown, errors);
  }
  return text;
}

std::string roughTable() {
  std::string text =
      "| IOR | roughness | view | walk | khr | openpbr | physical |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const double ior : {1.2, 1.5, 2.0}) {
    for (const double roughness : {0.0, 0.3, 0.6, 1.0}) {
      for (const double view : {1.0, 0.3}) {
        const Query query{{ior, 0.5, 1, roughness}, view, 1};
        const Estimate walk = roughEnvironment(query.coating, view, kPaths, kSeed);
        text += fmt::format("| {} | {} | {} | {:.3f} ± {:.3f} |", ior, roughness, view, walk.mean,
                            walk.deviation);
        for (const char* profile : kProfiles) {
          text += fmt::format(" {:.3f} |", transmissions(profile, Light::Environment, {{query}})[0]);
        }
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace

std::string table(std::string_view name) {
  if (name == "rough") return roughTable();
  if (name == "antialiasing") return antialiasingTable();
  if (name == "openpbr") return openPbrTable();
  if (name == "grid") return gridTable();
  for (const Light light : {Light::Direct, Light::Environment}) {
    for (const double tint : {1.0, 0.5}) {
      const std::string kind = light == Light::Direct ? "direct" : "environment";
      if (name == fmt::format("{} {}", kind, tint)) return smoothTable(light, tint);
    }
  }
  ADD_FAILURE() << "there is no table '" << name << "'";
  return {};
}

}  // namespace lacquer::accuracy
