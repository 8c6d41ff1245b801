# cmake -DSOURCE=folder -DHEADER=file -P AabblabCommit.cmake: writes which commit the sources are at.
cmake_minimum_required(VERSION 3.28)
set(commit "unknown")
set(dirty "false")
find_program(git git)
if(git)
    execute_process(
        COMMAND ${git} -C ${SOURCE} rev-parse HEAD
        RESULT_VARIABLE failed
        OUTPUT_VARIABLE head
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed)
        set(commit ${head})
        execute_process(
            COMMAND ${git} -C ${SOURCE} status --porcelain --untracked-files=no
            OUTPUT_VARIABLE changes
            ERROR_QUIET)
        if(changes)
            set(dirty "true")
        endif()
    endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once
#define AABBLAB_COMMIT \"@commit@\"
#define AABBLAB_DIRTY @dirty@
" @ONLY)
