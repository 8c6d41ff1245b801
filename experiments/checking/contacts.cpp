module aabblab.checking;

import :comparison;
import :triangle_classes;
import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Numbers the triangles of all objects in one row, so that a contact becomes a pair of two numbers.
class numbered_triangles {
public:
    /// @throws aabb::input_error if there are too many.
    explicit numbered_triangles(const aabb::mesh_scene& scene) {
        std::uint64_t count = 0;
        for (const std::uint32_t m : scene.mesh_of) {
            begins_.push_back(static_cast<std::uint32_t>(count));
            count += scene.meshes[m].triangle_count();
            if (count >= beyond_all)
                throw aabb::input_error(
                    fmt::format("check takes objects of fewer than {} triangles in all", grouped(beyond_all)));
        }
        begins_.push_back(static_cast<std::uint32_t>(count));
    }

    [[nodiscard]] std::size_t size() const { return begins_.back(); }

    [[nodiscard]] aabb::index_pair pair_of(const aabb::contact& c) const {
        return aabb::ordered_pair(begins_[c.a] + c.triangle_a, begins_[c.b] + c.triangle_b);
    }
    /// A row of a list, whose ids may be any; a contact of an object with itself becomes a pair of one number.
    [[nodiscard]] aabb::index_pair pair_of_row(const aabb::contact& c) const {
        const aabb::index_pair pair{number_of(c.a, c.triangle_a), number_of(c.b, c.triangle_b)};
        return c.a == c.b && pair.b != beyond_all ? aabb::index_pair{pair.a, pair.a} : pair;
    }
    /// The object and its triangle that have a number.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> at(std::uint32_t number) const {
        const auto after = std::ranges::upper_bound(begins_, number);
        return {static_cast<std::uint32_t>(after - begins_.begin() - 1), number - *(after - 1)};
    }

private:
    [[nodiscard]] std::uint32_t number_of(std::uint32_t object, std::uint32_t triangle) const {
        if (object >= begins_.size() - 1 || triangle >= begins_[object + 1] - begins_[object]) return beyond_all;
        return begins_[object] + triangle;
    }

    std::vector<std::uint32_t> begins_;  // of each object, and their end
};

/// From where ids in a list count: those of scenes count from 0.
struct id_origin {
    std::uint32_t object = 0, triangle = 0;

    /// Whether no id is less.
    [[nodiscard]] bool is_possible(const contact_list& list) const {
        return std::ranges::all_of(list.rows, [this](const listed_contact& row) {
            const aabb::contact& c = row.contact;
            return std::min(c.a, c.b) >= object && std::min(c.triangle_a, c.triangle_b) >= triangle;
        });
    }
    [[nodiscard]] std::string sentence() const {
        return fmt::format("{} count from 1: with 1 taken from each of their ids, the list is right.",
                           object == 0     ? "Triangles"
                           : triangle == 0 ? "Objects"
                                           : "Objects and triangles");
    }
};

pair_list numbered(const contact_list& list, const numbered_triangles& numbers, const id_origin& origin = {}) {
    pair_list pairs{.rows = {}, .has_frames = list.has_frames};
    pairs.rows.reserve(list.rows.size());
    for (const auto& [frame, c] : list.rows)
        pairs.rows.push_back({frame, numbers.pair_of_row({.a = c.a - origin.object,
                                                          .b = c.b - origin.object,
                                                          .triangle_a = c.triangle_a - origin.triangle,
                                                          .triangle_b = c.triangle_b - origin.triangle})});
    return pairs;
}

/// Tests whether a list is right if its ids count from 1.
class origin_tests {
public:
    origin_tests(const contact_list& list, const numbered_triangles& numbers, const list_extent& extent) {
        for (const id_origin origin : {id_origin{1, 0}, id_origin{0, 1}, id_origin{1, 1}})
            if (origin.is_possible(list))
                tests_.push_back(std::make_unique<test>(origin, numbered(list, numbers, origin), extent));
    }

    /// Tests a frame; all frames must be tested in order.
    void compare(std::span<const aabb::index_pair> truth) {
        for (const auto& tested : tests_) tested->comparison.compare(truth, [](const frame_errors&) {});
        std::erase_if(tests_, [](const auto& tested) { return !tested->comparison.is_right(); });
    }
    /// A sentence about where the ids count from that make the list right; empty if there are none.
    [[nodiscard]] std::string sentence() const { return tests_.empty() ? "" : tests_.front()->origin.sentence(); }

private:
    struct test {
        test(const id_origin& of, pair_list numbered, const list_extent& extent)
            : origin(of), list(std::move(numbered)), comparison(list, extent) {}

        id_origin origin;
        pair_list list;
        list_comparison comparison;
    };
    std::vector<std::unique_ptr<test>> tests_;  // those that hold so far
};

}  // namespace

check_result check_contacts(scene_frames& scene, const contact_list& list, const std::optional<nearness>& within,
                            bool touching) {
    if (!list.has_frames && scene.frames() > 1)
        throw aabb::input_error(
            fmt::format("the list has no frames, but the motion has {}: expected the columns "
                        "frame,object_a,object_b,triangle_a,triangle_b",
                        grouped(scene.frames())));
    search_method method = method_of({.stages = {aabb::stage::global_search, aabb::stage::local_detection},
                                      .named = {},
                                      .engine = {},
                                      .within = within},
                                     traits_of(scene));
    const wall_stopwatch building;
    stage_runner searcher(std::move(method.run_stages), scene);
    double search_ms = building.ms();
    const wall_stopwatch preparing;
    const aabb::mesh_scene& meshes = *scene.meshes();
    const numbered_triangles numbers(meshes);
    const pair_list numbered_list = numbered(list, numbers);
    const list_extent extent{scene.frames(), numbers.size(), numbers.size(), /*is_symmetric=*/true};
    list_comparison comparison(numbered_list, extent);
    origin_tests origins(list, numbers, extent);
    double check_ms = preparing.ms();
    triangle_classes classes(within, touching);
    std::vector<aabb::index_pair> truth;
    progress shown("frames checked", scene.frames());
    const auto placed = [&](std::uint32_t object) {
        return posed_surface{meshes.meshes[meshes.mesh_of[object]], scene.poses()[object],
                             fmt::format("object {}, triangle", object)};
    };
    const auto is_wanted = [&](const aabb::contact& c) {
        if (touching) return true;
        const posed_surface a = placed(c.a), b = placed(c.b);
        return hit_filter(touching).keeps(
            hit_geometry(a.mesh, a.pose, b.mesh, b.pose).kind({c.triangle_a, c.triangle_b}));
    };
    run_frames(scene, searcher, [&](const searched_frame& frame) {
        search_ms += frame.ms();
        const wall_stopwatch selecting;
        truth.clear();
        for (const aabb::contact& c : frame.contacts)
            if (is_wanted(c)) truth.push_back(numbers.pair_of(c));
        search_ms += touching ? 0 : selecting.ms();
        const wall_stopwatch checking;
        sort_rows(truth);
        comparison.compare(truth, [&](const frame_errors& errors) {
            errors.each([&](aabb::index_pair pair, bool is_listed) {
                const auto [a, triangle_a] = numbers.at(pair.a);
                const auto [b, triangle_b] = numbers.at(pair.b);
                const wrong_pair wrong{.frame = errors.frame,
                                       .pair = {triangle_a, triangle_b},
                                       .is_listed = is_listed,
                                       .objects = aabb::index_pair{a, b}};
                if (scene.filter() && !scene.filter()->keeps(a, b))
                    classes.add_left_out(wrong);
                else
                    classes.add(wrong, placed(a), placed(b));
                return true;
            });
        });
        origins.compare(truth);
        check_ms += checking.ms();
        shown.update(frame.number + 1);
    });
    check_result result = comparison.result({});
    if (const std::string sentence = origins.sentence(); !result.is_right() && !sentence.empty())
        result.patterns = {sentence};
    classes.add_to(result);
    result.search_ms = search_ms;
    result.check_ms = check_ms - classes.ms();
    return result;
}

}  // namespace aabblab
