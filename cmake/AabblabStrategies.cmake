# aabblab_kind(KIND STAGE DEFAULT [BESIDE NAME] [APART]): declares a kind of strategy of a stage (global_search or
# local_detection), and the strategy that a composition has where it names none; BESIDE says which where it names a strategy
# of another kind that is compiled with this one. The kinds of a stage are compiled together, every combination of them; one
# that stands APART is compiled alone and handed to the stage when that is made.
function(aabblab_kind kind stage default)
    cmake_parse_arguments(PARSE_ARGV 3 of "APART" "BESIDE" "")
    set_property(GLOBAL APPEND PROPERTY aabblab_kinds ${kind})
    if(of_APART)
        set(apart true)
    else()
        set(apart false)
        set_property(GLOBAL APPEND PROPERTY aabblab_${stage}_kinds ${kind})
    endif()
    if(NOT of_BESIDE)
        set(of_BESIDE ${default})
    endif()
    set_property(GLOBAL APPEND PROPERTY aabblab_kind_infos
                 "{\"${kind}\", stage::${stage}, \"${default}\", \"${of_BESIDE}\", ${apart}}")
endfunction()

# aabblab_strategy(KIND NAME): declares a strategy.
function(aabblab_strategy kind name)
    get_property(kinds GLOBAL PROPERTY aabblab_kinds)
    if(NOT kind IN_LIST kinds)
        list(JOIN kinds ", " known)
        message(FATAL_ERROR "aabblab_strategy(${kind} ${name}): ${kind} is not a kind of strategy; those are ${known}")
    endif()
    aabblab_strategy_module(${kind} ${name})
    set_property(GLOBAL APPEND PROPERTY aabblab_${kind}_names ${name})
endfunction()

# aabblab_family(KIND NAME): declares a module aabb.KIND.NAME that strategies of the kind share.
function(aabblab_family kind name)
    aabblab_strategy_module(${kind} ${name})
endfunction()

# aabblab_room(NAME FILES…): declares a room, NAME/, with what strategies share that is large: the module aabb.NAME, which
# strategies import, and behind it the modules aabb.NAME.FILE, which only the room itself does.
function(aabblab_room room)
    foreach(name IN LISTS room ARGN)
        aabblab_strategy_module(${room} ${name})
    endforeach()
endfunction()

function(aabblab_strategy_module kind name)
    if(NOT TARGET aabblab_strategies)
        add_library(aabblab_strategies STATIC)
        add_library(aabblab::strategies ALIAS aabblab_strategies)
        set_target_properties(aabblab_strategies PROPERTIES EXPORT_NAME strategies)
        target_link_libraries(aabblab_strategies PUBLIC aabblab_core)
    endif()
    target_sources(aabblab_strategies PUBLIC FILE_SET CXX_MODULES BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR}
                                             FILES ${kind}/${name}.cppm)
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${kind}/${name}.cpp)
        target_sources(aabblab_strategies PRIVATE ${kind}/${name}.cpp)
    endif()
endfunction()

# Sets <result> to FORMAT for each of the words, WORD replaced, with the separator between; ! stands for a
# semicolon, which a list of CMake would lose.
function(aabblab_each result format separator)
    set(all "")
    foreach(word IN LISTS ARGN)
        string(REPLACE "WORD" "${word}" one "${format}")
        list(APPEND all "${one}")
    endforeach()
    list(JOIN all "${separator}" all)
    string(REPLACE "!" ";" all "${all}")
    set(${result} "${all}" PARENT_SCOPE)
endfunction()

# aabblab_registry(): the modules aabb.registry, over all declared kinds and strategies, aabb.selection and
# aabb.auto_detector. Their interfaces name no strategy; generated implementation units do, one for each strategy of a stage's first kind, so that
# a changed strategy rebuilds few of them.
function(aabblab_registry)
    set(from ${CMAKE_CURRENT_SOURCE_DIR}/registry)
    set(to ${CMAKE_CURRENT_BINARY_DIR}/registry)
    get_property(kinds GLOBAL PROPERTY aabblab_kinds)
    get_property(infos GLOBAL PROPERTY aabblab_kind_infos)
    aabblab_each(kind_names "WORD" ", " ${kinds})
    aabblab_each(kind_infos "WORD" ",\n    " ${infos})
    configure_file(${from}/kinds.cppm.in ${to}/kinds.cppm @ONLY)

    set(exports "")
    set(type_lists "")
    foreach(kind IN LISTS kinds)
        get_property(names GLOBAL PROPERTY aabblab_${kind}_names)
        aabblab_each(imports_of_${kind} "import aabb.${kind}.WORD!\n" "" ${names})
        aabblab_each(types_of_${kind} "WORD_${kind}" ", " ${names})
        aabblab_each(more "export import aabb.${kind}.WORD!\n" "" ${names})
        string(APPEND exports "${more}")
        string(APPEND type_lists "using ${kind}s = type_list<${types_of_${kind}}>;\n")
    endforeach()
    configure_file(${from}/strategies.cppm.in ${to}/strategies.cppm @ONLY)

    aabblab_each(cases "        case strategy_kind::WORD: return take(WORDs{})!" "\n" ${kinds})
    set(units "")
    foreach(stage global_search local_detection)
        get_property(others GLOBAL PROPERTY aabblab_${stage}_kinds)
        list(POP_FRONT others first)
        set(other_imports "")
        set(other_types "")
        foreach(kind IN LISTS others)
            string(APPEND other_imports "${imports_of_${kind}}")
            string(APPEND other_types ", type_list<${types_of_${kind}}>{}")
        endforeach()
        get_property(names GLOBAL PROPERTY aabblab_${first}_names)
        aabblab_each(${stage}_declarations "composed::${stage}_rows ${stage}_WORD()!" "\n" ${names})
        aabblab_each(${stage}_functions "${stage}_WORD" ", " ${names})
        foreach(name IN LISTS names)
            configure_file(${from}/stage.cpp.in ${to}/${stage}_${name}.cpp @ONLY)
            list(APPEND units ${to}/${stage}_${name}.cpp)
        endforeach()
    endforeach()
    configure_file(${from}/catalog.cpp.in ${to}/catalog.cpp @ONLY)

    target_sources(aabblab_strategies PUBLIC FILE_SET CXX_MODULES BASE_DIRS ${CMAKE_CURRENT_BINARY_DIR}
                                             FILES ${to}/strategies.cppm)
    add_library(aabblab_registry STATIC)
    add_library(aabblab::registry ALIAS aabblab_registry)
    set_target_properties(aabblab_registry PROPERTIES EXPORT_NAME registry)
    target_sources(
        aabblab_registry
        PUBLIC FILE_SET CXX_MODULES BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}
               FILES registry/registry.cppm
                     registry/composed.cppm
                     registry/distance_stages.cppm
                     selection/auto_detector.cppm
                     selection/selection.cppm
                     ${to}/kinds.cppm
        PRIVATE registry/registry.cpp registry/distance_stages.cpp selection/auto_detector.cpp selection/selection.cpp ${to}/catalog.cpp ${units})
    target_link_libraries(aabblab_registry PUBLIC aabblab_core PRIVATE aabblab_strategies)
endfunction()
