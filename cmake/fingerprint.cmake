# lacquer_fingerprint(TARGET TEXT): defines lacquer::fingerprint(), which stands for the sources, the node library and
# TEXT (the version). What is linked says its version at run time.
function(lacquer_fingerprint target text)
  get_target_property(type "${target}" TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    return()  # left out of this build
  endif()
  file(GLOB_RECURSE files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/*.cpp" "${PROJECT_SOURCE_DIR}/src/*.h"
       "${PROJECT_SOURCE_DIR}/src/*.def" "${PROJECT_SOURCE_DIR}/nodes/*.node" "${PROJECT_SOURCE_DIR}/nodes/*.mtlx" "${PROJECT_SOURCE_DIR}/templates/*.node")
  list(FILTER files EXCLUDE REGEX "/src/faces/cli/")
  list(SORT files)
  string(REPLACE ";" "\n" lines "${files}")
  set(list "${PROJECT_BINARY_DIR}/fingerprint_files.txt")
  file(CONFIGURE OUTPUT "${list}" CONTENT "${lines}\n" @ONLY)
  set(output "${PROJECT_BINARY_DIR}/fingerprint.cpp")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DLIST=${list}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DTEXT=${text}" "-DOUTPUT=${output}"
            -P "${PROJECT_SOURCE_DIR}/cmake/fingerprint_files.cmake"
    DEPENDS ${files} "${list}" "${PROJECT_SOURCE_DIR}/cmake/fingerprint_files.cmake"
    COMMENT "Taking the sources' fingerprint"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()
