// glTF files with random combinations of every property that is read, right ones and wrong ones.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace lacquer::test {

class RandomMaterial {
public:
  using Json = nlohmann::ordered_json;

  explicit RandomMaterial(uint64_t seed) : random_(seed) {}

  /// A file that follows all rules: some materials, each on some primitives.
  Json valid(size_t materials);
  /// The text of such a file after some damage, from a property's wrong type to a cut in the text.
  std::string damaged();

private:
  bool yes(unsigned one_in) { return random_() % one_in == 0; }
  size_t below(size_t n) { return random_() % n; }
  /// Often one of the ends.
  double number(double lo, double hi);
  Json color(size_t components);
  Json texture(const char* strength = nullptr);
  void maybe(Json& object, const char* name, const Json& value) {
    if (!yes(3)) object[name] = value;
  }
  Json metallicRoughness();
  Json coat();
  Json clearcoat();
  Json material(size_t index);
  Json junk(int depth = 0);
  void damage(Json& json);
  void misplace(Json& gltf);

  std::mt19937_64 random_;
};

}  // namespace lacquer::test
