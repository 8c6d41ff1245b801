module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The nominal size of nodes: n triangles have n - 1 internal nodes. Parts have the paper's names: the scope is the
/// stored planes, and the symbol the bits that say which planes these are and which children are leaves.
struct layout {
    const char* name;
    const char* tree;  // with its parameters
    const char* internal;
    const char* leaf;
    const char* bytes;  // per triangle, for large trees
};
constexpr layout layouts[] = {
    {"canonical", "canonical", "box 24, children 8", "box 24, triangle 4", "60"},
    {"leafless", "leafless:leaf_test=triangle_box", "box 24, children 8", "none", "32"},
    {"shared_planes", "shared_planes", "box 12.5, children 8", "box 12.5, triangle 4", "37"},
    {"compressed", "compressed:leaf_test=triangle_box", "scope 12, children 8, symbol 1", "none", "21"},
    {"compressed_literal", "compressed_literal:leaf_test=triangle_box", "scope 12, children 8, symbol 1", "none",
     "21"}};

selection selection_of(const layout& l, const std::string& build) {
    return {{kind::tree, l.tree}, {kind::build, build}};
}

/// Bytes per triangle of every layout of trees on one mesh: nominal, from the sizes of nodes, and allocated. `nodes`
/// are boxes and symbols (bits for inherited planes and leaves), `indices` those of children and triangles.
table bytes_table(const condition& c) {
    table t = empty_table({"tree", "internal node", "leaf"},
                          {"bytes per triangle, nominal", "allocated", "of these, boxes and symbols", "indices"});
    for (const layout& l : layouts) {
        // The bytes of these layouts depend on the number of triangles only, so that any build would do.
        const selection composition = selection_of(l, "median");
        if (!c.value(composition, measured("tree_bytes"))) continue;
        const auto text_of = [&](const row_value& bytes) {
            const std::optional<double> quotient = c.value(composition, per_triangle(bytes));
            return quotient ? fmt::format("{:.2f}", *quotient) : "-";
        };
        t.rows.push_back({l.name, l.internal, l.leaf, l.bytes, text_of(bytes_of({"nodes", "indices"})),
                          text_of(bytes_of({"nodes"})), text_of(bytes_of({"indices"}))});
    }
    return t;
}

/// What every layout costs under every split rule on one mesh: bytes, inflation (surface area of boxes over that of
/// tight ones), and the times to build and to query over those of the canonical layout with the median.
table cost_table(const condition& c) {
    const selection baseline = selection_of(layouts[0], "median");
    table t = empty_table({"tree", "build"}, {"bytes per triangle", "boxes larger by (%)", "build time", "query time"});
    for (const layout& l : layouts)
        for (const char* build : {"median", "mean", "midpoint", "sah"}) {
            const selection tested = selection_of(l, build);
            const std::optional<double> bytes = c.value(tested, measured("tree_bytes"));
            if (!bytes) continue;
            const double inflation = c.value(tested, measured("box_inflation")).value_or(0);
            t.rows.push_back({l.name, build, fmt::format("{:.2f}", *bytes), three_digits(100 * inflation),
                              ratio_cell(endpoint_of(c, tested, baseline, "build_cpu_ms")),
                              ratio_cell(endpoint_of(c, tested, baseline, "detect_cpu_ms"))});
        }
    return t;
}

}  // namespace

/// The paper's table 1, sizes of tree nodes, as measured on the largest mesh; empty if it was not measured.
std::vector<named_table> table1(const measurements& m) {
    const std::vector<condition>& conditions = m.conditions_of("table1");
    if (conditions.empty()) return {};
    const condition& c = conditions.back();  // with the largest mesh
    return {
        {"table1", "Node sizes of every layout in bytes: nominal, and as allocated for trees of " + mesh_of(c) + ".",
         bytes_table(c)},
        {"table1_builds",
         "Costs of the layouts, split at the median, at the mean, in the middle of the box and by the surface area "
         "heuristic. Times are relative to canonical, median, on " +
             mesh_of(c) + ".",
         cost_table(c)}};
}

}  // namespace aabblab
