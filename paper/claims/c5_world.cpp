module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

selection grid(const std::string& cell) {
    return traditional.with(kind::partition, "uniform_grid:cell_size=" + cell);
}

row_value all_bytes() {
    return bytes_of({"projections", "partition", "sweep"});
}

/// The side of a world in edges of its cubes, which fill the share `density` of it.
double side_of(const condition& c) {
    return std::cbrt(objects_of(c) / number_of(c.scene(), "density"));
}

/// A grid and its name in factors and sentences.
struct tested_grid {
    std::string name, text;
    selection tested;
};
std::vector<tested_grid> grids() {
    return {{"cells of 2", "cells of two box edges", grid("2")},
            {"cells chosen anew", "the automatic cell size", grid("auto")}};
}

/// Adds the ratio of a cost in one world to that in the other. Claims favour ratios below 1, so growth is expressed as
/// the cost in the small world over that in the large one.
void add_growth(draft& claim, const std::string& comparison, const std::string& subject, const cells& above,
                const cells& below, quantity compared, std::optional<expectation> expected = {}) {
    claim.add({.where = {{"scene", "brownian"}, {"comparison", comparison}},
               .log_ratios = {difference_of_means(above, below)},
               .expected = expected,
               .source = "c5_world: growth"},
              subject, /*along=*/"", compared);
}

std::string worlds_text(const condition& small, const condition& large) {
    return fmt::format("for {} cubes in a world {:.0f} edges wide, compared with one of {:.0f} edges",
                       number_text(value_of(small.scene(), "objects")), side_of(small), side_of(large));
}

/// A figure of the time or memory of two grids and of the axial cut against the side of the world.
figure world_figure(const std::string& name, const std::string& quantity_name, const std::string& y_label,
                    const std::vector<condition>& worlds, const row_value& value) {
    const method methods[] = {{"grid, cells of 2", grid("2")}, {"grid, auto", grid("auto")}, {"axial cut", cut}};
    return log_log(name,
                   quantity_name +
                       " of the broad phase against the side of the world, for the same 2,000 cubes: a grid with "
                       "a fixed cell size, one with an automatic cell size, and the axial cut; medians and "
                       "quartiles.",
                   "side of the world (edges)", y_label, series_of(methods, matching(worlds, {}), side_of, value));
}

}  // namespace

/// Drafts C5c: the bytes of a grid in the smallest world over those in the largest, with the same number of boxes; and
/// those of the axial cut in the largest over the smallest.
draft c5c_claim(const measurements& m) {
    draft c5c{.claim = {.lead = "A grid", .experiments = {"c5_world"}}};
    const std::vector<condition>& worlds = m.conditions_of("c5_world");  // from the densest, and so smallest
    if (worlds.size() < 2) return c5c;
    const condition& small = worlds.front();
    const condition& large = worlds.back();
    for (const auto& [name, text, tested] : grids())
        add_growth(c5c, "bytes of a grid, " + name + ", small world over large",
                   "with " + text + ", " + worlds_text(small, large), small.logs(tested, all_bytes()),
                   large.logs(tested, all_bytes()), quantity::bytes);
    add_growth(c5c, "bytes of axial_cut, large world over small", "the cut, in the wider world instead of the other",
               large.logs(cut, all_bytes()), small.logs(cut, all_bytes()), quantity::bytes, expectation::not_more);
    c5c.claim.figures = {world_figure("c5_world", "Memory", "bytes", worlds, all_bytes())};
    return c5c;
}

/// Drafts C5d: the time of a grid over that of the axial cut, in the smallest world over that in the largest. Times
/// alone fall in a sparse world, with its fewer pairs.
draft c5d_claim(const measurements& m) {
    draft c5d{.claim = {.lead = "A grid", .experiments = {"c5_world"}}};
    const std::vector<condition>& worlds = m.conditions_of("c5_world");
    if (worlds.size() < 2) return c5d;
    const condition& small = worlds.front();
    const condition& large = worlds.back();
    for (const auto& [name, text, tested] : grids())
        add_growth(c5d, "time of a grid over that of axial_cut, " + name + ", small world over large",
                   "with " + text + ", " + worlds_text(small, large),
                   small.log_ratios(tested, cut, measured("frame_cpu_ms")),
                   large.log_ratios(tested, cut, measured("frame_cpu_ms")), quantity::relative_time);
    c5d.claim.figures = {
        world_figure("c5_world_time", "Time", "time per frame (ms)", worlds, measured("frame_cpu_ms"))};
    return c5d;
}

}  // namespace aabblab
