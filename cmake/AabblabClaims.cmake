# aabblab_claim(ID FILE PRIMARY number [EXPECTS not_more]): declares the claim ID of the paper, "C10", which the function
# c10_claim() in FILE.cpp makes; several claims may have one file. So many primary endpoints decide it, which it expects
# to be less than 1, or not more. tests/paper/recompute.py reads these lines too, so each stays on its line.
function(aabblab_claim id file)
    cmake_parse_arguments(PARSE_ARGV 2 claim "" "PRIMARY;EXPECTS" "")
    if(claim_UNPARSED_ARGUMENTS OR NOT claim_PRIMARY)
        message(FATAL_ERROR "aabblab_claim(${id}) takes PRIMARY and a number, and not ${claim_UNPARSED_ARGUMENTS}.")
    endif()
    if(NOT claim_EXPECTS)
        set(claim_EXPECTS less)
    endif()
    string(TOLOWER "${id}_claim" function)
    target_sources(aabblab_claims PRIVATE ${file}.cpp)
    set_property(GLOBAL APPEND_STRING PROPERTY aabblab_claim_declarations "draft ${function}(const measurements& m);\n")
    set_property(GLOBAL APPEND_STRING PROPERTY aabblab_claim_entries
                 "{{\"${id}\", ${claim_PRIMARY}, expectation::${claim_EXPECTS}}, ${function}},\n")
endfunction()

# aabblab_claim_list(): the list of all declared claims as a generated unit of the module aabblab.claims.
function(aabblab_claim_list)
    get_property(claim_declarations GLOBAL PROPERTY aabblab_claim_declarations)
    get_property(claim_entries GLOBAL PROPERTY aabblab_claim_entries)
    configure_file(claim_list.cpp.in claim_list.cpp @ONLY)
    target_sources(aabblab_claims PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/claim_list.cpp)
endfunction()
