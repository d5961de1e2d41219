#include <fmt/format.h>

#include <algorithm>

#include "lang/ast.h"
#include "lang/builtins.h"
#include "lang/reporter.h"

namespace lacquer::lang {

namespace {

Ties untiedBy(const Expr& expr) {
  if (expr.kind == Expr::Kind::Call && expr.node != nullptr) return expr.node->unties;
  if (expr.kind != Expr::Kind::Operation || expr.builtin == nullptr) return 0;
  return lang::untiedBy(expr.builtin->op);
}

/// An operation's op; nothing for what is no operation.
std::optional<ir::Op> opOf(const Expr& expr) {
  if (expr.kind != Expr::Kind::Operation || expr.builtin == nullptr) return std::nullopt;
  return expr.builtin->op;
}

class Tying {
public:
  Tying(TemplateDecl& decl, Reporter& reporter)
      : decl_(decl),
        reporter_(reporter),
        vertex_stage_(std::any_of(decl.outputs.begin(), decl.outputs.end(),
                                  [](const auto& output) { return output.role == OutputRole::Position; })),
        ties_(decl.slots),
        port_(decl.slots),
        refused_(decl.slots),
        unmade_(decl.slots) {}

  void run() {
    inputs();
    for (GivenDecl& given : decl_.givens) {
      given.ties = given.value ? tiesOf(*given.value, {given.inherited}) : Ties{0};
      for (size_t i = 0; i < given.results.size(); ++i) ties_[given.slot + i] = given.ties;
      if (given.value) needs(*given.value, given);
    }
    if (decl_.light_lists) lightLists(*decl_.light_lists);
    for (const PortDecl& port : decl_.ports) port_[port.slot] = true;
    for (const OutputDecl& output : decl_.outputs) {
      if (output.value) this->output(output);
    }
    // A port's default may use the ports before it, in its place.
    for (size_t i = decl_.ports.size(); i > 0; --i) {
      PortDecl& port = decl_.ports[i - 1];
      if (port.default_value)
        tiesOf(*port.default_value, {port.inherited, refused_[port.slot], unmade_[port.slot]});
      port.refused = refused_[port.slot] | unmade_[port.slot];
    }
  }

private:
  /// Where an expression stands.
  struct Place {
    bool inherited = false;  ///< in the text of a template that this one extends
    Ties refused = 0;        ///< what the caller reports
    Ties unmade = 0;         ///< what cannot be made there: reported where it stands
    bool position = false;   ///< not in interpolate(), but in a position
  };

  void inputs() {
    for (const BlockDecl& block : decl_.blocks) {
      const Ties ties = block.role == BlockRole::Lights ? kLight : Ties{0};
      for (const BlockFieldDecl& field : block.fields)
        std::fill_n(ties_.begin() + field.slot, field.elements(), ties);
    }
    // Without a vertex stage the attributes come to the fragment as they are.
    for (const AttributeDecl& attribute : decl_.attributes) {
      if (!attribute.fact) ties_[attribute.slot] = vertex_stage_ ? kVertex : kFragment;
    }
    if (decl_.front_facing) ties_[*decl_.front_facing] = kFragment;
  }

  /// Adds the attributes that an expression reads. An optional one is asked for first, so it is not needed.
  void needs(const Expr& expr, GivenDecl& given) {
    std::vector<uint16_t>& needed = given.attributes;
    const auto add = [&](uint16_t attribute) {
      const auto place = std::lower_bound(needed.begin(), needed.end(), attribute);
      if (place == needed.end() || *place != attribute) needed.insert(place, attribute);
    };
    if (expr.kind == Expr::Kind::Slot) {
      for (size_t i = 0; i < decl_.attributes.size(); ++i) {
        const AttributeDecl& attribute = decl_.attributes[i];
        if (!attribute.optional && attribute.slot == expr.slot) add(static_cast<uint16_t>(i));
      }
      for (const GivenDecl& other : decl_.givens) {
        if (&other == &given) break;
        if (expr.slot < other.slot || expr.slot >= other.slot + other.results.size()) continue;
        for (const uint16_t attribute : other.attributes) add(attribute);
      }
    }
    for (const ExprPtr& arg : expr.args) {
      if (arg) needs(*arg, given);
    }
  }

  void lightLists(const LightListsDecl& lists) {
    if (!lists.index) return;
    const Ties ties = tiesOf(*lists.index, {lists.inherited});
    if ((ties & (kLight | kVertex)) == 0) return;
    reporter_.error(
        (ties & kLight) != 0 ? "one-light" : "one-vertex", lists.inherited ? decl_.span : lists.span,
        "the number of the range is that of a fragment",
        "write interpolate(...) around what differs from vertex to vertex; it may not rest on a light");
  }

  void output(const OutputDecl& output) {
    // A displacement is made of what is interpolated as it is before that: lowering sees to it.
    const bool displaces = output.role == OutputRole::Displacement;
    const bool vertex = output.role == OutputRole::Position || displaces;
    const Place place{output.inherited, vertex ? kLight : Ties{kLight | kVertex},
                      vertex && !displaces ? kFragment : Ties{0}, vertex};
    const Ties ties = tiesOf(*output.value, place);
    const Span span = output.inherited ? decl_.span : output.span;
    if ((ties & kLight) != 0) {
      reporter_.error("one-light", span, fmt::format("'{}' is the value of one light", output.name),
                      "write sum_over_lights(...) around what differs from light to light");
    }
    if ((ties & kVertex) != 0 && !vertex) {
      reporter_.error("one-vertex", span, fmt::format("'{}' is the value of one vertex", output.name),
                      "write interpolate(...) around what differs from vertex to vertex");
    }
  }

  /// The ties of an expression. What is refused where the expression stands is refused to the ports in it.
  Ties tiesOf(const Expr& root, const Place& place) {
    struct Open {
      const Expr* expr;
      Ties untied;
      Place place;
    };
    Ties ties = 0;
    std::vector<Open> open = {{&root, 0, place}};
    while (!open.empty()) {
      auto [expr, outer, here] = open.back();
      open.pop_back();
      if (expr == nullptr) continue;
      if (expr->kind == Expr::Kind::Slot && expr->slot < ties_.size()) {
        ties |= ties_[expr->slot] & static_cast<Ties>(~outer);
        if (port_[expr->slot]) {
          refused_[expr->slot] |= here.refused;
          unmade_[expr->slot] |= here.unmade;
        }
        unmade(*expr, ties_[expr->slot], here);
      }
      const Ties untied = untiedBy(*expr);
      here.refused &= static_cast<Ties>(~untied);
      if (const std::optional<ir::Op> op = opOf(*expr)) {
        ties |= tiedBy(*op);
        unmade(*expr, tiedBy(*op), here);
        here.unmade &= static_cast<Ties>(~untied);
        if (*op == ir::Op::Interpolate) {
          here.unmade |= kFragment | kLight;
          here.position = false;
        }
      } else {
        here.unmade &= static_cast<Ties>(~untied);
      }
      for (const ExprPtr& arg : expr->args)
        open.push_back({arg.get(), static_cast<Ties>(outer | untied), here});
    }
    return ties;
  }

  void unmade(const Expr& expr, Ties ties, const Place& place) {
    ties &= place.unmade;
    if (ties == 0) return;
    const std::string_view what =
        (ties & kFragment) != 0 ? "this is one of the fragment" : "this is one of a light";
    reporter_.error(
        "wrong-rate", place.inherited ? decl_.span : expr.span,
        fmt::format("{}, and {}",
                    place.position ? "a position is a value of the vertex"
                                   : "interpolate() takes values of the vertex",
                    what),
        (ties & kFragment) != 0
            ? "made at the vertices: what has no interpolate(), sum_over_lights(), dFdx(), dFdy() "
              "and gl_FrontFacing in it"
            : "write interpolate(...) around what does not differ from light to light");
  }

  TemplateDecl& decl_;
  Reporter& reporter_;
  bool vertex_stage_;
  // By slot.
  std::vector<Ties> ties_;
  std::vector<bool> port_;     ///< it is a port
  std::vector<Ties> refused_;  ///< of a port: ties under which it is used without being untied
  std::vector<Ties> unmade_;   ///< of a port: ties that cannot be made where it is used
};

}  // namespace

void tie(TemplateDecl& decl, Reporter& reporter) { Tying(decl, reporter).run(); }

std::optional<GivenResult> TemplateDecl::find(std::string_view given) const {
  const size_t dot = given.find('.');
  const std::string_view head = given.substr(0, dot);
  for (const GivenDecl& decl : givens) {
    if (decl.name != head) continue;
    if (decl.multiple == (dot == std::string_view::npos)) return std::nullopt;
    if (!decl.multiple) return GivenResult{&decl, 0};
    for (size_t i = 0; i < decl.results.size(); ++i) {
      if (decl.results[i].name == given.substr(dot + 1)) return GivenResult{&decl, i};
    }
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace lacquer::lang
