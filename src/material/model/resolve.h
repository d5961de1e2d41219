// What the lines of a model come to for one material: which are there, and what each is made of.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "model/build.h"
#include "model/dimming.h"

namespace lacquer::model {

/// Up to four letters of a swizzle.
class Letters {
public:
  Letters() = default;
  explicit Letters(std::string_view letters) : count_(static_cast<uint8_t>(letters.size())) {
    assert(letters.size() <= letters_.size());
    std::copy(letters.begin(), letters.end(), letters_.begin());
  }
  std::string_view view() const { return {letters_.data(), count_}; }
  bool empty() const { return count_ == 0; }
  bool operator==(const Letters&) const = default;

private:
  std::array<char, 4> letters_{};
  uint8_t count_ = 0;
};

/// What a name comes to. A swizzle may stand behind any of them.
struct Found {
  enum class Kind : uint8_t {
    Nothing,
    Void,      ///< `none`: nothing, for good
    Constant,  ///< `constant` of `type`
    Number,    ///< an editable number: `property`
    Member,    ///< one of a textureInfo: `property`, `member`
    Texel,     ///< of the texture `property`
    Uv,        ///< the coordinate of the texture `property`
    Image,     ///< the texture `property` itself
    Given,     ///< `index` in Model::givens
    Texture,   ///< the template's: `index` in Model::givens
    Node,      ///< `output` of the node `index`, an id
  };
  Kind kind = Kind::Nothing;
  ir::Type type = ir::Type::Float;
  uint32_t index = 0;
  uint16_t property = 0;
  int member = -1;
  bool animated = false;  ///< a number whose value today says nothing of its value tomorrow
  ir::Components constant{};
  std::string_view output;
  Letters swizzle;

  static Found of(Kind kind, ir::Type type = ir::Type::Float, const ir::Components& constant = {}) {
    Found found;
    found.kind = kind;
    found.type = type;
    found.constant = constant;
    return found;
  }
  explicit operator bool() const { return kind != Kind::Nothing && kind != Kind::Void; }
  bool operator==(const Found&) const = default;
};

/// Resolves lazily: what nobody asks for is not looked at.
class Resolver {
public:
  Resolver(const Model& model, const lang::TemplateDecl& template_decl, const material::Material& material,
           const gltf::VertexAttributes& attributes, const BuildOptions& options, Diagnostics& warnings);

  /// A node that an id stands for; null when it stands for nothing or for another value.
  struct Node {
    const lang::NodeDecl* decl = nullptr;
    std::string_view variant;
    bool shared = false;
    uint32_t order = Line::kNone;
    std::vector<Found> inputs;  ///< by the node's parameters
  };
  const Node* node(uint32_t id) const { return nodes_[id].decl == nullptr ? nullptr : &nodes_[id]; }

  /// What the material is for a port of the template.
  Found port(std::string_view name);
  /// Whether a line of the kind Out is what a port was given.
  bool taken(const Line& line) const { return taken_[static_cast<size_t>(&line - model_.lines.data())]; }
  /// Looks at every term of the parts that the material has; those that it could have and has not, with the
  /// reasons.
  std::vector<graph::Skipped> skipped();
  /// The warnings about parts that are both there and whose order nothing says (model/order.h).
  Diagnostics unordered();
  bool has(const Part& part) const;
  bool alive(uint32_t term);
  /// Whether a line of the part, or the last line of the term, comes to something: what it is for.
  bool gives(uint32_t term);
  /// Of a term that gives nothing: the first thing that a line of it needs and the material, the primitive or
  /// the template does not have; empty where it is something else.
  std::string missing(uint32_t term);
  /// Of a line that was asked for and came to nothing: what it needs and has not, as of missing(); else
  /// empty.
  std::string unmade(const Line& line);
  /// A property that stands for a role, and what it is when the file does not say.
  uint16_t provider(const Role& role) const;
  ir::Components numberOf(uint16_t property) const;
  const Diagnostics& wrong() const { return wrong_; }

private:
  enum class State : uint8_t { Unknown, Open, Done };

  Found id(uint32_t id);
  Found fromLine(const Line& line);
  Found chosen(const Line& line);
  Found dimmed(uint32_t id, uint32_t part);
  bool enter(uint32_t part);
  Found found(const Value& value, const Line& line);
  Found role(const Value& value);
  Found image(Found texture, const gltf::TextureInfo& info);
  Found number(const Role& role, const Value& value);
  Found given(const Value& value);
  bool hasDefault(const lang::Param& param) const;
  /// With `from`, the line that gives it.
  Found below(const Value& value, uint32_t part, uint32_t* from = nullptr);
  Found call(const Value& value, const Line& line);
  Found behind(Found value, std::string_view path) const;
  Found replacement(const Value& value, uint32_t part);
  Found replaced(const Value& value, uint32_t part, Found original);
  bool holds(const Condition& condition, const Line& line);
  bool equal(const Condition& condition, const Line& line);
  bool flag(uint32_t id);
  bool live(const std::vector<std::string_view>& terms) const;
  bool uniform(const Found& value);
  const Line* undimmed(uint32_t out, uint32_t part);
  void checkDimmed(const Line& line);
  bool required(const Term& term);
  std::string missing(const Value& value, const Line& line, int depth);
  std::string because(const Condition& condition, const Line& line, bool holds);
  std::string shown(const Condition& equal) const;
  void circle(uint32_t id);
  void wrong(uint32_t part, std::string code, std::string message, std::string help);

  const Model& model_;
  const lang::TemplateDecl& template_;
  const material::Material& material_;
  const gltf::VertexAttributes& attributes_;
  const BuildOptions& options_;
  Diagnostics& warnings_;
  Diagnostics wrong_;
  std::vector<State> states_;
  std::vector<Found> values_;
  std::vector<Node> nodes_;
  std::vector<bool> taken_;  ///< of the lines
  std::vector<signed char>
      absent_;  ///< of what the template gives: -1 unknown, else whether it cannot be had
  enum class Life : uint8_t { Unknown, Asked, Dead, Alive };
  std::vector<Life> terms_;
  std::vector<signed char> uniform_;  ///< of the ids' nodes: -1 unknown, else whether it is
  std::vector<State> line_states_;    ///< of what stands behind `out` and `replace`
  std::vector<Found> line_values_;
  int depth_ = 0;
  std::optional<Dimming> dimming_;       ///< of this material, where it is asked
  std::vector<std::string_view> unmet_;  ///< of a term: why a requirement is not met
  std::set<uint16_t> told_;              ///< textures without an image that were reported
  std::vector<uint32_t> open_;
};

}  // namespace lacquer::model
