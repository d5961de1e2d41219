#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "eval/material.h"
#include "gltf/texture_source.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/base64.h"
#include "support/file.h"
#include "support/outputs.h"

namespace lacquer {

namespace {

/// Where the page has its files: JSON stands between this and the end of the element.
constexpr std::string_view kPlace = "<script type=\"application/json\" id=\"files\">";
constexpr std::string_view kEmpty = "[]</script>";
/// And what shaders cost, by their ids. A page may do without.
constexpr std::string_view kCosts = "<script type=\"application/json\" id=\"costs\">{}";
/// And how it makes its shaders.
constexpr std::string_view kOptions = "<script type=\"application/json\" id=\"options\">{}";

/// JSON for an HTML script element: no name in it ends the element.
std::string scriptText(const json::Json& json) {
  std::string text;
  for (const char c : json::dump(json)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

/// {ID: {"spirv": instructions, "gpus": {NAME: {"instructions", …}}}}, without what could not be measured.
json::Json costsJson(const std::vector<ShaderCost>& costs) {
  json::Json all = json::Json::object();
  for (const ShaderCost& shader : costs) {
    json::Json gpus = json::Json::object();
    for (const GpuCost& gpu : shader.gpus) {
      if (!gpu.problem.empty()) continue;
      gpus[gpu.gpu] = {{"instructions", gpu.instructions},
                       {"vgprs", gpu.vgprs},
                       {"latency", gpu.latency},
                       {"inverse_throughput", gpu.inverse_throughput}};
    }
    all[shader.name] = {{"spirv", shader.spirv_instructions}, {"gpus", std::move(gpus)}};
  }
  return all;
}

/// What the page's compiler can be told, of what is not as it is by default. The page has a template, lights
/// and parameters of its own.
json::Json optionsJson(const Options& options) {
  json::Json all = json::Json::object();
  if (!options.profile.empty()) all["profile"] = options.profile;
  if (!options.simplify.empty()) all["simplify"] = options.simplify;
  if (!options.live.empty()) all["live"] = options.live;
  if (options.permissive) all["permissive"] = true;
  if (!options.switches.empty()) {
    json::Json& switches = all["switches"] = json::Json::object();
    for (const auto& [name, on] : options.switches) switches[name] = on;
  }
  const Options usual;
  if (options.ibl != usual.ibl) all["ibl"] = options.ibl;
  if (options.multiple_scattering != usual.multiple_scattering)
    all["multiple_scattering"] = options.multiple_scattering;
  if (options.dfg_table != usual.dfg_table) all["dfg_table"] = options.dfg_table;
  return all;
}

void fill(std::string& page, size_t behind, std::string_view element, const json::Json& value) {
  if (const size_t at = page.find(element, behind); at != std::string::npos)
    page.replace(at + element.size() - 2, 2, scriptText(value));
}

class Viewing {
public:
  Viewing(const Options& options, Messages& messages)
      : options_(options), messages_(messages), limits_(limitsOf(options).value_or(Limits{})) {}

  Result<void> write(const View& view, const Strings& files) {
    if (const Result<Limits> limits = limitsOf(options_); !limits) return tl::make_unexpected(limits.error());
    if (Result<void> path = hasPath("the page", view.output); !path) return path;
    Result<std::string> page = readFile(view.page, limits_.file);
    const size_t place = page ? page->find(kPlace) : std::string::npos;
    if (place == std::string::npos || page->compare(place + kPlace.size(), kEmpty.size(), kEmpty) != 0) {
      return fail("no-page", {view.page, 0, 0, {}}, page ? "this is not the page" : "the page is not there",
                  "`./dev web` makes it, and an installation has it in share/lacquer/view.html");
    }
    inputs_.push_back(view.page);
    json::Json all = json::Json::array();
    for (const std::string& file : files) {
      Result<json::Json> entry = read(file);
      if (!entry) return tl::make_unexpected(std::move(entry.error()));
      all.push_back(std::move(*entry));
    }
    page->replace(place + kPlace.size(), 2, scriptText(all));
    // Behind the files, which may hold any text but no end of an element.
    fill(*page, place, kCosts, costsJson(view.costs));
    fill(*page, place, kOptions, optionsJson(options_));
    if (Diagnostics wrong = clashes(inputs_, {view.output}); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    const Result<bool> written = writeFile(view.output, *page, {nullptr, options_.sync});
    if (!written) return tl::make_unexpected(written.error());
    return {};
  }

private:
  Result<json::Json> read(const std::string& path) {
    const Result<gltf::TextureFile> file = gltf::TextureFile::open(path, {limits_, options_.allow});
    if (!file) return tl::make_unexpected(file.error());
    const Result<std::string> bytes = readFile(path, limits_.file);
    if (!bytes) return tl::make_unexpected(bytes.error());
    json::Json resources = json::Json::array();
    std::map<std::string, std::string> known;  // by path: one file may have many spellings
    held_ += bytes->size();
    for (const std::string& uri : file->fileUris()) {
      Result<std::string> resource = file->fileBytes(uri);
      if (resource) {
        const auto [first, fresh] = known.try_emplace(file->filesRead().back(), uri);
        held_ += fresh ? resource->size() : 0;
        if (held_ > limits_.file)
          return fail("file-too-large", {path, 0, 0, {}},
                      fmt::format("the page would hold files of more than {} bytes", limits_.file),
                      raising("file"));
        if (fresh)
          resources.push_back({{"uri", uri}, {"bytes", toBase64(*resource)}});
        else
          resources.push_back({{"uri", uri}, {"same", first->second}});
        continue;
      }
      for (Diagnostic& diagnostic : resource.error()) diagnostic.severity = Severity::Warning;
      report(resource.error(), path, messages_);
    }
    inputs_.push_back(path);
    const Strings of_resources = file->filesRead();
    inputs_.insert(inputs_.end(), of_resources.begin(), of_resources.end());
    return json::Json{{"name", std::filesystem::path(path).filename().string()},
                      {"bytes", toBase64(*bytes)},
                      {"resources", std::move(resources)}};
  }

  const Options& options_;
  Messages& messages_;
  Limits limits_;
  Strings inputs_;
  uint64_t held_ = 0;  ///< bytes of files that the page holds
};

}  // namespace

bool writeView(const View& view, const Strings& files, const Options& options, Messages& messages) {
  const Result<void> written = Viewing(options, messages).write(view, files);
  if (written) return true;
  report(written.error(), {}, messages);
  return false;
}

}  // namespace lacquer
