module;
#include <random>

module aabblab.errors;

import aabb.pipeline;
import aabb.registry;
import aabb.collision_filter;
import aabb.truth;
import aabblab.filters;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;
import aabblab.stopwatch;
import aabblab.trials;

namespace aabblab {

namespace {

/// Runs triangle tests alternately on batches of pairs. The order varies from batch to batch, so that no test always
/// inherits the cache state of the same predecessor.
template <class Point>
class alternating_tests {
public:
    struct entry {
        Point point;
        std::unique_ptr<aabb::triangle_test> test;
        std::size_t batches_per_run = 1;     ///< slow tests run on every n-th batch only
        std::vector<double> ns{}, cpu_ns{};  ///< wall and processor time per pair, for each batch
    };

    void add(entry added) { entries_.push_back(std::move(added)); }

    /// Times each test on a batch of pairs, in an order that varies with the batch, and adds its errors to its point.
    /// @param pairs their number in the batch
    /// @param work runs a test; it is timed
    /// @param judge compares its results with the ground truth, and adds to its point; untimed
    template <class Work, class Judge>
    void run_batch(std::size_t pairs, Work work, Judge judge) {
        run_round(entries_, batches_, [&](entry& e) {
            if (batches_ % e.batches_per_run != 0) return;  // slow tests skip batches
            stopwatch watch;
            work(*e.test);
            const elapsed took = watch.lap();
            e.ns.push_back(took.wall_ms * 1e6 / static_cast<double>(pairs));
            e.cpu_ns.push_back(took.cpu_ms * 1e6 / static_cast<double>(pairs));
            judge(e.point);
        });
        ++batches_;
    }

    /// Moves out the points of all tests.
    /// @param set_times sets the times of a point from those of an entry that ran
    template <class SetTimes>
    [[nodiscard]] std::vector<Point> points(SetTimes set_times) {
        std::vector<Point> points;
        for (entry& e : entries_) {
            if (!e.ns.empty()) set_times(e.point, e);
            points.push_back(std::move(e.point));
        }
        return points;
    }

private:
    std::vector<entry> entries_;
    std::size_t batches_ = 0;
};

/// A batch of this size stays in the cache, together with its results.
constexpr std::size_t pairs_in_batch = 4096;
constexpr std::size_t least_batch = 512;   ///< takes much longer than reading a clock
constexpr std::size_t fewest_batches = 8;  ///< of which the interval of a median can be given

/// The size of the batches of a set: smaller ones in a small set, so that there are several.
std::size_t batch_size(std::uint64_t pairs) {
    return std::clamp<std::size_t>(pairs / fewest_batches, least_batch, pairs_in_batch);
}

/// The median time per pair over batches with its 95 % interval. Batches are independent, so they are repeats.
void set_processor_time(error_point& point, const std::vector<double>& batches) {
    cells logarithms(/*processes=*/1, /*seeds=*/1);
    for (const double ns : batches)
        if (ns > 0) logarithms.add(0, 0, std::log(ns));
    if (logarithms.empty()) return;
    point.cpu_ns = quartiles_of(batches).median;
    if (const std::optional<interval> range = interval_of(logarithms)) {
        point.cpu_ns_low = range->low;
        point.cpu_ns_high = range->high;
    }
}

class error_run {
public:
    /// Makes every test of every curve of the study; a curve is a test at several values of its parameter.
    /// @param in_double leaves out the tests that take floats only
    error_run(const error_study& study, const std::string& name, bool in_double) {
        for (const error_curve& curve : study.curves)
            for (const aabb::strategy_choice& choice : curve.triangles) {
                std::unique_ptr<aabb::triangle_test> test = triangle_test_named(choice);
                if (in_double && !test->takes_double()) continue;
                error_point point{.pairs = name, .in_double = in_double, .curve = curve.label, .triangle = choice};
                methods_.add({.point = std::move(point), .test = std::move(test)});
            }
    }

    /// Times the methods on a batch, and counts their errors against the exact predicates.
    /// @param is_new false if the batch was counted before
    template <class Real>
    void run_batch(std::span<const aabb::triangle_pair<Real>> batch, bool is_new = true) {
        truth_.resize(batch.size());
        for (std::size_t i = 0; i < batch.size(); ++i)
            truth_[i] =
                static_cast<std::uint8_t>(aabb::judge_intersection({}, in_double(batch[i].a), in_double(batch[i].b)));
        results_.resize(batch.size());
        methods_.run_batch(
            batch.size(), [&](aabb::triangle_test& test) { test.intersect(batch, results_); },
            [&](error_point& point) {
                if (is_new) count(point);
            });
    }

    [[nodiscard]] std::vector<error_point> points() {
        return methods_.points([](error_point& point, const auto& times) {
            point.ns_per_pair = quartiles_of(times.ns);
            set_processor_time(point, times.cpu_ns);
        });
    }

private:
    /// Adds the errors of the last test; results and truth are 1 for an intersection.
    void count(error_point& point) const {
        point.count += results_.size();
        for (std::size_t i = 0; i < results_.size(); ++i) {
            point.intersecting += truth_[i];
            point.false_negatives += static_cast<std::uint64_t>(truth_[i] > results_[i]);
            point.false_positives += static_cast<std::uint64_t>(truth_[i] < results_[i]);
        }
    }

    alternating_tests<error_point> methods_;
    std::vector<std::uint8_t> truth_, results_;
};

/// Runs the tests of a study on the pairs of a set, batch by batch, so that memory does not grow with their number.
/// @param done the pairs of all sets so far, for the progress shown
template <class Real>
std::vector<error_point> run_pairs(const error_study& study, const pair_set& set, progress& shown, std::size_t& done) {
    error_run run(study, set.pair_class, set.in_double);
    pair_source<Real> source(set.pair_class, set.seed);
    std::vector<aabb::triangle_pair<Real>> batch;
    for (std::uint64_t left = set.count; left > 0; left -= batch.size()) {
        batch.resize(std::min<std::uint64_t>(left, batch_size(set.count)));
        source.next(batch);
        run.run_batch(std::span<const aabb::triangle_pair<Real>>(batch));
        shown.update(done += batch.size());
    }
    return run.points();
}

/// Appends the pairs of triangles of two objects whose boxes overlap, by a broad phase over the triangles of both, in
/// less than quadratic time. Pairs within one object are dropped; A's triangles have the lesser ids.
void add_overlapping(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b,
                     std::vector<aabb::triangle_pair<float>>& overlapping) {
    const aabb::box bounds_b = aabb::bounds_of(b);
    const aabb::relative_pose to_a(pose_a, pose_b, bounds_b, a.frame, b.frame);
    if (!aabb::overlaps(aabb::bounds_of(a), to_a(bounds_b))) return;
    std::vector<aabb::box> boxes;
    std::vector<aabb::triangle3f> images;  // of the triangles of B, in the frame of A
    for (std::uint32_t t = 0; t < a.triangle_count(); ++t) boxes.push_back(aabb::bounds_of(a.triangle(t)));
    for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
        images.push_back(to_a(b.triangle(t)));
        boxes.push_back(aabb::bounds_of(images.back()));
    }
    const auto search = aabb::compose_global_search({}, aabb::instrumentation::none);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) search->insert(id);
    search->update(boxes);
    std::vector<aabb::index_pair> pairs;
    search->search(pairs);
    for (const aabb::index_pair p : pairs)
        if (p.a < a.triangle_count() && p.b >= a.triangle_count())
            overlapping.push_back({a.triangle(p.a), images[p.b - a.triangle_count()]});
}

/// The pairs of triangles with overlapping boxes, of any two objects, over all frames, in the frame of the first mesh.
std::vector<aabb::triangle_pair<float>> overlapping_triangles(const scene_choice& choice) {
    const std::unique_ptr<aabb::mesh_scene> scene = make_mesh_scene(choice);
    const auto filter = filter_of(choice, scene->mesh_of.size());
    std::vector<aabb::triangle_pair<float>> overlapping;
    const auto mesh_of = [&](std::size_t object) -> const aabb::mesh& { return scene->meshes[scene->mesh_of[object]]; };
    for (std::vector<aabb::pose> poses; scene->next(poses);)
        for (std::size_t a = 0; a < poses.size(); ++a)
            for (std::size_t b = a + 1; b < poses.size(); ++b)
                if (!filter || filter->keeps(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)))
                    add_overlapping(mesh_of(a), poses[a], mesh_of(b), poses[b], overlapping);
    return overlapping;
}

/// Runs the tests of a study on the pairs that a narrow phase would test in a scene of meshes.
std::vector<error_point> run_scene(const error_study& study, const scene_choice& scene) {
    const std::string name = scene.kind + " " + parameters_text(scene);
    error_run run(study, name, /*in_double=*/false);
    std::vector<aabb::triangle_pair<float>> pairs = overlapping_triangles(scene);
    if (pairs.empty()) throw aabb::input_error(name + " has no triangles whose boxes overlap");
    // A tree traversal yields pairs in an unpredictable order; this search yields them row by row.
    std::ranges::shuffle(pairs, std::mt19937_64(1));  // NOLINT(*-msc51-cpp): the same order in every run
    const std::span<const aabb::triangle_pair<float>> shuffled(pairs);
    // Scenes have fewer pairs than classes: they run again until there are enough times.
    const std::size_t size = batch_size(pairs.size());
    const std::size_t batches = (pairs.size() + size - 1) / size;
    constexpr std::size_t enough_batches = 3 * fewest_batches;
    for (std::size_t round = 0; round < (enough_batches + batches - 1) / batches; ++round)
        for (std::size_t begin = 0; begin < pairs.size(); begin += size)
            run.run_batch(shuffled.subspan(begin, std::min(size, pairs.size() - begin)), /*is_new=*/round == 0);
    return run.points();
}

constexpr std::size_t hits_in_batch = 1024;
constexpr std::uint64_t most_pairs_per_hit = 1000;
/// Tests of libraries run on one batch in sixteen: CGAL's takes a hundred times as long as ours.
constexpr std::size_t batches_per_library_run = 16;

/// Raises the greatest errors so far to those of one hit.
void raise_to(aabb::corner_errors& greatest, const aabb::corner_errors& errors) {
    greatest.of_bound = std::max(greatest.of_bound, errors.of_bound);
    if (errors.greatest <= greatest.greatest) return;
    greatest.greatest = errors.greatest;
    greatest.bound = errors.bound;
}

/// Runs the tests that construct the intersection of two triangles on the hits (intersecting pairs) of one class.
class hit_run {
public:
    /// Makes all tests, also of libraries, that can construct an intersection.
    explicit hit_run(const pair_set& set) {
        const std::vector<std::string> strategies = aabb::strategy_names(aabb::strategy_kind::triangle);
        for (const std::string& name : constructing_tests()) {
            // Tests of libraries are slower, so that they skip batches.
            const bool of_library = std::ranges::find(strategies, name) == strategies.end();
            tests_.add({.point = {.pairs = set.pair_class, .in_double = set.in_double, .triangle = name},
                        .test = triangle_test_named({name, {}}),
                        .batches_per_run = of_library ? batches_per_library_run : 1});
        }
    }

    /// Times the tests on some hits, and compares each constructed intersection with CGAL's exact one: it is
    /// `different` if kind or number of corners are wrong, and `outside` if an error exceeds the stated bound.
    void run_batch(std::span<const aabb::triangle_pair<double>> hits) {
        std::deque<aabb::exact_intersection> exact;
        for (const aabb::triangle_pair<double>& hit : hits) exact.emplace_back(hit.a, hit.b);
        std::vector<aabb::triangle_intersection> constructed(hits.size());
        const auto construct = [&](aabb::triangle_test& test) {
            for (std::size_t k = 0; k < hits.size(); ++k) constructed[k] = test.intersection(hits[k].a, hits[k].b);
        };
        tests_.run_batch(hits.size(), construct, [&](hit_point& point) {
            point.count += hits.size();
            for (std::size_t k = 0; k < hits.size(); ++k) {
                const aabb::corner_errors errors = exact[k].errors_of(constructed[k]);
                ++point.kinds[static_cast<std::size_t>(exact[k].kind())];
                point.different += static_cast<std::uint64_t>(!errors.same);
                point.outside += static_cast<std::uint64_t>(errors.same && !errors.within);
                raise_to(point.greatest, errors);
            }
        });
    }

    [[nodiscard]] std::vector<hit_point> points(std::uint64_t tried) {
        std::vector<hit_point> points =
            tests_.points([](hit_point& point, const auto& times) { point.ns_per_hit = quartiles_of(times.ns); });
        for (hit_point& p : points) p.tried = tried;
        return points;
    }

private:
    alternating_tests<hit_point> tests_;
};

/// Generates pairs until a set has the requested number of hits, and runs the constructing tests on these, batch by
/// batch. It gives up after a thousand pairs per requested hit, as hits are rare in some classes.
/// @param done the hits of earlier sets, for the progress shown
template <class Real>
std::vector<hit_point> run_hits(const pair_set& set, progress& shown, std::uint64_t done) {
    hit_run run(set);
    pair_source<Real> source(set.pair_class, set.seed);
    std::vector<aabb::triangle_pair<double>> batch;
    std::uint64_t tried = 0, hits = 0;
    const auto flush = [&] {
        run.run_batch(batch);
        batch.clear();
        shown.update(done + hits);
    };
    while (hits < set.count && tried / most_pairs_per_hit < set.count) {
        aabb::triangle_pair<Real> p{};
        source.next({&p, 1});
        ++tried;
        if (!aabb::judge_intersection({}, in_double(p.a), in_double(p.b))) continue;
        ++hits;
        batch.push_back({in_double(p.a), in_double(p.b)});
        if (batch.size() == hits_in_batch) flush();
    }
    if (!batch.empty()) flush();
    return run.points(tried);
}

}  // namespace

/// Runs the tests of a study on its sets of generated pairs, then on the triangle pairs of its scenes.
/// @param finished if set, receives all points so far after each set, so that they can be stored
std::vector<error_point> measure_errors(const error_study& study,
                                        const std::function<void(std::span<const error_point>)>& finished) {
    std::vector<error_point> points;
    const auto add = [&](std::vector<error_point> more) {
        std::ranges::move(more, std::back_inserter(points));
        if (finished) finished(points);
    };
    std::uint64_t count = 0;
    for (const pair_set& set : study.pairs) count += set.count;
    {
        progress shown("pairs of triangles", count);
        std::size_t done = 0;
        for (const pair_set& set : study.pairs)
            add(set.in_double ? run_pairs<double>(study, set, shown, done) : run_pairs<float>(study, set, shown, done));
    }
    progress shown("scenes", study.scenes.size());
    for (std::size_t i = 0; i < study.scenes.size(); ++i) {
        add(run_scene(study, study.scenes[i]));
        shown.update(i + 1);
    }
    return points;
}

/// Runs the tests that construct intersections on the hits (intersecting pairs) of each set.
/// @param finished if set, receives all points so far after each set, so that they can be stored
std::vector<hit_point> measure_hits(std::span<const pair_set> sets,
                                    const std::function<void(std::span<const hit_point>)>& finished) {
    std::uint64_t count = 0;
    for (const pair_set& set : sets) count += set.count;
    progress shown("hits", count);
    std::vector<hit_point> points;
    std::uint64_t done = 0;
    for (const pair_set& set : sets) {
        for (hit_point& p : set.in_double ? run_hits<double>(set, shown, done) : run_hits<float>(set, shown, done))
            points.push_back(std::move(p));
        if (finished) finished(points);
        shown.update(done += set.count);
    }
    return points;
}

/// One row per class and test, with the greatest error over the hits, also relative to the bound that the test states.
table hit_summary(std::span<const hit_point> points, bool in_double) {
    table t = empty_table({"pairs", "triangle"}, {"hits", "differ", "error/bound", "error", "bound", "ns/hit"});
    for (const hit_point& p : points) {
        if (p.in_double != in_double) continue;
        std::vector<std::string> cells{p.pairs, p.triangle, grouped(p.count), grouped(p.different)};
        for (const double error : {p.greatest.of_bound, p.greatest.greatest, p.greatest.bound})
            cells.push_back(fmt::format("{:.2g}", error));
        cells.push_back(fmt::format("{:.0f}", p.ns_per_hit.median));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

}  // namespace aabblab
