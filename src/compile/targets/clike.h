// The one printer of GLSL, HLSL and WGSL. It walks a schedule::Program from front to back and asks a Dialect,
// the few hooks in which the languages differ, for every spelling. It decides nothing, never looks back and
// never edits what it wrote.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/module.h"
#include "ir/names.h"
#include "schedule/schedule.h"

namespace lacquer::targets {

/// How tightly an expression's outermost operator binds, loosest first; one order for GLSL, HLSL and WGSL.
enum class Precedence : uint8_t {
  Ternary,
  Or,
  And,
  Bitwise,  ///< of integers' bits and shifts, which languages rank differently: their operands are Unary at
            ///< least
  Equality,
  Relational,
  Additive,
  Multiplicative,
  Unary,
  Postfix,  ///< names, literals, calls, swizzles: never in need of parentheses
};

/// The text of an expression, and what decides whether it needs parentheses where it is put.
struct Expression {
  std::string text;
  Precedence precedence = Precedence::Postfix;
};

/// The expression's text for a place that takes anything which binds at least as tightly as `least`.
std::string parenthesized(const Expression& expression, Precedence least);

/// An operator before its operand or between its two.
Expression operatorText(std::string_view spelling, std::span<const Expression> operands);

/// The shortest literal that reads back as the float nearest to x: `0.04`, `1.0`, `1e-7`. Beyond the range of
/// float it is the largest float. A negative one binds like a unary minus.
Expression floatLiteral(double x);

/// Lines of text at a depth of indentation.
class Text {
public:
  void line(std::string_view text);
  void blank() { text_ += '\n'; }
  /// A comment of one line. What would end it early or continue it (control characters, a backslash) is
  /// replaced.
  void comment(std::string_view text);
  /// One comment for each line of `text`.
  void comments(std::string_view text);
  void indent() { ++depth_; }
  void outdent() { --depth_; }
  std::string take() { return std::move(text_); }

private:
  std::string text_;
  int depth_ = 0;
};

/// What differs between the C-like targets.
class Dialect {
public:
  virtual ~Dialect() = default;

  virtual std::string_view type(ir::Type type) const = 0;
  /// The operator or the function's name: a column of ops.def.
  virtual std::string_view spelling(ir::Op op) const = 0;
  virtual std::string_view position() const = 0;
  virtual std::string_view frontFacing() const = 0;
  /// What stands for a name that a template or the schedule gave: another one where the language keeps it for
  /// itself. The printers' own prefixes are never kept.
  virtual std::string name(std::string_view wanted) const { return std::string(wanted); }
  /// True when the function has an overload that takes a Float at `index` beside the vectors among
  /// `operands`. Elsewhere it is printed as a splat. As it is here: what GLSL has, and HLSL promotes any.
  virtual bool takesFloat(ir::Op op, std::span<const ir::Type> operands, size_t index) const;
  /// A number: floatLiteral's.
  virtual Expression literal(double x) const;
  /// A parameter where no place pass has been: its name.
  virtual std::string parameter(const ir::Input& input) const;
  /// Components of a vector, `picks` out of "xyzw". `vector` is text that a '.' may follow.
  virtual std::string swizzle(ir::Type result, std::string_view vector, std::string_view picks) const;
  /// A vector with one number in all components. `literal`: `x` is a literal.
  virtual Expression splat(ir::Type type, const Expression& x, bool literal) const = 0;
  /// A texel of a texture of a type; `lod` is empty for implicit derivatives.
  virtual std::string texture(ir::Type type, std::string_view name, const Expression& at,
                              std::string_view lod) const = 0;
  /// The same over the footprint of two derivatives.
  virtual std::string textureGrad(ir::Type type, std::string_view name, const Expression& at,
                                  std::string_view along_x, std::string_view along_y) const;
  /// How many texels, or layers, a level has along an axis, as an Int; `level` is one.
  virtual std::string textureSize(ir::Type type, std::string_view name, std::string_view level,
                                  uint32_t axis) const;
  /// What a depth map gives for the place `at`, whose third component is compared; `top`: at level 0.
  virtual std::string comparison(std::string_view name, const Expression& at, bool top) const = 0;
  /// A column of a Mat4.
  virtual std::string column(std::string_view matrix, uint32_t index) const;
  /// An integer of a type that is in the DAG.
  virtual Expression integer(ir::Type type, int32_t value) const;
  /// A call of a function of ops.def.
  virtual std::string call(ir::Op op, ir::Type result, std::string_view arguments) const;
  /// An operator of ops.def before its operand or between its two: operatorText's.
  virtual Expression operation(std::string_view spelling, std::span<const Expression> operands) const;
  /// The choice of `yes` where the condition holds: `?:`.
  virtual Expression select(const Expression& condition, const Expression& yes, const Expression& no) const;
  /// A number that no compiler may fold: lateOperand()'s. Where folding what is not finite is no error, the
  /// number itself.
  virtual Expression late(ir::Type type, const Expression& number) const;

  /// True where precisions are part of the language: what the Dag says is relaxed is `mediump`.
  virtual bool precisions() const { return false; }
  /// The type of 16 bits beside one of 32 (ir::Half); empty where the language has none.
  virtual std::string_view halfType(ir::Type) const { return {}; }
  /// A vector of 16 bits with one number in all components.
  virtual Expression halfSplat(ir::Type type, const Expression& x) const {
    return {std::string(halfType(type)) + '(' + x.text + ')'};
  }
  /// A variable of 16 bits with its value.
  virtual std::string halfVariable(ir::Type type, std::string_view name, std::string_view value) const;
  /// A variable with its value; `changes`: what a loop sums or carries.
  virtual std::string variable(ir::Type type, std::string_view name, std::string_view value,
                               bool changes) const;
  /// A field of the element of that number of a list.
  virtual Expression element(const ir::Block& list, const ir::BlockField& field,
                             const Expression& number) const;
  /// A texture of an array, by its number.
  virtual std::string textureAt(const ir::TextureSlot& slot, std::string_view number) const;
  /// The opening line of a loop from `first` to before `end`.
  virtual std::string loop(std::string_view counter, std::string_view first, std::string_view end) const;
  /// True for a target whose contract with the application may be broken by a page that anyone wrote: loops
  /// run no further than arrays and lists reach, whatever counts the application gives.
  virtual bool clampsLoops() const { return false; }
  /// With clampsLoops(): the number of elements of a list.
  virtual std::string listLength(const ir::Block&) const { return {}; }
  /// A member of a block; `array`: 0 or the number of elements.
  virtual std::string member(ir::Type type, std::string_view name, uint32_t array) const;
  /// The fragment's depth, of an output of that name, where it is assigned.
  virtual std::string depth(std::string_view name) const { return assigned(name); }
  /// A fragment output or an interpolant where it is assigned.
  virtual std::string assigned(std::string_view name) const { return std::string(name); }

  /// All that stands before the statements of main: the head as comments, the interface, and main's opening
  /// line.
  virtual void open(Text& text, const ir::Module& module, const schedule::Program& program,
                    std::string_view head) const = 0;
  /// What stands behind the last statement of main.
  virtual void close(Text&, const schedule::Program&) const {}
};

/// An operation on nothing but numbers is there only because it is not finite, and a clamp may have a number
/// for its lower end above that for its upper one. The operand that a language must not see as a number then,
/// where it refuses what it can tell of such operations; -1 elsewhere.
int lateOperand(const ir::Dag& dag, const ir::Value& value);

/// What an operand goes through, so that its operation gets the precision that it is to have: an operation's
/// is the highest of its operands', and literals have none (GLSL ES 3.00, 4.5.2).
enum class Passing : uint8_t { AsItIs, Lowered, Raised };
Passing passingOf(const ir::Dag& dag, ir::ValueId user, size_t index);
/// The functions for that; a parameter's precision is its own.
inline constexpr std::string_view kLower = "lacquer_mediump";
inline constexpr std::string_view kRaise = "lacquer_highp";

/// The dialects' interface names, the same in all of them. Variables of a Program never begin with these
/// prefixes.
std::string attributeName(const ir::Attribute& attribute);  ///< "TEXCOORD_0": in_texcoord_0
std::string varyingName(const ir::Varying& varying);        ///< v_…
std::string outputName(const ir::Output& output);           ///< out_…

/// The textures of a stage, of each array the first one alone, which stands for it.
std::vector<uint32_t> declaredTextures(const ir::Module& module, const schedule::Program& program);
/// What the sampler of a texture is called, `texture` being an expression: it has the same place in an array.
std::string samplerOf(std::string_view texture);

/// The members of a block, one a line. Where std140 or HLSL's packing would place a member elsewhere than the
/// block says, padding stands before it, so that one declaration means the same bytes in every dialect.
/// `whole`: and behind the last one, up to the block's size; elsewhere the language fills the last 16 bytes.
void printMembers(Text& text, const Dialect& dialect, const ir::Block& block, bool whole = false);

/// The whole text of a stage.
std::string printProgram(const Dialect& dialect, const ir::Module& module, const schedule::Program& program,
                         std::string_view head);

/// The Section, Let and Output statements, and what is between them.
void printStatements(Text& text, const Dialect& dialect, const ir::Module& module,
                     const schedule::Program& program);

/// A value where it is used: its variable if it has one.
std::string printValue(const Dialect& dialect, const ir::Module& module, const schedule::Program& program,
                       ir::ValueId value);

/// What a Let computes into the value's variable.
std::string printDefinition(const Dialect& dialect, const ir::Module& module,
                            const schedule::Program& program, ir::ValueId value);

/// Each value as one expression, everything written where it is used; parameters of the material by their
/// names. Of each, at most `longest` bytes and '…' for what is left: written out, what is used twice doubles.
std::vector<std::string> printExpressions(const Dialect& dialect, const ir::Module& module,
                                          std::span<const ir::ValueId> values, size_t longest);

/// The C++ header that packs the material's block (cpp.cpp).
std::string printHeader(const ir::Module& module, std::string_view name, std::string_view head);

const Dialect& glslVulkan();
const Dialect& glslOpenGl();
const Dialect& essl300();
const Dialect& hlsl();
const Dialect& wgsl();

}  // namespace lacquer::targets
