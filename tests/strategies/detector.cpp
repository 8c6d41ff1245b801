// Detectors composed at compile time and at run time, in which unused parts take no space.

#include "../meshes.hpp"
#include "searches.hpp"

import aabb.auto_detector;
import aabb.selection;
import aabb.strategies;

using namespace aabb;

namespace {

using bare_search = global_search<insertion_sort, none_partition, one_axis_sweep>;
using counted_search = global_search<insertion_sort, none_partition, one_axis_sweep, work_counters>;
using cut_search = global_search<insertion_sort, axial_cut_partition, one_axis_sweep>;
using column_search = global_search<bucket_sort, columns_partition, simd_sweep>;
using bare_detection = mesh_detection<median_build, canonical_tree, exact_triangle>;
using counted_detection = mesh_detection<median_build, canonical_tree, exact_triangle, work_counters>;

/// The members that a search without partition and counters needs.
struct needed_by_search {
    one_axis_sweep sweep;
    std::span<const box> boxes;
    membership objects;
    projection_lists<no_counters> lists;
    frame_state frame;
};
/// The members that a pipeline of both stages needs if no mesh is divided.
struct needed_by_pipeline {
    const mesh_scene* scene;
    bare_search* global;
    bare_detection* local;
    std::optional<posed_boxes> world;
    std::vector<pose> poses;
    std::vector<index_pair> candidates;
    std::vector<index_pair> triangle_pairs;
    std::vector<contact> contacts;
    frame_state frame;
    bool searched;
};

// What is left out takes no byte, and what is added takes its full size.
static_assert(sizeof(bare_search) == sizeof(needed_by_search));
static_assert(sizeof(detector<bare_search>) == sizeof(bare_search) + sizeof(std::vector<index_pair>));
static_assert(sizeof(counted_search) >= sizeof(bare_search) + sizeof(work_counters));
static_assert(sizeof(cut_search) >= sizeof(bare_search) + sizeof(subset_lists));
static_assert(sizeof(counted_detection) >= sizeof(bare_detection) + sizeof(work_counters));
static_assert(sizeof(basic_pipeline<bare_search, bare_detection>) == sizeof(needed_by_pipeline));
static_assert(sizeof(pipeline) >= sizeof(needed_by_pipeline) + sizeof(std::unique_ptr<scene_parts>));

// No detector and no stage can be moved, so none can be used after a move.
static_assert(!std::is_move_constructible_v<detector<cut_search>> && !std::is_move_assignable_v<detector<cut_search>>);
static_assert(!std::is_move_constructible_v<detector<bare_search, bare_detection>> &&
              !std::is_move_assignable_v<detector<bare_search, bare_detection>>);
static_assert(!std::is_move_constructible_v<auto_detector> && !std::is_move_assignable_v<auto_detector>);
static_assert(!std::is_move_constructible_v<global_stage> && !std::is_move_constructible_v<local_stage>);

/// A strip of triangles, much longer than the tetrahedra.
mesh strip() {
    mesh m;
    for (std::uint32_t i = 0; i <= 40; ++i) {
        m.vertices.push_back({static_cast<float>(i), 0, 0.4F});
        m.vertices.push_back({static_cast<float>(i), 1, 0.4F});
    }
    for (std::uint32_t i = 0; i < 40; ++i) {
        m.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
        m.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
    }
    return m;
}

const std::vector<mesh> meshes{tetrahedron(1), strip()};
const std::vector<std::uint32_t> mesh_of{0, 1, 0, 0, 1};

std::vector<pose> poses_of(int frame) {
    std::vector<pose> poses(mesh_of.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i].translation = {static_cast<double>(i) * 0.3 * frame, 0.25 * static_cast<double>(i), 0.1 * frame};
    return poses;
}

/// The contacts of all pairs of whole objects, by stages composed by name; without those of `removed`.
std::vector<contact> expected_contacts(const std::vector<pose>& poses, std::optional<std::uint32_t> removed = {}) {
    const given_scene scene(meshes, mesh_of);
    const auto local = local_of(composed({{strategy_kind::tree, "canonical"}}));
    pipeline brute_force(scene, *local);
    brute_force.update(poses);
    brute_force.search();
    brute_force.detect();
    std::vector<contact> contacts = sorted(brute_force.contacts());
    std::erase_if(contacts, [&](const contact& c) { return c.a == removed || c.b == removed; });
    return contacts;
}

/// Boxes of which some overlap, different ones in each frame.
std::vector<box> boxes_of(int frame) {
    std::vector<box> boxes;
    for (int i = 0; i < 40; ++i) {
        const vec3f at{static_cast<float>((i * 7 + frame * (i % 3)) % 23), static_cast<float>(i * 5 % 11),
                       static_cast<float>(i * 3 % 7)};
        boxes.push_back({at, at + vec3f{3, 3, 3}});
    }
    return boxes;
}

template <class Detector>
void check_pairs(Detector&& detector) {
    CHECK_THROWS_AS(detector.pairs(boxes_of(0)), input_error);  // nothing was inserted
    insert_all(detector, 40);
    std::vector<bool> without_7(40, true);
    without_7[7] = false;
    CHECK_REFUSED(detector.insert(3), "object 3 is inserted twice");
    for (int frame = 0; frame < 6; ++frame) {
        const std::vector<box> boxes = boxes_of(frame);
        const std::vector<index_pair> expected = overlapping(boxes);
        REQUIRE_FALSE(expected.empty());
        CHECK(sorted(detector.pairs(boxes)) == expected);
        detector.remove(7);
        CHECK(sorted(detector.pairs(boxes)) == overlapping(boxes, without_7));
        detector.insert(7);
        std::vector<box> inverted = boxes;
        std::swap(inverted[5].min, inverted[5].max);
        CHECK_THROWS_AS(detector.pairs(inverted), input_error);
        CHECK(sorted(detector.pairs(boxes)) == expected);
    }
}

/// The same boxes in double: as floats do not see them, and far away or of any size.
template <class Detector>
void check_pairs_in_double(Detector&& detector) {
    insert_all(detector, 40);
    for (int frame = 0; frame < 6; ++frame)
        for (const auto& [factor, offset] :
             {std::pair{1.0, 0.0}, {0.1, 0.0}, {1.0, 3948995.7}, {1e-9, 0.3}, {1e300, 0.0}, {1e-310, 0.0}}) {
            std::vector<boxd> boxes;
            for (const box& b : boxes_of(frame)) {
                boxd& in_double = boxes.emplace_back();
                for (int k = 0; k < 3; ++k) {
                    in_double.min[k] = b.min[k] * factor + offset;
                    in_double.max[k] = b.max[k] * factor + offset;
                    // Every third box ends one unit in the last place lower, so that it touches nothing.
                    if (boxes.size() % 3 == 0) in_double.max[k] = std::nextafter(in_double.max[k], -1);
                }
            }
            std::vector<index_pair> expected;
            for (std::uint32_t a = 0; a < boxes.size(); ++a)
                for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
                    if (boxes[a].overlaps(boxes[b])) expected.push_back({a, b});
            CAPTURE(factor, offset);
            CHECK(expected.size() < overlapping(boxes_of(frame)).size());
            CHECK(sorted(detector.pairs(boxes)) == expected);
            std::swap(boxes[5].min, boxes[5].max);
            CHECK_REFUSED(static_cast<void>(detector.pairs(boxes)),
                          "box 5 is inverted: its minimum is above its maximum");
        }
}

template <class Detector>
void check_contacts(Detector&& detector) {
    for (int frame = 0; frame < 6; ++frame) {
        const std::vector<pose> poses = poses_of(frame);
        const std::vector<contact> expected = expected_contacts(poses);
        REQUIRE_FALSE(expected.empty());
        CHECK(sorted(detector.contacts(poses)) == expected);
        CHECK(detector.count_contacts(poses) == expected.size());
        CHECK(std::ranges::find(expected, detector.first_contact(poses).value()) != expected.end());
        // Object 1 is divided if any object is.
        detector.remove(1);
        CHECK_THROWS_AS(detector.remove(1), input_error);
        CHECK(sorted(detector.contacts(poses)) == expected_contacts(poses, 1));
        detector.insert(1);
        CHECK_THROWS_AS(detector.insert(1), input_error);
        CHECK_REFUSED(detector.remove(5), "there is no object 5: the scene has 5");
        CHECK_THROWS_AS(detector.contacts(std::span(poses).first(4)), input_error);
        CHECK(sorted(detector.contacts(poses)) == expected);
    }
}

std::vector<std::string> names(const std::vector<part_bytes>& parts) {
    std::vector<std::string> part_names;
    for (const part_bytes& part : parts) part_names.push_back(part.part);
    return part_names;
}

}  // namespace

TEST_CASE("a detector of boxes in double finds the pairs that overlap in double") {
    check_pairs_in_double(detector_in_double<detector<bare_search>>());
    check_pairs_in_double(detector_in_double<detector<column_search>>());
    check_pairs_in_double(detector_in_double<auto_detector>());
    check_pairs_in_double(detector_in_double<auto_detector>(std::vector<std::string>{"prepare=neighbour_list"}));
}

TEST_CASE("a detector of boxes finds the overlapping pairs of present objects, also after a rejected frame") {
    check_pairs(detector<bare_search>());
    detector<counted_search> counted;
    check_pairs(counted);
    CHECK(counted.global().counters()[work::box_tests] > 0);
    axial_cut_partition::config one_axis;
    one_axis.axes = 1;
    check_pairs(detector<cut_search>(cut_search({}, axial_cut_partition(one_axis), {})));
    check_pairs(detector<column_search>());
    check_pairs(detector<global_search<insertion_sort, none_partition, incremental_sweep>>());
    check_pairs(detector<prepared_search<split_large_prepare, bare_search>>());
    check_pairs(auto_detector());
    check_pairs(auto_detector({"prepare=none", "sort=shell:gaps=ciura", "partition=none"}));
}

TEST_CASE("a detector of meshes finds the contacts of present objects, also after a rejected frame") {
    detector<bare_search, bare_detection> bare(meshes, mesh_of);
    check_contacts(bare);
    detector<counted_search, counted_detection> counted(meshes, mesh_of);
    check_contacts(counted);
    CHECK(counted.local().counters()[work::triangle_tests] > 0);
    using default_detection = mesh_detection<median_build, implicit_tree, exact_triangle>;
    check_contacts(detector<column_search, default_detection>(meshes, mesh_of));
    detector<prepared_search<split_mesh_prepare, bare_search>, bare_detection> divided(
        meshes, mesh_of, prepared_search<split_mesh_prepare, bare_search>(split_mesh_prepare({.size = 1})));
    check_contacts(divided);
    // Pairs of parts, of which one object pair may have several.
    CHECK(divided.candidates().size() != bare.candidates().size());
    check_contacts(auto_detector(meshes, mesh_of));
    check_contacts(auto_detector(meshes, mesh_of, {"prepare=split_mesh:size=1", "tree=compressed"}, 1));
}

TEST_CASE("a detector reports the bytes of its own parts only") {
    const std::vector<std::string> bare_parts{"projections", "sort", "sweep", "buffers"};
    detector<bare_search> bare;
    CHECK(names(bare.bytes()) == bare_parts);
    for (const part_bytes& part : bare.bytes()) CHECK(part.bytes == 0);
    check_pairs(bare);
    CHECK(names(bare.bytes()) == bare_parts);
    CHECK(bytes_of_part(bare.bytes(), "projections") > 0);
    CHECK(bytes_of_part(bare.bytes(), "buffers") > 0);
    detector<cut_search> cut;
    check_pairs(cut);
    CHECK(bytes_of_part(cut.bytes(), "partition") > 0);
    // Counters are members of the search itself, so the heap bytes of the parts are equal.
    detector<counted_search> counted;
    check_pairs(counted);
    CHECK(bytes_of_part(counted.bytes(), "sweep") == bytes_of_part(bare.bytes(), "sweep"));

    const detector<bare_search, bare_detection> both(meshes, mesh_of);
    CHECK(names(both.bytes()) ==
          std::vector<std::string>{"projections", "sort", "sweep", "nodes", "indices", "stack", "refit", "buffers"});
    CHECK(names(auto_detector({"prepare=none", "sort=insertion", "partition=none"}).bytes()) == bare_parts);
    const auto_detector prepared;
    CHECK(std::ranges::count(names(prepared.bytes()), "prepare") == 1);
    CHECK(std::ranges::count(names(prepared.bytes()), "nodes") == 0);
    CHECK(std::ranges::count(names(auto_detector(meshes, mesh_of).bytes()), "nodes") == 1);
}

TEST_CASE("an auto_detector reports what it selected, by which rule, and what it leaves out") {
    const auto_detector boxes({"sort=shell:gaps=ciura"}, 1);
    const auto rule_of = [](const auto_detector& detector, strategy_kind kind) {
        const auto& selected = detector.selected();
        const auto entry = std::ranges::find(selected, kind, &selected_strategy::kind);
        return entry == selected.end() ? "" : to_text(entry->choice) + ", " + entry->rule;
    };
    CHECK(rule_of(boxes, strategy_kind::sort) == "shell:gaps=ciura, as named");
    CHECK(rule_of(boxes, strategy_kind::prepare).starts_with("none, fewer than 4 frames"));
    CHECK(rule_of(boxes, strategy_kind::tree).empty());
    CHECK(leaves_out(boxes, absence::local_detection));
#if !__has_feature(address_sanitizer)  // with it, every search counts (`aabb.composed`)
    CHECK(leaves_out(boxes, absence::counters));
#endif
    const auto_detector many(meshes, mesh_of);
    CHECK(rule_of(many, strategy_kind::prepare).starts_with("neighbour_list, 4 frames or more"));
    CHECK(rule_of(many, strategy_kind::build).starts_with("sah, "));
    CHECK(rule_of(auto_detector(meshes, mesh_of, {}, 1), strategy_kind::build).starts_with("median, "));
#if !__has_feature(address_sanitizer)
    CHECK(leaves_out(many, absence::counters));
#endif
}

TEST_CASE("a detector rejects invalid arguments and calls in one sentence") {
    const std::string missing = "object 1 is mesh 2, but there are 2 meshes";
    using both = detector<bare_search, bare_detection>;
    CHECK_REFUSED(both(meshes, {0, 2}), missing);
    CHECK_REFUSED(auto_detector(meshes, {0, 2}), missing);
    CHECK_REFUSED(auto_detector({"sort"}), "'sort' is not of the form kind=strategy, as in sort=shell");
    CHECK_REFUSED(auto_detector({"srt=shell"}), "unknown kind of strategy 'srt'; did you mean 'sort'?");
    CHECK_REFUSED(auto_detector({"sort=shel"}), "unknown sort 'shel'; did you mean 'shell'?");
    CHECK_REFUSED(auto_detector({"sort=shell", "sort=std"}), "sort is named twice");
    CHECK_REFUSED(auto_detector({"tree=implicit"}), "tree is named, but objects are boxes");
    CHECK_THROWS_AS(auto_detector({"prepare=split_mesh"}), input_error);
    CHECK_THROWS_AS(auto_detector({"sort=shell", "sweep=incremental"}), input_error);
    auto_detector boxes;
    CHECK_REFUSED(boxes.contacts({}), "this detector is for boxes: construct one with meshes to find contacts");
    auto_detector moving(meshes, mesh_of);
    CHECK_REFUSED(moving.pairs({}), "this detector is for meshes: call contacts with their poses");
}
