# aabblab_embed(TARGET NAME.EXT): the text of that file, which may be in another folder, as the constant
# aabblab::embedded::name_ext of the header name_ext.hpp, for the sources of the target.
function(aabblab_embed target file)
    cmake_path(GET file FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} name)
    string(TOLOWER ${name} name)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    file(CONFIGURE OUTPUT ${name}.hpp CONTENT [=[
#pragma once
#include <string_view>

namespace aabblab::embedded {
inline constexpr std::string_view @name@ = R"embedded(@text@)embedded";
}
]=] @ONLY)
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
