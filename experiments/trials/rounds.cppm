/// Who plays when, for how long, and when to give up on one.
export module aabblab.trials:rounds;

import aabb.std;

export namespace aabblab {

/// Who plays at a place of a round, so that it matters to nobody alone after whom one plays: each begins a round, and
/// in as many rounds as there are players, if these are even, follows each other one once; else about so (Williams,
/// "Experimental designs balanced for the estimation of residual effects of treatments", 1949).
[[nodiscard]] constexpr std::size_t in_turn(std::size_t place, std::size_t round, std::size_t players) noexcept {
    // 0, 1, -1, 2, -2 and so on.
    const std::size_t apart = place % 2 == 1 ? (place + 1) / 2 : players - place / 2;
    return (round + apart) % players;
}

/// Runs each candidate once, in turn.
template <class Candidate, class Run>
void run_round(std::vector<Candidate>& candidates, std::size_t round, Run run) {
    for (std::size_t place = 0; place < candidates.size(); ++place)
        run(candidates[in_turn(place, round, candidates.size())]);
}

/// Which rounds are run, by their numbers.
struct round_limits {
    std::size_t end;
    std::size_t begin = 0;
    std::size_t fewest = 0;  ///< rounds before this one are run however little time is left
    /// Seconds; where it is given, no round begins for which there is no more time than the one before took.
    std::function<double()> left = nullptr;
    double expected = 0;  ///< seconds that the first takes
};

/// Runs candidates in turn, round after round, as long as there are any.
/// @param run takes a candidate and the number of the round
/// @param after follows a round, with its number; it may remove candidates, which the next round does without
/// @returns the first round that was not run
template <class Candidate, class Run, class After>
std::size_t run_rounds(std::vector<Candidate>& candidates, const round_limits& limits, Run run, After after) {
    double last = limits.expected;
    std::size_t round = limits.begin;
    for (; round < limits.end && !candidates.empty(); ++round) {
        const double left = limits.left ? limits.left() : std::numeric_limits<double>::infinity();
        if (round >= limits.fewest && left <= last) break;
        run_round(candidates, round, [&](Candidate& one) { run(one, round); });
        if (limits.left) last = left - limits.left();
        after(round);
    }
    return round;
}

/// Who takes so many times as long as another is hopeless: who is disturbed takes a few times as long, never so many.
inline constexpr double hopeless_ratio = 20;

/// When to give up on a candidate, by what another takes for the same.
struct stopping_rule {
    double ratio = hopeless_ratio;
    double grace = 0;  ///< seconds that are too short to matter; added to each limit
    /// No candidate gets more, so that a few do not take all time, unless it stays within `margin` times the other.
    double share = std::numeric_limits<double>::infinity();
    double margin = 1;

    [[nodiscard]] double hopeless_after(double other) const { return grace + ratio * other; }
    [[nodiscard]] double longest(double other) const {
        return std::min(hopeless_after(other), grace + std::max(share, margin * other));
    }
};

/// When to end. What is to take S seconds ends within 2 S, or 2 seconds after the scene is read where that is later:
/// half of it is for playing, the rest for comparing with the exact pairs. A twentieth is kept for ending and telling.
class time_limits {
public:
    /// @param seconds at most 1,000,000
    /// @param elapsed in seconds
    explicit time_limits(double seconds, std::function<double()> elapsed = since_now())
        : seconds_(seconds), elapsed_(std::move(elapsed)) {}

    void scene_is_read() { reading_ = elapsed_(); }
    /// Seconds that are left, none where it is not above 0.
    [[nodiscard]] double to_play() const { return std::max(usable * seconds_, reading_ + usable) - elapsed_(); }
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

/// Of the times of two in the same rounds, one's over the other's.
struct paired_ratio {
    double median = 1;
    double least = 1;
    double greatest = 1;

    /// Whether the rounds leave it open which of the two is faster by more than 3 %. One round leaves all open.
    [[nodiscard]] bool may_be_same() const { return least == greatest || (least < 1.03 && greatest > 1 / 1.03); }
};
/// @param ms one or more, by round, as are those of the other
[[nodiscard]] paired_ratio paired_ratio_of(std::span<const double> ms, std::span<const double> of_other);

}  // namespace aabblab
