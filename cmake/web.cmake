# The library for WebAssembly, by Debian's emscripten: what there is in place of cmake/dependencies.cmake, and what is
# left out. docs/web.md says what the module is.

# Native only: the search for cheaper forms but for what it counts by, compilers and validators, GPUs, costs, attacks, runs over folders with their
# cache, the search for levels. Their callers are linked with web/absent/.
set(LACQUER_ABSENT check vulkan cost stress cache run lod view)
set(LACQUER_ABSENT_FILES lab/environment/files.cpp lab/eval/gpu.cpp faces/answer/findings.cpp faces/api/levels.cpp faces/c/exchange.cpp
    faces/c/findings.cpp)
foreach(file approximate egraph extract facts fit optimize pattern points quotient ranges rounding rules safety)
  list(APPEND LACQUER_ABSENT_FILES compile/optimize/${file}.cpp)
endforeach()

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
# fmt asks no locale, and so the standard library's locales and streams stay out. No number here is grouped.
add_compile_definitions(FMT_STATIC_THOUSANDS_SEPARATOR=44)
add_link_options(${web_features})

# What lacquer-compiler.wasm is without: rooms, in whose place web/absent/compiler/ stands for what the others call, and functions
# of lacquer_c.h; and what the package for JavaScript has no use for.
set(beyond_compiler materialx mtlx exchange bake preview picture prove photometry)
set(beyond_compiler_functions
    "scene_(load|find_material|contract|evaluate|preview|materialx|gltf)" "contract_" "check_nodes" "environment_(filter|free|description|file)"
    "graph_(evaluate|preview|edit|add_|remove_|rename_|connect|disconnect|set_output|make_group|expand|structure|texture[(]|texture_count)"
    "shader_(block|field|texture|input|output|depth|displaced)")

# lacquer_web_module(TARGET NAME FUNCTIONS...): NAME.wasm, which exports the functions and memory, and needs no script of
# emscripten's: web/src/module.ts gives it the few functions that it imports.
function(lacquer_web_module target name)
  set(functions "${ARGN}")
  list(TRANSFORM functions PREPEND "_")
  list(JOIN functions "," functions)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME "${name}" SUFFIX .wasm)
  # -Oz inlines nothing that grows: a second round inlines the small functions of the standard library, for half the time and
  # fewer bytes.
  target_link_options(${target} PRIVATE -Oz -sBINARYEN_EXTRA_PASSES=--flexible-inline-max-function-size=10,-O3 --no-entry
                      "-sEXPORTED_FUNCTIONS=_malloc,_free,${functions}" -sSTANDALONE_WASM=1
                      -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=16777216)
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${PROJECT_SOURCE_DIR}/src/lacquer_c.h")
endfunction()

# lacquer_module(): lacquer.wasm, which has all functions of lacquer_c.h, and lacquer-compiler.wasm, from the same objects.
function(lacquer_module)
  set(whole "")
  set(compiler "")
  list(JOIN beyond_compiler_functions "|" beyond)
  file(STRINGS "${PROJECT_SOURCE_DIR}/src/lacquer_c.h" lines REGEX "^LACQUER_C ")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "(lacquer_[a-z0-9_]+)\\(" call "${line}")
    list(APPEND whole "${CMAKE_MATCH_1}")
    if(NOT call MATCHES "^lacquer_(${beyond})")
      string(REPLACE "(" "" name "${call}")
      list(APPEND compiler "${name}")
    endif()
  endforeach()
  target_compile_definitions(lacquer_c PRIVATE LACQUER_NO_CHECK)  # nothing is validated unless it is asked for
  # These hand on, read and report: their time is not worth the bytes.
  foreach(folder c answer api bake edit environment exchange gltf graph interface json lang manifest material materialx model mtlx optimize photometry picture preview programs
          prove schedule setting shader structures support targets texture)
    target_compile_options(lacquer_${folder} PRIVATE -Oz)
  endforeach()
  # So is that of passes which few materials, or few options, need.
  foreach(file arrays bind bindless half pipeline place specialize_lights hoist_vertex prune_loops)
    set_source_files_properties("${PROJECT_SOURCE_DIR}/src/compile/passes/${file}.cpp" TARGET_DIRECTORY lacquer_passes
                                PROPERTIES COMPILE_OPTIONS -Oz)
  endforeach()
  file(GLOB absent CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/web/absent/*.cpp")
  file(GLOB absent_compiler CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/web/absent/compiler/*.cpp")
  add_library(lacquer_absent OBJECT ${absent} "${PROJECT_SOURCE_DIR}/web/shim/png.cpp")
  add_library(lacquer_absent_compiler OBJECT ${absent_compiler})
  foreach(absent lacquer_absent lacquer_absent_compiler)
    target_link_libraries(${absent} PRIVATE lacquer_c lacquer_eval lacquer_targets lacquer_check lacquer_vulkan lacquer_cost lacquer_run
                          lacquer_materialx stb lacquer_warnings)
  endforeach()

  add_executable(lacquer_wasm $<TARGET_OBJECTS:lacquer_absent> $<TARGET_OBJECTS:lacquer_c>)
  target_link_libraries(lacquer_wasm PRIVATE lacquer_c lacquer_eval lacquer_targets)
  lacquer_web_module(lacquer_wasm lacquer ${whole})

  # By the rooms' files: the rooms' own links would bring the others in. A call of one that is not there does not link.
  add_executable(lacquer_compiler_wasm $<TARGET_OBJECTS:lacquer_absent> $<TARGET_OBJECTS:lacquer_absent_compiler>
                 $<TARGET_OBJECTS:lacquer_c>)
  set_target_properties(lacquer_compiler_wasm PROPERTIES LINKER_LANGUAGE CXX)
  get_property(rooms GLOBAL PROPERTY LACQUER_FOLDERS)
  foreach(room IN ITEMS c ${beyond_compiler})
    list(REMOVE_ITEM rooms lacquer_${room})
  endforeach()
  foreach(room IN LISTS rooms)
    target_link_options(lacquer_compiler_wasm PRIVATE "$<TARGET_FILE:${room}>")
    set_property(TARGET lacquer_compiler_wasm APPEND PROPERTY LINK_DEPENDS "$<TARGET_FILE:${room}>")
  endforeach()
  add_dependencies(lacquer_compiler_wasm ${rooms})
  lacquer_web_module(lacquer_compiler_wasm lacquer-compiler ${compiler})
endfunction()
