export module aabb.prepare.neighbour_list;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// Boxes are searched grown by a margin, and the pairs found are kept as a list. While no box has moved by more than
/// the margin relative to the others, each pair that overlaps is in the list, so that a frame takes one test a listed
/// pair and no search (Verlet, "Computer 'experiments' on classical fluids", 1967), and, once it has served and is to
/// go on, none of a pair that overlaps by more than two margins, which cannot part. What all move alike is no motion.
/// An object that comes makes a search too.
///
/// Without a margin of its own, each list gets the one that costs least (`list_plan`), from how far boxes moved under
/// the last one (`displacement_law`), or the longest of those that cost about as little. Of the first one nothing is
/// known yet: it gets a tenth of the mean extent. Where no list is worth its cost, or boxes moved by far more than was
/// planned for, frames are searched as they are, and a few boxes looked at in some of them (`list_pause`). Where few
/// frames are expected (`global_stage::expect`), no list is made before some of the boxes have shown that it repays its
/// making in those that are left. Where boxes move by far less than was thought, the list becomes the one that a
/// smaller margin would have made, once that pays. What a search costs is reckoned as that of `columns`: before a
/// slower one, lists are given up sooner than they need to be.
///
/// With `every` the search comes round after so many frames, whatever has moved by then: pairs that were further apart
/// than two margins at the last search are missed until the next one. Nothing is ever invented. When to use: where
/// objects move by little a frame, or might; `every` only to see what stale lists cost.
struct neighbour_list_prepare {
    static constexpr std::string_view name = "neighbour_list";
    static constexpr std::string_view summary =
        "pairs of boxes grown by a margin, kept until boxes have moved by more than that";

    struct config {
        std::optional<double> margin;
        std::uint32_t every = 0;

        /// Lists of an earlier frame may lack a pair of this one.
        [[nodiscard]] constexpr bool is_exact() const noexcept { return every <= 1; }
    };
    static constexpr std::array leaves_out{absence::division};
    static constexpr std::tuple parameters{
        number_parameter{"margin", &config::margin, 0.0, std::numeric_limits<double>::max(),
                         "by which boxes are grown on every side, in typical extents; auto: as it pays, list by list",
                         true},
        integer_parameter{"every", &config::every, std::uint32_t{0}, std::uint32_t{1'000'000},
                          "frames from one search to the next, inexact above 1; 0: when boxes have moved too far"}};

    static constexpr std::array contrasts{std::string_view("margin=0.1")};
    [[nodiscard]] static scene_fit fit(const scene_outlook& scene) {
        constexpr std::size_t fewest = scene_outlook::fewest_frames_to_keep;
        if (scene.frames < fewest)
            return {.because = {{"fewer than {frames} frames: a list of neighbours would not repay its making",
                                 {{{"frames", fewest}}}}}};
        return {.serves = true,
                .because = {{"frames follow each other: a list of neighbours is kept while boxes move little, and only "
                             "then"}}};
    }

    neighbour_list_prepare() = default;
    explicit neighbour_list_prepare(const config& c) : config_(c) {}

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search,
                                                       instrumentation counted) const;

private:
    config config_;
};

static_assert(PreparePolicy<neighbour_list_prepare>);

}  // namespace aabb
