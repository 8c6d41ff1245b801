# cmake -DBUILD=<our build folder> -DSOURCE=<this folder> -DWORK=<scratch folder> -DCOMPILER=<c++> -DFLAGS=<flags> -P run.cmake
# Installs the package, builds the consumer against it, runs it, and looks at what is linked into it.
function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGV " " command)
        message(FATAL_ERROR "${command}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/boxes_only)
run(${WORK}/build/by_name)

foreach(program boxes_only by_name)
    run(nm --demangle ${WORK}/build/${program})
    set(${program}_symbols "${output}")
endforeach()

# What a consumer of boxes does not need, in the names that the symbols have; the last word is only to see that the
# search finds something where it is.
if(NOT boxes_only_symbols MATCHES "one_axis_sweep")
    message(FATAL_ERROR "boxes_only: the symbols do not show what is in it; this check would see nothing")
endif()
foreach(absent _tree local_detection mesh pipeline digest triangle uniform_grid all_axes CGAL:: fcl:: ccdGJK)
    if(boxes_only_symbols MATCHES "[^\n]*${absent}[^\n]*")
        message(FATAL_ERROR "boxes_only links what it does not need: ${CMAKE_MATCH_0}")
    endif()
endforeach()
foreach(absent CGAL:: fcl:: ccdGJK)
    if(by_name_symbols MATCHES "[^\n]*${absent}[^\n]*")
        message(FATAL_ERROR "by_name links what it does not need: ${CMAKE_MATCH_0}")
    endif()
endforeach()
