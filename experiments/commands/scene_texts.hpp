#pragma once

import aabb.std;
import aabblab.measures;
import aabblab.output;
import aabblab.scenes;
import aabblab.tables;

/// What several commands say of a scene, and how.
namespace aabblab {

/// What columns of times include, for the lines below a table.
inline constexpr const char* build_ms_text =
    "build ms: the stages are made, with the trees of all meshes, before frame 0.";
inline constexpr const char* ms_a_frame_text =
    "ms/frame: update, search and detection of a frame, the mean of those after frame 0; of frame 0 where it is alone.";

/// "brownian (objects=1000, …)"
[[nodiscard]] inline std::string heading_of(const scene_choice& scene) {
    return scene.kind + " (" + visible(parameters_text(scene)) + ")";
}

[[nodiscard]] inline table table_of(const std::vector<told_measure>& measures) {
    table t{{{"measured", false}, {"", false}}, {}};
    for (const told_measure& one : measures) t.rows.push_back({one.name, one.value});
    return t;
}

/// Adds a row of which one cell is broken into lines of at most so many bytes; the others stand in the first of them.
inline void add_wrapped_row(table& t, std::vector<std::string> cells, std::size_t column, std::size_t room) {
    std::istringstream lines(wrapped(cells[column], room));
    while (std::getline(lines, cells[column])) {
        t.rows.push_back(cells);
        std::ranges::fill(cells, "");
    }
}

}  // namespace aabblab
