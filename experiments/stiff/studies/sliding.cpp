module aabblab.stiff;

import :method;
import :rules;
import :shapes;
import aabb.pipeline;
import aabblab.stepping;

namespace aabblab {

namespace {

constexpr std::uint32_t tips = 8;  // on each side of the upper mesh
constexpr double distance = 0.25;  // between tips; all lengths are relative to the size of the meshes
constexpr double rest = 1e-3;      // compression of a spring whose vertex just touches
constexpr int positions = 257;
constexpr double displacement = 1.0 / 128;  // between positions

/// The upper mesh: 8 by 8 teeth that stand on their tips. Each tooth is a single triangle that meets the flat mesh only
/// at its tip, so that a false negative there loses the tooth's share of the load.
aabb::mesh comb_mesh() {
    aabb::mesh teeth;
    for (std::uint32_t i = 0; i < tips * tips; ++i) {
        const std::uint32_t row = i / tips;
        const auto x = static_cast<float>(distance * (i % tips - 0.5 * tips) - 1);  // it slides by 2 from here
        const auto y = static_cast<float>(distance * (row - 0.5 * tips));
        for (const aabb::vec3f& v :
             {aabb::vec3f{x, y, 0}, {x + 0.06F, y + 0.08F, 0.125F}, {x - 0.06F, y - 0.08F, 0.125F}})
            teeth.vertices.push_back(v);
        teeth.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return teeth;
}

/// The placement of both meshes, which determines which coordinates are rounded.
struct placement {
    std::string name;
    aabb::pose frame;  // of both meshes
    double size;       // m
    double pressed;    // relative depth of the upper mesh; negative above the lower one
};

/// A rotation about (1, 1, 1) by an angle of cosine 0.8, so that no axis is favoured.
aabb::pose oblique() {
    const double third = 0.2 / 3, sine = 0.6 / std::sqrt(3.0);
    const double a = 0.8 + third, b = third - sine, c = third + sine;
    return {{a, b, c, c, a, b, b, c, a}, {0, 0, 0}};
}

aabb::vec3d rotated(const aabb::pose& frame, const aabb::vec3d& v) {
    aabb::vec3d w{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) w[i] += frame.rotation[static_cast<std::size_t>(3 * i + j)] * v[j];
    return w;
}

aabb::mesh placed(aabb::mesh m, const placement& p) {
    for (aabb::vec3f& v : m.vertices) {
        const aabb::vec3d w = rotated(p.frame, {v[0] * p.size, v[1] * p.size, v[2] * p.size});
        for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(w[k]);
    }
    return m;
}

/// The normal force at each position of the slide over the load: the force if the contacts of all tips are detected. A
/// spring that just touches is compressed by `rest`, so that a contact of depth 0 exerts a force too.
std::vector<double> forces_of(const candidate& tested, const placement& p) {
    const aabb::mesh lower = placed(floor_of(/*side=*/8, /*n=*/16), p);
    const aabb::mesh upper = placed(comb_mesh(), p);
    const auto stage = tested.make_local(aabb::instrumentation::none);
    stage->add_model(lower);
    stage->add_model(upper);
    const contact_law law{.geometry = contact_geometry::each_vertex, .stiffness = 1, .rest = rest * p.size};
    const aabb::vec3d normal = rotated(p.frame, {0, 0, 1});
    std::vector<double> forces;
    for (int i = 0; i < positions; ++i) {
        aabb::pose pose;
        pose.translation = rotated(p.frame, {displacement * i * p.size, 0, -p.pressed * p.size});
        std::vector<aabb::index_pair> pairs;
        stage->all_pairs(0, {}, 1, pose, pairs);
        std::ranges::sort(pairs);
        std::vector<aabb::contact> contacts;
        for (const auto& [s, t] : pairs) contacts.push_back({0, 1, s, t});
        const contact_force contact = force_of(law, contacts, {&lower, {}}, {&upper, pose});
        forces.push_back(dot(contact.force, normal) / (tips * tips * (rest + p.pressed) * p.size));
    }
    return forces;
}

double greatest_jump(const std::vector<double>& forces) {
    double greatest = 0;
    for (std::size_t i = 1; i < forces.size(); ++i) greatest = std::max(greatest, std::abs(forces[i] - forces[i - 1]));
    return greatest;
}

}  // namespace

/// Slides the meshes in each placement with each triangle method. With an exact one the force must be the load, or none
/// above the flat mesh; that of others is reported, and drawn for nine of those that lose load at 10 mm.
void run_sliding(const stiff_setting& setting, stiff_result& result) {
    const std::vector<placement> placements = {{.name = "lattice", .frame = {}, .size = 1, .pressed = 0},
                                               {"oblique, 1 m", oblique(), 1, 1e-5},
                                               {"oblique, 10 mm", oblique(), 0.01, 1e-5},
                                               {"oblique, 0.1 mm", oblique(), 1e-4, 1e-5},
                                               {"1 m", oblique(), 1, -1e-5},
                                               {"10 mm", oblique(), 0.01, -1e-5},
                                               {"0.1 mm", oblique(), 1e-4, -1e-5}};
    std::vector<method> methods = triangle_methods(setting.quick);
    std::ranges::find(methods, "exact", &method::label)->tested = setting.tested;
    constexpr std::size_t most_drawn = 9;
    std::size_t drawn = 0, done = 0;
    for (const placement& p : placements)
        for (const method& m : methods) {
            setting.progress(static_cast<double>(done++) / static_cast<double>(placements.size() * methods.size()));
            const std::vector<double> forces = forces_of(m.tested, p);
            const double least = std::ranges::min(forces);
            const auto add = [&](stiff_row row) { result.add(expected_if(m.tested.exact, std::move(row))); };
            if (p.pressed < 0) {
                add(at_most(m.label, "greatest force above the flat mesh, " + p.name, std::ranges::max(forces), 0));
                continue;
            }
            add(at_most(m.label, "greatest jump of the force, " + p.name, greatest_jump(forces), 1e-3));
            add(within(m.label, "least force, " + p.name, least, 1, 1e-3));
            if (p.size == 0.01 && least < 0.999 && drawn++ < most_drawn)
                for (int i = 0; i < positions; ++i)
                    result.plot("sliding_force", m.label, displacement * i, forces[static_cast<std::size_t>(i)]);
        }
}

stiff_study sliding_study() {
    return {
        "sliding",
        "A mesh of 64 teeth, each a triangle, slides on its tips over faces, edges and vertices of a flat mesh, "
        "both in sizes of 1 m, 10 mm and 0.1 mm. The meshes are oblique, or lie on a lattice, where no coordinate is "
        "rounded. Each tip whose contact is detected carries a 64th of the load. A 100,000th of its size above the "
        "flat mesh, there is no load",
        "the load, to one in a thousand, without a jump; rounding of vertices to float allows 1e-4",
        &run_sliding,
        {figure{.name = "sliding_force",
                .caption = "The force between two meshes of 10 mm that slide along each other, oblique and pressed "
                           "together by a 100,000th, relative to the load. Methods that keep it are not drawn.",
                .x = {"displacement (sizes)"},
                .y = {"force (relative to the load)"},
                .lines = {{"exact", series_style::level, {{0, 1}}}}}},
        /*compares_methods=*/true};
}

}  // namespace aabblab
