#include "../compositions.hpp"
#include "../random_poses.hpp"
#include "distance_judge.hpp"
#include "engines.hpp"
#include "pairs.hpp"
#include "support.hpp"

import aabb.distance;
import aabb.distance.exact_distance;
import aabb.distance.near_batch;
import aabb.distance.rounded_triangles;
import aabb.simd;

// Distances compared with a judge in integers of any size.

namespace {

using aabb::pose;
using aabb::pose_pair;
using aabb::triangle3d;
using aabb::vec3d;
using triangle_pairs::generator;

distance_judge::triangle as_given(const triangle3d& t) {
    distance_judge::triangle given{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) given[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = t[i][k];
    return given;
}

distance_judge judged(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    const auto placement = [](const pose& p) {
        return distance_judge::placement{p.rotation, {p.translation[0], p.translation[1], p.translation[2]}};
    };
    return {placement(poses.a), as_given(s), placement(poses.b), as_given(t)};
}

double real(generator& g, double most = 1) {
    return std::uniform_real_distribution<double>(-most, most)(g);
}

pose rotation(generator& g) {
    return turned_by({real(g), real(g), real(g), real(g)}, {});
}

/// How the poses of two meshes relate; the second is moved by `step`.
struct pose_class {
    const char* name;
    pose_pair (*make)(generator& g, const vec3d& step);
};

const std::array<pose_class, 6> pose_classes{
    {{"none", [](generator&, const vec3d&) { return pose_pair{}; }},
     {"a translation", [](generator&, const vec3d& step) { return pose_pair{{}, pose{pose{}.rotation, step}}; }},
     {"far translations",
      [](generator& g, const vec3d& step) {
          const vec3d far{4e6 + real(g), 4e6 + real(g), -4e6 + real(g)};
          return pose_pair{pose{pose{}.rotation, far}, pose{pose{}.rotation, far + step}};
      }},
     {"one rotation",
      [](generator& g, const vec3d& step) {
          const pose r = rotation(g);
          return pose_pair{r, pose{r.rotation, step}};
      }},
     {"any matrices",
      [](generator& g, const vec3d& step) {
          pose_pair poses{rotation(g), rotation(g)};
          for (double& r : poses.a.rotation) r += real(g, 0.5);
          for (double& r : poses.b.rotation) r *= 1.5;
          poses.b.translation = step;
          return poses;
      }},
     {"large or small", [](generator& g, const vec3d& step) {
          pose_pair poses{rotation(g), rotation(g)};
          poses.b.translation = step;
          const int exponent = triangle_pairs::integer(g, -900, 900);
          for (pose* const p : {&poses.a, &poses.b}) {
              for (double& r : p->rotation) r = std::ldexp(r, exponent);
              for (double& t : p->translation.at) t = std::ldexp(t, exponent);
          }
          return poses;
      }}}};

/// A whole vector, often along an axis, so that many distances are whole numbers.
vec3d step(generator& g) {
    vec3d by{};
    for (double& x : by.at) x = triangle_pairs::integer(g, 0, 2) == 0 ? triangle_pairs::integer(g, -9, 9) : 0;
    return by;
}

/// Lengths around a distance: itself, up to three units in the last place from it, and some farther ones.
std::vector<double> lengths_around(generator& g, double distance) {
    constexpr double most = std::numeric_limits<double>::max();
    std::vector<double> lengths{0, std::numeric_limits<double>::denorm_min(), most};
    if (!(distance <= most)) return lengths;
    double below = distance, above = distance;
    lengths.push_back(distance);
    for (int i = 0; i < 3; ++i) {
        lengths.push_back(below = std::nextafter(below, 0.0));
        lengths.push_back(above = std::nextafter(above, most));
    }
    for (const int greatest : {-1, -40})
        lengths.push_back(
            std::min(most, distance * (1 + std::ldexp(real(g), triangle_pairs::integer(g, -52, greatest)))));
    return lengths;
}

struct tally {
    std::size_t pairs = 0, equal = 0, nearer = 0, farther = 0, decided = 0, asked = 0;
};

/// Whether every decision is the judge's: of all of them, and of the rounded bounds where these decide.
bool decides_well(generator& g, const pose_pair& poses, const triangle3d& s, const triangle3d& t, tally& counted) {
    const distance_judge judge = judged(poses, s, t);
    const double truth = judge.rounded();
    const aabb::rounded_triangles rounded(poses, s, t);
    ++counted.pairs;
    for (const double d : lengths_around(g, truth)) {
        const int order = judge.compare(d);
        ++(order == 0 ? counted.equal : order < 0 ? counted.nearer : counted.farther);
        ++counted.asked;
        if (are_within(poses, s, t, d) != (order <= 0)) return false;
        if (are_within({poses.b, poses.a}, t, s, d) != (order <= 0)) return false;
        const std::optional<bool> known = rounded.are_within(d);
        if (known && *known != (order <= 0)) return false;
        counted.decided += known.has_value();
    }
    if (judge.compare(0) == 0) return true;
    const auto [mantissa, exponent] = aabb::disjoint_triangles(poses, s, t).nearest().squared;
    const double root = exponent % 2 == 0 ? std::ldexp(std::sqrt(mantissa), exponent / 2)
                                          : std::ldexp(std::sqrt(2 * mantissa), (exponent - 1) / 2);
    return truth < 0x1p-1000 || truth > 0x1p1000 || std::abs(root - truth) <= 0x1p-50 * truth;
}

/// Whether a point lies within an error of a triangle, in exact arithmetic.
bool is_near(const vec3d& point, const pose& at, const triangle3d& t, double error) {
    return judged({{}, at}, {{point, point, point}}, t).compare(error) <= 0;
}

}  // namespace

// With RC_PARAMS=max_success=190000 in the environment, more than 10^7 pairs; -s prints the numbers.
TEST_CASE("pairs of triangles are within a distance exactly where integers say so, in either order") {
    std::map<std::string, tally> tallies;
    REQUIRE(rc::check([&] {
        // The whole range of seeds from the first draw on.
        generator g(*rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()));
        const auto placement = *rc::gen::inRange<std::size_t>(0, triangle_pairs::placements.size());
        for (std::size_t i = 0; i < pose_classes.size() * triangle_pairs::patterns.size(); ++i) {
            const std::size_t c = i % pose_classes.size();
            triangle_pairs::pair pair = triangle_pairs::patterned(g, i / pose_classes.size());
            const vec3d by = step(g);
            // Without poses, the triangles are moved apart here.
            if (triangle_pairs::integer(g, 0, 1) == 0)
                for (auto& corner : pair[1])
                    for (std::size_t k = 0; k < 3; ++k) corner[k] += by[static_cast<int>(k)];
            const auto [s, t] = triangle_pairs::of_type<double>(triangle_pairs::placed<double>(g, pair, placement));
            const pose_pair poses = pose_classes[c].make(g, by);
            RC_ASSERT(decides_well(g, poses, s, t, tallies[pose_classes[c].name]));
        }
    }));
    for (const auto& [name, counted] : tallies) {
        CAPTURE(name, counted.pairs, counted.equal, counted.nearer, counted.farther, counted.decided, counted.asked);
        CHECK(counted.nearer > counted.pairs);
        CHECK(counted.farther > counted.pairs);
        // Of what is asked, most is within a few units in the last place.
        CHECK(counted.decided > counted.pairs / 4);
    }
    CHECK(tallies["none"].equal > tallies["none"].pairs / 4);
    CHECK(tallies["a translation"].equal > tallies["a translation"].pairs / 4);
}

TEST_CASE("eight pairs at once are decided as each alone, and as integers say") {
    generator g(568);
    std::size_t decided = 0, pairs = 0;
    for (int i = 0; i < 400; ++i) {
        const auto& of_class = pose_classes[static_cast<std::size_t>(i) % pose_classes.size()];
        const pose_pair poses = of_class.make(g, step(g));
        std::array<triangle3d, 8> s{}, t{};
        aabb::triangle3<aabb::simd::eight_doubles> of_s{}, of_t{};
        aabb::near_batch batch;
        const std::size_t count = i % 4 == 0 ? 1 + static_cast<std::size_t>(i) / 4 % 8 : 8;  // of pairs in the batch
        for (std::uint32_t lane = 0; lane < 8; ++lane) {
            const auto pattern = static_cast<std::size_t>(triangle_pairs::integer(g, 0, 8));
            const auto placement = static_cast<std::size_t>(triangle_pairs::integer(g, 0, 6));
            const auto pair = triangle_pairs::of_type<double>(
                triangle_pairs::placed<double>(g, triangle_pairs::patterned(g, pattern), placement));
            s[lane] = pair.a;
            t[lane] = pair.b;
            for (int c = 0; c < 3; ++c)
                for (int k = 0; k < 3; ++k) {
                    of_s[c][k][lane] = s[lane][c][k];
                    of_t[c][k][lane] = t[lane][c][k];
                }
        }
        const double judged_distance = judged(poses, s[0], t[0]).rounded();
        const bool is_of_first = triangle_pairs::integer(g, 0, 2) > 0 && judged_distance < 1e300;
        const double d = is_of_first ? judged_distance : real(g) + 1;
        const auto [within, farther] = aabb::rounded_pairs<aabb::simd::eight_doubles>(poses, of_s, of_t).decide(d);
        std::vector<aabb::index_pair> expected, found;
        for (std::uint32_t lane = 0; lane < 8; ++lane) {
            const std::optional<bool> alone = aabb::rounded_triangles(poses, s[lane], t[lane]).are_within(d);
            CHECK((within >> lane & 1U) == (alone == true ? 1U : 0U));
            CHECK((farther >> lane & 1U) == (alone == false ? 1U : 0U));
            decided += alone.has_value();
            ++pairs;
            if (lane >= count) continue;
            batch.add({lane, 2 * lane}, s[lane], t[lane]);
            if (judged(poses, s[lane], t[lane]).compare(d) <= 0) expected.push_back({lane, 2 * lane});
        }
        CHECK(batch.is_full() == (count == 8));
        const auto take = [&](aabb::index_pair pair) { found.push_back(pair); };
        batch.decide(poses, d, take);
        batch.decide(poses, d, take);  // it is empty
        CHECK(found == expected);
    }
    CHECK(decided > pairs / 2);
    CHECK(decided < pairs);
}

TEST_CASE("measured distances lie within their bounds at any size, and so do the points") {
    generator g(567);
    std::size_t apart = 0, meeting = 0, by_integers = 0;
    for (int i = 0; i < 6000; ++i) {
        const auto c = static_cast<std::size_t>(i) % pose_classes.size();
        triangle_pairs::pair pair =
            triangle_pairs::patterned(g, static_cast<std::size_t>(i) / 6 % triangle_pairs::patterns.size());
        const vec3d by = step(g);
        if (i % 2 == 0)
            for (auto& corner : pair[1])
                for (std::size_t k = 0; k < 3; ++k) corner[k] += by[static_cast<int>(k)];
        const auto placement = static_cast<std::size_t>(triangle_pairs::integer(g, 0, 6));
        if (triangle_pairs::placements[placement] == "largest") continue;  // distances may exceed the range of double
        const auto [s, t] = triangle_pairs::of_type<double>(triangle_pairs::placed<double>(g, pair, placement));
        const pose_pair poses = pose_classes[c].make(g, by);
        CAPTURE(i, pose_classes[c].name, triangle_pairs::placements[placement]);
        const distance_judge judge = judged(poses, s, t);
        const aabb::measured_distance distance =
            measured(poses, s, t, /*most=*/std::numeric_limits<double>::infinity());
        CHECK(judge.compare(distance.upper) <= 0);
        CHECK(judge.compare(distance.lower) >= 0);
        CHECK((distance.lower <= distance.value && distance.value <= distance.upper));
        CHECK((distance.upper == 0) == (judge.compare(0) == 0));
        CHECK(is_near(distance.p, poses.a, s, distance.point_error));
        CHECK(is_near(distance.q, poses.b, t, distance.point_error));
        const distance_judge of_points =
            judged({}, {{distance.p, distance.p, distance.p}}, {{distance.q, distance.q, distance.q}});
        constexpr double most = std::numeric_limits<double>::max();
        CHECK(of_points.compare(std::nextafter(distance.value + distance.point_error, most)) <= 0);
        CHECK(of_points.compare(std::nextafter(std::max(0.0, distance.value - distance.point_error), 0.0)) >= 0);
        ++(distance.upper == 0 ? meeting : apart);
        by_integers += distance.upper > 0 && distance.upper - distance.lower <= 0x1p-48 * distance.value;
        // What is certainly not nearer is left out.
        CHECK(judge.compare(measured(poses, s, t, distance.lower).lower) >= 0);
    }
    CHECK(apart > 1000);
    CHECK(meeting > 300);
    CHECK(by_integers > 100);
}

TEST_CASE("triangles whose coordinates span the range of double are within a distance where integers say so") {
    generator g(564);
    tally counted;
    int wrong = 0;
    for (int i = 0; i < 40; ++i) {
        const auto pair = triangle_pairs::of_type<double>(triangle_pairs::spread<double>(g));
        pose_pair poses;
        if (i % 3 == 0)
            for (pose* const p : {&poses.a, &poses.b}) {
                do {
                    for (double& r : p->rotation) r = std::ldexp(real(g), triangle_pairs::integer(g, -1070, 1020));
                } while (determinant_sign(*p) == 0);
                for (double& x : p->translation.at) x = std::ldexp(real(g), triangle_pairs::integer(g, -1070, 1020));
            }
        wrong += !decides_well(g, poses, pair.a, pair.b, counted);
    }
    CHECK(wrong == 0);
    CHECK(counted.farther > 20);
    CHECK(counted.nearer > 20);
}

TEST_CASE("rounded bounds of a distance hold, and lie close to it") {
    generator g(565);
    int above = 0, below = 0, far = 0, pairs = 0;
    for (int i = 0; i < 4000; ++i) {
        // Long triangles near each other, so that errors are large relative to the distance.
        triangle3d s{}, t{};
        for (triangle3d* const of : {&s, &t})
            for (vec3d& corner : of->corner) corner = {real(g, 100), real(g, 100), real(g, 1e-6)};
        const pose r = rotation(g);
        const pose_pair poses{r, {r.rotation, {real(g), real(g), 2e-6 + real(g, 1e-7)}}};
        const pose_pair unposed;
        const pose_pair& at = i % 2 == 0 ? poses : unposed;
        const distance_judge judge = judged(at, s, t);
        if (judge.compare(0) == 0) continue;
        ++pairs;
        const aabb::rounded_triangles rounded(at, s, t);
        const aabb::near_points nearest = rounded.nearest_points();
        const double upper = rounded.upper_bound(nearest);
        const double lower = std::max(rounded.lower_bound(nearest.p - nearest.q), rounded.lower_bound(nearest.normal));
        above += judge.compare(upper) > 0;
        below += lower > 0 && judge.compare(lower) < 0;
        far += upper - judge.rounded() > 1e-10 || judge.rounded() - lower > 1e-10;
    }
    CHECK(pairs > 1000);
    CHECK(above == 0);
    CHECK(below == 0);
    CHECK(far < pairs / 100);
}

TEST_CASE("every engine finds the boxes within a distance, as whole numbers say") {
    std::mt19937 random(566);
    const std::vector<aabb::box> boxes = lattice_boxes(random, 200, 30, 4);
    for (const double d : {0.0, 1.0, 2.0, 5.0, 5.5})
        for (const aabb::box_metric metric : {aabb::box_metric::euclidean, aabb::box_metric::axis}) {
            std::vector<aabb::index_pair> expected;
            for (std::uint32_t a = 0; a < boxes.size(); ++a)
                for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
                    int square = 0, greatest = 0;  // coordinates are small whole numbers
                    for (int k = 0; k < 3; ++k) {
                        const auto gap = static_cast<int>(
                            std::max({0.0F, boxes[b].min[k] - boxes[a].max[k], boxes[a].min[k] - boxes[b].max[k]}));
                        square += gap * gap;
                        greatest = std::max(greatest, gap);
                    }
                    const bool euclidean = metric == aabb::box_metric::euclidean;
                    if (euclidean ? square <= d * d : greatest <= d) expected.push_back({a, b});
                }
            for (const aabb::engine_info& engine : aabb::engines()) {
                if (!engine.searches_boxes) continue;
                CAPTURE(engine.name, d);
                aabb::within_stage stage(aabb::make_box_engine(engine.name), d, metric);
                for (std::uint32_t id = 0; id < boxes.size(); ++id) stage.insert(id);
                CHECK(found_by(stage, boxes) == expected);
            }
        }
}
