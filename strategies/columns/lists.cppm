export module aabb.columns.lists;

export import aabb.columns.plan;
import aabb.std;

export namespace aabb {

/// Cuts boxes into columns and sorts each column, for one sweep.
///
/// Each box is quantized once. Its quantized coordinates yield its column and its bucket, and a counting sort puts it
/// behind the boxes of its column that begin earlier.
class column_lists {
public:
    /// Puts boxes into all columns, cells of a grid on two axes, that they overlap, by a counting sort. Columns are
    /// ordered by buckets, intervals of the third axis or, if the sort policy requires it, by exact keys.
    /// @param ids by index in `boxes`; empty if the index is the id
    /// @param by_keys whether to sort by exact keys even if the sort policy would accept unsorted buckets
    /// @param most_copies limit on the copies; beyond it the result is `not_worthwhile`
    /// @returns `complete`, or else there is nothing to sweep
    template <class Sort, CounterPolicy Counters>
    [[nodiscard]] fill_result fill(std::span<const box> boxes, std::span<const std::uint32_t> ids,
                                   const column_plan& plan, bool by_keys, std::size_t most_copies, Sort& sort,
                                   Counters& counters) {
        const bool in_buckets = BucketSort<Sort> && !by_keys;
        const std::uint32_t bucket_bits = in_buckets ? plan.bucket_bits(boxes.size()) : 0;  // 0: a column is one bucket
        const fill_result result = fill_buckets(boxes, ids, plan, bucket_bits, most_copies);
        if (result != fill_result::complete) return result;
        counters.add(work::moves, copies());
        if (!in_buckets) {
            sort_columns(sort, counters);
            block_.ends = ends_;
        }
        return fill_result::complete;
    }

    /// The same with columns that are ordered by buckets.
    /// @param bucket_bits binary logarithm of the number of buckets of a column
    [[nodiscard]] fill_result fill_buckets(std::span<const box> boxes, std::span<const std::uint32_t> ids,
                                           const column_plan& plan, std::uint32_t bucket_bits,
                                           std::size_t most_copies) {
        block_ = {.boxes = boxes, .ids = ids, .entries = {}, .ends = {}, .axis = plan.axis};
        plan_ = plan;
        bucket_bits_ = bucket_bits;
        if (const fill_result result = count_boxes(most_copies); result != fill_result::complete) return result;
        const std::uint32_t entries = allocate_columns();
        write_entries();
        block_.entries = std::span(entries_).first(entries);
        block_.ends = ends_;
        return fill_result::complete;
    }

    /// Total number of boxes over all columns.
    [[nodiscard]] std::size_t copies() const noexcept { return block_.boxes.size() + copies_.size(); }
    [[nodiscard]] const column_block& block() const noexcept { return block_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(quantized_, copies_, entries_, ends_, list_, moved_, column_ends_);
    }

private:
    static constexpr std::uint32_t width = simd::width;
    static constexpr std::size_t boxes_at_a_time = 1024;

    /// A box as an entry of its first column.
    struct quantized_box {
        std::uint32_t lower;
        std::uint32_t upper;
        std::uint32_t end_bucket;
        std::uint32_t bucket;  ///< bucket of its lower end in its first column
    };
    /// A copy of a box in another column.
    struct copy {
        std::uint32_t index;    ///< index of the box, with bits of `begins_earlier`
        std::uint32_t buckets;  ///< offset to the bucket in the first column
    };

    /// The first pass: quantizes the boxes, counts them by bucket (`ends_`), and lists the copies of those that overlap
    /// several columns, in blocks that stay in the L1 cache meanwhile.
    [[nodiscard]] fill_result count_boxes(std::size_t most_copies) {
        quantized_.resize(block_.boxes.size() + width);
        copies_.clear();
        ends_.clear();
        ends_.resize((std::size_t{plan_.columns()} << bucket_bits_) + width);
        for (std::size_t begin = 0; begin < block_.boxes.size(); begin += boxes_at_a_time) {
            const auto boxes = block_.boxes.subspan(begin, std::min(boxes_at_a_time, block_.boxes.size() - begin));
            const bool valid = plan_.axis == 0   ? quantize<0>(boxes, begin)
                               : plan_.axis == 1 ? quantize<1>(boxes, begin)
                                                 : quantize<2>(boxes, begin);
            if (!valid) return fill_result::invalid;
            for (const quantized_box& b : std::span(quantized_).subspan(begin, boxes.size())) ++ends_[b.bucket];
            if (!add_copies(most_copies)) return fill_result::not_worthwhile;
        }
        return fill_result::complete;
    }

    /// Quantizes boxes by vectors to entries of their first columns, which run along `Axis`, and lists boxes in several
    /// columns in `spanning_boxes_`.
    /// @param begin index of the first of these boxes
    /// @returns whether all boxes are valid
    template <int Axis>
    [[nodiscard]] bool quantize(std::span<const box> boxes, std::size_t begin) {
        constexpr int u = (Axis + 1) % 3;
        constexpr int v = (Axis + 2) % 3;
        const column_plan plan = plan_;
        const std::uint32_t bits = bucket_bits_;
        // Each u32 word holds two u16, that of axis u low and that of axis v high; c has three lower, three upper ends.
        // A quantized coordinate times the number of columns, >> 16, is its column.
        const simd::words across = simd::broadcast(plan.across[0] | plan.across[1] << 16);
        simd::flags invalid{};
        std::size_t spanning = 0;
        for_each_vector(boxes, [&](std::size_t i, const simd::floats(&c)[6], std::uint32_t present) {
            invalid |= are_invalid(c);
            const simd::words lower = plan.quantized(c[u], u) | plan.quantized(c[v], v) << 16;
            const simd::words upper = plan.quantized(c[3 + u], u) | plan.quantized(c[3 + v], v) << 16;
            const simd::words first = simd::high_products(lower, across);
            const simd::words last = simd::high_products(upper, across);
            // Columns have 2^bits buckets; the high bits of the coordinate along the column select one.
            const simd::words first_bucket = ((first & 0xffffU) + (first >> 16) * plan.across[0]) << bits;
            const simd::words begin_bucket = first_bucket + (plan.quantized(c[Axis], Axis) >> (16 - bits));
            const simd::words end_bucket = first_bucket + (plan.quantized(c[3 + Axis], Axis) >> (16 - bits));
            simd::store_rows_of_four(&quantized_[begin + i].lower, {lower, upper, end_bucket, begin_bucket});
            spanning +=
                simd::compress_store(&spanning_boxes_[spanning], simd::places() + static_cast<std::uint32_t>(begin + i),
                                     simd::bits(first != last) & present);
        });
        spanning_count_ = spanning;
        return simd::bits(invalid) == 0;
    }

    /// Lists a copy of each box in `spanning_boxes_` for each of its columns but the first, and counts it in its
    /// bucket. Bits in its index mark the axes on which the box begins in an earlier column, so that only one column
    /// reports a pair.
    /// @returns whether the number of copies is within the limit
    [[nodiscard]] bool add_copies(std::size_t most_copies) {
        const std::uint32_t begins_earlier[2] = {column_entry::begins_earlier(plan_.axis_across(0)),
                                                 column_entry::begins_earlier(plan_.axis_across(1))};
        const std::uint32_t buckets_of_column = std::uint32_t{1} << bucket_bits_;
        const std::uint32_t buckets_of_row = plan_.across[0] << bucket_bits_;
        // On axis k across: the number of columns after the first that a box overlaps.
        const auto further_columns = [&](const quantized_box& b, std::size_t k) {
            const auto column_of = [&](std::uint32_t packed) {
                return (packed >> 16 * k & 0xffffU) * plan_.across[k] >> 16;
            };
            return column_of(b.upper) - column_of(b.lower);
        };
        constexpr std::size_t most_at_once = 3;  // copies between two checks whether the buffer is full
        std::array<copy, 64> buffer;
        std::size_t n = 0;
        const auto flush = [&] { copies_.insert(copies_.end(), buffer.begin(), buffer.begin() + std::exchange(n, 0)); };
        for (const std::uint32_t i : std::span(spanning_boxes_).first(spanning_count_)) {
            const quantized_box b = quantized_[i];
            const std::uint32_t nu = further_columns(b, 0), nv = further_columns(b, 1);
            // Adds the copy in the column that is u and v columns after the first.
            const auto add = [&](std::uint32_t u, std::uint32_t v, std::uint32_t times) {
                const std::uint32_t buckets = u * buckets_of_column + v * buckets_of_row;
                buffer[n] = {i | (u ? begins_earlier[0] : 0) | (v ? begins_earlier[1] : 0), buckets};
                n += times;  // 0 or 1: if 0, the next copy overwrites this one
                ends_[b.bucket + buckets * times] += times;
            };
            if (nu <= 1 && nv <= 1) {
                // Branch-free, since which of the three copies exist is hard to predict.
                add(1, 0, nu);
                add(0, 1, nv);
                add(1, 1, nu & nv);
                if (n + most_at_once > buffer.size()) flush();
                continue;
            }
            for (std::uint32_t v = 0; v <= nv; ++v)
                for (std::uint32_t u = v == 0 ? 1 : 0; u <= nu; ++u) {  // (0, 0) is the first column
                    add(u, v, /*times=*/1);
                    if (n + most_at_once > buffer.size()) flush();
                }
            if (copies_.size() > most_copies) return false;
        }
        flush();
        return copies_.size() <= most_copies;
    }

    /// Places the columns one after another: turns the counts of their buckets (`ends_`) into start indices, and pads
    /// each column to whole vectors with entries that overlap nothing.
    /// @returns the number of entries, including padding
    std::uint32_t allocate_columns() {
        const std::uint32_t columns = plan_.columns();
        const std::size_t most = block_.boxes.size() + copies_.size() + std::size_t{columns} * (width - 1);
        // Growth by a 16th instead of doubling: the number of entries changes little between frames.
        if (most > entries_.capacity()) {
            release(entries_);
            entries_.reserve(most + most / 16);
        }
        entries_.resize(most);
        const std::uint32_t buckets = std::uint32_t{1} << bucket_bits_;
        const column_entry padding{
            .lower = ~std::uint32_t{0}, .upper = 0, .end_bucket = columns << bucket_bits_, .index = 0};
        std::uint32_t next = 0;
        for (std::uint32_t c = 0; c < columns; ++c) {
            std::uint32_t* const counts = &ends_[c << bucket_bits_];  // one bucket, or at least a vector of them
            next = buckets >= width ? bucket_starts(counts, buckets, next) : std::exchange(*counts, next) + next;
            while (next % width != 0) entries_[next++] = padding;
        }
        ends_[columns << bucket_bits_] = 0;  // padding ends before every entry, so it overlaps none
        return next;
    }

    /// Turns the counts of a column's buckets into start indices from `next` on. @returns the end of the last bucket.
    static std::uint32_t bucket_starts(std::uint32_t* counts, std::uint32_t buckets, std::uint32_t next) noexcept {
        for (std::uint32_t b = 0; b < buckets; b += width) {
            const simd::words sizes = simd::load(counts + b);
            const simd::words ends = simd::prefix_sum(sizes) + next;
            simd::store(counts + b, ends - sizes);
            next = ends[width - 1];
        }
        return next;
    }

    /// Writes all boxes and copies to their columns; the start of each bucket in `ends_` moves to its end.
    void write_entries() {
        if (block_.ids.empty())
            write_entries([](std::uint32_t) { return std::uint32_t{0}; });
        else
            write_entries([&](std::uint32_t i) { return block_.ids[i] & ~column_entry::index_mask; });
    }
    /// Writes the entries of boxes and copies; `ends_[bucket]`, the next index, becomes the end of the bucket.
    /// @param group_bits returns the bits of `begins_earlier` that box i has in its group
    template <class GroupBits>
    void write_entries(GroupBits group_bits) {
        const auto boxes = static_cast<std::uint32_t>(block_.boxes.size());
        for (std::uint32_t i = 0; i < boxes; ++i) {
            const quantized_box b = quantized_[i];
            entries_[ends_[b.bucket]++] = {b.lower, b.upper, b.end_bucket, i | group_bits(i)};
        }
        for (const copy& c : copies_) {
            const std::uint32_t i = c.index & column_entry::index_mask;
            const quantized_box b = quantized_[i];
            entries_[ends_[b.bucket + c.buckets]++] = {b.lower, b.upper, b.end_bucket + c.buckets,
                                                       c.index | group_bits(i)};
        }
    }

    /// Sorts each column by the exact lower ends, with the sort policy. Each entry i then gets a bucket of its own: its
    /// `end_bucket` is i, and `ends_[i]` is the first entry of the column that begins after its box ends.
    template <class Sort, CounterPolicy Counters>
    void sort_columns(Sort& sort, Counters& counters) {
        column_ends_.assign(ends_.begin(), ends_.begin() + plan_.columns());
        ends_.resize(entries_.size() + width);  // from here on by entry
        std::uint32_t begin = 0;
        for (const std::uint32_t end : column_ends_) {
            list_.clear();
            for (std::uint32_t i = begin; i < end; ++i) list_.push_back({box_of(entries_[i]).min[plan_.axis], i});
            sort.sort(std::span(list_), counters);
            moved_.assign(entries_.begin() + begin, entries_.begin() + end);
            for (std::uint32_t i = begin; i < end; ++i) {
                entries_[i] = moved_[list_[i - begin].id - begin];
                entries_[i].end_bucket = i;
                const float upper = box_of(entries_[i]).max[plan_.axis];
                ends_[i] = begin + static_cast<std::uint32_t>(
                                       std::ranges::upper_bound(list_, upper, {}, &projection::key) - list_.begin());
            }
            begin = (end + width - 1) / width * width;  // of the next column, after the padding of this one
            for (std::uint32_t i = end; i < begin; ++i)
                entries_[i].end_bucket = static_cast<std::uint32_t>(entries_.size());
        }
        ends_[entries_.size()] = 0;  // padding ends before every entry, so it overlaps none
    }

    [[nodiscard]] const box& box_of(const column_entry& e) const noexcept {
        return block_.boxes[e.index & column_entry::index_mask];
    }

    column_block block_{};
    column_plan plan_;
    std::uint32_t bucket_bits_ = 0;
    std::vector<quantized_box> quantized_;                               // by box
    std::array<std::uint32_t, boxes_at_a_time + width> spanning_boxes_;  // those just quantized in several columns
    std::size_t spanning_count_ = 0;
    std::vector<copy> copies_;
    std::vector<column_entry> entries_;
    std::vector<std::uint32_t> ends_;  // by bucket, plus one for padding
    std::vector<projection> list_;     // keys of the column being sorted
    std::vector<column_entry> moved_;  // entries of the column being sorted, in their old order
    std::vector<std::uint32_t> column_ends_;
};

}  // namespace aabb
