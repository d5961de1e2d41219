/* Lacquer for programs in C, and for every language that can call C: glTF materials to GLSL, HLSL and SPIR-V.
 *
 * The way is scene -> graph -> shader, as in lacquer.h, which says what each of them is. The
 * WebAssembly module exports the same functions (docs/web.md). What holds for all of them:
 *
 * Handles are opaque. One that a function returns belongs to the caller, who frees it with the function named
 * `_free` of its type, once, in any order: nothing depends on the handle that it was made from. NULL means
 * that the call failed.
 *
 * NULL may stand for any handle: it may be freed, what it is asked for is empty or 0, a call that needs the
 * object fails with "empty-handle", options are the defaults, and messages are not wanted.
 *
 * Texts that come in are UTF-8, ended by a NUL, or have their size in bytes beside them. A `const char*` that
 * comes out is ended by a NUL, belongs to the handle, and stays until that is changed or freed; it is never
 * NULL. `size`, where it is not NULL, is given the bytes before the NUL: names may hold NULs of their own. A
 * NULL in the place of a text that comes in is an empty text.
 *
 * Functions that return int return 1 when they did what they are for, and 0, with an error among the
 * messages, when not. Indices begin with 0; for one that does not exist the answer is empty or 0. Messages
 * are appended.
 *
 * No exception leaves a call: "out-of-memory" and "internal" are messages. Distinct handles may be used from
 * distinct threads at once, and so may functions with const handles. Equal input gives equal bytes. */
#ifndef LACQUER_C_H
#define LACQUER_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define LACQUER_C __attribute__((visibility("default")))
#else
#define LACQUER_C
#endif
/* Not in the WebAssembly module. */
#define LACQUER_C_NATIVE LACQUER_C

/* Of this interface. A function, a key of the options or a constant may come; none goes or changes its
 * meaning while this number stays. */
#define LACQUER_C_VERSION 1
LACQUER_C uint32_t lacquer_c_version(void);
/* The library's: "0.2.0". */
LACQUER_C const char* lacquer_version(void);

/* ---- texts that calls make */

typedef struct lacquer_text lacquer_text;
LACQUER_C const char* lacquer_text_data(const lacquer_text* text);
LACQUER_C size_t lacquer_text_size(const lacquer_text* text);
LACQUER_C void lacquer_text_free(lacquer_text* text);

/* ---- messages: what is wrong with the input, or worth knowing */

typedef struct lacquer_messages lacquer_messages;
enum { LACQUER_NOTE = 0, LACQUER_WARNING = 1, LACQUER_ERROR = 2 };
enum {
  LACQUER_MESSAGE_CODE = 0,    /* stable, lower-case, dash-separated: "factor-out-of-range" */
  LACQUER_MESSAGE_FILE = 1,    /* as it was given; may be empty */
  LACQUER_MESSAGE_POINTER = 2, /* JSON pointer into the file; may be empty */
  LACQUER_MESSAGE_WHAT = 3,    /* what is wrong */
  LACQUER_MESSAGE_HELP = 4,    /* what is right; may be empty */
  LACQUER_MESSAGE_TEXT = 5     /* all of it as the command line prints it */
};
LACQUER_C lacquer_messages* lacquer_messages_new(void);
LACQUER_C void lacquer_messages_free(lacquer_messages* messages);
LACQUER_C void lacquer_messages_clear(lacquer_messages* messages);
LACQUER_C size_t lacquer_messages_count(const lacquer_messages* messages);
/* 1 when one of them is an error. */
LACQUER_C int lacquer_messages_have_error(const lacquer_messages* messages);
/* LACQUER_NOTE, ...; -1 for an index that does not exist. */
LACQUER_C int lacquer_message_level(const lacquer_messages* messages, size_t index);
LACQUER_C const char* lacquer_message_part(const lacquer_messages* messages, size_t index, int part,
                                           size_t* size);
/* From 1, the column in bytes; 0 where there is no place in a text. */
LACQUER_C uint32_t lacquer_message_line(const lacquer_messages* messages, size_t index);
LACQUER_C uint32_t lacquer_message_column(const lacquer_messages* messages, size_t index);

/* ---- options */

/* From a JSON object. Its keys are the members of lacquer::Options, `template` instead of `template_name`,
 * with the command line's words: {"profile": "openpbr", "targets": ["essl"], "parameters": "baked", "live":
 * ["coat"], "lights": {"directional": 1}}; "lights" may be "any" or "scene". "texels" is for evaluations and
 * previews alone: ["coatTexture=1,1,1,1"]. An empty text is an empty object. NULL, and a message, for another
 * key and for a value of another kind. */
typedef struct lacquer_options lacquer_options;
LACQUER_C lacquer_options* lacquer_options_new(const char* json, size_t size, lacquer_messages* messages);
LACQUER_C void lacquer_options_free(lacquer_options* options);

/* ---- scenes: the materials of a glTF file */

typedef struct lacquer_scene lacquer_scene;
typedef struct lacquer_graph lacquer_graph;
typedef struct lacquer_shader lacquer_shader;
/* No index: what lacquer_scene_find_material() returns when there is none. */
#define LACQUER_NONE ((size_t)-1)
/* The vertex attributes of a primitive beside POSITION, as bits. */
enum {
  LACQUER_NORMAL = 1,
  LACQUER_TANGENT = 2,
  LACQUER_COLOR_0 = 4,
  LACQUER_TEXCOORD_0 = 8,
  LACQUER_TEXCOORD_1 = 16,
  LACQUER_TEXCOORD_2 = 32,
  LACQUER_TEXCOORD_3 = 64,
  LACQUER_JOINTS_0 = 128, /* with WEIGHTS_0 */
  LACQUER_JOINTS_1 = 256, /* with WEIGHTS_1 */
  LACQUER_MORPH_TARGETS = 512,
  LACQUER_INSTANCES = 1024,      /* EXT_mesh_gpu_instancing */
  LACQUER_QUANTIZED = 2048,      /* POSITION or a TEXCOORD_n as integers that stand for themselves */
  LACQUER_UNUSED_ATTRIBUTES = 27 /* what a material that no primitive uses is read with */
};
/* Reads a .gltf or .glb file; buffers and images need not exist. */
LACQUER_C lacquer_scene* lacquer_scene_load(const char* path, const lacquer_options* options,
                                            lacquer_messages* messages);
/* The same from its bytes, which are copied; `name` stands for the file in messages. Such a scene reads
 * images from data URIs and buffer views, and no files. */
LACQUER_C lacquer_scene* lacquer_scene_read(const char* bytes, size_t size, const char* name,
                                            const lacquer_options* options, lacquer_messages* messages);
LACQUER_C void lacquer_scene_free(lacquer_scene* scene);
LACQUER_C size_t lacquer_scene_material_count(const lacquer_scene* scene);
LACQUER_C const char* lacquer_scene_material_name(const lacquer_scene* scene, size_t material, size_t* size);
/* Without a name (NULL) the only material. LACQUER_NONE, and an error, when there is none or several. */
LACQUER_C size_t lacquer_scene_find_material(const lacquer_scene* scene, const char* name,
                                             lacquer_messages* messages);
/* Of the primitives that use a material, each kind once. */
LACQUER_C size_t lacquer_scene_use_count(const lacquer_scene* scene, size_t material);
LACQUER_C uint32_t lacquer_scene_use(const lacquer_scene* scene, size_t material, size_t use);
LACQUER_C lacquer_graph* lacquer_scene_graph(const lacquer_scene* scene, size_t material, uint32_t attributes,
                                             const lacquer_options* options, lacquer_messages* messages);
/* A JSON array of a material's properties: `pointer` of each, what its `change` is to the shader ("numbers",
 * "textures" or "program"), the `name` of the parameter or texture, and of "program" the terms that "live" in
 * the options makes a number of it with. */
LACQUER_C lacquer_text* lacquer_scene_properties(const lacquer_scene* scene, size_t material,
                                                 uint32_t attributes, const lacquer_options* options,
                                                 lacquer_messages* messages);

/* ---- contracts: all that a file is drawn with */

/* The whole file, its shaders included; materials whose graphs have one structure share a shader, which is
 * made once. What fails is left out, with messages, and the rest is there. lacquer/contract.h says what the
 * members mean, docs/manifest.md what they are for. Functions that fill a struct do it as those of a shader.
 */
typedef struct lacquer_contract lacquer_contract;
LACQUER_C lacquer_contract* lacquer_scene_contract(const lacquer_scene* scene, const lacquer_options* options,
                                                   lacquer_messages* messages);
LACQUER_C void lacquer_contract_free(lacquer_contract* contract);
/* 1 when no material and no shader failed. */
LACQUER_C int lacquer_contract_ok(const lacquer_contract* contract);
/* manifest.json as the program writes it for the file, which it names `source`. */
LACQUER_C lacquer_text* lacquer_contract_manifest(const lacquer_contract* contract, const char* source);

LACQUER_C size_t lacquer_contract_shader_count(const lacquer_contract* contract);
/* A handle of the caller's. */
LACQUER_C lacquer_shader* lacquer_contract_shader(const lacquer_contract* contract, size_t index);

enum { LACQUER_ALPHA_OPAQUE = 0, LACQUER_ALPHA_MASK = 1, LACQUER_ALPHA_BLEND = 2 };
/* In their order in a frame. */
enum {
  LACQUER_PASS_OPAQUE = 0,
  LACQUER_PASS_MASKED = 1,
  LACQUER_PASS_LOOKS_THROUGH = 2, /* the shader reads scene_behind */
  LACQUER_PASS_BLENDED = 3
};
enum {
  LACQUER_FACTOR_ZERO = 0,
  LACQUER_FACTOR_ONE = 1,
  LACQUER_FACTOR_SOURCE_ALPHA = 2,
  LACQUER_FACTOR_ONE_MINUS_SOURCE_ALPHA = 3
};
typedef struct lacquer_material {
  const char* name;
  int index; /* in the file; -1 for the default material */
  int alpha_mode;
  double alpha_cutoff;
  int blends; /* 0: no blending, and the factors mean nothing */
  int source_color, destination_color, source_alpha, destination_alpha;
  int double_sided;
  int pass;
  int depth_write;
  size_t use_count;
} lacquer_material;
/* The file's materials, and last the default one where a primitive has it. */
LACQUER_C size_t lacquer_contract_material_count(const lacquer_contract* contract);
LACQUER_C int lacquer_contract_material(const lacquer_contract* contract, size_t place, lacquer_material* to,
                                        size_t size);
typedef struct lacquer_use {
  uint32_t attributes; /* LACQUER_NORMAL, ... */
  size_t shader;
  const char* structure; /* as lacquer_graph_structure() */
  const void* block;     /* what the material's uniform block holds: `block_size` bytes */
  size_t block_size;
  size_t parameter_count, texture_count, stand_in_attribute_count;
} lacquer_use;
typedef struct lacquer_parameter {
  const char* name;
  const double* numbers;
  size_t count;
  const char* pointer;
  int animated, stand_in;
} lacquer_parameter;
typedef struct lacquer_used_texture {
  const char* slot;  /* the name of the shader's texture */
  int texture;       /* -1 for a stand-in */
  int texcoord;      /* -1 for a stand-in */
  int has_transform; /* 0: the next three mean nothing */
  double offset[2], rotation, scale[2];
  int srgb;
  int stand_in; /* 1: what is bound has one texel, this one */
  double texel[4];
  const char* file; /* of a graph's own texture: the image, from its folder; else empty */
  /* 1: the next four are how it is looked up, as lacquer_file_texture has them, whatever the file's texture
   * says */
  int has_sampler;
  int wrap_s, wrap_t, mag_filter, min_filter;
} lacquer_used_texture;
LACQUER_C int lacquer_contract_use(const lacquer_contract* contract, size_t place, size_t use,
                                   lacquer_use* to, size_t size);
LACQUER_C int lacquer_contract_parameter(const lacquer_contract* contract, size_t place, size_t use,
                                         size_t index, lacquer_parameter* to, size_t size);
LACQUER_C int lacquer_contract_used_texture(const lacquer_contract* contract, size_t place, size_t use,
                                            size_t index, lacquer_used_texture* to, size_t size);
/* Of a shader that materials share: what it reads of the vertices and the primitive has not. Empty for an
 * index that does not exist. */
LACQUER_C const char* lacquer_contract_stand_in_attribute(const lacquer_contract* contract, size_t place,
                                                          size_t use, size_t index);

typedef struct lacquer_primitive {
  size_t mesh, primitive;
  int material; /* the index in the file; -1 for the default one */
  size_t place; /* of that material; LACQUER_NONE where there is none */
  size_t use;   /* LACQUER_NONE after an error */
  size_t attribute_count, target_count, variant_count;
} lacquer_primitive;
typedef struct lacquer_attribute {
  const char* semantic;
  const char* type;           /* "VEC3"; may be empty */
  const char* component_type; /* "FLOAT"; may be empty */
  int normalized;
} lacquer_attribute;
LACQUER_C size_t lacquer_contract_primitive_count(const lacquer_contract* contract);
LACQUER_C int lacquer_contract_primitive(const lacquer_contract* contract, size_t index,
                                         lacquer_primitive* to, size_t size);
/* With a variant, an index into lacquer_contract_variant(): material, place and use are those that it
 * chooses. */
LACQUER_C int lacquer_contract_variant_primitive(const lacquer_contract* contract, size_t index,
                                                 size_t variant, lacquer_primitive* to, size_t size);
LACQUER_C int lacquer_contract_attribute(const lacquer_contract* contract, size_t primitive, size_t index,
                                         lacquer_attribute* to, size_t size);
LACQUER_C size_t lacquer_contract_variant_count(const lacquer_contract* contract);
LACQUER_C const char* lacquer_contract_variant(const lacquer_contract* contract, size_t index, size_t* size);
/* Of a MaterialX document: which material is for which geometry, as JSON, an object with what
 * docs/manifest.md says of looks, look_groups, collections, geometry and material_variants. */
LACQUER_C lacquer_text* lacquer_contract_looks(const lacquer_contract* contract);

enum { LACQUER_WRAP_REPEAT = 0, LACQUER_WRAP_CLAMP = 1, LACQUER_WRAP_MIRROR = 2 };
enum {
  LACQUER_FILTER_OPEN = 0, /* the file leaves it to the engine */
  LACQUER_FILTER_NEAREST = 1,
  LACQUER_FILTER_LINEAR = 2,
  LACQUER_FILTER_NEAREST_MIPMAP_NEAREST = 3,
  LACQUER_FILTER_LINEAR_MIPMAP_NEAREST = 4,
  LACQUER_FILTER_NEAREST_MIPMAP_LINEAR = 5,
  LACQUER_FILTER_LINEAR_MIPMAP_LINEAR = 6
};
typedef struct lacquer_file_texture {
  size_t image_count; /* the one to prefer first */
  int wrap_s, wrap_t, mag_filter, min_filter;
  int swizzled; /* 1: shaders take the channels of the first image themselves (NV_texture_swizzle) */
} lacquer_file_texture;
typedef struct lacquer_image {
  const char* uri; /* relative to the file; else empty */
  int buffer_view; /* else -1 */
  int data_uri;    /* 1: in neither of both */
  const char* mime_type;
} lacquer_image;
LACQUER_C size_t lacquer_contract_texture_count(const lacquer_contract* contract);
LACQUER_C int lacquer_contract_texture(const lacquer_contract* contract, size_t index,
                                       lacquer_file_texture* to, size_t size);
/* An index into the images; LACQUER_NONE for one that does not exist. `extension`, where it is not NULL, is
 * given that which names the image; empty for the texture's own. */
LACQUER_C size_t lacquer_contract_texture_image(const lacquer_contract* contract, size_t texture,
                                                size_t index, const char** extension);
/* The channels of such an image that are the texture's red, green, blue and alpha, -1 where none is, and its
 * layer, where they are not NULL. 0 where the image is the texture as it is. */
LACQUER_C int lacquer_contract_texture_channels(const lacquer_contract* contract, size_t texture,
                                                size_t index, int channels[4], int* layer);
LACQUER_C size_t lacquer_contract_image_count(const lacquer_contract* contract);
LACQUER_C int lacquer_contract_image(const lacquer_contract* contract, size_t index, lacquer_image* to,
                                     size_t size);

/* ---- what computes colours on the processor, or on a device (native builds alone) */

enum {
  LACQUER_DOUBLE = 0,
  LACQUER_FLOAT = 1,
  LACQUER_VULKAN = 2,
  LACQUER_VULKAN_GLSL = 3,
  LACQUER_VULKAN_HLSL = 4
};
/* A material's linear colours at points, JSON in and out (docs/eval.md). */
LACQUER_C lacquer_text* lacquer_scene_evaluate(const lacquer_scene* scene, size_t material,
                                               const char* points, size_t size, int engine,
                                               const lacquer_options* options, lacquer_messages* messages);
/* The same as numbers: four doubles for each point into `rgba`, NaN where a device has discarded the
 * fragment. `discarded` may be NULL; else a byte for each point, 1 where the material discards it.
 * `capacity`: points that there is room for; with less, "block-too-small". The number of points; 0 on an
 * error. */
LACQUER_C_NATIVE size_t lacquer_scene_colors(const lacquer_scene* scene, size_t material, const char* points,
                                             size_t size, int engine, double* rgba, uint8_t* discarded,
                                             size_t capacity, const lacquer_options* options,
                                             lacquer_messages* messages);
/* Numbers for the points of an evaluation where the caller has them, as lacquer::PointArray says: by the name
 * of a point's member (docs/eval.md), of a parameter, or of a field of the template's blocks. */
typedef struct lacquer_array {
  const char* name;
  const void* numbers; /* of the first point: floats, or doubles */
  int is_double;
  size_t components; /* 1 to 4, side by side; of a matrix 9 or 16, column by column */
  ptrdiff_t stride;  /* bytes from a point's numbers to the next's; 0: one for all points */
} lacquer_array;
/* Where colours go: four floats or doubles for each point, `stride` bytes apart. */
typedef struct lacquer_colors {
  void* rgba;
  int is_double;
  ptrdiff_t stride;   /* 0: side by side */
  uint8_t* discarded; /* NULL, or a byte for each point */
} lacquer_colors;
/* A material's linear colours at `points` points from arrays: no text on the way. A parameter may differ from
 * point to point. 0 on an error. */
LACQUER_C_NATIVE int lacquer_scene_colors_of(const lacquer_scene* scene, size_t material,
                                             const lacquer_array* arrays, size_t count, size_t points,
                                             int engine, const lacquer_colors* to,
                                             const lacquer_options* options, lacquer_messages* messages);
/* Draws a lit ball of `pixels` by `pixels`, from 16 to 2048, into `rgb`: rows from the top, three bytes of
 * sRGB for each pixel. `capacity`, the bytes that there are, is at least 3 * pixels * pixels. */
LACQUER_C int lacquer_scene_preview(const lacquer_scene* scene, size_t material, uint32_t pixels,
                                    uint8_t* rgb, size_t capacity, const lacquer_options* options,
                                    lacquer_messages* messages);

/* ---- graphs: one node for each term of the specification */

/* From the JSON form (docs/graph-format.md). */
LACQUER_C lacquer_graph* lacquer_graph_read(const char* json, size_t size, const char* name,
                                            lacquer_messages* messages);
/* The same for a library of one's own: of the options, "node_directories" and "limits". */
LACQUER_C lacquer_graph* lacquer_graph_read_with(const char* json, size_t size, const char* name,
                                                 const lacquer_options* options, lacquer_messages* messages);
LACQUER_C void lacquer_graph_free(lacquer_graph* graph);
LACQUER_C lacquer_text* lacquer_graph_json(const lacquer_graph* graph);
LACQUER_C lacquer_text* lacquer_graph_dot(const lacquer_graph* graph);
/* A JSON array of the editable numbers: name, type, value, low, high (null: unbounded), or_zero, pointer. */
LACQUER_C lacquer_text* lacquer_graph_parameters(const lacquer_graph* graph);
/* Its textures. `slot`, which has room for `capacity` bytes, is given the name and a NUL; `texture` the index
 * in the file's textures, -1 for none. 0, and nothing given, for an index that does not exist or a name that
 * is too long. */
LACQUER_C size_t lacquer_graph_texture_count(const lacquer_graph* graph);
LACQUER_C int lacquer_graph_texture(const lacquer_graph* graph, size_t index, char* slot, size_t capacity,
                                    int* texture);
/* What is there, as JSON, in the order of the graph's own. Of its textures an array of name, type, srgb,
 * texture (-1: none), pointer, file, ui, also, and where the graph says how it is looked up, whatever the
 * file's texture says, its sampler: wrap_s, wrap_t, mag_filter; of its groups an array of their names. Of its
 * nodes, or with the name of a group of that's, an array of id, node or group, variant, stage, inputs (name
 * to source), ui; of its outputs, or of a group's, an object of sources by name. A `group` of NULL is the
 * graph. ui is any JSON of a tool's, or null. */
LACQUER_C lacquer_text* lacquer_graph_textures(const lacquer_graph* graph);
LACQUER_C lacquer_text* lacquer_graph_groups(const lacquer_graph* graph);
LACQUER_C lacquer_text* lacquer_graph_nodes(const lacquer_graph* graph, const char* group);
LACQUER_C lacquer_text* lacquer_graph_outputs(const lacquer_graph* graph, const char* group);
/* What a node takes and gives, without a node (NULL) the template's ports as inputs: {"inputs": [...],
 * "outputs": [...]} of name (of an only output ""), type, low, high (null: unbounded), or_zero, and of inputs
 * optional and source (null: nothing). */
LACQUER_C lacquer_text* lacquer_graph_sockets(const lacquer_graph* graph, const char* node,
                                              lacquer_messages* messages);
/* Edits, as those of lacquer::Graph: one that fails leaves the graph as it was. Nodes, inputs and outputs of
 * a group are named with the group and a slash: "worn/mix". */
LACQUER_C int lacquer_graph_add_node(lacquer_graph* graph, const char* id, const char* type,
                                     lacquer_messages* messages);
LACQUER_C int lacquer_graph_add_instance(lacquer_graph* graph, const char* id, const char* group,
                                         lacquer_messages* messages);
LACQUER_C int lacquer_graph_remove_node(lacquer_graph* graph, const char* id, lacquer_messages* messages);
LACQUER_C int lacquer_graph_rename_node(lacquer_graph* graph, const char* id, const char* to,
                                        lacquer_messages* messages);
/* `source` is JSON: 0.5, [1, 0, 0], {"node": "coat.f0"}, {"parameter": "x"}, {"texture": "x"}, {"given":
 * "view"} */
LACQUER_C int lacquer_graph_connect(lacquer_graph* graph, const char* node, const char* input,
                                    const char* source, lacquer_messages* messages);
/* The input has its default again. */
LACQUER_C int lacquer_graph_disconnect(lacquer_graph* graph, const char* node, const char* input,
                                       lacquer_messages* messages);
LACQUER_C int lacquer_graph_set_output(lacquer_graph* graph, const char* port, const char* source,
                                       lacquer_messages* messages);
LACQUER_C int lacquer_graph_remove_output(lacquer_graph* graph, const char* port, lacquer_messages* messages);
LACQUER_C int lacquer_graph_set_parameter(lacquer_graph* graph, const char* name, const double* numbers,
                                          size_t count, lacquer_messages* messages);
LACQUER_C int lacquer_graph_set_range(lacquer_graph* graph, const char* parameter, double low, double high,
                                      int or_zero, lacquer_messages* messages);
/* Puts `count` nodes into a new group, and an instance of it in their place. */
LACQUER_C int lacquer_graph_make_group(lacquer_graph* graph, const char* const* nodes, size_t count,
                                       const char* group, const char* instance, lacquer_messages* messages);
/* A graph as a group of this one: its parameters and textures are inputs. */
LACQUER_C int lacquer_graph_add_group(lacquer_graph* graph, const char* group, const lacquer_graph* other,
                                      lacquer_messages* messages);
/* Puts the nodes of an instance's group in its place. */
LACQUER_C int lacquer_graph_expand(lacquer_graph* graph, const char* node, lacquer_messages* messages);
/* Any edit in its JSON form, or an array of them, all or none (docs/graph-format.md, "Edits"): what takes it
 * back, after which the graph has the same bytes. NULL on an error. */
LACQUER_C lacquer_text* lacquer_graph_edit(lacquer_graph* graph, const char* json, size_t size,
                                           lacquer_messages* messages);
/* What has changed since lacquer_graph_generate(), the gravest. */
enum {
  LACQUER_CHANGED_NOTHING = 0,
  LACQUER_CHANGED_NUMBERS = 1,  /* the bytes of the block: lacquer_shader_pack_graph() */
  LACQUER_CHANGED_TEXTURES = 2, /* images or samplers, and perhaps numbers */
  LACQUER_CHANGED_PROGRAM = 3   /* the shader is to be generated */
};
LACQUER_C int lacquer_graph_changes(const lacquer_graph* graph);
/* Types, ranges, names, cycles: 1 when there is no error. */
LACQUER_C int lacquer_graph_check(lacquer_graph* graph, const lacquer_options* options,
                                  lacquer_messages* messages);
/* The address of its structure, 64 digits: graphs of one structure have one shader, so that one of them is
 * generated and packs the blocks of all. */
LACQUER_C lacquer_text* lacquer_graph_structure(const lacquer_graph* graph, const lacquer_options* options,
                                                lacquer_messages* messages);
LACQUER_C lacquer_shader* lacquer_graph_generate(lacquer_graph* graph, const lacquer_options* options,
                                                 lacquer_messages* messages);
/* The values of the code with their rates, after the pass of that name; "" for the last. */
LACQUER_C lacquer_text* lacquer_graph_dump(lacquer_graph* graph, const char* pass,
                                           const lacquer_options* options, lacquer_messages* messages);
/* As lacquer_scene_evaluate() and lacquer_scene_preview(), of a graph as it is now. Its textures are those of
 * the glTF file that it was built from; a graph that was read has none but the options' "texels". */
LACQUER_C lacquer_text* lacquer_graph_evaluate(const lacquer_graph* graph, const char* points, size_t size,
                                               int engine, const lacquer_options* options,
                                               lacquer_messages* messages);
LACQUER_C_NATIVE size_t lacquer_graph_colors(const lacquer_graph* graph, const char* points, size_t size,
                                             int engine, double* rgba, uint8_t* discarded, size_t capacity,
                                             const lacquer_options* options, lacquer_messages* messages);
LACQUER_C_NATIVE int lacquer_graph_colors_of(const lacquer_graph* graph, const lacquer_array* arrays,
                                             size_t count, size_t points, int engine,
                                             const lacquer_colors* to, const lacquer_options* options,
                                             lacquer_messages* messages);
LACQUER_C int lacquer_graph_preview(const lacquer_graph* graph, uint32_t pixels, uint8_t* rgb,
                                    size_t capacity, const lacquer_options* options,
                                    lacquer_messages* messages);

/* ---- shaders */

enum { LACQUER_VERTEX = 0, LACQUER_FRAGMENT = 1 };
LACQUER_C void lacquer_shader_free(lacquer_shader* shader);
LACQUER_C const char* lacquer_shader_id(const lacquer_shader* shader);
LACQUER_C int lacquer_shader_has_vertex_stage(const lacquer_shader* shader);
/* `target` is one of the command line's: "glsl", "glsl-gl", "essl", "hlsl", "wgsl", "msl"; "cpp" has its
 * header as the LACQUER_FRAGMENT, "js" its module, and the types of that as the LACQUER_VERTEX. Empty for a
 * target that was not asked for, that has no text or that does not exist. */
LACQUER_C const char* lacquer_shader_text(const lacquer_shader* shader, const char* target, int stage,
                                          size_t* size);
/* Words in the machine's byte order, `count` of them; NULL and 0 when "spirv" was not asked for. */
LACQUER_C const uint32_t* lacquer_shader_spirv(const lacquer_shader* shader, int stage, size_t* count);
/* The shader's entry in manifest.json (docs/manifest.md). */
LACQUER_C const char* lacquer_shader_interface(const lacquer_shader* shader, size_t* size);
/* What is in it as values, for programs that bind a shader without reading JSON: lacquer/reflection.h says
 * what the members mean. Each function fills the first `size` bytes of `to`, which is sizeof *to: a later
 * library may know more members, and an earlier caller is not given them. Texts belong to the handle. 0, and
 * nothing filled, for an index that does not exist. */
typedef struct lacquer_binding {
  uint32_t set, binding; /* of Vulkan */
  uint32_t flat;         /* OpenGL's binding point or texture unit, the register of Shader Model 5.0 */
  uint32_t wgsl_group, wgsl_binding, wgsl_sampler;
  uint32_t msl_index, msl_sampler; /* plain bindings */
  uint32_t msl_argument_buffer, msl_argument_index, msl_argument_sampler;
  int vertex, fragment; /* 1: the stage reads it */
} lacquer_binding;
enum {
  LACQUER_BLOCK_FRAME = 0,
  LACQUER_BLOCK_LIGHTS = 1,
  LACQUER_BLOCK_MATERIAL = 2, /* lacquer_shader_pack() fills it */
  LACQUER_BLOCK_OBJECT = 3,
  LACQUER_BLOCK_LIST = 4
};
typedef struct lacquer_block {
  const char* name;
  const char* structure; /* of an array or a list: its element's type; else empty */
  const char* list;      /* of a list (a storage buffer of any length): its array's name; else empty */
  int role;
  lacquer_binding at;
  uint32_t size;  /* bytes; of an array or a list, of one element */
  uint32_t array; /* elements; 0 for no array, and for a list */
  size_t field_count;
} lacquer_block;
typedef struct lacquer_field {
  const char* name;
  const char* type;       /* "float", "int", "vec2" to "vec4", "mat4" */
  uint32_t offset;        /* bytes */
  uint32_t array, stride; /* 0 for no array */
} lacquer_field;
enum { LACQUER_TEXTURE_MATERIAL = 0, LACQUER_TEXTURE_ENVIRONMENT = 1, LACQUER_TEXTURE_OBJECT = 2 };
typedef struct lacquer_texture {
  const char* name;
  const char* type;    /* "sampler2D", "samplerCube", ... */
  const char* sampler; /* its sampler's name in HLSL and WGSL */
  const char* slot;    /* of the material: what lacquer_graph_texture() calls it; else empty */
  int role;
  int srgb;
  lacquer_binding at;
  /* Of a shader made with "binding": "bindless": the array that the material's is taken from, which stands at
   * the place, else empty; and the byte of the material's record where its number in the array lies, an int.
   */
  const char* array;
  uint32_t number;
  /* With "binding": "arrays" not 0: `array` is a sampler2DArray, the number its layer, in the material's
   * block. */
  int layered;
  /* With "static_samplers": the sampler that nobody binds, numbers as of lacquer_used_texture; its register
   * in space 4 of Direct3D 12's root signature. */
  int has_static_sampler;
  int wrap_s, wrap_t, mag_filter, min_filter;
  uint32_t static_register;
} lacquer_texture;
/* A vertex attribute ("TEXCOORD_0"; without a vertex stage what the fragment stage is given), or a colour. */
typedef struct lacquer_place {
  const char* name;
  const char* type;
  uint32_t location;
} lacquer_place;
LACQUER_C size_t lacquer_shader_block_count(const lacquer_shader* shader);
LACQUER_C int lacquer_shader_block(const lacquer_shader* shader, size_t index, lacquer_block* to,
                                   size_t size);
LACQUER_C int lacquer_shader_field(const lacquer_shader* shader, size_t block, size_t index,
                                   lacquer_field* to, size_t size);
LACQUER_C size_t lacquer_shader_texture_count(const lacquer_shader* shader);
LACQUER_C int lacquer_shader_texture(const lacquer_shader* shader, size_t index, lacquer_texture* to,
                                     size_t size);
LACQUER_C size_t lacquer_shader_input_count(const lacquer_shader* shader);
LACQUER_C int lacquer_shader_input(const lacquer_shader* shader, size_t index, lacquer_place* to,
                                   size_t size);
LACQUER_C size_t lacquer_shader_output_count(const lacquer_shader* shader);
LACQUER_C int lacquer_shader_output(const lacquer_shader* shader, size_t index, lacquer_place* to,
                                    size_t size);
/* The output that is the fragment's depth, in [0, 1]; empty where the triangle's stays. */
LACQUER_C const char* lacquer_shader_depth(const lacquer_shader* shader);
/* Each that the vertices have elsewhere, "object_position", so that bounds must be wider; NULL behind the
 * last. */
LACQUER_C const char* lacquer_shader_displaced(const lacquer_shader* shader, size_t index);
/* Bytes of the material's uniform block, a multiple of 16; 0 when there is none. */
LACQUER_C size_t lacquer_shader_uniform_size(const lacquer_shader* shader);
/* A parameter's numbers. */
typedef struct lacquer_value {
  const char* name;
  const double* numbers;
  size_t count;
} lacquer_value;
/* The preshader: material values in, the first lacquer_shader_uniform_size() bytes of `block` out. Parameters
 * that are not among the `values` have today's; names that this shader has no parameter of are passed over,
 * since parameters leave it with their terms. A number outside of its parameter's range is packed as the
 * nearest one in it, NaN as if it were not given (docs/parameters.md): the warnings "out-of-range" and
 * "not-a-number". "wrong-count" for another number of components, "block-too-small" where `capacity`, in
 * bytes, does not suffice. */
LACQUER_C int lacquer_shader_pack(const lacquer_shader* shader, const lacquer_value* values, size_t count,
                                  void* block, size_t capacity, lacquer_messages* messages);
/* The same with a graph's numbers as they are now. */
LACQUER_C int lacquer_shader_pack_graph(const lacquer_shader* shader, const lacquer_graph* graph, void* block,
                                        size_t capacity, lacquer_messages* messages);

/* ---- what instruments find: proofs, stress tests, levels of detail, sheets of pictures. lacquer/results.h
 * says what the members mean. Rows are filled as those of reflection; texts belong to the handle. */

enum { LACQUER_PRECISION_VULKAN = 0, LACQUER_PRECISION_IEEE = 1, LACQUER_PRECISION_MEDIUMP = 2 };
typedef struct lacquer_proofs lacquer_proofs;
typedef struct lacquer_operation {
  const char *term, *name, *operation, *rate, *operand, *need;
  double low, high; /* of the operand */
  int nan;          /* 1: or it may be NaN */
  int safe;
} lacquer_operation;
typedef struct lacquer_claim {
  const char *node, *variant; /* of lacquer_nodes_prove(); else empty */
  const char *what, *need;
  double low, high;
  int nan, proved;
} lacquer_claim;
typedef struct lacquer_range {
  const char* name;
  double low, high;
  int nan;
} lacquer_range;
/* Of a graph's shader: operations, outputs, and as claims the arguments of its nodes. */
LACQUER_C_NATIVE lacquer_proofs* lacquer_graph_prove(lacquer_graph* graph, int precision,
                                                     const lacquer_options* options,
                                                     lacquer_messages* messages);
/* Of the library's nodes: claims alone. */
LACQUER_C_NATIVE lacquer_proofs* lacquer_nodes_prove(int precision, const lacquer_options* options,
                                                     lacquer_messages* messages);
LACQUER_C_NATIVE void lacquer_proofs_free(lacquer_proofs* proofs);
LACQUER_C_NATIVE size_t lacquer_proofs_operation_count(const lacquer_proofs* proofs);
LACQUER_C_NATIVE int lacquer_proofs_operation(const lacquer_proofs* proofs, size_t index,
                                              lacquer_operation* to, size_t size);
LACQUER_C_NATIVE size_t lacquer_proofs_claim_count(const lacquer_proofs* proofs);
LACQUER_C_NATIVE int lacquer_proofs_claim(const lacquer_proofs* proofs, size_t index, lacquer_claim* to,
                                          size_t size);
LACQUER_C_NATIVE size_t lacquer_proofs_output_count(const lacquer_proofs* proofs);
LACQUER_C_NATIVE int lacquer_proofs_output(const lacquer_proofs* proofs, size_t index, lacquer_range* to,
                                           size_t size);

typedef struct lacquer_stress lacquer_stress;
typedef struct lacquer_finding {
  const char *node, *variant, *extension, *file, *name; /* the subject's; those that it has not are empty */
  size_t material;
  const char* fault; /* "nan", "infinity", ... */
  const char *what, *known;
  const char* test; /* its case, JSON, which `lacquer stress` runs again */
  uint64_t count;
  double value;
} lacquer_finding;
/* Stress tests nodes, extensions, .gltf and .glb files and .json cases: `count` subjects; none for the whole
 * library. `samples` and `seed` as the command line has them; `engine` is none but LACQUER_DOUBLE. */
LACQUER_C_NATIVE lacquer_stress* lacquer_stress_run(const char* const* subjects, size_t count,
                                                    uint64_t samples, uint64_t seed, int engine,
                                                    const lacquer_options* options,
                                                    lacquer_messages* messages);
LACQUER_C_NATIVE void lacquer_stress_free(lacquer_stress* stress);
LACQUER_C_NATIVE size_t lacquer_stress_subject_count(const lacquer_stress* stress);
LACQUER_C_NATIVE size_t lacquer_stress_fault_count(const lacquer_stress* stress);
LACQUER_C_NATIVE size_t lacquer_stress_finding_count(const lacquer_stress* stress);
LACQUER_C_NATIVE int lacquer_stress_finding(const lacquer_stress* stress, size_t index, lacquer_finding* to,
                                            size_t size);

typedef struct lacquer_levels lacquer_levels;
typedef struct lacquer_level {
  const char *file, *name; /* the material's */
  size_t material, level;  /* 0 is the exact shader */
  const char* shader;      /* its id */
  const char* simplify;    /* words, a blank between them */
  uint64_t instructions, cycles, quarter_cycles, vertex_cycles;
  double cost;
  double delta_e, delta_e_95, flip, flip_95; /* from the exact shader */
  uint32_t screen_size;
} lacquer_level;
/* Levels of detail of the files' materials: their shaders, a manifest and a report below `folder`; at most
 * `levels` for each, the last with a mean colour difference of at most `most_error` by pictures of `pixels`
 * (the command line has 48). The rows are all levels, material by material. */
LACQUER_C_NATIVE lacquer_levels* lacquer_levels_make(const char* const* files, size_t count,
                                                     const char* folder, uint32_t levels, double most_error,
                                                     uint32_t pixels, const lacquer_options* options,
                                                     lacquer_messages* messages);
LACQUER_C_NATIVE void lacquer_levels_free(lacquer_levels* levels);
/* The driver that has measured the costs; empty where they are estimates. */
LACQUER_C_NATIVE const char* lacquer_levels_driver(const lacquer_levels* levels);
LACQUER_C_NATIVE size_t lacquer_levels_count(const lacquer_levels* levels);
LACQUER_C_NATIVE int lacquer_levels_level(const lacquer_levels* levels, size_t index, lacquer_level* to,
                                          size_t size);

typedef struct lacquer_sheet lacquer_sheet;
typedef struct lacquer_difference {
  const char *file, *material;
  double largest, mean, root_mean_square; /* infinite where a pixel is no number */
} lacquer_difference;
/* Writes a PNG file with a ball of `pixels` for each material of the files. `first` and `second` are settings
 * to put side by side, whose differences are the rows; NULL for none. */
LACQUER_C_NATIVE lacquer_sheet* lacquer_sheet_draw(const char* const* files, size_t count, const char* output,
                                                   uint32_t pixels, const char* first, const char* second,
                                                   const lacquer_options* options,
                                                   lacquer_messages* messages);
LACQUER_C_NATIVE void lacquer_sheet_free(lacquer_sheet* sheet);
LACQUER_C_NATIVE size_t lacquer_sheet_material_count(const lacquer_sheet* sheet);
LACQUER_C_NATIVE size_t lacquer_sheet_difference_count(const lacquer_sheet* sheet);
LACQUER_C_NATIVE int lacquer_sheet_difference(const lacquer_sheet* sheet, size_t index,
                                              lacquer_difference* to, size_t size);

/* ---- materials for other tools (docs/materialx.md). Scenes are read of .mtlx documents, too. `materials`:
 * the names of those that are wanted; all where `count` is 0. */

/* A MaterialX document of a .gltf, .glb or .mtlx file's materials. `surface` is "gltf_pbr",
 * "open_pbr_surface", or empty for the one that says more of a material. NULL on an error; what it cannot say
 * is a warning. */
LACQUER_C_NATIVE lacquer_text* lacquer_materialx(const char* file, const char* const* materials, size_t count,
                                                 const char* surface, const lacquer_options* options,
                                                 lacquer_messages* messages);
/* The same as a file. 1 when it was written. */
LACQUER_C_NATIVE int lacquer_convert(const char* output, const char* file, const char* const* materials,
                                     size_t count, const char* surface, const lacquer_options* options,
                                     lacquer_messages* messages);
/* Procedural textures of a .gltf or .mtlx file as PNG files of `size` by `size` texels, from 1 to 8192,
 * beside the .gltf file `output`, which has them. JSON: "output", "images", and how many "textures" have one.
 */
LACQUER_C_NATIVE lacquer_text* lacquer_bake(const char* output, const char* file,
                                            const char* const* materials, size_t count, uint32_t size,
                                            const lacquer_options* options, lacquer_messages* messages);

/* The same with all that C++'s lacquer::Bake says, by a JSON object: "size", "samples", "nodes" (outputs of
 * nodes, "*" for all that can be looked at), "also" ("ktx2", "exr"), "bits", "levels", "srgb". `output` may
 * be an image, .png, .ktx2 or .exr, and `file` a graph, .json. */
LACQUER_C_NATIVE lacquer_text* lacquer_bake_as(const char* output, const char* file,
                                               const char* const* materials, size_t count, const char* how,
                                               const lacquer_options* options, lacquer_messages* messages);
/* lacquer_convert(), and what is lost by it, with lacquer::Conversion as a JSON object: "surface",
 * "measured", "picture", a PNG file, and its "size". JSON: "output", "picture", and of each material's linear
 * colours the "differences": "material", "largest", "mean", "root_mean_square". */
LACQUER_C_NATIVE lacquer_text* lacquer_convert_as(const char* output, const char* file,
                                                  const char* const* materials, size_t count, const char* how,
                                                  const lacquer_options* options, lacquer_messages* messages);
/* A glTF file whose procedural textures are KHR_texture_procedurals, each with a baked fallback of `size` by
 * `size` texels, from 1 to 8192, in it: of a .mtlx file its materials, of a .gltf file the whole, of a graph,
 * .json, its patterns. */
LACQUER_C_NATIVE lacquer_text* lacquer_gltf(const char* file, const char* const* materials, size_t count,
                                            uint32_t size, const lacquer_options* options,
                                            lacquer_messages* messages);
/* The same two of a scene. Of materials whose graphs were edited, `edited[i]` with `graphs[i]`, the document
 * has what computes texels in the graph, with its numbers and images. */
LACQUER_C lacquer_text* lacquer_scene_materialx(const lacquer_scene* scene, const char* const* materials,
                                                size_t count, const char* surface, const size_t* edited,
                                                lacquer_graph* const* graphs, size_t graph_count,
                                                const lacquer_options* options, lacquer_messages* messages);
LACQUER_C lacquer_text* lacquer_scene_gltf(const lacquer_scene* scene, const char* const* materials,
                                           size_t count, uint32_t size, const lacquer_options* options,
                                           lacquer_messages* messages);

/* ---- the library of nodes, and tables */

/* Nodes, templates, profiles, extensions and their properties as JSON, as `lacquer nodes --json`. */
LACQUER_C lacquer_text* lacquer_nodes(const lacquer_options* options, lacquer_messages* messages);
/* Whether the options' own node files, "node_directories" and "node_texts", and their MaterialX definitions
 * are good where they stand: 1 when there is no error. All errors at once, and warnings of names that nobody
 * uses and of ranges that are left.
 */
LACQUER_C int lacquer_check_nodes(const lacquer_options* options, lacquer_messages* messages);
/* The tables behind environment_dfg and environment_sheen (docs/bindings.md): `size` rows of `size` pairs,
 * from 2 to 1024, into `pairs`, which has room for `capacity` floats. */
LACQUER_C int lacquer_environment_dfg(uint32_t size, float* pairs, size_t capacity,
                                      lacquer_messages* messages);
LACQUER_C int lacquer_environment_sheen(uint32_t size, float* pairs, size_t capacity,
                                        lacquer_messages* messages);
/* The files of `lacquer environment` (docs/environments.md) from a picture's bytes, Radiance HDR or OpenEXR,
 * which are called `name` in messages. `how` is a JSON object: "size", the texels of a face's edge,
 * "samples", "dds", "shared_exponents", "scene" and "draft", as the members of lacquer::Environment. */
typedef struct lacquer_environment lacquer_environment;
LACQUER_C lacquer_environment* lacquer_environment_filter(const char* picture, size_t size, const char* name,
                                                          const char* how, const lacquer_options* options,
                                                          lacquer_messages* messages);
LACQUER_C void lacquer_environment_free(lacquer_environment* environment);
/* The text of environment.json, which says what the files are. */
LACQUER_C const char* lacquer_environment_description(const lacquer_environment* environment, size_t* size);
/* A file's bytes by the name of its texture, "environment_specular"; NULL where there is none. */
LACQUER_C const char* lacquer_environment_file(const lacquer_environment* environment, const char* slot,
                                               size_t* size);
/* The tables of IES files, and of EXT_lights_ies in glTF files (docs/light-profiles.md): `width` and `height`
 * of each, or 0 for those of `lacquer profile`. `output` is the .ktx2, .dds or .png file to write; NULL for
 * none. What was found, as `lacquer profile --json`. */
LACQUER_C_NATIVE lacquer_text* lacquer_light_profiles(const char* output, const char* const* files,
                                                      size_t count, uint32_t width, uint32_t height,
                                                      const lacquer_options* options,
                                                      lacquer_messages* messages);

#ifdef __cplusplus
}
#endif

#endif
