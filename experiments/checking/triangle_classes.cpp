module aabblab.checking;

import :triangle_classes;
import aabb.distance;
import aabb.truth;
import aabblab.fmt;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Wrong pairs beyond these are counted only: a class takes exact arithmetic, about a tenth of a millisecond.
constexpr std::uint64_t most_classified = 10'000;

constexpr std::array<std::string_view, 3> names_of_distances{"intersecting", "at most D", "farther than D"};
constexpr std::string_view left_out = "left out by the filter";

std::string shape_of(const posed_surface& of, std::uint32_t id) {
    const aabb::triangle3d t = of.mesh.given_triangle(id);
    std::string decimals, hexadecimals;
    for (int i = 0; i < 3; ++i) {
        decimals += fmt::format(" ({}, {}, {})", t[i][0], t[i][1], t[i][2]);
        hexadecimals += fmt::format(" ({:a}, {:a}, {:a})", t[i][0], t[i][1], t[i][2]);
    }
    return fmt::format("{} {}:{}; in hexadecimal{}", of.name, id, decimals, hexadecimals);
}

/// An index into `difference_class_names`.
/// @param touching whether pairs count that only touch; if not, a false positive that intersects is such a pair
std::size_t class_of(const wrong_pair& wrong, const posed_surface& a, const posed_surface& b, bool touching) {
    if (!touching && wrong.is_listed &&
        hit_geometry(a.mesh, a.pose, b.mesh, b.pose).kind(wrong.pair) != aabb::intersection_kind::none)
        return static_cast<std::size_t>(aabb::difference_class::touching);
    const std::span<const aabb::index_pair> pair(&wrong.pair, 1), none;
    const aabb::differences counts = aabb::compare_triangle_pairs(
        wrong.is_listed ? none : pair, wrong.is_listed ? pair : none, a.mesh, a.pose, b.mesh, b.pose);
    const auto& of_kind = wrong.is_listed ? counts.false_positives : counts.false_negatives;
    return static_cast<std::size_t>(std::ranges::find(of_kind, std::size_t{1}) - of_kind.begin());
}

/// The distance of the triangles, rounded; empty if it is out of the range that can be measured.
std::optional<double> distance_of(const wrong_pair& wrong, const posed_surface& a, const posed_surface& b) try {
    const aabb::pose_pair poses{a.pose, b.pose};
    return aabb::measured(poses, a.mesh.given_triangle(wrong.pair.a), b.mesh.given_triangle(wrong.pair.b),
                          std::numeric_limits<double>::infinity())
        .value;
} catch (const aabb::input_error&) {
    return std::nullopt;
}

}  // namespace

triangle_classes::triangle_classes(const std::optional<nearness>& within, bool touching)
    : within_(within), touching_(touching) {
    const auto add_names = [this](std::span<const std::string_view> names) {
        for (const std::string_view name : names) counts_.push_back({std::string(name)});
    };
    if (within)
        add_names(names_of_distances);
    else
        add_names(aabb::difference_class_names);
}

/// Counts the pair; whether it is too late to be classified.
bool triangle_classes::is_beyond_most() {
    return ++wrong_pairs_ > most_classified;
}

void triangle_classes::count(std::size_t kind, const wrong_pair& wrong) {
    ++(wrong.is_listed ? counts_[kind].false_positives : counts_[kind].false_negatives);
}

void triangle_classes::show(wrong_pair wrong) {
    if (first_.size() < most_shown) first_.push_back(std::move(wrong));
}

void triangle_classes::add(wrong_pair wrong, const posed_surface& a, const posed_surface& b) {
    if (is_beyond_most()) return;
    const wall_stopwatch classifying;
    if (within_) {
        // Whether it is near was decided exactly before.
        const std::optional<double> distance = distance_of(wrong, a, b);
        count(distance == 0.0 ? 0 : wrong.is_listed ? 2 : 1, wrong);
        wrong.description = distance ? fmt::format("a distance of {:.6g}", *distance) : "a distance out of range";
    } else {
        const std::size_t kind = class_of(wrong, a, b, touching_);
        count(kind, wrong);
        wrong.description = aabb::difference_class_names[kind];
    }
    wrong.shapes = {shape_of(a, wrong.pair.a), shape_of(b, wrong.pair.b)};
    show(std::move(wrong));
    ms_ += classifying.ms();
}

void triangle_classes::add_left_out(wrong_pair wrong) {
    if (is_beyond_most()) return;
    if (counts_.back().name != left_out) counts_.push_back({std::string(left_out)});
    ++counts_.back().false_positives;
    wrong.description = left_out;
    show(std::move(wrong));
}

void triangle_classes::add_to(check_result& result) const {
    result.classes = counts_;
    result.unclassified = wrong_pairs_ - std::min(wrong_pairs_, most_classified);
    result.first = first_;
    const auto is_used = [](const class_counts& c) { return c.false_negatives + c.false_positives > 0; };
    if (!result.patterns.empty() || wrong_pairs_ < 2 || result.unclassified > 0 ||
        std::ranges::count_if(counts_, is_used) != 1)
        return;
    if (const std::string& name = std::ranges::find_if(counts_, is_used)->name; name != "other")
        result.patterns.push_back(fmt::format("All wrong pairs are of one class: {}.", name));
}

}  // namespace aabblab
