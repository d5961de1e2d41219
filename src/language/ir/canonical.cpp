#include "ir/canonical.h"

#include <utility>

#include "support/digest.h"

namespace lacquer::ir {

namespace {

class Writer {
public:
  explicit Writer(const Module& module) : module_(module), dag_(module.dag), numbers_(module.dag.size(), 0) {
    bytes_.reserve(16 * 1024);
  }

  std::string run() {
    text(module_.template_name);
    std::vector<ValueId> roots;
    for (const Output& output : module_.outputs) roots.push_back(output.value);
    for (const PreshaderField& field : module_.preshader) roots.push_back(field.value);
    for (const ValueId id : reachable(dag_, roots)) {
      const Value& value = dag_[id];
      if (value.op != Op::Constant && value.op != Op::Input) this->value(id, value);
    }
    preshader();
    for (const Output& output : module_.outputs) {
      number(output.stage);
      number(output.kind);
      number(output.location);
      text(output.name);
      refer(output.value);
      // Only packed colours have them, which their names tell.
      for (const std::string& held : output.holds) text(held);
    }
    textures();
    others();
    parameters();
    number(module_.varyings.size());
    for (const Varying& varying : module_.varyings) text(varying.name);
    for (const LightGroup& group : module_.light_groups) {
      number(group.first);
      number(group.count);
    }
    return std::move(bytes_);
  }

private:
  template <class T>
  void number(T x) {
    appendNumber(bytes_, x);
  }
  void text(std::string_view text) {
    number(static_cast<uint32_t>(text.size()));
    bytes_ += text;
  }

  /// An operand: a value by its place, a leaf by what it is where it is met first, so that the order in which
  /// leaves were made does not matter.
  void refer(ValueId id) {
    if (numbers_[id] != 0) return number(numbers_[id]);
    numbers_[id] = ++next_;
    number(uint32_t{0});
    const Value& leaf = dag_[id];
    number(leaf.op);
    number(leaf.type);
    if (leaf.op == Op::Constant) {
      const Components& constant = dag_.constantOf(id);
      for (int c = 0; c < std::min(componentCount(leaf.type), 4); ++c)
        number(constant[static_cast<size_t>(c)]);
      return;
    }
    const Input& input = dag_.inputOf(id);
    number(input.kind);
    number(input.rate);
    number(input.element);
    number(input.group);
    number(input.index);
    text(input.name);
    // Elsewhere they follow from what is read.
    if (module_.beside_another && input.kind == InputKind::Attribute)
      number(module_.attributes[input.field].location);
    if (module_.beside_another && input.kind == InputKind::Varying)
      number(module_.varyings[input.field].location);
    if (input.kind != InputKind::LoopIndex) return;
    number(input.range.lo);
    number(input.range.hi);
  }

  void value(ValueId id, const Value& value) {
    if (const TermId term = dag_.termOf(id); term != term_) {
      term_ = term;
      number(uint8_t{1});
      text(dag_.terms()[term].name);
      text(dag_.terms()[term].source);
    } else {
      number(uint8_t{0});
    }
    number(value.op);
    number(value.type);
    number(value.rate);
    number(static_cast<uint8_t>(dag_.relaxed(id) ? precision_ : 0));
    number(value.count);
    text(dag_.nameOf(id));
    if (value.op == Op::Swizzle || value.op == Op::Column || value.op == Op::SumOverLights ||
        value.op == Op::Carried || value.op == Op::TextureSize)
      number(value.payload);
    if (value.op == Op::Element) {
      const ListField from = ListField::of(value);
      text(module_.blocks[from.block].instance);
      text(module_.blocks[from.block].fields[from.field].name);
    }
    for (const ValueId operand : value.operands()) refer(operand);
    numbers_[id] = ++next_;
  }

  void preshader() {
    for (const PreshaderField& field : module_.preshader) {
      for (const Block& block : module_.blocks) {
        if (block.role != BlockRole::Material) continue;
        const BlockField& of = block.fields[field.field];
        number(of.type);
        number(of.offset);
        text(of.name);
        refer(field.value);
      }
    }
  }

  void textures() {
    for (const TextureSlot& slot : module_.textures) {
      const uint32_t place = slot.optional      ? slot.binding.binding
                             : slot.environment ? slot.binding.flat
                                                : slot.binding.flat - module_.material_textures;
      number(slot.type);
      number(slot.srgb);
      number(place);
      if (module_.beside_another && slot.optional) number(slot.binding.flat);
      text(slot.name);
      if (slot.sampler) {
        number(slot.sampler->wrap_s);
        number(slot.sampler->wrap_t);
        number(slot.sampler->mag);
        number(slot.sampler->min);
      }
      if (!slot.layers.empty()) {
        text(slot.layers);
        number(slot.number);
      }
      if (slot.array.empty()) continue;
      text(slot.array);
      number(slot.number);
    }
  }

  /// Of a program alone there is nothing.
  void others() {
    const auto add = [&](const std::string& name, const Stages& stages) {
      if (!stages.any()) return;
      text(name);
      number(stages.vertex);
      number(stages.fragment);
    };
    for (const Block& block : module_.blocks) add(block.instance, block.others);
    for (const TextureSlot& slot : module_.textures) add(slot.name, slot.others);
  }

  /// The packers hold to their ranges.
  void parameters() {
    for (const uint32_t index : usedParameters(module_)) {
      const Parameter& p = module_.parameters[index];
      text(p.name);
      number(p.type);
      for (const double x : p.neutral) number(x);
      for (const double x : {p.range.lo, p.range.hi, p.range.gap}) number(x);
      number(p.constant_id);
    }
  }

  const Module& module_;
  const Dag& dag_;
  const uint8_t precision_ = module_.half && module_.half->used ? 2 : 1;  ///< of what is relaxed
  std::string bytes_;
  std::vector<uint32_t> numbers_;  ///< from 1, in the order in which they are met; 0: not yet
  uint32_t next_ = 0;
  TermId term_ = ~TermId{0};
};

}  // namespace

std::string canonical(const Module& module) { return Writer(module).run(); }

}  // namespace lacquer::ir
