#include "../random_poses.hpp"

using namespace aabb;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::MessageMatches;

namespace {

pose any_pose(double range) {
    return any_turned(any_vector(range));
}

vec3f any_point(const box& b) {
    vec3f p;
    for (int k = 0; k < 3; ++k)
        p[k] = *rc::gen::element(b.min[k], b.max[k], static_cast<float>(uniform(b.min[k], b.max[k])));
    return p;
}

box any_box() {
    const auto size = static_cast<float>(std::pow(10.0, uniform(-3, 3)));
    box b = empty_box();
    for (int i = 0; i < 2; ++i)
        b = merged(b,
                   bounds_of(vec3f{static_cast<float>(uniform(-1, 1)) * size, static_cast<float>(uniform(-1, 1)) * size,
                                   static_cast<float>(uniform(-1, 1)) * size}));
    return b;
}

/// Brings a distant point to within 1 of the origin of A's frame, so that the digits that double loses are digits that
/// float has.
pose brings_near(const vec3f& far, const pose& pose_a) {
    pose b = any_pose(1);
    for (int i = 0; i < 3; ++i) {
        b.translation[i] += pose_a.translation[i];
        for (int j = 0; j < 3; ++j) b.translation[i] -= b.rotation[3 * i + j] * far[j];
    }
    return b;
}

box far_box() {
    box b = any_box();
    for (int k = 0; k < 3; ++k) {
        const auto by = static_cast<float>(uniform(-1, 1) * std::pow(10.0, uniform(0, 10)));
        b.min[k] += by;
        b.max[k] += by;
    }
    return b;
}

}  // namespace

TEST_CASE("the image of a box contains the image of every point of it") {
    REQUIRE(rc::check([] {
        const double range = std::pow(10.0, uniform(-2, 8));
        const box box_b = far_box();
        const pose a = any_pose(range);
        const relative_pose to_a(a, *rc::gen::element(any_pose(range), brings_near(box_b.min, a)), box_b);
        for (int i = 0; i < 20; ++i) {
            const box b = merged(bounds_of(any_point(box_b)), bounds_of(any_point(box_b)));
            const box image = to_a(b);
            for (int j = 0; j < 20; ++j) RC_ASSERT(contains(image, bounds_of(to_a(any_point(b)))));
        }
    }));
}

TEST_CASE("a box's image needs its margin, without which rounding misses points") {
    // The same formula without the margin, for boxes of one point, whose image a tight box would have to match exactly.
    int missed = 0;
    REQUIRE(rc::check([&] {
        const box box_b = far_box();
        const pose a = any_pose(1e9);
        const pose b = brings_near(box_b.min, a);
        const relative_pose to_a(a, b, box_b);
        const vec3f x = any_point(box_b);
        for (int i = 0; i < 3; ++i) {
            double bound = 0;
            for (int k = 0; k < 3; ++k) bound += a.rotation[3 * k + i] * (b.translation[k] - a.translation[k]);
            for (int j = 0; j < 3; ++j) {
                double rotation = 0;
                for (int k = 0; k < 3; ++k) rotation += a.rotation[3 * k + i] * b.rotation[3 * k + j];
                bound += rotation * x[j];
            }
            missed += static_cast<float>(bound) != to_a(x)[i];
        }
        RC_ASSERT(contains(to_a(bounds_of(x)), bounds_of(to_a(x))));
    }));
    CHECK(missed > 0);
}

TEST_CASE("two meshes moved together keep their vertices") {
    const box bounds{{-1, -1, -1}, {1, 1, 1}};
    const vec3f x{0.1F, -0.7F, 1.0F};
    CHECK(relative_pose({}, {}, bounds)(x) == x);
    REQUIRE(rc::check([&] {
        const pose p = any_pose(100);
        const vec3f image = relative_pose(p, p, bounds)(x);
        RC_ASSERT(image == x);
        // Bit by bit, as long as sums of translations are exact.
        pose a = p;
        pose b = any_pose(1);
        for (pose* q : {&a, &b})
            for (int k = 0; k < 3; ++k) q->translation[k] = *rc::gen::inRange(-4096, 4096) / 1024.0;
        const vec3f before = relative_pose(a, b, bounds)(x);
        for (int k = 0; k < 3; ++k) {
            const double far = *rc::gen::inRange(-1'000'000'000, 1'000'000'000);
            a.translation[k] += far;
            b.translation[k] += far;
        }
        RC_ASSERT(relative_pose(a, b, bounds)(x) == before);
    }));
}

TEST_CASE("vertices transformed together have the same images as one by one, under any poses") {
    REQUIRE(rc::check([] {
        const auto any_motion = [] {
            pose p = any_pose(*rc::gen::element(1.0, 1e6));
            if (*rc::gen::arbitrary<bool>()) p.rotation = pose{}.rotation;
            if (*rc::gen::arbitrary<bool>()) p.translation = pose{}.translation;
            return p;
        };
        const pose a = any_motion();
        const pose b = *rc::gen::arbitrary<bool>() ? any_motion() : a;
        const box bounds = any_box();
        const relative_pose to_a(a, b, bounds);
        bool is_unmoved = true;
        for (int repeat = 0; repeat < 20; ++repeat) {
            const vec3f x = any_point(bounds);
            const vec3f image = to_a(x);
            const auto batch = to_a.images(std::array<double, 3>{x[0], x[1], x[2]});
            for (int k = 0; k < 3; ++k) {
                RC_ASSERT(static_cast<float>(batch[static_cast<std::size_t>(k)]) == image[k]);
                is_unmoved &= image[k] == x[k];
            }
        }
        RC_ASSERT(to_a.moves() || is_unmoved);
        const bool turns = a.rotation != pose{}.rotation || b.rotation != pose{}.rotation;
        RC_ASSERT(to_a.moves() == (a != b && (turns || !(a.translation == b.translation))));
    }));
}

TEST_CASE("meshes that intersect in A's frame have overlapping world boxes") {
    REQUIRE(rc::check([] {
        const box local_a = any_box();
        const box local_b = any_box();
        const pose a = any_pose(std::pow(10.0, uniform(-2, 18)));
        pose b = any_pose(1);
        // Puts a point of B onto a point of A, then tests whether the rounded image overlaps A's box.
        const vec3f on_a = any_point(local_a);
        const vec3f on_b = any_point(local_b);
        for (int i = 0; i < 3; ++i) {
            b.translation[i] = a.translation[i];
            for (int j = 0; j < 3; ++j)
                b.translation[i] += a.rotation[3 * i + j] * on_a[j] - b.rotation[3 * i + j] * on_b[j];
        }
        const relative_pose to_a(a, b, local_b);
        if (overlaps(bounds_of(to_a(on_b)), local_a))
            RC_ASSERT(overlaps(world_bounds(local_a, a), world_bounds(local_b, b)));
    }));
}

TEST_CASE("world boxes overlap for meshes at a rounding tie and of denormal size") {
    const double r2 = std::sqrt(2.0);
    const double r3 = std::sqrt(3.0);
    const double r6 = std::sqrt(6.0);
    const std::array<double, 9> turned = {1 / r3, 1 / r3, 1 / r3, 1 / r2, -1 / r2, 0, 1 / r6, 1 / r6, -2 / r6};
    const double tie = 0x1p40 + 0x1p17 + 0x1p16;
    const auto s = static_cast<float>(0.49 * 0x1p-12 * r3);
    CHECK(overlaps(world_bounds({{0, 0, 0}, {s, s, s}}, {turned, {tie - 2 * 0x1p-12, 0, 0}}),
                   world_bounds({{-s, -s, -s}, {0, 0, 0}}, {turned, {tie, 0, 0}})));
    // Half a denormal apart in the world, touching after rounding in A's frame.
    constexpr float least = std::numeric_limits<float>::denorm_min();
    CHECK(
        overlaps(world_bounds({{0, 0, 0}, {least, least, least}}, {}),
                 world_bounds({{0, 0, 0}, {least, least, least}}, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1.5 * least, 0, 0}})));
}

TEST_CASE("a mesh beyond the range of float in the other's frame is rejected") {
    const float huge = 3e38F;
    const pose turned{{std::sqrt(0.5), -std::sqrt(0.5), 0, std::sqrt(0.5), std::sqrt(0.5), 0, 0, 0, 1}, {0, 0, 0}};
    CHECK_THROWS_AS(relative_pose({}, turned, {{0, 0, 0}, {huge, huge, 0}}), input_error);
    CHECK_THROWS_AS(relative_pose({}, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1e300, 0, 0}}, {{0, 0, 0}, {1, 1, 1}}),
                    input_error);
    CHECK_NOTHROW(relative_pose({}, {}, {{-huge, -huge, -huge}, {huge, huge, huge}}));
}

TEST_CASE("what is not a pose of full rank is rejected") {
    const auto rejected = [](pose p, const char* why) {
        CHECK_THROWS_MATCHES(require_full_rank(p), input_error, MessageMatches(ContainsSubstring(why)));
    };
    CHECK_NOTHROW(require_full_rank({}));
    CHECK_NOTHROW(require_full_rank({{2, 1, 0, 0, 1, 0, 0, 0, -1}, {1e9, 0, 0}}));
    CHECK_NOTHROW(require_full_rank({{1e-200, 0, 0, 0, 1e-200, 0, 0, 0, 1e-200}, {0, 0, 0}}));
    rejected({{1, 2, 3, 4, 5, 6, 5, 7, 9}, {0, 0, 0}}, "singular");
    rejected({{0.1, 0.2, 0.3, 0.2, 0.4, 0.6, 0, 0, 1}, {0, 0, 0}}, "singular");
    rejected({{0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0}}, "singular");
    rejected({{1, 0, 0, 0, NAN, 0, 0, 0, 1}, {0, 0, 0}}, "a matrix with an entry that is not finite");
    rejected({{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, INFINITY, 0}}, "a translation that is not finite");
}

TEST_CASE("rotations are rigid, other matrices are not") {
    CHECK(is_rigid({{1, 4e-7, 0, -4e-7, 1, 0, 0, 0, 1}, {1e9, 0, 0}}));
    CHECK_FALSE(is_rigid({{1.001, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}}));
    CHECK_FALSE(is_rigid({{1, 0, 0, 0, 1, 0, 0, 0, -1}, {0, 0, 0}}));
}
