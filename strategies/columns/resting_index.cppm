export module aabb.columns.resting_index;

export import aabb.columns.worker;
import aabb.std;

export namespace aabb {

/// An index of boxes, in which others are looked up. Its boxes are cut into columns as for a sweep, and each bucket of
/// a column knows the first box that reaches into it, so that a query tests a range of entries, a vector at a time, in
/// quantized coordinates; the boxes of those that may overlap are then compared exactly. Many boxes, or clustered ones,
/// are first put into nested groups, and so are those of a query.
class resting_index {
public:
    void clear() noexcept {
        nodes_.clear();
        lower_.clear();
        upper_.clear();
        marked_ids_.clear();
        buckets_.clear();
    }
    [[nodiscard]] bool is_built() const noexcept { return !nodes_.empty(); }

    /// Fills the empty index.
    /// @param boxes valid and at least one, with their ids
    template <ColumnPartition Partition>
    void build(const Partition& partition, const column_group& boxes) {
        nodes_.resize(1);
        build(partition, boxes, everywhere, /*at=*/0, /*depth=*/0);
        // Queries load whole vectors.
        for (large_vector<std::uint32_t>* const array : {&lower_, &upper_, &marked_ids_})
            array->resize(array->size() + width);
    }

    /// Appends the pairs {id of a query box, id of an indexed box} of boxes that overlap, each once.
    /// @param queries valid boxes with their ids
    /// @param boxes the indexed boxes by id
    /// @param most_tests limit on the tests, of vectors and of pairs
    /// @param counts whether pairs with the indexed box of this id count
    /// @returns the number of vector tests, where each visited column or group counts as one; or nullopt above the
    /// limit, and then some pairs are missing
    template <class Counts>
    [[nodiscard]] std::optional<std::uint64_t> look_up(const column_group& queries, std::span<const box> boxes,
                                                       std::uint64_t most_tests, std::vector<index_pair>& pairs,
                                                       Counts counts) {
        boxes_ = boxes;
        tests_ = exact_tests_ = 0;
        most_tests_ = most_tests;
        if (!look_up_in(nodes_.front(), queries, pairs, counts, /*depth=*/0)) return std::nullopt;
        return tests_;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t sum = bytes_of(lower_, upper_, marked_ids_, buckets_, nodes_, cut_, lists_, quantized_, order_,
                                   starts_, candidate_queries_, candidate_ids_);
        for (const column_groups& groups : levels_) sum += bytes_of(groups);
        return sum;
    }

private:
    static constexpr std::size_t width = simd::width;
    static constexpr std::size_t most_waiting = 2048;  // candidates between two exact tests
    static constexpr double most_across = 1024;        // columns on an axis
    static constexpr std::size_t queries_ahead = 8;    // that are prefetched

    /// A grid of groups, each with a node of its own, or columns.
    struct node {
        column_plan plan;
        std::size_t boxes = 0;
        std::size_t first_group = 0;     ///< its node; 0 for columns
        std::uint32_t first_entry = 0;   ///< of the columns, in the arrays of all
        std::uint32_t first_bucket = 0;  ///< likewise
        std::uint32_t bucket_bits = 0;
    };

    /// The entries of a bucket, by index from the first of the node.
    struct bucket {
        std::uint32_t reach;  ///< the first that ends in it or in a later bucket of the column
        std::uint32_t end;    ///< the one after its last
    };

    /// Builds node `at`.
    template <ColumnPartition Partition>
    void build(const Partition& partition, const column_group& group, const box& within, std::size_t at,
               std::size_t depth) {
        nodes_[at].boxes = group.boxes.size();
        if (group.boxes.empty()) return;
        kept_plan planned{.plan = partition.plan(group.boxes, within)};
        if (depth == 0) {
            const auto n = static_cast<double>(group.boxes.size());
            const double groups_by_size = n / static_cast<double>(partition.group_size(group.boxes.size()));
            planned.plan.groups = std::max(planned.plan.groups, groups_by_size);
        }
        cut_.columns = planned;
        cut_.in_groups = false;
        worker_threads single_thread(1);
        column_groups& groups = level(depth);
        if (put_into_groups(group, cut_, [&] { return planned; }, groups, single_thread) != fill_result::complete)
            return build_columns(group, planned.plan, nodes_[at]);
        const std::size_t first = nodes_.size();
        nodes_[at].plan = cut_.grid;
        nodes_[at].first_group = first;
        nodes_.resize(first + groups.size());
        for (std::uint32_t g = 0; g < groups.size(); ++g)
            build(partition, groups.group(g), groups.region(g, within), first + g, depth + 1);
    }

    void build_columns(const column_group& group, column_plan plan, node& to) {
        refine(plan, group.boxes);
        // Four boxes a bucket, so that those of a column stay in a cache; and at least a vector of buckets.
        constexpr auto fewest = static_cast<std::uint32_t>(std::bit_width(width - 1));
        const std::uint32_t bits = std::max(plan.bucket_bits(to.boxes), fewest + 2) - 2;
        const std::size_t most_copies = std::min(65'536 + 16 * group.boxes.size(), std::size_t{1} << 30);
        if (lists_.fill_buckets(group.boxes, group.ids, plan, bits, most_copies) != fill_result::complete) {
            plan.across = {1, 1};  // a single column has no copies
            return build_columns(group, plan, to);
        }
        to.plan = plan;
        to.bucket_bits = bits;
        to.first_entry = static_cast<std::uint32_t>(marked_ids_.size());
        to.first_bucket = static_cast<std::uint32_t>(buckets_.size());
        append_entries();
        append_buckets(to);
    }

    /// Cuts columns, planned for a sweep, as narrow as queries want them: to test half a vector of entries in each,
    /// evenly spread boxes assumed, if they stay twice as wide as the boxes.
    static void refine(column_plan& plan, std::span<const box> boxes) {
        constexpr std::size_t samples = 64;
        vec3d extent{};  // means, as shares of the range that is quantized
        for (std::size_t i = 0; i < samples; ++i)
            for (int k = 0; k < 3; ++k) {
                const box& b = boxes[i * boxes.size() / samples];
                extent[k] +=
                    static_cast<double>(plan.quantized(b.max[k], k) - plan.quantized(b.min[k], k)) / (65'536 * samples);
            }
        // The entries that overlap a box along a column begin in it, or reach into it.
        const double range = static_cast<double>(boxes.size()) * 2 * extent[plan.axis] / plan.columns();
        const double factor = std::sqrt(2 * range / width);
        if (!(factor > 1) || plan.columns() == 1) return;
        for (std::size_t i = 0; i < 2; ++i) {
            if (plan.across[i] == 1) continue;  // not to be cut
            const double widest = std::min(1 / (2 * extent[plan.axis_across(i)] + 1e-3), most_across);
            const auto wanted = static_cast<std::uint32_t>(std::min(factor * plan.across[i], widest));
            plan.across[i] = std::max(plan.across[i], wanted);
        }
    }

    void append_entries() {
        const column_block& block = lists_.block();
        for (const column_entry& e : block.entries) {
            const std::uint32_t index = e.index & column_entry::index_mask;
            lower_.push_back(e.lower);
            upper_.push_back(e.upper);
            marked_ids_.push_back(block.id_of(index) | (e.index & ~column_entry::index_mask));
        }
    }

    /// Finds the entries that queries of each bucket test: from the first that does not end before it.
    void append_buckets(const node& to) {
        const column_block& block = lists_.block();
        const std::uint32_t buckets = to.plan.columns() << to.bucket_bits;
        const std::uint32_t in_column = std::uint32_t{1} << to.bucket_bits;
        buckets_.resize(buckets_.size() + buckets);
        bucket* const ranges = &buckets_[to.first_bucket];
        for (std::uint32_t b = 0; b < buckets; ++b) {
            const std::uint32_t last = b / in_column * in_column + in_column - 1;  // of the column
            ranges[b] = {.reach = block.ends[last], .end = block.ends[b]};
        }
        std::uint32_t begin = 0;  // of the bucket
        for (std::uint32_t b = 0; b < buckets; ++b) {
            if (b % in_column == 0) begin = (begin + width - 1) / width * width;  // columns begin at whole vectors
            for (std::uint32_t i = begin; i < block.ends[b]; ++i) {
                std::uint32_t& reach = ranges[block.entries[i].end_bucket].reach;
                reach = std::min(reach, i);
            }
            begin = block.ends[b];
        }
        // Whatever reaches into a later bucket of the column ends no earlier.
        for (std::uint32_t b = buckets - 1; b > 0; --b)
            if (b % in_column != 0) ranges[b - 1].reach = std::min(ranges[b - 1].reach, ranges[b].reach);
    }

    template <class Counts>
    [[nodiscard]] bool look_up_in(const node& in, const column_group& queries, std::vector<index_pair>& pairs,
                                  Counts counts, std::size_t depth) {
        if (in.boxes == 0 || queries.boxes.empty()) return true;
        if (in.first_group == 0) return look_up_in_columns(in, queries, pairs, counts);
        worker_threads single_thread(1);
        column_groups& groups = level(depth);
        if (groups.distribute(queries.boxes, queries.ids, in.plan, std::numeric_limits<std::size_t>::max(),
                              single_thread) != fill_result::complete)
            return false;
        tests_ += groups.copies();
        for (std::uint32_t g = 0; g < groups.size(); ++g)
            if (!look_up_in(nodes_[in.first_group + g], groups.group(g), pairs, counts, depth + 1)) return false;
        return true;
    }

    /// A query box in a node: its quantized ends and columns on both axes across, packed as u16, and its buckets.
    struct quantized_query {
        std::uint32_t lower, upper, first, last, begin, end;
    };

    /// Looks up boxes column by column, so that the entries of one stay in a cache meanwhile.
    template <class Counts>
    [[nodiscard]] bool look_up_in_columns(const node& in, const column_group& queries, std::vector<index_pair>& pairs,
                                          Counts counts) {
        quantize(in, queries.boxes);
        sort_by_column(in);
        candidate_count_ = 0;
        for (std::size_t k = 0; k < order_.size(); ++k) {
            prefetch_buckets(in, k + 2 * queries_ahead);
            prefetch_entries(in, k + queries_ahead);
            const std::uint32_t q = order_[k];
            find_candidates(in, q, queries.ids[q] & ~column_entry::index_mask);
            if (tests_ + exact_tests_ > most_tests_) return false;
            if (candidate_count_ > most_waiting) append_overlapping(queries, pairs, counts);
        }
        append_overlapping(queries, pairs, counts);
        return true;
    }

    void quantize(const node& in, std::span<const box> boxes) {
        const column_plan plan = in.plan;
        const std::uint32_t bits = in.bucket_bits;
        const int u = plan.axis_across(0), v = plan.axis_across(1);
        const simd::words across = simd::broadcast(plan.across[0] | plan.across[1] << 16);
        quantized_.resize(boxes.size());
        for_each_vector(boxes, [&](std::size_t i, const simd::floats(&c)[6], std::uint32_t present) {
            const simd::words lower = plan.quantized(c[u], u) | plan.quantized(c[v], v) << 16;
            const simd::words upper = plan.quantized(c[3 + u], u) | plan.quantized(c[3 + v], v) << 16;
            const simd::words first = simd::high_products(lower, across), last = simd::high_products(upper, across);
            const simd::words begin = plan.quantized(c[plan.axis], plan.axis) >> (16 - bits);
            const simd::words end = plan.quantized(c[3 + plan.axis], plan.axis) >> (16 - bits);
            for (std::size_t l = 0; present >> l != 0; ++l)
                quantized_[i + l] = {lower[l], upper[l], first[l], last[l], begin[l], end[l]};
        });
    }

    /// Sets `order_`, the queries by their first column, by a counting sort. Fewer than there are columns are left in
    /// their order.
    void sort_by_column(const node& in) {
        const auto queries = static_cast<std::uint32_t>(quantized_.size());
        order_.resize(queries);
        if (queries < in.plan.columns()) {
            std::iota(order_.begin(), order_.end(), 0U);
            return;
        }
        const auto column_of = [&](const quantized_query& q) {
            return (q.first & 0xffffU) + (q.first >> 16) * in.plan.across[0];
        };
        starts_.assign(in.plan.columns() + 1, 0);
        for (const quantized_query& q : quantized_) ++starts_[column_of(q) + 1];
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        for (std::uint32_t q = 0; q < queries; ++q) order_[starts_[column_of(quantized_[q])]++] = q;
    }

    /// Loads what the k-th query reads first, while others are looked up.
    void prefetch_buckets(const node& in, std::size_t k) const noexcept {
        if (k < order_.size()) __builtin_prefetch(&buckets_[first_bucket_of(in, order_[k])]);
    }
    void prefetch_entries(const node& in, std::size_t k) const noexcept {
        if (k >= order_.size()) return;
        const std::size_t from = in.first_entry + std::size_t{buckets_[first_bucket_of(in, order_[k])].reach};
        for (const large_vector<std::uint32_t>* const array : {&lower_, &upper_, &marked_ids_})
            __builtin_prefetch(array->data() + from);
    }
    [[nodiscard]] std::size_t first_bucket_of(const node& in, std::uint32_t query) const noexcept {
        const quantized_query& q = quantized_[query];
        const std::uint32_t column = (q.first & 0xffffU) + (q.first >> 16) * in.plan.across[0];
        return in.first_bucket + (std::size_t{column} << in.bucket_bits) + q.begin;
    }

    /// Stores the entries that a query may overlap as candidates.
    /// @param group_marks the axes on which it begins in an earlier group
    void find_candidates(const node& in, std::uint32_t query, std::uint32_t group_marks) {
        const quantized_query q = quantized_[query];
        const std::uint32_t u0 = q.first & 0xffffU, v0 = q.first >> 16;
        const simd::words lower = simd::broadcast(q.lower), upper = simd::broadcast(q.upper);
        for (std::uint32_t v = v0; v <= q.last >> 16; ++v)
            for (std::uint32_t u = u0; u <= (q.last & 0xffffU); ++u) {
                const std::uint32_t first_bucket = in.first_bucket + ((u + v * in.plan.across[0]) << in.bucket_bits);
                const std::size_t from = in.first_entry + std::size_t{buckets_[first_bucket + q.begin].reach};
                const std::size_t to = in.first_entry + std::size_t{buckets_[first_bucket + q.end].end};
                ++tests_;
                if (from >= to) continue;
                tests_ += (to - from) / width;
                if (tests_ > most_tests_) return;
                // Copies that both begin in an earlier column on an axis are a pair there.
                const simd::words marks =
                    simd::broadcast(group_marks | (u != u0 ? column_entry::begins_earlier(in.plan.axis_across(0)) : 0) |
                                    (v != v0 ? column_entry::begins_earlier(in.plan.axis_across(1)) : 0));
                make_room(candidate_count_ + (to - from) + width);
                for (std::size_t i = from; i < to; i += width) {
                    const simd::words ids = simd::load(&marked_ids_[i]);
                    const simd::words apart = (ids & marks) |
                                              simd::saturated_difference(simd::load(&lower_[i]), upper) |
                                              simd::saturated_difference(lower, simd::load(&upper_[i]));
                    const std::uint32_t met = simd::bits(apart == 0U) & simd::lanes_below(to - i);
                    simd::store(&candidate_queries_[candidate_count_], simd::broadcast(query));
                    candidate_count_ += simd::compress_store(&candidate_ids_[candidate_count_], ids, met);
                }
            }
    }

    void make_room(std::size_t candidates) {
        if (candidates <= candidate_ids_.size()) return;
        candidate_queries_.resize(2 * candidates);
        candidate_ids_.resize(2 * candidates);  // last: its size says that both have room
    }

    /// Tests the candidates exactly, appends the pairs that overlap and count, and empties the list of candidates.
    template <class Counts>
    void append_overlapping(const column_group& queries, std::vector<index_pair>& pairs, Counts counts) {
        exact_tests_ += candidate_count_;
        std::size_t next = pairs.size();
        pairs.resize(next + candidate_count_);
        for (std::size_t c = 0; c < candidate_count_; ++c) {
            const std::uint32_t q = candidate_queries_[c];
            const std::uint32_t id = candidate_ids_[c] & column_entry::index_mask;
            // No branch: a pair that does not count is overwritten by the next one.
            pairs[next] = ordered_pair(queries.ids[q] & column_entry::index_mask, id);
            next +=
                static_cast<std::size_t>(overlaps(queries.boxes[q], boxes_[id])) & static_cast<std::size_t>(counts(id));
        }
        pairs.resize(next);
        candidate_count_ = 0;
    }

    [[nodiscard]] column_groups& level(std::size_t depth) {
        while (levels_.size() <= depth) levels_.emplace_back();
        return levels_[depth];
    }

    std::vector<node> nodes_;                    // the root first
    cut_plan cut_;                               // of the node that is being built
    large_vector<std::uint32_t> lower_, upper_;  // by entry, as in `column_entry`
    large_vector<std::uint32_t> marked_ids_;     // by entry, with bits of `begins_earlier`
    large_vector<bucket> buckets_;
    column_lists lists_;                            // of the columns that are being built
    std::deque<column_groups> levels_;              // nested groups, by depth
    std::span<const box> boxes_;                    // by id
    std::vector<quantized_query> quantized_;        // by query
    std::vector<std::uint32_t> order_;              // queries by column
    std::vector<std::uint32_t> starts_;             // by column, in `order_`
    std::vector<std::uint32_t> candidate_queries_;  // queries that may overlap
    std::vector<std::uint32_t> candidate_ids_;      // these entries, as marked ids
    std::size_t candidate_count_ = 0;
    std::uint64_t tests_ = 0, exact_tests_ = 0, most_tests_ = 0;  // vector tests of the current queries
};

}  // namespace aabb
