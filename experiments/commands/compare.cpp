#include <fmt/format.h>

#include "command_parser.hpp"

import aabb.std;
import aabblab.comparison;
import aabblab.output;
import aabblab.record;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

struct compare_request {
    std::string a, b;
    bool times = false;
    bool all = false;
};

constexpr std::string_view text_of(outcome found) {
    switch (found) {
        case outcome::less: return "less";
        case outcome::same: return "same";
        case outcome::more: return "more";
        case outcome::undecided: break;
    }
    return "undecided";
}

std::string heading_of(const compared_scene& s) {
    return fmt::format("{}: {}, {}", s.experiment, s.scene.kind, settings_text(s.scene));
}

void print_block(const std::string& heading, const table& t) {
    if (!t.rows.empty()) print("\n" + heading + "\n" + to_text(t, output_width()));
}

void print_answers(const comparison& found) {
    table t{{{"experiment", false}, {"scene", false}, {"parameters", false}, {"digest in A", false}, {"in B", false}},
            {}};
    for (const different_answer& d : found.answers)
        t.rows.push_back({d.experiment, d.scene.kind, parameters_text(d.scene), d.in_a, d.in_b});
    print_block(fmt::format("the answers differ in {} of {} scenes", t.rows.size(), found.answers_compared), t);
}

/// Those beyond noise, or all.
table table_of(std::span<const compared_time> times, const std::string& unit, bool all) {
    table t{{{"composition", false}, {unit + " in A"}, {"in B"}, {"B/A"}, {"95 %"}, {"B is", false}}, {}};
    for (const compared_time& time : times)
        if (all || time.found == outcome::less || time.found == outcome::more)
            t.rows.push_back({time.label, fmt::format("{:.3f}", time.in_a), fmt::format("{:.3f}", time.in_b),
                              fmt::format("{:.3f}", time.change),
                              time.too_few ? "-" : fmt::format("{:.3f}-{:.3f}", time.around.low, time.around.high),
                              std::string(text_of(time.found))});
    return t;
}

/// "24 ratios compared: 2 changed beyond noise, …".
class tally {
public:
    void add(std::span<const compared_time> times) {
        for (const compared_time& time : times) {
            ++compared_;
            changed_ += time.found == outcome::less || time.found == outcome::more;
            same_ += time.found == outcome::same;
            undecided_ += time.found == outcome::undecided;
            too_few_ += time.found == outcome::undecided && time.too_few;
        }
    }

    /// @param all are listed
    [[nodiscard]] std::string text(std::string_view what, bool all) const {
        std::string text =
            fmt::format("\n{} {} compared: {} changed beyond noise, {} unchanged (within {:.0f} %), {} undecided",
                        compared_, what, changed_, same_, 100 * equivalence_band, undecided_);
        if (too_few_ > 0) text += fmt::format(", {} of them for too few repeats", too_few_);
        text += "\n";
        if (undecided_ > 0)
            text += fmt::format(
                "undecided: their intervals reach beyond {:.0f} %, or show a change only without Holm's correction for "
                "all {}{}\n",
                100 * equivalence_band, what, all ? "" : "; --all lists them");
        return text;
    }

private:
    std::size_t compared_ = 0, changed_ = 0, same_ = 0, undecided_ = 0, too_few_ = 0;
};

void print_ratios(const comparison& found, bool all) {
    tally count;
    for (const compared_scene& s : found.scenes) {
        count.add(s.ratios);
        print_block(heading_of(s) + "; time over that of '" + s.base + "'", table_of(s.ratios, "ratio", all));
    }
    print(count.text("ratios", all));
}

void print_times(const comparison& found, bool all) {
    tally count;
    for (const compared_scene& s : found.scenes) {
        count.add(s.times);
        print_block(heading_of(s) + "; milliseconds a frame", table_of(s.times, "ms", all));
    }
    print(count.text("times", all));
}

std::string percents(std::uint64_t before, std::uint64_t after) {
    if (before == 0) return "-";
    return fmt::format("{:+.2f}", 100 * (static_cast<double>(after) / static_cast<double>(before) - 1));
}

void print_numbers(const comparison& found) {
    std::size_t changed = 0;
    for (const compared_scene& s : found.scenes) {
        table t{{{"composition", false}, {"what", false}, {"in A"}, {"in B"}, {"%"}}, {}};
        for (const changed_number& n : s.changed)
            t.rows.push_back(
                {n.label, n.what, std::to_string(n.in_a), std::to_string(n.in_b), percents(n.in_a, n.in_b)});
        changed += t.rows.size();
        print_block(heading_of(s) + "; sums over seeds", t);
    }
    print(fmt::format("{}{} counts and sizes compared: {} changed\n", changed > 0 ? "\n" : "", found.numbers_compared,
                      changed));
}

int compare_folders(const compare_request& request) {
    for (const std::string& folder : {request.a, request.b}) verify_record(folder);
    const run_results a = read_results(request.a);
    const run_results b = read_results(request.b);
    if (request.times) {
        require_one_machine(a, b);
        note("times of runs at different hours differ by more than the noise within each; ratios tell more");
    }
    const comparison found = compare(a, b, request.times ? compared::ratios_and_times : compared::ratios);
    print(fmt::format("A: {} ({})\nB: {} ({})\n", visible(request.a), makers_of(a), visible(request.b), makers_of(b)));
    print_answers(found);
    print_ratios(found, request.all);
    if (request.times) print_times(found, request.all);
    print_numbers(found);
    if (found.only_in_a + found.only_in_b > 0)
        print(fmt::format("left out is what only one of them has: {} compositions in a scene of A, {} of B\n",
                          found.only_in_a, found.only_in_b));
    return found.answers.empty() ? 0 : 1;
}

}  // namespace

void add_compare(const command_parser& program) {
    const command_parser command = program.add_command(
        "compare", "Two results folders, of two commits or machines: which ratios, answers, counts and bytes changed");
    auto& request = command.calls(compare_folders);
    command.argument("A", &request.a, "Folder of results, of an experiment or of several");
    command.argument("B", &request.b, "Another, which is compared with it");
    command.flag("--times", &request.times, "Compare milliseconds too; of one machine only");
    command.flag("--all", &request.all, "List what is unchanged or undecided too");
}

}  // namespace aabblab
