/* manifest.json and the shaders that it names as one file of records (docs/manifest.md, "Packed"): an engine
 * maps it into memory and reads it in place. This header is all of the reader: C99 and C++, without a
 * library. docs/manifest.md says what each member means to an application.
 *
 *   lacquer_packed file;
 *   const lacquer_packed_header* top = lacquer_packed_open(&file, bytes, size);
 *   const lacquer_packed_shader* one = LACQUER_PACKED_AT(&file, top->shaders, lacquer_packed_shader, 0);
 *   puts(lacquer_packed_string(&file, one->id));
 *
 * The reader stays within the bytes, whatever they are: a list that leaves the file has no elements, a
 * text that does is "". Lists may lie over one another, so that a small file is long to go through: who reads
 * anybody's counts what it reads. Numbers are little-endian, floats IEEE 754 binary32. A file of another
 * version is refused; in one of this version nothing moves. */
#ifndef LACQUER_PACKED_H
#define LACQUER_PACKED_H

#include <stddef.h>
#include <stdint.h>

#define LACQUER_PACKED_MAGIC 0x4d50514cu /* "LQPM" */
#define LACQUER_PACKED_VERSION 4u
#define LACQUER_PACKED_NONE 0xffffffffu /* no index */

/* `count` elements from the byte `at` of the file on. The comment behind a list names its elements. */
typedef struct {
  uint32_t at, count;
} lacquer_packed_list;
/* The same of bytes: UTF-8 with a 0 behind it, which `count` leaves out. */
typedef lacquer_packed_list lacquer_packed_text;

typedef struct {
  uint32_t magic, version;
  uint64_t size;               /* of the file in bytes */
  lacquer_packed_text lacquer; /* the version that wrote it */
  lacquer_packed_list files;   /* lacquer_packed_file */
  lacquer_packed_list shaders; /* lacquer_packed_shader, by id */
} lacquer_packed_header;

/* -- files -- */

typedef struct {
  lacquer_packed_text source;
  lacquer_packed_list materials;  /* lacquer_packed_material; the default one is the last, index -1 */
  lacquer_packed_list primitives; /* lacquer_packed_primitive */
  lacquer_packed_list textures;   /* lacquer_packed_file_texture */
  lacquer_packed_list images;     /* lacquer_packed_image */
  lacquer_packed_list variants;   /* lacquer_packed_text: names */
} lacquer_packed_file;

typedef struct {
  lacquer_packed_text name;
  int32_t index;      /* in the file; -1 for the default material */
  float alpha_cutoff; /* of MASK */
  uint8_t alpha_mode; /* 0 OPAQUE, 1 MASK, 2 BLEND */
  uint8_t pass;       /* 0 opaque, 1 masked, 2 looks_through, 3 blended */
  uint8_t depth_write, double_sided;
  /* Factors of source and destination, of color and of alpha: 0 zero, 1 one, 2 src-alpha, 3
   * one-minus-src-alpha. Opaque surfaces have one, zero, one, zero. */
  uint8_t blend[4];
  lacquer_packed_list uses; /* lacquer_packed_use */
} lacquer_packed_material;

typedef struct {
  uint32_t shader;                /* index into the header's shaders */
  lacquer_packed_list attributes; /* lacquer_packed_text: the primitive's, beside POSITION */
  /* The bytes of the shader's Material block, at a multiple of 16; with a fallback begun by its own. */
  lacquer_packed_list block;
  lacquer_packed_list textures;            /* lacquer_packed_use_texture */
  lacquer_packed_list parameters;          /* lacquer_packed_parameter */
  lacquer_packed_list stand_in_attributes; /* lacquer_packed_text */
  lacquer_packed_list fallback;            /* lacquer_packed_use: none or one, which has none */
} lacquer_packed_use;

typedef struct {
  lacquer_packed_text name;
  /* JSON pointer; of a material's own without "/materials/INDEX/" before it. Empty for a stand-in. */
  lacquer_packed_text pointer;
  float value[4];
  uint8_t components, animated, stand_in, reserved;
} lacquer_packed_parameter;

typedef struct {
  uint32_t slot;     /* index into the shader's textures */
  uint32_t texture;  /* index into the file's textures, or LACQUER_PACKED_NONE: a file, or a stand-in */
  uint32_t texcoord; /* or LACQUER_PACKED_NONE */
  float offset[2], rotation, scale[2];            /* which the shader applies */
  uint8_t wrap_s, wrap_t, mag_filter, min_filter; /* where has_sampler; numbers as in a file's textures */
  uint8_t stand_in;                               /* one texel of `color` is bound */
  uint8_t srgb, has_color, has_sampler;           /* in place of the sampler of the file's texture */
  float color[4];           /* of a stand-in; of a graph's texture what is there without an image */
  lacquer_packed_text file; /* of a graph's own texture: the image */
} lacquer_packed_use_texture;

typedef struct {
  uint32_t mesh, primitive;       /* meshes[mesh].primitives[primitive] */
  int32_t material;               /* its `index` */
  uint32_t use;                   /* index into the material's uses, or LACQUER_PACKED_NONE */
  lacquer_packed_list attributes; /* lacquer_packed_attribute */
  lacquer_packed_list targets;    /* lacquer_packed_list of lacquer_packed_text: of each morph target */
  lacquer_packed_list variants;   /* lacquer_packed_variant */
} lacquer_packed_primitive;

typedef struct {
  lacquer_packed_text semantic, type, component_type;
  uint32_t normalized;
} lacquer_packed_attribute;

typedef struct {
  lacquer_packed_list variants; /* uint32_t: indices into the file's variants */
  int32_t material;
  uint32_t use; /* or LACQUER_PACKED_NONE */
} lacquer_packed_variant;

typedef struct {
  lacquer_packed_list images; /* lacquer_packed_texture_image, the one to prefer first */
  uint8_t wrap_s, wrap_t;     /* 0 repeat, 1 clamp, 2 mirror */
  /* 0 the engine's, 1 nearest, 2 linear, 3 nearest-mipmap-nearest, 4 linear-mipmap-nearest, 5
   * nearest-mipmap-linear, 6 linear-mipmap-linear */
  uint8_t mag_filter, min_filter;
  uint32_t swizzled; /* the first image is bound as it is */
} lacquer_packed_file_texture;

typedef struct {
  uint32_t image; /* index into the file's images */
  uint32_t layer;
  int8_t channels[4];            /* of the image, that are red, green, blue and alpha; -1: none */
  lacquer_packed_text extension; /* that gives it; empty for the texture's own */
} lacquer_packed_texture_image;

typedef struct {
  lacquer_packed_text uri, mime_type; /* empty where the file has none */
  uint32_t buffer_view;               /* or LACQUER_PACKED_NONE */
  uint32_t data_uri;
} lacquer_packed_image;

/* -- shaders -- */

typedef struct {
  lacquer_packed_text id;
  lacquer_packed_text template_name;
  lacquer_packed_list codes;          /* lacquer_packed_code, by target; "vert" before "frag" */
  lacquer_packed_list blocks;         /* lacquer_packed_block */
  lacquer_packed_list textures;       /* lacquer_packed_texture */
  lacquer_packed_list inputs;         /* lacquer_packed_input */
  lacquer_packed_list outputs;        /* lacquer_packed_output */
  lacquer_packed_list spec_constants; /* lacquer_packed_spec_constant */
  lacquer_packed_list displaces;      /* lacquer_packed_text */
  lacquer_packed_text depth;          /* the output that is the fragment's depth; empty for none */
} lacquer_packed_shader;

typedef struct {
  lacquer_packed_text target; /* "spirv" */
  lacquer_packed_text stage;  /* "vert", "frag" */
  lacquer_packed_list code;   /* bytes, at a multiple of 16; a text has a 0 behind it */
  uint32_t validated;
} lacquer_packed_code;

/* Where a block or a texture is bound: by Vulkan and Direct3D 12, by OpenGL and Direct3D 11 (`flat`); by WGSL
 * and by MSL where the file has their shaders, else 0. */
typedef struct {
  uint32_t set, binding, flat;
  uint32_t wgsl_group, wgsl_binding, wgsl_sampler;
  /* Plain bindings, or with argument buffers [[id(msl_index)]] of the buffer `msl_argument_buffer`, which
   * else is LACQUER_PACKED_NONE. */
  uint32_t msl_index, msl_sampler, msl_argument_buffer;
  uint32_t stages; /* that read it: 1 the vertex stage, 2 the fragment stage, 3 both */
} lacquer_packed_place;

typedef struct {
  lacquer_packed_text name;
  lacquer_packed_text structure; /* of an array or a list: its element's type */
  lacquer_packed_text list;      /* of a list: the storage buffer's name; else empty */
  uint32_t role;                 /* 0 frame, 1 lights, 2 material, 3 object, 4 list */
  uint32_t size, array;          /* bytes (of one element of an array or a list), elements (0: no array) */
  lacquer_packed_place place;
  lacquer_packed_list fields; /* lacquer_packed_field */
} lacquer_packed_block;

typedef struct {
  lacquer_packed_text name, type;
  uint32_t offset, array, stride; /* bytes, elements (0: no array), bytes */
} lacquer_packed_field;

typedef struct {
  lacquer_packed_text name, slot, type, sampler; /* `slot`: the name in the manifest */
  uint32_t role;                                 /* 0 material, 1 environment, 2 object */
  uint32_t srgb;
  lacquer_packed_place place;
  /* Of a shader made with --binding bindless or arrays: what the material's is taken from, which stands at
   * the place, else empty; and the byte of the material's block where its number there lies, an int. */
  lacquer_packed_text array;
  uint32_t number;
  /* With --static-samplers: its sampler, numbers as in a file's textures, and its register in space 4. */
  uint32_t static_register;
  uint8_t has_static_sampler, wrap_s, wrap_t, mag_filter, min_filter, layered;
  uint8_t pad[2];
} lacquer_packed_texture;

typedef struct {
  lacquer_packed_text name, type;
  uint32_t location;
} lacquer_packed_input;

typedef struct {
  lacquer_packed_text name, type;
  uint32_t location;
  lacquer_packed_list holds; /* lacquer_packed_text */
} lacquer_packed_output;

typedef struct {
  lacquer_packed_text name, type;
  uint32_t id, component;
  float neutral; /* of a bool 0 or 1 */
} lacquer_packed_spec_constant;

/* -- reading -- */

typedef struct {
  const unsigned char* bytes;
  size_t size;
} lacquer_packed;

/* Element `i` of a list whose elements have so many bytes; NULL where there is none. */
static inline const void* lacquer_packed_element(const lacquer_packed* file, lacquer_packed_list list,
                                                 uint32_t i, size_t bytes) {
  if (i >= list.count || list.at % 4 != 0 || list.at > file->size) return NULL;
  if (list.count > (file->size - list.at) / bytes) return NULL;
  return file->bytes + list.at + (size_t)i * bytes;
}
#define LACQUER_PACKED_AT(file, list, type, i) \
  ((const type*)lacquer_packed_element((file), (list), (i), sizeof(type)))

/* The bytes of a code or of a block; NULL where there are none. */
static inline const void* lacquer_packed_bytes(const lacquer_packed* file, lacquer_packed_list list) {
  return lacquer_packed_element(file, list, 0, 1);
}

static inline const char* lacquer_packed_string(const lacquer_packed* file, lacquer_packed_text text) {
  if (text.at >= file->size || text.count >= file->size - text.at) return "";
  return file->bytes[(size_t)text.at + text.count] == 0 ? (const char*)file->bytes + text.at : "";
}

/* NULL for what is no packed manifest of this version, not whole, or not at a multiple of 8 in memory. The
 * bytes stay the caller's. */
static inline const lacquer_packed_header* lacquer_packed_open(lacquer_packed* file, const void* bytes,
                                                               size_t size) {
  const lacquer_packed_header* top = (const lacquer_packed_header*)bytes;
  file->bytes = (const unsigned char*)bytes;
  file->size = size;
  if (bytes == NULL || size < sizeof *top || (uintptr_t)bytes % 8 != 0) return NULL;
  return top->magic == LACQUER_PACKED_MAGIC && top->version == LACQUER_PACKED_VERSION && top->size == size
             ? top
             : NULL;
}

#endif
