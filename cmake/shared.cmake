# The library as one file that other languages load: it exports the functions of lacquer_c.h and of the C++ headers, and
# nothing of what they are made of or linked with.
if(NOT UNIX OR APPLE)
  return()  # the list of what is exported is one for ELF linkers
endif()

# lacquer_exports(OUTPUT): a version script from the C header and from cmake/exports.txt.
function(lacquer_exports output)
  set(source "${PROJECT_SOURCE_DIR}/src/lacquer_c.h")
  set(list "${PROJECT_SOURCE_DIR}/cmake/exports.txt")
  set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}" "${list}")
  set(text "{\n  global:\n")
  file(STRINGS "${source}" lines REGEX "^LACQUER_C(_NATIVE)? ")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "(lacquer_[a-z0-9_]+)\\(" ignored "${line}")
    string(APPEND text "    ${CMAKE_MATCH_1};\n")
  endforeach()
  file(STRINGS "${list}" lines REGEX "^[^#]")
  foreach(line IN LISTS lines)
    # "Scene::load" and "hasError ERKSt6vectorINS_7MessageE": a name, and how its parameters begin as the compiler has
    # them where another function has the same name.
    separate_arguments(words UNIX_COMMAND "${line}")
    list(GET words 0 name)
    string(REPLACE "::" ";" parts "${name}")
    set(mangled "7lacquer")
    foreach(part IN LISTS parts)
      string(LENGTH "${part}" length)
      string(APPEND mangled "${length}${part}")
    endforeach()
    set(rest "E*")
    list(LENGTH words count)
    if(count GREATER 1)
      list(GET words 1 rest)
      string(APPEND rest "*")
    endif()
    # The tag is GCC's, of functions that return a string or what holds one.
    foreach(tag "" "B5cxx11")
      string(APPEND text "    _ZN${mangled}${tag}${rest};\n    _ZNK${mangled}${tag}${rest};\n")
    endforeach()
  endforeach()
  file(CONFIGURE OUTPUT "${output}" CONTENT "${text}  local:\n    *;\n};\n" @ONLY)
endfunction()

set(exports "${PROJECT_BINARY_DIR}/lacquer.map")
lacquer_exports("${exports}")
add_library(lacquer_shared SHARED)
set_target_properties(lacquer_shared PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME lacquer VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} EXPORT_NAME shared
                      LINK_DEPENDS "${exports}")
foreach(folder IN LISTS lacquer_folders)
  target_sources(lacquer_shared PRIVATE $<TARGET_OBJECTS:${folder}>)
endforeach()
target_include_directories(lacquer_shared PUBLIC "$<BUILD_INTERFACE:${public_view}>"
                           "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
target_link_options(lacquer_shared PRIVATE "-Wl,--version-script=${exports}" -Wl,--no-undefined)
get_target_property(libraries lacquer_library LINK_LIBRARIES)
target_link_libraries(lacquer_shared PRIVATE ${libraries})
install(TARGETS lacquer_shared EXPORT lacquer_targets)
