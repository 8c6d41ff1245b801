#pragma once

#include <random>

import aabb.std;
import aabb;
import aabb.registry;
import aabblab.configs;
import aabblab.metrics;
import aabblab.results;
import aabblab.trials;
import aabblab.scenes;

// Imports modules, so it is included after every other header.

/// Results of the paper's experiments, made up: in place of playing a scene a world says what would come out.
namespace worlds {

/// A composition in a scene.
struct played {
    const aabblab::experiment& experiment;
    const aabblab::scene_choice& scene;
    const aabblab::candidate_name& tested;

    [[nodiscard]] std::string value_of(const std::string& setting) const {
        for (const aabb::setting& s : scene.settings)
            if (s.name == setting) return s.value;
        return "";
    }
    [[nodiscard]] bool has(const std::string& part) const {
        return std::ranges::any_of(tested.choices.all,
                                   [&](const std::string& text) { return text.find(part) != std::string::npos; });
    }
};

/// Of every scene.
inline constexpr const char* exact_digest = "0123456789abcdef";

/// The rows of one experiment, as if it had been run.
/// @param tell sets times, counts and bytes
/// @param disturb what is not in the processor time
inline void write_experiment(
    const std::filesystem::path& folder, const aabblab::experiment& e,
    const std::function<void(const played&, aabblab::row&)>& tell,
    const std::function<void(aabblab::row&)>& disturb = [](aabblab::row&) {}) {
    aabblab::results_folder results(folder / e.name, record_of(e), aabblab::existing_results::reject);
    const std::size_t repeats = e.records(aabblab::metric_group::time) ? e.repeats : 1;
    for (const aabblab::scene_choice& scene : e.scenes) {
        results.set_digest(scene, exact_digest);
        for (const aabblab::candidate& tested : aabblab::candidates_for(e, scene))
            for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
                aabblab::row r;
                r.experiment = e.name;
                r.scene = scene;
                r.frames = 2;
                r.name = tested.name;
                r.repeat = repeat;
                r.process = repeat * e.processes / repeats;
                r.status = "exact";
                r.digest = exact_digest;
                r.build_ms = r.first_ms = r.update_ms = r.search_ms = r.detect_ms = 1;
                const played p{e, scene, tested.name};
                r.objects = p.value_of("objects").empty() ? 2 : std::stoul(p.value_of("objects"));
                if (has_meshes(scene)) r.triangles = 1000;
                for (auto& count : r.counts) count = 1000 * r.objects;
                for (auto& bytes : r.bytes) bytes = 30'000;
                tell(p, r);
                std::tie(r.build_cpu_ms, r.first_cpu_ms, r.update_cpu_ms, r.search_cpu_ms, r.detect_cpu_ms) =
                    std::tie(r.build_ms, r.first_ms, r.update_ms, r.search_ms, r.detect_ms);
                disturb(r);
                results.add(r);
            }
    }
    results.seal();
}

inline std::vector<aabblab::experiment> all_experiments(aabblab::experiment_size size) {
    std::vector<aabblab::experiment> all;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(AABBLAB_CONFIGS)))
        all.push_back(aabblab::read_experiment(file.path(), size));
    return all;
}

/// Times of the elementary tests: of triangle and box, and of two boxes, however they are tested.
inline void write_tests(const std::filesystem::path& folder, double triangle_box, double box) {
    std::filesystem::create_directories(folder / "c6");
    for (const char* process : {"process-0.json", "process-1.json", "process-2.json"}) {
        std::ofstream out(folder / "c6" / process);
        out << "{\"benchmarks\": [";
        for (const char* frame : {"", "/frame:a"})
            for (const auto& [name, ns] : {std::pair{"triangle_box", triangle_box},
                                           {"triangle_box_moller", triangle_box},
                                           {"triangle_aabb", triangle_box},
                                           {"rotated_box_6", box},
                                           {"rotated_box_15", box},
                                           {"box", box}})
                out << "{\"run_name\": \"test/" << name << frame
                    << "\", \"run_type\": \"iteration\", \"time_unit\": \"ns\", "
                    << "\"cpu_time\": " << ns << "},";
        out << "{\"run_type\": \"aggregate\"}]}";
    }
}

/// The count of this name.
inline std::optional<std::uint64_t>& count_in(aabblab::row& r, std::string_view name) {
    return r.counts.at(static_cast<std::size_t>(std::ranges::find(aabb::work_names, name) - aabb::work_names.begin()));
}
inline std::optional<std::uint64_t>& bytes_in(aabblab::row& r, std::string_view name) {
    return r.bytes.at(
        static_cast<std::size_t>(std::ranges::find(aabblab::byte_columns, name) - aabblab::byte_columns.begin()));
}

/// Time of a grid or of the cut: where `ratio` is less than 1 each scene has another best cell size, and the cut is as
/// good as that one; in larger worlds a grid takes longer. Where it is more, the best size is the worst one, and the
/// cut is worse still.
inline double partition_time(const played& p, double ratio) {
    const bool cut = p.has("axial_cut");
    if (p.experiment.name == "c5_world") return p.value_of("density") == "0.1" ? 1 : cut ? ratio : 1 / ratio;
    if (cut) return std::max(1.0, ratio * ratio);
    const std::string best = p.scene.kind == "clustered"     ? "cell_size=32"
                             : p.scene.kind == "mixed_sizes" ? "cell_size=64"
                                                             : "cell_size=8";
    if (p.tested[aabb::strategy_kind::partition].ends_with(best)) return std::max(1.0, ratio);
    return ratio >= 1 ? 1 : 1 / ratio / ratio;
}

/// With each doubling of the segments, and once more with those that are chosen automatically.
inline double segments_time(const played& p, double ratio) {
    const std::size_t at = p.tested[aabb::strategy_kind::partition].rfind('=');
    if (at == std::string::npos) return 1;
    const std::string wanted = p.tested[aabb::strategy_kind::partition].substr(at + 1);
    double time = wanted == "auto" ? ratio : 1;
    for (const int segments : {4, 8, 16, 32, 64, 256})
        if (wanted == "auto" || std::stoi(wanted) >= segments) time *= ratio;
    return time;
}

/// Who has all of these parts takes `ratio` of the time of others.
inline auto with(std::vector<std::string> parts) {
    return [parts = std::move(parts)](const played& p, double ratio) {
        return std::ranges::all_of(parts, [&](const std::string& part) { return p.has(part); }) ? ratio : 1;
    };
}
/// The cut saves one half of what is saved, Shell sort on it the other.
inline double search_time(const played& p, double ratio) {
    return !p.has("axial_cut") ? 1 : p.has("shell") ? ratio : std::sqrt(ratio);
}
/// Where a factor has this value nothing takes longer, elsewhere all does where `ratio` is more than 1.
inline auto beyond(const std::string& factor, const std::string& value) {
    return [=](const played& p, double ratio) { return p.value_of(factor) == value ? 1 : std::max(1.0, ratio); };
}

inline void scale(std::optional<std::uint64_t>& number, double by) {
    number = static_cast<std::uint64_t>(static_cast<double>(number.value_or(0)) * by);
}

/// What stands for an experiment's measurements where all that claims say is less takes `ratio`. Where there is no row
/// nothing differs.
struct experiment_row {
    std::string experiment;
    std::function<double(const played& p, double ratio)> time = with({"no such part"});
    /// Counts and bytes, where they follow.
    std::function<void(const played& p, double ratio, aabblab::row& r)> count = [](const played&, double, auto&) {};
};

inline std::vector<experiment_row> experiment_rows() {
    const std::vector<std::string> global_parts{"projections", "partition", "sweep"};
    const auto improved = with({"shell", "axial_cut"});
    const auto compressed = [](const played& p, double ratio) {
        return p.has("compressed") || p.has("leafless") ? ratio : 1;
    };
    const auto fewer_tests = [](const played& p, double ratio, aabblab::row& r) {
        if (p.has("axial_cut")) scale(count_in(r, "box_tests"), ratio);
    };
    const auto fewer_bytes = [](const played& p, double ratio, aabblab::row& r) {
        for (const char* part : {"nodes", "indices"})
            if (p.has("compressed")) scale(bytes_in(r, part), ratio);
    };
    const auto growing = [=](const std::string& experiment, const std::string& factor, const std::string& value) {
        const auto time = [=, grown = beyond(factor, value)](const played& p, double ratio) {
            return grown(p, ratio) * (factor == "objects" ? std::stod(p.value_of("objects")) : 1);
        };
        return experiment_row{experiment, time, [=](const played& p, double ratio, aabblab::row& r) {
                                  for (const std::string& part : global_parts)
                                      bytes_in(r, part) = static_cast<std::uint64_t>(1000 * time(p, ratio) + 0.5);
                              }};
    };
    return {{"figure1", search_time, fewer_tests},
            {"three_lists", search_time, fewer_tests},
            {"choices", improved},
            {"figure2", compressed, fewer_bytes},
            {"figure2_million", compressed, fewer_bytes},
            {"table1", with({"median"})},
            // The work of an element grows with N where the claim is wrong.
            {"c2", with({"compressed"}),
             [](const played&, double ratio, aabblab::row& r) {
                 for (const char* work : {"comparisons", "moves"})
                     if (ratio > 1) scale(count_in(r, work), std::log10(static_cast<double>(r.objects)));
             }},
            {"c3", with({"shell"})},
            // As many segments as were wanted: the limit is far.
            {"c4", segments_time,
             [](const played& p, double, aabblab::row& r) {
                 const std::string& wanted = p.tested[aabb::strategy_kind::partition];
                 if (const std::size_t at = wanted.rfind('='); at != std::string::npos)
                     count_in(r, "segments_got") = wanted.ends_with("auto") ? 8 : std::stoul(wanted.substr(at + 1));
             }},
            {"c5", partition_time},
            {"c5_world", partition_time,
             [=](const played& p, double ratio, aabblab::row& r) {
                 for (const std::string& part : global_parts)
                     if (p.value_of("density") != "0.1")
                         scale(bytes_in(r, part), p.has("axial_cut") ? ratio : 1 / ratio);
             }},
            {"c9", with({"split_large"})},
            {"c9_geometry", with({"split_mesh"})},
            // The limit acts.
            {"c10", with({"limit=on"}),
             [](const played& p, double, aabblab::row& r) {
                 if (p.has("limit=on")) scale(count_in(r, "segments_got"), 0.5);
             }},
            {"c11", [=](const played& p, double ratio) { return improved(p, ratio) * with({"compressed"})(p, ratio); }},
            growing("smb_objects", "objects", "1000"),
            growing("smb_density", "density", "0.01"),
            growing("smb_sizes", "ratio", "1.01")};
}

/// What is expected of a claim in worlds in which it is neither true nor false.
struct claim_row {
    std::string id;
    std::string where_equal = "no difference";  ///< the verdict where nothing differs
    bool is_timed = true;                       ///< counts, bytes and the times of Google Benchmark have no noise here
    std::set<std::string> primaries{};          ///< where they are, in words, of claims that are told by them
};
/// A row for each claim.
inline const std::vector<claim_row>& claim_rows() {
    static const std::vector<claim_row> all{
        {.id = "C1a",
         .primaries = {"brownian, objects 10,000, displacement 0.1", "brownian, objects 10,000, displacement 0.001",
                       "brownian, objects 1,000, displacement 0.1",
                       "brownian, objects 10,000, displacement 0.1, sweep all_axes",
                       "brownian, objects 10,000, displacement 0.1, over incremental",
                       "brownian, objects 10,000, displacement 0.001, over incremental"}},
        {"C1b"},
        {"C1c"},
        {"C2", "holds", false},
        {.id = "C3",
         .primaries = {"brownian, objects 10,000, displacement 0.1, gaps ciura",
                       "brownian, objects 10,000, displacement 0.1, gaps ciura_eight",
                       "brownian, objects 10,000, displacement 0.1, gaps four_one",
                       "brownian, objects 10,000, displacement 0.1, gaps tokuda",
                       "brownian, objects 10,000, displacement 0.1, gaps shell",
                       "line, objects 100,000, displacement 0.1, gaps ciura",
                       "line, objects 100,000, displacement 0.1, gaps ciura_eight",
                       "line, objects 100,000, displacement 0.1, gaps four_one",
                       "line, objects 100,000, displacement 0.1, gaps tokuda",
                       "line, objects 100,000, displacement 0.1, gaps shell"}},
        {"C4a"},
        {"C4b", "holds"},  // more segments bring nothing, and fewer lose nothing
        {"C5a"},
        {"C5b", "holds"},
        {"C5c", "no difference", false},
        {"C5d"},
        {"C6", "holds", false},
        {"C7a", "no difference", false},
        {"C7b"},
        {"C8"},
        {"C9"},
        {"C10", "holds"},
        {"C11"},
        {.id = "C12",
         .is_timed = false,
         .primaries = {"brownian, objects 10,000, displacement 0.1",
                       "brownian, objects 10,000, displacement 0.1, sweep all_axes"}},
        {"SMB", "holds", false},
    };
    return all;
}

/// Everything that a claim says is less takes `ratio` of what it is compared with, and nothing else does; what is timed
/// is off by up to `noise`.
/// @param disturb what is not in the processor time
inline void write_world(
    const std::filesystem::path& folder, double ratio, double noise,
    aabblab::experiment_size size = aabblab::experiment_size::quick,
    const std::function<void(aabblab::row&)>& disturb = [](aabblab::row&) {}) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const std::vector<experiment_row> rows = experiment_rows();
    for (const aabblab::experiment& e : all_experiments(size)) {
        const auto row = std::ranges::find(rows, e.name, &experiment_row::experiment);
        const experiment_row of = row == rows.end() ? experiment_row{e.name} : *row;
        const auto tell = [&](const played& p, aabblab::row& r) {
            const double time = of.time(p, ratio) * std::exp(noise * normal(random));
            const bool sorting = e.name == "c3";
            const bool meshes = r.triangles && e.name != "c11" && e.name != "c9_geometry";
            r.update_ms = meshes ? 50 : time;
            r.search_ms = sorting || meshes ? 50 : time;
            r.detect_ms = r.triangles ? time : 0;
            of.count(p, ratio, r);
        };
        write_experiment(folder, e, tell, disturb);
    }
    write_tests(folder, ratio, 1);
}

}  // namespace worlds
