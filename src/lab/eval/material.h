// A material of a file made ready for the CPU evaluator: its module, and its textures as samplers.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "eval/image.h"
#include "eval/subject.h"
#include "gltf/geometry.h"
#include "gltf/texture_source.h"
#include "lacquer.h"
#include "shader/module.h"

namespace lacquer {

/// The images behind a file's textures, or a graph's, opened and decoded when first asked for. Those that
/// nobody uses any more go, the longest unused first, when others need their room.
class FileImages {
public:
  /// With `bytes` they are the file's, and `file` only stands for it.
  FileImages(std::string file, const Options& options, std::shared_ptr<const std::string> bytes = {});
  /// Of a graph: there are no textures of glTF's, but images lie beside its file, or with `in_memory` none.
  static FileImages ofGraph(std::string file, const Options& options, bool in_memory = false);

  const std::string& file() const { return file_; }
  struct Loaded {
    std::shared_ptr<const eval::Image> image;
    eval::Lookup lookup;
  };
  /// Errors: those of gltf::TextureFile and of eval::decodeImage(), and "image-too-large" where the images in
  /// use leave no room.
  Result<Loaded> load(int texture, bool srgb);
  /// The image and the sampler of a graph's texture that is a file.
  Result<Loaded> load(const graph::Texture& texture);
  Place placeOf(const graph::Texture& texture) const;
  /// What load() has to say beside its errors, once: images that were passed over for another one. And what
  /// note() was told.
  Diagnostics takeNotes() { return std::exchange(notes_, {}); }
  void note(Diagnostic note) { notes_.push_back(std::move(note)); }
  /// What the file's primitives of a material look like. Nothing where the file cannot be opened.
  gltf::Geometry geometry(size_t material);
  /// The files that were read for images and buffers.
  Strings read() const { return opened_ ? opened_->filesRead() : Strings(); }

private:
  struct Held {
    std::shared_ptr<const eval::Image> image;
    uint64_t pixels = 0;  ///< of 8 bits per channel
    uint64_t used = 0;    ///< a later use has a larger number
  };

  /// Its images are files that the document names, and it has no geometry.
  bool isMaterialX() const { return file_.ends_with(".mtlx"); }
  Result<void> open();
  /// A graph's texture with an image for each tile, as an array with a layer for each.
  Result<Loaded> loadTiles(const graph::Texture& texture);
  Result<Held> decode(const Result<std::string>& bytes, const Place& place);
  template <class Bytes>
  Result<std::shared_ptr<const eval::Image>> image(const std::string& key, const Place& place, Bytes bytes);
  void passedOver(int texture, const gltf::TextureSource& source);
  bool makeRoom(uint64_t pixels);

  std::string file_;
  std::shared_ptr<const std::string> bytes_;
  bool of_graph_ = false, in_memory_ = false;
  gltf::TextureAccess access_;
  std::optional<gltf::TextureFile> opened_;
  std::map<std::string, Held> images_;  ///< by the image's index or its URI
  uint64_t held_ = 0, uses_ = 0;        ///< pixels; calls of load()
  std::set<int> noted_;                 ///< textures
  Diagnostics notes_;
};

/// What stands behind a texture slot: an image or a constant.
struct BoundTexture {
  std::optional<std::array<double, 4>> constant;
  std::shared_ptr<const eval::Image> image;
  eval::Lookup lookup;
  ir::Type type = ir::Type::Texture2D;
};

class EvalMaterial {
public:
  /// What stands for a texture that has no image for these reasons; nothing where that is an error.
  using Substitute =
      std::function<std::optional<std::array<double, 4>>(const ir::TextureSlot&, const Diagnostics& why)>;

  /// `images` must outlive this.
  EvalMaterial(FileImages& images, const Options& options) : images_(images), options_(options) {}

  /// "baseColorTexture=0.5,0.5,0.5,1", each. Errors: "bad-texel".
  Result<void> setTexels(const std::vector<std::string>& texts);
  /// Before lower(), whose errors say what is wrong with it. `anyway`: names that no parameter has are those
  /// of other materials.
  void setTrial(Trial trial, bool anyway = false) {
    trial_ = std::move(trial);
    anyway_ = anyway;
  }

  /// Before lower(): parameters whose values differ from those of today, and maybe from point to point.
  void setColumns(std::map<std::string, eval::Column> columns) { columns_ = std::move(columns); }
  /// The columns of other points for the same parameters, after lower(). Errors: those of numbers.
  Result<void> replaceColumns(std::map<std::string, eval::Column> columns);
  /// The same by the parameters' names, after lower().
  const std::map<std::string, eval::Column>& columns() const { return columns_; }

  /// The primitive has no tangents: frames come of derivatives.
  void leaveOutTangents() { tangents_ = false; }
  /// It has these of the application's own, "_WETNESS", sorted.
  void setAttributes(Strings attributes) { attributes_ = std::move(attributes); }

  /// Integers that are looked at come in two outputs, whose sum they are exactly.
  void showWhole() { whole_ = true; }

  /// The module of the options' template, or of a graph's own, as lowered; of a material for a primitive with
  /// every attribute but what was left out: points are given all of them. Nodes that have the variant of that
  /// name use it. Errors: "unknown-texture", those of a graph and of EvalSubject::graph().
  Result<void> lower(const EvalSubject& subject, const Language& library, bool environment,
                     const std::string& variant, Messages& messages);

  /// The float engine computes what the shader does: values of the material's rate in the preshader, then
  /// floats.
  void place(const passes::LightFacts& lights);
  /// The double engine computes the module as it was lowered: with the options' counts of lights, where they
  /// are fixed, and nothing else.
  void countLights(const passes::LightFacts& lights);

  /// The trial's time and frame, in the place of bindPoints()' zeros.
  void bindClock(eval::Bindings& bindings) const;

  /// Samplers of the textures that the outputs reach, but for the environment's maps; its table of factors is
  /// one of them. Errors: "image-missing" and the like, one for each texture, where there is no substitute;
  /// the images' notes say where a graph's colour stands for an image.
  Result<void> bindTextures(const Substitute& substitute, eval::Bindings& bindings);
  /// What bindTextures() bound, by slot.
  const std::map<std::string, BoundTexture>& textures() const { return bound_; }

  /// The environment maps, cubes, that the outputs reach and that have no constant.
  std::vector<const ir::TextureSlot*> environments() const;

  const ir::Module& module() const { return module_; }
  /// Of the node's output that is looked at.
  struct Shown {
    ir::Type type = ir::Type::Float;
    std::optional<ir::Range> range;
  };
  const std::optional<Shown>& shown() const { return shown_; }
  /// Those of the trial's parameters that lower() has set, as they were named.
  const Strings& changed() const { return changed_; }
  /// Of the graph that was built of a material; empty for one that was given.
  const std::string& profile() const { return profile_; }

private:
  struct Texel {
    std::string slot;
    std::array<double, 4> value{};
  };

  Result<void> setParameters(const Language& library, graph::Graph& graph);
  Result<void> checkColumns(const graph::Graph& graph, const std::vector<ir::Range>& limits);
  Result<graph::Source> look(const graph::Graph& graph, const Language& library,
                             const graph::FlatOutputs& outputs);
  /// As the options want them.
  passes::LightFacts lit(passes::LightFacts lights) const;
  static Result<Texel> parseTexel(const std::string& text);
  static bool isMap(const ir::TextureSlot& slot);
  std::vector<std::string> pointersOf(const ir::TextureSlot& slot) const;
  bool namesOne(const std::string& name, const ir::TextureSlot& slot) const;
  bool names(const std::string& name, const ir::TextureSlot& slot) const;
  const Texel* texelOf(const ir::TextureSlot& slot) const;
  Result<void> checkAmbiguity() const;
  Result<void> checkAgreement() const;
  Result<void> checkTexels(const material::Schema& schema) const;
  Result<BoundTexture> environmentOf(const ir::TextureSlot& slot) const;
  Result<BoundTexture> textureOf(const ir::TextureSlot& slot, const Substitute& substitute);
  std::vector<const ir::TextureSlot*> usedTextures() const;

  FileImages& images_;
  Options options_;
  std::vector<Texel> texels_;
  Trial trial_;
  std::map<std::string, eval::Column> columns_;
  /// What the columns are of, by the names that they were given with.
  std::map<std::string, std::pair<graph::Parameter, ir::Range>, std::less<>> columns_of_;
  bool anyway_ = false;
  bool tangents_ = true, whole_ = false;
  Strings attributes_;
  std::vector<graph::Texture> originals_;  ///< by the slot's texture: the file's
  ir::Module module_;
  std::string profile_;
  std::optional<Shown> shown_;
  Strings changed_;
  std::map<std::string, BoundTexture> bound_;
};

/// Makes each colour of a module a vec4, so that it can be put out as one.
void widenColors(ir::Module& module);

/// The last part of the slot's pointer, "coatNormalTexture"; without one the slot's name.
std::string propertyOf(const ir::TextureSlot& slot);

/// What stands for an image that is absent: white, but where white would bend something, a flat normal and an
/// anisotropy along the tangent.
std::array<double, 4> neutralTexel(const ir::TextureSlot& slot);

}  // namespace lacquer
