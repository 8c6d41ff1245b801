export module aabb.columns.plan;

export import aabb.columns.kernels;
export import aabb.global_search;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// How boxes are cut into columns that run along one axis. Coordinates are quantized to u16 by a monotone function, so
/// the quantized test is conservative: intervals that are disjoint when quantized are disjoint.
struct column_plan {
    int axis = 0;                               ///< the axis along which columns run
    std::array<std::uint32_t, 2> across{1, 1};  ///< numbers of columns on the next axis and the one after it
    std::uint32_t most_along = 1;               ///< greatest useful number of cuts along the columns
    double groups = 1;  ///< approximate number of groups that are cut into columns separately; 1: no groups
    vec3f origin{};
    vec3f scale{};  ///< factor of the quantization

    [[nodiscard]] constexpr int axis_across(std::size_t i) const noexcept {
        return (axis + 1 + static_cast<int>(i)) % 3;
    }
    [[nodiscard]] constexpr std::uint32_t columns() const noexcept { return across[0] * across[1]; }
    /// Binary logarithm of the number of buckets per column: about one bucket per box, and at least a vector of them.
    [[nodiscard]] constexpr std::uint32_t bucket_bits(std::size_t boxes) const noexcept {
        const auto buckets = static_cast<std::uint32_t>(std::max<std::size_t>(simd::width, boxes / columns()));
        return std::min(16U, static_cast<std::uint32_t>(std::bit_width(buckets - 1)));
    }

    /// Sets the range that is quantized to u16, from 0 to 65,535, as (x - origin) * scale. On an axis without extent
    /// the scale is 0, so that every coordinate becomes 0.
    constexpr void fit(const box& bounds) noexcept {
        origin = bounds.min;
        for (int k = 0; k < 3; ++k) {
            const float extent = bounds.max[k] - bounds.min[k];
            // The double division avoids an overflow of the extent; coordinates that overflow later are clamped.
            if (extent > std::numeric_limits<float>::max())
                scale[k] = static_cast<float>(65'536 / (double{bounds.max[k]} - double{bounds.min[k]}));
            else
                scale[k] = extent > 0 ? 65'536.0F / extent : 0.0F;
        }
    }

    /// Quantizes a coordinate: monotone in x, and clamped to the range.
    [[nodiscard]] inline std::uint32_t quantized(float x, int k) const noexcept {
        const float at = (x - origin[k]) * scale[k];
        return static_cast<std::uint32_t>(at > 0 ? std::min(at, 65'535.0F) : 0.0F);
    }
    [[nodiscard, gnu::always_inline]] inline simd::words quantized(simd::floats x, int k) const noexcept {
        const simd::floats most = simd::broadcast(65'535.0F);
        simd::floats at = (x - origin[k]) * scale[k];
        at = at > 0.0F ? at : simd::floats{};
        at = at < most ? at : most;
        return reinterpret_cast<simd::words>(__builtin_convertvector(at, simd::flags));
    }
};

/// A box in one column. The quantized coordinates on the two axes across are packed as u16, the first axis low.
struct column_entry {
    std::uint32_t lower;
    std::uint32_t upper;
    std::uint32_t end_bucket;  ///< index into `column_block::ends` of the bucket in which the box ends along the column
    std::uint32_t index;       ///< index of the box in the block; for the three highest bits, see `begins_earlier`

    static constexpr int index_bits = 29;
    static constexpr std::uint32_t index_mask = (1U << index_bits) - 1;
    /// Set if the box begins in an earlier column on axis k. If both copies have it set, another column owns the pair.
    [[nodiscard]] static constexpr std::uint32_t begins_earlier(int k) noexcept { return 1U << (index_bits + k); }
};
static_assert(sizeof(column_entry) == 16);

/// Consecutive columns, each padded to a whole number of vectors with entries that overlap nothing. Within a column
/// boxes are ordered by bucket, but unordered within a bucket.
struct column_block {
    std::span<const box> boxes;
    std::span<const std::uint32_t> ids;  ///< as in `column_group`, bits of `begins_earlier` included
    std::span<const column_entry> entries;
    std::span<const std::uint32_t> ends;  ///< by bucket: index of the entry after the bucket's last
    int axis;                             ///< the axis along which columns run

    [[nodiscard]] inline std::uint32_t id_of(std::uint32_t index) const noexcept {
        return ids.empty() ? index : ids[index] & column_entry::index_mask;
    }
};

/// The result of distributing boxes to columns or groups: `invalid` if a box is, `not_worthwhile` if there are too many
/// copies or too many boxes in one group.
enum class fill_result : std::uint8_t { complete, invalid, not_worthwhile };

inline constexpr box everywhere{
    {std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest()},
    {std::numeric_limits<float>::max(), std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}};

/// Calls `visit(index, coordinates, present)` for each vector of boxes, from box `index` on, with the lower ends on
/// three axes and then the upper ones. Copies of the last box pad the last vector; their bits in `present` are not set.
template <class Visit>
inline void for_each_vector(std::span<const box> boxes, Visit visit) {
    simd::floats coordinates[6];
    std::size_t i = 0;
    for (; i + simd::width <= boxes.size(); i += simd::width) {
        simd::load_rows_of_six(boxes[i].min.at, coordinates);
        visit(i, coordinates, simd::every_lane);
    }
    if (i == boxes.size()) return;
    std::array<box, simd::width> rest;
    rest.fill(boxes.back());
    std::ranges::copy(boxes.subspan(i), rest.begin());
    simd::load_rows_of_six(rest[0].min.at, coordinates);
    visit(i, coordinates, simd::lanes_below(boxes.size() - i));
}

/// The exact complement of `is_valid`, by lanes.
[[nodiscard, gnu::always_inline]] inline simd::flags are_invalid(const simd::floats (&coordinates)[6]) noexcept {
    constexpr float most = std::numeric_limits<float>::max();
    simd::flags valid = coordinates[0] >= -most;
    for (int k = 0; k < 3; ++k)
        valid &= (coordinates[k] >= -most) & (coordinates[k] <= coordinates[3 + k]) & (coordinates[3 + k] <= most);
    return ~valid;
}

/// A partition into columns: `plan(boxes, within)` is the plan for boxes clipped to the bounds,
/// `brute_force_threshold()` the greatest number of boxes that are tested by brute force, `group_size(n)` the size of a
/// group in a scene of n boxes, and `threads()` the number of threads that search groups.
template <class P>
concept ColumnPartition =
    PartitionPolicy<P> && requires(const P policy, std::span<const box> boxes, const box& within) {
        { policy.plan(boxes, within) } -> std::same_as<column_plan>;
        { policy.brute_force_threshold() } -> std::same_as<std::size_t>;
        { policy.group_size(boxes.size()) } -> std::same_as<std::size_t>;
        { policy.threads() } -> std::same_as<unsigned>;
    };

/// A sweep that also takes columns. It returns its number of vector tests, and stops early once these exceed `most`.
template <class S>
concept ColumnSweep = SweepPolicy<S> && requires(S policy, const column_block& block, std::vector<index_pair>& pairs,
                                                 std::uint64_t most, no_counters off, work_counters on) {
    { policy.sweep(block, pairs, most, off) } -> std::same_as<std::uint64_t>;
    { policy.sweep(block, pairs, most, on) } -> std::same_as<std::uint64_t>;
};

/// A sort that is satisfied by the buckets into which columns put their boxes, without sorting within a bucket.
template <class S>
concept BucketSort = SortPolicy<S> && requires { requires S::is_done_by_columns; };

}  // namespace aabb
