// The uniform blocks of a SPIR-V module, by the decorations in its words (SPIR-V specification, 2.16
// and 3.20).
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp>
#include <tuple>

#include "check/check.h"

namespace lacquer::check {
namespace {

struct Type {
  spv::Op op = spv::OpNop;
  uint32_t size = 0;     ///< in bytes; of a matrix, the size of one column
  uint32_t element = 0;  ///< id of a vector's, matrix's or array's element, or what a pointer points to
  uint32_t count = 0;    ///< of elements; of a matrix, its columns
  std::vector<uint32_t> members;         ///< ids of a struct's member types
  spv::StorageClass storage_class = {};  ///< of a pointer
};

/// What the decorations of one id, or of one member of it, say.
struct Decorations {
  std::map<spv::Decoration, uint32_t> values;  ///< 0 for a decoration without an operand

  bool has(spv::Decoration decoration) const { return values.contains(decoration); }
  uint32_t get(spv::Decoration decoration) const {
    const auto found = values.find(decoration);
    return found == values.end() ? 0 : found->second;
  }
};

/// Reads the module in order. Decorations stand before types and types before their users, so that one pass
/// does.
class Reader {
public:
  void read(const spv_parsed_instruction_t& instruction);

  std::vector<Block> blocks;
  std::string error;  ///< the first reason why there is no answer

private:
  const Type& typeOf(uint32_t id) const;
  uint32_t memberSize(uint32_t type_id, const Decorations& decorations) const;
  void readType(spv::Op op, const spv_parsed_instruction_t& instruction);
  void readStruct(const spv_parsed_instruction_t& instruction);
  void readVariable(const spv_parsed_instruction_t& instruction);
  void complain(std::string message) {
    if (error.empty()) error = std::move(message);
  }

  std::map<uint32_t, std::string> names_;
  std::map<std::pair<uint32_t, uint32_t>, std::string> member_names_;
  std::map<uint32_t, Decorations> decorations_;
  std::map<std::pair<uint32_t, uint32_t>, Decorations> member_decorations_;
  std::map<uint32_t, Type> types_;
  std::map<uint32_t, uint32_t> constants_;
};

/// The literal string from word `first` to the instruction's end, which the parser has checked to be
/// terminated.
std::string textFrom(const spv_parsed_instruction_t& instruction, uint32_t first) {
  std::string text;
  for (uint32_t i = first; i < instruction.num_words; ++i) {
    for (uint32_t shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(instruction.words[i] >> shift & 0xff);
      if (c == '\0') return text;
      text += c;
    }
  }
  return text;
}

const Type& Reader::typeOf(uint32_t id) const {
  static const Type kNone;
  const auto found = types_.find(id);
  return found == types_.end() ? kNone : found->second;
}

uint32_t Reader::memberSize(uint32_t type_id, const Decorations& decorations) const {
  const Type& type = typeOf(type_id);
  if (type.op != spv::OpTypeMatrix) return type.size;
  const uint32_t rows = typeOf(type.element).count;
  return decorations.get(spv::DecorationMatrixStride) *
         (decorations.has(spv::DecorationRowMajor) ? rows : type.count);
}

void Reader::readStruct(const spv_parsed_instruction_t& instruction) {
  const uint32_t id = instruction.result_id;
  Type type;
  type.op = spv::OpTypeStruct;
  for (uint32_t i = 2; i < instruction.num_words; ++i) {
    const Decorations& decorations = member_decorations_[{id, i - 2}];
    type.members.push_back(instruction.words[i]);
    const uint32_t end =
        decorations.get(spv::DecorationOffset) + memberSize(instruction.words[i], decorations);
    type.size = std::max(type.size, end);
  }
  types_[id] = std::move(type);
}

void Reader::readType(spv::Op op, const spv_parsed_instruction_t& instruction) {
  const uint32_t* words = instruction.words;
  Type type;
  type.op = op;
  if (op == spv::OpTypeInt || op == spv::OpTypeFloat) {
    type.size = words[2] / 8;
    type.count = 1;
  } else if (op == spv::OpTypeVector || op == spv::OpTypeMatrix) {
    type.element = words[2];
    type.count = words[3];
    // A matrix is as large as its member's stride says; see memberSize.
    type.size = typeOf(type.element).size * (op == spv::OpTypeVector ? type.count : 1);
  } else if (op == spv::OpTypeArray) {
    type.element = words[2];
    type.count = constants_[words[3]];
    type.size = decorations_[instruction.result_id].get(spv::DecorationArrayStride) * type.count;
  } else if (op == spv::OpTypePointer) {
    type.storage_class = static_cast<spv::StorageClass>(words[2]);
    type.element = words[3];
  }
  types_[instruction.result_id] = std::move(type);
}

void Reader::readVariable(const spv_parsed_instruction_t& instruction) {
  const Type& pointer = typeOf(instruction.type_id);
  if (pointer.storage_class != spv::StorageClassUniform || pointer.op != spv::OpTypePointer) return;
  uint32_t id = pointer.element;
  while (typeOf(id).op == spv::OpTypeArray) id = typeOf(id).element;  // an array of blocks
  if (typeOf(id).op != spv::OpTypeStruct || !decorations_[id].has(spv::DecorationBlock)) return;

  const Decorations& variable = decorations_[instruction.result_id];
  Block block;
  block.name = names_[id];
  block.set = variable.get(spv::DecorationDescriptorSet);
  block.binding = variable.get(spv::DecorationBinding);
  block.size = typeOf(id).size;
  if (!variable.has(spv::DecorationBinding)) complain(fmt::format("block '{}' has no binding", block.name));
  uint32_t index = 0;
  for (const uint32_t member_type : typeOf(id).members) {
    const std::pair key(id, index++);
    const Decorations& decorations = member_decorations_[key];
    BlockMember member;
    member.name = member_names_[key];
    member.offset = decorations.get(spv::DecorationOffset);
    member.size = memberSize(member_type, decorations);
    if (!decorations.has(spv::DecorationOffset)) {
      complain(
          fmt::format("member {} ('{}') of block '{}' has no offset", key.second, member.name, block.name));
    }
    block.members.push_back(std::move(member));
  }
  blocks.push_back(std::move(block));
}

void Reader::read(const spv_parsed_instruction_t& instruction) {
  const uint32_t* words = instruction.words;
  const auto op = static_cast<spv::Op>(instruction.opcode);
  if (op == spv::OpName) {
    names_[words[1]] = textFrom(instruction, 2);
  } else if (op == spv::OpMemberName) {
    member_names_[{words[1], words[2]}] = textFrom(instruction, 3);
  } else if (op == spv::OpDecorate) {
    const auto decoration = static_cast<spv::Decoration>(words[2]);
    decorations_[words[1]].values[decoration] = instruction.num_words > 3 ? words[3] : 0;
  } else if (op == spv::OpMemberDecorate) {
    const auto decoration = static_cast<spv::Decoration>(words[3]);
    member_decorations_[{words[1], words[2]}].values[decoration] = instruction.num_words > 4 ? words[4] : 0;
  } else if (op == spv::OpConstant || op == spv::OpSpecConstant) {
    constants_[instruction.result_id] = words[3];
  } else if (op == spv::OpTypeStruct) {
    readStruct(instruction);
  } else if (op == spv::OpVariable) {
    readVariable(instruction);
  } else if (op >= spv::OpTypeVoid && op <= spv::OpTypePointer) {
    readType(op, instruction);
  }
}

}  // namespace

Result<std::vector<Block>> reflectBlocks(const Spirv& words) {
  spvtools::Context context(SPV_ENV_UNIVERSAL_1_3);
  std::string parse_error;
  context.SetMessageConsumer([&parse_error](spv_message_level_t, const char*, const spv_position_t&,
                                            const char* message) { parse_error = message; });
  Reader reader;
  const auto read = [](void* user, const spv_parsed_instruction_t* instruction) {
    static_cast<Reader*>(user)->read(*instruction);
    return SPV_SUCCESS;
  };
  const spv_result_t status =
      spvBinaryParse(context.CContext(), &reader, words.data(), words.size(), nullptr, read, nullptr);
  if (status != SPV_SUCCESS) {
    return fail("spirv-reflection", {}, fmt::format("not a SPIR-V module: {}", parse_error));
  }
  if (!reader.error.empty()) return fail("spirv-reflection", {}, reader.error);
  std::sort(reader.blocks.begin(), reader.blocks.end(), [](const Block& a, const Block& b) {
    return std::tie(a.set, a.binding, a.name) < std::tie(b.set, b.binding, b.name);
  });
  return std::move(reader.blocks);
}

}  // namespace lacquer::check
