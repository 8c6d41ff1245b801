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
add_compile_options("$<BUILD_INTERFACE:${aabblab_options}>")
add_link_options(-Wl,--gc-sections)
