# cmake -DCHECK=<symbols|bytes|instructions> -DCOSTS=<folder of stage_costs> -DCONSUMER=<scratch folder of consumer/run.cmake> \
#       -P zero_cost.cmake
# A stage or a counter that is left out costs nothing. Beside each check stands what has it, where the same check finds it.
cmake_minimum_required(VERSION 3.28)

# ---- symbols ---------------------------------------------------------------------------------------------------------

# Names in a program: unoptimised, where every function that is compiled has one, and optimised, as it is linked.
function(symbols_of program result)
    if(program STREQUAL "stage_costs")
        set(files ${COSTS}/stage_costs)
    else()
        set(files ${CONSUMER}/readme/${program} ${CONSUMER}/release_23/${program})
    endif()
    set(all "")
    foreach(file IN LISTS files)
        execute_process(COMMAND nm --demangle ${file} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
        string(APPEND all "${symbols}")
    endforeach()
    set(${result} "${all}" PARENT_SCOPE)
endfunction()

# left_out(PROGRAM CONTROL NAMES…): none of these stands in a symbol of the program, and each in one of the control, so that
# a name that nothing has any more does not pass.
function(left_out program control)
    symbols_of(${program} own)
    symbols_of(${control} others)
    foreach(name IN LISTS ARGN)
        string(FIND "${own}" ${name} place)
        if(NOT place EQUAL -1)
            string(SUBSTRING "${own}" ${place} 200 there)
            message(SEND_ERROR "${program} has what it does not need: ${there}")
        endif()
        string(FIND "${others}" ${name} place)
        if(place EQUAL -1)
            message(SEND_ERROR "${control} has no symbol with ${name}; this check would see nothing")
        endif()
    endforeach()
endfunction()

function(check_symbols)
    # Of meshes.
    left_out(boxes_only both_stages local_detection mesh _tree triangle posed_boxes model contact basic_pipeline)
    # Of other ways to search, and of what is made by name.
    left_out(boxes_only both_stages column simd_sweep bucket_sort worker_threads)
    left_out(boxes_only stage_costs axial_cut subset_lists work_counters global_stage prepared_search collision_filter
             filtered_search box_index)
    left_out(boxes_only selected uniform_grid all_axes incremental_sweep strategy_choice)
    # Of both stages, composed when they are compiled: neither division nor counters nor other strategies.
    left_out(both_stages stage_costs work_counters global_stage prepared_search axial_cut one_axis collision_filter
             filtered_search box_index)
    left_out(both_stages selected divided_scene local_stage neighbour_list split_mesh canonical_tree depth_first_walk
             strategy_choice)
    # Distances, which are only measured where they are asked for.
    left_out(both_stages by_name within_detection distance_detection disjoint_triangles)
    # The engines, which nothing of the library has.
    foreach(program boxes_only both_stages selected by_name)
        symbols_of(${program} own)
        foreach(name CGAL:: fcl:: ccdGJK rtcCollide boost::geometry btDbvt dSpaceCollide)
            string(FIND "${own}" ${name} place)
            if(NOT place EQUAL -1)
                message(SEND_ERROR "${program} has an engine in it: ${name}")
            endif()
        endforeach()
    endforeach()
endfunction()

# ---- bytes -----------------------------------------------------------------------------------------------------------

# held(WAY): what it holds in itself and on the heap, of a row of 1000 boxes.
function(held way)
    execute_process(COMMAND ${COSTS}/stage_costs ${way} 1000 OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
    if(NOT output MATCHES "^([1-9][0-9]*) pairs, ([0-9]+) bytes, ([0-9]+) on the heap\n$")
        message(FATAL_ERROR "stage_costs ${way} prints\n${output}")
    endif()
    set(${way}_pairs ${CMAKE_MATCH_1} PARENT_SCOPE)
    set(${way}_itself ${CMAKE_MATCH_2} PARENT_SCOPE)
    set(${way}_heap ${CMAKE_MATCH_3} PARENT_SCOPE)
    message(STATUS "${way}: ${CMAKE_MATCH_2} bytes, ${CMAKE_MATCH_3} on the heap")
endfunction()

# require_same_pairs(HAND WAYS…)
function(require_same_pairs hand)
    foreach(way IN LISTS ARGN)
        if(NOT ${way}_pairs EQUAL ${hand}_pairs)
            message(SEND_ERROR "${way} finds ${${way}_pairs} pairs, and ${hand} ${${hand}_pairs}")
        endif()
    endforeach()
endfunction()

# require_as_many_bytes(HAND WAY)
function(require_as_many_bytes hand way)
    foreach(where itself heap)
        if(NOT ${way}_${where} EQUAL ${hand}_${where})
            message(SEND_ERROR "${where}: ${${way}_${where}} bytes of ${way}, ${${hand}_${where}} of ${hand}")
        endif()
    endforeach()
endfunction()

# require_more_bytes(HAND SEEN…): what is there is seen, in the search itself or on the heap.
function(require_more_bytes hand)
    foreach(seen IN LISTS ARGN)
        string(REGEX REPLACE ".*_" "" where ${seen})
        if(NOT ${seen} GREATER ${hand}_${where})
            message(SEND_ERROR "${seen}: ${${seen}} bytes, no more than ${hand}; this check would see nothing")
        endif()
    endforeach()
endfunction()

function(check_bytes)
    foreach(way by_hand uncounted composed counted cut prepared filtered columns_by_hand columns counted_columns
                prepared_columns)
        held(${way})
    endforeach()
    require_same_pairs(by_hand uncounted composed counted cut prepared filtered columns_by_hand columns counted_columns
                       prepared_columns)
    require_as_many_bytes(by_hand composed)
    require_as_many_bytes(by_hand uncounted)
    require_as_many_bytes(columns_by_hand columns)
    require_more_bytes(by_hand counted_itself cut_itself counted_heap cut_heap prepared_heap filtered_heap)
    require_more_bytes(columns_by_hand counted_columns_itself prepared_columns_heap)
endfunction()

# ---- instructions ----------------------------------------------------------------------------------------------------

# counted(WAY OBJECTS): sets instructions and branches, conditional ones, that its eight measured frames execute. They are
# counted once.
function(counted way objects)
    get_property(counts GLOBAL PROPERTY counts_of_${way}_${objects})
    if(NOT counts)
        execute_process(
            COMMAND ${valgrind} --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=*measured_frames* --branch-sim=yes
                    ${COSTS}/stage_costs ${way} ${objects}
            OUTPUT_QUIET ERROR_VARIABLE output RESULT_VARIABLE status)
        if(NOT status EQUAL 0 OR NOT output MATCHES "Collected : ([1-9][0-9]*) ([1-9][0-9]*)")
            message(FATAL_ERROR "callgrind counts nothing of stage_costs ${way} ${objects}:\n${output}")
        endif()
        set(counts ${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
        set_property(GLOBAL PROPERTY counts_of_${way}_${objects} ${counts})
    endif()
    list(GET counts 0 instructions)
    list(GET counts 1 branches)
    set(instructions ${instructions} PARENT_SCOPE)
    set(branches ${branches} PARENT_SCOPE)
endfunction()

# more_than(HAND WAY): sets what eight frames of a way take more than by hand, with 2000 boxes, and how much more again with
# 4000: instructions and instructions_grown, branches and branches_grown.
function(more_than hand way)
    foreach(objects 2000 4000)
        foreach(one ${hand} ${way})
            counted(${one} ${objects})
            set(${one}_instructions_${objects} ${instructions})
            set(${one}_branches_${objects} ${branches})
        endforeach()
    endforeach()
    foreach(kind instructions branches)
        math(EXPR first "${${way}_${kind}_2000} - ${${hand}_${kind}_2000}")
        math(EXPR grown "${${way}_${kind}_4000} - ${${hand}_${kind}_4000} - (${first})")
        message(STATUS "${way}: with 2000 boxes ${first} ${kind} more than the ${${hand}_${kind}_2000} of ${hand}, with 4000 ${grown} more again")
        set(${kind} ${first} PARENT_SCOPE)
        set(${kind}_grown ${grown} PARENT_SCOPE)
    endforeach()
endfunction()

# A frame may take some more than by hand, which looks whether it is in order; each box, of which there are 16000 more, must
# take less than a sixteenth. Where not even the type of no_counters is there, the compiler may do the same in another way:
# less than three instructions a box differ.
function(check_instructions)
    find_program(valgrind valgrind)
    if(NOT valgrind)
        message("not tried, for want of valgrind: instructions")
        return()
    endif()
    more_than(by_hand uncounted)
    if(instructions_grown LESS -48000 OR branches_grown LESS -1000)
        message(SEND_ERROR "no_counters costs something")
    endif()
    foreach(pair "by_hand composed" "columns_by_hand columns")
        separate_arguments(pair)
        more_than(${pair})
        foreach(kind instructions branches)
            if(${kind} GREATER 1600 OR ${kind}_grown GREATER 1000)
                message(SEND_ERROR "${pair}: something is there that was left out")
            endif()
        endforeach()
    endforeach()
    foreach(pair "by_hand counted" "by_hand cut" "by_hand prepared" "by_hand filtered" "columns_by_hand prepared_columns")
        separate_arguments(pair)
        more_than(${pair})
        if(NOT (instructions_grown GREATER 16000 AND branches_grown GREATER 16000))
            message(SEND_ERROR "${pair}: this check would not see it")
        endif()
    endforeach()
endfunction()

cmake_language(CALL check_${CHECK})
