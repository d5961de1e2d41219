# The library for WebAssembly, by Debian's emscripten: what there is in place of cmake/dependencies.cmake, and what is
# left out. docs/web.md says what the module is.

# Native only: the search for cheaper forms, compilers and validators, GPUs, costs, attacks, runs over folders with their
# cache, the search for levels. Their callers are linked with web/absent/.
set(LACQUER_ABSENT optimize check vulkan cost stress cache run lod view)
set(LACQUER_ABSENT_FILES lab/environment/files.cpp lab/eval/gpu.cpp faces/answer/findings.cpp faces/c/exchange.cpp
    faces/c/findings.cpp)

include(headers)
# What emscripten's standard library of 2022 lacks, and loops without threads, come before the rest.
lacquer_headers("${PROJECT_SOURCE_DIR}/web/shim" PARTS fmt tl nlohmann spirv stb xxhash.h xxh3.h)

# The module is linked whole, so nothing in it needs a table of addresses. What the flags name, every engine has that has
# WebAssembly's exceptions.
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
set(web_features -fwasm-exceptions -mbulk-memory -msign-ext -mnontrapping-fptoint)
add_compile_options(${web_features})
# Strings are compiled with what uses them: those within the standard library are optimized for size, and take a quarter of the time.
add_compile_definitions(_LIBCPP_DISABLE_EXTERN_TEMPLATE)
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
  # These hand on, read and report: their time is not worth the bytes.
  foreach(folder c answer api bake edit environment exchange gltf graph interface json lang manifest material materialx model mtlx photometry picture preview programs
          prove schedule setting shader structures support targets texture)
    target_compile_options(lacquer_${folder} PRIVATE -Oz)
  endforeach()
  add_executable(lacquer_wasm ${absent} "${PROJECT_SOURCE_DIR}/web/shim/png.cpp" $<TARGET_OBJECTS:lacquer_c>)
  set_target_properties(lacquer_wasm PROPERTIES OUTPUT_NAME lacquer SUFFIX .wasm)
  target_link_libraries(lacquer_wasm PRIVATE lacquer_c lacquer_eval lacquer_targets lacquer_check lacquer_vulkan lacquer_cost lacquer_run stb
                        lacquer_warnings)
  target_link_options(lacquer_wasm PRIVATE -Oz --no-entry "-sEXPORTED_FUNCTIONS=${names}" -sSTANDALONE_WASM=1
                      -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=16777216)
  set_property(TARGET lacquer_wasm APPEND PROPERTY LINK_DEPENDS "${PROJECT_SOURCE_DIR}/src/lacquer_c.h")
endfunction()
