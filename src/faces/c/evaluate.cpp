#include <algorithm>

#include "answer/answer.h"
#include "c/handles.h"

namespace lacquer::c {

namespace {

/// `evaluate` is given the engine, the options, and where messages go.
template <class Evaluate>
lacquer_text* evaluated(int engine, const lacquer_options* options, lacquer_messages* messages,
                        const Evaluate& evaluate) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    if (!isEnumerator(engine, LACQUER_VULKAN_HLSL, "engine", messages))
      return static_cast<lacquer_text*>(nullptr);
    const std::optional<Evaluation> found =
        evaluate(static_cast<lacquer::Engine>(engine), optionsOf(options), to);
    return found ? textFrom(answerJson(*found)) : nullptr;
  });
}

/// `draw` is given the options, and where messages go.
template <class Draw>
int drawn(uint32_t pixels, uint8_t* rgb, size_t capacity, const lacquer_options* options,
          lacquer_messages* messages, const Draw& draw) {
  return guarded(messages, 0, [&](Messages& to) {
    const uint64_t needed = uint64_t{3} * pixels * pixels;
    if (rgb == nullptr || capacity < needed) {
      sayError(messages, "block-too-small", "there is no room for the picture",
               "it takes 3 * pixels * pixels bytes");
      return 0;
    }
    const std::vector<uint8_t> picture = draw(optionsOf(options), to);
    if (picture.empty() || picture.size() != needed) return 0;
    std::copy(picture.begin(), picture.end(), rgb);
    return 1;
  });
}

}  // namespace

}  // namespace lacquer::c

using namespace lacquer::c;
using lacquer::Messages;

lacquer_text* lacquer_scene_evaluate(const lacquer_scene* scene, size_t material, const char* points,
                                     size_t size, int engine, const lacquer_options* options,
                                     lacquer_messages* messages) {
  return evaluated(engine, options, messages,
                   [&](lacquer::Engine wanted, const lacquer_options& how, Messages& to) {
                     return lacquer::evaluate(sceneOf(scene), material, std::string(bytesOf(points, size)),
                                              wanted, how.texels, how.options, to, how.trial);
                   });
}

lacquer_text* lacquer_graph_evaluate(const lacquer_graph* graph, const char* points, size_t size, int engine,
                                     const lacquer_options* options, lacquer_messages* messages) {
  return evaluated(engine, options, messages,
                   [&](lacquer::Engine wanted, const lacquer_options& how, Messages& to) {
                     return lacquer::evaluate(graphOf(graph), std::string(bytesOf(points, size)), wanted,
                                              how.texels, how.options, to, how.trial);
                   });
}

int lacquer_scene_preview(const lacquer_scene* scene, size_t material, uint32_t pixels, uint8_t* rgb,
                          size_t capacity, const lacquer_options* options, lacquer_messages* messages) {
  return drawn(pixels, rgb, capacity, options, messages, [&](const lacquer_options& how, Messages& to) {
    return lacquer::drawBall(sceneOf(scene), material, pixels, how.texels, how.options, to, how.trial,
                             how.look);
  });
}

int lacquer_graph_preview(const lacquer_graph* graph, uint32_t pixels, uint8_t* rgb, size_t capacity,
                          const lacquer_options* options, lacquer_messages* messages) {
  return drawn(pixels, rgb, capacity, options, messages, [&](const lacquer_options& how, Messages& to) {
    return lacquer::drawBall(graphOf(graph), pixels, how.texels, how.options, to, how.trial, how.look);
  });
}
