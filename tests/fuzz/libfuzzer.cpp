// libFuzzer's side: one program for all targets, of which LACQUER_FUZZ_TARGET names one. `./dev fuzz` calls
// it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "mutate.h"
#include "targets.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace lacquer::fuzz;

const Target* chosen = nullptr;

std::string_view viewOf(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The text into libFuzzer's buffer; 0 where it is empty or does not fit.
size_t copied(const std::string& text, uint8_t* to, size_t most) {
  if (text.size() > most) return 0;
  std::memcpy(to, text.data(), text.size());
  return text.size();
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("LACQUER_FUZZ_TARGET");
  chosen = findTarget(name == nullptr ? "" : name);
  if (chosen != nullptr) return 0;
  std::fprintf(stderr, "LACQUER_FUZZ_TARGET must name a target:");
  for (const Target& target : targets()) std::fprintf(stderr, " %s", std::string(target.name).c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string wrong = chosen->feed(viewOf(data, size));
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "%s: %s\n", std::string(chosen->name).c_str(), wrong.c_str());
  std::abort();
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  if (chosen->form != Form::Bytes && seed % 4 != 0) {
    if (const size_t made = copied(mutated(viewOf(data, size), chosen->form, seed / 4), data, max_size);
        made > 0)
      return made;
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* data, size_t size, const uint8_t* other,
                                            size_t other_size, uint8_t* out, size_t max_size, unsigned seed) {
  if (chosen->form != Form::Bytes) {
    const std::string both = crossed(viewOf(data, size), viewOf(other, other_size), chosen->form, seed);
    if (const size_t made = copied(both, out, max_size); made > 0) return made;
  }
  // The first part of one and the last part of the other.
  const size_t head = size == 0 ? 0 : std::min(seed % size, max_size);
  const size_t tail = other_size == 0 ? 0 : std::min<size_t>(seed / 7 % other_size, max_size - head);
  if (head > 0) std::memcpy(out, data, head);
  if (tail > 0) std::memcpy(out + head, other + other_size - tail, tail);
  return head + tail;
}
