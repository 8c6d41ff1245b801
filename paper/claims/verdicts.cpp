module;
#include <fmt/format.h>

module aabblab.claims;

import aabblab.numbers;

namespace aabblab {

namespace {

/// "10,000"; what is shorter as it is.
std::string grouped_if_long(const std::string& text) {
    return text.size() < 5 ? text : number_text(text);
}

}  // namespace

table endpoint_table(std::span<const endpoint> all, const std::function<std::string(const endpoint&)>& outcome) {
    std::vector<factors> places;
    for (const endpoint& e : all) places.push_back(place_of(e));
    const place_columns columns(places);
    table t{columns.head(), {}};
    t.columns.insert(t.columns.end(), {{"measured"}, {"95 %"}, {"outcome", false}});
    for (const endpoint& e : all) {
        std::vector<std::string>& cells = t.rows.emplace_back(columns.cells(place_of(e)));
        cells.push_back(ratio_digits_of(e.ratio));
        cells.push_back(ratio_digits_of(e.range.low) + " to " + ratio_digits_of(e.range.high));
        cells.push_back(outcome(e));
    }
    return t;
}

place_columns::place_columns(std::span<const factors> places) {
    for (const factors& place : places)
        for (const auto& [name, value] : place)
            if (std::ranges::find(names_, name) == names_.end() &&
                std::ranges::any_of(places,
                                    [&, n = name, v = value](const factors& other) { return value_of(other, n) != v; }))
                names_.push_back(name);
}

place_columns::place_columns(const std::vector<condition>& conditions)
    : place_columns([&] {
          std::vector<factors> places;
          for (const condition& c : conditions) places.push_back(c.of());
          return places;
      }()) {}

std::vector<column> place_columns::head() const {
    std::vector<column> columns;
    for (const std::string& name : names_) columns.push_back({name, false});
    return columns;
}

std::vector<std::string> place_columns::cells(const factors& place) const {
    std::vector<std::string> all;
    for (const std::string& name : names_) all.push_back(grouped_if_long(value_of(place, name)));
    return all;
}

std::string dependence_of(const open_choice& choice) {
    bool undecided = choice.alternatives.empty();
    for (const open_choice::alternative& a : choice.alternatives) {
        if (a.measured.found == support::undecided)
            undecided = true;
        else if (choice.alternatives.front().measured.found != support::undecided &&
                 a.measured.found != choice.alternatives.front().measured.found)
            return "yes";
    }
    return undecided ? "undecided" : "no";
}

std::string ratio_digits_of(double ratio) {
    return ratio >= 1 && ratio < 10 ? fmt::format("{:.3f}", ratio) : three_digits(ratio);
}

std::string ratio_text(const endpoint& e) {
    return fmt::format("{} ({} to {})", ratio_digits_of(e.ratio), ratio_digits_of(e.range.low),
                       ratio_digits_of(e.range.high));
}

std::string text_of(const factors& where) {
    std::string text;
    for (const auto& [name, value] : where)
        if (!value.empty())
            text += (text.empty() ? "" : ", ") + (name == "scene" ? value : name + " " + grouped_if_long(value));
    return text;
}

std::string text_of(const claim_result& claim) {
    return text_of(claim.verdict);
}

table verdict_table(const reproduction& all) {
    table t{{{"", false},
             {"claim", false},
             {"verdict", false},
             {"in words", false},
             {"ratio"},
             {"95 %"},
             {"for"},
             {"against"},
             {"same"},
             {"undecided"}},
            {}};
    for (const claim_result& c : all.claims) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{c.id, c.claim, text_of(c), c.sentence});
        cells.push_back(c.has_primary ? ratio_digits_of(c.primary.ratio) : "-");
        cells.push_back(c.has_primary
                            ? ratio_digits_of(c.primary.range.low) + " to " + ratio_digits_of(c.primary.range.high)
                            : "-");
        const std::vector<endpoint> others = secondaries_of(c);
        for (const support what : {support::favours, support::contradicts, support::no_difference, support::undecided})
            cells.push_back(std::to_string(count_of(others, what)));
    }
    return t;
}

table brief_table(const reproduction& all) {
    table t{{{"", false}, {"claim", false}, {"verdict", false}, {"primary ratios", false}}, {}};
    for (const claim_result& c : all.claims) {
        std::string ratios;
        for (const endpoint& e : primaries_of(c)) ratios += (ratios.empty() ? "" : ", ") + ratio_digits_of(e.ratio);
        t.rows.push_back({c.id, c.claim, text_of(c), ratios.empty() ? "-" : ratios});
    }
    return t;
}

table choice_table(const reproduction& all) {
    table t{{{"left open", false},
             {"our choice", false},
             {"why", false},
             {"claim", false},
             {"its ratio", false},
             {"changes it", false}},
            {}};
    for (const open_choice& c : all.choices) {
        std::string ratios;
        for (const open_choice::alternative& a : c.alternatives)
            ratios += (ratios.empty() ? "At " + c.where + ": " : "; ") + a.label + " " + ratio_text(a.measured);
        t.rows.push_back(
            {c.question, c.choice, c.why, c.claim, ratios.empty() ? "not measured" : ratios, dependence_of(c)});
    }
    return t;
}

}  // namespace aabblab
