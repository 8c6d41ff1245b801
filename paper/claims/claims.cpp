module;
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
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

/// The same of a long number; others as they are.
std::string grouped_if_long(const std::string& text) {
    return text.size() < 5 ? text : number_text(text);
}

std::size_t count_of(std::span<const endpoint> all, support what) {
    return static_cast<std::size_t>(std::ranges::count(all, what, &endpoint::found));
}

std::string word_of(const endpoint& e) {
    if (e.expected == expectation::not_more && e.found == support::favours && e.direction == outcome::undecided)
        return "not more";
    switch (e.direction) {
        case outcome::less: return "less";
        case outcome::same: return "the same";
        case outcome::more: return "more";
        case outcome::undecided: break;
    }
    return "open";
}

/// Every primary ratio, and how many others say what.
std::string figures_of(std::span<const endpoint> all) {
    std::string text;
    std::vector<endpoint> others;
    for (const endpoint& e : all) {
        if (!e.is_primary) {
            others.push_back(e);
            continue;
        }
        text += fmt::format("{}{}: {}, {}", text.empty() ? "" : "; ", text_of(e.where), ratio_text(e), word_of(e));
    }
    if (text.empty()) return "There are no measurements that decide it.";
    text = "Primary ratios, each with its 95 % interval: " + text + ".";
    if (others.empty()) return text;
    return text + fmt::format(
                      " Of {} other conditions {} favour the claim, {} contradict it, {} show no difference and "
                      "{} are undecided.",
                      others.size(), count_of(others, support::favours), count_of(others, support::contradicts),
                      count_of(others, support::no_difference), count_of(others, support::undecided));
}

/// Judged.
claim_result finished(const draft& made, const std::vector<endpoint>& all) {
    claim_result claim = made.claim;
    claim.verdict = verdict_of(all);
    claim.sentence = sentence_of(all, claim.lead);
    std::vector<endpoint> of_primary_lines;
    std::ranges::copy_if(all, std::back_inserter(of_primary_lines), [&](const endpoint& e) {
        return std::ranges::any_of(all, [&](const endpoint& p) { return p.is_primary && is_same_line(p, e); });
    });
    claim.brief = sentence_of(of_primary_lines, claim.lead);
    std::vector<endpoint> beside;
    for (const candidate& c : made.beside)
        if (c.known()) beside.push_back(endpoint_of(c, claim.expected));
    if (!beside.empty()) claim.sentence += " " + sentence_of(beside);
    if (!claim.remark.empty()) claim.sentence += " " + claim.remark;
    claim.because = figures_of(all);
    std::vector<endpoint> ordered = all;
    std::ranges::stable_partition(ordered, &endpoint::is_primary);
    claim.has_primary = !ordered.empty() && ordered.front().is_primary;
    if (claim.has_primary) claim.primary = ordered.front();
    claim.secondary.assign(ordered.begin() + (claim.has_primary ? 1 : 0), ordered.end());
    std::string name = claim.id;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    claim.tables.insert(claim.tables.begin(),
                        {name,
                         "Every endpoint of " + claim.id + ": " + claim.measured +
                             ". Outcomes are by Holm's rule, of primary ones over all claims, of the others over this "
                             "one; intervals are each one's own.",
                         endpoint_table(ordered, [](const endpoint& e) {
                             return text_of(e.found) + (e.is_primary ? " (primary)" : "");
                         })});
    return claim;
}

/// The drafts of all claims, from one machine.
std::vector<draft> drafts_of(const measurements& m) {
    std::vector<draft> all{improved_search(m),  linear_sort(m),         shell_sort(m),    more_segments(m),
                           cut_against_grid(m), triangle_for_box(m),    less_memory(m),   less_time(m),
                           balanced_tree(m),    large_objects_split(m), one_cut_a_box(m), whole_algorithm(m),
                           fewer_box_tests(m),  insensitive_search(m)};
    for (draft& d : all)
        for (const std::string& experiment : d.claim.experiments)
            for (const condition& c : m.of(experiment)) d.claim.scenes.push_back(c.of());
    return all;
}

/// Puts what another machine measured beside it. What it did not measure is not known of all machines.
void add_machine(std::vector<draft>& all, const std::vector<draft>& more) {
    const auto add = [](std::vector<candidate>& to, const std::vector<candidate>& from) {
        for (candidate& c : to) {
            const auto same = std::ranges::find_if(
                from, [&](const candidate& other) { return other.where == c.where && other.source == c.source; });
            c.log_ratios.push_back(same == from.end() ? estimate{std::nan("")} : same->log_ratios.front());
        }
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        add(all[i].candidates, more[i].candidates);
        add(all[i].beside, more[i].beside);
    }
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

figure_point point_of(double x, const candidate& c) {
    const estimate ratio = c.log_ratio();
    const interval range = ratio.range();
    return {x, std::exp(ratio.value), std::exp(range.low), std::exp(range.high)};
}

candidate candidate_of(const condition& c, const selection& arm, const selection& base, const std::string& metric,
                       factors more) {
    candidate made;
    made.where = c.of();
    made.where.insert(made.where.end(), more.begin(), more.end());
    made.source = c.experiment() + ": " + metric + " of " + text_of(arm) + " over " + text_of(base);
    const cells ratios = c.log_ratios(arm, base, measured(metric));
    made.log_ratios = {ratios.empty() ? estimate{std::nan("")} : bootstrap(ratios)};
    return made;
}

estimate between(const cells& above, const cells& below) {
    if (above.empty() || below.empty()) return {std::nan("")};
    return bootstrap(above.size(), [&](const resample& d) { return d.mean_of(above) - d.mean_of(below); });
}

factors place_of(const endpoint& e) {
    factors place = e.where;
    place.insert(place.end(), e.observed.begin(), e.observed.end());
    return place;
}

std::vector<endpoint> primaries_of(const claim_result& claim) {
    std::vector<endpoint> all;
    if (claim.has_primary) all.push_back(claim.primary);
    std::ranges::copy_if(claim.secondary, std::back_inserter(all), &endpoint::is_primary);
    return all;
}

std::vector<endpoint> secondaries_of(const claim_result& claim) {
    std::vector<endpoint> all;
    std::ranges::remove_copy_if(claim.secondary, std::back_inserter(all), &endpoint::is_primary);
    return all;
}

bool is_brownian(const condition& c) {
    return value_of(c.of(), "scene") == "brownian";
}

bool is_drifting(const condition& c) {
    return is_brownian(c) && value_of(c.of(), "objects") == "10000" && value_of(c.of(), "displacement") == "0.1";
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
    return judged({&m, 1});
}

reproduction judged(std::span<const measurements> machines) {
    const measurements& first = machines.front();
    std::vector<draft> drafts = drafts_of(first);
    for (const measurements& m : machines.subspan(1)) add_machine(drafts, drafts_of(m));
    reproduction all;
    const std::vector<std::vector<endpoint>> endpoints = decided(drafts, equivalence_band);
    for (std::size_t i = 0; i < drafts.size(); ++i) all.claims.push_back(finished(drafts[i], endpoints[i]));
    all.headline = headline_of(all.claims);
    all.disturbance = disturbance_of(machines);
    all.choices = open_choices(first);
    all.tables = table1(first);
    all.bands = bands_table(drafts);
    all.null_control = null_control(first);
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
