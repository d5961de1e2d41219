// The parts of the library under one profile, with every name resolved: what build() follows for each
// material.
//
// An id ("coat.fresnel") may be said by several lines; the first that holds counts. A reference is to an id,
// to a property, to what a template gives, or to what lies below; each may come to nothing, and then the line
// that needs it comes to nothing as well, unless the node's parameter has a default.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lang/library.h"
#include "material/schema.h"

namespace lacquer::model {

/// What a line may be made of.
struct Value {
  enum class Kind : uint8_t {
    None,      ///< `none`: nothing, and what lies below does not count either
    Constant,  ///< `constant` of `type`
    Id,        ///< `index` in Model::ids
    Below,     ///< `index` in Model::outs: the value that the parts below put out
    Role,      ///< `index` in Model::roles
    Given,     ///< `index` in Model::givens: of the template
    Call,      ///< of `index` in Model::nodes, `args` by its parameters
  };
  Kind kind = Kind::None;
  ir::Type type = ir::Type::Float;
  uint32_t index = 0;
  int member = -1;          ///< Role: of the textureInfo
  bool coordinate = false;  ///< Role: the texture's coordinate
  bool image = false;       ///< Role: the texture itself, for a node that samples it
  bool absent = false;      ///< of a Call's argument: not given
  ir::Components constant{};
  std::string_view
      path;  ///< Id, Below: an output, a swizzle, or both, from a point on; Role, Given: a swizzle
  std::string_view variant;
  std::vector<Value> args;
};

struct Condition {
  enum class Kind : uint8_t {
    Always,
    And,
    Or,
    Not,
    Present,    ///< values[0] comes to something
    Same,       ///< both values come to the same
    Equal,      ///< the number values[0] is `constant`
    Flag,       ///< `index` in Model::ids
    Switch,     ///< `index` in Model::switches
    Extension,  ///< `index` in the schema
    Term,       ///< `index` in Model::terms
    Uniform,    ///< values[0] does not change from pixel to pixel
    Takes,      ///< the template has a port `name`
    Replaced,   ///< another part, or the profile, has put something in place of values[0], a line's value
    Dimmable,   ///< `index` in Model::outs: what the parts below put out scales with the light lines
  };
  Kind kind = Kind::Always;
  uint32_t index = 0;
  ir::Type type = ir::Type::Float;
  ir::Components constant{};
  std::string_view name;  ///< Takes; Equal with a choice: the value
  std::vector<Value> values;
  std::vector<Condition> conditions;
};

struct Alternative {
  Value value;
  Condition condition;
  bool unless = false;
};

/// A line, where its part's term is alive.
struct Line {
  lang::LineDecl::Kind kind = lang::LineDecl::Kind::Value;
  bool carried = false;  ///< Out, Replace: the values are those of a line of its own, the one before it
  bool shared = false;
  uint32_t id = 0;        ///< in Model::ids; of an Out: in Model::outs
  uint32_t part = 0;      ///< in Model::parts; for a line that a profile adds: their number
  uint32_t term = kNone;  ///< in Model::terms
  uint32_t order = 0;     ///< lines are put out in this order; kNone: where they are first used
  std::vector<Alternative> alternatives;
  Value target;  ///< Replace: an Id
  std::string_view code, message, help, reason;
  Value place;

  static constexpr uint32_t kNone = ~uint32_t{0};
};

struct Id {
  std::string_view name;
  std::vector<uint32_t> lines;     ///< that say it
  std::vector<uint32_t> replaced;  ///< lines that replace it, or one of its outputs, by part
  bool overridden = false;         ///< the profile has another line in its place
  /// Light of a lamp. What replaces it acts on the parts below alone, and all that they make of it must scale
  /// with it.
  bool light = false;
};

struct Term {
  std::string_view name;
  uint32_t part = 0;
  uint32_t parent = Line::kNone;
  Condition when, unless;
  bool has_unless = false;
  std::string_view when_reason, unless_reason;
  std::vector<uint32_t> requirements;  ///< lines
  bool valued = false;                 ///< it, or a term within it, has a line that makes a value
};

struct Part {
  std::string_view name;
  lang::Origin origin;
  std::vector<uint16_t> of;  ///< extensions; empty for any material
  uint32_t term = 0;
};

/// A node that lines call. Its declaration is looked for when it is first asked for: a material needs few of
/// them.
class Node {
public:
  explicit Node(std::string_view name, const lang::NodeDecl* decl = nullptr) : name_(name), decl_(decl) {}
  Node(Node&& other) noexcept : name_(other.name_), decl_(other.decl_.load()) {}
  Node& operator=(Node&&) = delete;
  std::string_view name() const { return name_; }
  const lang::NodeDecl& of(const lang::Library& library) const;

private:
  std::string_view name_;
  mutable std::atomic<const lang::NodeDecl*> decl_;
};

/// What parts call a property.
struct Role {
  std::string_view name;
  std::vector<uint16_t> providers;                         ///< properties
  std::vector<std::string_view> live;                      ///< terms that keep its number editable
  std::vector<std::vector<std::string_view>> member_live;  ///< the same for members of a textureInfo
};

struct Out {
  std::string_view name;
  std::vector<uint32_t> lines;  ///< from the inside outwards
  bool dimmed = false;          ///< some condition asks whether it is dimmable
};

struct Model {
  const lang::Library* library = nullptr;  ///< whose nodes the lines call
  const material::Schema* schema = nullptr;
  std::string_view profile;
  lang::Origin profile_origin;
  std::vector<Part> parts;  ///< from the inside outwards
  std::vector<Node> nodes;
  /// Pairs of them, the lower one first, that nothing but their names puts in this order (model/order.h).
  std::vector<std::pair<uint32_t, uint32_t>> unordered;
  std::vector<Term> terms;
  std::vector<Line> lines;
  std::vector<Id> ids;
  std::vector<Out> outs;
  std::vector<Role> roles;
  std::vector<std::string>
      givens;  ///< what a template may give, or have as a texture: "view", "light_sample.L"
  std::vector<std::string_view> switches;
  std::vector<bool> switch_defaults;
  std::vector<uint32_t> ordered;  ///< lines of Kind::Value with an order, sorted by it
  /// Of each line: an Out that scales with the light lines in every material, whatever else is there. Found
  /// when a material first asks: few do.
  struct Scales {
    std::once_flag asked;
    std::vector<bool> of_line;
  };
  std::shared_ptr<Scales> found_scales = std::make_shared<Scales>();
  bool scales(uint32_t line) const;
  /// Of a Call. Its bodies are there once the library was asked for the node itself.
  const lang::NodeDecl& nodeOf(const Value& call) const { return nodes[call.index].of(*library); }
  /// A part as the library has it.
  const lang::PartDecl& declOf(uint32_t part) const { return **library->part(parts[part].name); }
  /// Names of lines that the text gives none; Id::name views them.
  std::vector<std::shared_ptr<const std::string>> made_names;

  /// The terms that stay though their value would remove them, when they are asked to: sorted.
  std::vector<std::string_view> liveTerms() const;
  /// The parameters that are not there because of terms that are not, by name, each with the terms that bring
  /// it back when all of them are kept. `skipped`: the terms that a material could have and has not.
  std::vector<std::pair<std::string, std::vector<std::string>>> absent(
      const std::set<std::string, std::less<>>& skipped) const;
  /// The terms that keep the number at a path from the material on ("emissiveFactor", or a textureInfo's
  /// member: "normalTexture/scale") editable when they are kept, none where it always is or never; nothing
  /// where there is no such property.
  std::optional<std::vector<std::string>> keeping(std::string_view path) const;
  /// The parameters by which the extensions' parts vanish, with the numbers at which they do: "coat_factor",
  /// {0}.
  std::vector<std::pair<std::string, std::vector<double>>> layers() const;
};

/// Resolves the library's parts under a profile, with the lines of these lods in place of both's. Errors have
/// the place in the text.
Result<Model> compile(const lang::Library& library, const material::Schema& schema, std::string_view profile,
                      const std::set<std::string, std::less<>>& lods = {});

/// The profiles' names, the default one first, then by name. Errors: a wrong profile, or not just one
/// default.
Result<std::vector<const lang::ProfileDecl*>> profiles(const lang::Library& library);

/// The model of a profile of the library's own texts, in bytes, and what reads them: fromBytes() of
/// model/bytes.h.
struct Prepared {
  std::string_view profile;
  std::string_view bytes;
  Model (*read)(std::string_view bytes, const lang::Library& library,
                const material::Schema& schema) = nullptr;
};

/// What a library makes of materials, resolved once and kept. Lookups may run on several threads at once.
class Models {
public:
  /// Where the library has its own texts alone, its models are read from those that were prepared.
  explicit Models(const lang::Library& library, materialx::Definitions definitions = {},
                  std::span<const Prepared> prepared = {});
  ~Models();
  Result<const material::Schema*> schema() const;
  Result<const Model*> of(std::string_view profile,
                          const std::set<std::string, std::less<>>& lods = {}) const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacquer::model
