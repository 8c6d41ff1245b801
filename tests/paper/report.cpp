#include <regex>

#include "../experiments/temporary_folder.hpp"
#include "../matches.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.reproduction;
import aabblab.statistics;
import aabblab.tables;

using aabblab::claim_result;
using aabblab::verdict_kind;

namespace {

claim_result claim(const std::string& id, verdict_kind verdict, double ratio, aabblab::interval range) {
    return {.id = id,
            .claim = "What the paper says in " + id,
            .measured = "one over the other",
            .verdict = verdict,
            .sentence = "The verdict on " + id + " in words.",
            .brief = "The verdict on " + id + " in brief.",
            .evidence = "The figures of " + id + ".",
            .has_primary = true,
            .primary = {.ratio = ratio, .range = range}};
}

aabblab::reproduction made_up() {
    aabblab::reproduction all;
    all.headline = {"The first sentence.", "The second one.", "The third one."};
    all.claims = {claim("C1", verdict_kind::holds, 0.5, {0.4, 0.6}),
                  claim("C7a", verdict_kind::in_part, 0.0182, {0.018, 0.019}),
                  claim("C7b", verdict_kind::undecided, 2, {0.1, 19}),
                  claim("C8", verdict_kind::no_difference, 1.01, {0.99, 1.03})};
    claim_result unmeasured = claim("C9", verdict_kind::undecided, 0, {});
    unmeasured.has_primary = false;
    all.claims.push_back(unmeasured);
    all.bands = {"bands", "Verdicts by band.", {{{"", false}, {"0 %", false}}, {{"C1", "holds"}}}};
    all.null_control = {"null_control", "Nothing to be found.", {{{"ratio"}}, {{"1"}}}};
    return all;
}

struct reports {
    std::string html, markdown, macros;
};

reports written(const aabblab::reproduction& all, const std::string& agreement = {}) {
    const temporary_folder folder;
    const aabblab::measurements none(folder.path());
    write_reproduction(folder.path(), {&none, 1}, all, {}, {}, agreement);
    return {bytes_of_file(folder / "report.html"), bytes_of_file(folder / "report.md"),
            bytes_of_file(folder / "macros.tex")};
}

/// The row of a claim on the page.
std::string row_of(const std::string& page, const std::string& id) {
    const std::size_t begin = page.find("href=\"#" + id + "\"");
    REQUIRE(begin != std::string::npos);
    return page.substr(begin, page.find("</a>", begin) - begin);
}

}  // namespace

TEST_CASE("Reports begin with the headline, and before it with what disturbed the run") {
    aabblab::reproduction all = made_up();
    const reports quiet = written(all);
    all.disturbance = "Another program kept a core busy.";
    const reports disturbed = written(all);
    for (const auto& [undisturbed, told] :
         {std::pair(quiet.html, disturbed.html), std::pair(quiet.markdown, disturbed.markdown)}) {
        std::size_t before = 0;
        for (const std::string& sentence : all.headline) {
            const std::size_t at = told.find(sentence);
            REQUIRE(at != std::string::npos);
            CHECK(at > before);
            before = at;
        }
        CHECK(told.find(all.disturbance) < told.find(all.headline.front()));
        CHECK(told.find("What the paper says in") > before);
        CHECK_FALSE(holds(undisturbed, all.disturbance));
    }
}

TEST_CASE("Verdicts are compared with those of another run, and each that differs is told") {
    const std::vector<claim_result> here = made_up().claims;
    CHECK(agreement_of(here, here, "the other") == "5 of 5 verdicts agree with the other.");
    std::vector<claim_result> there = here;
    there[0].verdict = verdict_kind::in_part;
    there[3].verdict = verdict_kind::does_not_hold;
    there.pop_back();
    CHECK(agreement_of(here, there, "the other") ==
          "2 of 5 verdicts agree with the other: C1: here holds, there holds in part; C8: here no difference, there "
          "does not hold; C9: here undecided, there none.");
    const reports told = written(made_up(), "4 of 5 verdicts agree with the other.");
    for (const auto& report : {told.html, told.markdown}) CHECK(holds(report, "4 of 5 verdicts agree with the other."));
}

TEST_CASE("Every claim that was measured has its interval drawn in its row, beside its verdict in words") {
    const aabblab::reproduction all = made_up();
    const std::string page = written(all).html;
    CHECK(count_of("class=\"claim ", page) == all.claims.size());
    for (const claim_result& c : all.claims) {
        const std::string row = row_of(page, c.id);
        CHECK(holds(row, c.claim));
        CHECK(holds(row, c.brief));
        CHECK(holds(page, c.sentence));
        CHECK(count_of("<svg class=\"interval\"", row) == (c.has_primary ? 1 : 0));
        if (c.has_primary) CHECK(count_of(ratio_text(c.primary), row) == 2);
        CHECK(holds(page, "<h2 id=\"" + c.id + "\">"));
    }
}

TEST_CASE("What lies beyond the scale of the rows is an arrow with its number") {
    const std::string page = written(made_up()).html;
    const auto texts = [&](const std::string& id) {
        std::string all;
        for (const std::string& text : found_in(row_of(page, id), "<text[^>]*>([^<]*)</text>")) all += text + " ";
        return all;
    };
    CHECK(texts("C1") == "0.25 0.5 1 2 4 ");
    CHECK(count_of("<path", row_of(page, "C1")) == 0);
    CHECK(texts("C7a") == "0.25 0.5 1 2 4 0.0182 ");
    CHECK(count_of("<path", row_of(page, "C7a")) == 1);
    CHECK(count_of("<circle", row_of(page, "C7a")) == 0);
    CHECK(texts("C7b") == "0.25 0.5 1 2 4 0.100 19.0 ");
    CHECK(count_of("<path", row_of(page, "C7b")) == 2);
    // Places are parts of the width, none beyond it.
    for (const std::string& percent : found_in(page, "=\"(-?[0-9.]+)%\""))
        CHECK((0 <= std::stod(percent) && std::stod(percent) <= 100));
}

TEST_CASE("The rule is drawn once, and every verdict that there can be is explained") {
    const std::string page = written(made_up()).html;
    CHECK(count_of("<svg class=\"rule\"", page) == 1);
    for (const char* word : {"less", "no difference", "more", "undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</text>"));
    for (const char* word : {"Holds", "Holds in part", "No difference", "Does not hold", "Undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</span></dt>"));
    CHECK(holds(page, "Verdicts by band."));
}

TEST_CASE("The paper learns from its numbers which claims there are, and what each has") {
    const std::string macros = written(made_up()).macros;
    CHECK(holds(macros, "\\aabbset{claims}{C1,C7a,C7b,C8,C9}"));
    CHECK(holds(macros, "\\aabbset{headline}{The first sentence. The second one. The third one.}"));
    CHECK(holds(macros, "\\aabbset{C7a.sentence}{The verdict on C7a in words.}"));
}
