# Options of our own targets. They are not part of what is installed: who uses the library compiles it as they like.
set(aabblab_options
    -Wall
    -Wextra
    -Wpedantic
    -Wshadow
    -Wconversion
    -Wno-sign-conversion
    # A column of small functions and unused data falls away when a consumer links.
    -ffunction-sections
    -fdata-sections
    # Scenes are the same on every machine.
    -ffp-contract=off
    # Vectors of the compiler's are handed over within what one set of options compiles, so that their ABI is the same.
    -Wno-psabi)
if(AABBLAB_NATIVE)
    list(APPEND aabblab_options -march=native)
endif()
# Preset `lint`: clang-tidy as a plugin of the compiler.
if(AABBLAB_LINT)
    set(llvm /usr/lib/llvm-19)
    set(plugin ${PROJECT_BINARY_DIR}/clang_tidy.so)
    file(GLOB checks ${llvm}/lib/libclangTidy*.a)
    set(registered ${checks})
    list(FILTER registered INCLUDE REGEX "Tidy(Bugprone|Modernize|Performance|Readability)Module")
    execute_process(
        COMMAND
            ${CMAKE_CXX_COMPILER} -std=c++20 -O1 -fPIC -fno-rtti -shared -isystem ${llvm}/include ${PROJECT_SOURCE_DIR}/.ci/clang_tidy.cpp
            -o ${plugin} -Wl,--whole-archive ${registered} -Wl,--no-whole-archive,--start-group ${checks}
            ${llvm}/lib/libclangIncludeCleaner.a -Wl,--end-group ${llvm}/lib/libclang-cpp.so.19.1 ${llvm}/lib/libLLVM.so.19.1
            COMMAND_ERROR_IS_FATAL ANY)
    list(APPEND aabblab_options -fplugin=${plugin})
endif()
add_compile_options("$<BUILD_INTERFACE:${aabblab_options}>")
add_link_options(-Wl,--gc-sections)
