# The sources for Windows by MinGW, as objects: the libraries that a program would be linked with are not there. What has no
# POSIX there must compile without it, `long` has 32 bits, and a path is no string (docs/portability.md).
include(headers)
lacquer_headers(PARTS fmt tl nlohmann spirv stb xxhash.h xxh3.h CLI glslang spirv-tools tbb oneapi sodium sodium.h pugixml.hpp pugiconfig.hpp)

# lacquer_objects(): a target for the objects of all folders, and those of the program.
function(lacquer_objects)
  file(GLOB files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/faces/cli/*.cpp")
  add_library(lacquer_cli OBJECT ${files})
  set(view "${PROJECT_BINARY_DIR}/include/cli")
  file(MAKE_DIRECTORY "${view}")
  if(NOT EXISTS "${view}/cli")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/src/faces/cli" "${view}/cli" SYMBOLIC COPY_ON_ERROR)
  endif()
  target_include_directories(lacquer_cli PRIVATE "${view}")
  target_link_libraries(lacquer_cli PRIVATE lacquer_api lacquer_json CLI11::CLI11 fmt::fmt lacquer_warnings)
  get_property(folders GLOBAL PROPERTY LACQUER_FOLDERS)
  add_custom_target(lacquer_objects DEPENDS ${folders} lacquer_cli)
endfunction()
