export module aabb.wide_tree.leaf_front;

export import aabb.geometry;
export import aabb.simd;
import aabb.std;

export namespace aabb {

/// Two models, by their numbers, and as they are: each refit makes another state.
struct model_pair {
    std::array<std::uint64_t, 2> numbers;
    std::array<std::uint64_t, 2> states;
};

/// Two leaves, and which of their triangles may meet: bit 8 j + i for triangle i of A's leaf and j of B's.
struct kept_pair {
    std::uint32_t leaf_a;
    std::uint32_t leaf_b;
    std::uint64_t which;
};

/// Pairs of leaves of two trees whose triangles came within a margin of each other at one pose. As long as no point of
/// B has moved further than that in A's frame, all whose triangles meet are among them. Such pairs are kept from query
/// to query by front tracking (Ehmann and Lin, Computer Graphics Forum 20, 2001), and with a margin by neighbour lists
/// (Verlet, Physical Review 159, 1967).
class leaf_front {
public:
    /// A pair of triangles that met in the last query for one.
    std::optional<index_pair> hit;
    /// Whether it was found again since that was last asked.
    bool is_used = false;

    /// Begins anew, in the same memory.
    void begin(const model_pair& of) noexcept {
        numbers_ = of.numbers;
        last_states_ = {};
        margin_ = -1;
        near_queries_ = failures_ = waits_ = 0;
        hit.reset();
        is_used = false;
    }

    [[nodiscard]] std::span<const kept_pair> pairs() const noexcept { return pairs_; }

    /// Whether all pairs that meet at this pose are among these.
    /// @param reach box of B's vertices, in its own frame
    [[nodiscard]] bool holds(const model_pair& of, const box_motion& at, const box& reach) const noexcept {
        return margin_ >= 0 && made_states_ == of.states && most_apart(made_at_, at, reach) <= margin_;
    }
    /// Whether the last query was one of the same models about there.
    [[nodiscard]] bool is_near(const model_pair& of, const box_motion& at, const box& reach,
                               double near) const noexcept {
        return numbers_ == of.numbers && most_apart(last_at_, at, reach) <= near;
    }

    struct outlook {
        bool holds;                    ///< these pairs, for this query
        std::optional<double> margin;  ///< of others that are worth making
    };
    /// Notes a query. Pairs that do not hold for it are forgotten, and others are worth making where the last two such
    /// queries moved B by little and changed neither mesh, unless those made before were of no use. A margin that
    /// serves long holds many pairs, so that it grows like the root of the step.
    /// @param size of a leaf
    [[nodiscard]] outlook note(const model_pair& of, const box_motion& at, const box& reach, double size) noexcept {
        const bool same_states = last_states_ == of.states;
        const box_motion before = std::exchange(last_at_, at);
        last_states_ = of.states;
        if (holds(of, at, reach)) {
            ++served_;
            return {true, std::nullopt};
        }
        const double step = same_states ? most_apart(before, at, reach) : std::numeric_limits<double>::infinity();
        near_queries_ = step <= most_step * size ? near_queries_ + 1 : 0;
        if (margin_ >= 0) fail_or_forgive();
        if (waits_ > 0) {
            --waits_;
            return {false, std::nullopt};
        }
        if (near_queries_ < least_near_queries) return {false, std::nullopt};
        return {false, std::sqrt(step * size / 5)};
    }

    /// @param fill called as `fill(pairs)`, of which there are none; returns false where there would be too many
    /// @returns whether they are kept
    template <class Fill>
    bool make(const model_pair& of, const box_motion& at, double margin, const Fill& fill) {
        pairs_.clear();
        served_ = 0;
        if (!fill(pairs_)) {
            fail_or_forgive();
            return false;
        }
        made_states_ = of.states;
        made_at_ = at;
        margin_ = margin;
        return true;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(pairs_); }

    /// Of a leaf's size: beyond, so much lies within a margin that serves long that a walk from the roots is faster.
    static constexpr double most_step = 1.0 / 32;

private:
    /// More than one, since some ask twice about every pose of what moves fast.
    static constexpr std::uint32_t least_near_queries = 2;
    static constexpr std::uint32_t least_served = 2;  // below, pairs were not worth their making
    static constexpr std::uint32_t most_failures = 6;

    void fail_or_forgive() noexcept {
        failures_ = served_ < least_served ? std::min(failures_ + 1, most_failures) : 0;
        waits_ = (1U << failures_) - 1;
        margin_ = -1;
    }

    std::array<std::uint64_t, 2> numbers_{};
    std::array<std::uint64_t, 2> last_states_{};  // of a query; no model's at first
    box_motion last_at_{};
    std::array<std::uint64_t, 2> made_states_{};
    box_motion made_at_{};
    double margin_ = -1;  // negative where no pairs are kept
    std::vector<kept_pair> pairs_;
    std::uint32_t near_queries_ = 0;  // in a row
    std::uint32_t served_ = 0;        // queries since these were made
    std::uint32_t failures_ = 0;      // in a row
    std::uint32_t waits_ = 0;         // queries until others may be made
};

/// The fronts of many pairs of objects. Nobody says which object is which: a front is found again by its models and by
/// where they were in its last query, or because its pairs hold, the one behind the last found first, since objects
/// mostly come in the same order.
class front_keeper {
public:
    static constexpr std::size_t most = 1024;
    static constexpr std::size_t least_leaves = 64;  ///< of two meshes: fewer are walked before a front is found

    /// @param reach box of B's vertices, in its own frame
    /// @param near how far B may have moved since the front's last query
    /// @returns the front, or a new one, which has had no query
    [[nodiscard]] leaf_front& find(const model_pair& of, const box_motion& at, const box& reach, double near) {
        const std::array<float, 3> centre = centre_of(at, reach);
        const std::size_t place = place_of(of, at, reach, near, centre);
        for (std::size_t k = 0; k < 3; ++k) centres_[place / width][k][place % width] = centre[k];
        last_ = place;
        return fronts_[place];
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t all = bytes_of(fronts_, centres_);
        for (const leaf_front& f : fronts_) all += f.bytes();
        return all;
    }

private:
    static constexpr std::size_t width = 8;
    using row = std::array<float, width>;

    /// Of B, in A's frame: it moves no further than the rest.
    [[nodiscard]] static std::array<float, 3> centre_of(const box_motion& at, const box& reach) noexcept {
        vec3d centre = at.shift;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                centre[k] +=
                    at.columns[static_cast<std::size_t>(j)][k] * ((double{reach.min[j]} + double{reach.max[j]}) / 2);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2])};
    }

    [[nodiscard]] std::size_t place_of(const model_pair& of, const box_motion& at, const box& reach, double near,
                                       const std::array<float, 3>& centre) {
        const auto is_it = [&](std::size_t place) {
            return fronts_[place].holds(of, at, reach) || fronts_[place].is_near(of, at, reach, near);
        };
        const std::size_t next = last_ + 1 < fronts_.size() ? last_ + 1 : 0;
        if (next < fronts_.size() && is_it(next)) return found_again(next);
        for (std::size_t group = 0; group < centres_.size(); ++group) {
            simd::eight_floats furthest{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto away = __builtin_elementwise_abs(
                    simd::load_eight<simd::eight_floats>(centres_[group][k].data()) - centre[k]);
                furthest = away > furthest ? away : furthest;
            }
            for (std::uint32_t near_ones = simd::bits_of_eight(furthest <= static_cast<float>(near)); near_ones != 0;
                 near_ones &= near_ones - 1) {
                const std::size_t place = group * width + static_cast<std::size_t>(std::countr_zero(near_ones));
                if (place < fronts_.size() && is_it(place)) return found_again(place);
            }
        }
        return new_place(of);
    }

    [[nodiscard]] std::size_t found_again(std::size_t place) noexcept {
        fronts_[place].is_used = true;
        return place;
    }

    /// Of as many as are kept, the next one that was not found again of late makes room.
    [[nodiscard]] std::size_t new_place(const model_pair& of) {
        std::size_t place = fronts_.size();
        if (place < most) {
            if (place == centres_.size() * width) centres_.emplace_back();
            fronts_.emplace_back();
        } else {
            while (std::exchange(fronts_[hand_].is_used, false)) hand_ = (hand_ + 1) % most;
            place = hand_;
            hand_ = (hand_ + 1) % most;
        }
        fronts_[place].begin(of);
        return place;
    }

    std::vector<leaf_front> fronts_;
    std::vector<std::array<row, 3>> centres_;  // of B in the fronts' last queries, by eights
    std::size_t last_ = 0;                     // found
    std::size_t hand_ = 0;                     // where room is sought
};

}  // namespace aabb
