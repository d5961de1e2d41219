#include "support/stack.h"

#if defined(__linux__)
#include <pthread.h>
#endif

namespace lacquer {

std::optional<uint64_t> stackLeft() {
#if defined(__linux__) && defined(__GLIBC__)
  pthread_attr_t attributes;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return std::nullopt;
  void* lowest = nullptr;
  size_t size = 0;
  const bool known = ::pthread_attr_getstack(&attributes, &lowest, &size) == 0;
  ::pthread_attr_destroy(&attributes);
  const auto here = reinterpret_cast<uintptr_t>(__builtin_frame_address(0));
  const auto low = reinterpret_cast<uintptr_t>(lowest);
  if (!known || here < low || here > low + size) return std::nullopt;  // a stack of the caller's own
  return here - low;
#else
  return std::nullopt;
#endif
}

#if defined(__EMSCRIPTEN__)
bool hasStack() { return true; }  // one thread, whose stack the module brings
#else
bool hasStack() {
  enum class State : uint8_t { Unknown, Enough, Little };
  thread_local State state = State::Unknown;
  if (state == State::Unknown)
    state = stackLeft().value_or(kStackNeeded) >= kStackNeeded ? State::Enough : State::Little;
  return state == State::Enough;
}
#endif

}  // namespace lacquer
