// A buffer of SPIR-V instructions.
#pragma once

#include <spirv/unified1/spirv.hpp>

#include <cassert>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lacquer::targets::spirv {

class Words {
public:
  void reserve(size_t words) { words_.reserve(words); }
  std::span<const uint32_t> words() const { return words_; }
  bool empty() const { return words_.empty(); }
  size_t size() const { return words_.size(); }
  /// Replaces a word, for what is known only once more is written.
  void set(size_t at, uint32_t word) { words_[at] = word; }

  /// A whole instruction of a fixed length.
  template <class... Operands>
  void op(spv::Op opcode, Operands... operands) {
    const size_t at = words_.size();
    words_.resize(at + 1 + sizeof...(operands));
    uint32_t* next = words_.data() + at;
    *next++ = static_cast<uint32_t>(1 + sizeof...(operands)) << spv::WordCountShift | opcode;
    ((*next++ = static_cast<uint32_t>(operands)), ...);
  }

  // An instruction of any length: begin, words and texts, end.
  void begin(spv::Op opcode) {
    open_ = words_.size();
    words_.push_back(opcode);
  }
  void word(uint32_t word) { words_.push_back(word); }
  /// Zero-terminated UTF-8, four bytes a word, lowest first.
  void text(std::string_view text) {
    const size_t at = words_.size();
    words_.resize(at + text.size() / 4 + 1, 0);
    for (size_t i = 0; i < text.size(); ++i) {
      words_[at + i / 4] |= static_cast<uint32_t>(static_cast<unsigned char>(text[i])) << (i % 4 * 8);
    }
  }
  void end() {
    const size_t count = words_.size() - open_;
    assert(count < 65536 && "an instruction's length has 16 bits");
    words_[open_] |= static_cast<uint32_t>(count) << spv::WordCountShift;
  }

private:
  std::vector<uint32_t> words_;
  size_t open_ = 0;
};

}  // namespace lacquer::targets::spirv
