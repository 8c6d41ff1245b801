module aabblab.queries;

import aabb.build.median;
import aabb.tree.implicit;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.stopwatch;

namespace aabblab {

namespace {

surface_summary summary_of(const aabb::enclosure<aabb::implicit_tree>& mesh, std::optional<bool> intersects_itself) {
    surface_summary summary;
    summary.intersects_itself = intersects_itself;
    for (const aabb::surface_component& part : mesh.parts()) {
        ++summary.components;
        summary.closed += static_cast<std::uint32_t>(part.is_closed());
        summary.oriented += static_cast<std::uint32_t>(part.is_oriented);
        summary.inward += static_cast<std::uint32_t>(part.faces_inward());
        summary.open_edges += part.open_edges;
    }
    return summary;
}

/// Sentences about what is unusual in a surface, such as "1 of 2 components of A is not closed: 3 edges belong to an
/// odd number of triangles".
void add_sentences(const surface_summary& surface, const std::string& name, std::vector<std::string>& sentences) {
    const auto subject = [&](std::uint32_t count, std::string_view one, std::string_view several) {
        if (surface.components == 1) return fmt::format("{} {}", name, one);
        return fmt::format("{} of {} components of {} {}", grouped(count), grouped(surface.components), name,
                           count == 1 ? one : several);
    };
    if (const std::uint32_t open = surface.components - surface.closed; open > 0)
        sentences.push_back(subject(open, "is not closed", "are not closed") + ": " +
                            counted(surface.open_edges, "edge") + (surface.open_edges == 1 ? " belongs" : " belong") +
                            " to an odd number of triangles");
    if (surface.inward > 0) sentences.push_back(subject(surface.inward, "faces inward", "face inward"));
    if (surface.intersects_itself.value_or(false))
        sentences.push_back(name + " touches or crosses itself: inside is what an odd number of components enclose");
}

std::string sentence_about(const mesh_relation& lie) {
    switch (*lie.solids) {
        case aabb::solid_relation::apart:
            // Inside an even number of components.
            if (!lie.a_inside_b.empty()) return "neither lies inside the other, but A has components in a cavity of B";
            if (!lie.b_inside_a.empty()) return "neither lies inside the other, but B has components in a cavity of A";
            return "neither lies inside the other";
        case aabb::solid_relation::a_inside_b: return "A lies inside B";
        case aabb::solid_relation::b_inside_a: return "B lies inside A";
        case aabb::solid_relation::partly_inside: return "components of one lie inside the other, but not all";
        case aabb::solid_relation::not_closed: return "whether one lies inside the other has no answer: not closed";
    }
    __builtin_unreachable();
}

/// How components lie that share a point.
std::string text_of(aabb::contact_relation contact) {
    switch (contact) {
        case aabb::contact_relation::touching: return "touching from outside";
        case aabb::contact_relation::a_inside_b: return "that of A touches that of B from inside";
        case aabb::contact_relation::b_inside_a: return "that of B touches that of A from inside";
        case aabb::contact_relation::equal: return "equal";
        case aabb::contact_relation::crossing: return "crossing";
        case aabb::contact_relation::undecided: return "meeting, but whether they cross is not decided";
    }
    __builtin_unreachable();
}

}  // namespace

struct relation_search::state {
    const aabb::mesh& a;
    const aabb::mesh& b;
    self_query intersects_itself;
    std::optional<std::array<aabb::box, 2>> boxes;  ///< of the floats of A and B, computed once
    /// Of A and B, once a question needs them.
    std::optional<aabb::enclosure<aabb::implicit_tree>> solid_a, solid_b;
    std::vector<surface_summary> surfaces;
    double ms = 0;

    void prepare() {
        if (solid_a) return;
        const aabb::median_build build;
        solid_a.emplace(a, build);
        solid_b.emplace(b, build);
        for (std::uint32_t mesh = 0; mesh < 2; ++mesh) {
            const auto& solid = mesh == 0 ? *solid_a : *solid_b;
            const bool encloses = std::ranges::any_of(solid.parts(), &aabb::surface_component::is_closed);
            surfaces.push_back(summary_of(
                solid, intersects_itself ? std::optional(encloses && intersects_itself(mesh)) : std::nullopt));
        }
    }
};

relation_search::relation_search(const aabb::mesh& a, const aabb::mesh& b, self_query intersects_itself)
    : state_(std::make_unique<state>(a, b, std::move(intersects_itself))) {}
relation_search::~relation_search() = default;

mesh_relation relation_search::at(const aabb::pose& pose_a, const aabb::pose& pose_b) {
    const wall_stopwatch deciding;
    mesh_relation lie{.solids = aabb::solid_relation::apart, .a_inside_b = {}, .b_inside_a = {}, .contacts = {}};
    if (!state_->boxes) state_->boxes = {bounds_of(state_->a), bounds_of(state_->b)};
    const aabb::box box_a = world_bounds((*state_->boxes)[0], pose_a, state_->a.frame);
    const aabb::box box_b = world_bounds((*state_->boxes)[1], pose_b, state_->b.frame);
    // What lies inside lies inside the box.
    if (overlaps(box_a, box_b)) {
        state_->prepare();
        aabb::enclosed_pairs enclosed = relation_of(*state_->solid_a, pose_a, *state_->solid_b, pose_b);
        lie.solids = enclosed.relation;
        lie.a_inside_b = std::move(enclosed.a_inside_b);
        lie.b_inside_a = std::move(enclosed.b_inside_a);
    }
    state_->ms += deciding.ms();
    return lie;
}

mesh_relation relation_search::at(const aabb::pose& pose_a, const aabb::pose& pose_b,
                                  std::span<const aabb::index_pair> hits) {
    const wall_stopwatch deciding;
    state_->prepare();
    const auto &a = *state_->solid_a, &b = *state_->solid_b;
    mesh_relation lie;
    lie.contacts = contacts_of(a, pose_a, b, pose_b, hits,
                               std::ranges::any_of(state_->surfaces, [](const surface_summary& surface) {
                                   return surface.intersects_itself.value_or(false);
                               }));
    std::vector<aabb::index_pair> meeting, meeting_of_b;
    for (const aabb::component_contact& contact : lie.contacts) {
        meeting.push_back({contact.a, contact.b});
        meeting_of_b.push_back({contact.b, contact.a});
    }
    std::ranges::sort(meeting_of_b);
    lie.a_inside_b = enclosed_components(a, pose_a, b, pose_b, meeting);
    for (const auto [of_b, of_a] : enclosed_components(b, pose_b, a, pose_a, meeting_of_b))
        lie.b_inside_a.push_back({of_a, of_b});
    std::ranges::sort(lie.b_inside_a);
    state_->ms += deciding.ms();
    return lie;
}

std::span<const surface_summary> relation_search::surfaces() const {
    return state_->surfaces;
}
double relation_search::ms() const {
    return state_->ms;
}

std::vector<std::string> sentences_about_relations(const mesh_result& result) {
    std::map<std::string, std::uint64_t> poses;  // by sentence
    std::map<aabb::contact_relation, std::uint64_t> contacts;
    for (const std::optional<mesh_relation>& lie : result.relations) {
        if (lie && lie->solids) ++poses[sentence_about(*lie)];
        if (lie)
            for (const aabb::component_contact& contact : lie->contacts) ++contacts[contact.relation];
    }
    std::vector<std::string> sentences;
    for (const auto& [sentence, count] : poses)
        sentences.push_back(result.relations.size() == 1 ? sentence
                                                         : fmt::format("{}: {}", counted(count, "pose"), sentence));
    for (const auto& [relation, count] : contacts)
        sentences.push_back(counted(count, "pair") + " of components: " + text_of(relation));
    for (std::size_t mesh = 0; mesh < result.surfaces.size(); ++mesh)
        add_sentences(result.surfaces[mesh], mesh == 0 ? "A" : "B", sentences);
    return sentences;
}

}  // namespace aabblab
