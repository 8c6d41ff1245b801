module aabblab.reproduction;

import aabblab.fmt;
import aabblab.markup;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Outcomes of a ratio in the order of the overview, with their words there.
constexpr std::array<std::pair<support, std::string_view>, 4> outcomes{{{support::favours, "for"},
                                                                        {support::contradicts, "against"},
                                                                        {support::no_difference, "no difference"},
                                                                        {support::undecided, "undecided"}}};

std::string outcome_text(support outcome) {
    return std::string(std::ranges::find(outcomes, outcome, &std::pair<support, std::string_view>::first)->second);
}

/// The outcome of a ratio; it says where only the correction leaves it undecided, which its interval does not show.
std::string outcome_text(const endpoint& e) {
    const bool is_by_correction = e.corrected == support::undecided && e.uncorrected != support::undecided;
    return outcome_text(e.corrected) + (is_by_correction ? " (by Holm's correction)" : "");
}

/// The colour of a ratio is that of a claim with only this one.
std::string outcome_class(support outcome) {
    return verdict_class(verdict_of(std::array{outcome}));
}

/// The ratios of one outcome, a range for each unit: "0.291 to 0.719 times the time, 0.342 times the memory".
std::string spans_text(std::span<const endpoint> endpoints, support outcome) {
    std::vector<std::pair<std::string_view, interval>> spans;  // by unit
    for (const endpoint& e : endpoints) {
        if (e.corrected != outcome) continue;
        const auto same_unit = std::ranges::find(spans, unit_of(e), &std::pair<std::string_view, interval>::first);
        if (same_unit == spans.end())
            spans.push_back({unit_of(e), {e.ratio, e.ratio}});
        else
            same_unit->second = {std::min(same_unit->second.low, e.ratio), std::max(same_unit->second.high, e.ratio)};
    }
    std::string text;
    for (const auto& [unit, span] : spans)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", span_text(span.low, span.high), unit);
    return text;
}

/// All primary ratios of a claim in a line: "2 for: 0.291 to 0.719 times the time; 1 against: 3.58 times the time".
std::string ratios_text(const claim_result& c) {
    if (c.primaries.empty()) return "not measured";
    if (c.primaries.size() == 1 && c.missing.empty()) return spans_text(c.primaries, c.primaries.front().corrected);
    std::string text;
    for (const auto& [outcome, word] : outcomes) {
        const auto count = std::ranges::count(c.primaries, outcome, &endpoint::corrected);
        if (count == 0) continue;
        text += fmt::format("{}{} {}: {}", text.empty() ? "" : "; ", count, word, spans_text(c.primaries, outcome));
    }
    return text + (c.missing.empty() ? "" : fmt::format("; {} not measured", c.missing.size()));
}

/// Whether all ratios of a claim are of conditions with this factor.
bool is_common(const std::pair<std::string, std::string>& factor, std::span<const endpoint> ratios) {
    return std::ranges::all_of(ratios,
                               [&](const endpoint& e) { return value_of(e.where, factor.first) == factor.second; });
}

/// What a claim's ratios compare, and the factors that all their conditions share.
std::string shared_text(const claim_result& c) {
    factors common;
    if (c.primaries.size() > 1)
        std::ranges::copy_if(c.primaries.front().where, std::back_inserter(common),
                             [&](const auto& factor) { return is_common(factor, c.primaries); });
    return c.measured + (common.empty() ? "" : "; all: " + text_of(common));
}

/// The other factors of a ratio's condition, if there are any.
std::string own_text(const endpoint& e, const claim_result& c) {
    factors own;
    std::ranges::copy_if(e.where, std::back_inserter(own), [&](const auto& factor) {
        return c.primaries.size() == 1 || !is_common(factor, c.primaries);
    });
    return own.empty() ? "as above" : text_of(own);
}

/// Above claims that are not the paper's.
std::string origin_text(const claim_result& c) {
    return c.of == "SMB" ? "The method that the paper follows: Li, Feng and Owen, \"SMB: collision detection based on "
                           "temporal coherence\", 2006"
                         : "Not the paper's, but of " + c.of;
}

const claim_result* published_claim(const claim_result& c, const std::optional<published_run>& published) {
    if (!published) return nullptr;
    const auto same = std::ranges::find(published->claims, c.id, &claim_result::id);
    return same == published->claims.end() ? nullptr : &*same;
}

/// The published ratio of the same quantity in the same condition.
const endpoint* published_ratio(const endpoint& e, const claim_result* published) {
    if (published == nullptr) return nullptr;
    const auto same = std::ranges::find_if(published->primaries, [&](const endpoint& other) {
        return other.where == e.where && other.source == e.source;
    });
    return same == published->primaries.end() ? nullptr : &*same;
}

/// "1 of 2 ratios agree": those that have the same outcome.
std::string agreeing_text(const claim_result& here, const claim_result& there) {
    const auto agrees = [&](const endpoint& e) {
        const endpoint* const counterpart = published_ratio(e, &there);
        return counterpart != nullptr && counterpart->corrected == e.corrected;
    };
    return fmt::format("{} of {} ratios agree", std::ranges::count_if(here.primaries, agrees), here.primaries.size());
}

/// How the published judgement of a claim agrees with this one: "agrees, 2 of 2 ratios agree", or the other verdict.
std::string agreement_text(const claim_result& here, const claim_result* there) {
    if (there == nullptr) return "not judged there";
    return (here.verdict == there->verdict ? "agrees" : text_of(there->verdict)) + ", " + agreeing_text(here, *there);
}

/// "0.717 times the time"
std::string with_unit(const endpoint& e) {
    return ratio_digits_of(e.ratio) + " " + std::string(unit_of(e));
}

/// The published ratio, with its outcome if that is another.
std::string published_text(const endpoint& e, const endpoint* published) {
    if (published == nullptr) return "-";
    const std::string ratio = ratio_digits_of(published->ratio);
    return published->corrected == e.corrected ? ratio : ratio + ", " + outcome_text(published->corrected);
}

std::string cell(std::string_view kind, const std::string& markup) {
    return element("td", {{"class", kind}}, markup);
}

std::string link_to(const claim_result& c) {
    return element("a", {{"href", "#" + c.id}}, markup_text(c.id));
}

}  // namespace

std::string verdict_class(verdict_kind verdict) {
    constexpr std::array classes{"holds", "part", "same", "not", "open"};
    return classes[static_cast<std::size_t>(verdict)];
}

/// The summary: the words of each claim, its verdict, by how much, and the published verdict if there is another run.
table summary_table(const reproduction& reproduced, const std::optional<published_run>& published) {
    table t = empty_table({"", "what is claimed", "in its authors' words", "verdict", "by how much"});
    if (published) t.columns.push_back({"published run", /*is_number=*/false});
    for (const claim_result& c : reproduced.claims) {
        const std::string origin = c.of == "paper" ? "" : ". " + origin_text(c);
        t.rows.push_back({c.id, c.claim + origin, c.quote, text_of(c.verdict), ratios_text(c)});
        if (published) t.rows.back().push_back(agreement_text(c, published_claim(c, published)));
    }
    return t;
}

/// Every primary ratio of every claim.
table primaries_table(const reproduction& reproduced, const std::optional<published_run>& published) {
    table t = empty_table({"claim", "where"}, {"ratio", "95 %"}, {"unit", "outcome"});
    if (published) t.columns.push_back({"published run", /*is_number=*/false});
    for (const claim_result& c : reproduced.claims) {
        for (const endpoint& e : c.primaries) {
            t.rows.push_back({c.id, text_of(e.where), ratio_digits_of(e.ratio), range_text(e), std::string(unit_of(e)),
                              outcome_text(e)});
            if (published)
                t.rows.back().push_back(published_text(e, published_ratio(e, published_claim(c, published))));
        }
        for (const std::string& where : c.missing) {
            t.rows.push_back({c.id, where, "-", "-", "-", "not measured"});
            if (published) t.rows.back().emplace_back("-");
        }
    }
    return t;
}

/// The summary as HTML, a row per claim with a link to its section. Claims of others follow under a heading of their
/// own.
std::string summary_html(const reproduction& reproduced, const std::optional<published_run>& published) {
    std::string rows = "\n" +
                       element("tr", {},
                               element("th", {}, "") + element("th", {}, "what is claimed, and in which words") +
                                   element("th", {}, "verdict") + element("th", {}, "by how much") +
                                   (published ? element("th", {}, "published run") : "")) +
                       "\n";
    std::string maker = "paper";  // of the last claim
    for (const claim_result& c : reproduced.claims) {
        if (std::exchange(maker, c.of) != c.of && c.of != "paper")
            rows += element("tr", {{"class", "group"}},
                            element("th", {{"colspan", published ? 5 : 4}}, markup_text(origin_text(c)))) +
                    "\n";
        const std::string quote = c.quote.empty() ? "" : element("q", {}, markup_text(c.quote));
        rows +=
            element("tr", {{"class", "claim " + verdict_class(c.verdict)}},
                    cell("id", link_to(c)) + cell("said", markup_text(c.claim) + quote) +
                        cell("word", markup_text(text_of(c.verdict))) + cell("", markup_text(ratios_text(c))) +
                        (published ? cell("", markup_text(agreement_text(c, published_claim(c, published)))) : "")) +
            "\n";
    }
    return element("div", {{"class", "wide"}}, element("table", {{"class", "summary"}}, rows)) + "\n";
}

/// The primary ratios of some claims as HTML: a row per ratio with its condition, size, outcome and picture. Of
/// several claims, each has a row above its ratios, with what these have in common.
std::string primaries_html(std::span<const claim_result> claims, const std::optional<published_run>& published) {
    std::string head = element("th", {}, "where") + element("th", {{"colspan", 2}}, "how much, and its 95 % interval") +
                       element("th", {}, "outcome");
    if (published) head += element("th", {}, "published run");
    head += element("th", {{"class", "picture"}}, interval_axis());
    std::string groups = element("thead", {}, element("tr", {}, head)) + "\n";
    const bool has_groups = claims.size() > 1;
    const int columns = published ? 6 : 5;
    for (const claim_result& c : claims) {
        std::string rows;
        if (has_groups)
            rows += element("tr", {{"class", "group"}},
                            element("th", {{"colspan", columns}}, link_to(c) + " " + markup_text(shared_text(c)))) +
                    "\n";
        if (c.primaries.empty() && c.missing.empty())
            rows += element("tr", {}, element("td", {{"colspan", columns}}, "not measured")) + "\n";
        for (const endpoint& e : c.primaries) {
            std::string row = cell("", markup_text(has_groups ? own_text(e, c) : text_of(e.where))) +
                              cell("number", markup_text(with_unit(e))) + cell("number", markup_text(range_text(e))) +
                              cell("word", markup_text(outcome_text(e)));
            if (published)
                row +=
                    cell("number", markup_text(published_text(e, published_ratio(e, published_claim(c, published)))));
            rows += element("tr", {{"class", outcome_class(e.corrected)}}, row + cell("picture", interval_picture(e))) +
                    "\n";
        }
        for (const std::string& where : c.missing)
            rows += element("tr", {},
                            cell("", markup_text(where)) +
                                element("td", {{"colspan", columns - 1}}, "not measured, so undecided")) +
                    "\n";
        groups += element("tbody", {}, "\n" + rows) + "\n";
    }
    return element("div", {{"class", "wide"}}, element("table", {{"class", "ratios"}}, "\n" + groups)) + "\n";
}

/// The sentence of a claim's section on the published run; empty if there is none.
std::string published_sentence(const claim_result& c, const std::optional<published_run>& published) {
    if (!published) return {};
    const claim_result* const there = published_claim(c, published);
    return there == nullptr ? "The published run does not judge this claim."
                            : fmt::format("Published run: {}, {}.", text_of(there->verdict), agreeing_text(c, *there));
}

}  // namespace aabblab
