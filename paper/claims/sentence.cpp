module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The quantity of an endpoint as a noun, to follow "no more".
std::string_view noun_of(const endpoint& e) {
    constexpr std::array<std::string_view, 6> nouns{"time", "memory", "box tests", "work", "slowdown", "time"};
    return nouns[static_cast<std::size_t>(e.compared)];
}

/// The ratios of endpoints that compare one quantity: "0.250 to 0.800 times the time", "0.342 times the memory".
std::string size_text(std::span<const endpoint> endpoints) {
    const auto [least, greatest] = std::ranges::minmax_element(endpoints, {}, &endpoint::ratio);
    return span_text(least->ratio, greatest->ratio) + " " + std::string(unit_of(*least));
}

/// The phrase for endpoints (ratios of a claim) with one outcome, `form`: "0.476 times the time", "no difference".
std::string outcome_text(std::span<const endpoint> endpoints, wording form) {
    const std::string noun(noun_of(endpoints.front()));
    const bool is_time = endpoints.front().compared == quantity::time;
    switch (form) {
        case wording::less:
        case wording::more: return size_text(endpoints);
        case wording::not_more: return is_time ? "not slower" : "no more " + noun;
        case wording::not_less:
            return is_time ? "not faster"
                           : (endpoints.front().compared == quantity::box_tests ? "no fewer " : "no less ") + noun;
        case wording::same: return is_time ? "no difference" : "no difference in the " + noun;
        case wording::open: break;
    }
    return is_time ? "undecided" : noun + " undecided";
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

/// Outcomes along a factor: "1.30 times the time with 100 objects, 0.500 times the time with 1,000 or more".
std::string ordered_outcomes(std::span<const endpoint> endpoints) {
    const std::vector<stretch> stretches = stretches_of(endpoints);
    std::string text;
    for (std::size_t i = 0; i < stretches.size(); ++i)
        text +=
            (i == 0 ? "" : ", ") + outcome_text(stretches[i].endpoints, stretches[i].form) + range_text(stretches, i);
    return text;
}

/// Outcomes without an order: "0.833 to 1.30 times the time"; undecided ratios are only counted.
std::string unordered_outcomes(std::vector<endpoint> endpoints) {
    std::string undecided = outcome_text(endpoints, wording::open);
    const std::size_t count = endpoints.size();
    const std::size_t open = std::erase_if(endpoints, [](const endpoint& e) { return wording_of(e) == wording::open; });
    if (endpoints.empty()) return undecided;
    std::ranges::sort(endpoints, {}, &endpoint::ratio);
    const std::vector<stretch> stretches = stretches_of(endpoints);
    const auto text_of = [](const endpoint& e) { return outcome_text({&e, 1}, wording_of(e)); };
    const bool has_sizes =
        wording_of(endpoints.front()) == wording::less && wording_of(endpoints.back()) == wording::more;
    const std::string text = stretches.size() == 1 ? outcome_text(stretches.front().endpoints, stretches.front().form)
                             : has_sizes           ? size_text(endpoints)
                                         : "from " + text_of(endpoints.front()) + " to " + text_of(endpoints.back());
    return text + (open == 0 ? "" : fmt::format(" in {} of {} conditions, {} undecided", count - open, count, open));
}

/// What was compared, which may be empty, and what was found: "on drifting cubes", "0.500 times the time".
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

/// "Shell sort, on boxes: 1.13 times the time"; without lead and label only the outcomes.
std::string clause_text(const std::string& lead, const clause& c) {
    const std::string label = lead + (lead.empty() || c.label.empty() ? "" : ", ") + c.label;
    return label + (label.empty() ? "" : ": ") + c.outcomes;
}

}  // namespace

std::string_view unit_of(const endpoint& e) {
    constexpr std::array<std::string_view, 6> units{"times the time", "times the memory",   "times the box tests",
                                                    "times the work", "times the slowdown", "times the time"};
    return units[static_cast<std::size_t>(e.compared)];
}

std::string span_text(double least, double greatest) {
    const std::string low = three_digits(least), high = three_digits(greatest);
    return low == high ? low : low + " to " + high;
}

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

/// "Of the paper's 19 claims, 5 hold and 4 hold in part."
std::string headline_of(std::span<const claim_result> claims) {
    const auto is_of_paper = [](const claim_result& c) { return c.of == "paper"; };
    const auto count = [&](verdict_kind v) {
        return std::ranges::count_if(claims, [&](const claim_result& c) { return is_of_paper(c) && c.verdict == v; });
    };
    return counts_text(fmt::format("Of the paper's {} claims", std::ranges::count_if(claims, is_of_paper)),
                       {{count(verdict_kind::holds), "holds", "hold"},
                        {count(verdict_kind::in_part), "holds in part", "hold in part"},
                        {count(verdict_kind::does_not_hold), "does not hold", "do not hold"},
                        {count(verdict_kind::no_difference), "shows no difference", "show no difference"},
                        {count(verdict_kind::undecided), "is undecided", "are undecided"}});
}

}  // namespace aabblab
