#include "lod/share.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>

#include "ir/names.h"

namespace lacquer::lod {

namespace {

using ir::ValueId;

/// Copies values of the material's rate from one module to another: equal values become one.
class Import {
public:
  Import(const ir::Module& from, ir::Module& to)
      : from_(from), to_(to), made_(from.dag.size(), ir::kNoValue) {}

  ValueId operator()(ValueId root) {
    // Operands have smaller ids.
    const std::array<ValueId, 1> roots{root};
    for (const ValueId id : ir::reachable(from_.dag, roots)) {
      if (made_[id] == ir::kNoValue) made_[id] = copy(id);
    }
    return made_[root];
  }

private:
  ValueId copy(ValueId id) {
    const ir::Value& value = from_.dag[id];
    if (value.op == ir::Op::Constant) return to_.dag.constant(value.type, from_.dag.constantOf(id));
    if (value.op == ir::Op::Input) return parameter(from_.dag.inputOf(id));
    std::array<ValueId, 4> operands{};
    for (size_t k = 0; k < value.count; ++k) operands[k] = made_[value.args[k]];
    const std::span<const ValueId> all(operands.data(), value.count);
    if (value.op == ir::Op::Construct) return to_.dag.construct(value.type, all);
    if (value.op != ir::Op::Swizzle) return to_.dag.make(value.op, all, value.payload);
    std::array<int, 4> picks{};
    const auto count = static_cast<size_t>(ir::componentCount(value.type));
    for (size_t i = 0; i < count; ++i) picks[i] = ir::swizzleComponent(value.payload, static_cast<int>(i));
    return to_.dag.swizzle(operands[0], {picks.data(), count});
  }

  ValueId parameter(ir::Input input) {
    assert(input.kind == ir::InputKind::Parameter);
    std::vector<ir::Parameter>& known = to_.parameters;
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const ir::Parameter& p) { return p.name == input.name; });
    const size_t place = static_cast<size_t>(found - known.begin());
    if (found == known.end()) known.push_back(from_.parameters[input.field]);
    input.field = static_cast<uint32_t>(place);
    return to_.dag.input(input);
  }

  const ir::Module& from_;
  ir::Module& to_;
  std::vector<ValueId> made_;
};

ir::Block* materialBlock(ir::Module& module) {
  for (ir::Block& block : module.blocks) {
    if (block.role == ir::BlockRole::Material) return &block;
  }
  return nullptr;
}

/// A field that some level reads.
struct Field {
  ValueId value;  ///< in the module of all expressions
  ir::Type type;
  std::string name;
};

/// An order without holes: the wide ones first, each vec3 followed by a float while there are any.
std::vector<uint32_t> packed(const std::vector<Field>& fields) {
  std::vector<uint32_t> by_width[5], order;
  for (uint32_t i = 0; i < fields.size(); ++i) by_width[ir::componentCount(fields[i].type)].push_back(i);
  order = by_width[4];
  size_t next_float = 0;
  for (const uint32_t i : by_width[3]) {
    order.push_back(i);
    if (next_float < by_width[1].size()) order.push_back(by_width[1][next_float++]);
  }
  order.insert(order.end(), by_width[2].begin(), by_width[2].end());
  order.insert(order.end(), by_width[1].begin() + static_cast<ptrdiff_t>(next_float), by_width[1].end());
  return order;
}

/// Puts other inputs in for those that read the old block's fields. Inputs are opaque, so that nothing
/// becomes simpler: operands are exchanged where they stand.
class Reads {
public:
  Reads(ir::Module& module, uint32_t block, const std::vector<uint32_t>& now)
      : module_(module), block_(block), now_(now), to_(module.dag.size(), ir::kNoValue) {}

  void run() {
    ir::Dag& dag = module_.dag;
    std::vector<ValueId> roots;
    for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
    for (const ir::Varying& varying : module_.varyings) {
      if (varying.source != ir::kNoValue) roots.push_back(varying.source);
    }
    const std::vector<ValueId> live = ir::reachable(dag, roots);
    for (const ValueId id : live) to_[id] = read(id);
    for (const ValueId id : live) {
      std::array<ValueId, 4> operands = dag[id].args;
      const size_t count = dag[id].count;
      bool changed = false;
      for (size_t k = 0; k < count; ++k) {
        const ValueId by = operands[k] < to_.size() ? to_[operands[k]] : ir::kNoValue;
        if (by == ir::kNoValue || by == operands[k]) continue;
        operands[k] = by;
        changed = true;
      }
      if (changed) dag.substitute(id, {operands.data(), count});
    }
    for (ir::Output& output : module_.outputs) output.value = mapped(output.value);
    for (ir::Varying& varying : module_.varyings) {
      if (varying.source != ir::kNoValue) varying.source = mapped(varying.source);
    }
  }

private:
  ValueId mapped(ValueId id) const { return to_[id] == ir::kNoValue ? id : to_[id]; }

  ValueId read(ValueId id) {
    ir::Dag& dag = module_.dag;
    if (dag[id].op != ir::Op::Input) return id;
    ir::Input input = dag.inputOf(id);
    if (input.kind != ir::InputKind::BlockField || input.block != block_) return id;
    const ir::Block& block = module_.blocks[block_];
    input.field = now_[input.field];
    input.name = block.instance + "." + block.fields[input.field].name;
    dag.setTerm(dag.termOf(id));
    dag.setRank(dag.rankOf(id));
    const ValueId made = dag.input(input);
    dag.setTerm(0);
    dag.setRank(ir::Dag::kOwnRank);
    return made;
  }

  ir::Module& module_;
  uint32_t block_;
  const std::vector<uint32_t>& now_;
  std::vector<ValueId> to_;
};

/// The fields of all levels, and where each level's have gone.
struct Union {
  ir::Module expressions;
  std::vector<Field> fields;
  std::vector<std::vector<uint32_t>> now;  ///< by level, by its own field: the union's
};

Union unionOf(std::span<ir::Module> levels) {
  Union all;
  std::map<ValueId, uint32_t> known;
  ir::Names names;
  for (ir::Module& level : levels) {
    std::vector<uint32_t>& now = all.now.emplace_back();
    const ir::Block* block = materialBlock(level);
    if (block == nullptr) continue;
    now.resize(block->fields.size());
    Import import(level, all.expressions);
    for (const ir::PreshaderField& field : level.preshader) {
      const ValueId value = import(field.value);
      const auto [it, fresh] = known.emplace(value, static_cast<uint32_t>(all.fields.size()));
      const ir::BlockField& own = block->fields[field.field];
      if (fresh) all.fields.push_back({value, own.type, names.pick(own.name)});
      now[field.field] = it->second;
    }
  }
  return all;
}

void shareBlock(std::span<ir::Module> levels) {
  Union all = unionOf(levels);
  if (all.fields.empty()) return;
  const std::vector<uint32_t> order = packed(all.fields);
  std::vector<uint32_t> place(order.size());
  ir::Block block{ir::BlockRole::Material, "Material", "material", {}, 0, 0, ir::kMaterialBinding};
  for (uint32_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    block.fields.push_back({all.fields[order[i]].name, all.fields[order[i]].type, 0, {}, {}});
  }
  block.size = ir::layout(block.fields);
  for (size_t k = 0; k < levels.size(); ++k) {
    ir::Module& level = levels[k];
    std::vector<uint32_t> now = all.now[k];
    for (uint32_t& field : now) field = place[field];
    if (ir::Block* own = materialBlock(level)) {
      *own = block;
      Reads(level, static_cast<uint32_t>(own - level.blocks.data()), now).run();
    } else {
      level.blocks.push_back(block);
    }
    level.preshader.clear();
    Import import(all.expressions, level);
    for (uint32_t i = 0; i < order.size(); ++i)
      level.preshader.push_back({i, import(all.fields[order[i]].value)});
    ir::compact(level);
  }
}

}  // namespace

bool texturesWithin(const ir::Module& module, const ir::Module& whole) {
  return std::all_of(module.textures.begin(), module.textures.end(), [&](const ir::TextureSlot& slot) {
    return std::any_of(whole.textures.begin(), whole.textures.end(),
                       [&](const ir::TextureSlot& other) { return other.name == slot.name; });
  });
}

void shareInterface(std::span<ir::Module> levels) {
  if (levels.empty()) return;
  for (ir::Module& level : levels.subspan(1)) {
    for (ir::TextureSlot& slot : level.textures) {
      for (const ir::TextureSlot& whole : levels[0].textures) {
        if (whole.name == slot.name) slot.binding = whole.binding;
      }
    }
  }
  shareBlock(levels);
}

}  // namespace lacquer::lod
