// The preshader as an ES module with types beside it: a material's parameters in, the bytes of the uniform
// block out. JavaScript's numbers are doubles and its operators round as C++'s do, so that the bytes are
// those of Shader::pack(). It has no operators of vectors: the preshader is taken apart into numbers first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>

#include "ir/fold.h"
#include "ir/names.h"
#include "targets/clike.h"
#include "targets/packer.h"
#include "targets/target.h"

namespace lacquer::targets {

using ir::Op;
using ir::Type;
using ir::ValueId;

namespace {

constexpr std::string_view kMembers = "xyzw";

/// What a local of the module's function must not be called, beside what means something in another target.
constexpr std::array kTaken = {
    // the language's words and the globals that are used
    "arguments", "await", "debugger", "eval", "export", "extends", "finally", "function", "implements",
    "import", "instanceof", "let", "package", "super", "var", "yield", "async", "of", "undefined", "Infinity",
    "NaN", "Math", "Number", "Object", "DataView", "Uint8Array", "RangeError",
    // the module's own
    "id", "defaults", "blockSize", "fields", "blocks", "textures", "pack", "parameters", "bytes", "view",
    "put", "p", "within", "truth", "packed", "given", "outside"};

/// A number: the shortest text that reads back as the same.
Expression numberLiteral(double x) {
  return {fmt::format("{}", x), std::signbit(x) ? Precedence::Unary : Precedence::Postfix};
}

/// A constant or a default of a parameter.
std::string literalOf(Type type, const ir::Components& value) {
  if (type == Type::Bool) return value[0] != 0 ? "true" : "false";
  if (ir::componentCount(type) == 1) return numberLiteral(value[0]).text;
  std::string list;
  for (int i = 0; i < ir::componentCount(type); ++i)
    list += (i == 0 ? "" : ", ") + numberLiteral(value[static_cast<size_t>(i)]).text;
  return fmt::format("Object.freeze([{}])", list);
}

/// One name in an object is not just a name.
std::string keyOf(const std::string& name) { return name == "__proto__" ? "[\"__proto__\"]" : name; }

/// True when the op is a function of Math that means for all numbers what <cmath>'s does.
bool isMath(Op op) { return isStandard(op) && op != Op::Exp2 && op != Op::Pow && op != Op::Round; }

/// An op on integers: JavaScript's own are those of 32 bits, and each is a number (ir/whole.h).
std::string_view meaningOfWholes(Op op) {
  constexpr std::pair<Op, std::string_view> kMeanings[] = {
      {Op::WholeAdd, "(a + b) | 0"},
      {Op::WholeSub, "(a - b) | 0"},
      {Op::WholeMul, "Math.imul(a, b)"},
      {Op::IntDiv, "b === 0 ? 0 : (a / b) | 0"},
      {Op::UIntDiv, "b === 0 ? 0 : ((a >>> 0) / (b >>> 0)) | 0"},
      {Op::BitAnd, "a & b"},
      {Op::BitOr, "a | b"},
      {Op::BitXor, "a ^ b"},
      {Op::BitNot, "~a"},
      {Op::ShiftLeft, "a << b"},
      {Op::IntShiftRight, "a >> b"},
      {Op::UIntShiftRight, "(a >>> b) | 0"},
      {Op::IntLess, "a < b"},
      {Op::UIntLess, "a >>> 0 < b >>> 0"},
      {Op::WholeEqual, "a === b"},
      {Op::ToInt, "Math.min(Math.max(a, -2147483648), 2147483647) | 0"},
      {Op::ToUInt, "Math.min(Math.max(a, 0), 4294967295) | 0"},
      {Op::FromInt, "a"},
      {Op::FromUInt, "a >>> 0"},
  };
  for (const auto& [known, text] : kMeanings) {
    if (known == op) return text;
  }
  assert(false && "not an op on integers");
  return {};
}

/// What a module calls an op that JavaScript has not.
std::string_view helperName(Op op) { return ofWholes(op) ? ir::info(op).name : ir::info(op).glsl; }

/// ops.def's words of an op in JavaScript.
std::string meaning(Op op) {
  if (ofWholes(op)) return std::string(meaningOfWholes(op));
  if (op == Op::Exp2) return "2 ** a";
  // Beyond 2 ** 52 numbers are whole.
  if (op == Op::Round)
    return "Math.abs(a) < 2 ** 52 ? (a > 0 ? a + 2 ** 52 - 2 ** 52 : a < 0 ? -(2 ** 52 - a - 2 ** 52) : a) : "
           "a";
  // C++ has 1 where JavaScript has NaN.
  if (op == Op::Pow) return "a === 1 || (a === -1 && Math.abs(b) === Infinity) ? 1 : a ** b";
  std::string text(foldText(op));
  for (const auto& [from, to] : {std::pair("std::", "Math."), std::pair("T(", "(")}) {
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
      text.replace(at, std::string_view(from).size(), to);
  }
  return text;
}

/// The preshader as operations of numbers and truths, each once.
class Scalars {
public:
  using Id = uint32_t;

  Scalars(const ir::Module& module, const schedule::Program& program) : module_(module), program_(program) {
    std::vector<ValueId> roots;
    for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
    for (const ValueId id : ir::reachable(module.dag, roots)) take(id);
    for (const ValueId root : roots) {
      for (const Id id : parts_.at(root)) ++nodes_[id].uses;
    }
    decide();
  }

  /// Functions that the expressions call and JavaScript does not have.
  std::set<Op> helpers() const {
    std::set<Op> ops;
    for (const Node& node : nodes_) {
      if (!node.leaf && !isOperator(node.op) && node.op != Op::Select && !isMath(node.op))
        ops.insert(node.op);
    }
    return ops;
  }

  /// The variables, in an order in which each can be computed.
  void print(Text& text) {
    ir::TermId section = 0;
    ir::Names names;
    for (const char* word : kTaken) names.take(word);
    for (Node& node : nodes_) {
      if (!node.variable) continue;
      const ir::Term& term = module_.dag.terms()[node.term];
      if (node.term != section && !term.name.empty())
        text.comment(term.source.empty() ? term.name : fmt::format("{}: {}", term.name, term.source));
      section = node.term;
      const Expression value = compute(node);
      node.name = names.pick(node.wanted, ir::layerOf(term.name));
      text.line(fmt::format("const {} = {};", node.name, value.text));
    }
  }

  /// The components of a value of the module, after print().
  std::vector<std::string> components(ValueId id) const {
    std::vector<std::string> texts;
    for (const Id part : parts_.at(id)) texts.push_back(use(part).text);
    return texts;
  }

private:
  struct Node {
    Op op = Op::Constant;
    bool leaf = false;
    bool variable = false;
    uint8_t count = 0;
    std::array<Id, 4> args{};
    uint32_t uses = 0;
    uint32_t size = 1;  ///< of the expression that stands where it is used
    ir::TermId term = 0;
    Expression text{};     ///< of a leaf
    std::string wanted{};  ///< a variable's name, if it is free
    std::string name{};    ///< what it got
  };

  void take(ValueId id) {
    const ir::Dag& dag = module_.dag;
    const ir::Value& value = dag[id];
    const auto width = static_cast<size_t>(ir::componentCount(value.type));
    std::vector<Id>& parts = parts_[id];
    if (value.op == Op::Constant) {
      for (size_t i = 0; i < width; ++i) parts.push_back(constant(value.type, dag.constantOf(id)[i]));
    } else if (value.op == Op::Input) {
      const std::string member = "p." + module_.parameters[dag.inputOf(id).field].name;
      // An integer as the number of the Int with its bits.
      const std::string_view bits = ir::isWhole(ir::partType(value.type)) ? " | 0" : "";
      const Precedence precedence = bits.empty() ? Precedence::Postfix : Precedence::Bitwise;
      for (size_t i = 0; i < width; ++i)
        parts.push_back(leaf(
            {fmt::format("{}{}", width == 1 ? member : fmt::format("{}[{}]", member, i), bits), precedence}));
    } else if (value.op == Op::AsInt || value.op == Op::AsUInt) {
      parts = parts_.at(value.args[0]);
    } else {
      operation(id, width, parts);
    }
  }

  void operation(ValueId id, size_t width, std::vector<Id>& parts) {
    const ir::Value& value = module_.dag[id];
    const auto first = static_cast<Id>(nodes_.size());
    std::array<std::span<const Id>, 4> operands;
    for (size_t k = 0; k < value.count; ++k) operands[k] = parts_.at(value.args[k]);
    const std::array<Id, 4> made =
        ir::fold<Id>(value.op, value.type, value.payload, {operands.data(), value.count},
                     [this](Op op, std::span<const Id> arguments) { return node(op, arguments); });
    parts.assign(made.begin(), made.begin() + static_cast<ptrdiff_t>(width));
    const std::string wanted = wantedName(id);
    for (size_t i = first; i < nodes_.size(); ++i) {
      nodes_[i].term = module_.dag.termOf(id);
      nodes_[i].wanted = wanted;
    }
    for (size_t i = 0; i < width; ++i) {
      Node& part = nodes_[parts[i]];
      if (part.leaf || parts[i] < first || program_.names[id].empty()) continue;
      part.variable = true;
      if (width > 1) part.wanted = fmt::format("{}_{}", wanted, kMembers[i]);
    }
  }

  std::string wantedName(ValueId id) const {
    if (!program_.names[id].empty()) return program_.names[id];
    if (const std::string_view name = module_.dag.nameOf(id); !name.empty()) return std::string(name);
    const std::string& term = module_.dag.terms()[module_.dag.termOf(id)].name;
    return term.empty() ? "part" : term.substr(term.rfind('.') + 1) + "_part";
  }

  Id constant(Type type, double x) {
    if (type == Type::Bool) return leaf({x != 0 ? "true" : "false"});
    return leaf(numberLiteral(x));
  }

  Id leaf(const Expression& text) {
    const auto [it, fresh] = leaves_.emplace(text.text, static_cast<Id>(nodes_.size()));
    if (fresh) {
      Node node;
      node.leaf = true;
      node.text = text;
      nodes_.push_back(std::move(node));
    }
    return it->second;
  }

  Id node(Op op, std::span<const Id> arguments) {
    Node node;
    node.op = op;
    node.count = static_cast<uint8_t>(arguments.size());
    std::copy(arguments.begin(), arguments.end(), node.args.begin());
    const auto [it, fresh] = known_.emplace(std::pair(op, node.args), static_cast<Id>(nodes_.size()));
    if (!fresh) return it->second;
    for (const Id argument : arguments) ++nodes_[argument].uses;
    nodes_.push_back(std::move(node));
    return it->second;
  }

  /// Which nodes get a variable: those with a name, those that are used twice, and now and then one of a long
  /// expression. What nothing uses gets none.
  void decide() {
    constexpr uint32_t kLongest = 24;
    for (Node& node : nodes_) {
      if (node.leaf) continue;
      for (size_t k = 0; k < node.count; ++k) {
        const Node& argument = nodes_[node.args[k]];
        node.size += argument.variable ? 1 : argument.size;
      }
      node.variable = node.uses > 0 && (node.variable || node.uses > 1 || node.size > kLongest);
    }
  }

  Expression use(Id id) const {
    const Node& node = nodes_[id];
    if (node.leaf) return node.text;
    return node.variable ? Expression{node.name} : compute(node);
  }

  Expression compute(const Node& node) const {
    std::vector<Expression> arguments;
    for (size_t k = 0; k < node.count; ++k) arguments.push_back(use(node.args[k]));
    if (node.op == Op::Select) {
      return {fmt::format("{} ? {} : {}", parenthesized(arguments[0], Precedence::Or),
                          parenthesized(arguments[1], Precedence::Or),
                          parenthesized(arguments[2], Precedence::Ternary)),
              Precedence::Ternary};
    }
    const std::string_view spelling = ir::info(node.op).glsl;
    if (isOperator(node.op)) return operatorText(spelling, arguments);
    std::string list;
    for (const Expression& argument : arguments) list += (list.empty() ? "" : ", ") + argument.text;
    if (!isMath(node.op)) return {fmt::format("{}({})", helperName(node.op), list)};
    const std::string call = meaning(node.op);
    return {fmt::format("{}({})", call.substr(0, call.find('(')), list)};
  }

  const ir::Module& module_;
  const schedule::Program& program_;
  std::vector<Node> nodes_;  ///< arguments first
  std::map<ValueId, std::vector<Id>> parts_;
  std::map<std::string, Id> leaves_;
  std::map<std::pair<Op, std::array<Id, 4>>, Id> known_;
};

class EsModule {
public:
  EsModule(const ir::Module& module, std::string_view name)
      : module_(module),
        name_(name),
        block_(materialBlock(module)),
        parameters_(ir::usedParameters(module)) {}

  std::string code(std::string_view head) {
    open(head,
         "The material's uniform block from its parameters: an ES module. It computes in double what the "
         "library's\n"
         "pack() computes, and rounds each component to float once.");
    doc("The shader that this belongs to.");
    text_.line(fmt::format("export const id = \"{}\";", name_));
    defaults();
    text_.blank();
    doc("Bytes of the block; 0 where the shader has none.");
    text_.line(fmt::format("export const blockSize = {};", size()));
    fields();
    pack();
    bindings();
    return text_.take();
  }

  std::string types(std::string_view head) {
    open(head, "The types of the module beside this file.");
    text_.line(fmt::format("export declare const id: \"{}\";", name_));
    parameterTypes();
    text_.blank();
    doc("Bytes of the block; 0 where the shader has none.");
    text_.line(fmt::format("export declare const blockSize: {};", size()));
    fieldTypes();
    text_.blank();
    packDoc();
    text_.line(
        "export declare function pack<T extends ArrayBufferView = Uint8Array>(parameters?: "
        "Partial<Parameters>, "
        "bytes?: T): T;");
    text_.blank();
    doc("The names of the parameters that are packed otherwise than they are given, for they are outside of\n"
        "their ranges or no numbers.");
    text_.line("export declare function outside(parameters?: Partial<Parameters>): (keyof Parameters)[];");
    bindingTypes();
    return text_.take();
  }

private:
  void open(std::string_view head, std::string_view what) {
    text_.comments(head);
    text_.comment("");
    text_.comments(what);
    text_.blank();
  }

  void doc(std::string_view words) {
    std::string_view open = "/** ";
    for (size_t end = words.find('\n'); end != std::string_view::npos; end = words.find('\n')) {
      text_.line(fmt::format("{}{}", open, words.substr(0, end)));
      words.remove_prefix(end + 1);
      open = " *  ";
    }
    text_.line(fmt::format("{}{} */", open, words));
  }

  uint32_t size() const { return block_ == nullptr ? 0 : block_->size; }

  /// `export const NAME = Object.freeze(OPEN LINES CLOSE);`
  template <class Lines>
  void frozen(std::string_view name, std::string_view brackets, bool empty, Lines lines) {
    if (empty) return text_.line(fmt::format("export const {} = Object.freeze({});", name, brackets));
    text_.line(fmt::format("export const {} = Object.freeze({}", name, brackets[0]));
    text_.indent();
    lines();
    text_.outdent();
    text_.line(fmt::format("{});", brackets[1]));
  }

  void defaults() {
    text_.blank();
    doc("What can be edited, with glTF's defaults, which belong to no material.");
    frozen("defaults", "{}", parameters_.empty(), [&] {
      for (const uint32_t index : parameters_) {
        const ir::Parameter& p = module_.parameters[index];
        text_.line(fmt::format("{}: {},", keyOf(p.name), literalOf(p.type, p.neutral)));
      }
    });
  }

  void fields() {
    text_.blank();
    doc(block_ == nullptr
            ? std::string("There is no block.")
            : fmt::format("Where the fields of the block `{}` lie, in bytes, and how many floats each has.",
                          block_->name));
    frozen("fields", "{}", block_ == nullptr, [&] {
      for (const ir::BlockField& field : block_->fields) {
        text_.line(fmt::format("{}: Object.freeze({{ offset: {}, components: {} }}),", keyOf(field.name),
                               field.offset, field.stride() * field.elements() / 4));
      }
    });
  }

  void pack() {
    text_.blank();
    if (block_ == nullptr) {
      doc("There is no block: nothing is written.");
      text_.line("export function pack(parameters = {}, bytes = new Uint8Array(0)) { return bytes; }");
      return outside();
    }
    const schedule::Program program = schedule::schedulePreshader(module_, {});
    Scalars scalars(module_, program);
    for (const Op op : scalars.helpers()) {
      std::string list;
      for (int k = 0; k < ir::info(op).arity; ++k) list += fmt::format("{}{}", k == 0 ? "" : ", ", "abc"[k]);
      text_.line(fmt::format("const {} = ({}) => {};", helperName(op), list, meaning(op)));
    }
    packed();
    text_.blank();
    packDoc();
    text_.line("export function pack(parameters = {}, bytes = new Uint8Array(blockSize)) {");
    text_.indent();
    text_.line(
        "if (bytes.byteLength < blockSize) throw new RangeError(`the block takes ${blockSize} bytes`);");
    text_.line("const p = packed({ ...defaults, ...parameters });");
    text_.line("const view = new DataView(bytes.buffer, bytes.byteOffset, blockSize);");
    text_.comment("A field is as large as a float at most; one that is no number becomes 0, and so does -0.");
    text_.line(fmt::format(
        "const put = (at, x) => view.setFloat32(at, x === 0 ? 0 : within(x, -{0}, {0}, 0), true);",
        numberLiteral(kLargestFloat).text));
    text_.line("new Uint8Array(bytes.buffer, bytes.byteOffset, blockSize).fill(0);");
    scalars.print(text_);
    for (const ir::PreshaderField& p : module_.preshader) {
      const ir::BlockField& field = block_->fields[p.field];
      const std::vector<std::string> parts = scalars.components(p.value);
      if (ir::isWhole(field.type))
        text_.line(fmt::format("view.setInt32({}, {}, true);", field.offset, parts[0]));
      else
        for (size_t i = 0; i < parts.size(); ++i)
          text_.line(fmt::format("put({}, {});", field.offset + 4 * i, parts[i]));
    }
    text_.line("return bytes;");
    text_.outdent();
    text_.line("}");
    outside();
  }

  void packDoc() {
    doc("Writes the block to the first blockSize bytes of `bytes`, which it returns. What `parameters` does "
        "not\n"
        "name has its default, and so has what is no number; one outside of its parameter's range is packed "
        "as\n"
        "the nearest in it. Throws a RangeError where there are fewer bytes.");
  }

  /// Of a parameter that is given as `given`, what is packed.
  static std::string packedText(const ir::Parameter& p, const std::string& given, int i) {
    const std::string otherwise = numberLiteral(p.neutral[static_cast<size_t>(i)]).text;
    if (p.type == Type::Bool) return fmt::format("truth({}, {})", given, p.neutral[0] != 0);
    const PackedRange range = packedRange(p);
    std::string within = fmt::format("within({}, {}, {}, {})", given, numberLiteral(range.low).text,
                                     numberLiteral(range.high).text, otherwise);
    if (range.whole) within = fmt::format("Math.floor({} + 0.5)", within);
    return range.or_zero ? fmt::format("{} === 0 ? 0 : {}", given, within) : within;
  }

  void packed() {
    const auto isTruth = [&](uint32_t index) { return module_.parameters[index].type == Type::Bool; };
    text_.comment("A number outside of a range counts as the nearest one in it.");
    text_.line(
        "const within = (x, low, high, otherwise) => (x >= low ? (x <= high ? x : high) : x < low ? low : "
        "otherwise);");
    if (std::any_of(parameters_.begin(), parameters_.end(), isTruth))
      text_.line("const truth = (x, otherwise) => (x !== x ? otherwise : x !== 0);");
    text_.comment("The parameters as they are packed.");
    text_.line("const packed = (given) => ({");
    text_.indent();
    for (const uint32_t index : parameters_) {
      const ir::Parameter& p = module_.parameters[index];
      const int width = ir::componentCount(p.type);
      std::string list;
      for (int i = 0; i < width; ++i) {
        const std::string from = width == 1 ? fmt::format("Number(given.{})", p.name)
                                            : fmt::format("Number(Object(given.{})[{}])", p.name, i);
        list += (i == 0 ? "" : ", ") + packedText(p, from, i);
      }
      text_.line(width == 1 ? fmt::format("{}: {},", keyOf(p.name), list)
                            : fmt::format("{}: [{}],", keyOf(p.name), list));
    }
    text_.outdent();
    text_.line("});");
  }

  void outside() {
    text_.blank();
    doc("The names of the parameters that are packed otherwise than they are given, for they are outside of\n"
        "their ranges or no numbers.");
    if (block_ == nullptr) return text_.line("export function outside(parameters = {}) { return []; }");
    text_.line("export function outside(parameters = {}) {");
    text_.indent();
    text_.line("const given = { ...defaults, ...parameters };");
    text_.line("const p = packed(given);");
    text_.line("return Object.keys(p).filter((name) => Array.isArray(p[name])");
    text_.line("    ? p[name].some((x, i) => x !== Object(given[name])[i])");
    text_.line("    : Number(p[name]) !== Number(given[name]));");
    text_.outdent();
    text_.line("}");
  }

  static std::string place(const ir::Binding& at) {
    return fmt::format("set: {}, binding: {}, flat: {}", at.set, at.binding, at.flat);
  }

  std::vector<const ir::Block*> usedBlocks() const {
    std::vector<const ir::Block*> used;
    for (const ir::Block& block : module_.blocks) {
      if (usesBlock(module_, block)) used.push_back(&block);
    }
    return used;
  }

  void bindings() {
    const std::vector<const ir::Block*> used = usedBlocks();
    text_.blank();
    doc("The blocks that the shader reads, by their names in GLSL. `set` and `binding` are Vulkan's and "
        "WebGPU's,\n"
        "`flat` where there are no sets.");
    frozen("blocks", "[]", used.empty(), [&] {
      for (const ir::Block* block : used) {
        text_.line(fmt::format("Object.freeze({{ name: \"{}\", {}, size: {} }}),", blockName(*block),
                               place(block->binding), block->size * std::max(block->array, 1U)));
      }
    });
    text_.blank();
    doc("`srgb`: to be given an sRGB format. `environment`: the frame's, not the material's.");
    frozen("textures", "[]", module_.textures.empty(), [&] {
      for (const ir::TextureSlot& slot : module_.textures) {
        text_.line(fmt::format(
            "Object.freeze({{ name: \"{}\", type: \"{}\", {}, srgb: {}, environment: {} }}),", slot.name,
            ir::typeName(slot.type), place(slot.binding), slot.srgb, slot.environment));
      }
    });
  }

  /// What a parameter of the type may be given.
  static std::string typeText(Type type) {
    if (type == Type::Bool) return "boolean";
    if (ir::componentCount(type) == 1) return "number";
    std::string list;
    for (int i = 0; i < ir::componentCount(type); ++i) list += i == 0 ? "number" : ", number";
    return fmt::format("readonly [{}] | Float32Array | Float64Array", list);
  }

  void parameterTypes() {
    text_.blank();
    doc("What can be edited.");
    text_.line("export interface Parameters {");
    text_.indent();
    for (const uint32_t index : parameters_) {
      const ir::Parameter& p = module_.parameters[index];
      text_.line(fmt::format("{}: {};", p.name, typeText(p.type)));
    }
    text_.outdent();
    text_.line("}");
    text_.blank();
    doc("glTF's defaults, which belong to no material.");
    text_.line("export declare const defaults: Readonly<Parameters>;");
  }

  void fieldTypes() {
    text_.blank();
    doc("Where the block's fields lie, in bytes, and how many floats each has.");
    text_.line("export interface Field { readonly offset: number; readonly components: number; }");
    text_.line("export declare const fields: {");
    text_.indent();
    if (block_ != nullptr) {
      for (const ir::BlockField& field : block_->fields)
        text_.line(fmt::format("readonly {}: Field;", field.name));
    }
    text_.outdent();
    text_.line("};");
  }

  void bindingTypes() {
    text_.blank();
    doc("Where something is bound: `set` and `binding` for Vulkan and WebGPU, `flat` where there are no "
        "sets.");
    text_.line(
        "export interface Binding { readonly set: number; readonly binding: number; readonly flat: number; "
        "}");
    text_.line("export interface Block extends Binding { readonly name: string; readonly size: number; }");
    text_.line("export declare const blocks: readonly Block[];");
    doc("`srgb`: to be given an sRGB format. `environment`: the frame's, not the material's.");
    text_.line("export interface Texture extends Binding {");
    text_.indent();
    text_.line("readonly name: string;");
    text_.line("readonly type: string;");
    text_.line("readonly srgb: boolean;");
    text_.line("readonly environment: boolean;");
    text_.outdent();
    text_.line("}");
    text_.line("export declare const textures: readonly Texture[];");
  }

  const ir::Module& module_;
  std::string_view name_;
  const ir::Block* block_;
  std::vector<uint32_t> parameters_;  ///< by name
  Text text_;
};

}  // namespace

PackerText moduleText(const ir::Module& module, std::string_view name, std::string_view head) {
  assert(ir::verify(module).empty());
  return {EsModule(module, name).types(head), EsModule(module, name).code(head)};
}

}  // namespace lacquer::targets
