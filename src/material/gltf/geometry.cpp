#include "gltf/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>

#include "gltf/members.h"

namespace lacquer::gltf {

namespace {

using Vec3 = std::array<double, 3>;
using Matrix = std::array<double, 16>;  ///< by columns

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr double kFarthest = 1e15;
/// Elements of accessors that are read of a file.
constexpr size_t kMostElements = 40 * kMostCorners;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 widened(const std::array<float, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}
/// Of length 1; `otherwise` where there is no direction.
std::array<float, 3> unit(const Vec3& a, const std::array<float, 3>& otherwise) {
  const double length = std::sqrt(dot(a, a));
  if (!(length > 1e-30) || !std::isfinite(length)) return otherwise;
  return {static_cast<float>(a[0] / length), static_cast<float>(a[1] / length),
          static_cast<float>(a[2] / length)};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return c;
}

Vec3 turned(const Matrix& m, const Vec3& v) {
  return {m[0] * v[0] + m[4] * v[1] + m[8] * v[2], m[1] * v[0] + m[5] * v[1] + m[9] * v[2],
          m[2] * v[0] + m[6] * v[1] + m[10] * v[2]};
}

/// The cofactors of the upper 3x3: the inverse transpose times the determinant, for normals.
Matrix cofactors(const Matrix& m) {
  const Vec3 x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
  const Vec3 a = cross(y, z), b = cross(z, x), c = cross(x, y);
  return {a[0], a[1], a[2], 0, b[0], b[1], b[2], 0, c[0], c[1], c[2], 0, 0, 0, 0, 1};
}

/// Numbers of an array of exactly that many; nothing else.
template <size_t N>
std::optional<std::array<double, N>> numbersOf(const Json& object, std::string_view key) {
  const Json* array = member(object, key);
  if (array == nullptr || !array->is_array() || array->size() != N) return std::nullopt;
  std::array<double, N> numbers{};
  for (size_t i = 0; i < N; ++i) {
    if (!(*array)[i].is_number()) return std::nullopt;
    numbers[i] = (*array)[i].get<double>();
  }
  return numbers;
}

Matrix placeOf(const Json& node) {
  if (const auto matrix = numbersOf<16>(node, "matrix")) return *matrix;
  const auto t = numbersOf<3>(node, "translation").value_or(Vec3{0, 0, 0});
  const auto s = numbersOf<3>(node, "scale").value_or(Vec3{1, 1, 1});
  const auto [x, y, z, w] = numbersOf<4>(node, "rotation").value_or(std::array<double, 4>{0, 0, 0, 1});
  return {(1 - 2 * (y * y + z * z)) * s[0],
          2 * (x * y + z * w) * s[0],
          2 * (x * z - y * w) * s[0],
          0,
          2 * (x * y - z * w) * s[1],
          (1 - 2 * (x * x + z * z)) * s[1],
          2 * (y * z + x * w) * s[1],
          0,
          2 * (x * z + y * w) * s[2],
          2 * (y * z - x * w) * s[2],
          (1 - 2 * (x * x + y * y)) * s[2],
          0,
          t[0],
          t[1],
          t[2],
          1};
}

/// How a component lies in the bytes: glTF 2.0, section 3.6.2.2.
struct Component {
  size_t number, bytes;
  double most;  ///< of a normalized integer
  float (*read)(const char*);
};

template <class T>
float readAs(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));  // glTF is little-endian, as every machine that this runs on
  return static_cast<float>(value);
}

constexpr Component kComponents[] = {{5120, 1, 127, readAs<int8_t>},    {5121, 1, 255, readAs<uint8_t>},
                                     {5122, 2, 32767, readAs<int16_t>}, {5123, 2, 65535, readAs<uint16_t>},
                                     {5125, 4, 0, readAs<uint32_t>},    {5126, 4, 0, readAs<float>}};

size_t componentsOf(const Json& accessor) {
  const Json* type = member(accessor, "type");
  if (type == nullptr || !type->is_string()) return 0;
  constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  for (size_t i = 0; i < 4; ++i) {
    if (json::text(*type) == kTypes[i]) return i + 1;
  }
  return 0;
}

/// Where the elements of an accessor lie; checked.
struct Elements {
  std::shared_ptr<const std::string> buffer;
  size_t first = 0, stride = 0, count = 0, components = 0;
  const Component* component = nullptr;
  bool normalized = false;

  const char* at(size_t element, size_t k) const {
    return buffer->data() + first + element * stride + k * component->bytes;
  }
  float value(size_t element, size_t k) const {
    const float raw = component->read(at(element, k));
    if (!normalized || component->most == 0) return raw;
    return std::max(raw / static_cast<float>(component->most), -1.0F);
  }
};

class Reader {
public:
  explicit Reader(const TextureFile& file) : file_(file), root_(file.root()) {}

  Geometry run(size_t material) {
    material_ = material;
    visitScene();
    return std::move(geometry_);
  }

private:
  // -- nodes --

  struct Placed {
    size_t node;
    Matrix place;
  };

  void visitScene() {
    const size_t nodes = arraySize(root_, "nodes");
    std::vector<bool> visited(nodes, false);
    std::vector<Placed> open;
    const auto push = [&](const Json* list, const Matrix& place) {
      if (list == nullptr || !list->is_array()) return;
      // The last is taken first.
      for (size_t i = list->size(); i-- > 0;) {
        const std::optional<size_t> node = whole(&(*list)[i]);
        // Each has one parent at most: longer lists than there are nodes say something twice.
        if (node && *node < nodes && open.size() <= 2 * nodes) open.push_back({*node, place});
      }
    };
    const Json* scene = element(root_, "scenes", wholeOr(root_, "scene", 0));
    if (scene != nullptr) {
      push(member(*scene, "nodes"), kIdentity);
    } else {
      for (size_t i = nodes; i-- > 0;) open.push_back({i, kIdentity});
    }
    while (!open.empty() && !full_) {
      const Placed next = open.back();
      open.pop_back();
      // A node has one parent; a file that says otherwise, or has a circle, is read once round.
      if (visited[next.node]) continue;
      visited[next.node] = true;
      const Json* node = element(root_, "nodes", next.node);
      if (node == nullptr) continue;
      const Matrix place = product(next.place, placeOf(*node));
      if (const Json* mesh = element(root_, "meshes", wholeMember(*node, "mesh"))) visitMesh(*mesh, place);
      push(member(*node, "children"), place);
    }
  }

  /// A mesh may stand at as many nodes as there are: what it comes to is read once.
  void visitMesh(const Json& mesh, const Matrix& place) {
    const auto [known, fresh] = meshes_.try_emplace(&mesh);
    if (fresh) known->second = readMesh(mesh);
    for (const Geometry& one : known->second) {
      if (geometry_.triangles.size() + one.triangles.size() > 3 * kMostTriangles ||
          geometry_.corners.size() + one.corners.size() > kMostCorners) {
        leaveOut(
            fmt::format("there are more than {} triangles or {} vertices", kMostTriangles, kMostCorners));
        full_ = true;
      }
      if (full_) return;
      add(one, place);
    }
  }

  /// Its primitives of the material that have triangles, until they are too many.
  std::vector<Geometry> readMesh(const Json& mesh) {
    constexpr size_t kHeld = 4;  // a corner that is held takes the room of so many elements
    std::vector<Geometry> found;
    size_t corners = 0;
    const Json* primitives = member(mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return found;
    for (size_t i = 0; i < primitives->size() && !full_ && corners <= kMostCorners; ++i) {
      const Json& primitive = (*primitives)[i];
      if (!primitive.is_object() || wholeMember(primitive, "material") != material_) continue;
      std::optional<Geometry> one = read(primitive);
      if (!one || one->triangles.empty()) continue;
      corners += one->corners.size();
      elements_ += kHeld * one->corners.size();
      found.push_back(std::move(*one));
    }
    return found;
  }

  void add(const Geometry& one, const Matrix& place) {
    const auto first = static_cast<uint32_t>(geometry_.corners.size());
    const Matrix normals = cofactors(place);
    const bool mirrored = dot(turned(normals, {1, 0, 0}), {place[0], place[1], place[2]}) < 0;
    std::vector<Corner> corners;
    for (Corner corner : one.corners) {
      const Vec3 p = turned(place, widened(corner.position));
      for (size_t i = 0; i < 3; ++i) {
        const double x = p[i] + place[12 + i];
        if (!(std::abs(x) < kFarthest)) return addNothing(one);
        corner.position[i] = static_cast<float>(x);
      }
      Vec3 n = turned(normals, widened(corner.normal));
      if (mirrored) n = {-n[0], -n[1], -n[2]};
      corner.normal = unit(n, {0, 0, 1});
      const std::array<float, 3> t =
          unit(turned(place, widened({corner.tangent[0], corner.tangent[1], corner.tangent[2]})), {1, 0, 0});
      corner.tangent = {t[0], t[1], t[2], (corner.tangent[3] < 0) != mirrored ? -1.0F : 1.0F};
      corners.push_back(corner);
    }
    geometry_.corners.insert(geometry_.corners.end(), corners.begin(), corners.end());
    for (size_t i = 0; i + 2 < one.triangles.size(); i += 3) {
      // Mirrored triangles run the other way round.
      const size_t order[] = {i, mirrored ? i + 2 : i + 1, mirrored ? i + 1 : i + 2};
      for (const size_t k : order) geometry_.triangles.push_back(first + one.triangles[k]);
    }
  }

  /// What comes to nothing at one node after the other takes its time, too.
  void addNothing(const Geometry& one) {
    leaveOut("a position is no number, or too far away");
    elements_ += one.corners.size();
    full_ = full_ || elements_ > kMostElements;
  }

  void leaveOut(std::string why) {
    if (geometry_.left_out.empty()) geometry_.left_out = std::move(why);
  }

  // -- accessors --

  std::shared_ptr<const std::string> buffer(size_t index) {
    const auto [known, fresh] = buffers_.try_emplace(index);
    if (!fresh) return known->second;
    const Result<std::shared_ptr<const std::string>> bytes = file_.bufferBytes(index, {});
    if (!bytes) leaveOut(bytes.error()[0].message);
    return known->second = bytes ? *bytes : std::make_shared<const std::string>();
  }

  std::optional<Elements> elements(std::optional<size_t> index) {
    const auto wrong = [&](const char* why) {
      leaveOut(why);
      return std::nullopt;
    };
    const Json* accessor = element(root_, "accessors", index);
    if (accessor == nullptr) return wrong("an accessor is not there");
    if (member(*accessor, "sparse") != nullptr) return wrong("an accessor is sparse");
    const Json* view = element(root_, "bufferViews", wholeMember(*accessor, "bufferView"));
    if (view == nullptr) return wrong("an accessor has no bufferView");
    const std::optional<size_t> of_view = wholeMember(*view, "buffer");
    if (element(root_, "buffers", of_view) == nullptr) return wrong("a bufferView has no buffer");
    Elements out;
    out.components = componentsOf(*accessor);
    const std::optional<size_t> number = wholeMember(*accessor, "componentType");
    for (const Component& row : kComponents) {
      if (number == row.number) out.component = &row;
    }
    if (out.components == 0 || out.component == nullptr) return wrong("an accessor has an unknown type");
    out.count = wholeMember(*accessor, "count").value_or(0);
    if (out.count == 0 || out.count > 3 * kMostTriangles)
      return wrong("an accessor is empty, or longer than what is read");
    // Primitives that come to nothing may read one accessor again and again.
    elements_ += out.count;
    full_ = full_ || elements_ > kMostElements;
    if (full_) return wrong("there are too many vertices to read");
    const Json* normalized = member(*accessor, "normalized");
    out.normalized = normalized != nullptr && *normalized == true;
    const size_t size = out.components * out.component->bytes;
    out.stride = wholeOr(*view, "byteStride", size).value_or(0);
    constexpr size_t kWidest = 252;  // glTF 2.0, section 5.11.4
    if (out.stride < size || out.stride > std::max(size, kWidest)) return wrong("a byteStride is wrong");
    // All sizes are below 2^53, and the elements' below 2^30: no sum or product passes 2^64.
    const std::optional<size_t> of_buffer = wholeOr(*view, "byteOffset", 0);
    const size_t length = wholeMember(*view, "byteLength").value_or(0);
    const std::optional<size_t> offset = wholeOr(*accessor, "byteOffset", 0);
    if (!of_buffer || !offset) return wrong("a byteOffset is no whole number");
    const size_t needed = *offset + out.stride * (out.count - 1) + size;
    out.buffer = buffer(*of_view);
    if (needed > length || *of_buffer + length > out.buffer->size())
      return wrong("an accessor lies outside of its buffer");
    out.first = *of_buffer + *offset;
    return out;
  }

  /// An attribute of as many vertices, if the primitive has it; an error leaves the primitive out.
  enum class Got : uint8_t { Absent, Read, Wrong };
  template <class Take>
  Got attribute(const Json& attributes, std::string_view name, size_t least, size_t count, const Take& take) {
    if (member(attributes, name) == nullptr) return Got::Absent;
    const std::optional<Elements> found = elements(wholeMember(attributes, name));
    if (!found) return Got::Wrong;
    if (found->components < least || found->count < count) {
      leaveOut("an attribute has too few numbers");
      return Got::Wrong;
    }
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < std::min<size_t>(found->components, 4); ++k) {
        const float x = found->value(i, k);
        take(i, k, std::isfinite(x) ? x : 0.0F);
      }
    }
    return Got::Read;
  }

  /// A primitive in its mesh's space; none where it cannot be read.
  std::optional<Geometry> read(const Json& primitive) {
    const Json* attributes = member(primitive, "attributes");
    if (attributes == nullptr || !attributes->is_object()) return std::nullopt;
    const std::optional<Elements> positions = elements(wholeMember(*attributes, "POSITION"));
    if (!positions) return std::nullopt;
    if (positions->components != 3 || positions->count > kMostCorners) {
      leaveOut("a primitive has too many vertices, or positions that are none");
      return std::nullopt;
    }
    Geometry out;
    const size_t count = positions->count;
    out.corners.resize(count);
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        const float x = positions->value(i, k);
        if (!(std::abs(static_cast<double>(x)) < kFarthest)) {
          leaveOut("a position is no number, or too far away");
          return std::nullopt;
        }
        out.corners[i].position[k] = x;
      }
    }
    const Got normal = attribute(*attributes, "NORMAL", 3, count, [&](size_t i, size_t k, float x) {
      if (k < 3) out.corners[i].normal[k] = x;
    });
    const Got tangent = attribute(*attributes, "TANGENT", 4, count,
                                  [&](size_t i, size_t k, float x) { out.corners[i].tangent[k] = x; });
    const Got color = attribute(*attributes, "COLOR_0", 3, count,
                                [&](size_t i, size_t k, float x) { out.corners[i].color[k] = x; });
    bool wrong = normal == Got::Wrong || tangent == Got::Wrong || color == Got::Wrong;
    for (size_t set = 0; set < 4; ++set) {
      wrong |=
          attribute(*attributes, fmt::format("TEXCOORD_{}", set), 2, count, [&](size_t i, size_t k, float x) {
            if (k < 2) out.corners[i].uv[set][k] = x;
          }) == Got::Wrong;
    }
    if (wrong || !indices(primitive, count, out.triangles)) return std::nullopt;
    if (normal == Got::Absent) flatten(out);
    if (normal == Got::Absent || tangent == Got::Absent) makeTangents(out);
    return out;
  }

  bool indices(const Json& primitive, size_t count, std::vector<uint32_t>& out) {
    std::vector<uint32_t> list;
    if (member(primitive, "indices") != nullptr) {
      const std::optional<Elements> found = elements(wholeMember(primitive, "indices"));
      if (!found) return false;
      const bool whole = found->component->number == 5121 || found->component->number == 5123 ||
                         found->component->number == 5125;
      if (found->components != 1 || !whole) return leaveOut("indices are no whole numbers"), false;
      for (size_t i = 0; i < found->count; ++i) {
        uint32_t index = 0;  // little-endian; a float would lose the last bits of large ones
        for (size_t b = 0; b < found->component->bytes; ++b)
          index |= static_cast<uint32_t>(static_cast<unsigned char>(found->at(i, 0)[b])) << (8 * b);
        list.push_back(index);
      }
    } else {
      for (size_t i = 0; i < count; ++i) list.push_back(static_cast<uint32_t>(i));
    }
    const size_t mode = wholeOr(primitive, "mode", 4).value_or(0);
    const auto triangle = [&](size_t a, size_t b, size_t c) {
      // Triangles of vertices that are not there, or are the same twice, are none.
      const uint32_t x = list[a], y = list[b], z = list[c];
      if (x < count && y < count && z < count && x != y && y != z && z != x) out.insert(out.end(), {x, y, z});
    };
    if (mode == 4) {
      for (size_t i = 0; i + 2 < list.size(); i += 3) triangle(i, i + 1, i + 2);
    } else if (mode == 5) {
      for (size_t i = 0; i + 2 < list.size(); ++i) triangle(i, i + 1 + i % 2, i + 2 - i % 2);
    } else if (mode == 6) {
      for (size_t i = 0; i + 2 < list.size(); ++i) triangle(0, i + 1, i + 2);
    } else {
      return leaveOut("a primitive has no triangles"), false;
    }
    return true;
  }

  /// Flat normals, as glTF asks for: each triangle with vertices of its own.
  static void flatten(Geometry& of) {
    std::vector<Corner> corners;
    for (size_t i = 0; i + 2 < of.triangles.size(); i += 3) {
      Vec3 p[3];
      for (size_t k = 0; k < 3; ++k) p[k] = widened(of.corners[of.triangles[i + k]].position);
      const std::array<float, 3> n = unit(cross(minus(p[1], p[0]), minus(p[2], p[0])), {0, 0, 1});
      for (size_t k = 0; k < 3; ++k) {
        corners.push_back(of.corners[of.triangles[i + k]]);
        corners.back().normal = n;
        of.triangles[i + k] = static_cast<uint32_t>(i + k);
      }
    }
    of.corners = std::move(corners);
  }

  /// Along the first texture coordinate's u, averaged over a vertex's triangles; where that says nothing any
  /// direction across the normal.
  static void makeTangents(Geometry& of) {
    std::vector<Vec3> along(of.corners.size(), Vec3{}), up(of.corners.size(), Vec3{});
    for (size_t i = 0; i + 2 < of.triangles.size(); i += 3) {
      const Corner& a = of.corners[of.triangles[i]];
      const Corner& b = of.corners[of.triangles[i + 1]];
      const Corner& c = of.corners[of.triangles[i + 2]];
      const Vec3 e = minus(widened(b.position), widened(a.position));
      const Vec3 f = minus(widened(c.position), widened(a.position));
      const double bu = static_cast<double>(b.uv[0][0] - a.uv[0][0]);
      const double bv = static_cast<double>(b.uv[0][1] - a.uv[0][1]);
      const double cu = static_cast<double>(c.uv[0][0] - a.uv[0][0]);
      const double cv = static_cast<double>(c.uv[0][1] - a.uv[0][1]);
      const double sign = bu * cv - bv * cu < 0 ? -1 : 1;
      for (size_t k = 0; k < 3; ++k) {
        for (size_t x = 0; x < 3; ++x) {
          along[of.triangles[i + k]][x] += sign * (e[x] * cv - f[x] * bv);
          up[of.triangles[i + k]][x] += sign * (f[x] * bu - e[x] * cu);
        }
      }
    }
    for (size_t i = 0; i < of.corners.size(); ++i) {
      const Vec3 n = widened(unit(widened(of.corners[i].normal), {0, 0, 1}));
      const double off = dot(n, along[i]);
      const Vec3 flat{along[i][0] - off * n[0], along[i][1] - off * n[1], along[i][2] - off * n[2]};
      const Vec3 axis = std::abs(n[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      const std::array<float, 3> any = unit(cross(cross(n, axis), n), {1, 0, 0});
      const std::array<float, 3> t = unit(flat, any);
      // v runs down an image, and B = sign N x T along it: glTF has the sign of what OpenGL calls up.
      const float sign = dot(cross(n, widened(t)), up[i]) < 0 ? -1.0F : 1.0F;
      of.corners[i].tangent = {t[0], t[1], t[2], sign};
    }
  }

  const TextureFile& file_;
  const Json& root_;
  size_t material_ = 0, elements_ = 0;
  bool full_ = false;
  Geometry geometry_;
  std::map<const Json*, std::vector<Geometry>> meshes_;
  std::map<size_t, std::shared_ptr<const std::string>> buffers_;
};

}  // namespace

Geometry geometryOf(const TextureFile& file, size_t material) { return Reader(file).run(material); }

}  // namespace lacquer::gltf
