#include "programs/alternatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lacquer::programs {

using graph::Graph;
using graph::Literal;
using graph::Node;
using graph::NodeRef;
using graph::Source;
using graph::TextureRef;

namespace {

struct Text {
  std::string operator()(const Literal& l) const {
    std::string text = fmt::format("={}", static_cast<int>(l.type));
    for (int i = 0; i < ir::componentCount(l.type); ++i) text += fmt::format(",{}", l.number(i));
    return text;
  }
  std::string operator()(const graph::ParameterRef& ref) const { return "p" + ref.name; }
  std::string operator()(const TextureRef& ref) const { return "t" + ref.name; }
  std::string operator()(const graph::GivenRef& ref) const { return "g" + ref.name; }
  std::string operator()(const graph::AttributeRef& ref) const {
    return fmt::format("a{} {}", ref.name, static_cast<int>(ref.type));
  }
  std::string operator()(const NodeRef& ref) const { return "n" + ref.node + " " + ref.output; }
  std::string operator()(const graph::InputRef& ref) const { return "i" + ref.name; }
  std::string operator()(const graph::Choice& choice) const { return "c" + choice.name; }
};

constexpr std::string_view kSample = "texture_sample";

}  // namespace

Members joined(const Members& a, const Members& b) {
  Members all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

std::string textOf(const Source& source) { return std::visit(Text(), source.from) + "." + source.swizzle; }

// -- keys --

void Keys::add(const Graph& graph) {
  const auto member = static_cast<uint32_t>(ids_.size());
  ids_.emplace_back();
  for (const Node& node : graph.nodes) {
    std::string text = fmt::format("{}\n{}\n{}\n{}", node.id, node.type, node.variant, node.at_vertices);
    std::string image;
    for (const auto& [name, source] : node.inputs) {
      const auto* ref = std::get_if<TextureRef>(&source.from);
      if (ref != nullptr) text += "\n" + (image = ref->name);
    }
    const auto [it, fresh] = keys_.emplace(std::move(text), static_cast<uint32_t>(all_.size()));
    if (fresh) {
      all_.emplace_back();
      if (node.type == kSample && node.variant.empty()) all_.back().sampled = image;
    }
    Key& key = all_[it->second];
    key.members.push_back(member);
    key.nodes.push_back(&node);
    ids_.back().emplace(node.id, it->second);
  }
}

const Node* Keys::nodeOf(uint32_t key, uint32_t member) const {
  const Members& members = all_[key].members;
  const auto it = std::lower_bound(members.begin(), members.end(), member);
  return it == members.end() || *it != member ? nullptr
                                              : all_[key].nodes[static_cast<size_t>(it - members.begin())];
}

uint32_t Keys::of(uint32_t member, const std::string& id) const {
  const auto it = ids_[member].find(id);
  return it == ids_[member].end() ? kNone : it->second;
}

std::vector<Alternative> alternatives(const Keys& keys, Sources sources) {
  std::vector<Alternative> all;
  std::map<std::string, size_t> places;
  for (auto& [member, source] : sources) {
    const auto* ref = std::get_if<NodeRef>(&source.from);
    const uint32_t key = ref == nullptr ? Keys::kNone : keys.of(member, ref->node);
    const std::string text =
        ref == nullptr ? textOf(source) : fmt::format("n{} {}.{}", key, ref->output, source.swizzle);
    const auto [it, fresh] = places.emplace(text, all.size());
    if (fresh) all.push_back({std::move(source), {}, key});
    all[it->second].members.push_back(member);
  }
  return all;
}

// -- texels --

bool Texel::take(const Literal& literal, const std::string& swizzle) {
  auto changed = components_;
  const std::string of = swizzle.empty() ? "rgba" : swizzle;
  if (of.size() != static_cast<size_t>(ir::componentCount(literal.type))) return false;
  for (size_t i = 0; i < of.size(); ++i) {
    constexpr std::string_view kColors = "rgba", kPlaces = "xyzw";
    const size_t color = kColors.find(of[i]);
    const size_t place = color == std::string_view::npos ? kPlaces.find(of[i]) : color;
    const double x = literal.value[i];
    if (place >= changed.size() || (x != 0 && x != 1) || changed[place].value_or(x) != x) return false;
    changed[place] = x;
  }
  components_ = changed;
  return true;
}

ir::Components Texel::value() const {
  ir::Components all{};
  for (size_t i = 0; i < all.size(); ++i) all[i] = components_[i].value_or(1);
  return all;
}

// -- choices --

bool Choices::fits(const Flag& flag, const Members& members, bool on) {
  return std::all_of(members.begin(), members.end(),
                     [&](uint32_t m) { return flag.on[m].value_or(on) == on; });
}

void Choices::set(Flag& flag, const Members& members, bool on) {
  for (const uint32_t m : members) flag.on[m] = on;
}

Choices::Chosen Choices::of(const Members& first, const Members& others) {
  for (size_t i = 0; i < flags_.size(); ++i) {
    for (const bool swapped : {false, true}) {
      if (!fits(flags_[i], first, !swapped) || !fits(flags_[i], others, swapped)) continue;
      set(flags_[i], first, !swapped);
      set(flags_[i], others, swapped);
      return {i, swapped};
    }
  }
  flags_.push_back({{}, std::vector<std::optional<bool>>(members_)});
  set(flags_.back(), first, true);
  set(flags_.back(), others, false);
  return {flags_.size() - 1, false};
}

const std::string& Choices::name(size_t flag, const std::function<std::string(const std::string&)>& free) {
  if (flags_[flag].name.empty()) flags_[flag].name = free(fmt::format("choice_{}", flag));
  return flags_[flag].name;
}

void Choices::each(const std::function<void(const std::string&, const std::vector<bool>&)>& call) const {
  for (const Flag& flag : flags_) {
    std::vector<bool> on;
    for (const std::optional<bool>& one : flag.on) on.push_back(one.value_or(false));
    call(flag.name, on);
  }
}

}  // namespace lacquer::programs
