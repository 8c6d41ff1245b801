# The standard headers are compiled once, into one module file that stands in for them wherever a file includes them.
# Otherwise every module file carries a copy of all that its source includes, and who imports ten of them merges ten: a
# full build takes three times as long. Left out are <random>, whose intrinsics could be included no more, and <iostream>,
# which would give every module something to initialise. Tried with clang 19 and libstdc++ 12; elsewhere, and by who
# installs the library, files are compiled as they stand.
set(aabblab_headers
    algorithm
    array
    bit
    charconv
    chrono
    cmath
    compare
    concepts
    cstddef
    cstdint
    cstdio
    cstdlib
    cstring
    deque
    exception
    filesystem
    fstream
    functional
    initializer_list
    iterator
    limits
    map
    memory
    new
    numeric
    optional
    ranges
    set
    span
    sstream
    stdexcept
    string
    string_view
    system_error
    tuple
    type_traits
    unordered_map
    utility
    variant
    vector)

set(folders ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
list(FILTER folders INCLUDE REGEX "/c\\+\\+/12$")
if(NOT PROJECT_IS_TOP_LEVEL OR NOT folders OR CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 20)
    return()
endif()
list(GET folders 0 folder)

set(map ${PROJECT_BINARY_DIR}/headers/std.modulemap)
set(module ${PROJECT_BINARY_DIR}/headers/std.pcm)
list(TRANSFORM aabblab_headers PREPEND "header \"${folder}/")
list(TRANSFORM aabblab_headers APPEND "\"")
list(JOIN aabblab_headers "\n" lines)
file(CONFIGURE OUTPUT ${map} CONTENT "module std [system] {\n@lines@\nexport *\n}\n" @ONLY)

set(use -fmodules -fno-implicit-modules -fno-implicit-module-maps -fmodule-map-file=${map})
string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
add_custom_command(
    OUTPUT ${module}
    DEPENDS ${map}
    DEPFILE ${module}.d
    COMMAND ${CMAKE_CXX_COMPILER} ${flags} ${CMAKE_CXX20_STANDARD_COMPILE_OPTION} ${aabblab_options} ${use} -Xclang -emit-module
            -fmodule-name=std -MD -MF ${module}.d -MT ${module} -x c++ -c ${map} -o ${module}
    COMMENT "Compiling the standard headers"
    VERBATIM)
add_custom_target(aabblab_header_module DEPENDS ${module})
# Objects are as old as the module file that they are made with: it stands among what they depend on.
add_compile_options("$<BUILD_INTERFACE:${use};-fmodule-file=std=${module};SHELL:-Xclang -module-file-deps>")

# Every target of a folder and the folders in it waits for the module file.
function(aabblab_wait_for_headers folder)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
        get_target_property(type ${target} TYPE)
        if(type MATCHES "^(STATIC_LIBRARY|OBJECT_LIBRARY|EXECUTABLE)$")
            add_dependencies(${target} aabblab_header_module)
        endif()
    endforeach()
    get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
    foreach(inner IN LISTS folders)
        aabblab_wait_for_headers(${inner})
    endforeach()
endfunction()
cmake_language(DEFER DIRECTORY ${PROJECT_SOURCE_DIR} CALL aabblab_wait_for_headers ${PROJECT_SOURCE_DIR})
