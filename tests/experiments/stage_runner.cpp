#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../validation/altered_stages.hpp"

import aabblab.configs;
import aabblab.trials;
import aabblab.scenes;

using aabblab::candidate;
using aabblab::scene_frames;
using aabblab::searched_frame;

namespace {

/// Objects in a row that move towards the first, which is fixed; each stops for good at its first contact.
class stopping_meshes final : public aabb::mesh_scene {
public:
    explicit stopping_meshes(std::size_t objects) {
        meshes = {tetrahedron(1)};
        mesh_of.assign(objects, 0);
        stopped_.insert(0);
        poses_.resize(objects);
        for (std::size_t object = 0; object < objects; ++object)
            poses_[object].translation[0] = 1.5 * static_cast<double>(object);
    }
    [[nodiscard]] std::size_t frames() const override { return 12; }
    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames()) return false;
        if (frame_++ > 0)
            for (std::uint32_t object = 0; object < poses_.size(); ++object)
                if (!stopped_.contains(object)) poses_[object].translation[0] -= 0.25;
        poses = poses_;
        return true;
    }
    void take_contacts(std::span<const aabb::contact> contacts) override {
        REQUIRE(std::ranges::is_sorted(contacts));
        for (const aabb::contact& c : contacts) {
            stopped_.insert(c.a);
            stopped_.insert(c.b);
        }
    }

private:
    std::size_t frame_ = 0;
    std::vector<aabb::pose> poses_;
    std::set<std::uint32_t> stopped_;
};

/// The same motion with unit cubes.
class stopping_boxes final : public aabb::box_scene {
public:
    [[nodiscard]] std::size_t objects() const override { return 4; }
    [[nodiscard]] std::size_t frames() const override { return 8; }
    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames()) return false;
        if (frame_++ > 0)
            for (std::uint32_t object = 1; object < x_.size(); ++object)
                if (!stopped_.contains(object)) x_[object] -= 0.25F;
        boxes.clear();
        for (const float x : x_) boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
        return true;
    }
    void take_pairs(std::span<const aabb::index_pair> pairs) override {
        for (const auto [a, b] : pairs) stopped_.insert({a, b});
    }

private:
    std::size_t frame_ = 0;
    std::vector<float> x_ = {0, 1.5F, 3, 4.5F};
    std::set<std::uint32_t> stopped_;
};

std::vector<candidate> exact_candidates(bool meshes) {
    std::vector<candidate> candidates;
    using enum aabb::strategy_kind;
    const aabb::composition coherent = composed({{sort, "insertion"}, {sweep, "incremental"}, {tree, "compressed"}});
    candidates.push_back(aabblab::candidate_of(aabb::composition(), meshes));
    candidates.push_back(aabblab::candidate_of(coherent, meshes));
    for (const aabb::engine_info& engine : aabb::engines())
        if (auto tested = aabblab::candidate_of(engine, meshes); tested && tested->exact)
            candidates.push_back(*std::move(tested));
    return candidates;
}

}  // namespace

TEST_CASE("Every candidate answers count and first-contact queries, and a wrong result is reported") {
    const aabblab::scene_choice choice{"mesh_pair", {{"frames", "3"}}, {"icosphere:triangles=320"}, 1};
    const std::vector<candidate> candidates = exact_candidates(true);
    for (const aabblab::query_kind query : {aabblab::query_kind::count, aabblab::query_kind::first})
        for (const bool cold : {false, true}) {
            std::string digest;
            for (const candidate& tested : candidates) {
                const aabblab::observation times = aabblab::observe(choice, tested, {.query = {query, cold}});
                INFO(aabblab::text_of(tested.name) << ": " << times.wrong);
                CHECK(times.wrong.empty());
                CHECK(times.rest.detect.wall_ms > 0);
                if (digest.empty()) digest = times.digest;
                CHECK(times.digest == digest);
            }
            candidate wrong = candidates[0];
            // It counts one contact too many, or reports the first one with another triangle.
            wrong.make_local = [](aabb::instrumentation) {
                return std::make_unique<aabb::altered_meshes>(aabb::alterations{.first_pair =
                                                                                    [](auto& pair) {
                                                                                        if (pair) pair->b += 1000;
                                                                                    },
                                                                                .more_counted = 1});
            };
            CHECK_FALSE(aabblab::observe(choice, wrong, {.query = {query, cold}}).wrong.empty());
        }
}

TEST_CASE("A scene that reacts to contacts gives every candidate the same frames, validated and timed") {
    for (const bool meshes : {true, false}) {
        const auto make_scene = [&] {
            return meshes ? scene_frames(std::make_unique<stopping_meshes>(4))
                          : scene_frames(std::make_unique<stopping_boxes>());
        };
        const std::vector<candidate> candidates = exact_candidates(meshes);
        REQUIRE(candidates.size() > 3);
        scene_frames scene = make_scene();
        const aabblab::scene_validation result = aabblab::validate_scene({"stopping", {}, {}, 1}, scene, candidates);
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            INFO(result.candidates[i].failure);
            CHECK(result.candidates[i].failure.empty());
            CHECK(result.candidates[i].digest == result.digest);
            scene_frames again = make_scene();
            CHECK(aabblab::observe(again, candidates[i]).digest == result.digest);
        }
        // Each stops where it first touches the one before: nothing tunnels, and only neighbours ever touch.
        scene_frames last = make_scene();
        aabblab::stage_runner tested(candidates[0], last, aabb::instrumentation::none);
        std::set<aabb::index_pair> met;
        aabblab::run_frames(last, tested, [&](const searched_frame& frame) {
            for (const aabb::index_pair& pair : frame.pairs) met.insert(pair);
        });
        CHECK(met == std::set<aabb::index_pair>{{0, 1}, {1, 2}, {2, 3}});
    }
}

TEST_CASE("A scene is run frame by frame, to its end or for its first frames") {
    const aabblab::scene_choice choice{
        "mesh_swarm", {{"objects", "12"}, {"frames", "3"}}, {"icosphere:triangles=80"}, 1};
    const candidate tested = exact_candidates(true)[0];
    for (const std::size_t limit : {std::size_t{2}, std::size_t{9}}) {
        scene_frames scene(choice);
        aabblab::stage_runner runner(tested, scene, aabb::instrumentation::none);
        std::uint32_t frames = 0;
        std::size_t contacts = 0;
        aabblab::run_frames(
            scene, runner,
            [&](const searched_frame& frame) {
                CHECK(frame.number == frames++);
                CHECK(frame.ms() == frame.took.update.wall_ms + frame.took.search.wall_ms + frame.took.detect.wall_ms);
                CHECK(frame.took.update.wall_ms > 0);
                CHECK(std::ranges::is_sorted(frame.pairs));
                CHECK(std::ranges::is_sorted(frame.contacts));
                contacts += frame.contacts.size();
            },
            limit);
        CHECK(frames == std::min<std::size_t>(limit, 4));
        CHECK(contacts > 0);
    }
}

TEST_CASE("A runner without global search tests all pairs of objects, and can count contacts or find the first") {
    scene_frames scene(std::make_unique<stopping_meshes>(3));
    aabblab::stages local_only{nullptr, aabb::compose_local_detection({}, aabb::instrumentation::none)};
    aabblab::stage_runner tested(std::move(local_only), scene);
    REQUIRE(scene.next());
    tested.update();
    tested.search();
    CHECK(tested.sorted_pairs() == std::vector<aabb::index_pair>{{0, 1}, {0, 2}, {1, 2}});
    CHECK_FALSE(tested.first_contact());
    CHECK(tested.count_contacts() == 0);
    CHECK(tested.global_bytes().empty());
    while (!tested.first_contact() && scene.next()) {
        tested.update();
        tested.search();
    }
    tested.detect();
    const std::vector<aabb::contact> contacts = tested.sorted_contacts();
    REQUIRE_FALSE(contacts.empty());
    CHECK(tested.count_contacts() == contacts.size());
    CHECK(std::ranges::find(contacts, tested.first_contact().value()) != contacts.end());
    std::vector<aabb::index_pair> neighbours;
    std::size_t most = 2;
    const auto take = [&](aabb::index_pair pair) {
        neighbours.push_back(pair);
        return neighbours.size() == most;
    };
    tested.each_self_pair(0, take);
    CHECK(neighbours.size() == 2);
    neighbours.clear();
    most = 100;
    tested.each_self_pair(0, take);
    CHECK(neighbours.size() == 6);
}

TEST_CASE("Invalid poses of a file are reported with file and frame") {
    class leaving final : public aabb::mesh_scene {
    public:
        leaving() {
            meshes = {tetrahedron(1)};
            mesh_of = {0};
        }
        [[nodiscard]] std::size_t frames() const override { return 3; }
        bool next(std::vector<aabb::pose>& poses) override {
            poses.assign(1, {});
            poses[0].translation[0] = frame_++ == 2 ? 1e39 : 0;
            return true;
        }

    private:
        int frame_ = 0;
    };
    const std::string sentence = "object 0 lies beyond the range of float";
    for (const auto& [file, place] : {std::pair<std::string, std::string>{"a b.txt", "a b.txt: frame 2: "}, {"", ""}}) {
        scene_frames timed(std::make_unique<leaving>(), file);
        CHECK_REFUSED(aabblab::observe(timed, exact_candidates(true)[0]), place + sentence);
        scene_frames validated(std::make_unique<leaving>(), file);
        CHECK_REFUSED(aabblab::validate_scene({"leaving", {}, {}, 1}, validated, {}), place + sentence);
    }
}
