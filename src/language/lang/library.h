// The library of constants, nodes and templates: one namespace over many files.
//
// Building it only finds where each declaration stands. A declaration is parsed and checked when it is first
// asked for, together with what it calls, and kept. Lookups may run on several threads at once; add() may not
// run beside them. Declarations live, and do not move, as long as the library.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lang/ast.h"
#include "lang/model_decl.h"
#include "support/diagnostic.h"

namespace lacquer::lang {

struct SourceFile {
  std::string name;  ///< as diagnostics show it
  std::string text;
};

enum class DeclKind : uint8_t { Const, Node, Template, Extension, Part, Profile, Lod, Layers, Switch };

/// What a template gives to graphs, by the names that they write: "uv0", "light_sample.L".
struct GivenNames {
  std::vector<std::string> names;
  Origin origin;  ///< of the template
};

class Library {
public:
  /// Fails when a declaration's head cannot be found or a name is declared twice.
  static Result<Library> fromFiles(std::vector<SourceFile> files);

  /// nodes/ and templates/ as they were at build time. Of nodes/standard/ only the names are known at first:
  /// a file of it is scanned when one of its nodes or constants is named, or when all names are asked for.
  static Library embedded();

  Library(Library&&) noexcept;
  Library& operator=(Library&&) noexcept;
  ~Library();

  /// More files, as for `--nodes DIR`. On an error the library stays as it was.
  Result<void> add(std::vector<SourceFile> files);

  // Files that declare extensions have constants, nodes and parts of their own: where two of them say one
  // name, it means to each its own, and to all others "EXTENSION.name". `vendor`: in whose file it is said,
  // as Origin has it.
  Result<const ConstDecl*> constant(std::string_view name, std::string_view vendor = {}) const;
  /// A node, of several under one name by all of its types: "add<vec3>".
  Result<const NodeDecl*> node(std::string_view name, std::string_view vendor = {}) const;
  /// The same where parameters and results are all that is looked at: bodies and variants of the library's
  /// own nodes are there only once node() was asked for them.
  Result<const NodeDecl*> signature(std::string_view name, std::string_view vendor = {}) const;
  /// The nodes of a name: one, or its forms, or none. Each has its parameters and results with their types
  /// and whether there is a default (`default_syntax`); all else is there once node() has checked it.
  /// Behind the name may stand the first of the types that tell its forms apart: "convert<vec3>".
  std::vector<const NodeDecl*> forms(std::string_view family) const;
  Result<const TemplateDecl*> template_(std::string_view name) const;
  /// As they are written, also where something in them is wrong: for the names that others may use. Null
  /// where there is none, or where it does not parse.
  const TemplateDecl* writtenTemplate(std::string_view name) const;
  /// Of a template that is wrong as well, where it parses. Of the library's own what it adds to those that it
  /// extends.
  GivenNames givenNames(std::string_view name_of_template) const;
  /// Whether nothing was added to the library's own files, which are right.
  bool isBuiltIn() const;
  const ExtensionDecl* writtenExtension(std::string_view name) const;
  Result<const ExtensionDecl*> extension(std::string_view name) const;
  Result<const PartDecl*> part(std::string_view name, std::string_view vendor = {}) const;
  Result<const ProfileDecl*> profile(std::string_view name) const;
  Result<const ProfileDecl*> lod(std::string_view name) const;
  Result<const LayersDecl*> layers(std::string_view name) const;
  Result<const SwitchDecl*> switch_(std::string_view name) const;

  /// The last template that says `default;`, in the order of the files: what is added comes after what is
  /// there.
  Result<std::string> defaultTemplate() const;

  /// The profile that says `default`, by its head alone: it may be wrong elsewhere. Fails where there is
  /// none, or more than one.
  Result<std::string> defaultProfile() const;

  bool has(DeclKind kind, std::string_view name, std::string_view vendor = {}) const;

  /// The declared names of that kind, sorted; of nodes that share a name those with their types.
  std::vector<std::string_view> names(DeclKind kind) const;

  /// Parses and checks everything; empty when all is well.
  Diagnostics checkAll() const;

private:
  class Impl;
  explicit Library(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lacquer::lang
