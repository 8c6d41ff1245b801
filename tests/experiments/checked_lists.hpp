#pragma once

#include "program_json.hpp"

#include "csv_rows.hpp"

// Lists of pairs for `check`, and its report.

using rows = std::vector<std::array<std::int64_t, 3>>;  ///< frame, a, b

/// A recording of drifting cubes with the list of its pairs.
struct checked_scene {
    std::string recording;
    rows pairs;
};

[[nodiscard]] inline checked_scene scene_in(const temporary_folder& folder, const std::string& kind = "brownian",
                                            const std::vector<std::string>& more = {"--objects", "60", "--density",
                                                                                    "0.3"}) {
    checked_scene scene{folder / "scene.aabbs", {}};
    run_well(joined({"scene", kind, "--frames", "5", "--out", scene.recording}, more));
    run_well({"pairs", scene.recording, "--out", folder / "right.csv"});
    for (const auto& r : numbers_of(bytes_of_file(folder / "right.csv")))
        scene.pairs.push_back(
            {static_cast<std::int64_t>(r[0]), static_cast<std::int64_t>(r[1]), static_cast<std::int64_t>(r[2])});
    REQUIRE(scene.pairs.size() > 30);
    return scene;
}

[[nodiscard]] inline std::string text_of(const rows& list, const std::string& header = "frame,a,b\n",
                                         char separator = ',') {
    std::string text = header;
    for (const auto& [frame, a, b] : list)
        text += std::to_string(frame) + separator + std::to_string(a) + separator + std::to_string(b) + "\n";
    return text;
}

/// The report on a list as JSON. The exit status must agree with it.
[[nodiscard]] inline nlohmann::json checked(const std::vector<std::string>& arguments) {
    const program_result result = run_program(joined({"check", "--json"}, arguments));
    INFO(result.err);
    REQUIRE((result.status == 0 || result.status == 1));
    auto report = nlohmann::json::parse(result.out);
    REQUIRE(report["right"] == (result.status == 0));
    return report;
}

/// The only sentence on what the wrong pairs have in common.
[[nodiscard]] inline std::string pattern_of(const nlohmann::json& report) {
    INFO(report.dump());
    REQUIRE(report["patterns"].size() == 1);
    return report["patterns"][0];
}

[[nodiscard]] inline std::string npy_of(const rows& list) {
    std::string header =
        "{'descr': '<i8', 'fortran_order': False, 'shape': (" + std::to_string(list.size()) + ", 3), }";
    header.resize(118, ' ');
    header.back() = '\n';
    std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + '\x76' + '\0' + header;
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof list[0]);
    return bytes;
}

/// Recordings of boxes that are all in one frame, or in several.
inline void write_boxes(const std::string& file, const std::vector<std::vector<std::array<float, 6>>>& frames) {
    std::string bytes(256, '\0');
    const auto add = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    add(static_cast<std::int32_t>(frames[0].size()));
    add(static_cast<std::int32_t>(frames.size() - 1));
    add(std::int32_t{0});
    add(std::int32_t{0});
    const auto add_box = [&](const std::array<float, 6>& b) {
        for (int k = 0; k < 6; ++k) {
            add(b[static_cast<std::size_t>(k)]);
            if (k % 3 == 2) add(0.F);
        }
    };
    add_box({-1e6F, -1e6F, -1e6F, 1e6F, 1e6F, 1e6F});
    for (const auto& frame : frames)
        for (const auto& box : frame) add_box(box);
    std::ofstream(file, std::ios::binary) << bytes;
}
