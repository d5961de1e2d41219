#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "environment/read.h"
#include "eval/in_memory.h"
#include "eval/material.h"
#include "preview/ball.h"
#include "preview/compared.h"
#include "preview/setting.h"
#include "preview/sheet.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"
#include "support/text.h"

namespace lacquer {

namespace {

constexpr uint32_t kLeastBall = 16;  ///< pixels of a ball
constexpr uint32_t kMostBall = 2048;
constexpr uint32_t kMostColumns = 100;

/// What is tried of a material, and how a value is drawn.
struct Trying {
  const Strings& texels;
  const Trial& trial;
  const ValueLook& look;
  Strings* changed = nullptr;  ///< names of parameters that it has; the others are those of other materials
};

/// As the value's type and range want it where nobody says.
ValueLook lookOf(const EvalMaterial::Shown& shown, ValueLook look) {
  using As = ValueLook::As;
  if (look.as != As::Any) return look;
  if (ir::componentCount(shown.type) == 1)
    look.as = As::Grey;
  else
    look.as = shown.range && shown.range->lo >= 0 ? As::Color : As::Vector;
  return look;
}

/// A material compiled for the studio. `substituted` is the number of images that a neutral colour stands
/// for.
Result<preview::Shading> shadingOf(const EvalSubject& subject, const Language& library, FileImages& images,
                                   const PreviewSetting& of, const Trying& how, const preview::Studio& studio,
                                   Messages& messages, size_t& substituted) {
  EvalMaterial evaluated(images, of.options);
  evaluated.setTrial(how.trial, how.changed != nullptr);
  if (Result<void> set = evaluated.setTexels(how.texels); !set)
    return tl::make_unexpected(std::move(set.error()));
  if (Result<void> lowered = evaluated.lower(subject, library, true, of.variant, messages); !lowered)
    return tl::make_unexpected(std::move(lowered.error()));
  passes::LightFacts lights{false, {}};
  if (studio.hasLamps()) lights.counts["directional"] = preview::Studio::kLights;
  if (of.in_float)
    evaluated.place(lights);
  else
    evaluated.countLights(lights);
  preview::Look look;
  look.in_float = of.in_float;
  for (const ir::TextureSlot* slot : evaluated.environments()) {
    const auto holds = [&](const char* word) { return slot->name.find(word) != std::string::npos; };
    (holds("irradiance") ? look.irradiance
     : holds("charlie")  ? look.fibres
                         : look.specular)
        .push_back(slot->name);
  }
  const auto neutral = [&](const ir::TextureSlot& slot, const Diagnostics& why) {
    ++substituted;
    for (Diagnostic one : why) {
      // Absent images are counted; one that is there and not taken is worth a word.
      if (one.code == "image-missing") continue;
      one.severity = Severity::Warning;
      report({one}, images.file(), messages);
    }
    return neutralTexel(slot);
  };
  const Result<void> bound = evaluated.bindTextures(neutral, look.textures);
  report(images.takeNotes(), images.file(), messages);
  if (!bound) return tl::make_unexpected(bound.error());
  look.module = evaluated.module();
  look.time = how.trial.time;
  look.frame = how.trial.frame;
  if (how.changed != nullptr)
    how.changed->insert(how.changed->end(), evaluated.changed().begin(), evaluated.changed().end());
  if (evaluated.shown()) look.value = lookOf(*evaluated.shown(), how.look);
  return preview::Shading::make(std::move(look), studio);
}

Diagnostic absentImages(const EvalSubject& subject, const std::string& file, size_t count) {
  return {
      "image-missing",
      Severity::Note,
      {file, 0, 0, subject.pointer()},
      fmt::format("{} image{} absent: a neutral colour stands for each", count, count == 1 ? " is" : "s are"),
      "or give a constant: --texel SLOT=r,g,b,a",
      {}};
}

class Previewing {
public:
  Previewing(const Preview& preview, const Options& options, Messages& messages, const Progress& progress)
      : preview_(preview), options_(options), messages_(messages), progress_(progress) {}

  Result<PreviewSheet> make(const Strings& files, const Strings& materials) {
    if (const Result<Limits> limits = limitsOf(options_); !limits) return tl::make_unexpected(limits.error());
    if (Result<void> set = readSettings(); !set) return tl::make_unexpected(std::move(set.error()));
    if (Result<void> lit = readEnvironment(); !lit) return tl::make_unexpected(std::move(lit.error()));
    std::vector<Input> read_files;
    if (Result<void> read = readFiles(files, materials, read_files); !read)
      return tl::make_unexpected(std::move(read.error()));
    Strings inputs = files;
    if (!preview_.environment.empty()) inputs.push_back(preview_.environment);
    for (const lang::SourceFile& file : filesOfFolders(options_)) inputs.push_back(file.name);
    if (Diagnostics wrong = clashes(inputs, {preview_.output}); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    if (Result<void> fits = preview::mayLayOut(total_ * settings_.size(), preview_.size); !fits)
      return tl::make_unexpected(std::move(fits.error()));
    std::vector<preview::Section> sections;
    for (const Input& input : read_files) {
      preview::Section section{read_files.size() > 1 ? input.path : std::string(), {}};
      FileImages images =
          input.graph ? FileImages::ofGraph(input.path, options_) : FileImages(input.path, options_);
      for (const material::Material& material : input.materials) drawAll(material, images, section);
      if (input.graph) drawAll(*input.graph, images, section);
      const Strings of_images = images.read();
      inputs.insert(inputs.end(), of_images.begin(), of_images.end());
      if (!section.cells.empty()) sections.push_back(std::move(section));
    }
    for (const auto& [name, value] : preview_.parameters) {
      if (done_ == 0 || std::find(changed_.begin(), changed_.end(), name) != changed_.end()) continue;
      return fail("no-such-parameter", {}, fmt::format("none has a parameter '{}'", printable(name)),
                  "`lacquer graph` prints those of a material");
    }
    if (sections.empty()) return fail("nothing-to-show", {}, "there is no material to show");
    std::string title;
    if (settings_.size() == 2)
      title = fmt::format("{} | {} | difference", settings_[0].name, settings_[1].name);
    const Result<preview::Picture> sheet = preview::layOut(sections, title, preview_.size, preview_.columns);
    if (!sheet) return tl::make_unexpected(sheet.error());
    if (Diagnostics wrong = clashes(inputs, {preview_.output}); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    if (Result<bool> written = writeFile(preview_.output, sheet->png(), {nullptr, options_.sync}); !written)
      return tl::make_unexpected(std::move(written.error()));
    sheet_.output = preview_.output;
    sheet_.materials = done_;
    if (settings_.size() == 2) sheet_.compared = {settings_[0].name, settings_[1].name};
    return std::move(sheet_);
  }

private:
  Result<void> readSettings() {
    if (Result<void> good = checkNumbers(); !good) return good;
    if (preview_.compare.empty()) settings_.push_back({"", options_, preview_.in_float, ""});
    for (const std::string& text : preview_.compare) {
      Result<PreviewSetting> setting = previewSetting(text, {text, options_, preview_.in_float, ""});
      if (!setting) return tl::make_unexpected(std::move(setting.error()));
      settings_.push_back(std::move(*setting));
    }
    for (const PreviewSetting& setting : settings_) {
      for (const std::string& word : setting.options.simplify) {
        if (!word.starts_with("vertex:")) continue;
        return fail("no-triangles", {},
                    fmt::format("'{}' cannot be seen on a ball, which has no vertices", printable(word)),
                    "leave it out here; `lacquer lod` and `lacquer tune` draw triangles");
      }
      if (Diagnostics wrong = checkReading(setting.options); !wrong.empty())
        return tl::make_unexpected(std::move(wrong));
      auto library = libraryFor(setting.options);
      if (!library) return tl::make_unexpected(std::move(library.error()));
      libraries_.push_back(std::move(*library));
    }
    return {};
  }

  Result<void> readEnvironment() {
    // Fine enough for a ball: the finest level has a texel for two degrees and a half.
    constexpr environment::MapOptions kFine{128, 512};
    if (preview_.environment.empty()) return {};
    const Result<environment::Surroundings> surroundings =
        surroundingsOf(preview_.environment, -1, options_, messages_);
    if (!surroundings) return tl::make_unexpected(surroundings.error());
    studio_ = preview::Studio(environment::mapsOf(*surroundings, kFine));
    return {};
  }

  Result<void> checkNumbers() const {
    if (Result<void> path = hasPath("the picture", preview_.output); !path) return path;
    if (Result<void> size = inRange("the size of a ball", preview_.size, kLeastBall, kMostBall, "pixels");
        !size)
      return size;
    if (preview_.compare.size() == 1 || preview_.compare.size() > 2) {
      return fail("wrong-count", {}, fmt::format("{} settings are to be compared", preview_.compare.size()),
                  "name two, or none");
    }
    if (!preview_.nodes.empty() && !preview_.compare.empty())
      return fail("wrong-count", {}, "settings are to be compared by the values of nodes",
                  "colours alone can be compared");
    if (!std::isfinite(preview_.look.scale))
      return fail("not-finite", {}, fmt::format("the scale of values is {}", preview_.look.scale), {});
    return inRange("the number of columns", preview_.columns, 0, kMostColumns, {});
  }

  /// A file's materials, or the graph that it is.
  struct Input {
    std::string path;
    std::vector<material::Material> materials;
    std::optional<graph::Graph> graph;
  };

  void readGraph(const std::string& file, const std::vector<std::string>& only, Strings& missing,
                 std::vector<Input>& inputs) {
    Result<graph::Graph> graph = readGraphFile(file, options_);
    if (!graph) return report(graph.error(), file, messages_);
    std::erase(missing, graph->name);
    if (!only.empty() && std::find(only.begin(), only.end(), graph->name) == only.end()) return;
    ++total_;
    inputs.push_back({file, {}, std::move(*graph)});
  }

  /// The files with those of their materials that are wanted.
  Result<void> readFiles(const std::vector<std::string>& files, const std::vector<std::string>& only,
                         std::vector<Input>& inputs) {
    std::vector<std::string> missing = only;
    for (const std::string& file : files) {
      if (isGraphFile(file)) {
        readGraph(file, only, missing, inputs);
        continue;
      }
      Result<material::Document> document = readMaterials(file, *libraries_[0], options_);
      if (!document) {
        report(document.error(), file, messages_);
        continue;
      }
      report(document->diagnostics, file, messages_);
      std::erase_if(document->materials, [&](const material::Material& material) {
        std::erase(missing, material.name);
        return !only.empty() && std::find(only.begin(), only.end(), material.name) == only.end();
      });
      total_ += document->materials.size();
      inputs.push_back({document->path, std::move(document->materials), {}});
    }
    if (missing.empty()) return {};
    return fail("no-such-material", {}, fmt::format("no material is named '{}'", printable(missing[0])),
                "`lacquer gen` lists the materials of a file");
  }

  Result<preview::Shading> shading(const EvalSubject& subject, FileImages& images, size_t setting,
                                   const Trial& trial, size_t& substituted) {
    // Warnings about the material are the same for both settings.
    Messages again;
    return shadingOf(subject, *libraries_[setting], images, settings_[setting],
                     {preview_.texels, trial, preview_.look, &changed_}, studio_,
                     setting == 0 ? messages_ : again, substituted);
  }

  /// The nodes that are asked for; one that is none for the material itself.
  Result<Strings> nodesOf(const EvalSubject& subject) const {
    if (preview_.nodes.empty()) return Strings{""};
    Strings nodes;
    for (const std::string& wanted : preview_.nodes) {
      if (wanted != "*") {
        nodes.push_back(wanted);
        continue;
      }
      Options options = settings_[0].options;
      if (Result<void> named = subject.isGraph() ? Result<void>() : resolveNames(*libraries_[0], options);
          !named)
        return tl::make_unexpected(std::move(named.error()));
      graph::FlatOutputs outputs;
      Diagnostics warnings;
      const Result<graph::Graph> built = subject.built({true, true, true, {true, true, true, true}},
                                                       *libraries_[0], options, warnings, &outputs);
      if (!built) return tl::make_unexpected(built.error());
      for (const auto& [node, of] : outputs) {
        for (const auto& [output, source] : of) nodes.push_back(of.size() == 1 ? node : node + "." + output);
      }
    }
    return nodes;
  }

  void drawAll(const EvalSubject& subject, FileImages& images, preview::Section& section) {
    report(subject.diagnostics(), images.file(), messages_);
    ++done_;
    if (lacquer::hasError(subject.diagnostics())) return;
    const Result<Strings> nodes = nodesOf(subject);
    if (!nodes) return report(nodes.error(), images.file(), messages_);
    balls_ += nodes->size() - 1;
    if (Result<void> fits = preview::mayLayOut((total_ + balls_) * settings_.size(), preview_.size); !fits)
      return report(fits.error(), images.file(), messages_);
    for (const std::string& node : *nodes) draw(subject, node, images, section);
    if (progress_) progress_(done_, total_);
  }

  void draw(const EvalSubject& subject, const std::string& node, FileImages& images,
            preview::Section& section) {
    const Trial trial{preview_.parameters, node, preview_.time, preview_.frame};
    size_t substituted = 0;
    std::vector<preview::Shading> shadings;
    for (size_t i = 0; i < settings_.size(); ++i) {
      substituted = 0;
      Result<preview::Shading> made = shading(subject, images, i, trial, substituted);
      if (!made) return report(made.error(), images.file(), messages_);
      shadings.push_back(std::move(*made));
    }
    const std::string name = subject.title();
    preview::Cell cell{node.empty() ? name : node, {}, {}};
    if (shadings.size() == 2) {
      preview::Comparison compared =
          preview::compareBalls(shadings[0], shadings[1], preview_.size, preview::kBackground);
      cell.lines.push_back(fmt::format("max {:.2g}   mean {:.2g}   shown x {:g}", compared.measured.largest,
                                       compared.measured.mean, compared.gain));
      cell.pictures = {std::move(compared.a), std::move(compared.b), std::move(compared.difference)};
      sheet_.differences.push_back({images.file(), name, compared.measured.largest, compared.measured.mean,
                                    compared.measured.root_mean_square});
    } else {
      cell.pictures = {preview::drawBall(shadings[0], preview_.size, preview::kBackground)};
    }
    if (substituted > 0) noteAbsent(subject, images.file(), substituted, cell);
    section.cells.push_back(std::move(cell));
  }

  void noteAbsent(const EvalSubject& subject, const std::string& file, size_t count, preview::Cell& cell) {
    cell.lines.push_back(fmt::format("{} image{} absent", count, count == 1 ? "" : "s"));
    report({absentImages(subject, file, count)}, file, messages_);
  }

  const Preview& preview_;
  const Options& options_;
  Messages& messages_;
  const Progress& progress_;
  preview::Studio studio_;                ///< or what the environment's picture makes of it
  std::vector<PreviewSetting> settings_;  ///< one, or the two to compare
  std::vector<std::shared_ptr<const Language>> libraries_;
  PreviewSheet sheet_;
  Strings changed_;  ///< parameters that some material has
  size_t done_ = 0, total_ = 0;
  size_t balls_ = 0;  ///< beyond one for each
};

}  // namespace

std::optional<PreviewSheet> drawPreview(const Preview& preview, const Strings& files,
                                        const Strings& materials, const Options& options, Messages& messages,
                                        const Progress& progress) {
  Result<PreviewSheet> made;
  withJobs(options.jobs,
           [&] { made = Previewing(preview, options, messages, progress).make(files, materials); });
  return valueOf(std::move(made), {}, messages);
}

static Result<std::vector<uint8_t>> ballOf(const InMemory& of, uint32_t size, const Strings& texels,
                                           const Options& options, Messages& messages, const Trial& trial,
                                           const ValueLook& look) {
  if (Diagnostics wrong = checkReading(options); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  if (Result<void> good = inRange("the size of a ball", size, kLeastBall, kMostBall, "pixels"); !good)
    return tl::make_unexpected(std::move(good.error()));
  report(of.subject.diagnostics(), of.file, messages);
  if (lacquer::hasError(of.subject.diagnostics())) return std::vector<uint8_t>();
  FileImages images = of.images(options);
  const preview::Studio studio;
  size_t substituted = 0;
  const Result<preview::Shading> shading = shadingOf(of.subject, of.language, images, {"", options, true, ""},
                                                     {texels, trial, look}, studio, messages, substituted);
  if (!shading) return tl::make_unexpected(shading.error());
  if (substituted > 0) report({absentImages(of.subject, of.file, substituted)}, of.file, messages);
  const preview::Picture picture = preview::drawBall(*shading, size, preview::kBackground);
  std::vector<uint8_t> rgb;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x)
      rgb.insert(rgb.end(), picture.at(x, y).begin(), picture.at(x, y).end());
  }
  return rgb;
}

std::vector<uint8_t> drawBallOf(const InMemory& of, uint32_t size, const Strings& texels,
                                const Options& options, Messages& messages, const Trial& trial,
                                const ValueLook& look) {
  Result<std::vector<uint8_t>> made = std::vector<uint8_t>();
  withJobs(options.jobs, [&] { made = ballOf(of, size, texels, options, messages, trial, look); });
  if (made) return std::move(*made);
  report(made.error(), of.file, messages);
  return {};
}

namespace preview {

Result<std::vector<PreviewDifference>> compareFiles(const std::string& a, const std::string& b,
                                                    const std::string& picture, uint32_t size,
                                                    const Options& options, Messages& messages) {
  if (Result<void> good = inRange("the size of a ball", size, kLeastBall, kMostBall, "pixels"); !good)
    return tl::make_unexpected(std::move(good.error()));
  const Result<std::shared_ptr<const Language>> language = libraryFor(options);
  if (!language) return tl::make_unexpected(language.error());
  const Result<material::Document> first = readMaterials(a, **language, options);
  if (!first) return tl::make_unexpected(first.error());
  const Result<material::Document> second = readMaterials(b, **language, options);
  if (!second) return tl::make_unexpected(second.error());
  const Studio studio;
  FileImages of_first(a, options);
  FileImages of_second(b, options);
  const Strings no_texels;
  const Trial no_trial;
  const ValueLook look;
  const Trying how{no_texels, no_trial, look};
  // What is said of the materials was said when they were converted.
  Messages again;
  std::vector<PreviewDifference> differences;
  Section section;
  for (const material::Material& one : first->materials) {
    const auto other = std::find_if(second->materials.begin(), second->materials.end(),
                                    [&](const material::Material& m) { return m.name == one.name; });
    if (other == second->materials.end()) continue;
    size_t absent = 0;
    const PreviewSetting setting{"", options, true, ""};
    const auto shading = [&](const material::Material& material, FileImages& images) -> Result<Shading> {
      if (lacquer::hasError(material.diagnostics)) return tl::make_unexpected(material.diagnostics);
      return shadingOf(material, **language, images, setting, how, studio, again, absent);
    };
    const Result<Shading> before = shading(one, of_first);
    const Result<Shading> after = shading(*other, of_second);
    if (!before || !after) {
      report(before ? after.error() : before.error(), before ? b : a, messages);
      continue;
    }
    Comparison compared = compareBalls(*before, *after, size, kBackground);
    differences.push_back(
        {a, one.name, compared.measured.largest, compared.measured.mean, compared.measured.root_mean_square});
    Cell cell{one.name, {}, {}};
    cell.lines.push_back(fmt::format("max {:.2g}   mean {:.2g}   shown x {:g}", compared.measured.largest,
                                     compared.measured.mean, compared.gain));
    cell.pictures = {std::move(compared.a), std::move(compared.b), std::move(compared.difference)};
    section.cells.push_back(std::move(cell));
  }
  if (picture.empty()) return differences;
  if (section.cells.empty()) return fail("nothing-to-show", {}, "there is no material to show");
  if (Diagnostics wrong = clashes({a, b}, {picture}); !wrong.empty())
    return tl::make_unexpected(std::move(wrong));
  const Result<Picture> sheet = layOut({section}, "before | after | difference", size, 1);
  if (!sheet) return tl::make_unexpected(sheet.error());
  if (Result<bool> written = writeFile(picture, sheet->png(), {nullptr, options.sync}); !written)
    return tl::make_unexpected(std::move(written.error()));
  return differences;
}

}  // namespace preview

}  // namespace lacquer
