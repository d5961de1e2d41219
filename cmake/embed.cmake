# Puts the .node files of a folder into a library as text, so that a built Lacquer needs no data files.

# lacquer_embed(TARGET FOLDER NAME): defines `embedded<Name>()`, the folder's files, in embedded_<name>.cpp.
function(lacquer_embed target folder name)
  file(GLOB files CONFIGURE_DEPENDS "${folder}/*.node")
  list(SORT files)
  set(output "${PROJECT_BINARY_DIR}/embedded_${name}.cpp")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DFILES=${files}" "-DNAME=${name}" "-DOUTPUT=${output}"
            -P "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    DEPENDS ${files} "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    COMMENT "Embedding ${name}/"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()
