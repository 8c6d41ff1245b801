export module aabb.wide_tree.bvtt_front;

export import aabb.geometry;
export import aabb.simd;
import aabb.std;

export namespace aabb {

/// Identifies two models by their numbers and their states; each refit changes the state.
struct model_pair {
    std::array<std::uint64_t, 2> numbers;
    std::array<std::uint64_t, 2> states;
};

/// Two leaves and a mask of the pairs of triangles that may meet: bit 8 j + i for triangle i of A's leaf and j of B's.
struct front_pair {
    std::uint32_t leaf_a;
    std::uint32_t leaf_b;
    std::uint64_t mask;
};

/// BVTT front tracking with a skin: the pairs of leaves of two trees whose triangles were within a margin at one pose.
/// While no point of B moves further than the margin in A's frame, they include all pairs whose triangles meet. Front
/// tracking keeps pairs from query to query (Ehmann and Lin, Computer Graphics Forum 20, 2001); the margin is the skin
/// of Verlet lists (Verlet, Physical Review 159, 1967).
class bvtt_front {
public:
    /// The pair of triangles that the last first-pair query reported.
    std::optional<index_pair> hit;
    /// Whether the front was reused since the cache last looked for one to replace.
    bool is_recently_used = false;

    /// Drops the front and all history for another pair of models, and keeps the memory of its pairs.
    void reset(const model_pair& models) noexcept {
        model_numbers_ = models.numbers;
        last_states_ = {};
        margin_ = no_front;
        near_queries_ = failures_ = queries_to_wait_ = 0;
        hit.reset();
        is_recently_used = false;
    }

    [[nodiscard]] std::span<const front_pair> pairs() const noexcept { return pairs_; }

    /// Whether the pairs include all intersecting ones at this pose.
    /// @param bounds the box of B's vertices, in B's frame
    [[nodiscard]] bool is_valid(const model_pair& models, const box_motion& motion, const box& bounds) const noexcept {
        return has_front() && front_states_ == models.states &&
               displacement_bound(front_motion_, motion, bounds) <= margin_;
    }
    /// Whether the last query had the same models at a nearby pose.
    [[nodiscard]] bool is_near(const model_pair& models, const box_motion& motion, const box& bounds,
                               double near) const noexcept {
        return model_numbers_ == models.numbers && displacement_bound(last_motion_, motion, bounds) <= near;
    }

    struct decision {
        bool is_valid;                 ///< whether the pairs are valid for this query
        std::optional<double> margin;  ///< the margin of a new front, if one is worth its cost
    };
    /// Records a query, and decides whether the front serves it, or a new one is worth its cost; otherwise the caller
    /// walks from the roots. A front is built after two queries in a row that moved B little and changed neither mesh,
    /// later after fronts that served too few. A front of margin m lasts about m / step queries, and a larger m adds
    /// pairs: the best m grows with sqrt(step), where `step` is B's motion between two queries.
    /// @param motion the pose of B in A's frame
    /// @param bounds the box of B's vertices, in B's frame
    /// @param leaf_size the edge length of a leaf
    [[nodiscard]] decision record_query(const model_pair& models, const box_motion& motion, const box& bounds,
                                        double leaf_size) noexcept {
        const bool same_states = last_states_ == models.states;
        const box_motion before = std::exchange(last_motion_, motion);
        last_states_ = models.states;
        if (is_valid(models, motion, bounds)) {
            ++served_queries_;
            return {.is_valid = true, .margin = std::nullopt};
        }
        const double step =
            same_states ? displacement_bound(before, motion, bounds) : std::numeric_limits<double>::infinity();
        near_queries_ = step <= most_step * leaf_size ? near_queries_ + 1 : 0;
        if (has_front()) drop_front();
        const bool must_wait = queries_to_wait_ > 0;
        queries_to_wait_ -= must_wait;
        if (must_wait || near_queries_ < least_near_queries) return {.is_valid = false, .margin = std::nullopt};
        return {.is_valid = false, .margin = std::sqrt(step * leaf_size / 5)};
    }

    /// Builds a new front. If there are too many pairs, it counts as one that served no query, to be tried again later.
    /// @param fill called as `fill(pairs)` with an empty list; returns false if there are too many pairs
    /// @returns whether the front is kept
    template <class Fill>
    bool build(const model_pair& models, const box_motion& motion, double margin, const Fill& fill) {
        pairs_.clear();
        served_queries_ = 0;
        if (!fill(pairs_)) {
            drop_front();
            return false;
        }
        front_states_ = models.states;
        front_motion_ = motion;
        margin_ = margin;
        return true;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(pairs_); }

    /// The longest step, in leaf sizes. For a longer one, the pairs of a front take longer than a walk from the roots.
    static constexpr double most_step = 1.0 / 32;

private:
    /// More than one, since some callers query every pose twice, even of fast objects.
    static constexpr std::uint32_t least_near_queries = 2;
    static constexpr std::uint32_t least_served = 2;  // fewer do not repay the front
    static constexpr std::uint32_t most_failures = 6;
    static constexpr double no_front = -1;

    [[nodiscard]] bool has_front() const noexcept { return margin_ >= 0; }
    /// Ends the front. After fronts in a row that served too few queries, ever more queries follow without one.
    void drop_front() noexcept {
        failures_ = served_queries_ < least_served ? std::min(failures_ + 1, most_failures) : 0;
        queries_to_wait_ = (1U << failures_) - 1;
        margin_ = no_front;
    }

    std::array<std::uint64_t, 2> model_numbers_{};
    std::array<std::uint64_t, 2> last_states_{};  // of the last query; initially of no model
    box_motion last_motion_{};
    std::array<std::uint64_t, 2> front_states_{};
    box_motion front_motion_{};
    double margin_ = no_front;
    std::vector<front_pair> pairs_;
    std::uint32_t near_queries_ = 0;    // in a row
    std::uint32_t served_queries_ = 0;  // since the front was built
    std::uint32_t failures_ = 0;        // in a row
    std::uint32_t queries_to_wait_ = 0;
};

/// Caches the fronts of many pairs of objects. Queries carry no object ids: a front is recognised by its models, A and
/// B, and their last pose, or because its pairs are still valid. Poses are those of B in A's frame (`box_motion`).
class front_cache {
public:
    static constexpr std::size_t most = 1024;
    static constexpr std::size_t least_leaves = 64;  ///< of both meshes: with fewer, a walk costs less than the lookup

    /// @param bounds the box of B's vertices, in B's frame
    /// @param near how far B may have moved since the front's last query
    /// @returns the cached front, or a new, empty one
    [[nodiscard]] bvtt_front& find(const model_pair& models, const box_motion& motion, const box& bounds, double near) {
        const std::array<float, 3> centre = centre_of(motion, bounds);
        last_ = index_of(models, motion, bounds, near, centre);
        for (std::size_t k = 0; k < 3; ++k) centres_[last_ / width][k][last_ % width] = centre[k];
        return fronts_[last_];
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = bytes_of(fronts_, centres_);
        for (const bvtt_front& f : fronts_) total += f.bytes();
        return total;
    }

private:
    static constexpr std::size_t width = 8;
    using row = std::array<float, width>;

    /// The centre of B's box in A's frame, a cheap first comparison: if it has moved by more than `near` since the last
    /// query of a front, `displacement_bound`, which holds for all points of the box, is greater than `near`, too.
    [[nodiscard]] static std::array<float, 3> centre_of(const box_motion& motion, const box& bounds) noexcept {
        vec3d centre = motion.shift;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                centre[k] += motion.columns[static_cast<std::size_t>(j)][k] *
                             ((double{bounds.min[j]} + double{bounds.max[j]}) / 2);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2])};
    }

    /// Finds or adds the front of a query: first the one behind the last, since objects mostly come in the same order,
    /// then, compared eight at a time, those whose centre of B's box is within `near` on each axis.
    /// @param centre the centre of B's box in A's frame
    [[nodiscard]] std::size_t index_of(const model_pair& models, const box_motion& motion, const box& bounds,
                                       double near, const std::array<float, 3>& centre) {
        const auto matches = [&](std::size_t i) {
            return fronts_[i].is_valid(models, motion, bounds) || fronts_[i].is_near(models, motion, bounds, near);
        };
        const std::size_t next = last_ + 1 < fronts_.size() ? last_ + 1 : 0;
        if (next < fronts_.size() && matches(next)) return mark_used(next);
        for (std::size_t group = 0; group < centres_.size(); ++group) {  // of eight fronts
            simd::eight_floats greatest{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto distance = __builtin_elementwise_abs(
                    simd::load_eight<simd::eight_floats>(centres_[group][k].data()) - centre[k]);
                greatest = distance > greatest ? distance : greatest;
            }
            for (std::uint32_t near_fronts = simd::bits_of_eight(greatest <= static_cast<float>(near));
                 near_fronts != 0; near_fronts &= near_fronts - 1) {
                const std::size_t i = group * width + static_cast<std::size_t>(std::countr_zero(near_fronts));
                if (i < fronts_.size() && matches(i)) return mark_used(i);
            }
        }
        return add_front(models);
    }

    [[nodiscard]] std::size_t mark_used(std::size_t front) noexcept {
        fronts_[front].is_recently_used = true;
        return front;
    }

    /// Adds a front. A full cache evicts one by the clock algorithm: the first not reused since the hand passed it.
    [[nodiscard]] std::size_t add_front(const model_pair& models) {
        std::size_t added = fronts_.size();
        if (added < most) {
            if (added == centres_.size() * width) centres_.emplace_back();
            fronts_.emplace_back();
        } else {
            while (std::exchange(fronts_[clock_hand_].is_recently_used, false)) clock_hand_ = (clock_hand_ + 1) % most;
            added = clock_hand_;
            clock_hand_ = (clock_hand_ + 1) % most;
        }
        fronts_[added].reset(models);
        return added;
    }

    std::vector<bvtt_front> fronts_;
    std::vector<std::array<row, 3>> centres_;  // of B in the fronts' last queries, in groups of eight
    std::size_t last_ = 0;                     // the front found last
    std::size_t clock_hand_ = 0;               // the front to evict next, unless it was reused
};

}  // namespace aabb
