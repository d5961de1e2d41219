# What is installed: one library (the objects of all folders, so that nobody links a dozen archives in the right order),
# its public headers, the program, and the files for find_package(lacquer).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(lacquer_folders GLOBAL PROPERTY LACQUER_FOLDERS)
# (`lacquer` is the program among the build files.)
add_library(lacquer_library STATIC)
set_target_properties(lacquer_library PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME lacquer EXPORT_NAME lacquer)
foreach(folder IN LISTS lacquer_folders)
  target_sources(lacquer_library PRIVATE $<TARGET_OBJECTS:${folder}>)
endforeach()
target_include_directories(lacquer_library PUBLIC "$<BUILD_INTERFACE:${public_view}>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
target_compile_features(lacquer_library PUBLIC cxx_std_20)
# What its objects need at link time; lacquer-config.cmake finds the same. Header-only libraries are in the objects.
target_link_libraries(lacquer_library PRIVATE fmt::fmt glslang::glslang glslang::SPIRV
                      glslang::glslang-default-resource-limits SPIRV-Tools-opt SPIRV-Tools-static TBB::tbb pugixml::pugixml
                      PkgConfig::sodium_pc PkgConfig::stb_pc Threads::Threads ${CMAKE_DL_LIBS})
if(TARGET PkgConfig::spirv_cross_pc)
  set(LACQUER_SPIRV_CROSS ON)
  target_link_libraries(lacquer_library PRIVATE PkgConfig::spirv_cross_pc)
endif()
if(TARGET PkgConfig::openexr_pc)
  set(LACQUER_OPENEXR ON)
  target_link_libraries(lacquer_library PRIVATE PkgConfig::openexr_pc)
endif()
add_library(lacquer::lacquer ALIAS lacquer_library)
add_executable(lacquer::lacquer_cli ALIAS lacquer_cli)

set(package "${CMAKE_INSTALL_LIBDIR}/cmake/lacquer")
install(TARGETS lacquer_library lacquer_cli EXPORT lacquer_targets)
install(FILES src/lacquer.h src/lacquer_c.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(DIRECTORY src/lacquer DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
# The page of `lacquer view`, where `./dev web` has made it.
install(FILES "${PROJECT_SOURCE_DIR}/build/web/view.html" DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/lacquer" OPTIONAL)
# The package for Python: `pip install PREFIX/share/lacquer/python`, or that folder in PYTHONPATH.
install(DIRECTORY python/lacquer DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/lacquer/python" FILES_MATCHING PATTERN "*.py" PATTERN "py.typed")
install(FILES python/pyproject.toml DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/lacquer/python")
install(EXPORT lacquer_targets NAMESPACE lacquer:: FILE lacquer-targets.cmake DESTINATION "${package}")
configure_package_config_file(cmake/lacquer-config.cmake.in "${PROJECT_BINARY_DIR}/lacquer-config.cmake"
                              INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/lacquer-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/lacquer-config.cmake" "${PROJECT_BINARY_DIR}/lacquer-config-version.cmake"
        cmake/lacquer-shaders.cmake DESTINATION "${package}")
