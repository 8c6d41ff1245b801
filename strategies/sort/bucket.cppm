export module aabb.sort.bucket;

import aabb.global_search;
import aabb.sort.inserting;
import aabb.std;

export namespace aabb {

/// Bucket sort: entries are distributed over as many buckets of equal width as there are entries, then insertion sort
/// orders each bucket. When to use: whenever objects move; linear for uniformly spread objects. Columns are filled
/// bucket by bucket as they are cut, and sorted only if a bucket is crowded.
class bucket_sort {
public:
    static constexpr std::string_view name = "bucket";
    static constexpr std::string_view summary =
        "bucket sort with one bucket of equal width per entry: linear for uniformly spread entries";
    static constexpr bool is_done_by_columns = true;

    /// Distributes the entries by a counting sort of their buckets, and sorts each bucket.
    template <CounterPolicy Counters>
    void sort(std::span<projection> list, Counters& counters) {
        if (list.size() < 2) return;
        const auto [least, greatest] = std::ranges::minmax(list, {}, &projection::key);
        if (!(least.key < greatest.key)) return;
        const std::size_t buckets = std::bit_ceil(list.size());
        const double scale = static_cast<double>(buckets - 1) / (double{greatest.key} - double{least.key});
        const auto bucket_of = [&](const projection& p) {
            return static_cast<std::size_t>((double{p.key} - double{least.key}) * scale);
        };
        starts_.assign(buckets + 1, 0);
        for (const projection& p : list) ++starts_[bucket_of(p) + 1];
        for (std::size_t b = 0; b < buckets; ++b) starts_[b + 1] += starts_[b];
        from_.assign(list.begin(), list.end());
        for (const projection& p : from_) list[starts_[bucket_of(p)]++] = p;
        counters.add(work::moves, list.size());
        sort_buckets(list, counters);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(starts_, from_); }

private:
    /// Sorts each bucket by insertion; those with many entries by std::sort, since insertion sort is quadratic.
    template <CounterPolicy Counters>
    void sort_buckets(std::span<projection> list, Counters& counters) const {
        constexpr std::size_t most_to_insert = 64;
        std::size_t begin = 0;
        for (const std::uint32_t end : std::span(starts_).first(starts_.size() - 1)) {
            const std::span bucket = list.subspan(begin, end - begin);
            begin = end;
            if (bucket.size() > most_to_insert)
                std::ranges::sort(bucket, [&](const projection& p, const projection& q) {
                    counters.add(work::comparisons);
                    return precedes(p, q);
                });
            else
                insert_each(bucket, counters);
        }
    }

    std::vector<std::uint32_t> starts_;
    std::vector<projection> from_;
};

static_assert(SortPolicy<bucket_sort>);

}  // namespace aabb
