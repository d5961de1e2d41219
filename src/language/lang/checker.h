// Names, types and the other static rules; resolves what the parser left open.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lang/ast.h"
#include "lang/library.h"
#include "lang/reporter.h"

namespace lacquer::lang {

/// "a float", "an int".
std::string aType(ir::Type type);

/// What else the library declares, as the checker of one declaration sees it.
class Surroundings {
public:
  struct Found {
    DeclKind kind = DeclKind::Node;
    const ConstDecl* constant = nullptr;  ///< null as long as it is not checked, or is wrong
    const NodeDecl* node = nullptr;
    bool open = false;    ///< it is being checked: it uses itself
    bool family = false;  ///< a name of several nodes: forms()
  };
  /// A standard node is found only where one is `called`: names of values do not bring its text in.
  virtual std::optional<Found> find(std::string_view name, bool called = false) = 0;
  /// The heads of the nodes of that name that parse; each has its parameters and results, unchecked.
  virtual std::vector<const NodeDecl*> forms(std::string_view family) = 0;
  /// Checks the node of one of these heads.
  virtual Found form(std::string_view key) = 0;
  /// All names of that kind, for suggestions.
  virtual std::vector<std::string_view> names(DeclKind kind) = 0;
  /// How an open declaration came to use itself: "a -> b -> a".
  virtual std::string cycle(std::string_view name) const = 0;

protected:
  ~Surroundings() = default;
};

class Checker {
public:
  Checker(Reporter& reporter, Surroundings& surroundings) : reporter_(reporter), around_(surroundings) {}

  // Each is called once, for a declaration that parsed without an error. What is wrong goes to the reporter.
  void constant(ConstDecl& decl);
  void node(NodeDecl& decl);
  /// Of a node that is right, its parameters and results alone.
  void signature(NodeDecl& decl);
  /// `bases` are what it extends, freshly parsed, the farthest first; they checked without an error on their
  /// own.
  void templateDecl(TemplateDecl& decl, std::vector<TemplateDecl> bases);
  void extension(ExtensionDecl& decl);
  void part(PartDecl& decl);
  void profile(ProfileDecl& decl, std::string_view kind);

private:
  /// What an identifier in scope stands for.
  struct Member {
    std::string_view name;
    ir::Type type = ir::Type::Float;
    uint32_t slot = 0;
    uint32_t array = 0;                     ///< 0: not an array
    const BlockFieldDecl* field = nullptr;  ///< of a block's
  };
  struct Name {
    enum class Kind : uint8_t {
      Param,
      Local,
      Counter,
      Given,
      Port,
      Attribute,
      Environment,
      Instance,
      Builtin
    };
    std::string_view name;
    Kind kind = Kind::Local;
    ir::Type type = ir::Type::Float;
    uint32_t slot = 0;
    Span span;
    bool used = false;
    bool multiple = false;  ///< reached as `name.result`
    std::vector<Member> members;
    bool broken = false;     ///< its value was wrong: every use of it fails, without another report
    bool inherited = false;  ///< from a template that this one extends
  };
  enum class Flow : uint8_t { Falls, MayReturn, Returns };
  using Constant = std::optional<ir::Components>;

  // checker.cpp: declarations
  void docRules(const NodeDecl& decl);
  void nameRules(std::string_view name, Span span, std::string_view what);
  void rangeOf(Param& param);
  std::optional<ir::Interval> interval(RangeSyntax& syntax, ir::Type type);
  void defaultOf(Param& param);
  void matrixDefault(Param& param);
  void choicesOf(Param& param);
  void hintsOf(Param& param);
  /// Whether a value lies in the declared range; reports it when not. `what` begins the message.
  bool inRange(const Param& param, const ir::Components& value, Span span, std::string_view code,
               std::string_view what);
  Constant constantValue(ExprPtr& expr, ir::Type type, std::string_view what);
  std::optional<int> constantInt(ExprPtr& expr, std::string_view what);
  std::string_view written(Span span) const { return reporter_.text(span); }

  // check_model.cpp
  void modelDoc(const std::string& doc, const std::string* source, Span span, std::string_view what);
  void property(PropertyDecl& item, bool texture_member);
  void choices(const PropertyDecl& item);
  void numbers(const PropertyDecl& item, bool texture_member);

  // check_template.cpp
  void parts(TemplateDecl& decl, uint32_t& slots);
  void attribute(AttributeDecl& decl, uint32_t& slots);
  void environment(EnvironmentDecl& decl, uint32_t& slots);
  void block(BlockDecl& decl, uint32_t& slots);
  void extendedBlock(BlockDecl& decl, uint32_t& slots);
  void blockName(const BlockDecl& decl);
  void blockArray(BlockDecl& decl);
  void lightCount(BlockDecl& decl);
  void fields(BlockDecl& decl, Name& instance, uint32_t& slots);
  void fieldArray(BlockFieldDecl& field);
  void lightKind(LightKindDecl& decl, uint32_t first_property);
  void lightLists(LightListsDecl& decl);
  void given(GivenDecl& decl, uint32_t& slots);
  void port(PortDecl& decl, uint32_t& slots);
  void output(OutputDecl& decl);
  void leaveOut(const TemplateDecl& decl, std::vector<TemplateDecl>& bases);
  void outputRules(TemplateDecl& decl);
  bool unlike(const Param& param, const Expr& value, std::string_view what);

  // check_names.cpp
  void templateNames(const BlockDecl& decl);
  void templateNames(const AttributeDecl& decl);
  void templateNames(const EnvironmentDecl& decl);
  void templateNames(const OutputDecl& decl);
  bool spelled(std::string_view name, Span span);
  void claim(std::string text, Span span, std::string what);

  // check_body.cpp
  void body(NodeDecl& decl, std::string_view variant, Span place, Body& body);
  Flow block(std::vector<Statement>& statements);
  Flow statement(Statement& statement);
  void let(Statement& statement);
  void assign(Statement& statement);
  Flow ifElse(Statement& statement);
  Flow loop(Statement& statement);
  uint64_t rounds(Statement& statement);
  ir::Interval boundOf(const Expr& expr) const;
  void returns(Statement& statement);
  void assume(Statement& statement);
  uint32_t slotCount() const { return static_cast<uint32_t>(slots_.size()); }
  void declare(Name name);
  void leave(size_t scope);
  void unused();

  // check_expression.cpp
  /// False when something was wrong (and is reported): the expression has no type then.
  bool expression(ExprPtr& expr);
  bool name(Expr& expr);
  bool member(ExprPtr& expr);
  bool choice(Expr& expr);
  bool index(ExprPtr& expr);
  /// `name.member` where the name stands for several values.
  bool hasMembers(const Expr& expr);
  /// Which one of the several; null after a report.
  const Member* memberOf(Expr& expr);
  bool swizzle(Expr& expr);
  bool operation(Expr& expr);
  bool settle(Expr& expr, std::vector<ExprPtr>& args);
  bool construct(Expr& expr);
  bool select(Expr& expr);
  bool call(Expr& expr);
  bool function(Expr& expr);
  bool callForm(Expr& expr);
  bool noForm(const Expr& expr);
  bool callNode(Expr& expr, const Surroundings::Found& found);
  bool arguments(Expr& expr, bool checked);
  bool checkAll(std::vector<ExprPtr>& args);
  /// Checks, and makes the expression's type the one that is wanted.
  bool typed(ExprPtr& expr, ir::Type type, std::string_view what);
  bool fits(Expr& expr, ir::Type type, std::string_view what);
  /// An untyped number becomes a Float, an Int or a UInt.
  void makeTyped(Expr& expr, ir::Type type);
  void makeFloat(Expr& expr) { makeTyped(expr, ir::Type::Float); }
  /// The same; false where it does not fit, which is reported.
  bool keepWhole(Expr& expr, ir::Type type);
  bool unknown(std::string_view name, std::string_view what, std::vector<std::string_view> candidates,
               std::string otherwise = {});
  Name* find(std::string_view name);
  Span spanOf(std::string_view text) const {
    return {static_cast<uint32_t>(text.data() - reporter_.text().data()), static_cast<uint32_t>(text.size())};
  }

  Reporter& reporter_;
  Surroundings& around_;
  std::optional<ir::Dag> scratch_;  ///< for constants; made when the first is met
  std::vector<Name> names_;
  std::deque<std::string> made_names_;                     ///< that no source holds
  std::vector<std::pair<std::string_view, Span>> unused_;  ///< locals of the body
  NodeDecl* node_ = nullptr;                               ///< whose body is checked
  TemplateDecl* template_ = nullptr;                       ///< whose parts are checked
  std::vector<const BlockDecl*> blocks_;                   ///< of the template, so far
  /// What the template's declarations are called in the shaders, so far, and what each name is.
  std::map<std::string, std::string, std::less<>> claimed_;
  std::vector<uint32_t> frame_ints_;               ///< slots of ints of its frame blocks, so far
  std::vector<const LightKindDecl*> light_kinds_;  ///< of the template, so far
  std::string_view variant_;
  bool constants_only_ = false;          ///< the expression must be a constant
  bool ports_allowed_ = false;           ///< the expression is an output's
  std::vector<std::string_view> slots_;  ///< of the body, so far
  std::vector<ir::Interval> bounds_;     ///< by slot: of parameters, and of locals that are never assigned
  std::set<std::string_view> assigned_;  ///< names that the body assigns somewhere
  bool crowded_ = false;  ///< names were left out, and that was said: others are not looked for
  uint32_t arms_ = 0;     ///< enclosing arms of `if`
  uint32_t block_depth_ = 0;
  bool may_have_returned_ = false;
  uint64_t trips_ = 1;   ///< how often the enclosing loops run what is inside
  uint64_t weight_ = 0;  ///< expressions to evaluate
  Ties unties_ = 0;
  uint32_t deepest_statement_ = 0, deepest_expression_ = 0, deepest_callee_ = 0;
};

}  // namespace lacquer::lang
