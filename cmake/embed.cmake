# Puts the .node files, or those of another ending, of a folder into a library as text, so that a built Lacquer needs no data files.

# lacquer_embed(TARGET FOLDER NAME [ENDING]): defines `embedded<Name>()`, the folder's files, in embedded_<name>.cpp.
function(lacquer_embed target folder name)
  lacquer_embed_files("${target}" "${folder}" "${name}" "" ${ARGN})
endfunction()

# lacquer_embed_names(TARGET NAME FOLDER...): the same of several folders, with a table of what the files declare, so that one
# of them is read only when somebody asks for something in it.
function(lacquer_embed_names target name)
  lacquer_embed_files("${target}" "${ARGN}" "${name}" ON)
endfunction()

function(lacquer_embed_files target folders name names)
  set(ending "node")
  if(ARGC GREATER 4)
    set(ending "${ARGV4}")
  endif()
  set(files "")
  foreach(folder IN LISTS folders)
    file(GLOB found CONFIGURE_DEPENDS "${folder}/*.${ending}")
    list(SORT found)
    list(APPEND files ${found})
  endforeach()
  set(output "${PROJECT_BINARY_DIR}/embedded_${name}.cpp")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DFILES=${files}" "-DNAME=${name}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DNAMES=${names}" "-DOUTPUT=${output}" "-DWITHOUT_COMMENTS=${EMSCRIPTEN}"
            -P "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    DEPENDS ${files} "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    COMMENT "Embedding ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()

# lacquer_prepare(TARGET LINKS...): puts what material/prepare/ makes of the library's own texts into a library, so that no program
# makes it again at each start. The program for it runs on the machine that builds, by an emulator where that is another one; without
# one nothing is prepared.
function(lacquer_prepare target)
  set(output "${PROJECT_BINARY_DIR}/prepared_models.cpp")
  if(EMSCRIPTEN)
    # By itself, since not every module has it.
    add_library(lacquer_prepared STATIC "${output}")
    target_link_libraries(lacquer_prepared PRIVATE ${ARGN} lacquer_public lacquer_warnings)
    target_include_directories(lacquer_prepared PRIVATE "${PROJECT_BINARY_DIR}/include/setting")
    target_compile_options(lacquer_prepared PRIVATE -Oz)
    target_link_libraries(${target} PUBLIC lacquer_prepared)
  else()
    set_source_files_properties("${output}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE "${output}")
  endif()
  if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
    file(WRITE "${output}" "#include \"setting/prepared.h\"\n\nstd::span<const lacquer::model::Prepared> lacquer::preparedModels() { return {}; }\n")
    return()
  endif()
  lacquer_program(lacquer_prepare src/material/prepare ${ARGN})
  set(which "")
  if(EMSCRIPTEN)
    set(which --default)  # the module is sent
    # It runs once, and what emscripten optimizes JavaScript with need not be there.
    target_link_options(lacquer_prepare PRIVATE -O0 -sALLOW_MEMORY_GROWTH=1 -sWASM_ASYNC_COMPILATION=0)
  endif()
  add_custom_command(OUTPUT "${output}" COMMAND lacquer_prepare ${which} > "${output}" DEPENDS lacquer_prepare COMMENT "Preparing the models" VERBATIM)
endfunction()
