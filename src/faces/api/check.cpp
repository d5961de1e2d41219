// Node files of one's own, checked where they are to stand.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "api/part_lines.h"
#include "lacquer/check.h"
#include "lacquer/tools.h"
#include "lang/embedded.h"
#include "material/drawn.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/module.h"
#include "structures/describe.h"
#include "support/letters.h"

namespace lacquer {

namespace {

bool isWordLetter(char c) { return isLetterOrDigit(c) || c == '_' || c == '.'; }

/// How often each name stands in the files, outside of comments and texts in quotes. "coat.color.rgb" counts
/// for "coat.color.rgb", "coat.color" and "coat", and for each of its parts.
class WordCounts {
public:
  void add(std::string_view text) {
    for (size_t at = 0; at < text.size();) {
      if (text.substr(at, 2) == "//") {
        at = std::min(text.find('\n', at), text.size());
      } else if (text[at] == '"') {
        at = std::min(text.find_first_of("\"\n", at + 1), text.size() - 1) + 1;
      } else if (isWordLetter(text[at])) {
        const size_t begin = at;
        while (at < text.size() && isWordLetter(text[at])) ++at;
        word(text.substr(begin, at - begin));
      } else {
        ++at;
      }
    }
  }
  size_t count(std::string_view name) const {
    const auto it = counts_.find(name);
    return it == counts_.end() ? 0 : it->second;
  }

private:
  void word(std::string_view word) {
    for (size_t dot = word.find('.'); dot != std::string_view::npos; dot = word.find('.', dot + 1)) {
      ++counts_[std::string(word.substr(0, dot))];
      const size_t end = std::min(word.find('.', dot + 1), word.size());
      ++counts_[std::string(word.substr(dot + 1, end - dot - 1))];
    }
    ++counts_[std::string(word)];
  }

  std::map<std::string, size_t, std::less<>> counts_;
};

/// What is in the options' own files, within the whole library.
class OwnFiles {
public:
  OwnFiles(const Language& language, std::vector<lang::SourceFile> own)
      : language_(language), own_(std::move(own)) {
    for (const lang::EmbeddedFile& file : lang::embeddedNodes()) words_.add(file.text);
    for (const lang::EmbeddedFile& file : lang::embeddedTemplates()) words_.add(file.text);
    for (const lang::EmbeddedFile& file : lang::embeddedStandard().files) words_.add(file.text);
    for (const lang::SourceFile& file : own_) words_.add(file.text);
  }

  /// Warnings ("unused-name") of names that stand nowhere but where they are declared.
  Diagnostics unused() const {
    Diagnostics found;
    const auto plain = [&](lang::DeclKind kind, auto get, std::string_view what) {
      for (const std::string_view name : language_.names(kind)) {
        const auto decl = get(name);
        if (decl) unusedName(**decl, (*decl)->name, what, found);
      }
    };
    plain(
        lang::DeclKind::Const, [&](std::string_view name) { return language_.constant(name); }, "constant");
    plain(
        lang::DeclKind::Switch, [&](std::string_view name) { return language_.switch_(name); }, "switch");
    for (const std::string_view name : language_.names(lang::DeclKind::Node)) {
      const Result<const lang::NodeDecl*> decl = language_.node(name);
      // What has a category is for palettes.
      if (!decl || textOf((*decl)->origin.file) == nullptr || !(*decl)->category.empty()) continue;
      if (words_.count((*decl)->family) > language_.forms((*decl)->family).size()) continue;
      say(**decl, (*decl)->span, fmt::format("nothing calls the node '{}'", (*decl)->family),
          "say `category:` of a node that is for graphs alone", found);
    }
    for (const std::string_view name : language_.names(lang::DeclKind::Extension)) {
      const Result<const lang::ExtensionDecl*> decl = language_.extension(name);
      if (!decl || textOf((*decl)->origin.file) == nullptr) continue;
      for (const lang::PropertyDecl& property : (*decl)->properties) {
        if (property.kind == lang::PropertyDecl::Kind::Object || property.role != property.name ||
            words_.count(property.name) > 1)
          continue;
        say(**decl, property.span, fmt::format("no part asks for '{}' of {}", property.name, name),
            "a file may say it, and nothing comes of it", found);
      }
    }
    for (const std::string_view name : language_.names(lang::DeclKind::Part)) {
      const Result<const lang::PartDecl*> decl = language_.part(name);
      if (!decl || textOf((*decl)->origin.file) == nullptr) continue;
      for (const lang::LineDecl& line : (*decl)->lines) {
        const bool named =
            line.kind == lang::LineDecl::Kind::Value || line.kind == lang::LineDecl::Kind::Flag;
        if (!named || words_.count(line.id) > 1) continue;
        say(**decl, line.span, fmt::format("nothing takes a value from '{}'", line.id),
            "a line that nothing asks for is in no shader", found);
      }
    }
    return found;
  }

  /// Warnings of the lines of one's own parts under the options' profile: "undeclared-channels" where a node
  /// reads other channels of a texture than the extension declares, which engines may not store, and
  /// "out-of-range" where a condition compares a property with what no material has.
  Diagnostics lines(const Options& options) const {
    Diagnostics found;
    const Result<const model::Model*> compiled = language_.models.of(options.profile);
    if (!compiled) return found;
    const model::Model& model = **compiled;
    const auto sayAt = [&](uint32_t index, lang::Span span, std::string code, std::string message,
                           std::string help) {
      const lang::PartDecl& part = model.declOf(index);
      Diagnostic warning{std::move(code),    Severity::Warning, {std::string(part.origin.file), 0, 0, {}},
                         std::move(message), std::move(help),   {}};
      locate(warning, *textOf(part.origin.file), span.offset, span.length);
      addBounded(found, std::move(warning));
    };
    const auto compared = [&](uint32_t part, lang::Span span, const model::Condition& condition) {
      if (std::string message = neverEqual(model, condition); !message.empty())
        sayAt(part, span, "out-of-range", std::move(message), "no material of the range has that");
    };
    const auto own = [&](uint32_t part) {
      return part < model.parts.size() && textOf(model.parts[part].origin.file) != nullptr;
    };
    for (const model::Term& term : model.terms) {
      if (!own(term.part)) continue;
      const lang::Span span = model.declOf(term.part).span;
      compared(term.part, span, term.when);
      if (term.has_unless) compared(term.part, span, term.unless);
    }
    for (const model::Line& line : model.lines) {
      if (!own(line.part) || line.kind != lang::LineDecl::Kind::Value) continue;
      const lang::PartDecl& part = model.declOf(line.part);
      const std::string_view id = model.ids[line.id].name;
      const auto decl = std::find_if(part.lines.begin(), part.lines.end(),
                                     [&](const lang::LineDecl& one) { return one.id == id; });
      const lang::Span span = decl != part.lines.end() ? decl->span : part.span;
      for (const model::Alternative& one : line.alternatives) {
        compared(line.part, span, one.condition);
        if (std::string message = undeclaredChannels(model, one.value); !message.empty())
          sayAt(line.part, span, "undeclared-channels", std::move(message),
                "declare them behind the texture's name: `texture name .rgba;`");
      }
    }
    return found;
  }

  /// Warnings ("may-leave-range") of lines whose value may leave the range of what it goes to: of a material
  /// with nothing but the extension.
  Diagnostics leaving(const Options& options) const {
    Diagnostics found;
    const Result<const material::Schema*> schema = language_.models.schema();
    if (!schema) return found;
    for (uint16_t i = 1; i < (*schema)->extensions.size(); ++i) {
      const lang::ExtensionDecl& decl = *(*schema)->extensions[i];
      if (textOf(decl.origin.file) == nullptr) continue;
      std::optional<material::Material> material = material::materialWith(**schema, i, 0);
      if (!material) continue;
      addTextures(**schema, *material);
      Diagnostics warnings;
      const Result<graph::Graph> graph = buildGraph(*material, everything(), language_, options, warnings);
      if (!graph) continue;
      for (const Diagnostic& doubt : graph::doubts(*graph, language_)) atLine(*graph, doubt, found);
    }
    return found;
  }

private:
  const std::string* textOf(std::string_view file) const {
    for (const lang::SourceFile& one : own_) {
      if (one.name == file) return &one.text;
    }
    return nullptr;
  }

  template <class Decl>
  void unusedName(const Decl& decl, std::string_view name, std::string_view what, Diagnostics& found) const {
    if (textOf(decl.origin.file) == nullptr || words_.count(name) > 1) return;
    say(decl, decl.span, fmt::format("nothing uses the {} '{}'", what, name), "", found);
  }

  template <class Decl>
  void say(const Decl& decl, lang::Span span, std::string message, std::string help,
           Diagnostics& found) const {
    Diagnostic warning{"unused-name",      Severity::Warning, {std::string(decl.origin.file), 0, 0, {}},
                       std::move(message), std::move(help),   {}};
    locate(warning, *textOf(decl.origin.file), span.offset, span.length);
    // The forms of a node are one text.
    if (std::find(found.begin(), found.end(), warning) == found.end()) addBounded(found, std::move(warning));
  }

  static void addTextures(const material::Schema& schema, material::Material& material) {
    for (size_t i = 0; i < schema.properties.size(); ++i) {
      const material::Property& row = schema.properties[i];
      if (row.decl->kind != material::Kind::Texture ||
          std::find(material.extensions.begin(), material.extensions.end(), row.extension) ==
              material.extensions.end())
        continue;
      material::Material::Texture& texture = material.textures.emplace_back();
      texture.property = static_cast<uint16_t>(i);
      texture.info.texture = 0;
      texture.info.image = 0;
      for (const lang::PropertyDecl& member : row.decl->members)
        texture.info.members.push_back(member.default_value ? (*member.default_value)[0] : 0);
    }
  }

  /// Says a doubt about a node of the graph at the line that it comes from, where that is one's own.
  void atLine(const graph::Graph& graph, Diagnostic doubt, Diagnostics& found) const {
    constexpr std::string_view kNodes = "/nodes/";
    if (!doubt.place.pointer.starts_with(kNodes)) return;
    const size_t index = std::strtoul(doubt.place.pointer.c_str() + kNodes.size(), nullptr, 10);
    if (index >= graph.nodes.size()) return;
    for (const std::string_view name : language_.names(lang::DeclKind::Part)) {
      const Result<const lang::PartDecl*> part = language_.part(name);
      if (!part) continue;
      const std::string* text = textOf((*part)->origin.file);
      if (text == nullptr) continue;
      for (const lang::LineDecl& line : (*part)->lines) {
        if (line.id != graph.nodes[index].id) continue;
        doubt.place = {std::string((*part)->origin.file), 0, 0, {}};
        locate(doubt, *text, line.span.offset, line.span.length);
        if (std::find(found.begin(), found.end(), doubt) == found.end()) addBounded(found, std::move(doubt));
        return;
      }
    }
  }

  const Language& language_;
  std::vector<lang::SourceFile> own_;
  WordCounts words_;
};

}  // namespace

bool checkOptions(const Options& options, Messages& messages) {
  const Diagnostics found = checkOptions(options);
  report(found, {}, messages);
  return !lacquer::hasError(found);
}

bool checkNodes(const Options& options, Messages& messages) {
  const size_t before = messages.size();
  const auto said = [&] {
    return std::none_of(messages.begin() + static_cast<ptrdiff_t>(before), messages.end(),
                        [](const Message& one) { return one.level == Message::Level::Error; });
  };
  const auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), false;
  const Result<std::vector<lang::SourceFile>> own = ownNodeFiles(options);
  if (!own) return report(own.error(), {}, messages), false;
  if (Diagnostics empty = emptyFolders(options); !empty.empty()) return report(empty, {}, messages), false;
  Diagnostics all = (*language)->check();
  // In a folder that is to be good an order is said: what the names order today another part may turn over.
  for (Diagnostic& one : all) {
    if (one.code == "unordered-parts") one.severity = Severity::Error;
  }
  report(all, {}, messages);
  const Result<Limits> limits = limitsOf(options);
  const Result<const material::Schema*> schema = (*language)->models.schema();
  if (limits && schema && (*schema)->definitions)
    report(materialx::checkDefinitions((*schema)->definitions, **language, *limits), {}, messages);
  const OwnFiles files(**language, *own);
  report(files.unused(), {}, messages);
  Options named = options;
  if (!lacquer::hasError(all) && resolveNames(**language, named)) {
    report(files.lines(named), {}, messages);
    report(files.leaving(named), {}, messages);
  }
  return said();
}

}  // namespace lacquer
