/// The order of interleaved rounds, their time limits, and rules for early stopping.
export module aabblab.trials:rounds;

import aabb.std;

export namespace aabblab {

/// The index of the candidate at a place of a round. Carry-over effects are balanced: over n rounds of n candidates
/// each candidate begins one round and, for even n, follows every other candidate once, for odd n about once (Williams,
/// "Experimental designs balanced for the estimation of residual effects of treatments", 1949).
[[nodiscard]] constexpr std::size_t index_in_round(std::size_t place, std::size_t round, std::size_t candidates) {
    // 0, 1, -1, 2, -2 and so on.
    const std::size_t offset = place % 2 == 1 ? (place + 1) / 2 : candidates - place / 2;
    return (round + offset) % candidates;
}

/// Runs each candidate once, in the order of this round.
template <class Candidate, class Run>
void run_round(std::vector<Candidate>& candidates, std::size_t round, Run run) {
    for (std::size_t place = 0; place < candidates.size(); ++place)
        run(candidates[index_in_round(place, round, candidates.size())]);
}

/// The rounds to run, from `begin` to `end`, and the time for them.
struct round_limits {
    std::size_t end;
    std::size_t begin = 0;
    std::size_t fewest = 0;  ///< rounds before this one run regardless of the time
    /// The remaining seconds; if given, a round begins only if they exceed the time of the previous round.
    std::function<double()> seconds_left = nullptr;
    double expected = 0;  ///< seconds of the first round, estimated
};

/// Runs candidates in interleaved rounds, each candidate once per round, until no round or no candidate remains. After
/// the `fewest` rounds, one begins only if the time left exceeds that of the previous round.
/// @param run takes a candidate and the number of the round
/// @param after_round takes its number; it may remove candidates
/// @returns the first round that was not run
template <class Candidate, class Run, class After>
std::size_t run_rounds(std::vector<Candidate>& candidates, const round_limits& limits, Run run, After after_round) {
    double seconds_of_round = limits.expected;  // of the previous one
    std::size_t round = limits.begin;
    for (; round < limits.end && !candidates.empty(); ++round) {
        const double remaining = limits.seconds_left ? limits.seconds_left() : std::numeric_limits<double>::infinity();
        if (round >= limits.fewest && remaining <= seconds_of_round) break;
        run_round(candidates, round, [&](Candidate& c) { run(c, round); });
        if (limits.seconds_left) seconds_of_round = remaining - limits.seconds_left();
        after_round(round);
    }
    return round;
}

/// A candidate that takes this many times as long as another is hopeless: disturbances alone never cost that much.
inline constexpr double hopeless_ratio = 20;

/// Early stopping: limits the time of a candidate relative to that of another.
struct stopping_rule {
    double ratio = hopeless_ratio;
    double grace = 0;  ///< seconds that are too short to matter; added to each limit
    /// An upper limit, so that a few candidates do not use up the time; `margin` times the other is always allowed.
    double share = std::numeric_limits<double>::infinity();
    double margin = 1;

    [[nodiscard]] double hopeless_after(double other) const { return grace + ratio * other; }
    [[nodiscard]] double longest(double other) const {
        return std::min(hopeless_after(other), grace + std::max(share, margin * other));
    }
};

/// The time limits of a command. A budget of S seconds ends within 2 S, or 2 seconds after the scene is read if that is
/// later: one half is for runs, the other for the ground truth. A twentieth is reserved for finishing and reporting.
class time_limits {
public:
    /// @param seconds at most 1,000,000
    /// @param elapsed in seconds
    explicit time_limits(double seconds, std::function<double()> elapsed = since_now())
        : seconds_(seconds), elapsed_(std::move(elapsed)) {}

    void note_scene_read() { reading_ = elapsed_(); }
    /// The remaining seconds; not positive once the time is over.
    [[nodiscard]] double to_run() const { return std::max(usable * seconds_, reading_ + usable) - elapsed_(); }
    [[nodiscard]] double to_end() const { return std::max(2 * usable * seconds_, reading_ + 2 * usable) - elapsed_(); }

private:
    static constexpr double usable = 0.95;

    [[nodiscard]] static std::function<double()> since_now() {
        return [begin = std::chrono::steady_clock::now()] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        };
    }

    double seconds_;
    std::function<double()> elapsed_;
    double reading_ = 0;
};

/// Ratios of the times of two candidates within the same rounds.
struct paired_ratio {
    double median = 1, least = 1, greatest = 1;

    /// Whether the rounds do not show that one is faster by more than 3 %. A single round never shows it.
    [[nodiscard]] bool may_be_same() const { return least == greatest || (least < 1.03 && greatest > 1 / 1.03); }
};
/// @param ms one or more times, by round, as is `of_other`
[[nodiscard]] paired_ratio paired_ratio_of(std::span<const double> ms, std::span<const double> of_other);

}  // namespace aabblab
