#include "renderer.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

namespace tinygltf {
std::string base64_encode(const unsigned char* bytes, unsigned count);  // which its header has for itself
}

namespace renderer {

namespace {

constexpr size_t kMost = size_t{1} << 28;  ///< elements of an accessor
constexpr int kDeepest = 1000;             ///< nodes below one another, so that no file exhausts the stack

template <class List>
bool within(int index, const List& list) {
  return index >= 0 && static_cast<size_t>(index) < list.size();
}

/// tinygltf 2.7 wants a node of every animated target, which a pointer (KHR_animation_pointer) has not.
void giveNodes(nlohmann::json& json) {
  if (!json.is_object() || !json.contains("animations") || !json["animations"].is_array()) return;
  for (nlohmann::json& animation : json["animations"]) {
    if (!animation.is_object() || !animation.contains("channels")) continue;
    for (nlohmann::json& channel : animation["channels"]) {
      if (channel.is_object() && channel.contains("target") && channel["target"].is_object() &&
          !channel["target"].contains("node"))
        channel["target"]["node"] = 0;
    }
  }
}

/// The JSON of a .gltf or a .glb of version 2 or 3, as tinygltf 2.7 reads it: buffers of chunks as data URIs.
nlohmann::json jsonOf(const std::string& bytes) {
  const auto number = [&](size_t at, size_t count) {
    uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, count);
    return value;
  };
  if (bytes.size() < 12 || bytes.compare(0, 4, "glTF") != 0)
    return nlohmann::json::parse(bytes, nullptr, false);
  const bool wide = number(4, 4) == 3;
  const size_t head = wide ? 16 : 8;
  nlohmann::json json(nlohmann::json::value_t::discarded);
  std::vector<std::string> chunks;
  for (size_t at = wide ? 16 : 12; at < bytes.size() && bytes.size() - at >= head;) {
    const uint64_t size = wide ? number(at + 8, 8) : number(at, 4);
    if (size > bytes.size() - at - head) break;
    const uint64_t type = number(wide ? at : at + 4, 4);
    chunks.push_back(bytes.substr(at + head, static_cast<size_t>(size)));
    if (type == 0x4E4F534A && json.is_discarded())
      json = nlohmann::json::parse(chunks.back(), nullptr, false);
    at += head + static_cast<size_t>(size);
    if (wide) at = (at + 7) / 8 * 8;
  }
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return json;
  for (nlohmann::json& buffer : json["buffers"]) {
    if (!buffer.is_object() || buffer.contains("uri")) continue;
    const auto named = buffer.find("chunk");
    const bool first = &buffer == &json["buffers"][0];
    const size_t chunk = named == buffer.end()         ? (first ? 1 : 0)
                         : named->is_number_unsigned() ? named->get<size_t>()
                                                       : 0;
    if (chunk == 0 || chunk >= chunks.size()) continue;
    buffer["uri"] = "data:application/octet-stream;base64," +
                    tinygltf::base64_encode(reinterpret_cast<const unsigned char*>(chunks[chunk].data()),
                                            static_cast<unsigned>(chunks[chunk].size()));
  }
  return json;
}

void load(const std::string& path, tinygltf::Model& model) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + " cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string folder = path.find('/') == std::string::npos ? "." : path.substr(0, path.rfind('/'));
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  nlohmann::json json = jsonOf(bytes);
  giveNodes(json);
  const std::string text = json.is_discarded() ? bytes : json.dump();
  const bool good = reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                               static_cast<unsigned>(text.size()), folder);
  if (!warning.empty()) complain(path + ": " + warning);
  if (!good) throw std::runtime_error(path + ": " + (error.empty() ? "this is no glTF file" : error));
}

template <size_t N>
void take(const std::vector<double>& from, std::array<float, N>& to) {
  for (size_t i = 0; i < N && from.size() == N; ++i) to[i] = static_cast<float>(from[i]);
}

/// What a node says of itself and of those below it.
bool isVisible(const tinygltf::Node& node) {
  const auto named = node.extensions.find("KHR_node_visibility");
  if (named == node.extensions.end() || !named->second.Has("visible")) return true;
  const tinygltf::Value& visible = named->second.Get("visible");
  return !visible.IsBool() || visible.Get<bool>();
}

/// A node's light of EXT_lights_area.
std::optional<lacquer::vk::AreaLight> areaOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                             const Matrix& world) {
  const auto all = model.extensions.find("EXT_lights_area");
  const auto named = node.extensions.find("EXT_lights_area");
  if (all == model.extensions.end() || named == node.extensions.end() || !named->second.Has("light"))
    return {};
  const int number = named->second.Get("light").GetNumberAsInt();
  const tinygltf::Value& lights = all->second.Get("lights");
  if (number < 0 || static_cast<size_t>(number) >= lights.ArrayLen()) return {};
  const tinygltf::Value& light = lights.Get(number);
  const auto numberOf = [](const tinygltf::Value& owner, const char* name, float otherwise) {
    return owner.Has(name) ? static_cast<float>(owner.Get(name).GetNumberAsDouble()) : otherwise;
  };
  lacquer::vk::AreaLight made;
  made.disk =
      light.Has("type") && light.Get("type").IsString() && light.Get("type").Get<std::string>() == "disk";
  made.position = axis(world, 3);
  made.right = unit(axis(world, 0));
  made.up = unit(axis(world, 1));
  for (size_t c = 0; c < 3 && light.Has("color") && light.Get("color").ArrayLen() == 3; ++c)
    made.color[c] = static_cast<float>(light.Get("color").Get(static_cast<int>(c)).GetNumberAsDouble());
  made.intensity = numberOf(light, "intensity", made.intensity);
  const float scale = std::max({length(axis(world, 0)), length(axis(world, 1)), length(axis(world, 2))});
  made.size = numberOf(light, "size", made.size) * scale;
  if (light.Has("rect")) made.aspect = numberOf(light.Get("rect"), "aspect", made.aspect);
  return made;
}

/// A sampler's value at a time: `width` numbers.
std::vector<float> sampled(const std::vector<float>& times, const std::vector<float>& values,
                           const std::string& interpolation, float time, size_t width, bool rotation) {
  const bool cubic = interpolation == "CUBICSPLINE";
  const size_t step = width * (cubic ? 3 : 1);
  const auto key = [&](size_t i, size_t part = 1) { return &values[i * step + (cubic ? part * width : 0)]; };
  const size_t last = std::min(times.size(), values.size() / step) - 1;
  size_t i = 0;
  while (i < last && times[i + 1] <= time) ++i;
  const float span = i < last ? times[i + 1] - times[i] : 0;
  const float u = span > 0 ? std::clamp((time - times[i]) / span, 0.0F, 1.0F) : 0;
  std::vector<float> out(key(i), key(i) + width);
  if (u == 0 || interpolation == "STEP") return out;
  const float* a = key(i);
  const float* b = key(i + 1);
  if (cubic) {  // glTF 2.0, appendix C, "Cubic Spline Interpolation"
    const float u2 = u * u, u3 = u2 * u;
    for (size_t k = 0; k < width; ++k) {
      out[k] = (2 * u3 - 3 * u2 + 1) * a[k] + span * (u3 - 2 * u2 + u) * key(i, 2)[k] +
               (3 * u2 - 2 * u3) * b[k] + span * (u3 - u2) * key(i + 1, 0)[k];
    }
  } else if (rotation && width == 4) {  // "Spherical Linear Interpolation"
    float cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const float sign = cosine < 0 ? -1.0F : 1.0F;
    cosine = std::min(std::abs(cosine), 1.0F);
    const float angle = std::acos(cosine), sine = std::sin(angle);
    const float of_a = sine < 1e-4F ? 1 - u : std::sin((1 - u) * angle) / sine;
    const float of_b = sine < 1e-4F ? u : std::sin(u * angle) / sine;
    for (size_t k = 0; k < 4; ++k) out[k] = a[k] * of_a + sign * b[k] * of_b;
  } else {
    for (size_t k = 0; k < width; ++k) out[k] = a[k] + (b[k] - a[k]) * u;
  }
  if (rotation && width == 4) {
    const float size = std::sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3]);
    for (size_t k = 0; k < 4 && size > 0; ++k) out[k] /= size;
  }
  return out;
}

/// Triangles of a list, a strip or a fan.
std::vector<uint32_t> triangles(const std::vector<uint32_t>& from, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return from;
  std::vector<uint32_t> list;
  for (size_t i = 0; i + 2 < from.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      list.insert(list.end(), {from[i + 1], from[i + 2], from[0]});
    else
      list.insert(list.end(), {from[i], from[i + 1 + i % 2], from[i + 2 - i % 2]});
  }
  return list;
}

Attribute floats(const std::vector<float>& numbers, uint32_t components) {
  constexpr VkFormat kFormats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                   VK_FORMAT_R32G32B32A32_SFLOAT};
  Attribute made{{kFormats[components - 1], 4 * components, 1},
                 std::vector<unsigned char>(4 * numbers.size())};
  if (!numbers.empty()) std::memcpy(made.bytes.data(), numbers.data(), made.bytes.size());
  return made;
}

/// A component of an accessor; integers that are normalized as what they stand for.
template <class T>
T number(const unsigned char* at, const tinygltf::Accessor& accessor) {
  const auto as = [&](auto zero, float most) {
    std::memcpy(&zero, at, sizeof zero);
    if (most == 0 || !accessor.normalized) return static_cast<T>(zero);
    return static_cast<T>(std::max(static_cast<float>(zero) / most, -1.0F));
  };
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return as(int8_t{}, 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return as(uint8_t{}, 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return as(int16_t{}, 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return as(uint16_t{}, 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return as(uint32_t{}, 0);
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return as(float{}, 0);
    default: return 0;
  }
}

}  // namespace

Scene::Scene(const std::string& path) { load(path, model_); }

/// Where `count` elements of `size` bytes begin in a buffer view; null where the file has not got them.
const unsigned char* Scene::bytesOf(int view, size_t offset, size_t size, size_t count,
                                    size_t& stride) const {
  if (!within(view, model_.bufferViews)) return nullptr;
  const tinygltf::BufferView& of = model_.bufferViews[static_cast<size_t>(view)];
  if (!within(of.buffer, model_.buffers)) return nullptr;
  const std::vector<unsigned char>& data = model_.buffers[static_cast<size_t>(of.buffer)].data;
  stride = of.byteStride == 0 ? size : of.byteStride;
  const size_t needed = count == 0 ? 0 : (count - 1) * stride + size;
  const bool fits = of.byteOffset <= data.size() && of.byteLength <= data.size() - of.byteOffset &&
                    offset <= of.byteLength && needed <= of.byteLength - offset;
  return fits ? data.data() + of.byteOffset + offset : nullptr;
}

/// The accessor's elements as numbers, sparse ones in their places; `type` 0 takes any.
template <class T>
bool Scene::read(int index, int type, std::vector<T>& numbers) const {
  if (!within(index, model_.accessors)) return false;
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<size_t>(index)];
  const int width = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
  if (width <= 0 || bytes <= 0 || (type != 0 && accessor.type != type) || accessor.count > kMost)
    return false;
  const auto wide = static_cast<size_t>(width), one = static_cast<size_t>(bytes);
  // Columns of a matrix begin at multiples of four bytes.
  const bool matrix = accessor.type == TINYGLTF_TYPE_MAT2 || accessor.type == TINYGLTF_TYPE_MAT3 ||
                      accessor.type == TINYGLTF_TYPE_MAT4;
  const size_t side = accessor.type == TINYGLTF_TYPE_MAT2 ? 2 : accessor.type == TINYGLTF_TYPE_MAT3 ? 3 : 4;
  const size_t column = (side * one + 3) / 4 * 4;
  const size_t size = matrix ? side * column : wide * one;
  const auto put = [&](const unsigned char* from, size_t to) {
    for (size_t k = 0; k < wide; ++k) {
      const size_t at = matrix ? k / side * column + k % side * one : k * one;
      numbers[to * wide + k] = number<T>(from + at, accessor);
    }
  };
  numbers.assign(accessor.count * wide, 0);
  size_t stride = 0;
  if (accessor.bufferView >= 0) {
    const unsigned char* from =
        bytesOf(accessor.bufferView, accessor.byteOffset, size, accessor.count, stride);
    if (from == nullptr) return false;
    for (size_t i = 0; i < accessor.count; ++i) put(from + i * stride, i);
  }
  if (!accessor.sparse.isSparse) return true;
  const auto& [count, is, places, values] = accessor.sparse;
  const int place_bytes = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(places.componentType));
  if (count < 0 || place_bytes <= 0 || place_bytes > 4) return false;
  size_t place_stride = 0;
  const unsigned char* at =
      bytesOf(places.bufferView, static_cast<size_t>(places.byteOffset), static_cast<size_t>(place_bytes),
              static_cast<size_t>(count), place_stride);
  const unsigned char* from = bytesOf(values.bufferView, static_cast<size_t>(values.byteOffset), size,
                                      static_cast<size_t>(count), stride);
  if (at == nullptr || from == nullptr) return false;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    uint32_t place = 0;
    std::memcpy(&place, at + i * place_stride, static_cast<size_t>(place_bytes));
    if (place >= accessor.count) return false;
    put(from + i * stride, place);
  }
  return true;
}

/// An accessor as a vertex buffer has it: its own bytes where there is a format for them, else floats.
bool Scene::readAttribute(int index, const lacquer::StoredAttribute& stored, size_t& count,
                          Attribute& made) const {
  if (!within(index, model_.accessors)) return false;
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<size_t>(index)];
  const int width = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
  if (width < 1 || width > 4 || bytes <= 0 || accessor.count == 0 || accessor.count > kMost) return false;
  if (count != 0 && accessor.count != count) return false;
  count = accessor.count;
  made.stream = lacquer::vk::vertexStream(stored);
  if (made.stream.format == VK_FORMAT_UNDEFINED || accessor.sparse.isSparse || accessor.bufferView < 0) {
    std::vector<float> numbers;
    if (!read(index, 0, numbers)) return false;
    made = floats(numbers, static_cast<uint32_t>(width));
    return true;
  }
  const auto size = static_cast<size_t>(width * bytes);
  size_t stride = 0;
  const unsigned char* from = bytesOf(accessor.bufferView, accessor.byteOffset, size, count, stride);
  if (from == nullptr || size > made.stream.stride) return false;
  made.bytes.resize(count * made.stream.stride);
  for (size_t i = 0; i < count; ++i)
    std::memcpy(&made.bytes[i * made.stream.stride], from + i * stride, size);
  return true;
}

/// A matrix for each vertex: its columns as attributes of their own.
bool Scene::readColumns(int index, const lacquer::StoredAttribute& stored, size_t& count, Mesh& mesh) const {
  const auto side = static_cast<size_t>(stored.type.back() - '0');
  std::vector<float> numbers;
  if (!read(index, 0, numbers) || numbers.empty() || numbers.size() % (side * side) != 0) return false;
  const size_t vertices = numbers.size() / (side * side);
  if (count != 0 && vertices != count) return false;
  count = vertices;
  for (size_t c = 0; c < side; ++c) {
    std::vector<float> column(vertices * side);
    for (size_t v = 0; v < vertices; ++v)
      std::copy_n(&numbers[(v * side + c) * side], side, &column[v * side]);
    mesh.attributes[stored.semantic + "_" + std::to_string(c)] = floats(column, static_cast<uint32_t>(side));
  }
  return true;
}

bool Scene::readTargets(const tinygltf::Primitive& from, size_t vertices, Mesh& mesh) const {
  mesh.targets = static_cast<uint32_t>(from.targets.size());
  mesh.width = static_cast<uint32_t>(std::min<size_t>(vertices, 2048));
  mesh.height = static_cast<uint32_t>((vertices + mesh.width - 1) / mesh.width);
  const size_t layer = size_t{4} * mesh.width * mesh.height;
  mesh.deltas.assign(3 * mesh.targets * layer, 0);
  constexpr const char* kSemantics[] = {"POSITION", "NORMAL", "TANGENT"};
  for (size_t t = 0; t < from.targets.size(); ++t) {
    for (size_t s = 0; s < 3; ++s) {
      const auto it = from.targets[t].find(kSemantics[s]);
      std::vector<float> numbers;
      if (it == from.targets[t].end()) continue;
      if (!read(it->second, TINYGLTF_TYPE_VEC3, numbers) || numbers.size() != 3 * vertices) return false;
      for (size_t v = 0; v < vertices; ++v)
        std::copy_n(&numbers[3 * v], 3, &mesh.deltas[(3 * t + s) * layer + 4 * v]);
    }
  }
  return true;
}

bool Scene::readMesh(const lacquer::ContractPrimitive& of, Mesh& mesh) const {
  if (of.mesh >= model_.meshes.size() || of.primitive >= model_.meshes[of.mesh].primitives.size())
    return false;
  const tinygltf::Primitive& from = model_.meshes[of.mesh].primitives[of.primitive];
  const int mode = from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) return false;
  size_t vertices = 0;
  for (const lacquer::StoredAttribute& stored : of.attributes) {
    const auto it = from.attributes.find(stored.semantic);
    if (it == from.attributes.end()) continue;
    const bool read = stored.type.compare(0, 3, "MAT") == 0
                          ? readColumns(it->second, stored, vertices, mesh)
                          : readAttribute(it->second, stored, vertices, mesh.attributes[stored.semantic]);
    if (!read) return false;
  }
  std::vector<float> positions;
  const auto position = from.attributes.find("POSITION");
  if (position == from.attributes.end() || !read(position->second, TINYGLTF_TYPE_VEC3, positions))
    return false;
  mesh.low = mesh.high = {positions[0], positions[1], positions[2]};
  for (size_t i = 0; i < positions.size(); ++i) {
    mesh.low[i % 3] = std::min(mesh.low[i % 3], positions[i]);
    mesh.high[i % 3] = std::max(mesh.high[i % 3], positions[i]);
  }
  if (!from.targets.empty()) {
    std::vector<float> numbers(vertices);
    for (size_t v = 0; v < vertices; ++v) numbers[v] = static_cast<float>(v);
    mesh.attributes["MORPH_VERTEX"] = floats(numbers, 1);
    if (!readTargets(from, vertices, mesh)) return false;
  }
  std::vector<uint32_t> indices(vertices);
  for (uint32_t v = 0; v < vertices; ++v) indices[v] = v;
  if (from.indices >= 0 && !read(from.indices, TINYGLTF_TYPE_SCALAR, indices)) return false;
  mesh.indices = triangles(indices, mode);
  mesh.indices.resize(mesh.indices.size() / 3 * 3);
  return !mesh.indices.empty() && *std::max_element(mesh.indices.begin(), mesh.indices.end()) < vertices;
}

std::vector<Mesh> Scene::meshes(const lacquer::Contract& contract) const {
  std::vector<Mesh> all;
  for (const lacquer::ContractPrimitive& primitive : contract.primitives) {
    if (!readMesh(primitive, all.emplace_back())) {
      all.back() = {};
      complain("mesh " + std::to_string(primitive.mesh) + ", primitive " +
               std::to_string(primitive.primitive) +
               ": its data are absent, too short or of a wrong type; it is not drawn");
    }
  }
  return all;
}

Instances Scene::instances(int node) const {
  const tinygltf::Value& extension =
      model_.nodes[static_cast<size_t>(node)].extensions.at("EXT_mesh_gpu_instancing");
  const tinygltf::Value& accessors = extension.Get("attributes");
  Instances made;
  std::vector<float> numbers[3];
  size_t count = 0;
  constexpr const char* kNames[] = {"TRANSLATION", "ROTATION", "SCALE"};
  for (size_t k = 0; k < 3; ++k) {
    if (!accessors.Has(kNames[k])) continue;
    const uint32_t width = k == 1 ? 4 : 3;
    const bool good = read(accessors.Get(kNames[k]).GetNumberAsInt(),
                           k == 1 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, numbers[k]);
    if (!good || numbers[k].empty() || (count != 0 && numbers[k].size() != count * width)) {
      complain("node " + std::to_string(node) + ": its instances cannot be read; it is drawn once");
      return {{}, {kIdentity}};
    }
    count = numbers[k].size() / width;
    made.attributes[kNames[k]] = floats(numbers[k], width);
  }
  for (size_t i = 0; i < count; ++i) {
    Vec3 translation{}, scale{1, 1, 1};
    Vec4 rotation{0, 0, 0, 1};
    if (!numbers[0].empty()) std::copy_n(&numbers[0][3 * i], 3, translation.begin());
    if (!numbers[1].empty()) std::copy_n(&numbers[1][4 * i], 4, rotation.begin());
    if (!numbers[2].empty()) std::copy_n(&numbers[2][3 * i], 3, scale.begin());
    made.places.push_back(placed(translation, rotation, scale));
  }
  return made;
}

void Scene::animate(float seconds, Pointers& pointers) {
  for (const tinygltf::Animation& animation : model_.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (!within(channel.sampler, animation.samplers)) continue;
      const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<size_t>(channel.sampler)];
      std::vector<float> times, values;
      if (!read(sampler.input, TINYGLTF_TYPE_SCALAR, times) || !read(sampler.output, 0, values) ||
          times.empty()) {
        complain("an animation's data cannot be read; it rests");
        continue;
      }
      const size_t width = values.size() / (times.size() * (sampler.interpolation == "CUBICSPLINE" ? 3 : 1));
      if (width == 0) continue;
      const float end = times.back();
      const float time = end > 0 && seconds > end ? std::fmod(seconds, end) : seconds;
      std::string path = channel.target_path, pointer;
      if (const auto it = channel.target_extensions.find("KHR_animation_pointer");
          path == "pointer" && it != channel.target_extensions.end() && it->second.Has("pointer"))
        pointer = it->second.Get("pointer").Get<std::string>();
      int node = channel.target_node, at = 0;
      if (std::sscanf(pointer.c_str(), "/nodes/%d/%n", &node, &at) == 1 && at > 0)
        path = pointer.substr(static_cast<size_t>(at));
      const std::vector<float> value =
          sampled(times, values, sampler.interpolation, time, width, path == "rotation");
      if (path == "pointer") {
        pointers[pointer] = value;
      } else if (within(node, nodes_)) {
        Node& to = nodes_[static_cast<size_t>(node)];
        if (path == "weights") to.weights = value;
        if (path == "extensions/KHR_node_visibility/visible") to.visible = value[0] != 0;
        if (path == "translation" && width == 3) std::copy_n(value.begin(), 3, to.translation.begin());
        if (path == "scale" && width == 3) std::copy_n(value.begin(), 3, to.scale.begin());
        if (path == "rotation" && width == 4) std::copy_n(value.begin(), 4, to.rotation.begin());
      }
    }
  }
}

void Scene::place(int index, const Matrix& parent, bool hidden, int depth) {
  if (!within(index, nodes_) || nodes_[static_cast<size_t>(index)].shown || depth > kDeepest) return;
  Node& node = nodes_[static_cast<size_t>(index)];
  node.shown = true;
  node.hidden = hidden || !node.visible;
  node.world = parent * (node.decomposed ? placed(node.translation, node.rotation, node.scale) : node.matrix);
  for (const int child : model_.nodes[static_cast<size_t>(index)].children)
    place(child, node.world, node.hidden, depth + 1);
}

Moment Scene::at(float seconds, const lacquer::Contract& contract) {
  Moment moment;
  nodes_.assign(model_.nodes.size(), {});
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const tinygltf::Node& from = model_.nodes[i];
    take(from.translation, nodes_[i].translation);
    take(from.rotation, nodes_[i].rotation);
    take(from.scale, nodes_[i].scale);
    take(from.matrix, nodes_[i].matrix);
    nodes_[i].decomposed = from.matrix.size() != 16;
    nodes_[i].visible = isVisible(from);
    nodes_[i].weights.assign(from.weights.begin(), from.weights.end());
    if (from.weights.empty() && within(from.mesh, model_.meshes)) {
      const std::vector<double>& weights = model_.meshes[static_cast<size_t>(from.mesh)].weights;
      nodes_[i].weights.assign(weights.begin(), weights.end());
    }
  }
  animate(seconds, moment.pointers);
  const int scene = std::max(model_.defaultScene, 0);
  if (!within(scene, model_.scenes)) throw std::runtime_error("the file has no scene");
  for (const int node : model_.scenes[static_cast<size_t>(scene)].nodes) place(node, kIdentity, false, 0);
  for (const tinygltf::Skin& skin : model_.skins) {
    std::vector<float> binds;
    const bool bound =
        read(skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4, binds) && binds.size() >= 16 * skin.joints.size();
    std::vector<Matrix>& joints = moment.joints.emplace_back(skin.joints.size(), kIdentity);
    for (size_t j = 0; j < joints.size(); ++j) {
      Matrix bind = kIdentity;
      if (bound) std::copy_n(&binds[16 * j], 16, bind.begin());
      if (within(skin.joints[j], nodes_))
        joints[j] = nodes_[static_cast<size_t>(skin.joints[j])].world * bind;
    }
  }
  const auto animated = [&](const std::string& pointer, std::vector<float> value) {
    const auto it = moment.pointers.find(pointer);
    return it != moment.pointers.end() && it->second.size() == value.size() ? it->second : value;
  };
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const tinygltf::Node& from = model_.nodes[i];
    const Node& node = nodes_[i];
    if (!node.shown) continue;
    const bool skinned = within(from.skin, model_.skins);
    for (size_t p = 0; p < contract.primitives.size(); ++p) {
      if (node.hidden || from.mesh < 0 || contract.primitives[p].mesh != static_cast<size_t>(from.mesh))
        continue;
      const bool many = from.extensions.count("EXT_mesh_gpu_instancing") != 0;
      moment.draws.push_back({p, skinned ? kIdentity : node.world, &node.weights, skinned ? from.skin : -1,
                              many ? static_cast<int>(i) : -1});
    }
    if (within(from.camera, model_.cameras)) {
      const tinygltf::Camera& camera = model_.cameras[static_cast<size_t>(from.camera)];
      View view{node.world, static_cast<float>(camera.perspective.yfov),
                static_cast<float>(camera.perspective.znear), static_cast<float>(camera.perspective.zfar)};
      view.yfov = animated("/cameras/" + std::to_string(from.camera) + "/perspective/yfov", {view.yfov})[0];
      if (camera.type == "orthographic")
        view = {node.world,
                0,
                static_cast<float>(camera.orthographic.znear),
                static_cast<float>(camera.orthographic.zfar),
                static_cast<float>(camera.orthographic.xmag),
                static_cast<float>(camera.orthographic.ymag)};
      moment.cameras.push_back(view);
    }
    if (node.hidden) continue;  // cameras see from there all the same
    if (const auto area = areaOf(model_, from, node.world)) moment.areas.push_back(*area);
    const auto lit = from.extensions.find("KHR_lights_punctual");
    const int number = lit != from.extensions.end() && lit->second.Has("light")
                           ? lit->second.Get("light").GetNumberAsInt()
                           : -1;
    if (!within(number, model_.lights)) continue;
    const tinygltf::Light& light = model_.lights[static_cast<size_t>(number)];
    const std::string pointer = "/extensions/KHR_lights_punctual/lights/" + std::to_string(number) + "/";
    using Kind = lacquer::vk::PunctualLight::Kind;
    lacquer::vk::PunctualLight made;
    made.kind = light.type == "directional" ? Kind::Directional
                : light.type == "spot"      ? Kind::Spot
                                            : Kind::Point;
    made.position = axis(node.world, 3);
    made.direction = unit(axis(node.world, 2) * -1);
    take(light.color, made.color);
    const std::vector<float> color = animated(pointer + "color", {made.color.begin(), made.color.end()});
    std::copy_n(color.begin(), 3, made.color.begin());
    made.intensity = animated(pointer + "intensity", {static_cast<float>(light.intensity)})[0];
    made.range = animated(pointer + "range", {static_cast<float>(light.range)})[0];
    made.inner_cone_angle = static_cast<float>(light.spot.innerConeAngle);
    made.outer_cone_angle = static_cast<float>(light.spot.outerConeAngle);
    moment.lights.push_back(made);
  }
  return moment;
}

Matrix View::viewProjection(float aspect) const {
  const Matrix projection = half_width > 0 ? orthographic(half_width, half_height, near, far)
                                           : perspective(yfov, aspect, near, far);
  return projection * inverse(node);
}

}  // namespace renderer
