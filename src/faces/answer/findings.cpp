#include <cmath>

#include "answer/answer.h"
#include "environment/read.h"
#include "json/text.h"
#include "manifest/text.h"

namespace lacquer {

namespace {

using json::Json;

/// A number, or a list of several.
Json numbersJson(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return numbers[0];
  return Json(numbers);
}

/// [low, high], infinite ends as words, with "nan" behind them for what may be NaN.
Json reachedJson(const Reached& reached) {
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(x < 0 ? "-inf" : "inf"); };
  Json json = Json::array({end(reached.low), end(reached.high)});
  if (reached.nan) json.push_back("nan");
  return json;
}

Json claimsJson(const std::vector<Claim>& claims) {
  Json json = Json::array();
  for (const Claim& claim : claims) {
    json.push_back({{"what", claim.what},
                    {"need", claim.need},
                    {"reached", reachedJson(claim.reached)},
                    {"proved", claim.proved}});
  }
  return json;
}

/// What a case names, and a subject begins with.
Json subjectJson(const StressSubject& subject) {
  Json json = Json::object();
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) json[key] = value;
  };
  add("case", subject.test);
  add("node", subject.node);
  add("variant", subject.variant);
  add("extension", subject.extension);
  add("graph", subject.graph);
  if (!subject.graph.empty()) json["name"] = subject.name;
  if (!subject.file.empty()) {
    json["file"] = subject.file;
    json["material"] = subject.material;
    json["name"] = subject.name;
  }
  if (!subject.tangents) json["tangents"] = false;
  return json;
}

/// Of Fault::Form: lists even of one number.
Json sampleJson(const StressFinding& finding) {
  Json sample = Json::object();
  for (const auto& [variable, value] : finding.samples.at(0)) sample[variable] = Json(value);
  return sample;
}

Json formJson(const StressFinding& finding) {
  Json json = {{"fault", faultName(finding.fault)}, {"what", finding.what}, {"parameter", finding.parameter}};
  if (!finding.layer.empty()) json["layer"] = finding.layer;
  json["at"] = Json(finding.at);
  json["beside"] = Json(finding.beside);
  if (std::isfinite(finding.value)) json["value"] = finding.value;
  json["sample"] = sampleJson(finding);
  return json;
}

Json caseJson(const StressFinding& finding, const StressSubject& subject) {
  Json json = subjectJson(subject);
  json["fault"] = faultName(finding.fault);
  json["what"] = finding.what;
  Json& samples = json["samples"] = Json::array();
  for (const NamedNumbers& sample : finding.samples) {
    Json named = Json::object();
    for (const auto& [name, numbers] : sample) named[name] = numbersJson(numbers);
    samples.push_back(std::move(named));
  }
  return json;
}

Json findingJson(const StressFinding& finding, const StressSubject& subject) {
  if (finding.fault == Fault::Form) return formJson(finding);
  Json json = {{"fault", faultName(finding.fault)}, {"what", finding.what}, {"count", finding.count}};
  // JSON has neither NaN nor infinity; the fault's name tells.
  if (std::isfinite(finding.value)) json["value"] = finding.value;
  if (!finding.known.empty()) json["known"] = finding.known;
  if (subject.test.empty()) json["case"] = caseJson(finding, subject);
  return json;
}

}  // namespace

std::string answerJson(const Proofs& proofs) {
  Json operations = Json::array();
  for (const OperationProof& proof : proofs.operations) {
    Json row = {{"term", proof.term}};
    if (!proof.name.empty()) row["name"] = proof.name;
    row["operation"] = proof.operation;
    row["rate"] = proof.rate;
    row["operand"] = proof.operand;
    row["need"] = proof.need;
    row["reached"] = reachedJson(proof.reached);
    row["safe"] = proof.safe;
    operations.push_back(std::move(row));
  }
  Json outputs = Json::array();
  for (const OutputProof& output : proofs.outputs)
    outputs.push_back({{"name", output.name}, {"reached", reachedJson(output.reached)}});
  return json::dump({{"material", proofs.material},
                     {"shader", proofs.shader},
                     {"operations", std::move(operations)},
                     {"outputs", std::move(outputs)},
                     {"contracts", claimsJson(proofs.contracts)}},
                    2);
}

std::string answerJson(const std::vector<NodeProof>& nodes) {
  Json all = Json::array();
  for (const NodeProof& proof : nodes) {
    Json row = {{"name", proof.node}};
    if (!proof.variant.empty()) row["variant"] = proof.variant;
    row["operations"] = claimsJson(proof.operations);
    row["results"] = claimsJson(proof.results);
    row["calls"] = claimsJson(proof.calls);
    all.push_back(std::move(row));
  }
  return json::dump({{"nodes", std::move(all)}}, 2);
}

std::string answerJson(const PreviewSheet& sheet) {
  Json json = {{"output", sheet.output}, {"materials", sheet.materials}};
  if (!sheet.compared.empty()) {
    json["compared"] = sheet.compared;
    Json& rows = json["differences"] = Json::array();
    for (const PreviewDifference& of : sheet.differences) {
      rows.push_back({{"file", of.file},
                      {"material", of.material},
                      {"max", of.largest},
                      {"mean", of.mean},
                      {"rms", of.root_mean_square}});
    }
  }
  return json::dump(json, 2) + "\n";
}

std::string answerJson(const Levels& levels) {
  json::JsonText json;
  json.beginObject().key("output").string(levels.output).key("driver").string(levels.driver);
  manifest::writeLevels(levels.materials, json.key("materials"));
  return json.endObject().take() + "\n";
}

std::string answerJson(const StressReport& report) {
  Json json = {{"seed", report.seed}, {"samples", report.samples}, {"mediump", report.mediump}};
  if (!report.device.empty()) json["device"] = report.device;
  Json& subjects = json["subjects"] = Json::array();
  for (const StressSubject& subject : report.subjects) {
    Json one = subjectJson(subject);
    if (subject.forms) one["forms"] = *subject.forms;
    if (!subject.skipped.empty()) one["skipped"] = subject.skipped;
    Json& findings = one["findings"] = Json::array();
    for (const StressFinding& finding : subject.findings) findings.push_back(findingJson(finding, subject));
    if (subject.energy) {
      one["energy"] = {{"largest", subject.energy->largest},
                       {"base", subject.energy->largest_base},
                       {"asymmetry", subject.energy->asymmetry}};
    }
    subjects.push_back(std::move(one));
  }
  json["faults"] = report.faults;
  return json::dump(json, 2) + "\n";
}

std::string caseText(const StressFinding& finding, const StressSubject& subject) {
  return json::dump(finding.fault == Fault::Form ? sampleJson(finding) : caseJson(finding, subject));
}

std::string answerJson(const EnvironmentMaps& maps) { return environmentJson(maps); }

std::string answerJson(const LightProfiles& profiles) {
  Json json = Json::object();
  if (!profiles.output.empty()) json = {{"output", profiles.output}, {"format", profiles.format}};
  Json& layers = json["profiles"] = Json::array();
  for (const LightProfile& of : profiles.layers) {
    Json one = {{"file", of.file}};
    if (of.light >= 0) one["light"] = of.light;
    one["standard"] = of.standard;
    one["photometry"] = of.photometry;
    one["symmetry"] = of.symmetry;
    one["vertical"] = of.vertical;
    one["horizontal"] = of.horizontal;
    one["peak"] = of.peak;
    one["lumens"] = of.lumens;
    one["width"] = of.width;
    one["height"] = of.height;
    one["error"] = of.error;
    one["mean_error"] = of.mean_error;
    layers.push_back(std::move(one));
  }
  return json::dump(json, 2) + "\n";
}

}  // namespace lacquer
