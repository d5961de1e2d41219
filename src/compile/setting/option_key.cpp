#include "setting/option_key.h"

#include <algorithm>

namespace lacquer {

namespace {

template <class T>
void add(const T& number, KeyBuilder& key) {
  key.number(number);
}

void add(const std::string& text, KeyBuilder& key) { key.text(text); }

void add(const Lights& lights, KeyBuilder& key) {
  const auto& [mode, counts] = lights;
  key.number(mode).number(counts.size());
  for (const auto& [kind, count] : counts) key.text(kind).number(count);
}

void add(const std::map<std::string, bool, std::less<>>& switches, KeyBuilder& key) {
  key.number(switches.size());
  for (const auto& [name, on] : switches) key.text(name).number(on);
}

void add(const std::pair<std::string, std::string>& texts, KeyBuilder& key) {
  key.text(texts.first).text(texts.second);
}

template <class T>
void add(const std::vector<T>& list, KeyBuilder& key) {
  key.number(list.size());
  for (const T& one : list) add(one, key);
}

}  // namespace

void addOptions(const Options& options, std::initializer_list<Decides> what, KeyBuilder& key) {
  eachOption(options, [&](Decides decides, const auto& value) {
    if (std::find(what.begin(), what.end(), decides) != what.end()) add(value, key);
  });
}

}  // namespace lacquer
