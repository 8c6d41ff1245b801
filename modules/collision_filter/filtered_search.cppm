export module aabb.collision_filter:filtered_search;

import aabb.pipeline;
import aabb.std;
import :filter;

export namespace aabb {

/// A broad phase that finds the pairs which the filter keeps, and no others. Where it saves time, `search` gets neither
/// objects at rest nor two sets, and their pairs are found through an index; but it gets all objects if it finds more
/// than boxes that overlap (`finds_overlaps_only`). If it divides objects, the filter still speaks of whole objects.
/// @param filter must outlive the stage; may change before `update`, but not between `update` and `search`
[[nodiscard]] std::unique_ptr<global_stage> filtered(std::unique_ptr<global_stage> search,
                                                     const collision_filter& filter,
                                                     instrumentation counted = instrumentation::none);

/// The same for a broad phase that is composed at compile time: a detector of it finds the pairs, or the contacts of
/// the pairs, which the filter keeps. `Search` may be a `prepared_search`.
template <class Search>
class filtered_search : public stage_search {
public:
    /// @param filter must outlive this; may change between frames
    explicit filtered_search(const collision_filter& filter, Search search = Search())
        : stage_search(filtered(stage_of(std::move(search)), filter)) {}
};

}  // namespace aabb
