#include "mutate.h"

#include <cmath>
#include <cstring>
#include <random>

#include "vocabulary.h"

namespace lacquer::fuzz {

namespace {

/// Inputs do not grow beyond what a run can take a thousand of in a second.
constexpr size_t kMostValues = 600;

class Mutation {
public:
  Mutation(Json& root, uint64_t seed) : root_(root), random_(seed) { collect(root_); }

  void one(Form form) {
    const bool known = (form == Form::Gltf || form == Form::Glb || form == Form::Graph) && yes(2);
    if (known && form == Form::Graph) return changeGraph(root_, random_);
    if (known) return changeMaterial(root_, random_);
    any();
  }

  /// A part of `other` in place of a part of this one, or beside it.
  void cross(Json& other) {
    Mutation from(other, random_());
    insert(from.part());
  }

private:
  bool yes(unsigned one_in) { return random_() % one_in == 0; }
  size_t below(size_t n) { return n == 0 ? 0 : random_() % n; }

  void collect(Json& json) {
    all_.push_back(&json);
    if (!json.is_structured()) return;
    for (Json& child : json) collect(child);
  }

  Json& part() { return *all_[below(all_.size())]; }

  void insert(const Json& value) {
    const Json copy = value;
    Json& at = part();
    if (all_.size() > kMostValues) return;
    if (at.is_array())
      at.insert(at.begin() + static_cast<ptrdiff_t>(below(at.size() + 1)), copy);
    else if (at.is_object())
      at[keyAnywhere()] = copy;
    else
      at = copy;
  }

  std::string keyAnywhere() {
    for (int attempt = 0; attempt < 8; ++attempt) {
      const Json& at = part();
      if (!at.is_object() || at.empty()) continue;
      auto it = at.begin();
      std::advance(it, static_cast<ptrdiff_t>(below(at.size())));
      return it.key();
    }
    return "extensions";
  }

  void any() {
    Json& at = part();
    switch (below(6)) {
      case 0: return remove(at);
      case 1: return insert(part());
      case 2: {
        const Json copy = part();
        at = copy;
        return;
      }
      case 3: return rename(at);
      default: return value(at);
    }
  }

  void remove(Json& at) {
    if (!at.is_structured() || at.empty()) return value(at);
    at.erase(std::next(at.begin(), static_cast<ptrdiff_t>(below(at.size()))));
  }

  void rename(Json& at) {
    if (!at.is_object() || at.empty()) return value(at);
    auto it = std::next(at.begin(), static_cast<ptrdiff_t>(below(at.size())));
    const Json copy = it.value();
    const std::string key = keyAnywhere();
    at.erase(it);
    at[key] = copy;
  }

  void value(Json& at) {
    if (at.is_number())
      at = number(at.get<double>());
    else if (at.is_boolean())
      at = !at.get<bool>();
    else if (at.is_string())
      text(at);
    else if (yes(8))
      at = nullptr;
  }

  Json number(double old) {
    static constexpr double kNumbers[] = {0,    1,     -1,   0.5,  2,     1e-3, 1e-30, 1e-45,   1e30,
                                          3e38, 1e300, 1e-7, 4096, 65504, 1.5,  -0.0,  1 / 3.0, 100};
    switch (below(6)) {
      case 0: return old * 2;
      case 1: return -old;
      case 2: return std::floor(old) + static_cast<double>(below(4)) - 1;
      case 3: return static_cast<int64_t>(below(8));
      default: return kNumbers[below(std::size(kNumbers))];
    }
  }

  void text(Json& at) {
    const Json& other = part();
    if (other.is_string() && yes(2)) {
      const Json copy = other;
      at = copy;
      return;
    }
    auto& text = at.get_ref<std::string&>();
    const size_t place = below(text.size() + 1);
    if (yes(2))
      text.insert(place, 1, static_cast<char>(below(128)));
    else if (place < text.size())
      text.erase(place, 1 + below(4));
  }

  Json& root_;
  std::mt19937_64 random_;
  std::vector<Json*> all_;
};

Json read(std::string_view text) { return Json::parse(text, nullptr, false); }

std::string written(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// A GLB's JSON chunk and what comes behind it; the text is empty where it has none.
struct Glb {
  std::string_view text, rest;
};
constexpr size_t kGlbHead = 20;  ///< the file's header, then the first chunk's

Glb takeApart(std::string_view bytes) {
  uint32_t length = 0;
  if (bytes.size() < kGlbHead) return {};
  std::memcpy(&length, bytes.data() + 12, 4);
  if (length > bytes.size() - kGlbHead) return {};
  return {bytes.substr(kGlbHead, length), bytes.substr(kGlbHead + length)};
}

std::string putTogether(std::string text, std::string_view rest) {
  while (text.size() % 4 != 0) text += ' ';
  const auto word = [](size_t n) {
    const auto value = static_cast<uint32_t>(n);
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
  };
  return "glTF" + word(2) + word(kGlbHead + text.size() + rest.size()) + word(text.size()) + "JSON" + text +
         std::string(rest);
}

}  // namespace

std::string mutated(std::string_view bytes, Form form, uint64_t seed) {
  const Glb glb = form == Form::Glb ? takeApart(bytes) : Glb{bytes, {}};
  Json json = read(glb.text);
  if (!json.is_structured()) return {};
  for (uint64_t i = 0; i <= seed % 3; ++i) Mutation(json, seed + i).one(form);
  return form == Form::Glb ? putTogether(written(json), glb.rest) : written(json);
}

std::string crossed(std::string_view bytes, std::string_view other, Form form, uint64_t seed) {
  const Glb glb = form == Form::Glb ? takeApart(bytes) : Glb{bytes, {}};
  Json json = read(glb.text);
  Json from = read(form == Form::Glb ? takeApart(other).text : other);
  if (!json.is_structured() || !from.is_structured()) return {};
  Mutation(json, seed).cross(from);
  return form == Form::Glb ? putTogether(written(json), glb.rest) : written(json);
}

}  // namespace lacquer::fuzz
