# The Open Dynamics Engine by header and library: Debian's package has no configuration for CMake. One that computes in
# float, as Fedora's does, is passed over: it takes the greatest float for infinity.
find_path(ODE_INCLUDE_DIR ode/collision.h)
find_library(ODE_LIBRARY ode)
mark_as_advanced(ODE_INCLUDE_DIR ODE_LIBRARY)

set(ODE_VERSION "")
if(ODE_INCLUDE_DIR AND EXISTS ${ODE_INCLUDE_DIR}/ode/version.h)
    file(STRINGS ${ODE_INCLUDE_DIR}/ode/version.h ODE_VERSION REGEX "define dODE_VERSION ")
    string(REGEX MATCH "[0-9][0-9.]*" ODE_VERSION "${ODE_VERSION}")
endif()

set(ODE_IN_DOUBLE OFF)
if(ODE_INCLUDE_DIR AND EXISTS ${ODE_INCLUDE_DIR}/ode/precision.h)
    # What is left where nobody asks for either stands last.
    file(STRINGS ${ODE_INCLUDE_DIR}/ode/precision.h precisions REGEX "define d(SINGLE|DOUBLE)$")
    if(precisions MATCHES "dDOUBLE$")
        set(ODE_IN_DOUBLE ON)
    endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ODE REQUIRED_VARS ODE_LIBRARY ODE_INCLUDE_DIR ODE_IN_DOUBLE VERSION_VAR ODE_VERSION)
if(ODE_FOUND AND NOT TARGET ODE::ODE)
    add_library(ODE::ODE UNKNOWN IMPORTED)
    set_target_properties(ODE::ODE PROPERTIES IMPORTED_LOCATION ${ODE_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${ODE_INCLUDE_DIR})
endif()
