module aabblab.queries;

import aabb.build.median;
import aabb.tree.implicit;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.stopwatch;

namespace aabblab {

namespace {

using solid = aabb::enclosure<aabb::implicit_tree>;

/// A mesh prepared for relations of both kinds.
struct prepared_surface {
    solid whole;
    aabb::contact_surface<aabb::implicit_tree> contacts{whole};

    explicit prepared_surface(const aabb::mesh& m) : whole(m, aabb::median_build{}) {}
    prepared_surface(const prepared_surface&) = delete;  // since `contacts` refers to `whole`
};

surface_summary summary_of(const prepared_surface& surface) {
    surface_summary summary;
    for (const aabb::surface_component& part : surface.whole.parts()) {
        const std::uint32_t component = summary.components++;
        if (!part.is_closed()) summary.open.push_back(component);
        if (part.is_closed() && !part.is_oriented) summary.unoriented.push_back(component);
        if (part.faces_inward()) summary.inward.push_back(component);
        summary.open_edges += part.open_edges;
    }
    const std::vector<bool>& self_intersecting = surface.contacts.self_intersecting();
    if (self_intersecting.empty()) return summary;
    summary.self_intersecting.emplace();
    for (std::uint32_t component = 0; component < summary.components; ++component)
        if (self_intersecting[component]) summary.self_intersecting->push_back(component);
    return summary;
}

/// Sentences about what is unusual in a surface, such as "component 1 of A is not closed: 3 edges belong to an odd
/// number of triangles".
void add_sentences(const surface_summary& surface, const std::string& name, std::vector<std::string>& sentences) {
    const auto add = [&](const std::vector<std::uint32_t>& components, std::string_view one, std::string_view several,
                         const std::string& reason = "") {
        constexpr std::size_t most_named = 5;
        if (components.empty()) return;
        std::string subject = name;
        if (components.size() > most_named)
            subject =
                fmt::format("{} of {} components of {}", grouped(components.size()), grouped(surface.components), name);
        else if (surface.components > 1)
            subject = fmt::format("component{} {} of {}", components.size() == 1 ? "" : "s",
                                  fmt::join(components, ", "), name);
        sentences.push_back(fmt::format("{} {}{}", subject, components.size() == 1 ? one : several, reason));
    };
    add(surface.open, "is not closed", "are not closed",
        ": " + counted(surface.open_edges, "edge") + (surface.open_edges == 1 ? " belongs" : " belong") +
            " to an odd number of triangles");
    add(surface.unoriented, "is not oriented", "are not oriented", ": triangles at an edge face different ways");
    add(surface.inward, "faces inward", "face inward");
    if (surface.self_intersecting) add(*surface.self_intersecting, "intersects itself", "intersect themselves");
}

std::string sentence_about(const mesh_relation& lie) {
    switch (*lie.solids) {
        case aabb::solid_relation::disjoint:
            // Inside an even number of components.
            if (!lie.a_inside_b.empty()) return "A and B are disjoint, but A has components in a cavity of B";
            if (!lie.b_inside_a.empty()) return "A and B are disjoint, but B has components in a cavity of A";
            return "A and B are disjoint: neither lies inside the other";
        case aabb::solid_relation::a_inside_b: return "A lies inside B";
        case aabb::solid_relation::b_inside_a: return "B lies inside A";
        case aabb::solid_relation::partly_inside:
            return "partly inside: components of one lie inside the other, but not all";
        case aabb::solid_relation::not_closed: return "whether one lies inside the other cannot be decided: not closed";
        case aabb::solid_relation::undecided:
            return "whether one lies inside the other is undecided: components that enclose it face the same way, so "
                   "that it lies in the solid by its winding number, but in a cavity by parity";
    }
    __builtin_unreachable();
}

/// How components lie of which one is inside the other, or that share a point.
std::string_view text_of(aabb::contact_relation contact) {
    switch (contact) {
        case aabb::contact_relation::touching: return "touching";
        case aabb::contact_relation::a_inside_b: return "that of A inside that of B, touching it";
        case aabb::contact_relation::b_inside_a: return "that of B inside that of A, touching it";
        case aabb::contact_relation::equal: return "equal";
        case aabb::contact_relation::crossing: return "crossing";
        case aabb::contact_relation::undecided: return "undecided whether touching or crossing";
    }
    __builtin_unreachable();
}

}  // namespace

struct relation_search::state {
    const aabb::mesh& a;
    const aabb::mesh& b;
    std::optional<std::array<aabb::box, 2>> boxes;  ///< of the floats of A and B, computed once
    std::unique_ptr<prepared_surface> of_a, of_b;   ///< once a question needs them
    double ms = 0;

    void prepare() {
        if (of_a) return;
        of_a = std::make_unique<prepared_surface>(a);
        of_b = std::make_unique<prepared_surface>(b);
    }
};

relation_search::relation_search(const aabb::mesh& a, const aabb::mesh& b) : state_(std::make_unique<state>(a, b)) {}
relation_search::~relation_search() = default;

mesh_relation relation_search::at(const aabb::pose& pose_a, const aabb::pose& pose_b) {
    const wall_stopwatch deciding;
    mesh_relation lie{.solids = aabb::solid_relation::disjoint, .a_inside_b = {}, .b_inside_a = {}, .contacts = {}};
    if (!state_->boxes) state_->boxes = {bounds_of(state_->a), bounds_of(state_->b)};
    const aabb::box box_a = world_bounds((*state_->boxes)[0], pose_a, state_->a.frame);
    const aabb::box box_b = world_bounds((*state_->boxes)[1], pose_b, state_->b.frame);
    // What lies inside lies inside the box.
    if (overlaps(box_a, box_b)) {
        state_->prepare();
        aabb::enclosed_pairs enclosed = relation_of(state_->of_a->whole, pose_a, state_->of_b->whole, pose_b);
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
    const solid &a = state_->of_a->whole, &b = state_->of_b->whole;
    mesh_relation lie;
    lie.contacts = contacts_of(state_->of_a->contacts, pose_a, state_->of_b->contacts, pose_b, hits);
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

std::vector<surface_summary> relation_search::surfaces() const {
    if (!state_->of_a) return {};
    return {summary_of(*state_->of_a), summary_of(*state_->of_b)};
}
double relation_search::ms() const {
    return state_->ms;
}

std::vector<std::string> sentences_about_relations(const mesh_result& result) {
    std::map<std::string, std::uint64_t> poses;       // by sentence
    std::map<std::string_view, std::uint64_t> pairs;  // of components, by how they lie
    for (const std::optional<mesh_relation>& lie : result.relations) {
        if (!lie) continue;
        if (lie->solids) {
            ++poses[sentence_about(*lie)];
            continue;
        }
        for (const aabb::component_contact& contact : lie->contacts) ++pairs[text_of(contact.relation)];
        if (!lie->a_inside_b.empty()) pairs["that of A inside that of B"] += lie->a_inside_b.size();
        if (!lie->b_inside_a.empty()) pairs["that of B inside that of A"] += lie->b_inside_a.size();
    }
    std::vector<std::string> sentences;
    for (const auto& [sentence, count] : poses)
        sentences.push_back(result.relations.size() == 1 ? sentence
                                                         : fmt::format("{}: {}", counted(count, "pose"), sentence));
    for (const auto& [text, count] : pairs)
        sentences.push_back(fmt::format("{} of components: {}", counted(count, "pair"), text));
    for (std::size_t mesh = 0; mesh < result.surfaces.size(); ++mesh)
        add_sentences(result.surfaces[mesh], mesh == 0 ? "A" : "B", sentences);
    return sentences;
}

}  // namespace aabblab
