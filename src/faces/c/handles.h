// What the handles of lacquer_c.h hold, and what every call does: no exception leaves it.
#pragma once

#include <algorithm>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "lacquer.h"
#include "lacquer_c.h"

struct lacquer_text {
  std::string text;
};
struct lacquer_messages {
  lacquer::Messages list;
};
struct lacquer_options {
  lacquer::Options options;
  lacquer::Strings texels;  ///< of evaluations and previews
  lacquer::Trial trial;
  lacquer::ValueLook look;
};
struct lacquer_scene {
  lacquer::Scene scene;
};
struct lacquer_graph {
  lacquer::Graph graph;
};
struct lacquer_shader {
  lacquer::Shader shader;
};
struct lacquer_contract {
  lacquer::Contract contract;
};

namespace lacquer::c {

/// The options behind a handle, or the defaults: the library's, but that a build without validators uses
/// none.
const lacquer_options& optionsOf(const lacquer_options* options);

/// The object behind a handle, or an empty one.
const Scene& sceneOf(const lacquer_scene* scene);
const Graph& graphOf(const lacquer_graph* graph);
/// An empty one is made anew for each call: graphs are edited.
Graph editable(lacquer_graph* graph);
const Shader& shaderOf(const lacquer_shader* shader);

/// A text that comes in; NULL is an empty one.
inline std::string textOf(const char* text) { return text == nullptr ? std::string() : std::string(text); }
inline Strings stringsOf(const char* const* texts, size_t count) {
  Strings all;
  for (size_t i = 0; texts != nullptr && i < count; ++i) all.push_back(textOf(texts[i]));
  return all;
}
inline std::string_view bytesOf(const char* bytes, size_t size) {
  return bytes == nullptr ? std::string_view() : std::string_view(bytes, size);
}
/// A text that comes out and stays.
const char* give(const std::string& text, size_t* size) noexcept;
/// A new handle; null for an empty text, which means that the call failed.
lacquer_text* textFrom(std::string text);

/// As much of a row as the caller knows.
template <class Row>
int fillRow(const Row& made, Row* to, size_t size) {
  if (to == nullptr) return 0;
  std::memcpy(to, &made, std::min(size, sizeof made));
  return 1;
}

/// LACQUER_NORMAL and so on.
uint32_t bitsOf(const Attributes& attributes);

/// Appends an error, if there is memory for one.
void sayError(lacquer_messages* messages, const char* code, std::string_view what,
              std::string_view help) noexcept;

/// As much of `made` as the caller knows.
template <class Row>
int fill(const Row& made, Row* to, size_t size) {
  if (to == nullptr) return 0;
  std::memcpy(to, &made, std::min(size, sizeof made));
  return 1;
}

/// False, with a message, for a number that is none of an enumeration's.
bool isEnumerator(int value, int last, const char* what, lacquer_messages* messages);

/// What `call` returns; where it throws, a message and `failed`. `call` is given the Messages to append to.
template <class Value, class Call>
Value guarded(lacquer_messages* messages, Value failed, const Call& call) noexcept {
  try {
    Messages unwanted;
    return call(messages == nullptr ? unwanted : messages->list);
  } catch (const std::bad_alloc&) {
    sayError(messages, "out-of-memory", "there is not enough memory", "");
  } catch (...) {
    sayError(messages, "internal", "the library failed in a way that it should not", "please report it");
  }
  return failed;
}

}  // namespace lacquer::c
