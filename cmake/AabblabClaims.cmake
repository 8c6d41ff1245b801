# aabblab_claim(ID FILE): declares the claim ID, "C10", whose ratios the function c10_claim() in FILE.cpp computes; several
# claims may have one file. paper/claims/endpoints.toml states what decides it.
function(aabblab_claim id file)
    if(ARGN)
        message(FATAL_ERROR "aabblab_claim(${id}) takes a file, and not ${ARGN}.")
    endif()
    string(TOLOWER "${id}_claim" function)
    target_sources(aabblab_claims PRIVATE ${file}.cpp)
    set_property(GLOBAL APPEND_STRING PROPERTY aabblab_claim_declarations "draft ${function}(const measurements& m);\n")
    set_property(GLOBAL APPEND_STRING PROPERTY aabblab_claim_entries "{\"${id}\", ${function}},\n")
endfunction()

# aabblab_claim_list(): the list of all declared claims as a generated unit of the module aabblab.claims.
function(aabblab_claim_list)
    get_property(claim_declarations GLOBAL PROPERTY aabblab_claim_declarations)
    get_property(claim_entries GLOBAL PROPERTY aabblab_claim_entries)
    configure_file(claim_list.cpp.in claim_list.cpp @ONLY)
    target_sources(aabblab_claims PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/claim_list.cpp)
endfunction()
