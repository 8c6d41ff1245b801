module aabblab.measures;

import aabb.collision_filter;
import aabb.pipeline;
import aabb.prepare.mean_extent;
import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.output;

namespace aabblab {

namespace {

constexpr std::size_t frames_measured = 4;

constexpr std::array motion_members{&motion_measures::displacement, &motion_measures::relative_displacement,
                                    &motion_measures::at_rest, &motion_measures::inversions};

struct recorded_frame {
    std::vector<aabb::box> boxes;
    std::vector<bool> present;

    [[nodiscard]] std::vector<aabb::box> present_boxes() const {
        std::vector<aabb::box> result;
        for (std::size_t id = 0; id < boxes.size(); ++id)
            if (present[id]) result.push_back(boxes[id]);
        return result;
    }
};

/// Adds the motion of the objects that are present in both frames.
void add_motion(scene_measures& m, recorded_frame before, recorded_frame after, std::size_t axis) {
    for (std::size_t id = 0; id < before.present.size(); ++id)
        before.present[id] = after.present[id] = before.present[id] && after.present[id];
    const motion_measures motion = measure_motion(before.present_boxes(), after.present_boxes(), axis);
    if (!m.motion) m.motion = motion_measures{0, 0, 0, 0};
    for (const auto member : motion_members) *m.motion.*member += motion.*member;
}

/// Counts overlapping pairs of n intervals in O(n log n): all n (n - 1) / 2 pairs but those in which one interval ends
/// before the other begins.
/// @param lower, upper the ends of the intervals, each list in any order
double overlapping_pairs(std::vector<float> lower, std::vector<float> upper) {
    std::ranges::sort(lower);
    std::ranges::sort(upper);
    const auto n = static_cast<double>(lower.size());
    double disjoint = 0;
    std::size_t ended = 0;  // intervals that end before `begin`
    for (const float begin : lower) {
        while (ended < upper.size() && upper[ended] < begin) ++ended;
        disjoint += static_cast<double>(ended);
    }
    return n * (n - 1) / 2 - disjoint;
}

double longest_edge(const aabb::box& b) {
    const auto edge = [&](int k) { return double{b.max[k]} - double{b.min[k]}; };
    return std::max({edge(0), edge(1), edge(2)});
}

/// The pairs of overlapping boxes, whatever a filter keeps.
std::vector<aabb::index_pair> unfiltered_pairs(const recorded_frame& frame) {
    const auto search = aabb::compose_global_search(/*c=*/{}, aabb::instrumentation::none);
    for (std::uint32_t id = 0; id < frame.boxes.size(); ++id)
        if (frame.present[id]) search->insert(id);
    std::vector<aabb::index_pair> pairs;
    search->update(frame.boxes);
    search->search(pairs);
    return pairs;
}

/// The longest edge of all boxes over the median of their longest edges; empty if that is 0.
std::optional<double> size_ratio_of(std::span<const aabb::box> boxes) {
    std::vector<double> edges;
    for (const aabb::box& b : boxes) edges.push_back(longest_edge(b));
    const double longest = *std::ranges::max_element(edges);
    const auto median = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::ranges::nth_element(edges, median);
    return *median > 0 ? std::optional(longest / *median) : std::nullopt;
}

/// Inversions per object: pairs of boxes whose order along the axis changed, the swaps of an insertion sort.
double inversions_of(std::span<const aabb::box> before, std::span<const aabb::box> after, int axis) {
    std::vector<std::uint32_t> order(before.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t id) { return before[id].min[axis]; });
    std::vector<aabb::projection> list;
    for (const std::uint32_t id : order) list.push_back({after[id].min[axis], id});
    aabb::inversion_counter counter;
    return static_cast<double>(counter.count(list)) / static_cast<double>(list.size());
}

}  // namespace

/// Measures sizes and overlaps of boxes, and the pairs that uniformly distributed boxes would have: on an axis, two
/// intervals of mean length e in a range of width w overlap with a probability of about 2 e / w.
box_measures measure_boxes(std::span<const aabb::box> boxes) {
    box_measures m;
    if (boxes.empty()) return m;
    const auto n = static_cast<double>(boxes.size());
    m.size_ratio = size_ratio_of(boxes);
    m.expected_pairs = n * (n - 1) / 2;
    aabb::typical_extent extents_of_boxes;
    for (const aabb::box& b : boxes) extents_of_boxes.add(b);
    m.typical_extent = extents_of_boxes();
    for (int k = 0; k < 3; ++k) {
        std::vector<float> lower, upper;
        double extents = 0;  // their sum over the boxes
        for (const aabb::box& b : boxes) {
            lower.push_back(b.min[k]);
            upper.push_back(b.max[k]);
            extents += double{b.max[k]} - double{b.min[k]};
        }
        const double width = double{*std::ranges::max_element(upper)} - double{*std::ranges::min_element(lower)};
        if (width > 0) m.expected_pairs *= std::min(1.0, 2 * extents / n / width);
        m.overlaps[static_cast<std::size_t>(k)] = 2 * overlapping_pairs(std::move(lower), std::move(upper)) / n;
    }
    return m;
}

/// Measures the motion of the same boxes from one frame to the next. The relative displacement is without the common
/// motion, which is the middle of all displacements along an axis: half of their range remains.
/// @param axis along which inversions are counted
motion_measures measure_motion(std::span<const aabb::box> before, std::span<const aabb::box> after, std::size_t axis) {
    motion_measures m;
    if (before.empty()) return m;
    const auto n = static_cast<double>(before.size());
    double displacements = 0, moved = 0;
    std::vector<double> squares(before.size());  // of the displacement of each centre
    for (int k = 0; k < 3; ++k) {
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const double lower = double{after[i].min[k]} - double{before[i].min[k]};
            const double upper = double{after[i].max[k]} - double{before[i].max[k]};
            squares[i] += (lower + upper) * (lower + upper) / 4;
            least = std::min(least, lower);
            most = std::max(most, upper);
        }
        m.relative_displacement = std::max(m.relative_displacement, (most - least) / 2);
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        displacements += std::sqrt(squares[i]);
        moved += before[i] == after[i] ? 0 : 1;
    }
    m.displacement = displacements / n;
    m.at_rest = 1 - moved / n;
    m.inversions = inversions_of(before, after, static_cast<int>(axis));
    return m;
}

scene_measures measure_scene(const scene_choice& choice) {
    scene_frames scene(choice);
    return measure_scene(scene);
}

/// Measures the boxes of the first frame, and the mean motion and overlapping pairs of the first frames.
scene_measures measure_scene(scene_frames& scene) {
    scene_measures m;
    m.objects = scene.objects();
    m.frames = scene.frames();
    if (scene.meshes()) m.triangles = traits_of(scene).triangles;
    stage_runner runner(candidate_of(aabb::composition(), scene.meshes() != nullptr), scene,
                        aabb::instrumentation::none);
    recorded_frame before;
    std::size_t axis = 0;
    double changes = 0;
    std::size_t steps = 0;
    run_frames(
        scene, runner,
        [&](const searched_frame& frame) {
            // Objects are present from their arrival to their departure; those of meshes from the beginning.
            recorded_frame current{{runner.boxes().begin(), runner.boxes().end()}, before.present};
            current.present.resize(current.boxes.size(), scene.meshes() != nullptr);
            for (const std::uint32_t id : scene.arrivals()) current.present[id] = true;
            for (const std::uint32_t id : scene.departures()) current.present[id] = false;
            if (frame.number == 0) {
                const std::vector<aabb::box> boxes = current.present_boxes();
                m.boxes = measure_boxes(boxes);
                m.present = boxes.size();
                auto pairs = static_cast<double>(frame.pairs.size());
                if (scene.filter() && !boxes.empty()) {
                    std::vector<aabb::index_pair> overlapping = unfiltered_pairs(current);
                    pairs = static_cast<double>(overlapping.size());
                    scene.filter()->apply(overlapping);
                    m.kept = pairs > 0 ? static_cast<double>(overlapping.size()) / pairs : 1;
                }
                m.pairs_per_object = pairs / static_cast<double>(std::max<std::size_t>(boxes.size(), 1));
                m.clustering = m.boxes.expected_pairs > 0 ? pairs / m.boxes.expected_pairs : 0;
                axis = static_cast<std::size_t>(std::ranges::min_element(m.boxes.overlaps) - m.boxes.overlaps.begin());
            } else {
                add_motion(m, before, current, axis);
                changes += static_cast<double>(scene.arrivals().size() + scene.departures().size());
                ++steps;
            }
            before = std::move(current);
        },
        frames_measured);
    if (steps > 0) {
        for (const auto member : motion_members) *m.motion.*member /= static_cast<double>(steps);
        m.turnover = changes / static_cast<double>(steps) / static_cast<double>(std::max<std::size_t>(m.objects, 1));
    }
    return m;
}

/// The measures as rows to print, with lengths in typical extents (mean edges of a box), to compare any scales.
table measures_table(const scene_measures& m) {
    table measured = empty_table({"measured", ""});
    const auto add = [&](const char* name, const std::string& value) { measured.rows.push_back({name, value}); };
    add("objects", grouped(m.objects));
    add("frames", m.frames > frames_measured ? fmt::format("{}; sizes and pairs from frame 0, motion from 0 to {}",
                                                           grouped(m.frames), frames_measured - 1)
                                             : grouped(m.frames));
    if (m.present != m.objects) add("present", grouped(m.present) + " of them in the first frame");
    if (m.triangles) add("triangles", grouped(*m.triangles) + " in the meshes");
    const auto& o = m.boxes.overlaps;
    add("overlaps", fmt::format("a box overlaps {:.3g}, {:.3g}, {:.3g} others on x, y, z", o[0], o[1], o[2]));
    for (std::size_t k = 0; k < 3; ++k)
        if (m.present > 2 && o[k] > 0.999 * static_cast<double>(m.present - 1))  // boxes overlap nearly all others
            add("flat axis", std::string(1, "xyz"[k]));
    add("size ratio", (m.boxes.size_ratio ? fmt::format("{:.3g}", *m.boxes.size_ratio) : "-") +
                          ", the longest of all edges over the median box's longest");
    add("pairs", fmt::format("{:.3g} overlapping pairs per object", m.pairs_per_object));
    add("clustering", fmt::format("{:.3g} times the pairs of uniformly distributed boxes", m.clustering));
    if (m.kept) add("filter", fmt::format("keeps {:.3g} % of the overlapping pairs", 100 * *m.kept));
    if (!m.motion) return measured;
    const double unit = m.boxes.typical_extent > 0 ? m.boxes.typical_extent : 1;
    const char* unit_name = m.boxes.typical_extent > 0 ? "typical extents" : "units";
    if (m.boxes.typical_extent > 0)
        add("unit", fmt::format("typical extent: {:.3g}, the mean edge without outliers", m.boxes.typical_extent));
    add("displacement", fmt::format("{:.3g} {} per frame, the mean", m.motion->displacement / unit, unit_name));
    add("own motion", fmt::format("{:.3g} {} per frame at most, common motion removed",
                                  m.motion->relative_displacement / unit, unit_name));
    add("inversions", fmt::format("{:.3g} per object per frame, on the {} axis", m.motion->inversions,
                                  "xyz"[std::ranges::min_element(o) - o.begin()]));
    add("at rest", fmt::format("{:.3g} % of the objects", 100 * m.motion->at_rest));
    if (m.turnover > 0) add("turnover", fmt::format("{:.3g} % of the objects come or go per frame", 100 * m.turnover));
    return measured;
}

std::string heading_of(const scene_choice& scene) {
    return scene.kind + " (" + visible(parameters_text(scene)) + ")";
}

}  // namespace aabblab
