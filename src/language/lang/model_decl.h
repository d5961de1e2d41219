// What the node language says of materials: extensions with their properties, parts with their lines, the
// order of the layers, profiles. A line's values and conditions stay expressions over names; model/compile.h
// resolves them.
#pragma once

#include "lang/ast.h"

namespace lacquer::lang {

/// A property of a glTF object. `type` is Texture2D for a textureInfo and Int for a choice. A number without
/// a default is there only where a file says it.
struct PropertyDecl : Param {
  enum class Kind : uint8_t { Number, Bool, Choice, Texture, Object };
  Kind kind = Kind::Number;
  std::string_view role;         ///< what parts call it: `name`, or another property's after `as`
  bool folded = false;           ///< at its default it is a number in the shader, unless its term is live
  std::optional<double> tested;  ///< larger values are valid, but no contract speaks of them
  /// What it is for a material without the extension; the default where nothing is said.
  std::optional<ir::Components> neutral;
  bool srgb = false;          ///< Texture
  std::string_view channels;  ///< Texture: the swizzle that its texel is read with; empty for all four
  std::vector<std::string_view> choices;  ///< Choice: the values; `default_value` is a place in this list
  std::vector<PropertyDecl> members;      ///< Object: its properties; Texture: those of its textureInfo
  ExprPtr tested_syntax, neutral_syntax;
};

/// A material extension, or (`core`) what glTF itself says of materials.
struct ExtensionDecl {
  std::string_view name;
  bool core = false;
  std::string doc, source;
  std::vector<std::string_view> drafts;     ///< earlier names, read as if they were `name`
  std::vector<std::string_view> needs;      ///< must stand beside it
  std::vector<std::string_view> excludes;   ///< must not stand beside it
  std::vector<std::string_view> yields_to;  ///< where one of them stands beside it, it has no effect: a note
  std::vector<std::string_view> loses_to;   ///< the same where that contradicts it: a warning
  std::string_view inside;  ///< the extension whose `extensions` it stands in; empty: the material's
  std::string_view status;  ///< "ratified", "draft", …; empty where nothing is said
  std::vector<PropertyDecl> properties;
  Origin origin;
  Span span;
  std::string_view text;  ///< of the file
};

/// One of the values that a line can have: the first whose condition holds and which is there is the line's.
struct Alternative {
  ExprPtr value;
  ExprPtr condition;    ///< null: always
  bool unless = false;  ///< the condition is to be false; a live term does not ask
};

struct LineDecl {
  enum class Kind : uint8_t {
    Value,    ///< `id = ...`: a node of that id where the value is a call, else another name for the value
    Flag,     ///< `bool id = condition`
    Out,      ///< `out id = ...`: what the material is for a port of that name, from this part on outwards
    Replace,  ///< `replace target with ...`
    Require,  ///< `require value else ...`: without it the term is absent
  };
  Kind kind = Kind::Value;
  bool shared = false;  ///< one node for all shared lines with the same call, put out where it is first used
  bool light = false;  ///< of a lamp's light: a layer may put a dimmed value in its place for the parts below
  std::string_view id;
  std::string_view section;
  uint32_t term = 0;  ///< in the part's list
  std::vector<Alternative> alternatives;
  ExprPtr target;                                ///< Replace
  std::string_view code, message, help, reason;  ///< Require
  ExprPtr place;  ///< Require: the property that the warning points at; may be null
  Span span;
};

/// Lines that are there together. The first of a part's terms is the part itself.
struct TermDecl {
  std::string_view name;
  uint32_t parent = 0;
  ExprPtr when, unless;  ///< null: always
  std::string_view when_reason, unless_reason;
  Span span;
};

/// What an extension (or glTF) adds to a material.
struct PartDecl {
  std::string_view name;
  std::string doc, source;
  std::vector<std::string_view> of;    ///< one of these extensions must be there; empty for any material
  std::vector<std::string_view> over;  ///< the parts above which it lies, where the layers do not list it
  std::vector<TermDecl> terms;
  std::vector<LineDecl> lines;
  Origin origin;
  Span span;
  std::string_view text;  ///< of the file
};

/// Lines in place of the parts' lines of the same ids, and others that they need: another reading (a
/// profile), or a simpler material (a lod).
struct ProfileDecl {
  std::string_view name;
  std::string doc, source;
  bool by_default = false;
  std::vector<LineDecl> lines;
  Origin origin;
  Span span;
  std::string_view text;  ///< of the file
};

/// The order of the layers, from the inside outwards, and of the sections that their lines are put out in.
struct LayersDecl {
  std::string_view name;
  std::string doc;
  std::vector<std::string_view> sections, parts;
  std::vector<Span> spans;  ///< of the parts
  Origin origin;
  Span span;
  std::string_view text;  ///< of the file
};

/// A switch that conditions may ask, set by an option of the same name.
struct SwitchDecl {
  std::string_view name;
  std::string doc;
  bool value = true;
  Origin origin;
  Span span;
};

}  // namespace lacquer::lang
