// A declaration of the library from its text: parsed, and checked with all that it uses, when it is asked
// for.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lang/builtins.h"
#include "lang/library_impl.h"
#include "lang/parser.h"
#include "lang/suggest.h"
#include "lang/words.h"
#include "support/say_once.h"

namespace lacquer::lang {

namespace {

/// How deep declarations may use each other: checking one checks what it uses first.
constexpr size_t kLongestChain = 256;

/// Whether declarations of that kind say how a material becomes a graph.
bool isModel(DeclKind kind) {
  return kind == DeclKind::Part || kind == DeclKind::Profile || kind == DeclKind::Lod;
}

/// Gives a signature its bodies. Other threads may read its parameters meanwhile.
void complete(NodeDecl& signature, NodeDecl whole) {
  signature.body = std::move(whole.body);
  signature.variants = std::move(whole.variants);
  signature.assumptions = std::move(whole.assumptions);
  signature.weight = whole.weight;
  signature.height = whole.height;
  signature.unties = whole.unties;
}

}  // namespace

Origin originOf(const Entry& entry) {
  return {entry.file->name, entry.line, entry.file->vendor, entry.file->builtIn()};
}

/// Its body, which begins behind the first brace that follows its name, is not looked at.
NodeDecl Library::Impl::parseHead(const Entry& entry, Reporter& reporter,
                                  std::vector<std::string_view>* read) {
  const size_t brace = entry.file->text.find('{', entry.name_begin);
  const auto end = static_cast<uint32_t>(std::min<size_t>(brace, entry.end));
  Parser parser(reporter, entry.begin, end, entry.bindings);
  NodeDecl head = parser.nodeHead();
  head.name = entry.name;
  head.origin = originOf(entry);
  if (read != nullptr) *read = parser.namesRead();
  return head;
}

/// Null where it is to be checked whole: where its text is a user's, in which something may be wrong.
const NodeDecl* Library::Impl::signature(Entry& entry) {
  if (!entry.file->builtIn() || entry.state == Entry::State::Open) return nullptr;
  if (entry.node) return entry.node.get();
  Reporter reporter(entry.file->name, entry.file->text);
  std::vector<std::string_view> read;
  auto head = std::make_unique<NodeDecl>(parseHead(entry, reporter, &read));
  for (const std::string_view name : read) {
    if (Entry* constant = find(DeclKind::Const, name, entry.file->vendor)) demand(*constant);
  }
  if (reporter.count() == 0) Checker(reporter, *this).signature(*head);
  if (reporter.count() != 0) return nullptr;
  entry.node = std::move(head);
  entry.signature = true;
  return entry.node.get();
}

const TemplateDecl& Library::Impl::outline(Entry& entry) {
  if (!entry.outline) {
    Reporter silent(entry.file->name, entry.file->text);
    entry.outline = std::make_unique<TemplateDecl>(Parser(silent, entry.begin, entry.end).templateDecl());
  }
  return *entry.outline;
}

GivenNames Library::Impl::givenNames(std::string_view name_of_template) {
  GivenNames given;
  Entry* entry = find(DeclKind::Template, name_of_template);
  if (entry == nullptr) return given;
  given.origin = originOf(*entry);
  const auto add = [&](const TemplateDecl& decl, auto resultsOf) {
    for (const EnvironmentDecl& one : decl.environments) given.names.emplace_back(one.name);
    for (const GivenDecl& one : decl.givens) {
      const std::vector<Param>* several = resultsOf(one);
      if (several == nullptr) given.names.emplace_back(one.name);
      if (several == nullptr) continue;
      for (const Param& result : *several) given.names.push_back(fmt::format("{}.{}", one.name, result.name));
    }
  };
  if (entry->file->builtIn() && entry->state == Entry::State::Fresh) {
    // Nothing has to be checked to find the names: a call of a node with several results gives them all.
    add(outline(*entry), [&](const GivenDecl& one) {
      const bool called = !one.has_type && one.value && one.value->kind == Expr::Kind::Call;
      Entry* node = called ? find(DeclKind::Node, one.value->name) : nullptr;
      const NodeDecl* head = node == nullptr ? nullptr : signature(*node);
      return head == nullptr || head->results.size() < 2 ? nullptr : &head->results;
    });
    return given;
  }
  demand(*entry);
  if (!entry->parsed) return given;
  add(*entry->template_decl, [](const GivenDecl& one) { return one.multiple ? &one.results : nullptr; });
  return given;
}

void Library::Impl::check(Entry& entry, Reporter& reporter) {
  Checker checker(reporter, *this);
  switch (entry.kind) {
    case DeclKind::Const: checker.constant(*entry.constant); break;
    case DeclKind::Node: checker.node(*entry.node); break;
    case DeclKind::Template: {
      std::vector<TemplateDecl> bases;
      if (!basesOf(entry, reporter, bases)) break;
      checker.templateDecl(*entry.template_decl, std::move(bases));
      if (reporter.count() == 0) tie(*entry.template_decl, reporter);
      break;
    }
    case DeclKind::Extension: checker.extension(*entry.extension); break;
    case DeclKind::Part: checker.part(*entry.part); break;
    case DeclKind::Profile:
    case DeclKind::Lod: checker.profile(*entry.profile, kindName(entry.kind)); break;
    case DeclKind::Layers:
    case DeclKind::Switch: break;
  }
}

/// What the template extends, parsed again: a template has its own copy of the parts, with its own slots.
/// False when there is no such base, or it is wrong itself.
bool Library::Impl::basesOf(const Entry& entry, Reporter& reporter, std::vector<TemplateDecl>& bases) {
  const std::string_view name = entry.template_decl->base;
  if (name.empty()) return true;
  const Span span{static_cast<uint32_t>(name.data() - entry.file->text.data()),
                  static_cast<uint32_t>(name.size())};
  const Entry* base = find(DeclKind::Template, name);
  if (base == nullptr) {
    reporter.error("unknown-template", span, fmt::format("there is no template '{}'", name),
                   didYouMean(name, names(DeclKind::Template)));
    return false;
  }
  if (base->state == Entry::State::Open) {
    reporter.error("recursion", span, fmt::format("'{}' extends itself: {}", name, cycle(name)));
    return false;
  }
  if (!base->good) return false;
  for (; base != nullptr; base = find(DeclKind::Template, bases.front().base)) {
    Reporter silent(base->file->name, base->file->text);
    bases.insert(bases.begin(), Parser(silent, base->begin, base->end).templateDecl());
  }
  return true;
}

/// Parses the declaration, and checks what it uses, then itself.
void Library::Impl::demand(Entry& entry) {
  if (entry.state != Entry::State::Fresh) return;
  entry.state = Entry::State::Open;
  open_.push_back(&entry);
  Reporter reporter(entry.file->name, entry.file->text);
  std::unique_ptr<NodeDecl> signature;  // others have it already
  if (entry.signature) signature = std::move(entry.node);
  entry.signature = false;
  parse(entry, reporter);
  if (reporter.count() == 0 && open_.size() > kLongestChain) {
    reporter.error("too-deep", {entry.name_begin, static_cast<uint32_t>(entry.said.size())},
                   fmt::format("more than {} declarations use each other in a chain", kLongestChain));
  }
  bool good = true;
  entry.parsed = reporter.count() == 0;
  if (entry.parsed) {
    for (Entry* used : entry.uses) {
      demand(*used);
      good = good && used->good;
    }
    check(entry, reporter);
    // Forms are chosen as it is checked.
    for (const Entry* used : entry.uses) good = good && used->good;
  }
  // Of a part's nodes each call is looked at by itself, so that one which is wrong hides nothing in other
  // lines.
  entry.good = (good || entry.kind == DeclKind::Part) && reporter.count() == 0;
  entry.diagnostics = reporter.take();
  if (signature) {
    complete(*signature, std::move(*entry.node));
    entry.node = std::move(signature);
  }
  entry.state = Entry::State::Done;
  open_.pop_back();
}

void Library::Impl::parse(Entry& entry, Reporter& reporter) {
  Parser parser(reporter, entry.begin, entry.end, entry.bindings);
  const Origin origin = originOf(entry);
  switch (entry.kind) {
    case DeclKind::Const:
      entry.constant = std::make_unique<ConstDecl>(parser.constant());
      entry.constant->origin = origin;
      break;
    case DeclKind::Node:
      entry.node = std::make_unique<NodeDecl>(parser.node());
      entry.node->origin = origin;
      entry.node->name = entry.name;
      break;
    case DeclKind::Template:
      entry.template_decl = std::make_unique<TemplateDecl>(parser.templateDecl());
      entry.template_decl->origin = origin;
      break;
    case DeclKind::Extension:
      entry.extension = std::make_unique<ExtensionDecl>(parser.extension());
      entry.extension->origin = origin;
      break;
    case DeclKind::Part:
      entry.part = std::make_unique<PartDecl>(parser.part());
      entry.part->origin = origin;
      entry.part->name = entry.name;
      break;
    case DeclKind::Profile:
    case DeclKind::Lod:
      entry.profile = std::make_unique<ProfileDecl>(parser.profile());
      entry.profile->origin = origin;
      break;
    case DeclKind::Layers:
      entry.layers = std::make_unique<LayersDecl>(parser.layers());
      entry.layers->origin = origin;
      break;
    case DeclKind::Switch:
      entry.switch_decl = std::make_unique<SwitchDecl>(parser.switchDecl());
      entry.switch_decl->origin = origin;
      break;
  }
  const auto use = [&](std::string_view name, DeclKind kind) {
    // What is built in is meant in bodies; a node of such a name is for graphs.
    if (kind == DeclKind::Node && findFunction(name) != nullptr) return;
    Entry* used = find(kind, name, entry.file->vendor);
    // A part's lines are made nodes of a graph, which ask for their bodies themselves.
    if (used != nullptr && kind == DeclKind::Node && isModel(entry.kind) && used->file->builtIn()) return;
    if (used == nullptr || std::find(entry.uses.begin(), entry.uses.end(), used) != entry.uses.end()) return;
    entry.uses.push_back(used);
  };
  if (entry.template_decl && !entry.template_decl->base.empty())
    use(entry.template_decl->base, DeclKind::Template);
  for (const std::string_view name : parser.namesRead()) use(name, DeclKind::Const);
  for (const std::string_view name : parser.namesCalled()) use(name, DeclKind::Node);
}

void Library::Impl::collect(Entry& entry, std::unordered_set<const Entry*>& seen, Diagnostics& out) {
  if (!seen.insert(&entry).second) return;
  addOnce(out, entry.diagnostics);
  for (Entry* used : entry.uses) collect(*used, seen, out);
}

}  // namespace lacquer::lang
