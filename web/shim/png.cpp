// The function of stb's library that writes a PNG: the native program links it, the module compiles it.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
