/// times.csv: the processor times of an atlas without the wall times, counts and digests of its rows, a tenth of their
/// size, to be kept beside what follows from them.
module aabblab.atlas;

import aabblab.files;

namespace aabblab {

namespace {

/// A row of times.csv. The time per frame is the later one over the frames after frame 0, that of all frames the sum of
/// both.
struct timed_repeat {
    std::string experiment, kind, parameters{};  ///< as in results.csv
    std::optional<std::uint64_t> seed{};
    std::uint64_t frames = 0;
    std::string candidate{};
    std::uint64_t repeat = 0;
    double first_ms = 0;  ///< of construction and frame 0
    double later_ms = 0;
};

constexpr auto columns_of_times = [](auto& r, auto field) {
    field("experiment", r.experiment);
    field("scene", r.kind);
    field("scene_parameters", r.parameters);
    field("seed", r.seed);
    field("frames", r.frames);
    field("candidate", r.candidate);
    field("repeat", r.repeat);
    field("first_cpu_ms", r.first_ms);
    field("later_cpu_ms", r.later_ms);
};

}  // namespace

void write_times(const std::filesystem::path& file, std::span<const std::filesystem::path> folders) {
    std::vector<timed_repeat> times;
    for (const std::filesystem::path& folder : folders)
        for (const row& r : verified_rows(folder))
            if (is_timed(r))
                times.push_back({r.experiment, r.scene.kind, parameters_json(r.scene), r.scene.seed, r.frames,
                                 label_of(r.name), r.repeat, *r.build_cpu_ms + *r.first_cpu_ms,
                                 *r.update_cpu_ms + *r.search_cpu_ms + *r.detect_cpu_ms});
    write_file(file, csv_of(std::span<const timed_repeat>(times), columns_of_times));
}

}  // namespace aabblab
