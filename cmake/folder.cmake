# One static library per room of src/, a folder in its storey's. A room sees the headers of exactly the rooms that it links:
# its public include directory holds nothing but a link to itself, so a wrong #include does not build.

add_library(lacquer_warnings INTERFACE)
target_compile_options(lacquer_warnings INTERFACE
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall -Wextra -Werror>
  # No warning is an error there, since nobody has read them all; the rest is standard C++ as the other compilers take it.
  $<$<CXX_COMPILER_ID:MSVC>:/W4 /permissive- /utf-8 /Zc:__cplusplus /Zc:preprocessor /bigobj /EHsc>)
target_compile_definitions(lacquer_warnings INTERFACE
  $<$<CXX_COMPILER_ID:MSVC>:NOMINMAX _USE_MATH_DEFINES _CRT_SECURE_NO_WARNINGS>)
# GCC 12 sees overlapping copies in std::string's operator+ where there are none (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(lacquer_warnings INTERFACE -Wno-restrict)
endif()
# GCC collects its garbage from 512 MB on, not from 128: a twelfth of its time, for 200 MB of memory.
target_compile_options(lacquer_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
# The double evaluation is a reference: no contraction, so that every machine computes the same bits.
target_compile_options(lacquer_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
# Nobody replaces a function of the library from outside: so GCC may inline one in the file that defines it, as Clang does.
target_compile_options(lacquer_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)

# The files of a folder are compiled together, up to eight at a time (./dev: sixteen on two cores), which takes a third of the
# time: most of it goes into headers. So a folder's files share their unnamed namespaces.
option(LACQUER_UNITY "Compile the files of a folder together" ON)

# lacquer_folder(STOREY/NAME public links... [PRIVATE private links...])
#
# Of a room in LACQUER_ABSENT there are the headers alone, and what calls it is given its functions elsewhere
# (cmake/web.cmake); files in LACQUER_ABSENT_FILES ("lab/eval/gpu.cpp") are left out.
function(lacquer_folder folder)
  cmake_parse_arguments(arg "" "" "PRIVATE" ${ARGN})
  set(source "${PROJECT_SOURCE_DIR}/src/${folder}")
  get_filename_component(name "${folder}" NAME)
  # Arrows between rooms run down, or to the left within a storey: what is linked stands before it in CMakeLists.txt.
  foreach(linked IN LISTS arg_UNPARSED_ARGUMENTS arg_PRIVATE)
    if(linked MATCHES "^lacquer_" AND NOT TARGET "${linked}")
      message(FATAL_ERROR "${folder} links ${linked}, which is no room before it")
    endif()
  endforeach()
  file(GLOB files CONFIGURE_DEPENDS "${source}/*.cpp" "${source}/*.h" "${source}/*.def" "${source}/*/*.cpp"
       "${source}/*/*.h")
  set(view "${PROJECT_BINARY_DIR}/include/${name}")
  file(MAKE_DIRECTORY "${view}")
  if(NOT EXISTS "${view}/${name}")
    file(CREATE_LINK "${source}" "${view}/${name}" SYMBOLIC COPY_ON_ERROR)
  endif()
  if(name IN_LIST LACQUER_ABSENT)
    add_library(lacquer_${name} INTERFACE)
    target_include_directories(lacquer_${name} INTERFACE "${view}")
    target_link_libraries(lacquer_${name} INTERFACE ${arg_UNPARSED_ARGUMENTS})
    return()
  endif()
  foreach(absent IN LISTS LACQUER_ABSENT_FILES)
    list(REMOVE_ITEM files "${PROJECT_SOURCE_DIR}/src/${absent}")
  endforeach()
  add_library(lacquer_${name} STATIC ${files})
  set_property(GLOBAL APPEND PROPERTY LACQUER_FOLDERS lacquer_${name})
  set_target_properties(lacquer_${name} PROPERTIES LINKER_LANGUAGE CXX UNITY_BUILD ${LACQUER_UNITY})
  target_include_directories(lacquer_${name} PUBLIC "$<BUILD_INTERFACE:${view}>")
  target_link_libraries(lacquer_${name} PUBLIC ${arg_UNPARSED_ARGUMENTS}
                        PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:lacquer_warnings>)
endfunction()

# The public headers, by themselves.
set(public_view "${PROJECT_BINARY_DIR}/include/public")
file(MAKE_DIRECTORY "${public_view}")
foreach(part lacquer.h lacquer_c.h lacquer)
  if(NOT EXISTS "${public_view}/${part}")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/src/${part}" "${public_view}/${part}" SYMBOLIC COPY_ON_ERROR)
  endif()
endforeach()
add_library(lacquer_public INTERFACE)
target_include_directories(lacquer_public INTERFACE "$<BUILD_INTERFACE:${public_view}>")

# lacquer_program(TARGET FOLDER links...): an executable from the .cpp files of a folder.
function(lacquer_program name folder)
  file(GLOB files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp" "${PROJECT_SOURCE_DIR}/${folder}/*.h")
  add_executable(${name} ${files})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${LACQUER_UNITY})
  get_filename_component(base "${folder}" NAME)
  set(view "${PROJECT_BINARY_DIR}/include/${base}")
  file(MAKE_DIRECTORY "${view}")
  if(NOT EXISTS "${view}/${base}")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${folder}" "${view}/${base}" SYMBOLIC COPY_ON_ERROR)
  endif()
  target_include_directories(${name} PRIVATE "${view}")
  target_link_libraries(${name} PRIVATE ${ARGN} lacquer_warnings)
endfunction()
