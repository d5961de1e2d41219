// What the node language says, after checking: declarations, statements and expressions with their types
// resolved. Names and prose are views into the library's source text, which lives as long as the library.
//
// Every value that a body or a template can name has a slot, a small number: parameters first, then locals in
// the order of their declaration. A multi-output value takes one slot for each of its results. An evaluator
// therefore needs one vector of values and no names.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/module.h"
#include "lang/ties.h"

namespace lacquer::lang {

struct Builtin;
struct NodeDecl;
struct ConstDecl;
struct Expr;
using ExprPtr = std::unique_ptr<Expr>;

/// Bytes of a source file.
struct Span {
  uint32_t offset = 0;
  uint32_t length = 0;
};

/// Where a declaration stands.
struct Origin {
  std::string_view file;
  uint32_t line = 0;
  /// The first extension that the file declares, within which its names are; empty for a file that declares
  /// none and for the library's own.
  std::string_view vendor;
  bool built_in = false;
};

struct Expr {
  enum class Kind : uint8_t {
    Literal,    ///< `number`: a Float, an Int or a Bool
    Name,       ///< as parsed; the checker makes it a Slot or a Constant
    Slot,       ///< `slot`: a parameter, a local, or what a template declares
    Constant,   ///< `constant`
    Operation,  ///< `builtin` of args: an operator or a builtin function
    Construct,  ///< a value of `type` from args: vec3(a, b), float(i), mat3(x, y, z)
    Swizzle,    ///< components of args[0]
    Member,     ///< as parsed; the checker makes it a Slot, a Swizzle or a Field
    Index,      ///< args[0], a vector or a matrix, at args[1]; the checker makes a block's array a Slot
    Field,      ///< result `slot` of args[0], which is a Call
    Call,       ///< of `node`; args in the order of its parameters, null where the default is meant
    Select,     ///< args[0] ? args[1] : args[2]
  };

  Kind kind = Kind::Literal;
  ir::Type type = ir::Type::Float;  ///< of a Call with several results: of the first
  bool untyped =
      false;           ///< an Int made of literals alone, which becomes a Float or a UInt where one is needed
  uint16_t depth = 1;  ///< of the tree
  uint32_t slot = 0;
  Span span;
  double number = 0;
  std::string_view name;         ///< Name, Member, Call, Operation and Construct: as written
  std::string_view variant;      ///< Call: empty for the reference body
  std::vector<ir::Type> form{};  ///< Call: the types behind the name, which tell a form from others
  const Builtin* builtin = nullptr;
  const NodeDecl* node = nullptr;
  const ConstDecl* constant = nullptr;
  std::vector<ExprPtr> args;
  std::vector<std::string_view> labels;  ///< Call, as parsed: `name =` of each argument, or empty
  std::vector<int> components;           ///< Swizzle
};

/// `in [lo, hi]` or `in [lo, hi] or 0`, as written.
struct RangeSyntax {
  ExprPtr lo, hi;
  Span span;
  bool or_zero = false;
  explicit operator bool() const { return lo != nullptr; }
};

struct Statement {
  enum class Kind : uint8_t {
    Let,     ///< a new local `slot` (or several, `results` of them) = values[0]
    Assign,  ///< the local `slot` = values[0]; compound assignments are parsed into plain ones
    If,      ///< values[0] ? body : otherwise; locals from `slot` on are of one arm alone
    For,     ///< `slot` counts from `first` up to, not including, `last`; where it is `open`, to where
             ///< values[1] says, but no further
    Return,  ///< values, one for each result, or one Call with all of them
    Assume,  ///< values[0] lies in `range`
  };

  Kind kind = Kind::Let;
  bool inferred = false;  ///< `let`
  ir::Type type = ir::Type::Float;
  uint32_t slot = 0;
  uint32_t results = 1;
  int first = 0, last = 0;
  bool open = false;       ///< For: the bound is no constant
  bool inclusive = false;  ///< For: `<=`
  bool surely = false;     ///< For: there is a round in any case
  bool direct = false;  ///< For: it returns, sums over lights or interpolates, which no loop that stays does
  uint32_t weight = 0;  ///< For: expressions to evaluate for a round
  std::vector<uint32_t> assigned{};  ///< For: locals from before it that its body assigns, ascending
  std::string_view name;
  Span span, name_span;
  std::vector<ExprPtr> values;
  std::vector<Statement> body, otherwise;
  RangeSyntax range_syntax;
  ir::Interval range;
  std::string_view reason;
};

/// The components of a matrix, column by column.
using Matrix = std::array<double, 16>;

/// What a tool shows of a parameter; nothing else follows from it.
struct Hints {
  std::string_view label;  ///< what it is called for people
  std::string_view unit;   ///< "degree", "meter"
  bool has_soft = false;   ///< most values lie in `soft`, which lies in the range
  ir::Interval soft;
  bool color = false;     ///< the vector is a colour
  bool advanced = false;  ///< few need it
  RangeSyntax soft_syntax;
};

/// A parameter, a result, or another typed name with a range.
struct Param {
  ir::Type type = ir::Type::Float;
  std::string_view name;  ///< empty for the result of a node that has one
  bool has_range = false;
  ir::Range range;
  std::optional<ir::Components> default_value;
  std::optional<Matrix> matrix_default;  ///< of a matrix, which has too many components for default_value
  /// Of a node: what of the template's givens stands for it where a graph connects nothing, "uv0"; empty for
  /// none.
  std::string_view given;
  std::vector<std::string_view> choices;  ///< of an Int: what its values 0, 1, … are called
  Hints hints;
  std::string_view prose;
  Span span;
  RangeSyntax range_syntax;
  ExprPtr default_syntax;

  /// Whether something stands for it in a graph, and in a call.
  bool hasDefault() const { return hasConstantDefault() || !given.empty(); }
  bool hasConstantDefault() const { return default_value || matrix_default; }
};

struct Body {
  std::vector<Statement> statements;
  std::vector<std::string_view> slots;  ///< what they are called, parameters first
};

struct Variant {
  std::string_view name;
  std::string doc;
  Span span;
  Body body;
};

/// A stated fact, for the listing of what the numbers rest on.
struct Assumption {
  std::string_view variant;  ///< empty: in the reference body
  std::string_view value;    ///< the expression, as written
  ir::Interval range;
  std::string_view reason;
  uint32_t line = 0;
};

struct ConstDecl {
  std::string_view name;
  std::string doc;  ///< the doc lines, or the comment behind it
  ir::Type type = ir::Type::Float;
  ir::Components value{};
  Origin origin;
  Span span;
  ExprPtr syntax;
};

struct NodeDecl {
  std::string_view name;    ///< of a form with its types: "add<vec3>"
  std::string_view family;  ///< "add"
  std::string doc;          ///< its lines joined by newlines, without the source
  std::string source;       ///< `KHR_materials_coat, "Colored Absorption"`
  std::string category;     ///< where a tool's palette has it: "noise"; empty for none
  std::vector<Param> params;
  std::vector<Param> results;  ///< at least one
  Body body;                   ///< the reference
  std::vector<Variant> variants;
  std::vector<Assumption> assumptions;
  Origin origin;
  Span span;
  uint32_t weight = 0;  ///< expressions to evaluate for the heaviest body, calls included
  uint32_t height = 0;  ///< how deep an evaluator nests
  Ties unties = 0;      ///< what some operation in the bodies, or in what they call, unties

  /// The body of that variant, the reference for an empty name, null when there is none.
  const Body* find(std::string_view variant) const {
    if (variant.empty()) return &body;
    for (const Variant& v : variants) {
      if (v.name == variant) return &v.body;
    }
    return nullptr;
  }
};

enum class BlockRole : uint8_t { Frame, Lights, Object, List };

struct BlockFieldDecl : Param {
  uint32_t slot = 0;        ///< of an array, the first element's; the others follow
  uint32_t array = 0;       ///< 0: not an array
  bool miscounted = false;  ///< the number of elements was wrong, and that was said
  ExprPtr array_syntax;

  uint32_t elements() const { return array == 0 ? 1 : array; }
};

struct BlockDecl {
  BlockRole role = BlockRole::Frame;
  bool extension = false;      ///< `extend block`: fields of a block of the base; gone after checking
  bool optional = false;       ///< its place lies behind all others'
  bool late = false;           ///< optional, and its place lies behind those of all other optional ones
  std::string_view type_name;  ///< "Light"
  std::string_view instance;   ///< "light"
  uint32_t array = 0;          ///< 0: not an array
  bool endless = false;        ///< `[]`, as it is written
  bool list = false;           ///< of any length: a block of that role, and lights that come in lists
  std::vector<BlockFieldDecl> fields;
  std::string_view prose;
  Span span;       ///< of the instance
  Span type_span;  ///< of the type's name
  ExprPtr array_syntax;
  ExprPtr count_syntax;     ///< of the lights: how many are in use
  uint32_t count_slot = 0;  ///< the field that `count_syntax` names
  ir::Binding binding;
};

/// An attribute's name without the underscore that glTF's application-specific ones begin with.
inline std::string_view withoutUnderscore(std::string_view name) {
  return name.substr(name.starts_with('_') ? 1 : 0);
}

struct AttributeDecl {
  ir::Type type = ir::Type::Float;
  std::string_view name;
  uint32_t location = 0;
  uint32_t slot = 0;
  /// A primitive may lack it: its location lies behind all others, and the Bool `has_NAME` says whether it is
  /// there.
  bool optional = false;
  bool fact = false;  ///< optional, and nothing but `has_NAME`: it has no location, no type and no slot
  /// Switches that say so in place of the file where they are set: it is there only if none of them is off,
  /// and in any case if the last one is on.
  std::vector<std::string_view> by;
  uint32_t has_slot = 0;  ///< of `has_NAME`
  std::string_view prose;
  Span span;
};

/// `FIELD = value;` of a kind of light.
struct LightFieldDecl {
  std::string_view name;
  Span span;
  ExprPtr value;  ///< over the properties of KHR_lights_punctual, whose slots are those of lightProperties()
  std::optional<ir::Components> constant;  ///< the value where it is the same for all lights of the kind
};

/// How a light of a type of KHR_lights_punctual fills its element of the light array.
struct LightKindDecl {
  std::string_view name;  ///< as in glTF: "spot"
  std::vector<LightFieldDecl> fields;
  std::string_view prose;
  Span span;
  bool extends =
      false;  ///< `extend light kind`: more fields of one that a template has which this one extends
};

/// `lights from RANGES[EXPR] through NUMBERS;`: the lights that count are those whose numbers stand in a
/// range of one list, and which range that is, an element of another says.
struct LightListsDecl {
  std::string_view ranges, numbers;  ///< the lists' own names
  ExprPtr index;                     ///< the number of the range, a Float
  Span span, ranges_span, numbers_span;
  bool inherited = false;  ///< from a template that this one extends
};

/// What a light kind's values are made of, in the order of their slots: the properties of
/// KHR_lights_punctual, and where the light's node is.
struct LightProperty {
  std::string_view name;
  ir::Type type;
  std::string_view prose;
};
std::span<const LightProperty> lightProperties();

/// A texture that the application gives once per frame, or for each object.
struct EnvironmentDecl {
  ir::Type type = ir::Type::TextureCube;
  bool object = false;    ///< for each object: in its set
  bool optional = false;  ///< it takes a unit only where it is used, behind the material's
  std::string_view name;
  uint32_t slot = 0;
  std::string_view prose;
  Span span;
  ir::Binding binding;
  ExprPtr texel_syntax;
  std::optional<ir::Components> texel;  ///< what evaluations on the CPU take where nothing else is said
};

/// What a graph may refer to.
struct GivenDecl {
  std::string_view name;
  std::vector<Param> results;  ///< one without a name, or those of the node whose call `value` is
  bool multiple = false;       ///< a graph writes `name.result`
  bool has_type = false;
  bool inherited = false;  ///< from a template that this one extends
  uint32_t slot = 0;       ///< of the first result; the others follow
  std::string_view prose;
  Span span;
  ExprPtr value;
  Ties ties = 0;  ///< whether its values differ for each light or each vertex: tie()
  /// The attributes that it cannot do without, by their places, in ascending order: tie()
  std::vector<uint16_t> attributes;
};

/// One of a given's results.
struct GivenResult {
  const GivenDecl* given;
  size_t index;
};

/// What a graph must deliver, or may where there is a default.
struct PortDecl {
  Param param;
  bool inherited = false;  ///< from a template that this one extends
  uint32_t slot = 0;
  ExprPtr default_value;  ///< any expression over what the template declares before it; null: must deliver
  Ties refused = 0;       ///< what its value may not be tied to: tie()
};

enum class OutputRole : uint8_t {
  Position,
  Color,
  Discard,
  Depth,
  Displacement,  ///< what the given of its name is for all that is put out
};

struct OutputDecl {
  OutputRole role = OutputRole::Color;
  bool replaces = false;   ///< `replace output`: it takes the place of the base's of that name
  bool optional = false;   ///< it is not there where the graph delivers none of the ports that it reads
  bool inherited = false;  ///< from a template that this one extends
  ir::Type type = ir::Type::Vec4;
  std::string_view name;
  std::string_view prose;
  Span span;
  ExprPtr value;
};

/// `without output`: an output of the base that is not there.
struct WithoutDecl {
  std::string_view name;
  Span span;
};

struct TemplateDecl {
  std::string_view name;
  bool is_default = false;  ///< `default;`: it is meant where no template is named
  std::string_view base;    ///< `extends`: its parts come first in the lists below; empty for none
  std::string doc;
  std::vector<BlockDecl> blocks;
  std::vector<AttributeDecl> attributes;
  std::vector<EnvironmentDecl> environments;
  std::vector<GivenDecl> givens;
  std::vector<PortDecl> ports;
  std::vector<OutputDecl> outputs;
  std::vector<WithoutDecl> without;        ///< taken from `outputs` when checked
  std::vector<LightKindDecl> light_kinds;  ///< in the order in which lights lie in the array
  std::optional<LightListsDecl> light_lists;
  uint32_t material_textures = 0;  ///< the flat number of the material's first texture
  bool sums_lights = false;        ///< an output is a sum over the lights
  uint32_t slots = 0;
  std::optional<uint32_t> front_facing;  ///< the slot of gl_FrontFacing, where an expression uses it
  Origin origin;
  Span span;

  /// The given of that name as a graph writes it: "uv0", "light_sample.L".
  std::optional<GivenResult> find(std::string_view given) const;
};

}  // namespace lacquer::lang
