#include "material/beside.h"

#include <algorithm>
#include <iterator>

namespace lacquer::material {

namespace {

struct Beside {
  std::string_view extension, reason;
};

constexpr std::string_view kStored = "how vertices are stored; a shader reads floats";
constexpr std::string_view kMeshes = "which geometry is drawn";
constexpr std::string_view kImages = "in which format an image is stored";
constexpr std::string_view kLights = "which lights there are; the application gives them";
constexpr std::string_view kEnvironments =
    "what a scene is lit by all around; `lacquer environment` makes its maps";
constexpr std::string_view kNodes = "which nodes there are and what they can do";
constexpr std::string_view kData = "data beside the picture";

/// What there is in the registry of glTF, apart from the materials' own.
constexpr Beside kRows[] = {
    {"KHR_accessor_float64", kStored},
    {"KHR_draco_mesh_compression", kStored},
    {"KHR_mesh_quantization", kStored},
    {"KHR_meshopt_compression", kStored},
    {"EXT_meshopt_compression", kStored},
    {"MPEG_accessor_timed", kStored},
    {"MPEG_buffer_circular", kStored},
    {"CESIUM_primitive_outline", kMeshes},
    {"CESIUM_primitive_restart", kMeshes},
    {"EXT_mesh_gpu_instancing", kMeshes},
    {"EXT_mesh_manifold", kMeshes},
    {"EXT_mesh_primitive_restart", kMeshes},
    {"FB_geometry_metadata", kMeshes},
    {"KHR_texture_basisu", kImages},
    {"NV_texture_swizzle", "it is implemented, in textures"},
    {"EXT_texture_astc", kImages},
    {"EXT_texture_avif", kImages},
    {"EXT_texture_webp", kImages},
    {"MPEG_texture_video", kImages},
    {"MSFT_texture_dds", kImages},
    {"KHR_texture_transform", "it is implemented, in textureInfos"},
    {"KHR_texture_procedurals", "it is implemented, in textureInfos"},
    {"EXT_texture_procedurals_mx_1_39", "which nodes the procedural textures have"},
    {"KHR_lights_punctual", kLights},
    {"KHR_lights_environment", kEnvironments},
    {"KHR_environment_map", kEnvironments},
    {"EXT_lights_area", kLights},
    {"EXT_lights_ies", "which lights there are; `lacquer profile` makes their tables"},
    {"EXT_lights_image_based", kLights},
    {"KHR_animation_pointer", "what animations change; it is implemented for materials"},
    {"KHR_materials_variants", "which whole material is taken; none changes"},
    {"MSFT_lod", "which whole node or material is taken; none changes"},
    {"AGI_articulations", kNodes},
    {"CESIUM_RTC", kNodes},
    {"KHR_audio_emitter", kNodes},
    {"KHR_audio_graph", kNodes},
    {"KHR_implicit_shapes", kNodes},
    {"KHR_node_hoverability", kNodes},
    {"KHR_node_selectability", kNodes},
    {"KHR_node_visibility", kNodes},
    {"KHR_physics_rigid_bodies", kNodes},
    {"MSFT_physics_rigid_bodies", kNodes},
    {"OMI_physics_body", kNodes},
    {"OMI_physics_shape", kNodes},
    {"EXT_feature_metadata", kData},
    {"EXT_instance_features", kData},
    {"EXT_mesh_features", kData},
    {"EXT_structural_metadata", kData},
    {"KHR_xmp", kData},
    {"KHR_xmp_json_ld", kData},
};

}  // namespace

std::string_view besideMaterials(std::string_view extension) {
  const auto row = std::find_if(std::begin(kRows), std::end(kRows),
                                [&](const Beside& each) { return each.extension == extension; });
  return row == std::end(kRows) ? std::string_view{} : row->reason;
}

}  // namespace lacquer::material
