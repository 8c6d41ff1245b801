#include <benchmark/benchmark.h>

#include "peers/peers.hpp"
#include "stages.hpp"

import aabb.build.sah;
import aabb.distance;
import aabb.std;
import aabb.tree.implicit;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Two meshes that are disjoint, or intersect a little, at some poses of the second.
class disjoint_meshes {
public:
    disjoint_meshes(const std::string& name_a, const std::string& name_b)
        : a(make_mesh(name_a).mesh), b(make_mesh(name_b).mesh) {
        const ball of_a(a), of_b(b);
        size = of_a.radius + of_b.radius;
        constexpr int poses = 8;
        for (int i = 0; i < poses; ++i) {
            aabb::pose p = turned(0.7 * i);
            // Along a spiral around A, ever farther from it.
            const double angle = 2.4 * i, height = (i + 0.5) * 2 / poses - 1, width = std::sqrt(1 - height * height);
            const double far = size * (0.45 + 0.06 * i);
            const aabb::vec3d centre = moved(p, of_b.centre);
            const aabb::vec3d way{far * width * std::cos(angle), far * width * std::sin(angle), far * height};
            for (int k = 0; k < 3; ++k) p.translation[k] = of_a.centre[k] + way[k] - centre[k];
            of_b_.push_back(p);
        }
    }

    aabb::mesh a, b;
    double size = 0;  ///< the sum of the radii of balls around both

    [[nodiscard]] const std::vector<aabb::pose>& poses_of_b() const { return of_b_; }

private:
    /// Around the box of a mesh.
    struct ball {
        aabb::vec3d centre{};
        double radius = 0;

        explicit ball(const aabb::mesh& m) {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            aabb::vec3d low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
            for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
                const aabb::triangle3d corners = m.given_triangle(t);
                for (const aabb::vec3d& corner : corners.corner)
                    for (int k = 0; k < 3; ++k) {
                        low[k] = std::min(low[k], corner[k]);
                        high[k] = std::max(high[k], corner[k]);
                    }
            }
            for (int k = 0; k < 3; ++k) centre[k] = (low[k] + high[k]) / 2;
            radius = std::sqrt(dot(high - centre, high - centre));
        }
    };

    /// The rotation about (1, 2, 3) by Rodrigues' formula.
    [[nodiscard]] static aabb::pose turned(double angle) {
        const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
        const double length = std::sqrt(14.0), x = 1 / length, y = 2 / length, z = 3 / length;
        return {{c + x * x * d, x * y * d - z * s, x * z * d + y * s, y * x * d + z * s, c + y * y * d,
                 y * z * d - x * s, z * x * d - y * s, z * y * d + x * s, c + z * z * d},
                {0, 0, 0}};
    }

    std::vector<aabb::pose> of_b_;
};

struct mesh_names {
    std::string name, a, b;
};
const std::array<mesh_names, 5> scenes{{{"spheres", "noise_sphere:triangles=5000", "noise_sphere:triangles=5000"},
                                        {"knots", "torus_knot:triangles=20000", "torus_knot:triangles=20000"},
                                        {"sphere_knot", "noise_sphere:triangles=80000", "torus_knot:triangles=80000"},
                                        {"elephant_lion", "elephant.off", "lion.off"},
                                        {"bunnies", "bunny00.off", "bunny00.off"}}};

/// Times of two candidates that take turns.
struct turns {
    std::vector<double> ours_ms, ratios;
    double theirs_ms = 0;

    void add(double ours, double theirs) {
        ours_ms.push_back(ours);
        ratios.push_back(theirs / ours);
        theirs_ms += theirs;
    }
    /// The mean time of a query of theirs is that of the iteration.
    void report(benchmark::State& state) const {
        state.counters["ours_ms"] = quartiles_of(ours_ms).median;
        state.counters["ratio"] = quartiles_of(ratios).median;
    }
};

/// The result and the time of a call.
template <class Call>
auto timed(const Call& call) {
    const wall_stopwatch watch;
    const auto result = call();
    return std::pair(result, watch.ms());
}

/// The time of a search that appends its pairs, which are sorted afterwards.
template <class Search>
double time_search(std::vector<aabb::index_pair>& pairs, const Search& search) {
    pairs.clear();
    const wall_stopwatch watch;
    search();
    const double ms = watch.ms();
    std::ranges::sort(pairs);
    return ms;
}

/// Times both distances at each pose in turn, and counts how many of the peer's are beyond our bounds by more than
/// their rounding.
void time_distances(benchmark::State& state, const distance_peer& peer, const mesh_names& names) {
    const disjoint_meshes meshes(names.a, names.b);
    aabb::distance_detection<aabb::sah_build, aabb::implicit_tree> ours;
    const auto of_a = ours.add_model(meshes.a), of_b = ours.add_model(meshes.b);
    const distance_peer::measurement theirs = peer.distance(meshes.a, meshes.b);
    turns taken;
    double wrong = 0, worst = 0;
    for ([[maybe_unused]] const auto& ignored : state) {
        const double before = taken.theirs_ms;
        wrong = 0;
        for (const aabb::pose& at : meshes.poses_of_b()) {
            const auto [exact, our_ms] = timed([&] { return ours.distance(of_a, {}, of_b, at); });
            const auto [their_distance, their_ms] = timed([&] { return theirs(at); });
            taken.add(our_ms, their_ms);
            const double off = std::max(0.0, std::abs(their_distance - exact.distance) - exact.error);
            wrong += off > 1e-12 * meshes.size;
            worst = std::max(worst, off / meshes.size);
        }
        state.SetIterationTime((taken.theirs_ms - before) / 1000 / static_cast<double>(meshes.poses_of_b().size()));
    }
    taken.report(state);
    state.counters["wrong"] = wrong / static_cast<double>(meshes.poses_of_b().size());
    state.counters["worst"] = worst;
}

/// Times searches for the pairs within a fiftieth of the meshes' size beyond their distance.
/// @throws std::logic_error if the sets of pairs differ
void time_within(benchmark::State& state, const distance_peer& peer, const mesh_names& names) {
    const disjoint_meshes meshes(names.a, names.b);
    aabb::distance_detection<aabb::sah_build, aabb::implicit_tree> distances;
    distances.add_model(meshes.a);
    distances.add_model(meshes.b);
    const distance_peer::search theirs = peer.within(meshes.a, meshes.b);
    turns taken;
    std::vector<aabb::index_pair> expected, found;
    double pairs = 0;
    for ([[maybe_unused]] const auto& ignored : state) {
        const double before = taken.theirs_ms;
        pairs = 0;
        for (const aabb::pose& at : meshes.poses_of_b()) {
            const double d = distances.distance(0, {}, 1, at).distance + meshes.size / 50;
            aabb::within_detection<aabb::sah_build, aabb::implicit_tree> ours(d);
            ours.add_model(meshes.a);
            ours.add_model(meshes.b);
            const auto search = [&] { ours.all_pairs(0, {}, 1, at, expected); };
            static_cast<void>(time_search(expected, search));  // buffers grow
            found.reserve(expected.size());
            const double our_ms = time_search(expected, search);
            const double their_ms = time_search(found, [&] { theirs(at, d, found); });
            if (found != expected)
                throw std::logic_error(peer.name + " finds other pairs within a distance: " +
                                       std::to_string(found.size()) + ", not " + std::to_string(expected.size()));
            taken.add(our_ms, their_ms);
            pairs += static_cast<double>(expected.size());
        }
        state.SetIterationTime((taken.theirs_ms - before) / 1000 / static_cast<double>(meshes.poses_of_b().size()));
    }
    taken.report(state);
    state.counters["pairs"] = pairs / static_cast<double>(meshes.poses_of_b().size());
}

std::vector<distance_peer> peers() {
    std::vector<distance_peer> peers;
#ifdef AABBLAB_PEER_FCL
    peers.push_back(fcl_distances());
#endif
#ifdef AABBLAB_PEER_EMBREE
    peers.push_back(embree_distances());
#endif
#ifdef AABBLAB_PEER_CGAL
    peers.push_back(cgal_distances());
#endif
    return peers;
}

}  // namespace

void add_distance_benchmarks() {
    const auto add = [](const std::string& query, const distance_peer& peer, const mesh_names& names, auto* time) {
        benchmark::RegisterBenchmark((query + "/" + peer.name + "/" + names.name).c_str(),
                                     [=](benchmark::State& state) { time(state, peer, names); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    };
    for (const mesh_names& names : scenes) {
        if (!is_mesh(names.a, {}) || !is_mesh(names.b, {})) continue;  // not downloaded
        for (const distance_peer& peer : peers()) {
            add("distance", peer, names, time_distances);
            if (peer.within) add("within", peer, names, time_within);
        }
    }
}

}  // namespace aabblab
