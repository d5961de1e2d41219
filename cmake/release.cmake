# What CPack makes of an installation and of the sources; `./dev package` calls it.
set(CPACK_PACKAGE_NAME lacquer)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "The maintainers of Lacquer <maintainers@lacquer.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Of those who link the static library; what the program and the shared library need, they depend on.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, pkg-config, libfmt-dev, glslang-dev, spirv-tools, libtbb-dev, libsodium-dev, \
libstb-dev, libopenexr-dev, libspirv-cross-c-shared-dev")

# The sources are what a checkout has, without what is made in it.
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME "lacquer-${PROJECT_VERSION}")
set(CPACK_SOURCE_IGNORE_FILES "^${PROJECT_SOURCE_DIR}/build/" "^${PROJECT_SOURCE_DIR}/out/" "/generated\\\\.new/" "/\\\\.git$" "/\\\\.git/" "/\\\\.cache/" "/node_modules" "/__pycache__/"
                              "\\\\.egg-info/" "/compile_commands\\\\.json$")
include(CPack)
