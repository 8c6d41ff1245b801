/// Decides of eight pairs of triangles at once whether they are within a distance.
export module aabb.distance.near_batch;

export import aabb.geometry;
import aabb.distance.rounded_triangles;
import aabb.distance.triangle_distance;
import aabb.simd;
import aabb.std;

export namespace aabb {

/// Queues pairs of triangles of two meshes until they fill SIMD vectors. Rounded bounds decide most of the eight
/// (`rounded_pairs`), and integers the others.
class near_batch {
public:
    void clear() noexcept { count_ = 0; }
    [[nodiscard]] inline bool is_full() const noexcept { return count_ == width; }

    /// Adds a pair to a batch that is not full.
    inline void add(index_pair pair, const triangle3d& s, const triangle3d& t) noexcept {
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                s_[place(i, k)][count_] = s[i][k];
                t_[place(i, k)][count_] = t[i][k];
            }
        pairs_[count_++] = pair;
    }

    /// Passes the pairs at a distance of at most d to `take`, and clears the batch.
    template <class Take>
    void decide(const pose_pair& poses, double d, const Take& take) {
        const std::size_t count = std::exchange(count_, 0);
        if (count == 0) return;
        const auto [within, farther] = rounded_pairs<simd::eight_doubles>(poses, eight(s_), eight(t_)).decide(d);
        for (std::size_t lane = 0; lane < count; ++lane)
            if ((within >> lane & 1U) != 0 ||
                ((farther >> lane & 1U) == 0 && are_within_unrounded(poses, triangle(s_, lane), triangle(t_, lane), d)))
                take(pairs_[lane]);
    }

    /// Passes the pairs that are not certainly farther than d to `take`, with their triangles, until it returns true,
    /// and clears the batch.
    /// @returns whether it did
    template <class Take>
    bool each_not_farther(const pose_pair& poses, double d, const Take& take) {
        const std::size_t count = std::exchange(count_, 0);
        if (count == 0) return false;
        const auto [within, farther] = rounded_pairs<simd::eight_doubles>(poses, eight(s_), eight(t_)).decide(d);
        for (std::size_t lane = 0; lane < count; ++lane)
            if ((farther >> lane & 1U) == 0 && take(pairs_[lane], triangle(s_, lane), triangle(t_, lane))) return true;
        return false;
    }

private:
    static constexpr std::size_t width = 8;
    using rows = std::array<std::array<double, width>, 9>;  // by corner, then axis

    [[nodiscard]] static constexpr std::size_t place(int corner, int axis) noexcept {
        return static_cast<std::size_t>(3 * corner + axis);
    }
    [[nodiscard]] static inline triangle3<simd::eight_doubles> eight(const rows& of) noexcept {
        triangle3<simd::eight_doubles> t;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) t[i][k] = simd::load_eight<simd::eight_doubles>(of[place(i, k)].data());
        return t;
    }
    [[nodiscard]] static inline triangle3d triangle(const rows& of, std::size_t lane) noexcept {
        triangle3d t;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) t[i][k] = of[place(i, k)][lane];
        return t;
    }

    std::size_t count_ = 0;
    alignas(64) rows s_{};
    alignas(64) rows t_{};
    std::array<index_pair, width> pairs_{};
};

}  // namespace aabb
