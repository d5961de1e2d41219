// What a document has of patterns as groups of a graph: each nodegraph is a group, each definition with a
// graph of its own, too.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "graph/graph.h"
#include "lang/library.h"
#include "materialx/flaws.h"
#include "mtlx/element.h"
#include "mtlx/names.h"
#include "mtlx/values.h"

namespace lacquer::materialx {

struct PatternOptions {
  bool editable = true;                              ///< numbers become parameters of the graph
  uint64_t most = 0;                                 ///< nodes of all bodies together
  std::set<std::string, std::less<>> animated = {};  ///< JSON pointers of inputs whose numbers change
  std::set<std::string, std::less<>> reserved = {};  ///< names that no parameter may have
  bool has_attributes = false;  ///< primitives have what the documents read of them; else a file says it
  /// Definitions that hold where the documents have none, and whose own numbers are no parameters; or null.
  const Element* models = nullptr;
  /// Definitions that hold as the documents' own where these have none of the name; or null.
  const Element* definitions = nullptr;
};

/// Among the elements of PatternOptions::definitions: a warning of one of its files, which is told where
/// something of the file is used.
inline constexpr std::string_view kWarning = "said:warning";

/// The error of a connection that names none of the outputs of what it is connected to.
Diagnostic unnamedOutput(const Element& at, std::string_view name, std::span<const std::string_view> outputs);
/// The names of a nodegraph's or a definition's outputs.
std::vector<std::string_view> outputsOf(const Element& interface);

enum class Alpha : uint8_t { Opaque, Mask, Blend };

/// The nodes of one body while it is made: of a group, whose elements stand beside each other.
class Scope {
public:
  const Element& owner() const { return *owner_; }
  graph::Group& group() { return group_; }
  /// The surface that the body is of: its node is called as its category, so that materials alike have one
  /// shader.
  void nameSurface(const Element& surface) { surface_ = &surface; }
  /// Of the interface; null where there is none of that name.
  const Element* input(std::string_view name) const {
    const auto it = inputs_.find(name);
    return it == inputs_.end() ? nullptr : it->second;
  }

private:
  friend class Patterns;
  const Element* owner_ = nullptr;
  const Element* interface_ = nullptr;  ///< whose inputs the group has; null for none
  const Element* surface_ = nullptr;
  bool model_ = false;  ///< of PatternOptions::models
  graph::Group group_;
  const Siblings* siblings_ = nullptr;
  Siblings inputs_;                                      ///< of the interface
  std::set<std::string, std::less<>> demanded_;          ///< outputs
  std::unordered_map<const Element*, std::string> ids_;  ///< looked up, never walked
  NameSet taken_;
  std::vector<const Element*> pending_;
  std::vector<const Element*> elements_;  ///< of the group's nodes
};

class Patterns {
public:
  /// `documents`: elements whose children are nodegraphs and definitions. They and the library live longer.
  Patterns(const std::vector<const Element*>& documents, const lang::Library& library,
           PatternOptions options);

  /// The group of a nodegraph: its name. finish() makes of its body what is asked for.
  const std::string& group(const Element& nodegraph);
  /// A body of its own, beside the elements of `owner`, with the inputs of `owner` if it is a nodegraph. It
  /// lives as long as this.
  Scope& body(const Element& owner, std::string_view name);
  /// Where a value of an input comes from, in a body; of a closure that part of it. Nothing, and an error,
  /// where that cannot be said.
  std::optional<graph::Source> connected(Scope& scope, const Element& input, std::string_view part = {});
  /// A part of what a node of a body gives, which is a closure.
  std::optional<graph::Source> closure(Scope& scope, const Element& node, std::string_view part);
  /// Whether a node is there that gives closures: of the library or of the document.
  bool givesClosure(const Element& node) const;
  /// What a surface made of closures is to what is behind it, whatever its numbers become.
  Alpha alphaOf(const Element& surface);
  /// The `surface_unlit` that a surface beside the nodes of `owner` is by its definition; null for others.
  const Element* unlit(const Element& owner, const Element& surface);
  /// The model of a surface; null where the document has a definition, or there is none.
  const Element* modelOf(const Element& surface) const;
  /// The unit of an input of a surface that there is a model for; empty where it says none.
  std::string_view unitOf(const Element& surface, std::string_view input) const;
  /// A node of the library in a body.
  graph::Source add(Scope& scope, std::string_view name, std::string type, graph::Inputs inputs);
  /// The node of that name among the children of an element; null for none.
  const Element* nodeOf(const Element& owner, std::string_view name);
  /// The node or output that an input is connected to, through outputs of its scope; null for none.
  const Element* upstream(const Scope& scope, const Element& input) const;
  /// The nodegraph that an input is connected to; null for none.
  const Element* nodegraph(const Scope& scope, const Element& input) const;
  /// A node of a body that the document has not: what it gives. It lives as long as this.
  std::optional<graph::Source> insert(Scope& scope, Element element);
  static std::optional<Diagnostic> wrongType(const Element& input, const Element& port);

  /// Asks for every output of every definition of PatternOptions::definitions.
  void demandAll();
  /// Makes the bodies of all groups that were asked for, and checks them. Afterwards wrong() is whole.
  void finish();
  const Diagnostics& wrong() const { return wrong_; }
  /// Whether a group, or one that it has, is wrong.
  bool isWrong(const std::string& group) const { return broken_.contains(group); }
  graph::Graph& graph() { return graph_; }
  const Units& units() const { return units_; }
  const Element* definitionOf(const Element& node) const;

private:
  struct Definition {
    const Element* nodedef = nullptr;
    const Element* graph = nullptr;  ///< null for code
    bool model = false;              ///< of PatternOptions::models
  };
  struct Referred {
    const Element* element = nullptr;
    std::string output, swizzle;
    std::string part = {};  ///< of a closure
  };

  void define();
  void define(const Element& nodedef, const Element& graph);
  void defineFrom(const Element& document);
  bool isReplaced(const Element& nodedef) const;
  void findFlaws();
  void checkDefinition(const Element& nodedef);
  void tellWarnings();
  std::vector<size_t> definitionsCalled(const Element& node) const;
  const Element* definitionNamed(const Element& node) const;
  std::vector<const Element*> definitionsOf(const Element& node) const;
  const Element* innermost(const Element& surface);
  void checkVersion(const Element& node);
  bool isOfTarget(const Element& nodedef);
  bool isOfTarget(const Element& node, const Element& input) const;
  const Element& withoutTargets(const Element& node);
  bool isKnown(const Element& nodedef) const;
  const Element* merged(const Element& nodedef, size_t depth);
  void prepare(Scope& scope, const Element& owner, const Element* inputs, std::string_view name);
  void groupInputs(Scope& scope);
  void work(Scope& scope);
  void demand(const Element& nodegraph, std::string_view output, const Element& at);
  void output(Scope& scope, std::string_view name, const Element& at);
  void node(Scope& scope, const Element& element);
  void instance(Scope& scope, const Element& element, const Element& interface, graph::Node& node);
  void modelInputs(Scope& scope, const Element& element, const Element& interface, graph::Node& node);
  std::optional<graph::Source> modelNumber(Scope& scope, const Element& element, const Element& input,
                                           const Element& port);
  void libraryNode(Scope& scope, const Element& element, graph::Node& node);
  void withoutFiles(Scope& scope, const Element& element, const lang::NodeDecl& form, graph::Node& node);
  void surroundings(Scope& scope, const Element& element, const lang::NodeDecl& form, graph::Node& node);
  bool hasOneRoughness(const Scope& scope, const Element& element) const;
  std::optional<graph::Source> literal(Scope& scope, const Element& element, const Element& input,
                                       const lang::Param& param);
  std::optional<graph::Source> matrix(Scope& scope, const Element& element, const Element& input,
                                      ir::Type type);
  std::optional<graph::Source> attribute(Scope& scope, const Element& element, const Element& input,
                                         const lang::Param& param);
  /// A node that samples an image, and what it stands in.
  struct Sampling {
    Scope* scope;
    const Element* node;
  };
  Sampling samplingOf(Scope& body, const Element& input);
  std::optional<graph::Source> image(Scope& scope, const Sampling& by, const Element& input, bool tiles,
                                     std::vector<const Element*> holders);
  std::string_view choice(Scope& scope, const Element& element, std::string_view name,
                          std::span<const std::string_view> words);
  double unitsOf(Scope& scope, const Element& element);
  void putBehind(Scope& scope, const Element& element, graph::Node& made, std::string type,
                 graph::Inputs inputs);
  std::string_view endsOf(Scope& scope, const Element& element);
  const Element* text(Scope& within, const Element& input);
  const Element* propertyOf(const Element& node, std::string_view name);
  /// Texts and attributes of files that instances give a definition. Each choice of them makes a nodegraph.
  struct Given {
    struct OfFile {
      std::string_view input, attribute, value;
    };
    std::vector<std::pair<const Element*, std::string>> texts;  ///< of ports
    std::vector<OfFile> files;
  };
  const Element* definitionFor(Scope& scope, const Element& element);
  const Element* definitionWith(const Element& nodedef, const Given& given, const Element& at);
  bool takesTiles(std::string_view category) const;
  bool isOfInstances(const Scope& scope, const Element& input) const;
  bool hasTiles(Scope& scope, const Element& node, const Element& input);
  bool goesToTiles(const Element& owner, std::string_view name) const;
  void withoutGraph(const Element& at, const Element& nodedef);
  void checkDeclared(const Element& nodedef, const Element& graph, std::string_view name);
  bool namesOutput(const Element& input, const Referred& referred, std::span<const std::string_view> outputs);
  static std::string_view outputNameOf(const Element& interface, std::string_view name);
  std::string_view givenType(const Scope& scope, const Element& port) const;
  void checkPort(const Scope& scope, const Element& port);
  bool hasType(const Element& element);
  bool isOfKind(const Element& input, const Referred& referred);
  struct OfGeometry {
    std::string node, space;
    std::string index = {};
    std::string given;  ///< what the template has for it; empty where the node computes it
  };
  std::optional<OfGeometry> geometryOf(std::string_view name) const;
  const Element* propertyNamed(std::string_view name) const;
  std::optional<OfGeometry> ofGeometry(const Element& input);
  const Element& standardProperty(Scope& scope, const Element& element);
  std::optional<graph::Source> refer(Scope& scope, const Element& input, Referred referred, size_t depth);
  std::optional<Referred> find(const Scope& scope, const Element& input);
  const lang::NodeDecl* formOf(Scope& scope, const Element& element);
  const std::string& idOf(Scope& scope, const Element& element);
  std::string parameterName(const std::string& wish, ir::Type type);
  graph::Parameter& parameter(const Scope& scope, const Element& element, const Element& input,
                              ir::Type type);
  bool isAnimated(const Element& input) const;
  std::string fileOf(const Scope& scope, std::vector<const Element*> owners, const Element& input);
  const Element* tokenOf(const Scope& scope, const Element& token);
  void checkTokens(const Element& input, std::string_view file);
  void defineTokens();
  std::string withGeometryTokens(std::string_view file) const;
  void unknownNode(const Element& element);
  void checked();
  void spread();

  const Siblings& siblingsOf(const Element& owner);
  const std::vector<const Element*>& inputElements(const Element& owner);
  const Definition* definition(const Element& nodedef) const;
  template <class Wanted>
  std::string suggest(std::string_view name, const Element& owner, Wanted wanted);
  bool maySuggest() { return ++suggestions_ <= 20; }  // each looks at every name that there is
  void error(const Element& at, std::string code, std::string message, std::string help = {});
  void warning(const Element& at, std::string code, std::string message, std::string help = {});

  const lang::Library& library_;
  PatternOptions options_;
  std::vector<const Element*> documents_;
  Units units_;
  std::vector<Definition> definitions_;
  std::deque<Element> merged_, made_;
  std::map<const Element*, const Element*> merges_;
  graph::Graph graph_;
  std::deque<Scope> scopes_;
  std::unordered_map<const Element*, Scope*> groups_;  ///< looked up, never walked
  NameSet group_names_, parameter_names_, texture_names_;
  std::unordered_map<const Element*, Siblings> siblings_;                   ///< of owners
  std::unordered_map<const Element*, std::vector<const Element*>> inputs_;  ///< of interfaces
  Siblings nodegraphs_, nodedefs_, geomprops_;                              ///< of the documents
  std::unordered_map<std::string_view, const Element*> bodies_;             ///< by the definition
  std::map<std::string_view, std::string_view> geometry_tokens_;
  std::map<std::string_view, const Element*> of_targets_;  ///< definitions for a target, by their nodes
  /// Nodes and inputs that these have.
  std::set<std::pair<std::string_view, std::string_view>> inputs_of_targets_;
  /// Looked up, never walked.
  std::unordered_map<std::string_view, std::vector<size_t>> definitions_of_;
  std::unordered_map<const Element*, size_t> by_nodedef_, by_graph_;
  std::vector<Flaw> flaws_;
  std::unordered_map<std::string_view, std::vector<size_t>> flaws_of_;  ///< by the nodedef
  std::set<size_t> told_;                                               ///< flaws of what is used
  std::set<std::string, std::less<>> used_files_;                       ///< of definitions
  size_t suggestions_ = 0;
  size_t samplings_ = 0;  ///< definitions that a file is being handed down through
  std::map<std::string, const Element*> with_texts_;  ///< definitions, by their names and their texts
  uint64_t copied_ = 0;                               ///< elements of nodegraphs of these
  std::map<std::string, std::string> textures_;       ///< by all that is said of one
  struct Demand {
    Scope* scope;
    std::string output;
    const Element* at;
  };
  std::vector<Demand> demands_;  ///< outputs of groups that something takes
  std::vector<Scope*> dirty_;    ///< with pending nodes
  uint64_t count_ = 0;           ///< of nodes
  Scope* now_ = nullptr;
  std::set<std::string, std::less<>> broken_;
  Diagnostics wrong_;
};

/// A name of the graph: letters, digits and single underscores.
std::string graphName(std::string_view name);

}  // namespace lacquer::materialx
