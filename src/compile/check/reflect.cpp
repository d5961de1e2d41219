// Reads a module in one walk over its words (SPIR-V specification, 2.3 and 2.4): decorations stand before
// types, types before variables. Operands that are not there read as 0, so that no module makes the walk
// leave its words.
#include "check/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <spirv/unified1/spirv.hpp>
#include <tuple>

namespace lacquer::check {
namespace {

constexpr uint32_t kHeaderWords = 5;
constexpr uint32_t kMaxSlots = 64;   ///< more locations than any device has
constexpr uint32_t kMaxNesting = 8;  ///< of arrays

// Drivers make tables that reach to the highest set and binding, with a row for each descriptor: what a
// module says here is what they take of memory.
constexpr uint32_t kMaxSets = 32;                  ///< as most devices have it
constexpr uint32_t kMaxBindings = 65'536;          ///< in a set; WebGPU has 1,000
constexpr uint32_t kMaxCount = 65'536;             ///< descriptors of one binding
constexpr uint64_t kMaxDescriptors = 1U << 20U;    ///< of all bindings, as devices with the most have it
constexpr uint32_t kMaxPushConstantBytes = 4'096;  ///< more than any device has
constexpr size_t kMaxMembers = 65'536;             ///< of all uniform blocks, each of which has one
constexpr size_t kMaxName = 1'024;                 ///< characters; the rest is cut

struct Instruction {
  spv::Op op = spv::OpNop;
  const uint32_t* words = nullptr;
  uint32_t length = 0;

  uint32_t at(uint32_t index) const { return index < length ? words[index] : 0; }
  /// The literal string from a word on.
  std::string text(uint32_t first) const {
    std::string text;
    for (uint32_t i = first; i < length; ++i) {
      for (uint32_t shift = 0; shift < 32; shift += 8) {
        const char c = static_cast<char>(words[i] >> shift & 0xff);
        if (c == '\0') return text;
        text += c;
      }
    }
    return text;
  }
};

/// Calls `visit` for each instruction until it returns false. False when the words are no module.
template <class Visit>
bool walk(const Spirv& words, const Visit& visit) {
  if (words.size() < kHeaderWords || words[0] != spv::MagicNumber) return false;
  for (size_t i = kHeaderWords; i < words.size();) {
    const uint32_t length = words[i] >> spv::WordCountShift;
    if (length == 0 || length > words.size() - i) return false;
    if (!visit(Instruction{static_cast<spv::Op>(words[i] & spv::OpCodeMask), &words[i], length})) break;
    i += length;
  }
  return true;
}

struct Type {
  spv::Op op = spv::OpNop;
  uint32_t width = 0;
  bool is_signed = false;
  uint32_t element = 0;  ///< id of a vector's, matrix's or array's element, or what a pointer points to
  uint32_t count = 0;    ///< of elements; 0 for a run-time array
  uint32_t dim = 0, sampled = 0;  ///< of an image
  uint32_t bytes = 0;             ///< 0 for a matrix: its stride is the member's that holds it
  std::vector<uint32_t> members;  ///< ids of a struct's member types
};

using Decorations = std::map<uint32_t, uint32_t>;  ///< decoration → its operand, or 0

/// What of a module is kept: the rest may take far more room than the words do.
enum class Wanted : uint8_t { Interface, Blocks, Places };

class Reader {
public:
  /// The stage matters to the interface alone.
  explicit Reader(Wanted wanted, Stage stage = Stage::Fragment)
      : wanted_(wanted),
        model_(stage == Stage::Vertex ? spv::ExecutionModelVertex : spv::ExecutionModelFragment) {}

  bool read(const Instruction& instruction);
  Result<Interface> finish();
  Result<std::vector<Block>> finishBlocks();

  std::vector<Taken> places;

private:
  void readEntryPoint(const Instruction& instruction);
  void readType(const Instruction& instruction);
  void readVariable(const Instruction& instruction);
  void readPlace(const Instruction& instruction, spv::StorageClass storage, const Decorations& decorations);
  void readBlock(uint32_t type_id, const Decorations& variable);
  void readInterface(uint32_t type_id, uint32_t storage, const Decorations& decorations);
  void readResource(uint32_t type_id, spv::StorageClass storage, const Decorations& decorations);
  void readPushConstants(uint32_t type_id);
  void readSlots(uint32_t type_id, const Decorations& decorations, std::vector<Slot>& slots);
  bool addSlots(uint32_t type_id, Slot& next, std::vector<Slot>& slots, uint32_t nesting) const;
  std::optional<Resource> resourceOf(uint32_t type_id, spv::StorageClass storage) const;
  uint32_t memberBytes(uint32_t type_id, const Decorations& member) const;
  const Type& typeOf(uint32_t id) const;
  const Decorations& decorationsOf(uint32_t id, std::optional<uint32_t> member = {}) const;

  void refuse(std::string why) {
    if (error_.empty()) error_ = std::move(why);
  }

  Wanted wanted_;
  spv::ExecutionModel model_;
  bool found_ = false;
  Interface interface_;
  std::set<uint32_t> own_;    ///< variables of the entry point's interface
  uint64_t descriptors_ = 0;  ///< of all bindings
  std::vector<Block> blocks_;
  size_t members_ = 0;  ///< of all blocks
  std::string error_;   ///< the first
  std::map<uint32_t, std::string> names_;
  std::map<std::pair<uint32_t, uint32_t>, std::string> member_names_;
  std::map<uint32_t, Decorations> decorations_;
  std::map<std::pair<uint32_t, uint32_t>, Decorations> member_decorations_;
  std::map<uint32_t, Type> types_;
  std::map<uint32_t, uint32_t> constants_;
};

const Type& Reader::typeOf(uint32_t id) const {
  static const Type kNone;
  const auto found = types_.find(id);
  return found == types_.end() ? kNone : found->second;
}

const Decorations& Reader::decorationsOf(uint32_t id, std::optional<uint32_t> member) const {
  static const Decorations kNone;
  if (member) {
    const auto found = member_decorations_.find({id, *member});
    return found == member_decorations_.end() ? kNone : found->second;
  }
  const auto found = decorations_.find(id);
  return found == decorations_.end() ? kNone : found->second;
}

uint32_t get(const Decorations& decorations, spv::Decoration decoration) {
  const auto found = decorations.find(decoration);
  return found == decorations.end() ? 0 : found->second;
}

void Reader::readEntryPoint(const Instruction& instruction) {
  if (found_ || instruction.at(1) != static_cast<uint32_t>(model_)) return;
  found_ = true;
  interface_.entry = instruction.text(3);
  // A module may hold the other stages of its program, too.
  const auto name_words = static_cast<uint32_t>(interface_.entry.size() / 4 + 1);
  for (uint32_t i = 3 + name_words; i < instruction.length; ++i) own_.insert(instruction.at(i));
}

void Reader::readType(const Instruction& instruction) {
  Type type;
  type.op = instruction.op;
  if (instruction.op == spv::OpTypeInt || instruction.op == spv::OpTypeFloat) {
    type.width = instruction.at(2);
    type.bytes = type.width / 8;
    type.is_signed = instruction.op == spv::OpTypeInt && instruction.at(3) != 0;
  } else if (instruction.op == spv::OpTypeVector || instruction.op == spv::OpTypeMatrix) {
    type.element = instruction.at(2);
    type.count = instruction.at(3);
    if (instruction.op == spv::OpTypeVector) type.bytes = type.count * typeOf(type.element).bytes;
  } else if (instruction.op == spv::OpTypeArray) {
    type.element = instruction.at(2);
    const auto length = constants_.find(instruction.at(3));
    type.count = length == constants_.end() ? 1 : length->second;
    type.bytes = get(decorationsOf(instruction.at(1)), spv::DecorationArrayStride) * type.count;
  } else if (instruction.op == spv::OpTypeRuntimeArray || instruction.op == spv::OpTypeSampledImage) {
    type.element = instruction.at(2);
  } else if (instruction.op == spv::OpTypePointer) {
    type.element = instruction.at(3);
  } else if (instruction.op == spv::OpTypeImage) {
    type.dim = instruction.at(3);
    type.sampled = instruction.at(7);
  } else if (instruction.op == spv::OpTypeStruct) {
    for (uint32_t i = 2; i < instruction.length; ++i) {
      const Decorations& member = decorationsOf(instruction.at(1), i - 2);
      type.members.push_back(instruction.words[i]);
      type.bytes = std::max(type.bytes,
                            get(member, spv::DecorationOffset) + memberBytes(instruction.words[i], member));
    }
  }
  types_[instruction.at(1)] = std::move(type);
}

std::optional<Resource> Reader::resourceOf(uint32_t type_id, spv::StorageClass storage) const {
  const Type& type = typeOf(type_id);
  if (storage == spv::StorageClassStorageBuffer) return Resource::StorageBuffer;
  if (storage == spv::StorageClassUniform) {
    const bool stored = decorationsOf(type_id).contains(spv::DecorationBufferBlock);
    return stored ? Resource::StorageBuffer : Resource::UniformBuffer;
  }
  if (type.op == spv::OpTypeSampler) return Resource::Sampler;
  const bool buffer = type.dim == spv::DimBuffer;
  if (type.op == spv::OpTypeSampledImage) {
    return typeOf(type.element).dim == spv::DimBuffer ? Resource::UniformTexelBuffer
                                                      : Resource::CombinedImageSampler;
  }
  if (type.op != spv::OpTypeImage || type.dim == spv::DimSubpassData) return {};
  if (type.sampled == 2) return buffer ? Resource::StorageTexelBuffer : Resource::StorageImage;
  return buffer ? Resource::UniformTexelBuffer : Resource::SampledImage;
}

void Reader::readResource(uint32_t type_id, spv::StorageClass storage, const Decorations& decorations) {
  const uint32_t set = get(decorations, spv::DecorationDescriptorSet);
  const uint32_t number = get(decorations, spv::DecorationBinding);
  const auto isArray = [this](uint32_t id) {
    return typeOf(id).op == spv::OpTypeArray || typeOf(id).op == spv::OpTypeRuntimeArray;
  };
  uint64_t count = 1;
  for (uint32_t i = 0; i < kMaxNesting && isArray(type_id); ++i) {
    count = std::min<uint64_t>(count * std::max(typeOf(type_id).count, 1U), kMaxCount + 1U);
    type_id = typeOf(type_id).element;
  }
  const std::optional<Resource> resource = resourceOf(type_id, storage);
  const std::string name = fmt::format("the resource at set {}, binding {}", set, number);
  if (!resource || isArray(type_id)) return refuse(name + " is of a kind that is not measured");
  if (set >= kMaxSets) return refuse(fmt::format("{}: there are {} sets", name, kMaxSets));
  if (number >= kMaxBindings) return refuse(fmt::format("{}: a set has {} bindings", name, kMaxBindings));
  if (count > kMaxCount) return refuse(fmt::format("{} has more than {} descriptors", name, kMaxCount));
  const Binding binding{*resource, static_cast<uint32_t>(count)};
  const auto [place, fresh] = interface_.bindings.try_emplace({set, number}, binding);
  Binding& known = place->second;
  const uint32_t before = fresh ? 0 : known.count;
  // Two variables may share a binding: an image and its sampler out of one combined descriptor.
  if (known.resource != binding.resource) known.resource = Resource::CombinedImageSampler;
  known.count = std::max(known.count, binding.count);
  descriptors_ += known.count - before;
  if (descriptors_ > kMaxDescriptors)
    refuse(fmt::format("the module's resources have more than {} descriptors", kMaxDescriptors));
}

void Reader::readPushConstants(uint32_t type_id) {
  interface_.push_constant_bytes = std::max(interface_.push_constant_bytes, typeOf(type_id).bytes);
  if (interface_.push_constant_bytes > kMaxPushConstantBytes)
    refuse(fmt::format("the push constants take more than {} bytes", kMaxPushConstantBytes));
}

void Reader::readPlace(const Instruction& instruction, spv::StorageClass storage,
                       const Decorations& decorations) {
  uint32_t id = typeOf(instruction.at(1)).element;
  // Before SPIR-V 1.3 a storage buffer is a uniform one with another decoration.
  const bool stored =
      storage == spv::StorageClassStorageBuffer || decorationsOf(id).contains(spv::DecorationBufferBlock);
  const bool uniform = storage == spv::StorageClassUniform && !stored;
  if (wanted_ == Wanted::Places) {
    if (decorations.contains(spv::DecorationBinding))
      places.push_back({names_[instruction.at(2)], get(decorations, spv::DecorationDescriptorSet),
                        get(decorations, spv::DecorationBinding), uniform, stored});
    return;
  }
  if (!uniform) return;
  // An array of blocks.
  for (uint32_t i = 0; i < kMaxNesting && typeOf(id).op == spv::OpTypeArray; ++i) id = typeOf(id).element;
  if (typeOf(id).op == spv::OpTypeStruct && decorationsOf(id).contains(spv::DecorationBlock))
    readBlock(id, decorations);
}

void Reader::readBlock(uint32_t type_id, const Decorations& variable) {
  // Variables of one type have its members each, so that their sum is no part of the words.
  members_ += std::max<size_t>(typeOf(type_id).members.size(), 1);
  if (members_ > kMaxMembers)
    return refuse(fmt::format("the uniform blocks have more than {} members", kMaxMembers));
  Block block{names_[type_id],
              get(variable, spv::DecorationDescriptorSet),
              get(variable, spv::DecorationBinding),
              typeOf(type_id).bytes,
              {}};
  if (!variable.contains(spv::DecorationBinding))
    refuse(fmt::format("block '{}' has no binding", block.name));
  uint32_t index = 0;
  for (const uint32_t member_type : typeOf(type_id).members) {
    const Decorations& decorations = decorationsOf(type_id, index);
    BlockMember member{member_names_[{type_id, index}], get(decorations, spv::DecorationOffset),
                       memberBytes(member_type, decorations)};
    if (!decorations.contains(spv::DecorationOffset))
      refuse(fmt::format("member {} ('{}') of block '{}' has no offset", index, member.name, block.name));
    block.members.push_back(std::move(member));
    ++index;
  }
  blocks_.push_back(std::move(block));
}

/// Appends the locations of a type from `next` on, of a block or a struct those of its members. False for
/// booleans and numbers that are not 32 bits wide.
bool Reader::addSlots(uint32_t type_id, Slot& next, std::vector<Slot>& slots, uint32_t nesting) const {
  const Type& type = typeOf(type_id);
  if (type.op == spv::OpTypeArray || type.op == spv::OpTypeMatrix) {
    if (nesting == 0 || type.count == 0) return false;
    for (uint32_t i = 0; i < type.count; ++i) {
      if (slots.size() >= kMaxSlots || !addSlots(type.element, next, slots, nesting - 1)) return false;
    }
    return true;
  }
  if (type.op == spv::OpTypeStruct) {
    // What has no members takes no slot, and however many of them are nothing that ends.
    if (nesting == 0 || type.members.empty()) return false;
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      const Decorations& member = decorationsOf(type_id, i);
      if (member.contains(spv::DecorationLocation)) next.location = get(member, spv::DecorationLocation);
      next.component = get(member, spv::DecorationComponent);
      if (slots.size() >= kMaxSlots || !addSlots(type.members[i], next, slots, nesting - 1)) return false;
    }
    return true;
  }
  const Type& scalar = type.op == spv::OpTypeVector ? typeOf(type.element) : type;
  if ((scalar.op != spv::OpTypeFloat && scalar.op != spv::OpTypeInt) || scalar.width != 32) return false;
  next.count = type.op == spv::OpTypeVector ? type.count : 1;
  next.scalar = scalar.op == spv::OpTypeFloat ? Scalar::Float : scalar.is_signed ? Scalar::Int : Scalar::Uint;
  if (next.count > 4 || next.location >= kMaxSlots) return false;
  slots.push_back(next);
  ++next.location;
  return true;
}

void Reader::readSlots(uint32_t type_id, const Decorations& decorations, std::vector<Slot>& slots) {
  if (decorations.contains(spv::DecorationBuiltIn)) return;
  const Type& type = typeOf(type_id);
  // gl_PerVertex is a block of built-ins.
  if (type.op == spv::OpTypeStruct && decorationsOf(type_id, 0).contains(spv::DecorationBuiltIn)) return;
  if (slots.size() >= size_t{4} * kMaxSlots)  // a location has four components
    return refuse("the module has more inputs or outputs than any device");
  Slot next;
  next.location = get(decorations, spv::DecorationLocation);
  next.component = get(decorations, spv::DecorationComponent);
  const size_t before = slots.size();
  if (addSlots(type_id, next, slots, kMaxNesting)) return;
  slots.resize(before);
  if (&slots == &interface_.inputs) {
    interface_.odd_input = fmt::format("the input at location {}", get(decorations, spv::DecorationLocation));
  }
}

/// Bytes of a struct's member; its decorations hold the stride of a matrix.
uint32_t Reader::memberBytes(uint32_t type_id, const Decorations& member) const {
  const Type& type = typeOf(type_id);
  if (type.op != spv::OpTypeMatrix) return type.bytes;
  const bool rows = member.contains(spv::DecorationRowMajor);
  return get(member, spv::DecorationMatrixStride) * (rows ? typeOf(type.element).count : type.count);
}

/// `storage` is whatever the module says, and so perhaps no value of the enumeration.
void Reader::readInterface(uint32_t type_id, uint32_t storage, const Decorations& decorations) {
  if (storage == spv::StorageClassInput) {
    readSlots(type_id, decorations, interface_.inputs);
  } else if (storage == spv::StorageClassOutput) {
    readSlots(type_id, decorations, interface_.outputs);
  } else if (storage == spv::StorageClassPushConstant) {
    readPushConstants(type_id);
  } else if (storage == spv::StorageClassUniform || storage == spv::StorageClassUniformConstant ||
             storage == spv::StorageClassStorageBuffer) {
    readResource(type_id, static_cast<spv::StorageClass>(storage), decorations);
  }
}

void Reader::readVariable(const Instruction& instruction) {
  const Decorations& decorations = decorationsOf(instruction.at(2));
  const uint32_t storage = instruction.at(3);
  if (wanted_ == Wanted::Interface) {
    const bool between = storage == spv::StorageClassInput || storage == spv::StorageClassOutput;
    if (!between || own_.contains(instruction.at(2)))
      readInterface(typeOf(instruction.at(1)).element, storage, decorations);
  } else if (storage == spv::StorageClassUniform || storage == spv::StorageClassUniformConstant ||
             storage == spv::StorageClassStorageBuffer) {
    readPlace(instruction, static_cast<spv::StorageClass>(storage), decorations);
  }
}

bool Reader::read(const Instruction& instruction) {
  const spv::Op op = instruction.op;
  if (op == spv::OpFunction) return false;  // all declarations stand before it
  if (op == spv::OpEntryPoint) {
    readEntryPoint(instruction);
  } else if (op == spv::OpName && wanted_ != Wanted::Interface) {
    names_[instruction.at(1)] = instruction.text(2).substr(0, kMaxName);
  } else if (op == spv::OpMemberName && wanted_ == Wanted::Blocks) {
    member_names_[{instruction.at(1), instruction.at(2)}] = instruction.text(3).substr(0, kMaxName);
  } else if (op == spv::OpDecorate) {
    decorations_[instruction.at(1)][instruction.at(2)] = instruction.at(3);
  } else if (op == spv::OpMemberDecorate) {
    member_decorations_[{instruction.at(1), instruction.at(2)}][instruction.at(3)] = instruction.at(4);
  } else if (op == spv::OpConstant || op == spv::OpSpecConstant) {
    constants_[instruction.at(2)] = instruction.at(3);
  } else if (op == spv::OpVariable) {
    readVariable(instruction);
  } else if (op >= spv::OpTypeVoid && op <= spv::OpTypePointer) {
    readType(instruction);
  }
  return error_.empty();
}

Result<Interface> Reader::finish() {
  if (!found_) {
    const char* name = model_ == spv::ExecutionModelVertex ? "vertex" : "fragment";
    return fail("spirv-reflection", {}, fmt::format("the module has no entry point of a {} shader", name));
  }
  if (!error_.empty()) return fail("spirv-reflection", {}, error_);
  for (std::vector<Slot>* slots : {&interface_.inputs, &interface_.outputs}) {
    std::sort(slots->begin(), slots->end(), [](const Slot& a, const Slot& b) {
      return std::tie(a.location, a.component) < std::tie(b.location, b.component);
    });
  }
  return std::move(interface_);
}

Result<std::vector<Block>> Reader::finishBlocks() {
  if (!error_.empty()) return fail("spirv-reflection", {}, error_);
  std::sort(blocks_.begin(), blocks_.end(), [](const Block& a, const Block& b) {
    return std::tie(a.set, a.binding, a.name) < std::tie(b.set, b.binding, b.name);
  });
  return std::move(blocks_);
}

/// False when the words are no module.
bool readAll(const Spirv& words, Reader& reader) {
  return walk(words, [&](const Instruction& instruction) { return reader.read(instruction); });
}

}  // namespace

Result<Interface> reflect(const Spirv& words, Stage stage) {
  Reader reader(Wanted::Interface, stage);
  if (!readAll(words, reader)) return fail("spirv-reflection", {}, "not a SPIR-V module");
  return reader.finish();
}

bool hasEntryPoint(const Spirv& words, Stage stage) {
  const uint32_t model = stage == Stage::Vertex ? spv::ExecutionModelVertex : spv::ExecutionModelFragment;
  bool found = false;
  walk(words, [&](const Instruction& instruction) {
    found = found || (instruction.op == spv::OpEntryPoint && instruction.at(1) == model);
    return !found && instruction.op != spv::OpFunction;
  });
  return found;
}

Result<std::vector<Block>> reflectBlocks(const Spirv& words) {
  Reader reader(Wanted::Blocks);
  if (!readAll(words, reader)) return fail("spirv-reflection", {}, "not a SPIR-V module");
  return reader.finishBlocks();
}

std::vector<Taken> reflectPlaces(const Spirv& words) {
  Reader reader(Wanted::Places);
  return readAll(words, reader) ? std::move(reader.places) : std::vector<Taken>{};
}

size_t instructionCount(const Spirv& words) {
  size_t count = 0;
  bool inside = false;
  const bool good = walk(words, [&](const Instruction& instruction) {
    const spv::Op op = instruction.op;
    if (op == spv::OpFunction) inside = true;
    const bool declares = op == spv::OpFunction || op == spv::OpFunctionParameter || op == spv::OpLabel ||
                          op == spv::OpVariable || op == spv::OpLine || op == spv::OpNoLine ||
                          op == spv::OpFunctionEnd;
    if (inside && !declares) ++count;
    if (op == spv::OpFunctionEnd) inside = false;
    return true;
  });
  return good ? count : 0;
}

}  // namespace lacquer::check
