/// What elementary work takes on the machine at hand. Strategies hold ways to the same answer against each other by it;
/// which way they take changes how long the answer takes, never the answer.
export module aabb.costs;

import aabb.std;

export namespace aabb {

/// In nanoseconds, each for one piece of counted work. Only costs of one group are ever held against each other. The
/// defaults are those of an AMD EPYC (Zen 5).
struct cost_model {
    // A list of neighbours, against a search by columns in every frame (`list_plan`).
    double search_box = 8;     ///< a box that is searched
    double search_pair = 7.5;  ///< a pair of boxes that the search finds
    double keep_box = 3;       ///< a box that is grown by a margin and kept with its list
    double watch_box = 0.75;   ///< a box that is looked at for how far it has moved
    double test_pair = 1.35;   ///< a pair of the list that is tested

    // Segments of an axial cut (`axial_cut`).
    double list_entry = 6;   ///< an entry of a sorted list, brought up to a frame
    double cut_entry = 8;    ///< an entry of a box in a subset (`work::subset_copies`)
    double cut_subset = 16;  ///< a subset (`work::subsets`)
    double cut_test = 1;     ///< a test of two boxes in a subset (`work::box_tests`)

    // Columns (`columns`).
    double column_entry = 6;  ///< an entry of a box, brought to its place in a column (`work::subset_copies`)
    double column = 16;       ///< a column (`work::subsets`)
    double column_test = 1;   ///< a test of an entry against a vector of them (`work::box_tests` over `simd::width`)

    // Trees, for few queries or for many (`aabb.selection`).
    double median_triangle = 81;  ///< a triangle that a tree by `median` is built of
    double sah_triangle = 115;    ///< one that a tree by `sah` is built of
    double node_visit = 46;       ///< a pair of nodes that a query visits, with its triangles (`work::node_visits`)

    friend bool operator==(const cost_model&, const cost_model&) = default;
};

/// One of them, for whoever fits, keeps or shows all.
struct cost_info {
    double cost_model::* value;
    std::string_view name;
    std::string_view unit;
    std::string_view of;  ///< the work, in a few words
};

inline constexpr std::array<cost_info, 15> cost_infos{{
    {&cost_model::search_box, "search_box", "ns/box", "searching a box by columns"},
    {&cost_model::search_pair, "search_pair", "ns/pair", "finding a pair so"},
    {&cost_model::keep_box, "keep_box", "ns/box", "keeping a box with its list"},
    {&cost_model::watch_box, "watch_box", "ns/box", "watching a box move"},
    {&cost_model::test_pair, "test_pair", "ns/pair", "testing a listed pair"},
    {&cost_model::list_entry, "list_entry", "ns/entry", "sorting an entry of a list"},
    {&cost_model::cut_entry, "cut_entry", "ns/entry", "an entry of a box in a subset"},
    {&cost_model::cut_subset, "cut_subset", "ns/subset", "a subset of a cut"},
    {&cost_model::cut_test, "cut_test", "ns/test", "testing two boxes of one"},
    {&cost_model::column_entry, "column_entry", "ns/entry", "an entry of a box in a column"},
    {&cost_model::column, "column", "ns/column", "a column"},
    {&cost_model::column_test, "column_test", "ns/vector", "testing an entry by a vector"},
    {&cost_model::median_triangle, "median_triangle", "ns/triangle", "building by median"},
    {&cost_model::sah_triangle, "sah_triangle", "ns/triangle", "building by sah"},
    {&cost_model::node_visit, "node_visit", "ns/visit", "visiting a pair of nodes"},
}};

/// The costs in force: the defaults, unless others were set. Strategies read them when they plan.
[[nodiscard]] const cost_model& machine_costs() noexcept;
/// For the whole process: before anything is composed, and while nobody else reads them.
void set_machine_costs(const cost_model& costs) noexcept;

}  // namespace aabb
