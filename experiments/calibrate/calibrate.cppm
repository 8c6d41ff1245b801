/// Calibrates the cost model to this machine. Strategies run generated scenes, once with their work counted and several
/// times against the clock, and the cost of each kind of elementary work is fitted to counts and times.
export module aabblab.calibrate;

import aabb.costs;
import aabb.std;
import aabblab.statistics;

export namespace aabblab {

/// Counts and times of the same part of a run.
struct timed_work {
    std::string scene;         ///< observations of one scene are not independent
    std::vector<double> work;  ///< by kind of work, the number of times that it is done
    std::vector<double> ns;    ///< by repeat; all observations have the same number
};

/// Fits non-negative costs to the times, by least squares of the relative error; outliers are weighted down (Huber,
/// "Robust estimation of a location parameter", 1964). Confidence intervals are bootstrapped over scenes and repeats.
/// @param observations not empty; all have the same kinds of work
[[nodiscard]] std::vector<estimate> fit_costs(std::span<const timed_work> observations);

/// The factors, at least 1, by which predicted times are too long or too short.
struct accuracy {
    std::size_t observations = 0;
    double median = 1, worst = 1;
};
[[nodiscard]] accuracy accuracy_of(std::span<const timed_work> observations, std::span<const estimate> costs);

enum class calibration_size : unsigned char { quick, full };

/// The accuracy of the costs of one group on held-out scenes.
struct group_check {
    std::string_view group;
    accuracy held_out;
};

struct calibration {
    aabb::cost_model costs;
    std::array<estimate, aabb::cost_infos.size()> estimates;  ///< by cost
    std::vector<group_check> checks;
};

/// @param seconds the approximate time of the timed rounds; at least three run
[[nodiscard]] calibration calibrate(calibration_size size, double seconds);

}  // namespace aabblab
