#pragma once

namespace aabblab {

/// What columns of times include, for the lines below a table.
inline constexpr const char* build_ms_text =
    "build ms: the stages are made, with the trees of all meshes, before frame 0.";
inline constexpr const char* ms_a_frame_text =
    "ms/frame: update, search and detection of a frame, the mean of those after frame 0; of frame 0 where it is alone.";

}  // namespace aabblab
