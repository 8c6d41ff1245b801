/// When to keep objects from the search, by the costs of both ways.
module aabb.collision_filter:filter_plan;

import aabb.costs;
import aabb.std;
import :box_index;

namespace aabb {

/// The number of objects, pairs or nodes, for products with costs.
template <std::integral Count>
[[nodiscard]] constexpr double amount(Count count) noexcept {
    return static_cast<double>(count);
}

/// What a way to find the pairs of a frame takes, in ns.
struct frame_cost {
    std::size_t searched = 0;  ///< objects that the search gets
    double found = 0;          ///< pairs that it finds, before the filter
    std::size_t watched = 0;   ///< boxes that are compared with those of an earlier frame
    std::size_t refitted = 0;  ///< boxes to which an index is adjusted
    double opened = 0;         ///< nodes of the index
    double looked_up = 0;      ///< pairs that queries find

    [[nodiscard]] double ns(const cost_model& cost = machine_costs()) const {
        return amount(searched) * cost.search_box + (found + looked_up) * cost.search_pair +
               amount(watched) * cost.watch_box + amount(refitted) * cost.refit_box + opened * cost.open_node;
    }
};

/// The time to build an index: ordering its boxes takes about as long per level of halves as adjusting it to them.
[[nodiscard]] inline double ns_to_build(std::size_t boxes, const cost_model& cost = machine_costs()) {
    return amount(boxes) * amount(std::bit_width(boxes)) * cost.refit_box;
}

/// The nodes that queries open, as many per query as the last ones did.
class query_estimate {
public:
    void learn(std::size_t queries, std::size_t opened) noexcept {
        if (queries > 0) per_query_ = amount(opened) / amount(queries);
    }
    /// @param boxes in the index, which decides as long as there were no queries
    [[nodiscard]] double opened_by(std::size_t queries, std::size_t boxes) const noexcept {
        return amount(queries) * per_query_.value_or(box_index::expected_nodes(boxes));
    }

private:
    std::optional<double> per_query_;
};

}  // namespace aabb
