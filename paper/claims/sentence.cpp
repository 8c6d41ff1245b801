module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Factors from here on have one decimal, smaller ones two.
constexpr double factor_threshold = 1.5;
/// Ratios within this factor are reported as a single one.
constexpr double equality_threshold = 1.1;

/// The nouns in the order of `quantity`; empty where labels name the quantity.
std::string noun_of(quantity compared) {
    constexpr std::array nouns{"time", "bytes", "box tests", "", "slowdown", "time relative to the cut's"};
    return nouns[static_cast<std::size_t>(compared)];
}

/// "1.27", "2.1", "107"; factors near 1 have more decimals.
std::string times_text(double factor) {
    if (factor >= 9.95) return grouped(static_cast<std::size_t>(std::llround(factor)));
    return fmt::format("{:.{}f}", factor, factor < 1.02 ? 3 : factor < factor_threshold ? 2 : 1);
}

/// "12", or "1.2" for small shares.
std::string percent_text(double share) {
    const double percent = 100 * share;
    return percent < 1.95 ? fmt::format("{:.1f}", percent) : fmt::format("{:.0f}", percent);
}

/// "1.2 to 3.4", or a single number if both are equal.
std::string span_text(const std::string& low, const std::string& high) {
    return low == high ? high : low + " to " + high;
}

/// The size of ratios on one side of 1: "up to 2.1 times as fast", "1.27 times as long", "34 to 36 % of the bytes".
std::string size_text(std::span<const endpoint> endpoints) {
    const auto [least, greatest] = std::ranges::minmax_element(endpoints, {}, &endpoint::ratio);
    const double low = least->ratio, high = greatest->ratio;
    if (const quantity compared = least->compared; compared != quantity::time) {
        const std::string noun = noun_of(compared);
        return span_text(percent_text(low), percent_text(high)) + " %" + (noun.empty() ? "" : " of the " + noun);
    }
    const bool is_faster = high < 1;
    const double least_factor = is_faster ? 1 / high : low;
    const double greatest_factor = is_faster ? 1 / low : high;
    const std::string unit = is_faster ? " times as fast" : " times as long";
    // Almost equal ratios are reported as one, unless they are near 1, where a small difference matters.
    if (least_factor >= factor_threshold && greatest_factor / least_factor <= equality_threshold)
        return times_text(std::sqrt(least_factor * greatest_factor)) + unit;
    return span_text(times_text(least_factor), times_text(greatest_factor)) + unit;
}

/// The phrase for endpoints (ratios of a claim) with one outcome, `form`: "up to 2.1 times as fast", "no difference".
std::string outcome_text(std::span<const endpoint> endpoints, wording form) {
    if (form == wording::less || form == wording::more) return size_text(endpoints);
    const quantity compared = endpoints.front().compared;
    const std::string noun = noun_of(compared);
    if (form == wording::not_more) return "no more" + (noun.empty() ? "" : " " + noun);
    if (form == wording::not_less)
        return (compared == quantity::bytes || compared == quantity::box_tests ? "no fewer" : "no less") +
               (noun.empty() ? "" : " " + noun);
    const bool is_named = !noun.empty() && compared != quantity::time;
    return form == wording::same ? "no difference" + (is_named ? " in the " + noun : "")
                                 : "undecided" + (is_named ? " (" + noun + ")" : "");
}

/// Consecutive endpoints of a clause with the same outcome.
struct stretch {
    wording form;
    std::vector<endpoint> endpoints;
};

/// Divides the ordered endpoints (ratios) of a clause into stretches: maximal runs with the same outcome.
std::vector<stretch> stretches_of(std::span<const endpoint> endpoints) {
    std::vector<stretch> stretches;
    for (const endpoint& e : endpoints) {
        if (stretches.empty() || stretches.back().form != wording_of(e)) stretches.push_back({wording_of(e), {}});
        stretches.back().endpoints.push_back(e);
    }
    return stretches;
}

/// The range of the factor over the i-th stretch, a run of successive ratios with the same outcome: "with 100 objects",
/// "with up to 1,000 objects", "on 2 or more axes". It is empty if the clause has a single value.
std::string range_text(const std::vector<stretch>& stretches, std::size_t i) {
    const std::vector<endpoint>& endpoints = stretches[i].endpoints;
    const std::string& factor = endpoints.front().along;
    const std::string first = number_text(value_of(factors_of(endpoints.front()), factor));
    const std::string last = number_text(value_of(factors_of(endpoints.back()), factor));
    if (stretches.size() == 1 && first == last) return "";
    const std::string values = first == last               ? last
                               : stretches.size() == 1     ? first + " to " + last
                               : i == 0                    ? "up to " + last
                               : i + 1 == stretches.size() ? first + " or more"
                                                           : first + " to " + last;
    if (factor == "objects") return " with " + values + (values == "1" ? " object" : " objects");
    if (factor == "axes") return " on " + values + (values == "1" ? " axis" : " axes");
    if (factor == "inversions") return " at " + values + " inversions per element";
    if (factor == "displacement") return " at " + values + (values == "1" ? " edge" : " edges") + " per frame";
    return " at " +
           (factor == "ratio"     ? "an edge ratio"
            : factor == "density" ? "a volume fraction"
                                  : "a " + factor) +
           " of " + values;
}

/// Outcomes along a factor: "1.30 times as long with 100 objects, 2.0 times as fast with 1,000 or more".
std::string ordered_outcomes(std::span<const endpoint> endpoints) {
    const std::vector<stretch> stretches = stretches_of(endpoints);
    std::string text;
    for (std::size_t i = 0; i < stretches.size(); ++i)
        text +=
            (i == 0 ? "" : ", ") + outcome_text(stretches[i].endpoints, stretches[i].form) + range_text(stretches, i);
    return text;
}

/// Outcomes without an order: "from 1.2 times as fast to 1.3 times as long"; undecided ratios are only counted.
std::string unordered_outcomes(std::vector<endpoint> endpoints) {
    std::string undecided = outcome_text(endpoints, wording::open);
    const std::size_t count = endpoints.size();
    const std::size_t open = std::erase_if(endpoints, [](const endpoint& e) { return wording_of(e) == wording::open; });
    if (endpoints.empty()) return undecided;
    std::ranges::sort(endpoints, {}, &endpoint::ratio);
    const std::vector<stretch> stretches = stretches_of(endpoints);
    const auto text_of = [](const endpoint& e) { return outcome_text({&e, 1}, wording_of(e)); };
    const std::string text = stretches.size() == 1
                                 ? outcome_text(stretches.front().endpoints, stretches.front().form)
                                 : "from " + text_of(endpoints.front()) + " to " + text_of(endpoints.back());
    return text + (open == 0 ? "" : fmt::format(" in {} of {} conditions, {} undecided", count - open, count, open));
}

/// What was compared, which may be empty, and what was found: "on drifting cubes", "2.0 times as fast".
struct clause {
    std::string label;
    std::string outcomes;
};

/// The clause of a claim's sentence that reports `member` and all other ratios of the same subject and quantity.
clause clause_of(std::span<const endpoint> endpoints, const endpoint& member) {
    std::vector<endpoint> reported;
    std::ranges::copy_if(endpoints, std::back_inserter(reported),
                         [&](const endpoint& e) { return is_same_clause(e, member); });
    if (member.along.empty()) return {*member.subject, unordered_outcomes(std::move(reported))};
    std::ranges::stable_sort(reported, {}, [&](const endpoint& e) { return number_of(factors_of(e), member.along); });
    return {*member.subject, ordered_outcomes(reported)};
}

/// "Shell sort, on boxes: 1.13 times as long"; without lead and label only the outcomes.
std::string clause_text(const std::string& lead, const clause& c) {
    const std::string label = lead + (lead.empty() || c.label.empty() ? "" : ", ") + c.label;
    return label + (label.empty() ? "" : ": ") + c.outcomes;
}

const claim_result* claim_named(std::span<const claim_result> claims, const std::string& id) {
    const auto claim = std::ranges::find(claims, id, &claim_result::id);
    return claim != claims.end() ? &*claim : nullptr;
}

/// The part of the headline that compares the improved broad phase with the classic incremental sweep and prune, under
/// the paper's premise that objects hardly move; empty if it was not measured.
std::string classic_sweep_text(std::span<const claim_result> claims) {
    const claim_result* claim = claim_named(claims, "C1a");
    if (!claim) return "";
    for (const endpoint& e : claim->primaries)
        if (value_of(e.where, "over") == "incremental")
            return ". " + clause_text(fmt::format("Its time with little motion (up to {} edges per frame)",
                                                  value_of(factors_of(e), "displacement")),
                                      clause_of({&e, 1}, e));
    return "";
}

/// What "undecided" means, to follow a sentence that has this word; otherwise empty.
std::string meaning_of_undecided_in(const std::string& sentence) {
    return sentence.find("undecided") == std::string::npos
               ? ""
               : " Undecided: the intervals show neither a difference beyond the band nor that there is none.";
}

/// The clause that reports a claim's first primary endpoint, for the headline.
clause first_clause(std::span<const claim_result> claims, const std::string& id) {
    const claim_result* claim = claim_named(claims, id);
    if (!claim || claim->primaries.empty() || !claim->primaries.front().subject) return {"", "not measured"};
    std::vector<endpoint> endpoints = claim->primaries;
    endpoints.insert(endpoints.end(), claim->secondaries.begin(), claim->secondaries.end());
    return clause_of(endpoints, endpoints.front());
}

}  // namespace

wording wording_of(const endpoint& e) {
    if (e.direction != outcome::undecided) return static_cast<wording>(e.direction);
    return e.corrected == support::favours       ? wording::not_more
           : e.corrected == support::contradicts ? wording::not_less
                                                 : wording::open;
}

/// Appends the counts above 0 with their verbs: ", 2 hold, 1 does not hold and 3 are undecided."
std::string counts_text(std::string text, std::initializer_list<counted_verb> counts) {
    auto left = std::ranges::count_if(counts, [](const counted_verb& c) { return c.count > 0; });
    std::string_view separator = ", ";
    for (const auto& [count, singular, plural] : counts) {
        if (count == 0) continue;
        text += fmt::format("{}{} {}", separator, count, count == 1 ? singular : plural);
        separator = --left > 1 ? ", " : " and ";
    }
    return text + ".";
}

/// Groups the digits of whole numbers, also among other words: "10,000 to 100,000".
std::string number_text(const std::string& value) {
    if (const std::size_t blank = value.find(' '); blank != std::string::npos)
        return number_text(value.substr(0, blank)) + " " + number_text(value.substr(blank + 1));
    std::uint64_t number = 0;
    const char* const end = value.data() + value.size();
    return std::from_chars(value.data(), end, number) == std::from_chars_result{end, std::errc{}} ? grouped(number)
                                                                                                  : value;
}

/// The sentence on a claim: a clause for each subject and quantity of its endpoints (ratios), in the order of their
/// first ones. Successive clauses on one subject share its label. Endpoints without a subject are not mentioned.
/// @param lead precedes the first label
std::string sentence_of(std::span<const endpoint> endpoints, const std::string& lead) {
    if (endpoints.empty()) return "There are no measurements that decide it.";
    std::string text, label;
    for (auto e = endpoints.begin(); e != endpoints.end(); ++e) {
        const auto shares_clause = [&](const endpoint& other) { return is_same_clause(*e, other); };
        if (!e->subject || std::any_of(endpoints.begin(), e, shares_clause)) continue;
        const clause c = clause_of(endpoints, *e);
        text += text.empty() ? clause_text(lead, c) : c.label == label ? ", " + c.outcomes : "; " + clause_text("", c);
        label = c.label;
    }
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text + ".";
}

/// A summary of three parts: broad phase, narrow phase, number of verdicts of each kind on claims of the paper.
std::vector<std::string> headline_of(std::span<const claim_result> claims) {
    const auto is_of_paper = [](const claim_result& c) { return c.of == "paper"; };
    const auto count = [&](verdict_kind v) {
        return std::ranges::count_if(claims, [&](const claim_result& c) { return is_of_paper(c) && c.verdict == v; });
    };
    const std::string broad_phase =
        clause_text(
            "Time of the improved broad phase (Shell sort, axial cut), compared with the traditional one (insertion "
            "sort, no cut)",
            first_clause(claims, "C1a")) +
        classic_sweep_text(claims) + ".";
    return {broad_phase + meaning_of_undecided_in(broad_phase),
            clause_text("The compressed tree of the narrow phase, compared with the canonical one",
                        first_clause(claims, "C7a")) +
                clause_text("; its queries", first_clause(claims, "C7b")) + ".",
            counts_text(fmt::format("Of the paper's {} claims", std::ranges::count_if(claims, is_of_paper)),
                        {{count(verdict_kind::holds), "holds", "hold"},
                         {count(verdict_kind::in_part), "holds in part", "hold in part"},
                         {count(verdict_kind::does_not_hold), "does not hold", "do not hold"},
                         {count(verdict_kind::no_difference), "shows no difference", "show no difference"},
                         {count(verdict_kind::undecided), "is undecided", "are undecided"}})};
}

}  // namespace aabblab
