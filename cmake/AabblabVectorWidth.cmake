# aabblab_vector_width(RESULT OPTIONS...): how many floats a register holds of the processor that is compiled for, by what
# the compiler predefines when it is called as a build calls it, with these options.
function(aabblab_vector_width result)
    # Nothing is linked or run, and the flags are those of the build, not of Debug.
    set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
    set(CMAKE_TRY_COMPILE_CONFIGURATION ${CMAKE_BUILD_TYPE})
    set(width 4)
    foreach(wider 8 16)
        set(macro_of_8 __AVX2__)
        set(macro_of_16 __AVX512F__)
        try_compile(has_width SOURCE_FROM_CONTENT width.cpp "#ifndef ${macro_of_${wider}}\n#error narrower\n#endif\n"
                    COMPILE_DEFINITIONS ${ARGN} NO_CACHE)
        if(has_width)
            set(width ${wider})
        endif()
    endforeach()
    set(${result} ${width} PARENT_SCOPE)
endfunction()
