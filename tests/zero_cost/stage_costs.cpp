// stage_costs WAY OBJECTS: plays a row of boxes in one way and prints the bytes that it holds, for zero_cost.cmake,
// which also counts the instructions of measured_frames.
#include <malloc.h>

import aabb.std;
import aabb;
import aabb.columns;
import aabb.partition.axial_cut;
import aabb.partition.columns;
import aabb.partition.none;
import aabb.sort.bucket;
import aabb.sort.insertion;
import aabb.sweep.one_axis;
import aabb.sweep.simd;

namespace {
std::size_t held = 0;  // on the heap
}

void* operator new(std::size_t bytes) {
    void* const memory = std::malloc(bytes);
    if (memory == nullptr) throw std::bad_alloc();
    held += malloc_usable_size(memory);
    return memory;
}
void operator delete(void* memory) noexcept {
    held -= malloc_usable_size(memory);
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}

namespace {

/// Counts nothing, whatever becomes of aabb::no_counters.
struct uncounted {
    static constexpr bool enabled = false;
    static constexpr void add(aabb::work, std::uint64_t = 1) noexcept {}
};

/// The same sort and the same sweep without any composition: all that finding the pairs takes.
template <class Counters>
class by_hand {
public:
    void insert(unsigned id) { objects_.insert(id); }
    std::span<const aabb::index_pair> pairs(std::span<const aabb::box> boxes) {
        objects_.require_boxes_for_all(boxes.size());
        aabb::require_valid(boxes);
        boxes_ = boxes;
        lists_.settle(objects_);
        objects_.settle();
        lists_.sort(boxes, sweep_.axes(boxes, objects_), sort_, counters_);
        has_frame_ = true;
        pairs_.clear();
        if (has_frame_) sweep_.sweep(lists_.all(boxes_), pairs_, counters_);
        return pairs_;
    }

private:
    [[no_unique_address]] aabb::insertion_sort sort_;
    [[no_unique_address]] Counters counters_;
    aabb::one_axis_sweep sweep_;
    std::span<const aabb::box> boxes_;
    aabb::membership objects_;
    aabb::projection_lists<Counters> lists_;
    bool has_frame_ = false;
    std::vector<aabb::index_pair> pairs_;
};

/// The same of what cuts before it sorts.
class columns_by_hand {
public:
    void insert(unsigned id) { objects_.insert(id); }
    std::span<const aabb::index_pair> pairs(std::span<const aabb::box> boxes) {
        objects_.require_boxes_for_all(boxes.size());
        search_.update(boxes, objects_, counters_);
        objects_.settle();
        has_frame_ = true;
        pairs_.clear();
        if (has_frame_) search_.search(pairs_, counters_);
        return pairs_;
    }

private:
    aabb::column_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep, aabb::no_counters> search_{
        {}, {}, {}};
    [[no_unique_address]] aabb::no_counters counters_;
    aabb::membership objects_;
    bool has_frame_ = false;
    std::vector<aabb::index_pair> pairs_;
};

/// A prepare that looks at every box, and changes none.
struct copying_prepare {
    static constexpr std::string_view name = "copying";
    static constexpr std::string_view summary = "hands copies of the boxes on";

    class stage final : public aabb::global_stage {
    public:
        explicit stage(std::unique_ptr<aabb::global_stage> search) : search_(std::move(search)) {}
        void insert(std::uint32_t id) override { search_->insert(id); }
        void remove(std::uint32_t id) override { search_->remove(id); }
        void update(std::span<const aabb::box> boxes) override {
            boxes_.assign(boxes.begin(), boxes.end());
            search_->update(boxes_);
        }
        void search(std::vector<aabb::index_pair>& pairs) override { search_->search(pairs); }
        [[nodiscard]] aabb::work_counters counters() const override { return search_->counters(); }
        [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return search_->bytes(); }
        [[nodiscard]] std::vector<aabb::omission> left_out() const override { return search_->left_out(); }

    private:
        std::unique_ptr<aabb::global_stage> search_;
        std::vector<aabb::box> boxes_;
    };

    [[nodiscard]] static std::unique_ptr<aabb::global_stage> before(std::unique_ptr<aabb::global_stage> search,
                                                                    aabb::instrumentation) {
        return std::make_unique<stage>(std::move(search));
    }
};

using bare = aabb::global_search<aabb::insertion_sort, aabb::none_partition, aabb::one_axis_sweep>;
using counted =
    aabb::global_search<aabb::insertion_sort, aabb::none_partition, aabb::one_axis_sweep, aabb::work_counters>;
using cut = aabb::global_search<aabb::insertion_sort, aabb::axial_cut_partition, aabb::one_axis_sweep>;
using prepared = aabb::prepared_search<copying_prepare, bare>;
using columns = aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep>;
using counted_columns =
    aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep, aabb::work_counters>;
using prepared_columns = aabb::prepared_search<copying_prepare, columns>;
using filtered = aabb::filtered_search<bare>;

/// It cuts, whether that pays or not.
aabb::axial_cut_partition into_segments() {
    aabb::axial_cut_partition::config config;
    config.axes = 1;
    config.segments = 16;
    return aabb::axial_cut_partition(config);
}

/// A filter that leaves nothing out.
const aabb::collision_filter& wide_filter(unsigned objects) {
    static aabb::collision_filter filter;
    for (unsigned id = 0; id < objects; ++id) filter.set(id, {.group = 1U << id % 32});
    return filter;
}

/// A row of boxes of which each overlaps its neighbours in some frames; each frame moves all, and some past another.
std::vector<std::vector<aabb::box>> row_of(unsigned objects) {
    std::vector<std::vector<aabb::box>> frames(8);
    for (unsigned f = 0; f < frames.size(); ++f)
        for (unsigned i = 0; i < objects; ++i) {
            const float x = static_cast<float>(2 * i) + static_cast<float>((7 * i + 3 * f) % 11) / 4;
            frames[f].push_back({{x, 0, 0}, {x + 1, 1, 1}});
        }
    return frames;
}

template <class Detector>
[[gnu::noinline]] std::size_t measured_frames(Detector& detector, const std::vector<std::vector<aabb::box>>& frames) {
    std::size_t pairs = 0;
    for (const std::vector<aabb::box>& boxes : frames) pairs += detector.pairs(boxes).size();
    return pairs;
}

/// All buffers have grown when the measured frames begin.
template <class Make>
void play(unsigned objects, Make make) {
    const std::vector<std::vector<aabb::box>> frames = row_of(objects);
    const std::size_t before = held;
    auto detector = make();
    for (unsigned id = 0; id < objects; ++id) detector.insert(id);
    for (const std::vector<aabb::box>& boxes : frames) static_cast<void>(detector.pairs(boxes));
    const std::size_t pairs = measured_frames(detector, frames);
    std::printf("%zu pairs, %zu bytes, %zu on the heap\n", pairs, sizeof(detector), held - before);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::string_view way = argv[1];
    const auto objects = static_cast<unsigned>(std::atoi(argv[2]));
    if (way == "by_hand") play(objects, [] { return by_hand<aabb::no_counters>(); });
    if (way == "uncounted") play(objects, [] { return by_hand<uncounted>(); });
    if (way == "composed") play(objects, [] { return aabb::detector<bare>(); });
    if (way == "counted") play(objects, [] { return aabb::detector<counted>(); });
    if (way == "cut") play(objects, [] { return aabb::detector<cut>(cut({}, into_segments(), {})); });
    if (way == "prepared") play(objects, [] { return aabb::detector<prepared>(); });
    if (way == "filtered") {
        const aabb::collision_filter& filter = wide_filter(objects);
        play(objects, [&filter] { return aabb::detector<filtered>(filtered(filter)); });
    }
    if (way == "columns_by_hand") play(objects, [] { return columns_by_hand(); });
    if (way == "columns") play(objects, [] { return aabb::detector<columns>(); });
    if (way == "counted_columns") play(objects, [] { return aabb::detector<counted_columns>(); });
    if (way == "prepared_columns") play(objects, [] { return aabb::detector<prepared_columns>(); });
}
