// MaterialX documents, and glTF files with procedural textures, as materials: what is said of them, their
// properties, and the groups that compute their texels.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

#include "graph/graph.h"
#include "material/material.h"
#include "materialx/materialx.h"
#include "model/build.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

std::string formatAll(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + "\n";
  return text;
}

struct CaseLibrary {
  explicit CaseLibrary(materialx::Definitions definitions = {}) : models(library, std::move(definitions)) {}

  lang::Library library = withNodes();
  model::Models models;

  static lang::Library withNodes() {
    lang::Library library = lang::Library::embedded();
    const auto added =
        library.add({{"library.node", readFile(sourceFolder() / "tests/materialx/library.node")}});
    EXPECT_TRUE(added) << formatAll(added ? Diagnostics() : added.error());
    return library;
  }
};

const CaseLibrary& caseLibrary() {
  static const CaseLibrary kLibrary;
  return kLibrary;
}

std::string numbers(std::span<const double> value, int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", value[static_cast<size_t>(i)]);
  return count == 1 ? text : "(" + text + ")";
}

std::string shown(const graph::Source& source) {
  const auto* node = std::get_if<graph::NodeRef>(&source.from);
  const auto* parameter = std::get_if<graph::ParameterRef>(&source.from);
  const auto* texture = std::get_if<graph::TextureRef>(&source.from);
  const auto* given = std::get_if<graph::GivenRef>(&source.from);
  const auto* input = std::get_if<graph::InputRef>(&source.from);
  const auto* choice = std::get_if<graph::Choice>(&source.from);
  const auto* attribute = std::get_if<graph::AttributeRef>(&source.from);
  const auto* literal = std::get_if<graph::Literal>(&source.from);
  std::string text = node        ? node->node + (node->output.empty() ? "" : "." + node->output)
                     : parameter ? "$" + parameter->name
                     : texture   ? "texture " + texture->name
                     : given     ? "given " + given->name
                     : input     ? "input " + input->name
                     : choice    ? '"' + choice->name + '"'
                     : attribute ? "attribute " + attribute->name
                                 : numbers(literal->value, ir::componentCount(literal->type));
  return source.swizzle.empty() ? text : text + "." + source.swizzle;
}

std::string shown(const graph::Graph& patterns) {
  std::string text;
  for (const graph::Parameter& p : patterns.parameters)
    text += fmt::format("${} = {} ({}){}\n", p.name, numbers(p.numbers(), ir::componentCount(p.type)),
                        p.pointer, p.animated ? ", animated" : "");
  for (const graph::Texture& t : patterns.textures)
    text += fmt::format("texture {} = {}{}{}{}{}\n", t.name,
                        t.file.empty() ? fmt::format("{}", t.texture) : t.file, t.srgb ? ", srgb" : "",
                        t.wrap[0] == graph::Wrap::Repeat ? "" : ", u not repeated",
                        t.nearest ? ", nearest" : "", t.color ? ", default " + numbers(*t.color, 4) : "");
  for (const graph::Group& group : patterns.groups) {
    std::string inputs;
    for (const graph::GroupInput& input : group.inputs)
      inputs += fmt::format("{}{} = {}", inputs.empty() ? "" : ", ", input.name,
                            input.by_default ? shown(*input.by_default) : "nothing");
    text += fmt::format("group {}({})\n", group.name, inputs);
    for (const graph::Node& node : group.nodes) {
      std::string given;
      for (const auto& [name, source] : node.inputs)
        given += fmt::format("{}{}: {}", given.empty() ? "" : ", ", name, shown(source));
      text += fmt::format("  {} = {}{}({})\n", node.id, node.group ? "group " : "", node.type, given);
    }
    for (const auto& [name, source] : group.outputs)
      text += fmt::format("  out {} = {}\n", name, shown(source));
  }
  return text;
}

std::string shown(const GeometryNames& names) {
  std::string text;
  for (const std::string& path : names.paths) text += " " + path;
  return names.collection.empty() ? text : fmt::format("{} collection {}", text, names.collection);
}

std::string shown(const Looks& looks) {
  std::string text;
  const auto values = [&](const char* kind, const std::vector<GeometryValue>& list) {
    for (const GeometryValue& v : list)
      text += fmt::format("  {} {} {} = {}\n", kind, v.type, v.name, v.value);
  };
  for (const Look& look : looks.looks) {
    text += fmt::format("look {}\n", look.name);
    for (const MaterialAssignment& m : look.materials)
      text += fmt::format("  {}: material {}{} for{}\n", m.name, m.material, m.exclusive ? "" : ", not alone",
                          shown(m.geometry));
    for (const PropertyAssignment& p : look.properties)
      text +=
          fmt::format("  {} {} = {} ({}) for{}\n", p.type, p.property, p.value, p.target, shown(p.geometry));
    for (const VisibilityAssignment& v : look.visibility)
      text += fmt::format("  {}{} for{} by{}\n", v.type, v.visible ? "" : " not", shown(v.geometry),
                          shown(v.viewers));
  }
  for (const LookGroup& group : looks.groups) {
    text += fmt::format("group {}:", group.name);
    for (const std::string& look : group.looks) text += " " + look;
    text += group.by_default.empty() ? "\n" : fmt::format(", {} by default\n", group.by_default);
  }
  for (const GeometryCollection& collection : looks.collections)
    text +=
        fmt::format("collection {}:{} with{} without{}\n", collection.name, shown({collection.include, {}}),
                    shown({collection.collections, {}}), shown({collection.exclude, {}}));
  for (const GeometryInfo& info : looks.geometry) {
    text += fmt::format("geometry {}:{}\n", info.name, shown(info.geometry));
    values("property", info.properties);
    values("token", info.tokens);
  }
  for (const MaterialVariant& variant : looks.variants)
    text += fmt::format("material {} is {} with{}\n", variant.material, variant.of,
                        shown({variant.variants, {}}));
  return text;
}

std::string shown(const material::Material& material, const material::Schema& schema) {
  std::string text = fmt::format("-- {}\n", material.name) + formatAll(material.diagnostics);
  for (const auto& number : material.numbers) {
    const material::Property& property = schema.properties[number.property];
    const bool choice = property.decl->kind == material::Kind::Choice;
    text += fmt::format("{} = {}\n", property.path,
                        choice ? std::string(property.decl->choices[static_cast<size_t>(number.value[0])])
                               : numbers(number.value, ir::componentCount(property.decl->type)));
  }
  for (const auto& texture : material.textures)
    text += fmt::format("{} = {}\n", schema.properties[texture.property].path,
                        texture.info.group.empty() ? fmt::format("texture {}", texture.info.texture)
                                                   : texture.info.group + "." + texture.info.output);
  if (!material.displacement.empty()) text += "displaced by " + material.displacement + "\n";
  return text;
}

/// What is accepted has a graph that holds for every template of the library.
void buildAll(const material::Document& document, const CaseLibrary& with) {
  const Result<const model::Model*> model = with.models.of("khr");
  ASSERT_TRUE(model) << formatAll(model.error());
  for (const material::Material& material : document.materials) {
    if (hasError(material.diagnostics)) continue;
    for (const std::string_view name : {"forward", "surface", "bsdf"}) {
      model::BuildOptions options;
      options.template_name = name;
      if (name == "surface" && !material.closures.empty()) continue;  // it takes properties
      Diagnostics warnings;
      const auto graph = model::build(**model, **with.library.template_(name), material,
                                      {true, true, false, {true, true, false, false}}, options, warnings);
      ASSERT_TRUE(graph) << formatAll(graph.error());
      EXPECT_EQ(formatAll(graph::check(*graph, with.library)), "") << name;
    }
  }
}

/// The files of a section, each below a line `## NAME`.
std::vector<lang::SourceFile> filesOf(const std::string& section) {
  std::vector<lang::SourceFile> files;
  std::istringstream lines(section);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## "))
      files.push_back({line.substr(3), {}});
    else
      files.back().text += line + "\n";
  }
  return files;
}

void runWith(Case& c, const CaseLibrary& with, const std::string& name);

/// With a library of definitions: what is wrong with it, or what comes of the document.
void run(Case& c, const std::string& name) {
  if (!c.has("definitions")) return runWith(c, caseLibrary(), name);
  const auto definitions = materialx::readDefinitions(filesOf(c.section("definitions")), Limits{});
  if (!definitions) return c.expect("materials", formatAll(definitions.error()));
  const CaseLibrary with(*definitions);
  c.expect("checked", formatAll(materialx::checkDefinitions(*definitions, with.library, Limits{})));
  runWith(c, with, name);
}

void runWith(Case& c, const CaseLibrary& with, const std::string& name) {
  const Result<const material::Schema*> schema = with.models.schema();
  ASSERT_TRUE(schema) << formatAll(schema.error());
  std::vector<std::pair<std::string, std::string>> included;  // files beside the document
  if (c.has("included"))
    for (const lang::SourceFile& file : filesOf(c.section("included")))
      included.emplace_back(file.name, file.text);
  material::ReadOptions options;
  options.included = &included;
  const auto document = material::readText(c.input(), name, **schema, options);
  if (!document) return c.expect("materials", formatAll(document.error()));
  std::string text = formatAll(document->diagnostics);
  text += shown(document->looks);
  for (const material::Material& material : document->materials) text += shown(material, **schema);
  if (!document->materials.empty() && document->materials[0].patterns)
    text += shown(*document->materials[0].patterns);
  c.expect("materials", text);
  buildAll(*document, with);
}

const bool kDocuments = registerCases("MaterialX", sourceFolder() / "tests/materialx/cases", ".case",
                                      [](Case& c) { run(c, "case.mtlx"); });
const bool kProcedurals = registerCases("Procedurals", sourceFolder() / "tests/materialx/procedurals",
                                        ".case", [](Case& c) { run(c, "case.gltf"); });

}  // namespace
}  // namespace lacquer::test
