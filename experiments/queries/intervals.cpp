module aabblab.queries;

import aabb.distance_stages;
import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The frame in which two objects are nearest to each other, and their distance there.
struct nearest_frame {
    std::uint32_t frame;
    double distance, error;
};

/// Consecutive frames in contact, and the place of one of the first contacts.
struct contact_frames {
    std::uint32_t first, last;
    aabb::index_pair triangles;
    aabb::vec3d point;  ///< of the first object
    double point_error;
};

/// Frames without contact, then frames in contact; either may be missing.
struct interval {
    std::optional<nearest_frame> before;
    std::optional<contact_frames> contact;
};

struct object_pair {
    std::uint32_t a, b;
    std::vector<interval> intervals = std::vector<interval>(1);  ///< the last one goes on
};

std::vector<object_pair> pairs_of(const scene_frames& scene, const aabb::collision_filter* filter) {
    constexpr std::size_t most = 500'000;
    const auto objects = static_cast<std::uint32_t>(scene.objects());
    std::vector<object_pair> pairs;
    for (std::uint32_t a = 0; a < objects; ++a)
        for (std::uint32_t b = a + 1; b < objects; ++b) {
            if (filter != nullptr && !filter->keeps(a, b)) continue;
            if (pairs.size() == most)
                throw aabb::input_error(fmt::format(
                    "--intervals follows at most {} pairs of objects; leave pairs out by --groups or --except",
                    grouped(most)));
            pairs.push_back({a, b});
        }
    return pairs;
}

/// The cells behind the two objects; empty where there is nothing.
std::string cells_of(const interval& of) {
    const auto& [before, contact] = of;
    return (before ? fmt::format("{},{},{},", before->frame, before->distance, before->error) : ",,,") +
           (contact ? fmt::format("{},{},{},{},{},{}", contact->first, contact->last, contact->triangles.a,
                                  contact->triangles.b, fmt::join(contact->point.at, ","), contact->point_error)
                    : ",,,,,,,");
}

}  // namespace

struct contact_intervals::state {
    const scene_frames& scene;
    number_table& rows;
    std::unique_ptr<aabb::distance_stage> distances;
    std::vector<object_pair> pairs;

    [[nodiscard]] std::uint32_t mesh_of(std::uint32_t object) const { return scene.meshes()->mesh_of[object]; }

    /// The beginning of a contact. Its point is common to the triangles, or nearest to the other one of two that do not
    /// intersect.
    [[nodiscard]] contact_frames begun_at(std::uint32_t frame, const aabb::contact& c) const {
        const auto triangle = [&](std::uint32_t object, std::uint32_t number) {
            return scene.meshes()->meshes[mesh_of(object)].given_triangle(number);
        };
        const aabb::measured_distance at =
            measured({scene.poses()[c.a], scene.poses()[c.b]}, triangle(c.a, c.triangle_a), triangle(c.b, c.triangle_b),
                     /*most=*/std::numeric_limits<double>::infinity());
        return {frame, frame, {c.triangle_a, c.triangle_b}, at.p, at.point_error};
    }

    /// Keeps the frame if the objects are nearer in it than in the frames before it since their last contact.
    void measure(std::uint32_t frame, const object_pair& pair, std::optional<nearest_frame>& nearest) const {
        const double most = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
        if (const auto nearer = distances->distance_below(mesh_of(pair.a), scene.poses()[pair.a], mesh_of(pair.b),
                                                          scene.poses()[pair.b], most))
            nearest = {frame, nearer->distance, nearer->error};
    }
};

contact_intervals::contact_intervals(const scene_frames& scene, const aabb::named_strategies& named,
                                     const aabb::collision_filter* filter, number_table& rows)
    : state_(std::make_unique<state>(state{scene, rows, nullptr, pairs_of(scene, filter)})) {
    state_->distances = aabb::compose_distance(select_composition(named, traits_of(scene)));
    for (const aabb::mesh& m : scene.meshes()->meshes) state_->distances->add_model(m);
}

contact_intervals::~contact_intervals() = default;

void contact_intervals::add(std::uint32_t frame, std::span<const aabb::contact> contacts) {
    for (object_pair& pair : state_->pairs) {
        const auto is_of_earlier = [&](const aabb::contact& c) {
            return std::pair(c.a, c.b) < std::pair(pair.a, pair.b);
        };
        while (!contacts.empty() && is_of_earlier(contacts.front())) contacts = contacts.subspan(1);
        const bool in_contact = !contacts.empty() && contacts.front().a == pair.a && contacts.front().b == pair.b;
        if (!in_contact && pair.intervals.back().contact) pair.intervals.emplace_back();
        interval& current = pair.intervals.back();
        if (!in_contact) {
            state_->measure(frame, pair, current.before);
            continue;
        }
        if (!current.contact) current.contact = state_->begun_at(frame, contacts.front());
        current.contact->last = frame;
    }
}

void contact_intervals::write() {
    for (const object_pair& pair : state_->pairs)
        for (const interval& of : pair.intervals) state_->rows.add({pair.a, pair.b}, cells_of(of));
    state_->rows.commit();
}

}  // namespace aabblab
