/// What elementary work takes on this machine. Strategies play generated scenes, once with their work counted and
/// several times against the clock, and costs are fitted to what both passes say.
export module aabblab.calibrate;

import aabb.costs;
import aabb.std;
import aabblab.statistics;

export namespace aabblab {

/// How much work of each kind a piece of play takes, and how long that took.
struct timed_work {
    std::string scene;         ///< pieces of one scene are no evidence of each other
    std::vector<double> work;  ///< times of each kind of work that there is a cost for
    std::vector<double> ns;    ///< of each repeat; all observations have as many
};

/// The costs, none below 0, whose sums of work times cost come nearest to the times, by least squares of the relative
/// error; those far off count less (Huber, "Robust estimation of a location parameter", 1964). How far a cost may be
/// off is bootstrapped over scenes and repeats.
/// @param seen not empty; all with the same kinds of work
[[nodiscard]] std::vector<estimate> fit_costs(std::span<const timed_work> seen);

/// How many times too long, or too short, times are that costs predict.
struct accuracy {
    std::size_t observations = 0;
    double median = 1;
    double worst = 1;
};
[[nodiscard]] accuracy accuracy_of(std::span<const timed_work> seen, std::span<const estimate> costs);

enum class calibration_size : unsigned char { quick, full };

/// What the costs of one group predict of scenes that they were not fitted to.
struct group_check {
    std::string_view group;
    accuracy found;
};

struct calibration {
    aabb::cost_model costs;
    std::array<estimate, aabb::cost_infos.size()> estimates;  ///< of each cost
    std::vector<group_check> checks;
};

/// @param seconds about how long to measure, once scenes are made and work is counted; three rounds at least
[[nodiscard]] calibration calibrate(calibration_size size, double seconds);

}  // namespace aabblab
