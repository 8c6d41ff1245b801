/// The cost of elementary work on the current machine. Strategies compare alternative algorithms by these costs; the
/// choice affects the time, but never the result.
export module aabb.costs;

import aabb.std;

export namespace aabb {

/// Nanoseconds per unit of counted work, by default those of an AMD EPYC (Zen 5). Costs are compared within a group.
struct cost_model {
    // Verlet lists compared with a search by columns in every frame (`list_plan`).
    double search_box = 8;     ///< searching a box
    double search_pair = 7.5;  ///< finding a pair of boxes by a search
    double keep_box = 3;       ///< growing a box by a margin and keeping it with its list
    double watch_box = 0.75;   ///< measuring the displacement of a box
    double test_pair = 1.35;   ///< testing a listed pair

    // Segments of an axial cut (`axial_cut`).
    double list_entry = 6;   ///< updating an entry of a sorted list to a frame
    double cut_entry = 8;    ///< an entry of a box in a subset (`work::subset_copies`)
    double cut_subset = 16;  ///< a subset (`work::subsets`)
    double cut_test = 1;     ///< a test of two boxes in a subset (`work::box_tests`)

    // Columns (`columns`). `active_box` is compared with the costs of Verlet lists.
    double column_entry = 6;  ///< placing an entry of a box in a column (`work::subset_copies`)
    double column = 16;       ///< a column (`work::subsets`)
    double column_test = 1;   ///< a test of an entry against a vector of them (`work::box_tests` over `simd::width`)
    double active_box = 50;   ///< searching a box that moves among boxes at rest, and looking it up among these

    // Trees for few or many queries (`aabb.selection`).
    double median_triangle = 81;  ///< building a tree by `median`, per triangle
    double sah_triangle = 115;    ///< building a tree by `sah`, per triangle
    double node_visit = 46;       ///< visiting a pair of nodes in a query, with its triangles (`work::node_visits`)

    // Indices of objects that a filter keeps from the search (`aabb.collision_filter`).
    double refit_box = 3;  ///< adjusting an index to a box
    double open_node = 6;  ///< opening a node of an index in a query (an eighth of `work::box_tests`)

    friend bool operator==(const cost_model&, const cost_model&) = default;
};

/// Metadata of one cost, for code that fits, stores or prints all of them.
struct cost_info {
    double cost_model::* value;
    std::string_view name;
    std::string_view unit;
    std::string_view of;  ///< a short description of the work
};

inline constexpr std::array<cost_info, 18> cost_infos{{
    {&cost_model::search_box, "search_box", "ns/box", "searching a box by columns"},
    {&cost_model::search_pair, "search_pair", "ns/pair", "finding a pair by columns"},
    {&cost_model::keep_box, "keep_box", "ns/box", "keeping a box with its Verlet list"},
    {&cost_model::watch_box, "watch_box", "ns/box", "tracking the motion of a box"},
    {&cost_model::test_pair, "test_pair", "ns/pair", "testing a listed pair"},
    {&cost_model::list_entry, "list_entry", "ns/entry", "sorting an entry of a list"},
    {&cost_model::cut_entry, "cut_entry", "ns/entry", "an entry of a box in a subset"},
    {&cost_model::cut_subset, "cut_subset", "ns/subset", "a subset of a cut"},
    {&cost_model::cut_test, "cut_test", "ns/test", "testing two boxes in a subset"},
    {&cost_model::column_entry, "column_entry", "ns/entry", "an entry of a box in a column"},
    {&cost_model::column, "column", "ns/column", "a column"},
    {&cost_model::column_test, "column_test", "ns/vector", "testing an entry by a vector"},
    {&cost_model::active_box, "active_box", "ns/box", "a box that moves among others at rest"},
    {&cost_model::median_triangle, "median_triangle", "ns/triangle", "building by median"},
    {&cost_model::sah_triangle, "sah_triangle", "ns/triangle", "building by sah"},
    {&cost_model::node_visit, "node_visit", "ns/visit", "visiting a pair of nodes"},
    {&cost_model::refit_box, "refit_box", "ns/box", "adjusting an index to a box"},
    {&cost_model::open_node, "open_node", "ns/node", "opening a node of an index"},
}};

/// The current costs, by default those of `cost_model`. Strategies read them when they plan.
[[nodiscard]] const cost_model& machine_costs() noexcept;
/// Sets the costs of the process. Must be called before strategies are composed; not thread-safe.
void set_machine_costs(const cost_model& costs) noexcept;

/// Decides when to change from one way to another: once what the frames so far have cost too much would have paid for
/// the change, so that a change which is never repaid at most doubles the time (Karlin, Manasse, Rudolph and Sleator,
/// "Competitive snoopy caching", 1988).
class regret {
public:
    /// Adds a frame.
    /// @param excess what this way takes more than the other, in ns; less if it is negative
    /// @returns whether to change now, after which the sum is 0
    bool exceeds(double ns_to_change, double excess) noexcept {
        sum_ = std::max(0.0, sum_ + excess);
        if (!(sum_ > ns_to_change)) return false;
        sum_ = 0;
        return true;
    }
    void forget() noexcept { sum_ = 0; }

private:
    double sum_ = 0;
};

}  // namespace aabb
