# Shaders as part of a build (docs/builds.md).
#
#   lacquer_add_shaders(<target> FILES <file>... [TARGETS <name>...] [OUTPUT <folder>] [CACHE <folder>]
#                       [OPTIONS <flag>...])
#
# Adds <target>, which makes the shaders and manifest.json of glTF files and is part of `all`. Relative FILES are those
# of the current source folder. OUTPUT is below the current binary folder, <target> when it is not given. TARGETS are
# those of `lacquer gen --target`, OPTIONS other flags of `lacquer gen`. The target's properties LACQUER_OUTPUT and
# LACQUER_MANIFEST say where the results are.
function(lacquer_add_shaders target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OUTPUT;CACHE" "FILES;TARGETS;OPTIONS")
  if(NOT arg_FILES)
    message(FATAL_ERROR "lacquer_add_shaders(${target}): name at least one file after FILES")
  endif()
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "lacquer_add_shaders(${target}): these belong to no keyword: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_OUTPUT)
    set(arg_OUTPUT "${target}")
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)
  set(manifest "${arg_OUTPUT}/manifest.json")

  # Relative names: what is said of the files is the same in every checkout.
  set(inputs "")
  set(names "")
  foreach(file IN LISTS arg_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND inputs "${file}")
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
    list(APPEND names "${file}")
  endforeach()
  cmake_path(RELATIVE_PATH arg_OUTPUT BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" OUTPUT_VARIABLE folder)
  set(flags -q -o "${folder}" --depfile "${target}.d")
  if(arg_TARGETS)
    list(JOIN arg_TARGETS "," targets)
    list(APPEND flags --target "${targets}")
  endif()
  if(arg_CACHE)
    list(APPEND flags --cache "${arg_CACHE}")
  endif()

  # Nothing is written that holds the right bytes already. Ninja knows that a command may leave its output alone; a
  # Makefile would run it again and again.
  set(after "")
  if(CMAKE_GENERATOR MATCHES "Makefiles")
    set(after COMMAND "${CMAKE_COMMAND}" -E touch "${manifest}")
  endif()
  set(depfile "")
  if(CMAKE_GENERATOR MATCHES "Makefiles|Ninja")
    set(depfile DEPFILE "${CMAKE_CURRENT_BINARY_DIR}/${target}.d")
  endif()
  if(POLICY CMP0116)
    cmake_policy(SET CMP0116 NEW)  # paths in the depfile are relative to the current binary folder
  endif()
  add_custom_command(
    OUTPUT "${manifest}"
    COMMAND lacquer::lacquer_cli gen ${names} ${flags} ${arg_OPTIONS}
    ${after}
    DEPENDS ${inputs} "$<TARGET_FILE:lacquer::lacquer_cli>"
    ${depfile}
    WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}"
    COMMENT "Shaders of ${target}"
    VERBATIM)
  add_custom_target("${target}" ALL DEPENDS "${manifest}")
  set_target_properties("${target}" PROPERTIES LACQUER_OUTPUT "${arg_OUTPUT}" LACQUER_MANIFEST "${manifest}")
endfunction()
