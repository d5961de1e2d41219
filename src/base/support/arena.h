// Memory for one pass over a material: taken in one piece, given back at once.
#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>
#include <string_view>
#include <unordered_map>

namespace lacquer {

/// The first block of an arena: a base, so that it is there before the resource that is told of it.
struct ArenaBlock {
  alignas(std::max_align_t) std::array<std::byte, 16384> first_block;
};

/// A monotonic resource whose first block is within it; what does not fit comes from the heap. For the stack
/// or as a member: containers that use it must go before it.
class Arena : private ArenaBlock, public std::pmr::monotonic_buffer_resource {
public:
  Arena() : std::pmr::monotonic_buffer_resource(first_block.data(), first_block.size()) {}
};

/// By names that stay where they are.
template <class T>
using NameMap = std::pmr::unordered_map<std::string_view, T>;

}  // namespace lacquer
