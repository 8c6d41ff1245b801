# The linear algebra of whatever is no hot kernel. Aligned as in Debian's libfcl (validation/engines), since one program has
# both, and whichever functions of Eigen's the linker keeps serve all of it. By its own package configuration: CGAL brings
# a FindEigen3 that defines no target.
find_package(Eigen3 CONFIG REQUIRED)
add_library(aabblab_eigen INTERFACE)
target_link_libraries(aabblab_eigen INTERFACE Eigen3::Eigen)
target_compile_definitions(aabblab_eigen INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
