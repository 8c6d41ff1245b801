/// Who plays when, and for how long.
export module aabblab.trials:turns;

import aabb.std;
import :observation;
import :player;
import :staged_scene;

export namespace aabblab {

/// Who plays at a place of a round, so that it matters to nobody alone after whom one plays: each begins a round, and
/// in as many rounds as there are players, if these are even, follows each other one once; else about so (Williams,
/// "Experimental designs balanced for the estimation of residual effects of treatments", 1949).
[[nodiscard]] constexpr std::size_t in_turn(std::size_t place, std::size_t round, std::size_t players) noexcept {
    // 0, 1, -1, 2, -2 and so on.
    const std::size_t apart = place % 2 == 1 ? (place + 1) / 2 : players - place / 2;
    return (round + apart) % players;
}

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

/// Of those who play in turn, who takes more than so many times as long a frame as the first, and so long in all that
/// it matters, is stopped, or plays in one round only.
inline constexpr double hopeless_ratio = 20;
inline constexpr double hopeless_ms = 100;

/// What came of playing in turn, by contender.
struct turns {
    std::size_t frames = 0;  ///< in each play: as many as there was time for
    std::size_t rounds = 0;
    std::vector<std::vector<observation>> times;     ///< of whole plays, by round
    std::vector<std::optional<attempt>> broken_off;  ///< whose first play did not end
    std::vector<bool> hopeless;                      ///< who took, or would have taken, so many times as long
};

/// Plays the first frames of the scene with all in turn (`in_turn`), round after round, until time is over. Without the
/// first, whose first frame may take too long, nobody else plays.
[[nodiscard]] turns play_in_turn(staged_scene& scene, std::span<const contender> all, std::size_t frames,
                                 std::size_t rounds, const time_limits& limits);

/// Those of them, by place, who find other pairs than the first in as many frames.
[[nodiscard]] std::vector<std::size_t> who_disagrees(std::span<const std::vector<observation>> times);

/// By round.
[[nodiscard]] std::vector<double> frame_ms_of(std::span<const observation> times);

/// Of the times of two in the same rounds, one's over the other's.
struct paired_ratio {
    double median = 1;
    double least = 1;
    double greatest = 1;

    /// Whether the rounds leave it open which of the two is faster by more than 3 %.
    [[nodiscard]] bool may_be_same() const { return least < 1.03 && greatest > 1 / 1.03; }
};
/// @param ms one or more, by round, as are those of the other
[[nodiscard]] paired_ratio paired_ratio_of(std::span<const double> ms, std::span<const double> of_other);

}  // namespace aabblab
