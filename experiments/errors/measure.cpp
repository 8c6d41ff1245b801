module;
#include <random>

module aabblab.errors;

import :turns;
import aabb.base;
import aabb.pipeline;
import aabblab.progress;

namespace aabblab {

namespace {

/// As many pairs as stay in the processor's cache with their answers.
constexpr std::size_t batch_size = 4096;

/// The methods of a study on their way through one set of pairs.
class one_set {
public:
    one_set(const error_study& study, const std::string& name, bool in_double) {
        for (const error_curve& curve : study.curves)
            for (const aabb::strategy_choice& choice : curve.triangles) {
                std::unique_ptr<aabb::triangle_test> test = triangle_test_named(choice);
                if (in_double && !test->takes_double()) continue;
                error_point point{.pairs = name, .in_double = in_double, .curve = curve.label, .triangle = choice};
                methods_.add({std::move(point), std::move(test), 1, {}});
            }
    }

    template <class Real>
    void play(std::span<const aabb::triangle_pair<Real>> batch) {
        truth_.resize(batch.size());
        for (std::size_t i = 0; i < batch.size(); ++i)
            truth_[i] = static_cast<std::uint8_t>(aabb::exactly_intersect(batch[i].a, batch[i].b));
        answers_.resize(batch.size());
        methods_.play(
            batch.size(), [&](aabb::triangle_test& test) { test.intersect(batch, answers_); },
            [&](error_point& point) { count(point); });
    }

    [[nodiscard]] std::vector<error_point> points() { return methods_.points(&error_point::ns_a_pair); }

private:
    void count(error_point& point) const {
        point.count += answers_.size();
        for (std::size_t i = 0; i < answers_.size(); ++i) {
            point.intersecting += truth_[i];
            point.false_negatives += static_cast<std::uint64_t>(truth_[i] > answers_[i]);
            point.false_positives += static_cast<std::uint64_t>(truth_[i] < answers_[i]);
        }
    }

    tests_in_turn<error_point> methods_;
    std::vector<std::uint8_t> truth_;
    std::vector<std::uint8_t> answers_;
};

template <class Real>
std::vector<error_point> points_of(const error_study& study, const pair_set& set, progress& shown, std::size_t& done) {
    one_set all(study, set.pair_class, set.in_double);
    pair_source<Real> source(set.pair_class, set.seed);
    std::vector<aabb::triangle_pair<Real>> batch;
    for (std::uint64_t left = set.count; left > 0; left -= batch.size()) {
        batch.resize(std::min<std::uint64_t>(left, batch_size));
        source.next(batch);
        all.play(std::span<const aabb::triangle_pair<Real>>(batch));
        shown.at(done += batch.size());
    }
    return all.points();
}

std::vector<error_point> points_of(const error_study& study, const scene_choice& scene) {
    one_set all(study, scene.kind + " " + parameters_text(scene), false);
    std::vector<aabb::triangle_pair<float>> pairs = candidate_triangles(scene);
    if (pairs.empty())
        throw aabb::input_error(scene.kind + " " + parameters_text(scene) + " has no triangles whose boxes overlap");
    // A walk meets them in an order that no processor can guess; a search finds them row by row.
    std::ranges::shuffle(pairs, std::mt19937_64(1));  // NOLINT(*-msc51-cpp): the same order in every run
    const std::span<const aabb::triangle_pair<float>> rest(pairs);
    for (std::size_t at = 0; at < pairs.size(); at += batch_size)
        all.play(rest.subspan(at, std::min(batch_size, pairs.size() - at)));
    return all.points();
}

}  // namespace

std::vector<error_point> measure_errors(const error_study& study,
                                        const std::function<void(std::span<const error_point>)>& finished) {
    std::vector<error_point> points;
    const auto add = [&](std::vector<error_point> more) {
        std::ranges::move(more, std::back_inserter(points));
        if (finished) finished(points);
    };
    std::uint64_t all = 0;
    for (const pair_set& set : study.pairs) all += set.count;
    {
        progress shown("pairs of triangles", all);
        std::size_t done = 0;
        for (const pair_set& set : study.pairs)
            add(set.in_double ? points_of<double>(study, set, shown, done) : points_of<float>(study, set, shown, done));
    }
    progress shown("scenes", study.scenes.size());
    for (std::size_t i = 0; i < study.scenes.size(); ++i) {
        add(points_of(study, study.scenes[i]));
        shown.at(i + 1);
    }
    return points;
}

}  // namespace aabblab
