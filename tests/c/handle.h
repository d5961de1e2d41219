// Handles that free themselves, for the tests.
#pragma once

#include <memory>
#include <string>

#include "lacquer_c.h"

namespace lacquer::test {

template <auto Free>
struct Freer {
  template <class T>
  void operator()(T* handle) const {
    Free(handle);
  }
};
using COptions = std::unique_ptr<lacquer_options, Freer<lacquer_options_free>>;
using CScene = std::unique_ptr<lacquer_scene, Freer<lacquer_scene_free>>;
using CGraph = std::unique_ptr<lacquer_graph, Freer<lacquer_graph_free>>;
using CShader = std::unique_ptr<lacquer_shader, Freer<lacquer_shader_free>>;
using CContract = std::unique_ptr<lacquer_contract, Freer<lacquer_contract_free>>;
using CEnvironment = std::unique_ptr<lacquer_environment, Freer<lacquer_environment_free>>;
using CText = std::unique_ptr<lacquer_text, Freer<lacquer_text_free>>;

inline std::string textOf(const CText& text) {
  return {lacquer_text_data(text.get()), lacquer_text_size(text.get())};
}

/// Messages, with what tests ask of them.
class CMessages {
public:
  CMessages() : list_(lacquer_messages_new()) {}
  ~CMessages() { lacquer_messages_free(list_); }
  CMessages(const CMessages&) = delete;
  CMessages& operator=(const CMessages&) = delete;
  operator lacquer_messages*() const { return list_; }

  /// "code, code"; forgets them.
  std::string takeCodes() {
    std::string codes;
    for (size_t i = 0; i < lacquer_messages_count(list_); ++i)
      codes +=
          (i > 0 ? ", " : "") + std::string(lacquer_message_part(list_, i, LACQUER_MESSAGE_CODE, nullptr));
    lacquer_messages_clear(list_);
    return codes;
  }

private:
  lacquer_messages* list_;
};

inline COptions optionsFrom(const std::string& json, lacquer_messages* messages = nullptr) {
  return COptions(lacquer_options_new(json.data(), json.size(), messages));
}

}  // namespace lacquer::test
