module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

/// One sort on input of one disorder, at every size.
struct sizes {
    std::vector<double> log_n;
    std::vector<cells> per_element;  // logarithms

    /// How much work an element costs at ten times as many, from the straight line through work against log N; the line
    /// is flat where the sort is O(N).
    [[nodiscard]] double growth(const resample& d) const {
        std::vector<double> y;
        for (const cells& one : per_element) y.push_back(std::exp(d.mean_of(one)));
        const auto [slope, mean_y] = line_through(log_n, y);
        // A steep fall would give a negative level; the line has no meaning there.
        return std::log(std::max(1e-6, 1 + slope / mean_y));
    }
};

/// Comparisons and moves together: a sort is linear when both are.
row_value work() {
    return sum_of({"comparisons", "moves"});
}

/// "100 to 100000"
std::string sizes_text(const std::vector<const condition*>& conditions) {
    return value_of(conditions.front()->of(), "objects") + " to " + value_of(conditions.back()->of(), "objects");
}

/// "Almost ordered" is to mean the same at every size.
table inversions_table(const std::map<std::string, std::vector<const condition*>>& by_displacement) {
    table t{{{"displacement"}}, {}};
    for (const condition* c : by_displacement.begin()->second)
        t.columns.push_back({value_of(c->of(), "objects") + " elements"});
    for (const auto& [displacement, conditions] : by_displacement) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{displacement});
        for (const condition* c : conditions) cells.push_back(digits_cell(inversions_of(*c)));
    }
    return t;
}

struct sort_told {
    const char* sort;
    const char* subject;
};
constexpr sort_told sorts[] = {{"insertion", "with insertion sort"},
                               {"shell:gaps=four_one", "with Shell sort of two gaps"},
                               {"shell:gaps=ciura_eight", "with Ciura's eight gaps"},
                               {"shell:gaps=ciura", "with Ciura's gaps extended as N grows"},
                               {"shell:gaps=tokuda", "with Tokuda's gaps"},
                               {"shell:gaps=shell", "with Shell's own gaps"}};

/// As it is at most sizes.
std::optional<double> inversions_of(const std::vector<const condition*>& conditions) {
    std::vector<double> all;
    for (const condition* c : conditions)
        if (const auto one = inversions_of(*c)) all.push_back(*one);
    return all.empty() ? std::nullopt : std::optional(quartiles_of(all).median);
}

/// Sizes that tell of growth: with fewer elements the passes of the greatest gaps are cut short; and so far from the
/// origin that coordinates cannot move by a hundredth of an edge, the input is more ordered than elsewhere.
std::vector<const condition*> comparable(std::vector<const condition*> conditions) {
    constexpr double fewest = 10'000;
    constexpr double most_off = 0.1;
    std::erase_if(conditions, [](const condition* c) { return number_of(c->of(), "objects") < fewest; });
    const std::optional<double> usual = inversions_of(conditions);
    std::erase_if(conditions, [&](const condition* c) {
        const std::optional<double> here = inversions_of(*c);
        return usual && here && std::abs(*here - *usual) > most_off * *usual;
    });
    return conditions;
}

}  // namespace

draft c2_claim(const measurements& m) {
    draft made{{.claim = "Shell sort takes O(N) on almost ordered input, and insertion sort too",
                .measured = "comparisons and moves for an element at ten times as many elements over those now, by the "
                            "straight line through them against log N, from 10,000 elements on",
                .lead = "For an element at ten times as many",
                .experiments = {"c2"}},
               {{{"sort", "insertion"}, {"displacement", "0.1"}},
                {{"sort", "shell:gaps=four_one"}, {"displacement", "0.1"}},
                {{"sort", "shell:gaps=ciura_eight"}, {"displacement", "0.1"}},
                {{"sort", "shell:gaps=ciura"}, {"displacement", "0.1"}}}};
    std::map<std::string, std::vector<const condition*>> by_displacement;
    for (const condition& c : m.of("c2")) by_displacement[value_of(c.of(), "displacement")].push_back(&c);
    for (const sort_told& one : sorts)
        for (const auto& [displacement, of_all_sizes] : by_displacement) {
            sizes all;
            const std::vector<const condition*> conditions = comparable(of_all_sizes);
            if (conditions.size() < 2) continue;
            for (const condition* c : conditions) {
                all.log_n.push_back(std::log10(number_of(c->of(), "objects")));
                all.per_element.push_back(c->logs({{kind::sort, one.sort}}, an_object(work())));
            }
            endpoint c;
            c.where = {{"scene", "line"},
                       {"sort", one.sort},
                       {"displacement", displacement},
                       {"elements", sizes_text(conditions)}};
            if (const auto inversions = inversions_of(conditions))
                c.observed = {{"inversions", three_digits(*inversions)}};
            c.log_ratios = {
                bootstrap(all.per_element.front().size(), [&](const resample& d) { return all.growth(d); })};
            c.source = "c2: growth of comparisons and moves of sort=" + std::string(one.sort);
            made.add(told(std::move(c), one.subject, "inversions", quantity::work));
        }
    if (by_displacement.empty()) return made;
    made.claim.tables.push_back({"c2_inversions",
                                 "Inversions for each element, which are to be the same at every size.",
                                 inversions_table(by_displacement)});
    figure& f = made.claim.figures.emplace_back(
        log_log("c2",
                "Comparisons and moves for each element against the number of elements, at a displacement of a tenth "
                "of an edge: a level line is O(N).",
                "elements", "comparisons and moves for each element"));
    std::vector<method> methods;
    for (const sort_told& one : sorts) methods.push_back({one.sort, {{kind::sort, one.sort}}});
    f.lines = series_of(methods, by_displacement["0.1"], "objects", an_object(work()));
    f.lines.push_back(series_of("inversions", by_displacement["0.1"], "objects", {{kind::sort, "insertion"}},
                                an_object(measured("inversions"))));
    return made;
}

}  // namespace aabblab
