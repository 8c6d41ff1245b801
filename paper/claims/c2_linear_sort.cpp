module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

/// The work of a sort at all sizes, on input with one displacement.
struct work_by_size {
    std::vector<double> log_n;
    std::vector<cells> log_per_element;

    /// The growth of work per element when N grows tenfold, as a logarithm; 0 if the work is O(N). A linear regression
    /// of the work per element, not of its logarithm, against log N gives its increase, which is divided by its mean.
    [[nodiscard]] double growth(const resample& d) const {
        std::vector<double> y;
        for (const cells& logs : log_per_element) y.push_back(std::exp(d.mean_of(logs)));
        const auto [slope, mean_y] = line_through(log_n, y);
        // A steep fall would extrapolate to a negative value, which has no meaning.
        return std::log(std::max(1e-6, 1 + slope / mean_y));
    }
};

/// Comparisons and moves together: a sort is linear when both are.
row_value work() {
    return sum_of({"comparisons", "moves"});
}

/// Inversions per element by displacement and size, to check that "almost ordered" means the same at all sizes.
table inversions_table(const std::map<std::string, std::vector<const condition*>>& by_displacement) {
    table t{{{"displacement"}}, {}};
    for (const condition* c : by_displacement.begin()->second)
        t.columns.push_back({number_text(value_of(c->scene(), "objects")) + " elements"});
    for (const auto& [displacement, conditions] : by_displacement) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{displacement});
        for (const condition* c : conditions) cells.push_back(digits_cell(inversions_of(*c)));
    }
    return t;
}

constexpr std::pair<const char*, const char*> sorts[] = {
    {"shell:gaps=ciura", "Shell sort with Ciura's gaps extended as N grows"},
    {"shell:gaps=tokuda", "with Tokuda's gaps"},
    {"shell:gaps=shell", "with Shell's own gaps"},
    {"shell:gaps=ciura_eight", "with Ciura's eight gaps"},
    {"shell:gaps=four_one", "with two gaps"},
    {"insertion", "insertion sort"}};

/// The median of the inversions per element over all sizes.
std::optional<double> inversions_of(const std::vector<const condition*>& conditions) {
    std::vector<double> values;
    for (const condition* c : conditions)
        if (const auto inversions = inversions_of(*c)) values.push_back(*inversions);
    return values.empty() ? std::nullopt : std::optional(quartiles_of(values).median);
}

/// The sizes to which the growth of work is fitted. With fewer than 10,000 elements, the passes with the largest gaps
/// are incomplete. Sizes whose inversions per element deviate from the median by more than 10 % are left out, too: far
/// from the origin, floats cannot represent a move of a hundredth of an edge.
std::vector<const condition*> equally_ordered_sizes(std::vector<const condition*> conditions) {
    constexpr double fewest_elements = 10'000;
    constexpr double most_deviation = 0.1;
    std::erase_if(conditions, [](const condition* c) { return objects_of(*c) < fewest_elements; });
    const std::optional<double> median = inversions_of(conditions);
    std::erase_if(conditions, [&](const condition* c) {
        const std::optional<double> inversions = inversions_of(*c);
        return median && inversions && std::abs(*inversions - *median) > most_deviation * *median;
    });
    return conditions;
}

}  // namespace

/// Drafts C2: the counted work per element at 10 N elements over that at N, from a line fitted to all sizes, per sort
/// and displacement. A sort in O(N) has the ratio 1.
draft c2_claim(const measurements& m) {
    draft c2{.claim = {.lead = "Work (comparisons and moves) per element when N grows tenfold", .experiments = {"c2"}}};
    std::map<std::string, std::vector<const condition*>> by_displacement;
    for (const condition& c : m.conditions_of("c2")) by_displacement[value_of(c.scene(), "displacement")].push_back(&c);
    for (const auto& [sort, subject] : sorts)
        for (const auto& [displacement, of_all_sizes] : by_displacement) {
            work_by_size measured_work;
            const std::vector<const condition*> conditions = equally_ordered_sizes(of_all_sizes);
            if (conditions.size() < 2) continue;
            for (const condition* c : conditions) {
                measured_work.log_n.push_back(std::log10(objects_of(*c)));
                measured_work.log_per_element.push_back(c->logs({{kind::sort, sort}}, per_object(work())));
            }
            endpoint growth;
            growth.where = {{"scene", "line"},
                            {"sort", sort},
                            {"displacement", displacement},
                            {"elements", value_of(conditions.front()->scene(), "objects") + " to " +
                                             value_of(conditions.back()->scene(), "objects")}};
            if (const auto inversions = inversions_of(conditions))
                growth.observed = {{"inversions", three_digits(*inversions)}};
            // Bootstrapped: the line is fitted anew to each resample of the measurements.
            growth.log_ratios = {bootstrap(measured_work.log_per_element.front().size(),
                                           [&](const resample& d) { return measured_work.growth(d); })};
            growth.source = "c2: growth of comparisons and moves of sort=" + std::string(sort);
            c2.add(std::move(growth), subject, "inversions", quantity::work);
        }
    if (by_displacement.empty()) return c2;
    c2.claim.tables.push_back({"c2_inversions",
                               "Inversions per element. On the longest lines floats round small displacements away, "
                               "so they have fewer. A list in which any key stays the same is merged with those that "
                               "changed, which moves each element once more.",
                               inversions_table(by_displacement)});
    figure& f = c2.claim.figures.emplace_back(
        log_log("c2",
                "Comparisons and moves per element against the number of elements, at a displacement of a tenth of an "
                "edge. A horizontal line is O(N).",
                "elements", "comparisons and moves per element"));
    std::vector<method> methods;
    for (const auto& [sort, subject] : sorts) methods.push_back({sort, {{kind::sort, sort}}});
    f.lines = series_of(methods, by_displacement["0.1"], objects_of, per_object(work()));
    f.lines.push_back(series_of("inversions", by_displacement["0.1"], objects_of, {{kind::sort, "insertion"}},
                                per_object(measured("inversions"))));
    return c2;
}

}  // namespace aabblab
