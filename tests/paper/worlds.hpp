#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

import aabb;
import aabblab.config;
import aabblab.results;
import aabblab.runner;
import aabblab.scenes;

// Imports modules, so it is included after every other header.

/// Results of the paper's experiments, made up: in place of playing a scene a world says what would come out.
namespace worlds {

/// A composition in a scene.
struct played {
    const aabblab::experiment& experiment;
    const aabblab::scene_choice& scene;
    const aabblab::contender_name& who;

    [[nodiscard]] std::string value_of(const std::string& setting) const {
        for (const aabb::setting& s : scene.settings)
            if (s.name == setting) return s.value;
        return "";
    }
    [[nodiscard]] bool has(const std::string& part) const {
        for (const std::string* text : {&who.sort, &who.partition, &who.sweep, &who.split_large, &who.tree})
            if (text->find(part) != std::string::npos) return true;
        return false;
    }
};

/// The rows of one experiment, as if it had been run.
/// @param tell sets times, counts and bytes
inline void write_experiment(const std::filesystem::path& folder, const aabblab::experiment& e,
                             const std::function<void(const played&, aabblab::row&)>& tell) {
    aabblab::results_folder results(folder / e.name, e, aabblab::existing_results::refuse);
    const std::size_t repeats = e.measured.time ? e.repeats : 1;
    for (const aabblab::scene_choice& scene : e.scenes)
        for (const aabblab::contender& who : aabblab::contenders_for(e, scene))
            for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
                aabblab::row r;
                r.experiment = e.name;
                r.scene = scene.kind;
                r.scene_parameters = parameters_text(scene);
                r.frames = 2;
                r.name = who.name;
                r.repeat = repeat;
                r.process = repeat * e.processes / repeats;
                r.status = "exact";
                r.build_ms = r.first_ms = r.update_ms = r.search_ms = r.detect_ms = 1;
                const played p{e, scene, who.name};
                r.objects = p.value_of("objects").empty() ? 2 : std::stoul(p.value_of("objects"));
                if (has_meshes(scene)) r.triangles = 1000;
                for (auto& count : r.counts) count = 1000 * r.objects;
                for (auto& bytes : r.bytes) bytes = 30'000;
                tell(p, r);
                results.add(r);
            }
}

inline std::vector<aabblab::experiment> all_experiments() {
    std::vector<aabblab::experiment> all;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(AABBLAB_CONFIGS) / "paper"))
        all.push_back(aabblab::read_experiment(file.path(), aabblab::experiment_size::quick));
    return all;
}

/// Times of the elementary tests: of triangle and box, and of two boxes.
inline void write_tests(const std::filesystem::path& folder, double triangle_box, double box) {
    std::filesystem::create_directories(folder / "c6");
    for (const char* process : {"process-0.json", "process-1.json", "process-2.json"}) {
        std::ofstream out(folder / "c6" / process);
        out << "{\"benchmarks\": [";
        for (const char* frame : {"", "/frame:a"})
            for (const auto& [name, ns] :
                 {std::pair{"triangle_box", triangle_box}, {"triangle_aabb", triangle_box}, {"box", box}})
                out << "{\"run_name\": \"test/" << name << frame
                    << "\", \"run_type\": \"iteration\", \"time_unit\": \"ns\", "
                    << "\"real_time\": " << ns << "},";
        out << "{\"run_type\": \"aggregate\"}]}";
    }
}

/// Everything that a claim says is less takes `ratio` of what it is compared with; what is timed is off by up to
/// `noise`.
inline void write_world(const std::filesystem::path& folder, double ratio, double noise) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (const aabblab::experiment& e : all_experiments())
        write_experiment(folder, e, [&](const played& p, aabblab::row& r) {
            double time = 1;
            const std::string& name = e.name;
            const bool cut = p.has("axial_cut");
            if (name == "c9")
                time = p.who.split_large == "off" ? 1 : ratio;
            else if (name == "c10")
                time = p.has("limit=on") ? ratio : 1;
            else if (name == "c4")
                // Each doubling from 2 segments on.
                for (const int segments : {4, 8, 16, 32, 64, 256})
                    if (const std::size_t at = p.who.partition.rfind('='); at != std::string::npos)
                        if (const std::string wanted = p.who.partition.substr(at + 1); wanted != "auto")
                            time *= std::stoi(wanted) >= segments ? ratio : 1;
            if (name == "c5" || name == "c5_world") {
                // A grid suits one scene; elsewhere it is worse than the cut, and grows with the world.
                time = cut ? ratio : 1;
                if (name == "c5" && p.has("cell_size=2") && p.scene.kind == "brownian") time = 0.1;
                if (name == "c5" && cut) time *= p.scene.kind == "brownian" ? 0.1 : 1;
                if (name == "c5_world" && !cut && p.value_of("density") != "0.1") time = 1 / ratio;
                if (name == "c5_world" && !cut && p.value_of("density") != "0.1")
                    for (auto& bytes : r.bytes) bytes = static_cast<std::uint64_t>(30'000 / ratio / ratio);
            }
            if (name == "figure1" || name == "choices" || name == "c11")
                time = (p.has("shell") && cut ? ratio : 1) * (name == "c11" && p.has("compressed") ? ratio : 1);
            if (name == "c3") time = p.has("shell") ? ratio : 1;
            if (name == "figure2" || name == "figure2_million")
                time = p.has("compressed") || p.has("leafless") ? ratio : 1;
            if (name == "table1") time = p.has("build=median") ? ratio : 1;
            time *= std::exp(noise * normal(random));
            r.update_ms = r.search_ms = r.detect_ms = time;
            if (name == "figure1" && cut)
                for (auto& count : r.counts) *count = static_cast<std::uint64_t>(static_cast<double>(*count) * ratio);
            if (name == "figure2" || name == "figure2_million")
                for (auto& bytes : r.bytes)
                    *bytes = p.has("compressed") ? static_cast<std::uint64_t>(30'000 * ratio) : 30'000;
            if (name == "c4")
                // As many segments as were wanted: the limit is far.
                for (auto& count : r.counts)
                    if (const std::size_t at = p.who.partition.rfind('='); at != std::string::npos)
                        count = p.who.partition.ends_with("auto") ? 8 : std::stoul(p.who.partition.substr(at + 1));
            if (name == "c2")
                // The work of an element grows with N where the claim is wrong.
                for (auto& count : r.counts)
                    count = static_cast<std::uint64_t>(1000 * static_cast<double>(r.objects) *
                                                       (ratio > 1 ? std::log10(static_cast<double>(r.objects)) : 1));
        });
    write_tests(folder, ratio, 1);
}

}  // namespace worlds
