#include "preview/setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "setting/simplify.h"

namespace lacquer {

namespace {

Result<void> checkSimplification(const PreviewSetting& setting) {
  if (const auto simpler = simplificationOf(setting.options.simplify); !simpler)
    return tl::make_unexpected(simpler.error());
  return {};
}

struct Word {
  const char* name;
  void (*apply)(PreviewSetting&);
};

/// What can be compared beside profiles and variants.
constexpr Word kWords[] = {
    {"as-given", [](PreviewSetting&) {}},
    {"float", [](PreviewSetting& s) { s.in_float = true; }},
    {"double", [](PreviewSetting& s) { s.in_float = false; }},
    {"uniform", [](PreviewSetting& s) { s.options.parameters = Parameters::Uniform; }},
    {"baked", [](PreviewSetting& s) { s.options.parameters = Parameters::Baked; }},
    {"spec", [](PreviewSetting& s) { s.options.parameters = Parameters::Spec; }},
    {"multiple-scattering", [](PreviewSetting& s) { s.options.multiple_scattering = true; }},
    {"no-multiple-scattering", [](PreviewSetting& s) { s.options.multiple_scattering = false; }},
    {"ibl", [](PreviewSetting& s) { s.options.ibl = true; }},
    {"no-ibl", [](PreviewSetting& s) { s.options.ibl = false; }},
};
constexpr std::string_view kVariant = "variant:";

Result<void> applyWord(const std::string& word, PreviewSetting& setting) {
  // Of one node, with a `=`, it is a level's word.
  const bool of_all = word.starts_with(kVariant) && word.find('=') == std::string::npos;
  if (word.find(':') != std::string::npos && !of_all) {
    setting.options.simplify.push_back(word);
    return checkSimplification(setting);
  }
  if (word.starts_with(kVariant) && word.size() > kVariant.size()) {
    setting.variant = word.substr(kVariant.size());
    return {};
  }
  const auto* found = std::find_if(std::begin(kWords), std::end(kWords),
                                   [&](const Word& known) { return word == known.name; });
  if (found == std::end(kWords)) {
    const Strings readings = profiles(setting.options);
    if (std::find(readings.begin(), readings.end(), word) != readings.end()) {
      setting.options.profile = word;
      return {};
    }
    std::string known;
    for (const std::string& name : readings) known += name + ", ";
    for (const Word& w : kWords) known += fmt::format("{}, ", w.name);
    return fail("unknown-setting", {}, fmt::format("--compare: there is no setting '{}'", word),
                fmt::format("there are {}variant:NAME and the words of levels of detail, such as "
                            "without:coat; several are joined by +",
                            known));
  }
  found->apply(setting);
  return {};
}

}  // namespace

Result<PreviewSetting> previewSetting(const std::string& text, PreviewSetting base) {
  base.name = text;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('+', begin), text.size());
    if (Result<void> applied = applyWord(text.substr(begin, end - begin), base); !applied)
      return tl::make_unexpected(std::move(applied.error()));
    begin = end + 1;
  }
  return base;
}

}  // namespace lacquer
