module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The waiting time in percent of all frames. A quiet machine takes a thousandth for itself.
constexpr double most_waiting = 2;
/// The median difference between successive repeats, in percent.
constexpr double most_difference = 5;

}  // namespace

std::string range_text(const endpoint& e) {
    return ratio_digits_of(e.range.low) + " to " + ratio_digits_of(e.range.high);
}

/// One row per endpoint: the factors in which their conditions differ, the ratio, its interval and its outcome.
/// @param outcome returns the text of the last column
table endpoint_table(std::span<const endpoint> endpoints, const std::function<std::string(const endpoint&)>& outcome) {
    std::vector<factors> conditions;
    for (const endpoint& e : endpoints) conditions.push_back(factors_of(e));
    table t = factors_table(conditions);
    t.columns.insert(t.columns.end(), {{"ratio"}, {"95 %"}, {"outcome", /*is_number=*/false}});
    for (std::size_t i = 0; i < endpoints.size(); ++i)
        t.rows[i].insert(t.rows[i].end(),
                         {ratio_digits_of(endpoints[i].ratio), range_text(endpoints[i]), outcome(endpoints[i])});
    return t;
}

/// One row per scene, with a column for each factor whose value differs between them: others only widen the table.
table factors_table(std::span<const factors> conditions) {
    table t;
    t.rows.resize(conditions.size());
    std::set<std::string> named;
    for (const factors& where : conditions)
        for (const auto& [name, value] : where) {
            const auto differs = [n = name, v = value](const factors& other) { return value_of(other, n) != v; };
            if (named.contains(name) || std::ranges::none_of(conditions, differs)) continue;
            named.insert(name);
            t.columns.push_back({name, /*is_number=*/false});
            for (std::size_t i = 0; i < conditions.size(); ++i)
                t.rows[i].push_back(number_text(value_of(conditions[i], name)));
        }
    return t;
}

std::vector<factors> factors_of(const std::vector<condition>& conditions) {
    std::vector<factors> scenes;
    for (const condition& c : conditions) scenes.push_back(c.scene());
    return scenes;
}

/// Whether a claim's outcome depends on our choice for an open question, the first of the alternatives: "yes", if one
/// of them has another outcome; "undecided", if an outcome is undecided; otherwise "no".
std::string dependence_of(const open_choice& choice) {
    bool is_undecided = choice.alternatives.empty();
    for (const open_choice::alternative& a : choice.alternatives) {
        const support ours = choice.alternatives.front().measured.corrected;
        if (a.measured.corrected == support::undecided)
            is_undecided = true;
        else if (ours != support::undecided && a.measured.corrected != ours)
            return "yes";
    }
    return is_undecided ? "undecided" : "no";
}

std::string ratio_digits_of(double ratio) {
    return ratio >= 1 && ratio < 10 ? fmt::format("{:.3f}", ratio) : three_digits(ratio);
}

std::string ratio_text(const endpoint& e) {
    return ratio_digits_of(e.ratio) + " (" + range_text(e) + ")";
}

std::string text_of(const factors& where) {
    std::string text;
    for (const auto& [name, value] : where)
        if (!value.empty())
            text += (text.empty() ? "" : ", ") + (name == "scene" ? value : name + " " + number_text(value));
    return text;
}

/// Each claim's verdict, first primary ratio, and numbers of secondary ratios by outcome.
table verdict_table(const reproduction& results) {
    table t = empty_table(
        {"", "claim", "verdict", "in words"},
        {"first primary ratio", "95 %", "secondary for", "secondary against", "secondary same", "secondary undecided"});
    for (const claim_result& c : results.claims) {
        std::vector<std::string>& cells =
            t.rows.emplace_back(std::vector{c.id, c.claim, text_of(c.verdict), c.sentence});
        cells.push_back(c.primaries.empty() ? "-" : ratio_digits_of(c.primaries.front().ratio));
        cells.push_back(c.primaries.empty() ? "-" : range_text(c.primaries.front()));
        for (const support what : {support::favours, support::contradicts, support::no_difference, support::undecided})
            cells.push_back(std::to_string(count_of(c.secondaries, what)));
    }
    return t;
}

table brief_table(const reproduction& results) {
    table t = empty_table({"", "claim", "verdict"});
    for (const claim_result& c : results.claims)
        if (c.of == "paper") t.rows.push_back({c.id, c.claim, text_of(c.verdict)});
    return t;
}

/// What the paper leaves open: our choice, its reason, and a claim's ratio under each alternative.
table choice_table(const reproduction& results) {
    table t = empty_table({"left open", "our choice", "why", "claim", "ratio with each choice", "changes outcome"});
    for (const open_choice& c : results.choices) {
        std::string ratios;
        for (const open_choice::alternative& a : c.alternatives)
            ratios += (ratios.empty() ? "At " + c.where + ": " : "; ") + a.label + " " + ratio_text(a.measured);
        t.rows.push_back(
            {c.question, c.choice, c.why, c.claim, ratios.empty() ? "not measured" : ratios, dependence_of(c)});
    }
    return t;
}

/// The verdicts under bands of no difference of 0, 3, 5 and 10 %, which show how much they depend on the chosen 5 %.
named_table bands_table(std::span<const draft> drafts) {
    table t = empty_table({"", "claim"});
    for (const draft& d : drafts) t.rows.push_back({d.claim.id, d.claim.claim});
    for (const double band : {0.0, 0.03, 0.05, 0.1}) {
        t.columns.push_back({fmt::format("band {:.0f} %", 100 * band), /*is_number=*/false});
        const std::vector<std::vector<endpoint>> endpoints = decided(drafts, band);
        for (std::size_t i = 0; i < drafts.size(); ++i)
            t.rows[i].push_back(text_of(verdict_of(drafts[i], endpoints[i])));
    }
    return {
        "bands",
        "The verdicts under other bands of no difference. Each decides all primary ratios anew, by Holm's correction.",
        t};
}

/// Judges ratios of a composition to itself under another name. Their true value is 1, so every difference found here
/// is an error of the intervals. Their number shows how far the intervals of claims can be trusted.
named_table null_control(const measurements& m) {
    // A composition, and the same one with an explicit default.
    const std::pair<selection, selection> twins[] = {{traditional, traditional.with(kind::sweep, "one_axis:axis=auto")},
                                                     {improved, improved.with(kind::sort, "shell:gaps=ciura")}};
    std::vector<endpoint> ratios;
    for (const condition& c : m.conditions_of("null_control"))
        for (const auto& [plain, written_out] : twins) {
            const endpoint ratio = endpoint_of(c, written_out, plain, "frame_cpu_ms",
                                               {{"composition", plain[kind::sort] + " + " + plain[kind::partition]}});
            if (ratio.is_known()) ratios.push_back(decided_alone(ratio));
        }
    // An interval outside the band is a difference; one that merely excludes 1 is found by chance in one of twenty.
    const auto outcome_of = [](const endpoint& e) {
        if (e.range.low > 1 + equivalence_band || e.range.high < 1 / (1 + equivalence_band))
            return std::string("a difference");
        return e.uncorrected == support::no_difference ? text_of(e.uncorrected) : "undecided";
    };
    const table t = endpoint_table(ratios, outcome_of);
    if (ratios.empty()) return {"null_control", "There are no measurements of a null control.", t};
    const auto count = [&](const std::string& outcome) { return std::ranges::count(ratios, outcome, outcome_of); };
    const auto excluding_1 =
        std::ranges::count_if(ratios, [](const endpoint& e) { return e.range.low > 1 || e.range.high < 1; });
    const std::string text = fmt::format(
        "Null control: time per frame of a composition under two names, the second name over the first; "
        "displacements in mean edges. {} of the {} intervals {} a ratio of 1; by chance one in twenty would. Without "
        "correction",
        excluding_1 == 0 ? "None" : std::to_string(excluding_1), ratios.size(),
        excluding_1 > 1 ? "exclude" : "excludes");
    return {"null_control",
            counts_text(text, {{count("a difference"), "is decided as a difference", "are decided as a difference"},
                               {count("no difference"), "is decided as no difference", "are decided as no difference"},
                               {count("undecided"), "is undecided", "are undecided"}}),
            t};
}

/// A warning if the program waited for a processor, or successive repeats vary, by more than the limits; or empty.
std::string disturbance_of(std::span<const measurements> machines) {
    std::string text;
    for (const measurements& m : machines) {
        double wall_ms = 0, cpu_ms = 0;
        std::vector<double> differences;  // of processor time from one repeat to the next, as shares
        for (const std::string& experiment : m.experiments())
            for (const condition& c : m.conditions_of(experiment)) {
                for (const double ms : c.values(measured("frame_ms"))) wall_ms += ms;
                for (const double ms : c.values(measured("frame_cpu_ms"))) cpu_ms += ms;
                std::ranges::copy(c.differences(measured("frame_cpu_ms")), std::back_inserter(differences));
            }
        if (!(wall_ms > 0)) continue;
        const double waiting = std::max(0.0, 100 * (1 - cpu_ms / wall_ms));
        const double difference = differences.empty() ? 0 : 100 * quartiles_of(differences).median;
        if (waiting <= most_waiting && difference <= most_difference) continue;
        text += (text.empty() ? "The machine" : " The machine") +
                (machines.size() > 1 ? " of " + m.name() : std::string()) + " was not quiet.";
        if (difference > most_difference)
            text += fmt::format(
                " The median difference between successive repeats is {:.1f} %; on a quiet machine it is less than "
                "{:.0f} %.",
                difference, most_difference);
        if (waiting > most_waiting)
            text += fmt::format(
                " The program waited for a processor during {:.1f} % of the time of all frames; on a quiet machine "
                "it is less than {:.0f} %.",
                waiting, most_waiting);
        text += " The errors of ratios may exceed their intervals.";
    }
    return text;
}

}  // namespace aabblab
