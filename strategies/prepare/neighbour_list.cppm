export module aabb.prepare.neighbour_list;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A Verlet list (Verlet, "Computer 'experiments' on classical fluids", 1967): boxes are grown by a margin, the skin,
/// and the pairs found among them are kept. While no box has moved by more than the margin relative to the others, the
/// list contains every overlapping pair, so a frame takes one test per listed pair and no search. Pairs that overlap by
/// more than two margins cannot separate and are not tested either. Motion common to all boxes does not count. An
/// inserted object triggers a search.
///
/// Without a configured margin, each list gets the cheapest one (`list_plan`), estimated from the displacement under
/// the last list (`displacement_law`), or the largest of those that cost about as little. If no list is worth its cost,
/// or boxes moved much farther than estimated, frames are searched directly and a sample of boxes is watched in some of
/// them (`list_backoff`). The first list, too, waits until such a sample shows that the remaining frames repay it
/// (`global_stage::expect`); if many remain, its margin is at least a tenth of the typical extent. If boxes move much
/// less than estimated, the list is reduced to a smaller margin once that is worth its cost. Searches are assumed to
/// cost what `columns` costs; with a slower search, lists are given up too early.
///
/// With `every` the search runs after a fixed number of frames, whatever has moved by then: pairs at a distance of more
/// than two margins at the last search are false negatives until the next one. There are never false positives.
/// When to use: objects that move little per frame, or might; `every` only to measure the cost of stale lists.
struct neighbour_list_prepare {
    static constexpr std::string_view name = "neighbour_list";
    static constexpr std::string_view summary =
        "a Verlet list: pairs of boxes grown by a margin, the skin, kept until boxes have moved farther";

    struct config {
        std::optional<double> margin;
        std::uint32_t every = 0;

        /// A list from an earlier frame may lack a pair of the current one.
        [[nodiscard]] constexpr bool is_exact() const noexcept { return every <= 1; }
    };
    static constexpr std::array leaves_out{absence::division};
    static constexpr std::tuple parameters{
        number_parameter{
            "margin", &config::margin, 0.0, std::numeric_limits<double>::max(),
            "the skin by which boxes are grown on every side, in typical extents; auto: the cheapest for each list",
            true},
        integer_parameter{
            "every", &config::every, std::uint32_t{0}, std::uint32_t{1'000'000},
            "number of frames between searches, inexact above 1; 0: search when boxes have moved too far"}};

    static constexpr std::array contrasts{std::string_view("margin=0.1")};
    /// Whether `auto` chooses this strategy for a scene, and why.
    [[nodiscard]] static scene_fit fit(const scene_traits& scene) {
        constexpr std::size_t fewest = scene_traits::fewest_frames_to_keep;
        if (scene.frames < fewest)
            return {.because = {{"fewer than {frames} frames: a Verlet list would not be worth its cost",
                                 {{{"frames", fewest}}}}}};
        return {.serves = true,
                .because = {{"{frames} frames or more: builds a Verlet list once it is worth its cost",
                             {{{"frames", fewest}}}}}};
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
