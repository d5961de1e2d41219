# Every dependency, found the standard way. docs/dependencies.md says why each is here.
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
find_package(glslang REQUIRED)
find_package(SPIRV-Headers REQUIRED)
find_package(SPIRV-Tools REQUIRED)
find_package(SPIRV-Tools-opt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(TBB REQUIRED)
find_package(pugixml REQUIRED)
find_package(Vulkan QUIET)  # its headers alone; `lacquer cost` opens the loader at run time, if there is one
if(LACQUER_EXAMPLES)
  find_package(TinyGLTF QUIET)  # of examples/renderer
endif()

find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash_pc REQUIRED IMPORTED_TARGET libxxhash)
add_library(xxhash ALIAS PkgConfig::xxhash_pc)
pkg_check_modules(stb_pc REQUIRED IMPORTED_TARGET stb)
add_library(stb ALIAS PkgConfig::stb_pc)
pkg_check_modules(spirv_cross_pc IMPORTED_TARGET spirv-cross-c-shared)  # without it there is no MSL
pkg_check_modules(openexr_pc IMPORTED_TARGET OpenEXR)  # without it `lacquer environment` reads Radiance HDR alone
pkg_check_modules(sodium_pc REQUIRED IMPORTED_TARGET libsodium)
add_library(sodium ALIAS PkgConfig::sodium_pc)
