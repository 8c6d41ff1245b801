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

    /// Distributes the entries over about as many buckets of equal width by a counting sort, and sorts each bucket.
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
        next_.assign(buckets + 1, 0);
        for (const projection& p : list) ++next_[bucket_of(p) + 1];
        for (std::size_t b = 0; b < buckets; ++b) next_[b + 1] += next_[b];  // where bucket b + 1 begins
        from_.assign(list.begin(), list.end());
        for (const projection& p : from_) list[next_[bucket_of(p)]++] = p;  // finally next_[b] is the end of bucket b
        counters.add(work::moves, list.size());
        sort_buckets(list, counters);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(next_, from_); }

private:
    /// Sorts each bucket, b ending at `next_[b]`: by insertion, or a large one by std::sort, as insertion is quadratic.
    template <CounterPolicy Counters>
    void sort_buckets(std::span<projection> list, Counters& counters) const {
        constexpr std::size_t most_to_insert = 64;
        std::size_t begin = 0;
        for (const std::uint32_t end : std::span(next_).first(next_.size() - 1)) {
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

    std::vector<std::uint32_t> next_;  // by bucket: where its next entry goes
    std::vector<projection> from_;
};

static_assert(SortPolicy<bucket_sort>);

}  // namespace aabb
