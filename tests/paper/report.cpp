#include <regex>

#include "../experiments/temporary_folder.hpp"
#include "../matches.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.reproduction;
import aabblab.statistics;
import aabblab.tables;

using aabblab::claim_result;
using aabblab::endpoint;
using aabblab::quantity;
using aabblab::support;
using aabblab::verdict_kind;

namespace {

claim_result claim(const std::string& id, verdict_kind verdict, double ratio, aabblab::interval range) {
    return {.id = id,
            .of = "paper",
            .claim = "What the paper says in " + id,
            .quote = "Its words on " + id,
            .regime = "the regime of " + id,
            .measured = "one over the other",
            .verdict = verdict,
            .sentence = "The verdict on " + id + " in words.",
            .brief = "The verdict on " + id + " in brief.",
            .evidence = "The figures of " + id + ".",
            .primaries = {{.where = {{"scene", "scene of " + id}}, .ratio = ratio, .range = range}}};
}

aabblab::reproduction fictitious() {
    aabblab::reproduction reproduction;
    reproduction.headline = "Of 3 claims, 2 hold.";
    reproduction.claims = {claim("C1", verdict_kind::holds, 0.5, {0.4, 0.6}),
                           claim("C7a", verdict_kind::in_part, 0.0182, {0.018, 0.019}),
                           claim("C7b", verdict_kind::undecided, 2, {0.1, 19}),
                           claim("C8", verdict_kind::no_difference, 1.01, {0.99, 1.03})};
    claim_result unmeasured = claim("C9", verdict_kind::undecided, 0, {});
    unmeasured.primaries.clear();
    reproduction.claims.push_back(unmeasured);
    reproduction.bands = {"bands", "Verdicts by band.", {{{"", false}, {"0 %", false}}, {{"C1", "holds"}}}};
    reproduction.null_control = {"null_control", "Nothing to be found.", {{{"ratio"}}, {{"1"}}}};
    return reproduction;
}

struct reports {
    std::string html, markdown, macros;
};

reports written(const aabblab::reproduction& reproduction,
                const std::optional<aabblab::published_run>& published = {}) {
    const temporary_folder folder;
    const aabblab::measurements no_results(folder.path());
    write_reproduction(folder.path(), {&no_results, 1}, reproduction, {}, {}, published);
    return {bytes_of_file(folder / "report.html"), bytes_of_file(folder / "report.md"),
            bytes_of_file(folder / "macros.tex")};
}

/// The part of a text from one mark up to the next occurrence of another.
std::string part_of(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    CAPTURE(from);
    REQUIRE(begin != std::string::npos);
    return text.substr(begin, text.find(to, begin + from.size()) - begin);
}

/// The row of a claim in the summary, on the first page.
std::string summary_row(const std::string& page, const std::string& id) {
    const std::string summary = part_of(page, "<table class=\"summary\">", "</table>");
    return part_of(summary, "href=\"#" + id + "\"", "</tr>");
}

/// The rows of a claim in the table of all primary ratios, on the second page.
std::string ratio_rows(const std::string& page, const std::string& id) {
    const std::string ratios = part_of(page, "<table class=\"ratios\">", "</table>");
    return part_of(ratios, "href=\"#" + id + "\"", "</tbody>");
}

}  // namespace

TEST_CASE("Reports begin with the number of verdicts, preceded by any disturbance of the run") {
    aabblab::reproduction reproduction = fictitious();
    const reports quiet = written(reproduction);
    reproduction.disturbance = "Another program kept a core busy.";
    const reports disturbed = written(reproduction);
    for (const auto& [undisturbed, stated] :
         {std::pair(quiet.html, disturbed.html), std::pair(quiet.markdown, disturbed.markdown)}) {
        std::size_t before = 0;
        for (const char* const part : {"Another program kept a core busy.", "Of 3 claims, 2 hold.",
                                       "What the paper says in", "The ratios that decide"}) {
            CAPTURE(part);
            const std::size_t at = stated.find(part, before);
            REQUIRE(at != std::string::npos);
            before = at;
        }
        CHECK_FALSE(holds(undisturbed, reproduction.disturbance));
    }
}

TEST_CASE("Verdicts are compared with those of the published run, and differences are listed") {
    const std::vector<claim_result> here = fictitious().claims;
    CHECK(agreement_of_verdicts(here, {"the other", here}) == "5 of 5 verdicts agree with the other.");
    CHECK(agreement_of_verdicts(here, {"the other", {}}) == "The results are those of the other.");
    std::vector<claim_result> there = here;
    there[0].verdict = verdict_kind::in_part;
    there[3].verdict = verdict_kind::does_not_hold;
    there.pop_back();
    const std::string sentence =
        "2 of 5 verdicts agree with the other: C1: here holds, there holds in part; C8: here no difference, there "
        "does not hold; C9: here undecided, there none.";
    CHECK(agreement_of_verdicts(here, {"the other", there}) == sentence);
    const reports out = written(fictitious(), aabblab::published_run{"the other", there});
    for (const auto& report : {out.html, out.markdown}) CHECK(holds(report, sentence));
    CHECK(holds(out.macros, "\\aabbset{agreement}{" + sentence + "}"));
}

TEST_CASE("Every claim and every primary ratio is compared with the published run") {
    aabblab::reproduction reproduction = fictitious();
    std::vector<claim_result> there = reproduction.claims;
    there[0].verdict = verdict_kind::in_part;
    there[0].primaries[0].ratio = 0.8;
    there[0].primaries[0].corrected = support::contradicts;
    there[1].primaries[0].where = {{"scene", "another"}};
    there.pop_back();
    const reports out = written(reproduction, aabblab::published_run{"the other", there});
    for (const auto& [id, agreement] : {std::pair("C1", "holds in part, 0 of 1 ratios agree"),
                                        {"C7a", "agrees, 0 of 1 ratios agree"},
                                        {"C8", "agrees, 1 of 1 ratios agree"},
                                        {"C9", "not judged there"}}) {
        CAPTURE(id);
        CHECK(holds(summary_row(out.html, id), agreement));
        CHECK(holds(out.markdown, agreement));
    }
    // The published amount, with its outcome where that is another, or nothing to compare with.
    CHECK(holds(ratio_rows(out.html, "C1"), ">0.800, against<"));
    CHECK(holds(ratio_rows(out.html, "C7a"), ">-<"));
    CHECK(holds(ratio_rows(out.html, "C8"), ">1.010<"));
    CHECK(holds(out.html, "Published run: holds in part, 0 of 1 ratios agree."));
    CHECK(holds(out.html, "The published run does not judge this claim."));

    // Nothing is compared with itself.
    for (const std::string& html :
         {written(reproduction).html, written(reproduction, aabblab::published_run{"the other", {}}).html})
        CHECK_FALSE(holds(html, ">published run<"));
    CHECK(holds(written(reproduction, aabblab::published_run{"the other", {}}).html,
                "The results are those of the other."));
}

TEST_CASE("The summary has a line per claim, with its verdict and how much it is, in one unit") {
    aabblab::reproduction reproduction = fictitious();
    claim_result& several = reproduction.claims[0];
    several.primaries[0].corrected = support::favours;
    several.primaries.push_back({.ratio = 0.25, .range = {0.2, 0.3}, .corrected = support::favours});
    several.primaries.push_back({.ratio = 4, .range = {3, 5}, .corrected = support::contradicts});
    several.primaries.push_back(
        {.ratio = 0.3, .range = {0.2, 0.4}, .corrected = support::favours, .compared = quantity::bytes});
    reproduction.claims[1].primaries[0].compared = quantity::box_tests;
    const reports out = written(reproduction);
    CHECK(count_of("<tr class=\"claim ", out.html) == reproduction.claims.size());
    for (const claim_result& c : reproduction.claims) {
        const std::string row = summary_row(out.html, c.id);
        CHECK(holds(row, c.claim));
        CHECK(holds(row, "<q>" + c.quote + "</q>"));
        CHECK(holds(row, ">" + text_of(c.verdict) + "<"));
        CHECK(holds(out.html, c.sentence));
        CHECK(holds(out.html, "<h2 id=\"" + c.id + "\">"));
    }
    for (const auto& [id, amount] :
         {std::pair<std::string, std::string>(
              "C1", "3 for: 0.250 to 0.500 times the time, 0.300 times the memory; 1 against: 4.00 times the time"),
          {"C7a", "0.0182 times the box tests"},
          {"C7b", "2.00 times the time"},
          {"C9", "not measured"}}) {
        CAPTURE(id);
        CHECK(holds(summary_row(out.html, id), ">" + amount + "<"));
        CHECK(holds(out.markdown, "| " + amount + " |"));
    }
}

TEST_CASE("Claims that are not the paper's stand apart") {
    aabblab::reproduction reproduction = fictitious();
    CHECK_FALSE(holds(written(reproduction).html, "Li, Feng and Owen"));
    reproduction.claims.back().of = "SMB";
    const std::string summary = part_of(written(reproduction).html, "<table class=\"summary\">", "</table>");
    CHECK(summary.find("href=\"#C8\"") < summary.find("Li, Feng and Owen"));
    CHECK(summary.find("Li, Feng and Owen") < summary.find("href=\"#C9\""));
    CHECK(count_of("class=\"group\"", summary) == 1);
}

TEST_CASE("The rows of a claim's ratios state once what all have in common") {
    aabblab::reproduction reproduction = fictitious();
    std::vector<endpoint>& ratios = reproduction.claims[0].primaries;
    ratios[0].where = {{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.1"}};
    ratios.push_back({.where = {{"scene", "brownian"}, {"objects", "1000"}, {"over", "cut"}, {"displacement", "0.1"}},
                      .ratio = 1,
                      .range = {1, 1}});
    reproduction.claims[0].missing = {"on a line"};
    std::vector<endpoint>& nested = reproduction.claims[1].primaries;
    nested.push_back(nested.front());
    nested.back().where.emplace_back("sweep", "all_axes");
    const reports out = written(reproduction);
    const std::string rows = ratio_rows(out.html, "C1");
    CHECK(holds(rows, "one over the other; all: brownian, displacement 0.1<"));
    CHECK(holds(rows, ">objects 10,000<"));
    CHECK_FALSE(holds(rows, "as above"));
    CHECK(holds(rows, ">objects 1,000, over cut<"));
    CHECK(holds(ratio_rows(out.html, "C7a"), "<td>as above<"));
    CHECK(holds(ratio_rows(out.html, "C7a"), "<td>sweep all_axes<"));
    CHECK(holds(rows, ">on a line</td><td colspan=\"4\">not measured, so undecided<"));
    CHECK(holds(out.markdown, "| C1 | on a line | - | - | - | not measured |"));
    CHECK(holds(summary_row(out.html, "C1"), "2 undecided: 0.500 to 1.00 times the time; 1 not measured"));
    const std::string section = part_of(out.html, "<h2 id=\"C1\">", "<h2 ");
    for (const char* part : {"<blockquote>Its words on C1</blockquote>", "the regime of C1",
                             ">brownian, objects 10,000, displacement 0.1<", "not measured, so undecided"})
        CHECK(holds(section, part));
}

TEST_CASE("A ratio that only Holm's correction leaves undecided says so") {
    aabblab::reproduction reproduction = fictitious();
    reproduction.claims[0].primaries[0].uncorrected = support::favours;
    const reports out = written(reproduction);
    CHECK(holds(ratio_rows(out.html, "C1"), ">undecided (by Holm's correction)<"));
    CHECK(holds(ratio_rows(out.html, "C7b"), ">undecided<"));
}

TEST_CASE("Every primary ratio has a row with its condition, amount, interval, outcome and picture") {
    aabblab::reproduction reproduction = fictitious();
    reproduction.claims[0].primaries[0].corrected = support::favours;
    const reports out = written(reproduction);
    const std::string row = ratio_rows(out.html, "C1");
    for (const char* part :
         {"<tr class=\"holds\">", ">scene of C1<", ">0.500 times the time<", ">0.400 to 0.600<", ">for<", "<circle"})
        CHECK(holds(row, part));
    for (const claim_result& c : reproduction.claims) {
        CHECK(count_of("<svg class=\"interval\"", ratio_rows(out.html, c.id)) == c.primaries.size());
        // The section of the claim repeats its rows.
        const std::string section = part_of(out.html, "<h2 id=\"" + c.id + "\">", "<h2 ");
        CHECK(count_of("<td class=\"picture\">", section) == c.primaries.size());
    }
    CHECK(holds(ratio_rows(out.html, "C9"), "not measured"));
    CHECK(holds(out.markdown, "| C1 | scene of C1 | 0.500 | 0.400 to 0.600 | times the time | for |"));
}

TEST_CASE("A value beyond the scale of the pictures is drawn as an arrow") {
    const std::string page = written(fictitious()).html;
    const auto has = [&](const std::string& id, std::size_t arrows, std::size_t discs) {
        const std::string rows = ratio_rows(page, id);
        CAPTURE(id);
        CHECK(count_of("<path", rows) == arrows);
        CHECK(count_of("<circle", rows) == discs);
    };
    has("C1", 0, 1);
    has("C7a", 1, 0);
    has("C7b", 2, 1);
    // Positions are fractions of the width.
    for (const std::string& percent : found_in(page, "=\"(-?[0-9.]+)%\""))
        CHECK((0 <= std::stod(percent) && std::stod(percent) <= 100));
}

TEST_CASE("The contents follow the two first pages, and every link of a report has its target") {
    const reports out = written(fictitious());
    for (const auto& [text, target, link] : {std::tuple(out.html, " id=\"([^\"]*)\"", "href=\"#([^\"]*)\""),
                                             {out.markdown, "<a id=\"([^\"]*)\"", "\\]\\(#([^)]*)\\)"}}) {
        const std::vector<std::string> targets = found_in(text, target);
        CHECK(std::set(targets.begin(), targets.end()).size() == targets.size());
        const std::vector<std::string> links = found_in(text, link);
        for (const std::string& to : links) {
            CAPTURE(to);
            CHECK(std::ranges::find(targets, to) != targets.end());
        }
        for (const char* const section :
             {"ratios", "terms", "rule", "bands", "C1", "C9", "table1", "open", "provenance"})
            CHECK(std::ranges::find(links, section) != links.end());
        CHECK(text.find("The ratios that decide") < text.find("Contents"));
    }
    const std::string after_contents = part_of(out.html, "</nav>", "</body>");
    CHECK(count_of("<h2 ", after_contents) == count_of("<a class=\"up\" href=\"#contents\">", after_contents));
}

TEST_CASE("Reports say what the paper is about, and explain words of the field") {
    const reports out = written(fictitious());
    for (const std::string& report : {out.html, out.markdown})
        for (const char* part :
             {"Shell sort instead of insertion sort, and cuts each axis", "0.5 times the time is half of it"})
            CHECK(holds(report, part));
    const std::string list = part_of(out.html, "<dl class=\"terms\">", "</dl>");
    CHECK(holds(list, "<dt>broad phase</dt><dd>the paper's global search; finds"));
    CHECK(holds(list, "(ciura)</dd>\n<dt>axial_cut</dt>"));
    CHECK(count_of("<dt>", list) > 15);
    CHECK(holds(out.markdown, "- broad phase: the paper's global search; finds"));
}

TEST_CASE("The figure of the verdicts has every primary ratio, by outcome") {
    aabblab::reproduction reproduction = fictitious();
    reproduction.claims[0].primaries[0].corrected = support::favours;
    reproduction.claims[0].primaries.push_back({.ratio = 3, .range = {2, 4}, .corrected = support::contradicts});
    const temporary_folder folder;
    const aabblab::measurements no_results(folder.path());
    write_reproduction(folder.path(), {&no_results, 1}, reproduction, {}, {});
    const std::string csv = bytes_of_file(folder / "figures/verdicts.csv");
    CHECK(holds(csv, "1,0,0.5,0.4,0.6,for the claim,C1\n"));
    CHECK(holds(csv, "2,0,3,2,4,against it,C1\n"));
    CHECK(holds(csv, "4,1,0.0182,0.018,0.019,undecided,C7a\n"));
}

TEST_CASE("A claim's section begins with its verdict and primary ratios, and the other ones follow") {
    aabblab::reproduction reproduction = fictitious();
    reproduction.claims[0].sentence = reproduction.claims[0].brief + " Secondary ratios: twice as fast.";
    const reports out = written(reproduction);
    const std::string section = part_of(out.html, "<h2 id=\"C1\">", "<h2 ");
    const std::size_t brief = section.find("<span class=\"word\">Holds.</span> The verdict on C1 in brief.</p>");
    const std::size_t ratios = section.find("<table class=\"ratios\">");
    const std::size_t others = section.find("<p>Secondary ratios: twice as fast.</p>");
    CHECK(brief < ratios);
    CHECK(ratios < others);
    CHECK(others != std::string::npos);
    CHECK(holds(out.markdown, "**holds.** The verdict on C1 in brief.\n"));
    CHECK(holds(out.markdown, "\n\nSecondary ratios: twice as fast.\n\n"));
}

TEST_CASE("The rule is drawn once, and every possible verdict is explained") {
    const std::string page = written(fictitious()).html;
    CHECK(count_of("<svg class=\"rule\"", page) == 1);
    for (const char* word : {"less: for the claim", "no difference", "more: against it", "undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</text>"));
    for (const char* word : {"Holds", "Holds in part", "No difference", "Does not hold", "Undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</span></dt>"));
    CHECK(holds(page, "Verdicts by band."));
}

TEST_CASE("The macros of the paper list the claims and their sentences") {
    const std::string macros = written(fictitious()).macros;
    CHECK(holds(macros, "\\aabbset{claims}{C1,C7a,C7b,C8,C9}"));
    CHECK(holds(macros, "\\aabbset{headline}{Of 3 claims, 2 hold.}"));
    CHECK(holds(macros, "\\aabbset{C7a.sentence}{The verdict on C7a in words.}"));
}
