module;
#include <cmath>

module aabblab.stiff;

import :rules;
import :touching;
import aabb.geometry;

namespace aabblab {

namespace {

// Functions: clang 19 does not initialise variables of a module's implementation unit in their order.
constexpr std::array<int, 2> teeth = {15, 22};
constexpr double module_length = 2e-3;                  // of a pitch circle per tooth, m
constexpr double backlash = 0.1 * module_length;        // on the pitch circles, m
constexpr double root_clearance = 0.1 * module_length;  // m
constexpr double contact_ratio = 1.5;                   // length of the path of contact in base pitches
constexpr double angle_precision = 1e-10;               // of the angle of touching
constexpr double micrometres = 1e6;                     // per m

double pressure_angle() {
    return std::numbers::pi / 9;
}
double pitch_radius(std::size_t gear) {
    return module_length * teeth[gear] / 2;
}
double base_radius(std::size_t gear) {
    return pitch_radius(gear) * std::cos(pressure_angle());
}
double base_pitch() {
    return std::numbers::pi * module_length * std::cos(pressure_angle());
}
double pitch_angle(std::size_t gear) {
    return 2 * std::numbers::pi / teeth[gear];
}
double centre_distance() {
    return pitch_radius(0) + pitch_radius(1);
}

/// The curve that the end of a string describes, as it is unwound from the base circle. The roll angle t says where the
/// string leaves the circle; its free part, base times t, is the radius of curvature.
struct involute {
    double base;  ///< radius of the circle, m

    [[nodiscard]] double radius(double roll) const { return base * std::hypot(1, roll); }
    [[nodiscard]] double roll_at(double radius) const { return std::sqrt(std::pow(radius / base, 2) - 1); }
    /// The polar angle since the start of the curve.
    [[nodiscard]] static double angle(double roll) { return roll - std::atan(roll); }
    /// How far the point at a roll angle lies behind the tangent at another, m. The tangent at t is at the distance
    /// base t from the centre of the circle, along the string; the point at v is at base (sin(t - v) + v cos(t - v)).
    [[nodiscard]] double depth(double tangent, double point) const {
        const double between = tangent - point;
        return base * (between - std::sin(between) + point * (1 - std::cos(between)));
    }
    /// The roll angle at which the tangent, whose direction it is, is parallel to a chord. The arc is farthest from
    /// the chord here.
    [[nodiscard]] static double parallel_to_chord(double from, double to) {
        const auto x = [](double t) { return std::cos(t) + t * std::sin(t); };
        const auto y = [](double t) { return std::sin(t) - t * std::cos(t); };
        return std::atan2(y(to) - y(from), x(to) - x(from));
    }
    /// c²/(8r) to leading order, with the chord's length c and the radius of curvature r.
    [[nodiscard]] double sagitta(double from, double to) const { return depth(parallel_to_chord(from, to), from); }
};

/// A gear whose flanks are chords of involutes, between points that divide the path of contact evenly, so that vertices
/// of two gears meet.
struct faceted_gear {
    std::size_t number;    ///< 0 drives, 1 is driven
    int facets;            ///< per base pitch
    double base_part = 1;  ///< the base circle of the flanks in parts of the true one

    [[nodiscard]] int facets_of_flank() const { return static_cast<int>(contact_ratio * facets); }
    /// The roll angle at the ends of facets, 0 at the root.
    [[nodiscard]] double roll(int end) const {
        const double from_pitch_point = (static_cast<double>(end) / facets - contact_ratio / 2) * base_pitch();
        return (pitch_radius(number) * std::sin(pressure_angle()) + from_pitch_point) / base_radius(number);
    }
    [[nodiscard]] double radius(int end) const { return involute{base_radius(number)}.radius(roll(end)); }
    [[nodiscard]] double tip_radius() const { return radius(facets_of_flank()); }
    [[nodiscard]] double sagitta(int facet) const {
        return involute{base_radius(number)}.sagitta(roll(facet), roll(facet + 1));
    }
    [[nodiscard]] double greatest_sagitta() const {
        double greatest = 0;
        for (int facet = 0; facet < facets_of_flank(); ++facet) greatest = std::max(greatest, sagitta(facet));
        return greatest;
    }
    /// Half the angle of a tooth on the pitch circle. Each gear has half of the backlash.
    [[nodiscard]] double half_tooth() const { return pitch_angle(number) / 4 - backlash / (4 * pitch_radius(number)); }

    /// A prism with the axis z and a tooth on the axis x. Radial lines join the flanks to the root, which the tips of
    /// the other gear do not reach. @param half_width m
    [[nodiscard]] aabb::mesh prism(double half_width) const;

private:
    /// Half the angle of a tooth at the end of a facet.
    [[nodiscard]] double half_angle(int end) const {
        const involute flank{base_part * base_radius(number)};
        return half_tooth() + involute::angle(flank.roll_at(pitch_radius(number))) -
               involute::angle(flank.roll_at(radius(end)));
    }
};

aabb::mesh faceted_gear::prism(double half_width) const {
    const faceted_gear other{1 - number, facets};
    const double root = centre_distance() - other.tip_radius() - root_clearance;
    const auto rows = static_cast<std::uint32_t>(facets_of_flank()) + 2;  // of a flank, from the root to the tip
    const auto count = static_cast<std::uint32_t>(teeth[number]);
    aabb::mesh m;
    const auto add = [&](double radius, double angle) {
        for (const double z : {-half_width, half_width})
            m.vertices.push_back({static_cast<float>(radius * std::cos(angle)),
                                  static_cast<float>(radius * std::sin(angle)), static_cast<float>(z)});
    };
    for (std::uint32_t tooth = 0; tooth < count; ++tooth)
        for (const double side : {-1.0, 1.0})
            for (std::uint32_t row = 0; row < rows; ++row) {
                const int end = std::max(static_cast<int>(row) - 1, 0);
                add(row == 0 ? root : radius(end), tooth * pitch_angle(number) + side * half_angle(end));
            }
    add(0, 0);
    // Of two vertices one above the other, the lower one; the upper one follows it.
    const auto at = [&](std::uint32_t tooth, std::uint32_t side, std::uint32_t row) {
        return 2 * ((tooth % count * 2 + side) * rows + row);
    };
    const std::uint32_t centre = 2 * count * 2 * rows;
    // A triangle of both ends, counterclockwise from above.
    const auto add_to_ends = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        m.triangles.push_back({a + 1, b + 1, c + 1});
        m.triangles.push_back({a, c, b});
    };
    const auto add_wall = [&](std::uint32_t from, std::uint32_t to) {
        m.triangles.push_back({from, to, to + 1});
        m.triangles.push_back({from, to + 1, from + 1});
    };
    for (std::uint32_t tooth = 0; tooth < count; ++tooth) {
        for (std::uint32_t row = 0; row + 1 < rows; ++row) {
            add_to_ends(at(tooth, 0, row), at(tooth, 0, row + 1), at(tooth, 1, row + 1));
            add_to_ends(at(tooth, 0, row), at(tooth, 1, row + 1), at(tooth, 1, row));
            add_wall(at(tooth, 0, row), at(tooth, 0, row + 1));
            add_wall(at(tooth, 1, row + 1), at(tooth, 1, row));
        }
        add_wall(at(tooth, 0, rows - 1), at(tooth, 1, rows - 1));
        add_wall(at(tooth, 1, 0), at(tooth + 1, 0, 0));
        add_to_ends(centre, at(tooth, 0, 0), at(tooth, 1, 0));
        add_to_ends(centre, at(tooth, 1, 0), at(tooth + 1, 0, 0));
    }
    return m;
}

/// Two gears in mesh, of which the second turns until it touches the first.
class gear_pair {
public:
    gear_pair(int facets, const stiff_setting& setting)
        : driver_{0, facets},
          driven_{1, facets},
          // The driven gear is wider, so that no ends are coplanar.
          test_(setting.tested, driver_.prism(2 * module_length),
                faceted_gear{1, facets, setting.fault.shape}.prism(2.5 * module_length)) {}

    [[nodiscard]] const faceted_gear& driver() const { return driver_; }
    [[nodiscard]] const faceted_gear& driven() const { return driven_; }

    /// The angle of the driven gear at which it touches a flank of the driver, turned by `driver_angle`. At 0 it is in
    /// the middle of the backlash.
    [[nodiscard]] double touching_angle(double driver_angle) {
        const double free = ideal_angle(driver_angle) - half_backlash();
        const double opposite = std::numbers::pi + pitch_angle(1) / 2;  // a gap of its teeth faces the driver's tooth
        return touching_point(free, free + 2 * half_backlash(), angle_precision, [&](double angle) {
            return test_.touch(turned(driver_angle, {0, 0, 0}), turned(angle + opposite, {centre_distance(), 0, 0}));
        });
    }
    /// The same angle of gears without facets.
    [[nodiscard]] static double ideal_angle(double driver_angle) {
        return -driver_angle * teeth[0] / teeth[1] + half_backlash();
    }
    /// How far the flank of the driven gear is beyond that of a gear without facets, along the line of action, m.
    [[nodiscard]] double transmission_error(double driver_angle) {
        return base_radius(1) * (touching_angle(driver_angle) - ideal_angle(driver_angle));
    }
    /// The error of this error because vertices are rounded to floats.
    [[nodiscard]] double rounding() const {
        return float_rounding * (driver_.tip_radius() + driven_.tip_radius()) + angle_precision * base_radius(1);
    }

private:
    static double half_backlash() { return backlash / (2 * pitch_radius(1)); }

    faceted_gear driver_, driven_;
    touch_test test_;
};

/// A value with its bounds.
struct bounded {
    double value = 0, least = 0, greatest = 0;
};

/// The transmission error where the driver's facet behind the pitch point is perpendicular to the line of action: a
/// single pair of teeth is in contact here.
bounded error_at_facet(gear_pair& gears) {
    const faceted_gear &driver = gears.driver(), &driven = gears.driven();
    const int facet = driver.facets_of_flank() / 2, partner = facet - 1;
    const double roll = involute::parallel_to_chord(driver.roll(facet), driver.roll(facet + 1));
    bounded error;
    // The tooth on the axis x touches at the pitch point, at a roll angle of tan 20°, when its flank is on this axis.
    error.value = gears.transmission_error(roll - std::tan(pressure_angle()) - driver.half_tooth());
    error.greatest = driver.sagitta(facet) + driven.sagitta(partner);
    // The driven gear's roll angle at this place of the line of action; it turns on by less than the greatest error.
    const double partner_roll =
        (centre_distance() * std::sin(pressure_angle()) - base_radius(0) * roll) / base_radius(1);
    const double turn = error.greatest / base_radius(1);
    double least_depth = error.greatest;  // of a vertex
    for (const double tangent : {partner_roll - turn, partner_roll + turn})
        for (const int end : {partner, partner + 1})
            least_depth = std::min(least_depth, involute{base_radius(1)}.depth(tangent, driven.roll(end)));
    error.least = driver.sagitta(facet) + least_depth;
    error.least -= gears.rounding();
    error.greatest += gears.rounding();
    return error;
}

/// Adds the ratio of the angles by which both gears turn over one pitch, for that of the driver's pitches in which it
/// is worst.
void measure_ratio(gear_pair& gears, const std::string& subject, stiff_result& result) {
    const double expected = -static_cast<double>(teeth[0]) / teeth[1];
    double worst = expected;
    double before = gears.touching_angle(0);
    for (int pitch = 1; pitch <= teeth[0]; ++pitch) {
        const double angle = gears.touching_angle(pitch * pitch_angle(0));
        const double ratio = (angle - before) / pitch_angle(0);
        if (std::abs(ratio - expected) > std::abs(worst - expected)) worst = ratio;
        before = angle;
    }
    // Both angles are rounded.
    const double rounding = 2 * gears.rounding() / base_radius(1) / pitch_angle(1);
    result.add(within(subject, "ratio of the mean speeds, worst of " + std::to_string(teeth[0]) + " pitches", worst,
                      expected, rounding));
}

}  // namespace

/// A gear with chords for arcs lies in the true gear, and contains the one whose flanks lie deeper by the greatest
/// sagitta. Parallels of an involute are the same involute, turned: so the driven gear touches beyond the true angle,
/// by at most the sagittas of both gears along the line of action. A flank lies behind the planes of its facets, too.
/// If one is perpendicular to the line of action, the driven gear turns at least until its nearest vertex is in its
/// plane: by the facet's sagitta, and the depth of this vertex behind the tangent of its own involute.
void run_gears(const stiff_setting& setting, stiff_result& result) {
    const std::vector<int> numbers = setting.quick ? std::vector{4, 8, 16} : std::vector{4, 8, 16, 32, 64};
    const int phases = setting.quick ? 32 : 256;
    std::optional<bounded> coarser;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        const int facets = numbers[n];
        gear_pair gears(facets, setting);
        const std::string subject = std::to_string(facets) + " facets";
        double least = std::numeric_limits<double>::infinity(), greatest = -least;
        for (int i = 0; i <= phases; ++i) {
            setting.progress((static_cast<double>(n) + static_cast<double>(i) / phases) /
                             static_cast<double>(numbers.size()));
            const double phase = static_cast<double>(i) / phases;
            const double error = gears.transmission_error(phase * pitch_angle(0));
            least = std::min(least, error);
            greatest = std::max(greatest, error);
            if (facets <= 16) result.plot("transmission_error", subject, phase, micrometres * error);
        }
        result.add(
            at_least(subject, "least transmission error (µm)", micrometres * least, -micrometres * gears.rounding()));
        const double sagittas = gears.driver().greatest_sagitta() + gears.driven().greatest_sagitta();
        result.add(at_most(subject, "greatest transmission error (µm)", micrometres * greatest,
                           micrometres * (sagittas + gears.rounding())));
        const bounded at_facet = error_at_facet(gears);
        result.add(between(subject, "error at a facet over both sagittas", at_facet.value / at_facet.greatest,
                           at_facet.least / at_facet.greatest, 1));
        if (coarser)
            result.add(between(subject, "error at a facet with half as many over this one",
                               coarser->value / at_facet.value, coarser->least / at_facet.greatest,
                               coarser->greatest / at_facet.least));
        coarser = at_facet;
        measure_ratio(gears, subject, result);
    }
}

stiff_study gears_study() {
    return {
        "gears",
        "Two gears of 15 and 22 teeth with a module of 2 mm, whose involute flanks are chords, 4 to 64 (16 with "
        "--quick) per base pitch. At each phase the driven gear turns, by bisection, until it touches the driver. "
        "Involutes turn at a constant ratio, so that the error of transmission is that of the chords. There is "
        "backlash, so that one flank touches. The path of contact is 1.5 base pitches, half of it on either side: it "
        "ends above the base circles, so that no flank is undercut, for 13 teeth and more, (1.5π)/tan 20°",
        "the mean ratio -15/22 over a pitch; errors along the line of action, between 0 and the sagittas c²/(8r) of "
        "both chords, which fall with the square of the number of facets. Vertices are rounded to floats",
        &run_gears,
        {figure{.name = "transmission_error",
                .caption = "How far the driven gear is ahead of one without facets, along the line of action, over a "
                           "pitch, for numbers of facets per base pitch. Twice the facets leave a quarter.",
                .x = {"angle of the driver (pitches)"},
                .y = {"transmission error (µm)"}}}};
}

}  // namespace aabblab
