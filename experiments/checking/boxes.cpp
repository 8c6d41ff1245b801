module aabblab.checking;

import :comparison;
import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 5> class_names{"touching", "within 1 unit in the last place", "within 4",
                                                      "within 16", "beyond 16"};
constexpr std::string_view axis_names = "xyz";

/// The axis on which two boxes overlap least, or have the greatest gap.
struct box_gap {
    int axis = 0;
    double gap = -std::numeric_limits<double>::infinity();  ///< negative if they overlap
    double unit = 0;  ///< the unit in the last place of the greatest coordinate on this axis
    int axes = 0;     ///< with a gap

    /// In units in the last place.
    [[nodiscard]] double units() const { return std::abs(gap) / unit; }
};

template <class Real, class Box>
box_gap gap_of(const Box& a, const Box& b) {
    box_gap widest;
    for (int k = 0; k < 3; ++k) {
        // One of the two boxes begins later, one ends earlier; the difference of floats is exact in double but for
        // extreme exponents, and its sign always.
        const double gap = std::max(double{a.min[k]}, double{b.min[k]}) - std::min(double{a.max[k]}, double{b.max[k]});
        widest.axes += gap > 0;
        if (gap <= widest.gap) continue;
        const Real greatest = std::max(std::max(std::abs(a.min[k]), std::abs(a.max[k])),
                                       std::max(std::abs(b.min[k]), std::abs(b.max[k])));
        widest = {k, gap, double{std::nextafter(greatest, std::numeric_limits<Real>::infinity())} - double{greatest},
                  widest.axes};
    }
    return widest;
}

std::size_t class_of(const box_gap& g) {
    if (g.gap == 0) return 0;
    return g.units() <= 1 ? 1 : g.units() <= 4 ? 2 : g.units() <= 16 ? 3 : 4;
}

std::string description_of(const box_gap& g) {
    const char axis = axis_names[static_cast<std::size_t>(g.axis)];
    if (g.gap == 0) return fmt::format("touching on {}", axis);
    const std::string units = g.units() <= 16 ? fmt::format(", {:.2g} units in the last place", g.units()) : "";
    return g.gap > 0 ? fmt::format("a gap of {:.6g} on {}{}", g.gap, axis, units)
                     : fmt::format("an overlap of {:.6g} on {}{}", -g.gap, axis, units);
}

template <class Box>
std::string shape_of(std::uint32_t id, const Box& b) {
    return fmt::format("{}: x {:a} to {:a}, y {:a} to {:a}, z {:a} to {:a}", id, b.min[0], b.max[0], b.min[1], b.max[1],
                       b.min[2], b.max[2]);
}

/// What all wrong pairs have in common, as far as boxes show it.
class box_patterns {
public:
    void add(const wrong_pair& wrong, const box_gap& g) {
        const bool is_near = class_of(g) <= 3;
        if (wrong.is_listed) {
            ++false_positives_;
            greatest_gap_ = std::max(greatest_gap_, g.gap);
            only_near_ &= is_near;
            untested_axis_ = g.axes == 1 && untested_axis_.value_or(g.axis) == g.axis ? std::optional(g.axis) : -1;
        } else {
            ++false_negatives_;
            only_touching_ &= g.gap == 0;
            only_near_ &= is_near;
        }
        if (!common_) common_ = {wrong.pair.a, wrong.pair.b};
        std::erase_if(*common_, [&](std::uint32_t id) { return id != wrong.pair.a && id != wrong.pair.b; });
    }

    [[nodiscard]] std::vector<std::string> sentences() const {
        std::vector<std::string> texts;
        if (false_negatives_ > 0 && only_touching_)
            texts.emplace_back(
                "Every false negative touches without overlapping: boxes are closed, so that < in place "
                "of <= loses such pairs.");
        else if (only_near_ && false_negatives_ + false_positives_ > 0)
            texts.emplace_back(
                "Every wrong pair is within 16 units in the last place of touching: the list is of "
                "rounded boxes.");
        if (false_positives_ > 0 && !only_near_ && untested_axis_.value_or(-1) >= 0)
            texts.push_back(
                fmt::format("Every false positive overlaps on the two other axes: {} may not be tested, or "
                            "the boxes may be grown on it. No gap is above {:.6g}.",
                            axis_names[static_cast<std::size_t>(*untested_axis_)], greatest_gap_));
        else if (false_positives_ > 0 && false_negatives_ == 0 && !only_near_)
            texts.push_back(
                fmt::format("No pair is missing, and no false positive has a gap above {:.6g}: the list may "
                            "be of boxes that are grown by a margin.",
                            greatest_gap_));
        if (common_ && false_negatives_ + false_positives_ > 2)
            for (const std::uint32_t id : *common_)
                texts.push_back(fmt::format("Object {} is in every wrong pair.", id));
        return texts;
    }

private:
    std::uint64_t false_negatives_ = 0, false_positives_ = 0;
    double greatest_gap_ = 0;
    bool only_touching_ = true, only_near_ = true;
    std::optional<int> untested_axis_;                  // -1 if there are several
    std::optional<std::vector<std::uint32_t>> common_;  // objects of all wrong pairs
};

}  // namespace

check_result check_boxes(scene_frames& scene, pair_list list) {
    if (!list.has_frames && scene.frames() > 1)
        throw aabb::input_error(fmt::format(
            "the list has no frames, but the scene has {}: expected the columns frame,a,b", grouped(scene.frames())));
    const auto objects = scene.objects();
    search_method method =
        method_of({.stages = {aabb::stage::global_search}, .named = {}, .engine = {}}, traits_of(scene));
    stage_runner searcher(std::move(method.run_stages), scene);
    double search_ms = 0;
    const wall_stopwatch preparing;
    list_comparison comparison(std::move(list), {scene.frames(), objects, objects, /*is_symmetric=*/true});
    double check_ms = preparing.ms();
    std::vector<class_counts> classes;
    for (std::size_t c = 0; c < class_names.size(); ++c) classes.push_back({std::string(class_names[c])});
    box_patterns patterns;
    std::vector<wrong_pair> first;
    progress shown("frames checked", scene.frames());
    run_frames(scene, searcher, [&](const searched_frame& frame) {
        search_ms += frame.ms();
        const auto gap = [&](aabb::index_pair pair) {
            return scene.boxes_in_double().empty()
                       ? gap_of<float>(scene.boxes()[pair.a], scene.boxes()[pair.b])
                       : gap_of<double>(scene.boxes_in_double()[pair.a], scene.boxes_in_double()[pair.b]);
        };
        const auto shape = [&](std::uint32_t id) {
            return scene.boxes_in_double().empty() ? shape_of(id, scene.boxes()[id])
                                                   : shape_of(id, scene.boxes_in_double()[id]);
        };
        const wall_stopwatch checking;
        comparison.compare(frame.pairs, [&](const wrong_pair& wrong) {
            const box_gap g = gap(wrong.pair);
            class_counts& counts = classes[class_of(g)];
            ++(wrong.is_listed ? counts.false_positives : counts.false_negatives);
            patterns.add(wrong, g);
            if (first.size() == most_shown) return;
            first.push_back(wrong);
            first.back().description = description_of(g);
            first.back().shapes = {shape(wrong.pair.a), shape(wrong.pair.b)};
        });
        check_ms += checking.ms();
        shown.update(frame.number + 1);
    });
    check_result result = comparison.result(patterns.sentences());
    result.classes = std::move(classes);
    result.first = std::move(first);
    result.search_ms = search_ms;
    result.check_ms = check_ms;
    return result;
}

}  // namespace aabblab
