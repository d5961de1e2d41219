// What instruments find, as rows.
#include <algorithm>
#include <array>
#include <cstring>

#include "answer/answer.h"
#include "c/handles.h"

using lacquer::Messages;
using lacquer::Strings;
using namespace lacquer::c;

struct lacquer_proofs {
  std::vector<lacquer::OperationProof> operations;
  std::vector<lacquer::OutputProof> outputs;
  struct Claim {
    std::string node, variant;
    lacquer::Claim claim;
  };
  std::vector<Claim> claims;
};

struct lacquer_stress {
  lacquer::StressReport report;
  struct Row {
    size_t subject = 0, finding = 0;
    std::string test;
  };
  std::vector<Row> rows;
};

struct lacquer_levels {
  lacquer::Levels levels;
  struct Row {
    size_t material = 0, level = 0;
    std::string simplify;
  };
  std::vector<Row> rows;
};

struct lacquer_sheet {
  lacquer::PreviewSheet sheet;
};

namespace {

/// The row at `index` of a list of a handle's, as `make` has it; `list` gives the list.
template <class Handle, class List, class Row, class Make>
int rowOf(const Handle* handle, List list, size_t index, Row* to, size_t size, const Make& make) {
  if (handle == nullptr || index >= (handle->*list).size()) return 0;
  return fill(make((handle->*list)[index]), to, size);
}

template <class Handle, class List>
size_t countOf(const Handle* handle, List list) {
  return handle == nullptr ? 0 : (handle->*list).size();
}

/// `evaluate` is given the engine, the options, and where messages go.
template <class Evaluate>
size_t colorsOf(int engine, double* rgba, uint8_t* discarded, size_t capacity, const lacquer_options* options,
                lacquer_messages* messages, const Evaluate& evaluate) {
  return guarded(messages, size_t{0}, [&](Messages& to) -> size_t {
    if (!isEnumerator(engine, LACQUER_VULKAN_HLSL, "engine", messages)) return 0;
    const std::optional<lacquer::Evaluation> found =
        evaluate(static_cast<lacquer::Engine>(engine), optionsOf(options), to);
    if (!found) return 0;
    const size_t count = found->rgba.size();
    if (rgba == nullptr || capacity < count) {
      sayError(messages, "block-too-small", "there is no room for the colours",
               "it takes four numbers for each point");
      return 0;
    }
    for (size_t i = 0; i < count; ++i) {
      std::copy(found->rgba[i].begin(), found->rgba[i].end(), rgba + 4 * i);
      if (discarded != nullptr) discarded[i] = !found->discarded.empty() && found->discarded[i] ? 1 : 0;
    }
    return count;
  });
}

/// The same of arrays; `evaluate` is given those first.
template <class Evaluate>
int colorsOfArrays(const lacquer_array* arrays, size_t count, size_t points, int engine,
                   const lacquer_colors* to, const lacquer_options* options, lacquer_messages* messages,
                   const Evaluate& evaluate) {
  return guarded(messages, 0, [&](Messages& said) -> int {
    if (!isEnumerator(engine, LACQUER_VULKAN_HLSL, "engine", messages)) return 0;
    if (to == nullptr || to->rgba == nullptr || (arrays == nullptr && count > 0)) {
      sayError(messages, "null-argument", "there is no array", "arrays, and a place for colours");
      return 0;
    }
    lacquer::PointArrays of;
    of.count = points;
    for (size_t i = 0; i < count; ++i) {
      const lacquer_array& one = arrays[i];
      of.arrays.push_back(
          {one.name == nullptr ? "" : one.name, one.numbers, one.is_double != 0, one.components, one.stride});
    }
    const std::optional<lacquer::Evaluation> found =
        evaluate(of, static_cast<lacquer::Engine>(engine), optionsOf(options), said);
    if (!found) return 0;
    const size_t size = to->is_double != 0 ? sizeof(double) : sizeof(float);
    const ptrdiff_t stride = to->stride == 0 ? static_cast<ptrdiff_t>(4 * size) : to->stride;
    auto* at = static_cast<unsigned char*>(to->rgba);
    for (size_t i = 0; i < found->rgba.size(); ++i, at += stride) {
      const std::array<double, 4>& color = found->rgba[i];
      std::array<float, 4> rounded{};
      for (size_t c = 0; c < 4; ++c) rounded[c] = static_cast<float>(color[c]);
      std::memcpy(at, to->is_double != 0 ? static_cast<const void*>(color.data()) : rounded.data(), 4 * size);
      if (to->discarded != nullptr)
        to->discarded[i] = !found->discarded.empty() && found->discarded[i] ? 1 : 0;
    }
    return 1;
  });
}

}  // namespace

size_t lacquer_scene_colors(const lacquer_scene* scene, size_t material, const char* points, size_t size,
                            int engine, double* rgba, uint8_t* discarded, size_t capacity,
                            const lacquer_options* options, lacquer_messages* messages) {
  return colorsOf(engine, rgba, discarded, capacity, options, messages,
                  [&](lacquer::Engine wanted, const lacquer_options& how, Messages& to) {
                    return lacquer::evaluate(sceneOf(scene), material, std::string(bytesOf(points, size)),
                                             wanted, how.texels, how.options, to);
                  });
}

size_t lacquer_graph_colors(const lacquer_graph* graph, const char* points, size_t size, int engine,
                            double* rgba, uint8_t* discarded, size_t capacity, const lacquer_options* options,
                            lacquer_messages* messages) {
  return colorsOf(engine, rgba, discarded, capacity, options, messages,
                  [&](lacquer::Engine wanted, const lacquer_options& how, Messages& to) {
                    return lacquer::evaluate(graphOf(graph), std::string(bytesOf(points, size)), wanted,
                                             how.texels, how.options, to);
                  });
}

int lacquer_scene_colors_of(const lacquer_scene* scene, size_t material, const lacquer_array* arrays,
                            size_t count, size_t points, int engine, const lacquer_colors* to,
                            const lacquer_options* options, lacquer_messages* messages) {
  return colorsOfArrays(arrays, count, points, engine, to, options, messages,
                        [&](const lacquer::PointArrays& of, lacquer::Engine wanted,
                            const lacquer_options& how, Messages& said) {
                          return lacquer::evaluate(sceneOf(scene), material, of, wanted, how.texels,
                                                   how.options, said, how.trial);
                        });
}

int lacquer_graph_colors_of(const lacquer_graph* graph, const lacquer_array* arrays, size_t count,
                            size_t points, int engine, const lacquer_colors* to,
                            const lacquer_options* options, lacquer_messages* messages) {
  return colorsOfArrays(arrays, count, points, engine, to, options, messages,
                        [&](const lacquer::PointArrays& of, lacquer::Engine wanted,
                            const lacquer_options& how, Messages& said) {
                          return lacquer::evaluate(graphOf(graph), of, wanted, how.texels, how.options, said,
                                                   how.trial);
                        });
}

lacquer_proofs* lacquer_graph_prove(lacquer_graph* graph, int precision, const lacquer_options* options,
                                    lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_proofs*>(nullptr), [&](Messages& to) -> lacquer_proofs* {
    if (!isEnumerator(precision, LACQUER_PRECISION_MEDIUMP, "precision", messages)) return nullptr;
    std::optional<lacquer::Proofs> found =
        editable(graph).prove(optionsOf(options).options, to, static_cast<lacquer::Precision>(precision));
    if (!found) return nullptr;
    auto made = std::make_unique<lacquer_proofs>();
    made->operations = std::move(found->operations);
    made->outputs = std::move(found->outputs);
    for (lacquer::Claim& claim : found->contracts) made->claims.push_back({{}, {}, std::move(claim)});
    return made.release();
  });
}

lacquer_proofs* lacquer_nodes_prove(int precision, const lacquer_options* options,
                                    lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_proofs*>(nullptr), [&](Messages& to) -> lacquer_proofs* {
    if (!isEnumerator(precision, LACQUER_PRECISION_MEDIUMP, "precision", messages)) return nullptr;
    const auto found =
        lacquer::proveNodes(optionsOf(options).options, to, static_cast<lacquer::Precision>(precision));
    if (!found) return nullptr;
    auto made = std::make_unique<lacquer_proofs>();
    for (const lacquer::NodeProof& node : *found) {
      for (const auto* claims : {&node.operations, &node.results, &node.calls}) {
        for (const lacquer::Claim& claim : *claims) made->claims.push_back({node.node, node.variant, claim});
      }
    }
    return made.release();
  });
}

void lacquer_proofs_free(lacquer_proofs* proofs) { delete proofs; }
size_t lacquer_proofs_operation_count(const lacquer_proofs* proofs) {
  return countOf(proofs, &lacquer_proofs::operations);
}
size_t lacquer_proofs_claim_count(const lacquer_proofs* proofs) {
  return countOf(proofs, &lacquer_proofs::claims);
}
size_t lacquer_proofs_output_count(const lacquer_proofs* proofs) {
  return countOf(proofs, &lacquer_proofs::outputs);
}

int lacquer_proofs_operation(const lacquer_proofs* proofs, size_t index, lacquer_operation* to, size_t size) {
  return rowOf(proofs, &lacquer_proofs::operations, index, to, size, [](const lacquer::OperationProof& of) {
    return lacquer_operation{of.term.c_str(),        of.name.c_str(), of.operation.c_str(), of.rate.c_str(),
                             of.operand.c_str(),     of.need.c_str(), of.reached.low,       of.reached.high,
                             of.reached.nan ? 1 : 0, of.safe ? 1 : 0};
  });
}

int lacquer_proofs_claim(const lacquer_proofs* proofs, size_t index, lacquer_claim* to, size_t size) {
  return rowOf(proofs, &lacquer_proofs::claims, index, to, size, [](const lacquer_proofs::Claim& of) {
    const lacquer::Claim& claim = of.claim;
    return lacquer_claim{of.node.c_str(),           of.variant.c_str(),  claim.what.c_str(),
                         claim.need.c_str(),        claim.reached.low,   claim.reached.high,
                         claim.reached.nan ? 1 : 0, claim.proved ? 1 : 0};
  });
}

int lacquer_proofs_output(const lacquer_proofs* proofs, size_t index, lacquer_range* to, size_t size) {
  return rowOf(proofs, &lacquer_proofs::outputs, index, to, size, [](const lacquer::OutputProof& of) {
    return lacquer_range{of.name.c_str(), of.reached.low, of.reached.high, of.reached.nan ? 1 : 0};
  });
}

lacquer_stress* lacquer_stress_run(const char* const* subjects, size_t count, uint64_t samples, uint64_t seed,
                                   int engine, const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_stress*>(nullptr), [&](Messages& to) -> lacquer_stress* {
    if (!isEnumerator(engine, LACQUER_VULKAN_HLSL, "engine", messages)) return nullptr;
    lacquer::Stress how;
    how.samples = samples;
    how.seed = seed;
    how.engine = static_cast<lacquer::Engine>(engine);
    auto report = lacquer::stressNodes(how, stringsOf(subjects, count), optionsOf(options).options, to);
    if (!report) return nullptr;
    auto made = std::make_unique<lacquer_stress>();
    made->report = std::move(*report);
    for (size_t s = 0; s < made->report.subjects.size(); ++s) {
      const lacquer::StressSubject& subject = made->report.subjects[s];
      for (size_t f = 0; f < subject.findings.size(); ++f)
        made->rows.push_back({s, f, lacquer::caseText(subject.findings[f], subject)});
    }
    return made.release();
  });
}

void lacquer_stress_free(lacquer_stress* stress) { delete stress; }
size_t lacquer_stress_subject_count(const lacquer_stress* stress) {
  return stress == nullptr ? 0 : stress->report.subjects.size();
}
size_t lacquer_stress_fault_count(const lacquer_stress* stress) {
  return stress == nullptr ? 0 : stress->report.faults;
}
size_t lacquer_stress_finding_count(const lacquer_stress* stress) {
  return countOf(stress, &lacquer_stress::rows);
}

int lacquer_stress_finding(const lacquer_stress* stress, size_t index, lacquer_finding* to, size_t size) {
  return rowOf(stress, &lacquer_stress::rows, index, to, size, [&](const lacquer_stress::Row& row) {
    const lacquer::StressSubject& subject = stress->report.subjects[row.subject];
    const lacquer::StressFinding& finding = subject.findings[row.finding];
    return lacquer_finding{subject.node.c_str(),
                           subject.variant.c_str(),
                           subject.extension.c_str(),
                           subject.file.c_str(),
                           subject.name.c_str(),
                           subject.material,
                           lacquer::faultName(finding.fault).data(),  // of a literal
                           finding.what.c_str(),
                           finding.known.c_str(),
                           row.test.c_str(),
                           finding.count,
                           finding.value};
  });
}

lacquer_levels* lacquer_levels_make(const char* const* files, size_t count, const char* folder,
                                    uint32_t levels, double most_error, uint32_t pixels,
                                    const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_levels*>(nullptr), [&](Messages& to) -> lacquer_levels* {
    lacquer::Lod how;
    how.output = textOf(folder);
    how.levels = levels;
    how.most_error = most_error;
    how.size = pixels;
    how.texels = optionsOf(options).texels;
    auto found = lacquer::makeLevels(how, stringsOf(files, count), {}, optionsOf(options).options, to);
    if (!found) return nullptr;
    auto made = std::make_unique<lacquer_levels>();
    made->levels = std::move(*found);
    for (size_t m = 0; m < made->levels.materials.size(); ++m) {
      const std::vector<lacquer::Level>& all = made->levels.materials[m].levels;
      for (size_t l = 0; l < all.size(); ++l) {
        std::string words;
        for (const std::string& word : all[l].simplify) words += (words.empty() ? "" : " ") + word;
        made->rows.push_back({m, l, std::move(words)});
      }
    }
    return made.release();
  });
}

void lacquer_levels_free(lacquer_levels* levels) { delete levels; }
const char* lacquer_levels_driver(const lacquer_levels* levels) {
  return levels == nullptr ? "" : levels->levels.driver.c_str();
}
size_t lacquer_levels_count(const lacquer_levels* levels) { return countOf(levels, &lacquer_levels::rows); }

int lacquer_levels_level(const lacquer_levels* levels, size_t index, lacquer_level* to, size_t size) {
  return rowOf(levels, &lacquer_levels::rows, index, to, size, [&](const lacquer_levels::Row& row) {
    const lacquer::MaterialLevels& material = levels->levels.materials[row.material];
    const lacquer::Level& level = material.levels[row.level];
    const lacquer::LevelFigures& figures = level.figures;
    return lacquer_level{
        material.file.c_str(),    material.name.c_str(), material.index,        row.level,
        level.shader.c_str(),     row.simplify.c_str(),  figures.instructions,  figures.cycles,
        figures.quarter_cycles,   figures.vertex_cycles, figures.cost,          figures.error.delta_e,
        figures.error.delta_e_95, figures.error.flip,    figures.error.flip_95, level.screen_size};
  });
}

lacquer_sheet* lacquer_sheet_draw(const char* const* files, size_t count, const char* output, uint32_t pixels,
                                  const char* first, const char* second, const lacquer_options* options,
                                  lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_sheet*>(nullptr), [&](Messages& to) -> lacquer_sheet* {
    lacquer::Preview how;
    how.output = textOf(output);
    how.size = pixels;
    how.texels = optionsOf(options).texels;
    if (first != nullptr) how.compare.push_back(first);
    if (second != nullptr) how.compare.push_back(second);
    auto sheet = lacquer::drawPreview(how, stringsOf(files, count), {}, optionsOf(options).options, to);
    return sheet ? new lacquer_sheet{std::move(*sheet)} : nullptr;
  });
}

void lacquer_sheet_free(lacquer_sheet* sheet) { delete sheet; }
size_t lacquer_sheet_material_count(const lacquer_sheet* sheet) {
  return sheet == nullptr ? 0 : sheet->sheet.materials;
}
size_t lacquer_sheet_difference_count(const lacquer_sheet* sheet) {
  return sheet == nullptr ? 0 : sheet->sheet.differences.size();
}

int lacquer_sheet_difference(const lacquer_sheet* sheet, size_t index, lacquer_difference* to, size_t size) {
  if (index >= lacquer_sheet_difference_count(sheet)) return 0;
  const lacquer::PreviewDifference& of = sheet->sheet.differences[index];
  return fill(
      lacquer_difference{of.file.c_str(), of.material.c_str(), of.largest, of.mean, of.root_mean_square}, to,
      size);
}

lacquer_text* lacquer_light_profiles(const char* output, const char* const* files, size_t count,
                                     uint32_t width, uint32_t height, const lacquer_options* options,
                                     lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    lacquer::ProfileTables how;
    how.output = textOf(output);
    if (width != 0) how.width = width;
    how.height = height;
    const auto found = lacquer::lightProfiles(how, stringsOf(files, count), optionsOf(options).options, to);
    return found ? textFrom(lacquer::answerJson(*found)) : nullptr;
  });
}
