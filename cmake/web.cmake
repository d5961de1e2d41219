# The library for WebAssembly, by Debian's emscripten: what there is in place of cmake/dependencies.cmake, and what is
# left out. docs/web.md says what the module is.

# Native only: compilers and validators, GPUs, runs over folders with their cache, attacks, the search for levels. Callers
# of the first two are linked with web/absent/.
set(LACQUER_ABSENT check vulkan cost stress cache run lod)
set(LACQUER_ABSENT_FILES tools/cost.cpp tools/environment.cpp tools/gpu.cpp tools/lod.cpp tools/lod_material.cpp tools/lod_report.cpp
    tools/stress.cpp tools/view.cpp)

# The header-only parts of the same libraries. They are linked into a folder of their own, because the folder that they
# lie in has the native system's headers as well.
set(web_include "${PROJECT_BINARY_DIR}/include/libraries")
file(MAKE_DIRECTORY "${web_include}")
foreach(part fmt tl nlohmann spirv stb xxhash.h xxh3.h)
  if(NOT EXISTS "/usr/include/${part}")
    if(NOT part STREQUAL "xxh3.h")
      message(FATAL_ERROR "/usr/include/${part} is missing; `./dev web` installs what the build needs")
    endif()
  elseif(NOT EXISTS "${web_include}/${part}")
    file(CREATE_LINK "/usr/include/${part}" "${web_include}/${part}" SYMBOLIC)
  endif()
endforeach()

add_library(web_libraries INTERFACE)
# What emscripten's standard library of 2022 lacks, and loops without threads, come before the rest.
target_include_directories(web_libraries BEFORE INTERFACE "${PROJECT_SOURCE_DIR}/web/shim")
target_include_directories(web_libraries SYSTEM INTERFACE "${web_include}")
target_compile_definitions(web_libraries INTERFACE FMT_HEADER_ONLY)
foreach(name fmt::fmt tl::expected nlohmann_json::nlohmann_json SPIRV-Headers::SPIRV-Headers TBB::tbb xxhash stb sodium
             glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits SPIRV-Tools-static SPIRV-Tools-opt)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${name} INTERFACE web_libraries)
endforeach()

# The module is linked whole, so nothing in it needs a table of addresses. What the flags name, every engine has that has
# WebAssembly's exceptions.
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
set(web_features -fwasm-exceptions -mbulk-memory -msign-ext -mnontrapping-fptoint)
add_compile_options(${web_features})
add_link_options(${web_features})

# lacquer_module(): lacquer.wasm, which exports the functions of lacquer_c.h and memory, and needs no script of
# emscripten's: web/src/module.ts gives it the few functions that it imports.
function(lacquer_module)
  file(GLOB absent CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/web/absent/*.cpp")
  file(STRINGS "${PROJECT_SOURCE_DIR}/src/lacquer_c.h" lines REGEX "^LACQUER_C ")
  set(names "_malloc,_free")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "(lacquer_[a-z0-9_]+)\\(" ignored "${line}")
    string(APPEND names ",_${CMAKE_MATCH_1}")
  endforeach()
  target_compile_definitions(lacquer_c PRIVATE LACQUER_NO_CHECK)  # nothing is validated unless it is asked for
  add_executable(lacquer_wasm ${absent} "${PROJECT_SOURCE_DIR}/web/shim/png.cpp" $<TARGET_OBJECTS:lacquer_c>)
  set_target_properties(lacquer_wasm PROPERTIES OUTPUT_NAME lacquer SUFFIX .wasm)
  target_link_libraries(lacquer_wasm PRIVATE lacquer_c lacquer_tools lacquer_check lacquer_vulkan stb
                        lacquer_warnings)
  target_link_options(lacquer_wasm PRIVATE --no-entry "-sEXPORTED_FUNCTIONS=${names}" -sSTANDALONE_WASM=1
                      -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=16777216)
  set_property(TARGET lacquer_wasm APPEND PROPERTY LINK_DEPENDS "${PROJECT_SOURCE_DIR}/src/lacquer_c.h")
endfunction()
