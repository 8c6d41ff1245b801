# cmake -DBUILD=<our build folder> -DSOURCE=<this folder> -DWORK=<scratch folder> -DCOMPILER=<c++> -DFLAGS=<flags> -P run.cmake
# Installs the package, builds the consumer against it in several ways, runs it, looks at what reaches it and tries what must
# be refused. zero_cost/ looks at what is in these programs.
function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGV " " command)
        message(FATAL_ERROR "${command}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

# prints(PROGRAM OUTPUT)
function(prints program expected)
    run(${program})
    if(NOT output STREQUAL expected)
        message(FATAL_ERROR "${program} prints\n${output}and not\n${expected}")
    endif()
endfunction()

# builds(NAME FLAGS OPTIONS…): configured with these flags and options all programs build and have the right answers.
set(answers "images: dc8da3cc70a66806\n")
foreach(how "canonical exact" "compressed exact" "compressed_literal exact" "implicit exact" "leafless exact"
        "quantized exact" "shared_planes exact" "canonical devillers_guigue" "canonical moller" "canonical moller_double")
    string(APPEND answers "${how}: 489 contacts, 12 of its own\n")
endforeach()
string(APPEND answers "2377 touch\n2377 touch\n2377 touch\n2377 touch\n")
function(builds name flags)
    run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/${name} -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
        -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS} ${flags}" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON ${ARGN})
    run(${CMAKE_COMMAND} --build ${WORK}/${name})
    prints(${WORK}/${name}/boxes_only "frame 0: 0 overlaps 1\nframe 1: 0 overlaps 1\nframe 1: 0 overlaps 2\nframe 2: 0 overlaps 2\n")
    set(counts "frame 0: 6 contacts\nframe 1: 3 contacts\nframe 2: 0 contacts\n")
    prints(${WORK}/${name}/both_stages "${counts}")
    foreach(with IN ITEMS with_eigen with_aligned_eigen)
        prints(${WORK}/${name}/${with} "${counts}x 1, 2 boxes\n")
    endforeach()
    run(${WORK}/${name}/selected)
    if(NOT output MATCHES "\nsort shell: as named\n.*\n${counts}$")
        message(FATAL_ERROR "selected prints\n${output}")
    endif()
    prints(${WORK}/${name}/inside "1 component, closed\nframe 0: a_inside_b\nframe 1: disjoint\nframe 2: disjoint\n")
    prints(${WORK}/${name}/by_name "3 triangle pairs\n")
    prints(${WORK}/${name}/filtered "all 0-1 0-2 1-2\nfiltered 0-2\nwoken 0-1 0-2\nby name 0-1 0-2\nwithout 0 1: 0-2\nwith 1 2: 0-2 1-2\n")
    prints(${WORK}/${name}/meshes_by_type "${answers}")
endfunction()

# refused(NAME SENTENCE OPTIONS…): configured like that, the sentence is all that CMake has to say.
function(refused name sentence)
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/${name} -DCMAKE_PREFIX_PATH=${WORK}/prefix ${ARGN}
                    RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE output)
    string(REGEX REPLACE "[ \n]+" " " words "${output}")
    string(REGEX MATCHALL "CMake (Error|Warning)" complaints "${output}")
    if(status EQUAL 0 OR NOT words MATCHES "${sentence}" OR NOT complaints STREQUAL "CMake Error")
        message(FATAL_ERROR "${name}: expected one error, \"${sentence}\", not\n${output}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# C++20 with extensions, as the README leaves it to CMake, and C++23 without them, with all that a compiler may do to sums
# where a file lets it.
builds(readme "")
set(flags "-march=native -ffp-contract=fast-honor-pragmas -fassociative-math -freciprocal-math -fno-signed-zeros -fno-trapping-math")
builds(release_23 "${flags}" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_STANDARD=23 -DCMAKE_CXX_EXTENSIONS=OFF)

set(clang -DCMAKE_CXX_COMPILER=${COMPILER})
# Where the machine has them.
find_program(make make)
if(make)
    refused(makefiles "aabblab is made of C\\+\\+ modules, which Unix Makefiles cannot build: configure with -G Ninja\\."
            -G "Unix Makefiles" ${clang})
else()
    message(STATUS "not tried, for want of make: Makefiles")
endif()
find_program(gcc g++)
if(gcc)
    refused(gcc "aabblab needs clang 19 or newer, not GNU [0-9.]+: configure with -DCMAKE_CXX_COMPILER=clang\\+\\+-19\\."
            -G Ninja -DCMAKE_CXX_COMPILER=${gcc})
else()
    message(STATUS "not tried, for want of g++: GCC")
endif()
refused(optional "not found: aabblab is made of C\\+\\+ modules, which are not looked for here" -G Ninja ${clang}
        -DSCAN_POLICY=OLD -DOPTIONAL=ON)
refused(no_language "aabblab is a C\\+\\+ library, and this project has no C\\+\\+: write project\\(NAME LANGUAGES CXX\\)\\."
        -G Ninja -DLANGUAGE=NONE)
refused(unscannable "has none: install it, on Debian with clang-tools-19, and configure afresh\\." -G Ninja
        ${clang} -DCMAKE_CXX_COMPILER_CLANG_SCAN_DEPS=)
refused(unscanned "write cmake_minimum_required\\(VERSION 3\\.28\\) or set\\(CMAKE_CXX_SCAN_FOR_MODULES ON\\) before find_package\\."
        -G Ninja ${clang} -DSCAN_POLICY=OLD)
refused(mixed "boxes_only is compiled in C\\+\\+20 with extensions and by_name in C\\+\\+23 with extensions: give both"
        -G Ninja ${clang} -DOTHER_STANDARD=23)

# Fused where the processor can: then every query says so.
run(${CMAKE_COMMAND} --build ${WORK}/release_23 --target fused)
execute_process(COMMAND ${WORK}/release_23/fused RESULT_VARIABLE status OUTPUT_VARIABLE output)
execute_process(COMMAND ${COMPILER} -march=native -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros)
if(macros MATCHES "__FMA__" AND NOT (status EQUAL 2 AND output MATCHES "products and sums are fused; compile with -ffp-contract=on"))
    message(FATAL_ERROR "fused multiply-add goes unnoticed:\n${output}")
endif()

# Nothing but the standard reaches a consumer, neither its sources nor the interfaces that it compiles.
file(READ ${WORK}/readme/compile_commands.json commands)
string(REPLACE " ${FLAGS} " " " commands "${commands}")
string(REGEX MATCHALL "\"command\": \"[^\n]*boxes_only.cpp\"" command "${commands}")
string(REGEX MATCHALL " [-][^ ]+" options "${command}")
if(NOT options STREQUAL " -std=gnu++20; -o; -c")
    message(FATAL_ERROR "these options reach a consumer: ${options}")
endif()
file(READ ${WORK}/prefix/lib/cmake/aabblab/aabblabTargets.cmake targets)
if(targets MATCHES "[^\n]*COMPILE_(OPTIONS|DEFINITIONS)[^\n]*[^\n\" ]\"")
    message(FATAL_ERROR "these options reach the interfaces: ${CMAKE_MATCH_0}")
endif()

# The README has these programs.
file(READ ${SOURCE}/../../README.md readme)
foreach(program boxes_only both_stages selected)
    file(READ ${SOURCE}/${program}.cpp text)
    string(FIND "${readme}" "```cpp\n${text}```" place)
    if(place EQUAL -1)
        message(FATAL_ERROR "README.md does not have ${program}.cpp as it is")
    endif()
endforeach()
