module;
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabblab.errors;

import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import aabb.registry;
import aabb.validation;
import aabblab.configs;
import aabblab.numbers;
import aabblab.progress;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.stopwatch;
import aabblab.tables;

namespace aabblab {

namespace {

constexpr std::size_t batch_size = 1024;
constexpr std::uint64_t most_pairs_a_hit = 1000;
/// Tests of libraries take part in one batch of so many: CGAL's takes a hundred times as long as ours.
constexpr std::size_t library_share = 16;

/// A test on its way through the hits of one class.
struct constructor {
    hit_point point;
    std::size_t share = 1;  ///< takes part in one batch of so many
    std::unique_ptr<aabb::triangle_test> test;
    std::vector<aabb::triangle_intersection> made;  ///< of the batch
    std::vector<double> ns;                         ///< a hit, of each batch
};

void take(aabb::corner_errors& greatest, const aabb::corner_errors& errors) {
    greatest.of_bound = std::max(greatest.of_bound, errors.of_bound);
    if (errors.greatest <= greatest.greatest) return;
    greatest.greatest = errors.greatest;
    greatest.bound = errors.bound;
}

class one_class {
public:
    explicit one_class(const pair_set& set) {
        const std::vector<std::string> strategies = aabb::strategy_names(aabb::strategy_kind::triangle);
        for (const std::string& name : constructing_tests()) {
            constructor& c = constructors_.emplace_back();
            c.point.pairs = set.pair_class;
            c.point.in_double = set.in_double;
            c.point.triangle = name;
            c.test = triangle_test_named({name, {}});
            if (std::ranges::find(strategies, name) == strategies.end()) c.share = library_share;
        }
    }

    /// Each batch begins with another test, so that none always finds the cache as the same one left it.
    void play(std::span<const aabb::triangle_pair<double>> hits) {
        for (std::size_t i = 0; i < constructors_.size(); ++i) {
            constructor& c = constructors_[(i + batches_) % constructors_.size()];
            if (batches_ % c.share != 0) continue;
            c.made.resize(hits.size());
            const double ms = milliseconds_of([&] {
                for (std::size_t k = 0; k < hits.size(); ++k) c.made[k] = c.test->intersection(hits[k].a, hits[k].b);
            });
            c.ns.push_back(ms * 1e6 / static_cast<double>(hits.size()));
            c.point.count += hits.size();
        }
        for (std::size_t k = 0; k < hits.size(); ++k) {
            const aabb::exact_intersection exact(hits[k].a, hits[k].b);
            for (constructor& c : constructors_) {
                if (batches_ % c.share != 0) continue;
                const aabb::corner_errors errors = exact.errors_of(c.made[k]);
                ++c.point.kinds[static_cast<std::size_t>(exact.kind())];
                c.point.different += static_cast<std::uint64_t>(!errors.same);
                c.point.outside += static_cast<std::uint64_t>(errors.same && !errors.within);
                take(c.point.greatest, errors);
            }
        }
        ++batches_;
    }

    [[nodiscard]] std::vector<hit_point> points(std::uint64_t tried) {
        std::vector<hit_point> all;
        for (constructor& c : constructors_) {
            c.point.tried = tried;
            if (!c.ns.empty()) c.point.ns_a_hit = quartiles_of(c.ns);
            all.push_back(std::move(c.point));
        }
        return all;
    }

private:
    std::vector<constructor> constructors_;
    std::size_t batches_ = 0;
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

table hit_rows(std::span<const hit_point> points) {
    table t{{{"pairs", false}, {"precision", false}, {"triangle", false}, {"tried"}, {"hits"}}, {}};
    constexpr std::array kinds = {aabb::intersection_kind::point, aabb::intersection_kind::segment,
                                  aabb::intersection_kind::transversal, aabb::intersection_kind::overlap};
    for (const aabb::intersection_kind kind : kinds) t.columns.push_back({std::string(name_of(kind))});
    for (const char* name : {"different", "outside", "of_bound", "error", "bound", "ns", "ns_low", "ns_high"})
        t.columns.push_back({name});
    for (const hit_point& p : points) {
        std::vector<std::string>& row = t.rows.emplace_back();
        row = {p.pairs, p.in_double ? "double" : "float", p.triangle, std::to_string(p.tried), std::to_string(p.count)};
        for (const aabb::intersection_kind kind : kinds)
            row.push_back(std::to_string(p.kinds[static_cast<std::size_t>(kind)]));
        for (const std::uint64_t number : {p.different, p.outside}) row.push_back(std::to_string(number));
        for (const double number : {p.greatest.of_bound, p.greatest.greatest, p.greatest.bound, p.ns_a_hit.median,
                                    p.ns_a_hit.low, p.ns_a_hit.high})
            row.push_back(aabb::shortest(number));
    }
    return t;
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
