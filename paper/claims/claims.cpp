module;
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.numbers;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

/// Digits of a long number in groups; anything else as it is.
std::string grouped_if_number(const std::string& text) {
    if (text.size() < 5 || text.find_first_not_of("0123456789") != std::string::npos) return text;
    return grouped(std::stoull(text));
}

std::size_t count_of(std::span<const endpoint> all, support what) {
    return static_cast<std::size_t>(std::ranges::count(all, what, &endpoint::found));
}

std::string where_against_band(support found, expectation expected, double ratio) {
    if (found == support::undecided && expected == expectation::not_more)
        return "is not shown to be below 1.05, nor above";
    if (found == support::undecided) return "cannot be told from the band of no difference, 0.952 to 1.05";
    if (found == support::no_difference) return "lies within the band of no difference, 0.952 to 1.05";
    if (found == support::favours && expected == expectation::not_more && ratio > 1 / (1 + equivalence_band))
        return "is not above 1.05";
    return found == support::favours ? "is below 0.952" : "is above 1.05";
}

std::string sentence_of(const claim_result& claim) {
    if (!claim.has_primary) return "There are no measurements that decide it.";
    std::string text =
        fmt::format("At {} the ratio is {}, which {}", text_of(claim.primary.where), ratio_text(claim.primary),
                    where_against_band(claim.primary.found, claim.expected, claim.primary.ratio));
    if (claim.secondary.empty()) return text + ".";
    return text + fmt::format(
                      "; of {} other conditions {} favour the claim, {} contradict it, {} show no difference "
                      "and {} are undecided.",
                      claim.secondary.size(), count_of(claim.secondary, support::favours),
                      count_of(claim.secondary, support::contradicts),
                      count_of(claim.secondary, support::no_difference), count_of(claim.secondary, support::undecided));
}

}  // namespace

table endpoint_table(std::span<const endpoint> all, const std::function<std::string(const endpoint&)>& outcome) {
    std::vector<factors> places;
    for (const endpoint& e : all) places.push_back(e.where);
    const place_columns columns(places);
    table t{columns.head(), {}};
    t.columns.insert(t.columns.end(), {{"measured"}, {"95 %"}, {"outcome", false}});
    for (const endpoint& e : all) {
        std::vector<std::string>& cells = t.rows.emplace_back(columns.cells(e.where));
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
    for (const std::string& name : names_) all.push_back(grouped_if_number(value_of(place, name)));
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

endpoint endpoint_of(const candidate& c, expectation expected) {
    const interval range = c.log_ratio.range();
    const expectation own = c.expected.value_or(expected);
    const support alone = support_of(own, decide(evidence_of(c.log_ratio, own)));
    return {c.where, std::exp(c.log_ratio.value), {std::exp(range.low), std::exp(range.high)}, alone, alone};
}

figure_point point_of(double x, const candidate& c) {
    const interval range = c.log_ratio.range();
    return {x, std::exp(c.log_ratio.value), std::exp(range.low), std::exp(range.high)};
}

void judge(claim_result& claim, std::vector<candidate> candidates) {
    std::erase_if(candidates, [](const candidate& c) { return !c.log_ratio.known(); });
    std::vector<evidence> others;
    std::vector<expectation> expected;
    for (const candidate& c : candidates) {
        const endpoint e = endpoint_of(c, claim.expected);
        if (c.primary && !claim.has_primary) {
            claim.has_primary = true;
            claim.primary = e;
            continue;
        }
        claim.secondary.push_back(e);
        expected.push_back(c.expected.value_or(claim.expected));
        others.push_back(evidence_of(c.log_ratio, expected.back()));
    }
    const std::vector<outcome> outcomes = decide_together(others);
    std::vector<support> supports;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        claim.secondary[i].found = support_of(expected[i], outcomes[i]);
        supports.push_back(claim.secondary[i].found);
    }
    std::vector<endpoint> all;
    if (claim.has_primary) all.push_back(claim.primary);
    all.insert(all.end(), claim.secondary.begin(), claim.secondary.end());
    if (claim.has_primary) {
        claim.verdict = verdict_of(claim.primary.found, supports);
        if (claim.verdict == verdict_kind::holds_when) {
            if (count_of(all, support::favours) + count_of(all, support::undecided) == all.size()) {
                claim.when = fmt::format("in {} of {} conditions, the others are undecided",
                                         count_of(all, support::favours), all.size());
            } else if (const std::string simplest = simplest_condition(all); !simplest.empty()) {
                claim.when = "when " + simplest;
            } else {
                claim.when = fmt::format("in {} of {} conditions", count_of(all, support::favours), all.size());
                if (const std::string nearest = nearest_condition(all); !nearest.empty())
                    claim.when += ", mostly when " + nearest;
            }
        }
    }
    claim.because = sentence_of(claim);
    std::string name = claim.id;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    claim.tables.insert(
        claim.tables.begin(),
        {name,
         "Every endpoint of " + claim.id + ": " + claim.measured +
             ". Outcomes are by Holm's rule over all but the primary one, intervals are each one's own.",
         endpoint_table(all, [&](const endpoint& e) {
             return text_of(e.found) + (&e == all.data() && claim.has_primary ? " (primary)" : "");
         })});
}

candidate candidate_of(const condition& c, const selection& arm, const selection& base, const row_value& of,
                       factors more) {
    factors where = c.of();
    where.insert(where.end(), more.begin(), more.end());
    const cells ratios = c.log_ratios(arm, base, of);
    if (ratios.empty()) return {where, {std::nan(""), {}}};
    return {where, bootstrap(ratios)};
}

series series_of(const std::string& label, std::span<const condition* const> conditions, const std::string& x,
                 const selection& who, const row_value& of) {
    series s{label, series_style::line, {}};
    for (const condition* c : conditions) {
        const double place = x == "triangles" ? c->triangles() : number_of(c->of(), x);
        if (const auto point = c->point(place, who, of)) s.points.push_back(*point);
    }
    std::ranges::sort(s.points, {}, &figure_point::x);
    return s;
}

std::string mesh_of(const condition& c) {
    return value_of(c.of(), "meshes");
}

reproduction judged(const measurements& m) {
    reproduction all;
    all.claims = {improved_search(m),     linear_sort(m),      shell_sort(m),      more_segments(m),
                  cut_against_grid(m),    triangle_for_box(m), compressed_tree(m), balanced_tree(m),
                  large_objects_split(m), one_cut_a_box(m),    whole_algorithm(m), fewer_box_tests(m)};
    for (claim_result& claim : all.claims)
        for (const std::string& experiment : claim.experiments)
            for (const condition& c : m.of(experiment)) claim.scenes.push_back(c.of());
    all.choices = open_choices(m);
    all.tables = table1(m);
    all.null_control = null_control(m);
    return all;
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
            text += (text.empty() ? "" : ", ") + (name == "scene" ? value : name + " " + grouped_if_number(value));
    return text;
}

std::string text_of(support found) {
    switch (found) {
        case support::favours: return "for";
        case support::no_difference: return "no difference";
        case support::contradicts: return "against";
        case support::undecided: break;
    }
    return "undecided";
}

std::string text_of(const claim_result& claim) {
    switch (claim.verdict) {
        case verdict_kind::holds: return "holds";
        case verdict_kind::holds_when: return "holds " + claim.when;
        case verdict_kind::no_difference: return "no difference";
        case verdict_kind::does_not_hold: return "does not hold";
        case verdict_kind::undecided: break;
    }
    return "undecided";
}

table verdict_table(const reproduction& all) {
    table t{{{"", false},
             {"claim", false},
             {"verdict", false},
             {"ratio"},
             {"95 %"},
             {"for"},
             {"against"},
             {"same"},
             {"undecided"}},
            {}};
    for (const claim_result& c : all.claims) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{c.id, c.claim, text_of(c)});
        cells.push_back(c.has_primary ? ratio_digits_of(c.primary.ratio) : "-");
        cells.push_back(c.has_primary
                            ? ratio_digits_of(c.primary.range.low) + " to " + ratio_digits_of(c.primary.range.high)
                            : "-");
        for (const support what : {support::favours, support::contradicts, support::no_difference, support::undecided})
            cells.push_back(std::to_string(count_of(c.secondary, what)));
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
