export module aabb.collision_filter:filtered_search;

import aabb.pipeline;
import aabb.std;
import :filter;

namespace aabb::detail {

/// A broad phase of any type behind the interface of a stage.
template <class Search>
class any_search final : public global_stage {
public:
    explicit any_search(Search search) : search_(std::move(search)) {}

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) override {
        if constexpr (DividingSearch<Search>)
            return search_.divide(scene);
        else
            return nullptr;
    }
    void insert(std::uint32_t id) override { search_.insert(id); }
    void remove(std::uint32_t id) override { search_.remove(id); }
    void update(std::span<const box> boxes) override { search_.update(boxes); }
    void search(std::vector<index_pair>& pairs) override { search_.search(pairs); }
    [[nodiscard]] work_counters counters() const override {
        if constexpr (requires { work_of(search_.counters()); })
            return work_of(search_.counters());
        else
            return {};
    }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return bytes_by_part(search_); }
    [[nodiscard]] std::vector<omission> left_out() const override { return {}; }

private:
    Search search_;
};

}  // namespace aabb::detail

export namespace aabb {

/// When pairs are left out.
enum class filtering : std::uint8_t {
    early,  ///< where it saves time, also before the search: it gets neither objects at rest, if they are many, nor two
            ///< sets within which many pairs overlap; pairs with them are found by an index, if their boxes overlap
    late    ///< after the search, which gets all objects: for one that finds more than boxes that overlap
};

/// A broad phase that reports the pairs which the filter keeps, and no others. If `search` divides objects, the filter
/// still speaks of whole objects.
/// @param filter must outlive the stage; may change before `update`, but not between `update` and `search`
[[nodiscard]] std::unique_ptr<global_stage> filtered(std::unique_ptr<global_stage> search,
                                                     const collision_filter& filter, filtering when = filtering::early,
                                                     instrumentation counted = instrumentation::none);

/// The same for a broad phase that is composed at compile time, with the functions of `global_stage`: a detector of it
/// finds the pairs, or the contacts of the pairs, which the filter keeps. `Search` may be a `prepared_search`.
template <class Search>
class filtered_search {
public:
    /// @param filter must outlive this; may change between frames
    explicit filtered_search(const collision_filter& filter, Search search = Search(),
                             filtering when = filtering::early)
        : stage_(filtered(std::make_unique<detail::any_search<Search>>(std::move(search)), filter, when)) {}

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) { return stage_->divide(scene); }
    void insert(std::uint32_t id) { stage_->insert(id); }
    void remove(std::uint32_t id) { stage_->remove(id); }
    void update(std::span<const box> boxes) { stage_->update(boxes); }
    void search(std::vector<index_pair>& pairs) { stage_->search(pairs); }
    [[nodiscard]] work_counters counters() const { return stage_->counters(); }

    [[nodiscard]] friend std::vector<part_bytes> bytes_by_part(const filtered_search& search) {
        return search.stage_->bytes();
    }

private:
    std::unique_ptr<global_stage> stage_;
};

}  // namespace aabb
