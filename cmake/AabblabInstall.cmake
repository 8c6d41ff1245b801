include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Interfaces are installed as sources: a consumer's compiler makes its own module files of them.
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aabblab)
install(
    TARGETS aabblab_std aabblab_core aabblab_strategies aabblab_registry
    EXPORT aabblab
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET CXX_MODULES DESTINATION ${package_dir}/modules)
install(
    EXPORT aabblab
    NAMESPACE aabblab::
    FILE aabblabTargets.cmake
    DESTINATION ${package_dir}
    CXX_MODULES_DIRECTORY cxx-modules)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/aabblabConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/aabblabConfig.cmake ${PROJECT_BINARY_DIR}/aabblabConfigVersion.cmake
        DESTINATION ${package_dir})
