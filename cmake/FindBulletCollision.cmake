# Bullet's collision detection by header and libraries: its package configuration names no targets, and its paths are
# relative to a folder that Debian's does not say. It says only whether Bullet was built to compute in double.
find_package(Bullet QUIET CONFIG)
find_path(BulletCollision_INCLUDE_DIR BulletCollision/BroadphaseCollision/btDbvt.h PATH_SUFFIXES bullet)
find_library(BulletCollision_LIBRARY BulletCollision)
find_library(BulletCollision_LINEAR_MATH_LIBRARY LinearMath)
mark_as_advanced(BulletCollision_INCLUDE_DIR BulletCollision_LIBRARY BulletCollision_LINEAR_MATH_LIBRARY)

set(BulletCollision_VERSION "")
if(BulletCollision_INCLUDE_DIR)
    file(STRINGS ${BulletCollision_INCLUDE_DIR}/LinearMath/btScalar.h BulletCollision_VERSION REGEX "define BT_BULLET_VERSION ")
    # 324 stands for 3.24.
    string(REGEX REPLACE ".* ([0-9]+)([0-9][0-9])$" "\\1.\\2" BulletCollision_VERSION "${BulletCollision_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
    BulletCollision
    REQUIRED_VARS BulletCollision_LIBRARY BulletCollision_LINEAR_MATH_LIBRARY BulletCollision_INCLUDE_DIR
    VERSION_VAR BulletCollision_VERSION)
if(BulletCollision_FOUND AND NOT TARGET Bullet::Collision)
    add_library(Bullet::Collision UNKNOWN IMPORTED)
    set_target_properties(
        Bullet::Collision
        PROPERTIES IMPORTED_LOCATION ${BulletCollision_LIBRARY}
                   INTERFACE_INCLUDE_DIRECTORIES ${BulletCollision_INCLUDE_DIR}
                   INTERFACE_COMPILE_OPTIONS "${BULLET_DEFINITIONS}"
                   INTERFACE_LINK_LIBRARIES ${BulletCollision_LINEAR_MATH_LIBRARY})
endif()
