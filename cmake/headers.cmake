# For other systems than the one that builds: the header-only parts of the libraries of cmake/dependencies.cmake, under the
# same names, in a folder of their own, because the folder that they lie in has the native system's headers as well.

# lacquer_headers([FOLDER...] PARTS part...): parts of /usr/include; the folders are looked into before all else.
function(lacquer_headers)
  cmake_parse_arguments(arg "" "" "PARTS" ${ARGN})
  set(view "${PROJECT_BINARY_DIR}/include/libraries")
  file(MAKE_DIRECTORY "${view}")
  foreach(part IN LISTS arg_PARTS)
    if(NOT EXISTS "/usr/include/${part}")
      if(NOT part STREQUAL "xxh3.h")
        message(FATAL_ERROR "/usr/include/${part} is missing; `./dev deps` installs what the build needs")
      endif()
    elseif(NOT EXISTS "${view}/${part}")
      file(CREATE_LINK "/usr/include/${part}" "${view}/${part}" SYMBOLIC)
    endif()
  endforeach()

  add_library(lacquer_headers INTERFACE)
  target_include_directories(lacquer_headers BEFORE INTERFACE ${arg_UNPARSED_ARGUMENTS})
  target_include_directories(lacquer_headers SYSTEM INTERFACE "${view}")
  target_compile_definitions(lacquer_headers INTERFACE FMT_HEADER_ONLY)
  foreach(name fmt::fmt tl::expected nlohmann_json::nlohmann_json SPIRV-Headers::SPIRV-Headers TBB::tbb xxhash stb sodium
               CLI11::CLI11 glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits SPIRV-Tools-static
               SPIRV-Tools-opt pugixml::pugixml)
    add_library(${name} INTERFACE IMPORTED GLOBAL)
    target_link_libraries(${name} INTERFACE lacquer_headers)
  endforeach()
endfunction()
