module aabblab.checking;

import :box_classes;
import aabb.distance;
import aabblab.fmt;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 5> names_of_gaps{"touching", "within 1 unit in the last place", "within 4",
                                                        "within 16", "beyond 16"};
constexpr std::size_t beyond_16 = 4;
constexpr std::array<std::string_view, 4> names_of_distances{"overlapping or touching", "nearer than D",
                                                             "at D, to 4 units in the last place", "farther than D"};
constexpr std::size_t at_distance = 2;
constexpr std::string_view left_out = "left out by the filter";
constexpr std::string_view axis_names = "xyz";

template <class Box>
using real_of = std::remove_cvref_t<decltype(std::declval<Box>().min[0])>;

/// The unit in the last place of a number that is not negative, in its precision.
template <class Real>
double unit_of(double x) {
    return double{std::nextafter(static_cast<Real>(x), std::numeric_limits<Real>::infinity())} - x;
}

template <class Box>
box_gap gap_of(const Box& a, const Box& b) {
    box_gap widest;
    for (int k = 0; k < 3; ++k) {
        // One of the two boxes begins later, one ends earlier; the difference of floats is exact in double but for
        // extreme exponents, and its sign always.
        const double gap = std::max(double{a.min[k]}, double{b.min[k]}) - std::min(double{a.max[k]}, double{b.max[k]});
        widest.axes |= static_cast<unsigned>(gap > 0) << k;
        if (gap <= widest.gap) continue;
        widest.axis = k;
        widest.gap = gap;
    }
    const int k = widest.axis;
    widest.greatest =
        std::max(std::max(std::abs(a.min[k]), std::abs(a.max[k])), std::max(std::abs(b.min[k]), std::abs(b.max[k])));
    return widest;
}

using four_doubles = double __attribute__((vector_size(32)));
using four_flags = std::int64_t __attribute__((vector_size(32)));  // result of a comparison: -1 in lanes that hold

/// Four of the six coordinates of a box, in their order.
template <class Box>
[[gnu::always_inline]] inline auto four_coordinates(const Box& b, std::size_t first) {
    static_assert(sizeof(Box) == 6 * sizeof(real_of<Box>));
    using four_reals = real_of<Box> __attribute__((vector_size(4 * sizeof(real_of<Box>))));
    four_reals coordinates;
    std::memcpy(&coordinates, reinterpret_cast<const std::byte*>(&b) + first * sizeof(real_of<Box>),
                sizeof coordinates);
    return coordinates;
}

/// The gaps on x, y and z, as `gap_of` computes them; the last lane has that on z again.
template <class Box>
[[gnu::always_inline]] inline four_doubles gaps_of_axes(const Box& a, const Box& b) {
    const auto low_a = four_coordinates(a, 0), low_b = four_coordinates(b, 0);
    const auto high_a = four_coordinates(a, 2), high_b = four_coordinates(b, 2);
    const auto begin = low_a > low_b ? low_a : low_b;
    const auto end = high_a < high_b ? high_a : high_b;
    return __builtin_convertvector(__builtin_shufflevector(begin, begin, 0, 1, 2, 2), four_doubles) -
           __builtin_convertvector(__builtin_shufflevector(end, end, 1, 2, 3, 3), four_doubles);
}

/// 16 units in the last place of the greatest coordinate of all boxes. Nearly all gaps are wider, so that they are
/// beyond 16 units of any coordinate, whichever axis they are on.
template <class Box>
double sixteen_greatest_units(std::span<const Box> boxes) {
    using limits = std::numeric_limits<real_of<Box>>;
    const auto zero = four_coordinates(Box{}, 0);
    auto greatest = zero;
    for (const Box& b : boxes)
        for (const std::size_t first : {std::size_t{0}, std::size_t{2}}) {
            const auto coordinates = four_coordinates(b, first);
            const auto size = coordinates < zero ? -coordinates : coordinates;
            greatest = size > greatest ? size : greatest;
        }
    const double most = std::max(std::max(greatest[0], greatest[1]), std::max(greatest[2], greatest[3]));
    return 16 * std::max(double{limits::epsilon()} * most, double{limits::denorm_min()});
}

/// With the distance, which is Euclidean and rounded.
template <class Box>
box_gap distant_gap_of(const Box& a, const Box& b) {
    box_gap widest = gap_of(a, b);
    std::array<double, 3> gaps{};
    for (int k = 0; k < 3; ++k)
        gaps[static_cast<std::size_t>(k)] =
            std::max({0.0, double{a.min[k]} - double{b.max[k]}, double{b.min[k]} - double{a.max[k]}});
    widest.distance = std::hypot(gaps[0], gaps[1], gaps[2]);
    return widest;
}

bool overlap_in_float(const aabb::boxd& a, const aabb::boxd& b) {
    for (int k = 0; k < 3; ++k)
        if (static_cast<float>(a.min[k]) > static_cast<float>(b.max[k]) ||
            static_cast<float>(b.min[k]) > static_cast<float>(a.max[k]))
            return false;
    return true;
}

char axis_name(int axis) {
    return axis_names[static_cast<std::size_t>(axis)];
}

/// A box in decimal and in hexadecimal.
template <class Box>
std::string shape_of(std::uint32_t id, const Box& b) {
    std::string decimals, hexadecimals;
    for (int k = 0; k < 3; ++k) {
        const std::string before = fmt::format("{}{} ", k == 0 ? "" : ", ", axis_name(k));
        decimals += fmt::format("{}{} to {}", before, b.min[k], b.max[k]);
        hexadecimals += fmt::format("{}{:a} to {:a}", before, b.min[k], b.max[k]);
    }
    return fmt::format("{}: {}; in hexadecimal {}", id, decimals, hexadecimals);
}

}  // namespace

box_classes::box_classes(const std::optional<nearness>& within, const aabb::collision_filter* filter)
    : within_(within), filter_(filter) {
    const auto add_names = [this](std::span<const std::string_view> names) {
        for (const std::string_view name : names) counts_.push_back({std::string(name)});
    };
    if (within)
        add_names(names_of_distances);
    else
        add_names(names_of_gaps);
    if (filter) counts_.push_back({std::string(left_out)});
}

/// The distance by the metric of the list, rounded.
double box_classes::distance_of(const box_gap& g) const {
    return within_->metric == aabb::box_metric::axis ? std::max(g.gap, 0.0) : g.distance;
}

/// The class of a pair, which the filter keeps.
template <class Real>
std::size_t box_classes::class_of(const box_gap& g) const {
    if (within_) {
        if (g.gap <= 0) return 0;
        const double distance = distance_of(g);
        if (std::abs(distance - within_->d) <= 4 * unit_of<double>(within_->d)) return at_distance;
        return distance < within_->d ? 1 : 3;
    }
    if (g.gap == 0) return 0;
    // Most pairs are so far from touching that their unit, which takes longer, does not matter.
    using limits = std::numeric_limits<Real>;
    if (g.greatest >= limits::min() && std::abs(g.gap) > 16 * double{limits::epsilon()} * g.greatest) return beyond_16;
    const double units = std::abs(g.gap) / unit_of<Real>(g.greatest);
    return units <= 1 ? 1 : units <= 4 ? 2 : units <= 16 ? 3 : beyond_16;
}

bool box_classes::is_left_out(aabb::index_pair pair) const {
    return filter_ && !filter_->keeps(pair.a, pair.b);
}

/// Keeps of the common objects those that are in all pairs.
void box_classes::narrow_common(std::span<const aabb::index_pair> pairs) {
    if (!common_ && !pairs.empty()) common_ = {pairs[0].a, pairs[0].b};
    for (std::size_t i = 0; i < pairs.size() && !common_->empty(); ++i)
        std::erase_if(*common_, [&](std::uint32_t id) { return id != pairs[i].a && id != pairs[i].b; });
}

template <class Box>
void box_classes::count_false_negative(const Box& a, const Box& b) {
    const box_gap g = within_ ? distant_gap_of(a, b) : gap_of(a, b);
    const std::size_t kind = class_of<real_of<Box>>(g);
    ++counts_[kind].false_negatives;
    ++false_negatives_;
    only_near_ &= kind < beyond_16;
    only_touching_ &= g.gap == 0;
    only_at_distance_ &= kind == at_distance;
    is_of_other_metric_ &= within_ && within_->metric == aabb::box_metric::axis && g.distance > within_->d;
}

template <class Box>
void box_classes::count_false_positive(const Box& a, const Box& b) {
    const box_gap g = within_ ? distant_gap_of(a, b) : gap_of(a, b);
    const std::size_t kind = class_of<real_of<Box>>(g);
    ++counts_[kind].false_positives;
    ++false_positives_;
    only_near_ &= kind < beyond_16;
    greatest_gap_ = std::max(greatest_gap_, g.gap);
    all_gaps_ |= g.axes;
    common_gaps_ &= g.axes;
    is_of_other_metric_ &= within_ && within_->metric == aabb::box_metric::euclidean && g.gap <= within_->d;
}

/// Classifies many pairs that overlap, as `count_false_negative` does each.
template <class Box>
void box_classes::count_false_negatives(std::span<const aabb::index_pair> pairs, std::span<const Box> boxes) {
    const four_doubles none{}, sixteen_units = none + sixteen_greatest_units(boxes);
    std::uint64_t touching = 0, far = 0;
    for (const aabb::index_pair& pair : pairs) {
        const Box &a = boxes[pair.a], &b = boxes[pair.b];
        const four_doubles gaps = gaps_of_axes(a, b);
        if (__builtin_reduce_or(gaps >= -sixteen_units) == 0)
            ++far;
        else if (__builtin_reduce_or(gaps == none) != 0)
            ++touching;
        else
            count_false_negative(a, b);
    }
    counts_[0].false_negatives += touching;
    counts_[beyond_16].false_negatives += far;
    false_negatives_ += touching + far;
    only_near_ &= far == 0;
    only_touching_ &= far == 0;
}

/// Classifies many pairs that do not overlap, as `count_false_positive` does each.
template <class Box>
void box_classes::count_false_positives(std::span<const aabb::index_pair> pairs, std::span<const Box> boxes) {
    const four_doubles none{}, sixteen_units = none + sixteen_greatest_units(boxes);
    four_doubles greatest_gaps{};
    four_flags any_gaps{}, common_gaps = ~any_gaps;
    std::uint64_t far = 0;
    for (const aabb::index_pair& pair : pairs) {
        const Box &a = boxes[pair.a], &b = boxes[pair.b];
        const four_doubles gaps = gaps_of_axes(a, b);
        if (__builtin_reduce_or(gaps > sixteen_units) == 0) {
            count_false_positive(a, b);
            continue;
        }
        ++far;
        any_gaps |= gaps > none;
        common_gaps &= gaps > none;
        greatest_gaps = gaps > greatest_gaps ? gaps : greatest_gaps;
    }
    if (far == 0) return;
    counts_[beyond_16].false_positives += far;
    false_positives_ += far;
    only_near_ = false;
    for (int k = 0; k < 3; ++k) {
        greatest_gap_ = std::max(greatest_gap_, greatest_gaps[k]);
        all_gaps_ |= static_cast<unsigned>(any_gaps[k] != 0) << k;
        if (common_gaps[k] == 0) common_gaps_ &= ~(1U << k);
    }
}

template <class Box>
void box_classes::count(const frame_errors& errors, std::span<const Box> boxes) {
    // The classes of many pairs begin with a loop over the boxes, which takes about as long as those of an eighth as
    // many pairs one by one.
    const auto are_many = [&](std::span<const aabb::index_pair> pairs) {
        return !within_ && pairs.size() > boxes.size() / 8;
    };
    if (are_many(errors.false_negatives))
        count_false_negatives(errors.false_negatives, boxes);
    else
        for (const auto [a, b] : errors.false_negatives) count_false_negative(boxes[a], boxes[b]);
    if (are_many(errors.false_positives) && !filter_)
        count_false_positives(errors.false_positives, boxes);
    else
        for (const aabb::index_pair& pair : errors.false_positives)
            if (is_left_out(pair)) {
                ++left_out_;
                ++counts_.back().false_positives;
            } else {
                count_false_positive(boxes[pair.a], boxes[pair.b]);
            }
    if constexpr (std::same_as<Box, aabb::boxd>)
        errors.each([&](aabb::index_pair pair, bool is_listed) {
            is_of_floats_ = is_of_floats_ && overlap_in_float(boxes[pair.a], boxes[pair.b]) == is_listed;
            return is_of_floats_;
        });
    else
        is_of_floats_ = false;
    if (first_.size() < most_shown) keep(errors, boxes);
}

/// The gap or the distance of a pair that the filter keeps.
template <class Box>
std::string box_classes::description(const Box& a, const Box& b) const {
    const box_gap g = distant_gap_of(a, b);
    if (within_) return g.gap <= 0 ? "overlapping or touching" : fmt::format("a distance of {:.6g}", distance_of(g));
    if (g.gap == 0) return fmt::format("touching on {}", axis_name(g.axis));
    const double units = std::abs(g.gap) / unit_of<real_of<Box>>(g.greatest);
    const std::string text = units <= 16 ? fmt::format(", {:.2g} units in the last place", units) : "";
    return g.gap > 0 ? fmt::format("a gap of {:.6g} on {}{}", g.gap, axis_name(g.axis), text)
                     : fmt::format("an overlap of {:.6g} on {}{}", -g.gap, axis_name(g.axis), text);
}

/// Keeps the first pairs with their boxes.
template <class Box>
void box_classes::keep(const frame_errors& errors, std::span<const Box> boxes) {
    errors.each([&](aabb::index_pair pair, bool is_listed) {
        first_.push_back({.wrong = {.frame = errors.frame, .pair = pair, .is_listed = is_listed},
                          .boxes = std::array{boxes[pair.a], boxes[pair.b]}});
        return first_.size() < most_shown;
    });
}

void box_classes::add(const frame_errors& errors, const frame_boxes& boxes) {
    narrow_common(errors.false_negatives);
    narrow_common(errors.false_positives);
    if (boxes.in_double.empty())
        count(errors, boxes.in_float);
    else
        count(errors, boxes.in_double);
}

void box_classes::add_to(check_result& result) const {
    result.classes = counts_;
    for (const auto& [wrong, boxes] : first_)
        std::visit(
            [&](const auto& both) {
                const auto& [a, b] = both;
                wrong_pair& w = result.first.emplace_back(wrong);
                w.description = w.is_listed && is_left_out(w.pair) ? std::string(left_out) : description(a, b);
                w.shapes = {shape_of(w.pair.a, a), shape_of(w.pair.b, b)};
            },
            boxes);
}

std::string box_classes::sentence_about_rounding() const {
    if (false_negatives_ > 0 && only_touching_)
        return "Every false negative touches without overlapping: boxes are closed, so that < in place of <= loses "
               "such pairs.";
    if (false_negatives_ + false_positives_ == 0) return {};
    if (is_of_floats_) return "Every wrong pair is right for boxes rounded to float, but the scene is of doubles.";
    if (only_near_)
        return "Every wrong pair is within 16 units in the last place of touching: the list is of rounded boxes.";
    return {};
}

std::string box_classes::sentence_about_gaps() const {
    if (false_positives_ == 0 || only_near_ || is_of_floats_) return {};
    if (std::has_single_bit(all_gaps_) && all_gaps_ == common_gaps_)
        return fmt::format(
            "Every false positive overlaps on the two other axes: {} may not be tested, or "
            "the boxes may be grown on it. No gap is above {:.6g}.",
            axis_name(std::countr_zero(all_gaps_)), greatest_gap_);
    if (false_negatives_ > 0) return {};
    return fmt::format(
        "No pair is missing, and no false positive has a gap above {:.6g}: the list may "
        "be of boxes that are grown by a margin.",
        greatest_gap_);
}

std::string box_classes::sentence_about_distances() const {
    if (false_negatives_ > 0 && only_at_distance_)
        return "Every false negative is at the distance D: it counts, so that < in place of <= loses such pairs.";
    if (false_negatives_ + false_positives_ == 0 || !is_of_other_metric_) return {};
    return within_->metric == aabb::box_metric::axis
               ? "No row is wrong, and the distance of all missing pairs is above D as --metric euclidean has it."
               : "No pair is missing, and no false positive has a gap above D on any axis: the list is of --metric "
                 "axis.";
}

std::vector<std::string> box_classes::sentences() const {
    std::vector<std::string> texts;
    if (within_)
        texts = {sentence_about_distances()};
    else
        texts = {sentence_about_rounding(), sentence_about_gaps()};
    if (left_out_ > 0 && false_positives_ == 0)
        texts.emplace_back("Every false positive is left out by --groups or --except: the list is not filtered.");
    if (common_ && false_negatives_ + false_positives_ + left_out_ > 2)
        for (const std::uint32_t id : *common_) texts.push_back(fmt::format("Object {} is in every wrong pair.", id));
    std::erase(texts, std::string());
    return texts;
}

}  // namespace aabblab
