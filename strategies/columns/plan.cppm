export module aabb.columns.plan;

export import aabb.columns.kernels;
export import aabb.global_search;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// How boxes are cut into columns that run along one axis. Coordinates are taken to whole numbers of 0 to 65,535,
/// rounded down, so that of two that overlap none lies beyond the other: what is apart in whole numbers is apart.
struct column_plan {
    int axis = 0;                               ///< along which columns run
    std::array<std::uint32_t, 2> across{1, 1};  ///< how many columns on the next axis and the one after it
    std::uint32_t most_along = 1;               ///< how many boxes fit one behind the other along them
    double groups = 1;  ///< of neighbours, about, into which boxes are put before each is cut for itself; 1: none
    vec3f origin{};
    vec3f scale{};  ///< to the whole numbers

    [[nodiscard]] constexpr int axis_across(std::size_t i) const noexcept {
        return (axis + 1 + static_cast<int>(i)) % 3;
    }
    [[nodiscard]] constexpr std::uint32_t columns() const noexcept { return across[0] * across[1]; }

    /// About as many buckets as a column of so many boxes has of them, and at least a vector of them: 2 to this power.
    [[nodiscard]] constexpr std::uint32_t bucket_bits(std::size_t boxes) const noexcept {
        const auto each = static_cast<std::uint32_t>(std::max<std::size_t>(simd::width, boxes / columns()));
        return std::min(16U, static_cast<std::uint32_t>(std::bit_width(each - 1)));
    }

    /// Whole numbers over these bounds. Where an axis has no extent all are 0.
    constexpr void fit(const box& bounds) noexcept {
        origin = bounds.min;
        for (int k = 0; k < 3; ++k) {
            const float extent = bounds.max[k] - bounds.min[k];
            // What overflows here does so where `whole` takes it for the last number, which is no less.
            if (extent > std::numeric_limits<float>::max())
                scale[k] = static_cast<float>(65'536 / (double{bounds.max[k]} - double{bounds.min[k]}));
            else
                scale[k] = extent > 0 ? 65'536.0F / extent : 0.0F;
        }
    }

    /// Rises with x, wherever x lies.
    [[nodiscard]] inline std::uint32_t whole(float x, int k) const noexcept {
        const float at = (x - origin[k]) * scale[k];
        return static_cast<std::uint32_t>(at > 0 ? std::min(at, 65'535.0F) : 0.0F);
    }
    [[nodiscard, gnu::always_inline]] inline simd::words whole(simd::floats x, int k) const noexcept {
        const simd::floats most = simd::all(65'535.0F);
        simd::floats at = (x - origin[k]) * scale[k];
        at = at > 0.0F ? at : simd::floats{};
        at = at < most ? at : most;
        return reinterpret_cast<simd::words>(__builtin_convertvector(at, simd::flags));
    }
};

/// A box in one column. Numbers on the two axes across stand in one word, those of the first one low.
struct column_entry {
    std::uint32_t lower;
    std::uint32_t upper;
    std::uint32_t reach;  ///< which of `column_block::ends` says where the box ends along the column
    std::uint32_t index;  ///< of the box among those of the block; the three highest bits: see `later_on`

    static constexpr std::uint32_t index_bits = (std::uint32_t{1} << 29) - 1;
    /// Set where the box begins on axis k in an earlier column: of two such copies another column has the pair.
    [[nodiscard]] static constexpr std::uint32_t later_on(int k) noexcept { return std::uint32_t{1} << (29 + k); }
};
static_assert(sizeof(column_entry) == 16);

/// Columns one behind the other, each filled up to a whole vector with entries that overlap none, and in each its boxes
/// bucket after bucket, in no order within a bucket.
struct column_block {
    std::span<const box> boxes;
    std::span<const std::uint32_t> ids;  ///< by index, maybe with bits of `later_on`; empty where the index is the id
    std::span<const column_entry> entries;
    std::span<const std::uint32_t> ends;  ///< by bucket: how many entries stand before the next one
    int axis;                             ///< along which columns run

    [[nodiscard]] inline std::uint32_t id_of(std::uint32_t index) const noexcept {
        return ids.empty() ? index : ids[index] & column_entry::index_bits;
    }
};

/// What came of bringing boxes to their places: with an invalid one, or with more copies or boxes at one place than are
/// allowed, nothing.
enum class fill_result : std::uint8_t { whole, invalid, crowded };

inline constexpr box everywhere{
    {std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest()},
    {std::numeric_limits<float>::max(), std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}};

/// Calls `visit(place, coordinates, present)` for each vector of boxes: lower ends on three axes, then upper ones. What
/// the last one holds too many are copies of the last box, and have no bit in `present`.
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

/// Where `is_valid` does not hold; nowhere else.
[[nodiscard, gnu::always_inline]] inline simd::flags are_invalid(const simd::floats (&coordinates)[6]) noexcept {
    constexpr float most = std::numeric_limits<float>::max();
    simd::flags valid = coordinates[0] >= -most;
    for (int k = 0; k < 3; ++k)
        valid &= (coordinates[k] >= -most) & (coordinates[k] <= coordinates[3 + k]) & (coordinates[3 + k] <= most);
    return ~valid;
}

/// A partition into columns: `plan(boxes, within)` says into which columns boxes are cut, of which only what lies
/// within the bounds counts; `few()` says of how many nothing is cut, `group(n)` how many of n boxes are cut together,
/// and `threads()` how many threads take such groups.
template <class P>
concept ColumnPartition =
    PartitionPolicy<P> && requires(const P policy, std::span<const box> boxes, const box& within) {
        { policy.plan(boxes, within) } -> std::same_as<column_plan>;
        { policy.few() } -> std::same_as<std::size_t>;
        { policy.group(boxes.size()) } -> std::same_as<std::size_t>;
        { policy.threads() } -> std::same_as<unsigned>;
    };

/// A sweep of columns, too. It returns how many tests of a vector it made; once these are more than `most`, it stops,
/// and the pairs are not all.
template <class S>
concept ColumnSweep = SweepPolicy<S> && requires(S policy, const column_block& block, std::vector<index_pair>& pairs,
                                                 std::uint64_t most, no_counters none, work_counters some) {
    { policy.sweep(block, pairs, most, none) } -> std::same_as<std::uint64_t>;
    { policy.sweep(block, pairs, most, some) } -> std::same_as<std::uint64_t>;
};

/// A sort whose work columns do as they are cut: they bring boxes into buckets, and need no more.
template <class S>
concept BucketSort = SortPolicy<S> && requires { requires S::is_done_by_columns; };

}  // namespace aabb
