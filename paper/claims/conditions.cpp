module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabblab.statistics;

namespace aabblab {

namespace {

/// A condition on one factor.
struct predicate {
    std::string text;
    std::function<bool(const factors&)> holds;
    std::string excludes_of{};  ///< the factor of which it only excludes a value
};

/// Values of a factor where it has any.
std::set<std::string> values_of(std::span<const endpoint> all, const std::string& name) {
    std::set<std::string> values;
    for (const endpoint& e : all)
        if (std::string value = value_of(e.where, name); !value.empty()) values.insert(std::move(value));
    return values;
}

/// Where a factor is missing, nothing holds of it. `not` is for words only: of numbers it would be a hole in a range.
void add_predicates(std::span<const endpoint> all, const std::string& name, std::vector<predicate>& found) {
    const auto is_number = [&](const std::string& value) { return !std::isnan(number_of({{name, value}}, name)); };
    const std::set<std::string> values = values_of(all, name);
    for (const std::string& value : values) {
        if (const double limit = number_of({{name, value}}, name); is_number(value)) {
            found.push_back({name + " is at least " + value,
                             [=](const factors& where) { return number_of(where, name) >= limit; }});
            found.push_back(
                {name + " is at most " + value, [=](const factors& where) { return number_of(where, name) <= limit; }});
        }
        found.push_back({name + " is " + value, [=](const factors& where) { return value_of(where, name) == value; }});
    }
    for (const std::string& value : values)
        if (!is_number(value))
            found.push_back({name + " is not " + value,
                             [=](const factors& where) {
                                 const std::string there = value_of(where, name);
                                 return !there.empty() && there != value;
                             },
                             name});
}

/// Endpoints that are decided, or undecided among many but decided otherwise when taken alone, and every condition on
/// one factor that could tell them apart.
struct told_apart {
    explicit told_apart(std::span<const endpoint> all) {
        for (const endpoint& e : all)
            if (e.found != support::undecided || (e.alone != support::undecided && e.alone != support::favours))
                decided.push_back(e);
        std::vector<std::string> names;
        for (const endpoint& e : decided)
            for (const auto& [name, value] : e.where)
                if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        for (const std::string& name : names) add_predicates(decided, name, predicates);
    }

    /// How many it says the right thing of.
    template <class Holds>
    [[nodiscard]] std::size_t right(Holds holds) const {
        return static_cast<std::size_t>(std::ranges::count_if(
            decided, [&](const endpoint& e) { return holds(e.where) == (e.found == support::favours); }));
    }

    std::vector<endpoint> decided;
    std::vector<predicate> predicates;
};

}  // namespace

std::string simplest_condition(std::span<const endpoint> all) {
    const told_apart found(all);
    const auto tells_apart = [&](const auto& holds) { return found.right(holds) == found.decided.size(); };
    for (const predicate& p : found.predicates)
        if (tells_apart(p.holds)) return p.text;
    // Nearly right and simple is better than right by an exception, which another run may not have.
    if (!nearest_condition(all).empty()) return {};
    const auto favourable = std::ranges::count(found.decided, support::favours, &endpoint::found);
    if (favourable < 2 || std::ssize(found.decided) - favourable < 2) return {};
    for (const predicate& p : found.predicates)
        for (const predicate& q : found.predicates) {
            if (&p >= &q) continue;
            // Exceptions one by one are no condition.
            if (!p.excludes_of.empty() && p.excludes_of == q.excludes_of) continue;
            if (tells_apart([&](const factors& where) { return p.holds(where) && q.holds(where); }))
                return p.text + " and " + q.text;
            if (tells_apart([&](const factors& where) { return p.holds(where) || q.holds(where); }))
                return p.text + " or " + q.text;
        }
    return {};
}

std::string nearest_condition(std::span<const endpoint> all) {
    constexpr double least_share = 0.8;
    const told_apart found(all);
    const auto favourable = static_cast<double>(std::ranges::count(found.decided, support::favours, &endpoint::found));
    const auto others = static_cast<double>(found.decided.size()) - favourable;
    // Of those that favour the claim, and of those that do not: a condition that nothing meets says nothing.
    const auto share_right = [&](const predicate& p) {
        double met = 0, rightly_not = 0;
        for (const endpoint& e : found.decided) {
            met += e.found == support::favours && p.holds(e.where);
            rightly_not += e.found != support::favours && !p.holds(e.where);
        }
        return std::min(met / favourable, rightly_not / others);
    };
    if (favourable == 0 || others == 0) return {};
    const auto best = std::ranges::max_element(found.predicates, {}, share_right);
    if (best == found.predicates.end() || share_right(*best) < least_share) return {};
    return best->text + " (right in " + std::to_string(found.right(best->holds)) + " of the " +
           std::to_string(found.decided.size()) + " that speak for or against it)";
}

}  // namespace aabblab
