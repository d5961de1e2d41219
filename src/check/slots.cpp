// Whether two resources of a SPIR-V module share a place (SPIR-V specification, 3.20; Vulkan, "Shader
// Interfaces").
#include <fmt/format.h>

#include <map>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp>
#include <tuple>

#include "check/check.h"

namespace lacquer::check {
namespace {

class Slots {
public:
  Slots(bool open_gl, const std::string& name) : open_gl_(open_gl), file_(name) {}

  void read(const spv_parsed_instruction_t& instruction) {
    const uint32_t* words = instruction.words;
    const auto op = static_cast<spv::Op>(instruction.opcode);
    if (op == spv::OpName) {
      names_[words[1]] = reinterpret_cast<const char*>(words + 2);
    } else if (op == spv::OpDecorate && instruction.num_words > 3) {
      if (words[2] == spv::DecorationDescriptorSet) sets_[words[1]] = words[3];
      if (words[2] == spv::DecorationBinding) bindings_[words[1]] = words[3];
    } else if (op == spv::OpVariable) {
      variable(instruction.result_id, static_cast<spv::StorageClass>(words[3]));
    }
  }

  Diagnostics wrong;

private:
  void variable(uint32_t id, spv::StorageClass storage) {
    const bool block = storage == spv::StorageClassUniform;
    if ((!block && storage != spv::StorageClassUniformConstant) || !bindings_.contains(id)) return;
    const std::tuple place(open_gl_ && block, sets_[id], bindings_[id]);
    const auto [it, fresh] = taken_.try_emplace(place, id);
    if (fresh) return;
    wrong.push_back({"slot-clash",
                     Severity::Error,
                     {file_, 0, 0, {}},
                     fmt::format("'{}' and '{}' are both at set {}, binding {}", names_[it->second],
                                 names_[id], std::get<1>(place), std::get<2>(place)),
                     {},
                     {}});
  }

  bool open_gl_;
  std::string file_;
  std::map<uint32_t, std::string> names_;
  std::map<uint32_t, uint32_t> sets_, bindings_;
  std::map<std::tuple<bool, uint32_t, uint32_t>, uint32_t> taken_;  ///< variable by place
};

}  // namespace

Diagnostics checkSlots(const Spirv& words, bool open_gl, const std::string& name) {
  spvtools::Context context(SPV_ENV_UNIVERSAL_1_3);
  Slots slots(open_gl, name);
  const auto read = [](void* user, const spv_parsed_instruction_t* instruction) {
    static_cast<Slots*>(user)->read(*instruction);
    return SPV_SUCCESS;
  };
  spvBinaryParse(context.CContext(), &slots, words.data(), words.size(), nullptr, read, nullptr);
  return std::move(slots.wrong);
}

}  // namespace lacquer::check
