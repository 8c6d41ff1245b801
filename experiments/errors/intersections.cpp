module;
#include <fmt/format.h>

module aabblab.errors;

import :turns;
import aabb.pipeline;
import aabb.registry;
import aabblab.numbers;
import aabblab.progress;

namespace aabblab {

namespace {

constexpr std::size_t batch_size = 1024;
constexpr std::uint64_t most_pairs_a_hit = 1000;
/// Tests of libraries take part in one batch of so many: CGAL's takes a hundred times as long as ours.
constexpr std::size_t library_share = 16;

void take(aabb::corner_errors& greatest, const aabb::corner_errors& errors) {
    greatest.of_bound = std::max(greatest.of_bound, errors.of_bound);
    if (errors.greatest <= greatest.greatest) return;
    greatest.greatest = errors.greatest;
    greatest.bound = errors.bound;
}

/// The tests that construct on their way through the hits of one class.
class one_class {
public:
    explicit one_class(const pair_set& set) {
        const std::vector<std::string> strategies = aabb::strategy_names(aabb::strategy_kind::triangle);
        for (const std::string& name : constructing_tests()) {
            const bool of_library = std::ranges::find(strategies, name) == strategies.end();
            tests_.add({{.pairs = set.pair_class, .in_double = set.in_double, .triangle = name},
                        triangle_test_named({name, {}}),
                        of_library ? library_share : 1,
                        {}});
        }
    }

    void play(std::span<const aabb::triangle_pair<double>> hits) {
        std::deque<aabb::exact_intersection> exact;
        for (const aabb::triangle_pair<double>& hit : hits) exact.emplace_back(hit.a, hit.b);
        std::vector<aabb::triangle_intersection> made(hits.size());
        const auto construct = [&](aabb::triangle_test& test) {
            for (std::size_t k = 0; k < hits.size(); ++k) made[k] = test.intersection(hits[k].a, hits[k].b);
        };
        tests_.play(hits.size(), construct, [&](hit_point& point) {
            point.count += hits.size();
            for (std::size_t k = 0; k < hits.size(); ++k) {
                const aabb::corner_errors errors = exact[k].errors_of(made[k]);
                ++point.kinds[static_cast<std::size_t>(exact[k].kind())];
                point.different += static_cast<std::uint64_t>(!errors.same);
                point.outside += static_cast<std::uint64_t>(errors.same && !errors.within);
                take(point.greatest, errors);
            }
        });
    }

    [[nodiscard]] std::vector<hit_point> points(std::uint64_t tried) {
        std::vector<hit_point> points = tests_.points(&hit_point::ns_a_hit);
        for (hit_point& p : points) p.tried = tried;
        return points;
    }

private:
    tests_in_turn<hit_point> tests_;
};

template <class Real>
std::vector<hit_point> points_of(const pair_set& set, progress& shown, std::uint64_t done) {
    one_class all(set);
    pair_source<Real> source(set.pair_class, set.seed);
    std::vector<aabb::triangle_pair<double>> batch;
    std::uint64_t tried = 0;
    std::uint64_t hits = 0;
    const auto play = [&] {
        all.play(batch);
        batch.clear();
        shown.at(done + hits);
    };
    while (hits < set.count && tried / most_pairs_a_hit < set.count) {
        aabb::triangle_pair<Real> p{};
        source.next({&p, 1});
        ++tried;
        if (!aabb::exactly_intersect(p.a, p.b)) continue;
        ++hits;
        batch.push_back({in_double(p.a), in_double(p.b)});
        if (batch.size() == batch_size) play();
    }
    if (!batch.empty()) play();
    return all.points(tried);
}

/// "0", "0.53", "4.4e-16".
std::string number_text(double number) {
    return fmt::format("{:.2g}", number);
}

}  // namespace

std::vector<hit_point> measure_hits(std::span<const pair_set> sets,
                                    const std::function<void(std::span<const hit_point>)>& finished) {
    std::uint64_t all = 0;
    for (const pair_set& set : sets) all += set.count;
    progress shown("hits", all);
    std::vector<hit_point> points;
    std::uint64_t done = 0;
    for (const pair_set& set : sets) {
        for (hit_point& p : set.in_double ? points_of<double>(set, shown, done) : points_of<float>(set, shown, done))
            points.push_back(std::move(p));
        if (finished) finished(points);
        shown.at(done += set.count);
    }
    return points;
}

table hit_summary(std::span<const hit_point> points, bool in_double) {
    table t{{{"pairs", false},
             {"triangle", false},
             {"hits"},
             {"differ"},
             {"error/bound"},
             {"error"},
             {"bound"},
             {"ns a hit"}},
            {}};
    for (const hit_point& p : points) {
        if (p.in_double != in_double) continue;
        t.rows.push_back({p.pairs, p.triangle, grouped(p.count), grouped(p.different), number_text(p.greatest.of_bound),
                          number_text(p.greatest.greatest), number_text(p.greatest.bound),
                          fmt::format("{:.0f}", p.ns_a_hit.median)});
    }
    return t;
}

}  // namespace aabblab
