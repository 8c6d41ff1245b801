#pragma once

#include <random>
#include <set>

#include "../boxes.hpp"

/// What a user says of objects: the same as a `collision_filter`, kept and decided independently of the library.
struct stated_filter {
    std::vector<std::uint32_t> group, mask;
    std::vector<char> set;  ///< 'a', 'b' or 0
    std::vector<bool> rests;
    std::set<std::pair<std::uint32_t, std::uint32_t>> exceptions;  ///< in either order

    explicit stated_filter(std::size_t objects = 0)
        : group(objects, 1), mask(objects, 0xffffffff), set(objects, 0), rests(objects, false) {}

    [[nodiscard]] bool keeps(std::uint32_t a, std::uint32_t b) const {
        const bool any_set = std::ranges::any_of(set, [](char s) { return s != 0; });
        const bool of_both_sets = (set[a] == 'a' && set[b] == 'b') || (set[a] == 'b' && set[b] == 'a');
        bool a_wants_b = false, b_wants_a = false;
        for (int bit = 0; bit < 32; ++bit) {
            const std::uint32_t one_group = std::uint32_t{1} << bit;
            a_wants_b = a_wants_b || ((mask[a] & one_group) != 0 && (group[b] & one_group) != 0);
            b_wants_a = b_wants_a || ((mask[b] & one_group) != 0 && (group[a] & one_group) != 0);
        }
        return a_wants_b && b_wants_a && (!any_set || of_both_sets) && !(rests[a] && rests[b]) &&
               !exceptions.contains({a, b}) && !exceptions.contains({b, a});
    }

    /// Says the same to the library.
    void tell(aabb::collision_filter& filter) const {
        for (std::uint32_t id = 0; id < group.size(); ++id) {
            const auto of_set = set[id] == 'a'   ? aabb::object_set::a
                                : set[id] == 'b' ? aabb::object_set::b
                                                 : aabb::object_set::none;
            filter.set(id, {.group = group[id], .mask = mask[id], .set = of_set, .rests = rests[id]});
        }
        const std::vector<aabb::index_pair> before(filter.exceptions().begin(), filter.exceptions().end());
        filter.remove_exceptions(before);
        std::vector<aabb::index_pair> pairs;
        for (const auto& [a, b] : exceptions) pairs.push_back({a, b});
        filter.add_exceptions(pairs);
    }
};

/// The parts of a filter; the last one is all of them at once.
inline const std::vector<std::string> filter_kinds{"groups", "masks", "sets", "rest", "exceptions", "together"};

/// Changes some objects at random.
inline void draw(stated_filter& filter, const std::string& kind, std::mt19937& random, std::uint32_t one_in = 1) {
    const bool together = kind == "together";
    const auto n = static_cast<std::uint32_t>(filter.group.size());
    for (std::uint32_t id = 0; id < n; ++id) {
        if (random() % one_in != 0) continue;
        if (kind == "groups") {
            filter.group[id] = 1U << random() % 3;
            filter.mask[id] = static_cast<std::uint32_t>(random() % 8);
        }
        if (kind == "masks" || together) {
            // Few bits, also the highest one, so that a good part of the pairs is kept.
            filter.group[id] = static_cast<std::uint32_t>(random() & random() & 0x8000'0107U);
            filter.mask[id] = static_cast<std::uint32_t>(random() | 0x8000'0000U);
        }
        // Sets of very different sizes, or objects without a set.
        if (kind == "sets" || together) filter.set[id] = n % 2 == 0 ? "abbbbbbb"[random() % 8] : "ab\0"[random() % 3];
        if (kind == "rest" || together) filter.rests[id] = random() % 16 != 0;
    }
    if (one_in > 1) std::erase_if(filter.exceptions, [&](const auto&) { return random() % one_in == 0; });
    if ((kind == "exceptions" || together) && n > 1)
        for (std::uint32_t i = 0; i < 2 * n / one_in; ++i) {
            const auto a = static_cast<std::uint32_t>(random() % n);
            const auto b = static_cast<std::uint32_t>((a + 1 + random() % (n - 1)) % n);
            filter.exceptions.insert({a, b});
        }
}

/// A scene of boxes that move, come and go, and whose filter changes, with the pairs that are kept in each frame.
struct filtered_scene {
    struct frame {
        std::vector<aabb::box> boxes;
        std::vector<std::uint32_t> toggled;  ///< objects that come or go
        stated_filter filter;
        std::vector<aabb::index_pair> pairs;
    };
    std::vector<frame> frames;
    bool filter_changes = false;  ///< between frames
};

/// @param most_objects some scenes have as many, some few
inline filtered_scene make_filtered_scene(const std::string& kind, std::uint32_t seed,
                                          std::uint32_t most_objects = 70) {
    std::mt19937 random(seed);
    const std::uint32_t n = seed < 3 ? seed : 3 + static_cast<std::uint32_t>(random() % (most_objects - 2));
    const std::uint32_t side = std::array{3U, 6U, 12U}[random() % 3];
    filtered_scene scene{.frames = {}, .filter_changes = seed % 2 == 0};
    stated_filter filter(n);
    draw(filter, kind, random);
    std::vector<aabb::box> boxes = lattice_boxes(random, n, side);
    std::vector<bool> present(n, false);
    for (int f = 0; f < 12; ++f) {
        auto& frame = scene.frames.emplace_back();
        if (f > 0 && scene.filter_changes) draw(filter, kind, random, 8);
        for (std::uint32_t id = 0; id < n; ++id) {
            // What rests stays where it is, for the most part; nothing promises that.
            const bool stays = f > 0 && random() % (filter.rests[id] ? 64 : 4) != 0;
            if (!stays) boxes[id] = lattice_box(random, side, 3);
            if (f == 0 ? random() % 8 != 0 : random() % 16 == 0) {
                frame.toggled.push_back(id);
                present[id] = !present[id];
            }
        }
        frame.boxes = boxes;
        frame.filter = filter;
        for (const aabb::index_pair p : overlapping(boxes, present))
            if (filter.keeps(p.a, p.b)) frame.pairs.push_back(p);
    }
    return scene;
}

/// Twenty scenes of each kind, made once.
inline const std::vector<filtered_scene>& filtered_scenes(const std::string& kind) {
    static std::map<std::string, std::vector<filtered_scene>> scenes;
    std::vector<filtered_scene>& of_kind = scenes[kind];
    for (std::uint32_t seed = 0; of_kind.size() < 20; ++seed) of_kind.push_back(make_filtered_scene(kind, seed));
    return of_kind;
}

/// In how many frames pairs were found otherwise than by the search of all objects.
struct filter_usage {
    std::size_t indexed = 0;  ///< some objects at rest were in an index
    std::size_t joined = 0;   ///< two sets were joined

    void add(const aabb::global_stage& stage) {
        for (const aabb::stage_plan& plan : stage.plans()) {
            indexed += plan.kind == aabb::plan_kind::resting_index ? 1 : 0;
            joined += plan.kind == aabb::plan_kind::set_join ? 1 : 0;
        }
    }
};

/// Costs by which an index and a join are worth it at once.
inline aabb::cost_model costs_for_indices() {
    aabb::cost_model costs;
    costs.refit_box = costs.open_node = 1e-9;
    return costs;
}

/// Whether a search rejects a frame with an inverted box.
template <class Search>
bool rejects_inverted(Search& search, std::span<const aabb::box> boxes) {
    std::vector<aabb::box> inverted(boxes.begin(), boxes.end());
    inverted.front() = {{1, 1, 1}, {0, 0, 0}};
    try {
        search.update(inverted);
    } catch (const aabb::input_error&) {
        return true;
    }
    return false;
}

/// The first frame in which a search does not find what is kept; -1 if it always does.
/// @param filter that of the search, which is told what the scene says
/// @param after_frame called after each frame
template <class Search, class Call>
int first_wrong_frame(Search& search, aabb::collision_filter& filter, const filtered_scene& scene, Call after_frame) {
    std::vector<bool> present;
    bool any_yet = false;  // before the first object comes there are no boxes
    std::span<const aabb::box> before;
    for (std::size_t f = 0; f < scene.frames.size(); ++f) {
        const filtered_scene::frame& frame = scene.frames[f];
        if (f == 0 || scene.filter_changes) frame.filter.tell(filter);
        present.resize(frame.boxes.size());
        for (const std::uint32_t id : frame.toggled) {
            present[id] ? search.remove(id) : search.insert(id);
            present[id] = !present[id];
        }
        any_yet |= !frame.toggled.empty();
        const auto boxes = std::span(frame.boxes).first(any_yet ? frame.boxes.size() : 0);
        const bool is_rejected_first = f % 5 == 3 && any_yet;
        if (is_rejected_first && !rejects_inverted(search, boxes)) return static_cast<int>(f);
        // Most frames say what has moved. After a rejected one that has no effect.
        std::vector<std::uint32_t> said;
        if (!is_rejected_first) said = ids_of_moved(before, boxes);
        if (f % 3 > 0) search.moved(said);
        before = boxes;
        if (found_by(search, boxes) != frame.pairs) return static_cast<int>(f);
        after_frame();
    }
    return -1;
}

/// The same of a stage behind a filter.
inline int first_wrong_frame(std::unique_ptr<aabb::global_stage> search, const filtered_scene& scene,
                             filter_usage* usage = nullptr) {
    aabb::collision_filter filter;
    const auto stage = filtered(std::move(search), filter);
    return first_wrong_frame(*stage, filter, scene, [&] {
        if (usage) usage->add(*stage);
    });
}
