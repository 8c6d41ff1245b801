module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Ratios from here on are reported as factors, smaller ones in percent.
constexpr double factor_threshold = 1.5;
/// Ratios within this factor are reported as a single one.
constexpr double equality_threshold = 1.1;

std::string_view noun_of(quantity compared) {
    constexpr std::array nouns{"time", "bytes", "box tests", "work", "worst slowdown"};
    return nouns[static_cast<std::size_t>(compared)];
}

std::string times_text(double factor) {
    return factor < 9.95 ? fmt::format("{:.1f}", factor) : grouped(static_cast<std::size_t>(std::llround(factor)));
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

/// The least and the greatest of several ratios on one side of 1, as factors above 1.
struct extent {
    double mild;
    double strong;

    [[nodiscard]] bool is_narrow() const { return strong / mild <= equality_threshold; }
    [[nodiscard]] std::string times() const {
        return is_narrow() ? times_text(std::sqrt(mild * strong)) : span_text(times_text(mild), times_text(strong));
    }
};

/// A reduction of time, as a factor of speed if it is large: "12 % less time", "2.1 times as fast".
std::string less_time_text(const extent& e) {
    if (e.mild >= factor_threshold) return e.times() + " times as fast";
    if (e.strong >= factor_threshold) return "up to " + times_text(e.strong) + " times as fast";
    return span_text(percent_text(1 - 1 / e.mild), percent_text(1 - 1 / e.strong)) + " % less time";
}

/// The strongest reduction comes first.
std::string less_text(const extent& e, std::string_view noun) {
    return span_text(percent_text(1 / e.strong), percent_text(1 / e.mild)) + " % of the " + std::string(noun);
}

std::string more_text(const extent& e, std::string_view noun) {
    if (e.mild >= factor_threshold) return fmt::format("{} times the {}", e.times(), noun);
    if (e.strong >= factor_threshold) return fmt::format("up to {} times the {}", times_text(e.strong), noun);
    return fmt::format("{} % more {}", span_text(percent_text(e.mild - 1), percent_text(e.strong - 1)), noun);
}

/// The extent of ratios that all lie on one side of 1; those below 1 are inverted.
extent extent_of(std::span<const endpoint> endpoints) {
    extent range{std::max(endpoints[0].ratio, 1 / endpoints[0].ratio), 0};
    for (const endpoint& e : endpoints) {
        const double factor = std::max(e.ratio, 1 / e.ratio);
        range = {std::min(range.mild, factor), std::max(range.strong, factor)};
    }
    return range;
}

/// The outcome of an endpoint, as a sentence reports it.
enum class wording : unsigned char { less, same, more, not_more, open };
wording kind_of(const endpoint& e) {
    if (e.direction != outcome::undecided) return static_cast<wording>(e.direction);
    return e.corrected == support::favours ? wording::not_more : wording::open;
}

/// Time is the default quantity and not mentioned.
std::string quantity_suffix(quantity compared) {
    return compared == quantity::time ? "" : " in the " + std::string(noun_of(compared));
}

/// The phrase for endpoints (ratios of a claim) with the same outcome: "up to 2.1 times as fast".
std::string predicate_of(std::span<const endpoint> endpoints, wording form) {
    const quantity compared = endpoints.front().compared;
    const std::string_view noun = noun_of(compared);
    const extent range = extent_of(endpoints);
    switch (form) {
        case wording::less: return compared == quantity::time ? less_time_text(range) : less_text(range, noun);
        case wording::more: return more_text(range, noun);
        case wording::same: return "no difference" + quantity_suffix(compared);
        case wording::not_more: return fmt::format("no more {}", noun);
        case wording::open: break;
    }
    return "undecided" + quantity_suffix(compared);
}

/// "10,000 objects", "a displacement of 0.1".
std::string factor_text(const std::string& factor, const std::string& value) {
    if (factor == "objects") return number_text(value) + (value == "1" ? " object" : " objects");
    if (factor == "axes") return value + (value == "1" ? " axis" : " axes");
    if (factor == "inversions") return number_text(value) + " inversions per element";
    return "a " + factor + " of " + number_text(value);
}

/// Consecutive endpoints of a clause with the same outcome.
struct stretch {
    wording form;
    std::vector<endpoint> endpoints;
};

/// Divides the ordered endpoints of a clause into stretches, where the outcome changes.
std::vector<stretch> stretches_of(std::span<const endpoint> endpoints) {
    std::vector<stretch> stretches;
    for (const endpoint& e : endpoints) {
        if (stretches.empty() || stretches.back().form != kind_of(e)) stretches.push_back({kind_of(e), {}});
        stretches.back().endpoints.push_back(e);
    }
    return stretches;
}

/// The range of a stretch: "at 100 objects", "up to 1,000 objects", "from 3,162 objects on", "from 10 to 100 objects".
std::string range_text(const std::vector<stretch>& stretches, std::size_t i) {
    const std::string& factor = stretches[i].endpoints.front().along;
    const std::string first = value_of(factors_of(stretches[i].endpoints.front()), factor);
    const std::string last = value_of(factors_of(stretches[i].endpoints.back()), factor);
    if (stretches.size() == 1) return "";
    if (i == 0 && stretches[i].endpoints.size() > 1) return " up to " + factor_text(factor, last);
    if (i + 1 == stretches.size() && stretches[i].endpoints.size() > 1)
        return " from " + factor_text(factor, first) + " on";
    if (first == last) return " at " + factor_text(factor, first);
    return " from " + number_text(first) + " to " + factor_text(factor, last);
}

std::string subject_text(const endpoint& e) {
    return e.subject->empty() ? "" : " " + *e.subject;
}

/// Reports ordered endpoints by stretches: "30 % more time at 100 objects, 2.0 times as fast from 1,000 objects on".
std::string ordered_clause(std::span<const endpoint> endpoints) {
    const std::vector<stretch> stretches = stretches_of(endpoints);
    std::string text;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        text += (i == 0 ? "" : ", ") + predicate_of(stretches[i].endpoints, stretches[i].form);
        if (i == 0) text += subject_text(endpoints.front());
        text += range_text(stretches, i);
    }
    return text;
}

/// Reports the least and the greatest ratio if their outcomes differ, and of undecided ones only the number.
std::string unordered_clause(std::vector<endpoint> endpoints) {
    const std::string subject = subject_text(endpoints.front());
    const std::string undecided = predicate_of(endpoints, wording::open);
    const std::size_t count = endpoints.size();
    const std::size_t open = std::erase_if(endpoints, [](const endpoint& e) { return kind_of(e) == wording::open; });
    if (endpoints.empty()) return undecided + subject;
    std::ranges::sort(endpoints, {}, &endpoint::ratio);
    const std::vector<stretch> stretches = stretches_of(endpoints);
    const auto text_of = [](const endpoint& e) { return predicate_of({&e, 1}, kind_of(e)); };
    const std::string text = stretches.size() == 1
                                 ? predicate_of(stretches.front().endpoints, stretches.front().form)
                                 : "from " + text_of(endpoints.front()) + " to " + text_of(endpoints.back());
    return text + subject + (open == 0 ? "" : fmt::format(", {} of {} conditions undecided", open, count));
}

const claim_result* claim_named(std::span<const claim_result> claims, const std::string& id) {
    const auto claim = std::ranges::find(claims, id, &claim_result::id);
    return claim != claims.end() ? &*claim : nullptr;
}

/// The comparison with the classic sweep under the paper's own premise, that objects hardly move.
std::string classic_sweep_clause(std::span<const claim_result> claims) {
    const claim_result* claim = claim_named(claims, "C1");
    if (!claim) return "";
    for (const endpoint& e : primaries_of(*claim))
        if (value_of(e.where, "over") == "incremental") return "; with little motion, " + clause_of({&e, 1}, e);
    return "";
}

/// The clause that reports a claim's first primary endpoint, for the headline.
std::string first_clause(std::span<const claim_result> claims, const std::string& id) {
    const claim_result* claim = claim_named(claims, id);
    if (!claim || !claim->has_primary || !claim->primary.subject) return "not measured";
    std::vector<endpoint> endpoints{claim->primary};
    endpoints.insert(endpoints.end(), claim->secondary.begin(), claim->secondary.end());
    return clause_of(endpoints, claim->primary);
}

/// "Of 14 claims 2 hold, 6 hold in part, 5 do not hold and 1 is undecided."
std::string counts_of(std::span<const claim_result> claims) {
    std::vector<std::string> parts;
    const auto add = [&](verdict_kind verdict, const char* singular, const char* plural) {
        if (const auto count = std::ranges::count(claims, verdict, &claim_result::verdict); count > 0)
            parts.push_back(fmt::format("{} {}", count, count == 1 ? singular : plural));
    };
    add(verdict_kind::holds, "holds", "hold");
    add(verdict_kind::in_part, "holds in part", "hold in part");
    add(verdict_kind::does_not_hold, "does not hold", "do not hold");
    add(verdict_kind::no_difference, "shows no difference", "show no difference");
    add(verdict_kind::undecided, "is undecided", "are undecided");
    std::string text = fmt::format("Of {} claims", claims.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        text += (i == 0 ? " " : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    return text + ".";
}

}  // namespace

std::string number_text(const std::string& value) {
    std::uint64_t number = 0;
    const char* const end = value.data() + value.size();
    return std::from_chars(value.data(), end, number) == std::from_chars_result{end, std::errc{}} ? grouped(number)
                                                                                                  : value;
}

/// The clause that reports `member` and all endpoints with the same subject and quantity.
std::string clause_of(std::span<const endpoint> endpoints, const endpoint& member) {
    std::vector<endpoint> reported;
    std::ranges::copy_if(endpoints, std::back_inserter(reported),
                         [&](const endpoint& e) { return is_same_clause(e, member); });
    if (member.along.empty()) return unordered_clause(std::move(reported));
    std::ranges::stable_sort(reported, {}, [&](const endpoint& e) { return number_of(factors_of(e), member.along); });
    return ordered_clause(reported);
}

/// The sentence on a claim: a clause for each subject and quantity of its endpoints, in the order of their first ones.
std::string sentence_of(std::span<const endpoint> endpoints, const std::string& lead) {
    if (endpoints.empty()) return "There are no measurements that decide it.";
    std::string text;
    for (auto e = endpoints.begin(); e != endpoints.end(); ++e) {
        const auto shares_clause = [&](const endpoint& other) { return is_same_clause(*e, other); };
        if (!e->subject || std::any_of(endpoints.begin(), e, shares_clause)) continue;
        text += (text.empty() ? "" : "; ") + clause_of(endpoints, *e);
    }
    if (!lead.empty()) text = lead + ": " + text;
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text + ".";
}

/// A summary in three sentences: broad phase, narrow phase, number of verdicts of each kind.
std::vector<std::string> headline_of(std::span<const claim_result> claims) {
    return {
        "The improved broad phase (Shell sort, axial cut), compared with the traditional one (insertion sort, no "
        "cut): " +
            first_clause(claims, "C1") + classic_sweep_clause(claims) + ".",
        "The compressed tree of the narrow phase, compared with the canonical one: " + first_clause(claims, "C7a") +
            "; its queries: " + first_clause(claims, "C7b") + ".",
        counts_of(claims)};
}

}  // namespace aabblab
