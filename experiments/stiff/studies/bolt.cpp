module;
#include <cmath>

module aabblab.stiff;

import :rules;
import :touching;
import aabb.geometry;

namespace aabblab {

namespace {

// Functions: clang 19 does not initialise variables of a module's implementation unit in their order. All lengths are
// in metres, of a thread like that of M10: a pitch of 1.5 mm and flanks at 30°.
constexpr double pitch = 1.5e-3;
constexpr double crest_radius = 5e-3;      // of the bolt
constexpr double root_radius = 4.2e-3;     // of the bolt
constexpr double crest_width = 0.2e-3;     // of the bolt, along the axis
constexpr double axial_clearance = 50e-6;  // on each side
constexpr double radial_clearance = 200e-6;
constexpr std::size_t flank_rows = 4;  // of facets, where both flanks are
constexpr double precision = 1e-12;
constexpr double micrometres = 1e6;  // per m

double flank_slope() {
    return std::tan(std::numbers::pi / 6);
}

/// A point of a thread's profile: its distances from the axis, and along the axis from the middle of a crest.
struct profile_point {
    double radius, height;
};

/// The profile over one pitch, from below. Both flanks of bolt and nut have rows of vertices at the same distances from
/// the axis, from the nut's crest to the bolt's.
/// @param radii of the rows, ascending
/// @param clearance along the axis
std::vector<profile_point> profile(const std::vector<double>& radii, double clearance) {
    std::vector<profile_point> upper;
    for (const double radius : radii)
        upper.push_back({radius, crest_width / 2 + clearance + (crest_radius - radius) * flank_slope()});
    std::vector<profile_point> points;
    for (const auto& [radius, height] : upper) points.push_back({radius, -height});
    points.insert(points.end(), upper.rbegin(), upper.rend());
    return points;
}

std::vector<double> shared_rows() {
    const double first = root_radius + radial_clearance;  // the nut's crest
    std::vector<double> radii;
    for (std::size_t i = 0; i <= flank_rows; ++i)
        radii.push_back(first + (crest_radius - first) * static_cast<double>(i) / flank_rows);
    return radii;
}

/// A surface that the profile sweeps along a helix about the axis z, in facets between planes through the axis; it is
/// open at both ends.
/// @param first_turn where it begins
aabb::mesh thread(const std::vector<profile_point>& points, int facets_per_turn, int first_turn, int turns,
                  double advance_per_turn) {
    const auto rows = static_cast<std::uint32_t>(points.size());
    const auto in_turn = static_cast<std::uint32_t>(facets_per_turn);
    const std::uint32_t steps = in_turn * static_cast<std::uint32_t>(turns);
    aabb::mesh m;
    // The last row of a turn joins the first row of the next turn, one turn on.
    for (std::uint32_t step = 0; step <= steps + in_turn; ++step) {
        const double turn = first_turn + static_cast<double>(step) / in_turn;
        const double angle = 2 * std::numbers::pi * turn;
        for (const auto& [radius, height] : points)
            m.vertices.push_back({static_cast<float>(radius * std::cos(angle)),
                                  static_cast<float>(radius * std::sin(angle)),
                                  static_cast<float>(height + advance_per_turn * turn)});
    }
    for (std::uint32_t step = 0; step < steps; ++step)
        for (std::uint32_t row = 0; row < rows; ++row) {
            const std::uint32_t corner = step * rows + row;
            const std::uint32_t above = row + 1 < rows ? corner + 1 : (step + in_turn) * rows;
            m.triangles.push_back({corner, corner + rows, above + rows});
            m.triangles.push_back({corner, above + rows, above});
        }
    return m;
}

aabb::mesh bolt_thread(int facets) {
    std::vector<double> radii = shared_rows();
    radii.insert(radii.begin(), root_radius);
    return thread(profile(radii, 0), facets, /*first_turn=*/-2, /*turns=*/6, pitch);
}

aabb::mesh nut_thread(int facets, double advance_per_turn) {
    std::vector<double> radii = shared_rows();
    radii.push_back(crest_radius + radial_clearance);
    return thread(profile(radii, axial_clearance), facets, /*first_turn=*/0, /*turns=*/2, advance_per_turn);
}

/// What a smooth thread, a cone along a helix, differs from its facets, along the axis.
struct facet_error {
    double sagitta;  ///< of the cone
    double twist;    ///< at most, of the helix

    /// Facets of a cone are planar. At half an angle h from their ends they lie on the cone's axis' side of it: at the
    /// distance r by r (1/cos h - 1) times the slope. The helix gives each point its angle's share of the pitch, a
    /// function with second derivatives of pitch/(2πr²): a triangle interpolates it within half of this times the
    /// square of the radius of a circle around the triangle (Shewchuk 2002, "What is a good linear finite element?",
    /// section 2).
    explicit facet_error(int facets) {
        const double half_angle = std::numbers::pi / facets;
        sagitta = flank_slope() * crest_radius * (1 / std::cos(half_angle) - 1);
        const double half_chord = (crest_radius + radial_clearance) * std::sin(half_angle);
        const double nearest = root_radius * std::cos(half_angle);
        twist = pitch / (4 * std::numbers::pi) * (half_chord * half_chord + radial_clearance * radial_clearance / 4) /
                (nearest * nearest);
    }
};

/// A nut on a bolt, where it belongs at an angle, or displaced from there along the axis.
class nut_on_bolt {
public:
    nut_on_bolt(int facets, const stiff_setting& setting)
        : test_(setting.tested, bolt_thread(facets), nut_thread(facets, setting.fault.shape * pitch)) {}

    /// The distance between the places at which the nut touches the bolt, m; 0 if it does everywhere.
    [[nodiscard]] double play(double turn) {
        double sum = 0;
        for (const double direction : {-1.0, 1.0})
            sum += touching_point(0, 2 * axial_clearance, precision, [&](double offset) {
                return test_.touch({}, turned(2 * std::numbers::pi * turn, {0, 0, pitch * turn + direction * offset}));
            });
        return sum;
    }

private:
    touch_test test_;
};

/// The error of the play because vertices are rounded to floats: of two vertices, on either side. A vertex that is off
/// across the axis counts by the slope.
double rounding() {
    const double farthest = std::hypot(crest_radius + radial_clearance, 5 * pitch);
    return 4 * float_rounding * farthest * (1 + flank_slope()) + 2 * precision;
}

void measure_play(int facets, const stiff_setting& setting, stiff_result& result) {
    const std::string subject = std::to_string(facets) + " facets";
    nut_on_bolt nut(facets, setting);
    const facet_error error(facets);
    const auto in_bounds = [&](const char* quantity, double value, double least, double greatest) {
        result.add(between(subject, quantity, micrometres * value, micrometres * (std::max(least, 0.0) - rounding()),
                           micrometres * (std::max(greatest, 0.0) + rounding())));
    };
    // Where vertices meet, facets of the nut are parallel to those of the bolt, and have the clearance.
    const double least = 2 * (axial_clearance - error.sagitta - 2 * error.twist);
    const double turn_of_facet = 1.0 / facets;
    result.add(within(subject, "play where vertices meet (µm)", micrometres * nut.play(0),
                      micrometres * 2 * axial_clearance, rounding() / (2 * axial_clearance)));
    in_bounds("play half a facet on (µm)", nut.play(turn_of_facet / 2), least,
              2 * (axial_clearance - error.sagitta + error.twist));
    // Over a facet, of which the rest of the turn is a repetition, up to rounding.
    double least_play = std::numeric_limits<double>::infinity(), greatest_play = 0;
    const int phases = setting.quick ? 16 : 64;
    for (int i = 0; i <= phases; ++i) {
        const double phase = static_cast<double>(i) / phases;
        const int whole_facets = i % 8 * facets / 8;
        const double play = nut.play((whole_facets + phase) * turn_of_facet);
        least_play = std::min(least_play, play);
        greatest_play = std::max(greatest_play, play);
        result.plot("play", subject, phase, micrometres * play);
    }
    in_bounds("least play at every phase (µm)", least_play, least, 2 * axial_clearance);
    in_bounds("greatest play at every phase (µm)", greatest_play, least, 2 * axial_clearance);
}

}  // namespace

/// The flank of a bolt's thread loses the height of its chords, and that of the nut, which is hollow, gains it: where
/// a vertex faces the middle of a chord, this height is missing from the clearance on both sides. With few facets the
/// clearance is less than it, and the nut jams.
void run_bolt(const stiff_setting& setting, stiff_result& result) {
    const std::vector<int> numbers = setting.quick ? std::vector{12, 24, 48} : std::vector{12, 24, 48, 96, 192};
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        setting.progress(static_cast<double>(n) / static_cast<double>(numbers.size()));
        measure_play(numbers[n], setting, result);
    }
}

stiff_study bolt_study() {
    return {
        "bolt",
        "A nut on a bolt, with a thread like that of M10 and clearances of 50 µm along the axis, 12 to 192 facets (48 "
        "with --quick) per turn. The nut turns and advances by a pitch per turn; at each phase it is moved along the "
        "axis, by bisection, until it touches the bolt. Factory (Narang et al. 2022, arXiv 2205.03532) simulates a "
        "thousand such pairs at once",
        "the play of smooth threads, twice the clearance, less the height of the chords on both sides, r tan 30° "
        "(1/cos h - 1) with half the angle h of a facet: 12 facets jam. Triangles interpolate the helix within "
        "p/(4π) times the square of their radius over r²",
        &run_bolt,
        {figure{.name = "play",
                .caption = "Play of a nut on a bolt over the phase between vertices that meet, for numbers of facets "
                           "per turn. Smooth threads have 100 µm.",
                .x = {"angle (facets)"},
                .y = {"play (µm)"}}}};
}

}  // namespace aabblab
