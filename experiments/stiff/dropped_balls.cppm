/// Balls that fall in a lattice on a floor, with whoever finds their contacts.
module aabblab.stiff:dropped_balls;

import aabb.std;
import aabblab.trials;
import aabblab.stepping;
import :simulation;

namespace aabblab {

struct trajectory {
    std::vector<std::vector<double>> positions;  ///< of all bodies, after each step that is kept
    double detection_ms = 0;
    double energy_error = 0;  ///< the root of the mean square of twenty looks, over the energy at the beginning
    /// How deep two balls are in each other at most, taken for spheres, in diameters, at twenty times.
    std::vector<double> times, depths;
};

class dropped_balls {
public:
    /// @param side balls on an edge of the lattice
    /// @param diameter m
    dropped_balls(std::size_t side, double diameter);

    /// What takes so long for balls of 1 m, scaled to these, s.
    [[nodiscard]] double seconds(double of_large_ones) const;

    /// Ends early where bodies come beyond all poses.
    /// @param kept positions are kept of every so many-th step
    /// @throws aabb::input_error where it ends before the first of its twenty looks.
    [[nodiscard]] trajectory play(const contender& who, const integrator_info& stepping, double step, std::size_t kept,
                                  bool with_energy) const;

    /// The greatest distance of a body from where it should be, in diameters, after each step that both kept; infinite
    /// once it ended before the other.
    [[nodiscard]] std::vector<double> departures(const trajectory& t, const trajectory& right) const;

private:
    [[nodiscard]] double energy_of(simulation& balls) const;
    [[nodiscard]] double greatest_depth(const std::vector<double>& position) const;

    double diameter_;
    stepped_world world_;
};

}  // namespace aabblab
