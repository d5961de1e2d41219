// A surface of MaterialX as a glTF material: what its inputs come to as factors, and as texels that a group
// computes.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "materialx/patterns.h"

namespace lacquer::materialx {

/// What an input comes to: numbers, or what it is connected to times numbers.
struct Value {
  int size = 1;  ///< 1 or 3
  ir::Components constant{};
  std::optional<graph::Source> source;
  bool isConstant(double x) const;
  /// Connected, or not 0.
  bool there() const { return source || !isConstant(0); }
};

/// The product of values, as glTF has it: a factor, and what the texture is.
struct Product {
  ir::Components factor{1, 1, 1, 1};
  std::optional<graph::Source> texel;
  bool color = false;  ///< the texel is one
};

class Surface {
public:
  Surface(Patterns& patterns, Scope& scope, const Element& shader, Diagnostics& said)
      : patterns_(patterns), scope_(scope), shader_(shader), said_(said) {}

  /// An input, or its default in the definition of the surface.
  Value get(std::string_view input, double by_default);
  Value get(std::string_view input, std::array<double, 3> by_default);
  /// One whose texel is no factor's: a number in front of it stays in the pattern.
  Value whole(std::string_view input, double by_default);
  Value whole(std::string_view input, std::array<double, 3> by_default);
  /// One that glTF has as a number alone: what is connected to it is left out, with a warning.
  double number(std::string_view input, double by_default);
  std::array<double, 3> color(std::string_view input, std::array<double, 3> by_default);
  bool flag(std::string_view input, bool by_default) { return number(input, by_default ? 1 : 0) != 0; }
  /// One that has no counterpart: a warning where it is not the default.
  void leave(std::string_view input, double by_default);
  void leave(std::string_view input, std::array<double, 3> by_default);
  /// One that says more of another, which was warned of.
  void pass(std::string_view input) { known_.emplace(input); }
  void warn(std::string_view input, std::string message, std::string help = {});

  Product product(const std::vector<Value>& values);
  /// A connected value, or a constant one, times a number.
  Product scaled(Product product, double by);
  Value scaled(Value value, double by);
  /// How bright a connected colour is.
  Value luminance(const Value& color);

  /// A property, by its path from the material on: "extensions/KHR_materials_ior/ior".
  void set(const std::string& path, json::Json value);
  /// In [0, 1], or [0, inf) where `open`; a warning, once for a property, where it was not.
  double inRange(std::string_view property, double x, bool open = false);
  /// A factor in [0, 1] (or [0, inf] where `open`) and one channel of a texture, "r" to "a".
  void scalar(const std::string& factor, const std::string& texture, char channel, const Product& product,
              bool open = false);
  void color(const std::string& factor, const std::string& texture, const Product& product,
             bool open = false);
  void baseColor(const Product& color, const Product& alpha);
  /// A factor beyond 1 goes into KHR_materials_emissive_strength.
  void emission(const Product& product, double strength);
  /// The normal of the surface, or of its coat, as a texture in tangent space.
  void normal(std::string_view input, const std::string& texture);
  void tangentSpaceNormal(std::string_view input, const std::string& texture);

  /// The material; `procedural` is the number of its group. The inputs that nobody asked for are warned of.
  json::Json finish(std::string_view name, size_t procedural);
  bool hasTexels() const { return !texels_.empty(); }
  const std::vector<std::pair<std::string, std::string>>& outputs() const { return outputs_; }

private:
  struct Texel {
    std::optional<graph::Source> color;
    std::array<std::optional<graph::Source>, 4> channels;
  };
  const Element* input(std::string_view name);
  Value value(std::string_view name, int size, ir::Components by_default, bool factored);
  bool takeFactor(const Element& in, Value& value);
  void normalTexel(const graph::Source& encoded, const std::string& texture, double scale);

  Patterns& patterns_;
  Scope& scope_;
  const Element& shader_;
  Diagnostics& said_;
  std::set<std::string, std::less<>> known_;
  json::Json material_ = json::Json::object();
  std::map<std::string, Texel> texels_;
  std::set<std::string, std::less<>> clamped_;
  std::vector<std::pair<std::string, std::string>> outputs_;
  std::deque<Element> made_;
};

/// Translates a surface. False for one that there is no translation for.
bool translate(Surface& surface, std::string_view category);
/// How far a translated surface is from its closures: the mean difference of colours under one lamp, of the
/// mean colour, over random surfaces, views and lights. 0 where they are alike.
double translationError(std::string_view category);
/// The surfaces that there is one for.
std::vector<std::string_view> translated();

/// The attribute of outputs that addTangentSpace() adds to a nodegraph: no connection means them.
inline constexpr std::string_view kMadeOutput = "made_output";
/// Gives a nodegraph an output in tangent space beside each that is a normal map's, for Surface::normal().
void addTangentSpace(Element& document);

/// A node whose input `disable` is true becomes one that gives its default input or value (MaterialX 1.39,
/// "Standard Node Inputs").
void takeDisabled(Element& document);

/// Each `convert` to a surfaceshader becomes the `surface_unlit` that it stands for.
void makeConversionsUnlit(Element& document);

}  // namespace lacquer::materialx
