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
            .primaries = {{.ratio = ratio, .range = range}}};
}

aabblab::reproduction fictitious() {
    aabblab::reproduction reproduction;
    reproduction.headline = {"The first sentence.", "The second one.", "The third one."};
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

reports written(const aabblab::reproduction& reproduction, const std::string& verdict_agreement = {}) {
    const temporary_folder folder;
    const aabblab::measurements no_results(folder.path());
    write_reproduction(folder.path(), {&no_results, 1}, reproduction, {}, {}, verdict_agreement);
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

TEST_CASE("Reports begin with the headline, preceded by any disturbance of the run") {
    aabblab::reproduction reproduction = fictitious();
    const reports quiet = written(reproduction);
    reproduction.disturbance = "Another program kept a core busy.";
    const reports disturbed = written(reproduction);
    for (const auto& [undisturbed, stated] :
         {std::pair(quiet.html, disturbed.html), std::pair(quiet.markdown, disturbed.markdown)}) {
        std::size_t before = 0;
        for (const std::string& sentence : reproduction.headline) {
            const std::size_t at = stated.find(sentence);
            REQUIRE(at != std::string::npos);
            CHECK(at > before);
            before = at;
        }
        CHECK(stated.find(reproduction.disturbance) < stated.find(reproduction.headline.front()));
        CHECK(stated.find("What the paper says in") > before);
        CHECK_FALSE(holds(undisturbed, reproduction.disturbance));
    }
}

TEST_CASE("Verdicts are compared with those of another run, and differences are listed") {
    const std::vector<claim_result> here = fictitious().claims;
    CHECK(agreement_of_verdicts(here, here, "the other") == "5 of 5 verdicts agree with the other.");
    std::vector<claim_result> there = here;
    there[0].verdict = verdict_kind::in_part;
    there[3].verdict = verdict_kind::does_not_hold;
    there.pop_back();
    CHECK(agreement_of_verdicts(here, there, "the other") ==
          "2 of 5 verdicts agree with the other: C1: here holds, there holds in part; C8: here no difference, there "
          "does not hold; C9: here undecided, there none.");
    const reports out = written(fictitious(), "4 of 5 verdicts agree with the other.");
    for (const auto& report : {out.html, out.markdown}) CHECK(holds(report, "4 of 5 verdicts agree with the other."));
}

TEST_CASE("The row of every measured claim shows its interval and its verdict") {
    const aabblab::reproduction reproduction = fictitious();
    const std::string page = written(reproduction).html;
    CHECK(count_of("class=\"claim ", page) == reproduction.claims.size());
    for (const claim_result& c : reproduction.claims) {
        const std::string row = row_of(page, c.id);
        CHECK(holds(row, c.claim));
        CHECK(holds(row, c.brief));
        CHECK(holds(page, c.sentence));
        CHECK(count_of("<svg class=\"interval\"", row) == c.primaries.size());
        if (!c.primaries.empty()) CHECK(count_of(ratio_text(c.primaries.front()), row) == 2);
        CHECK(holds(page, "<h2 id=\"" + c.id + "\">"));
    }
}

TEST_CASE("A value beyond the scale of the rows is drawn as an arrow with its number") {
    const std::string page = written(fictitious()).html;
    const auto texts = [&](const std::string& id) {
        std::string labels;
        for (const std::string& text : found_in(row_of(page, id), "<text[^>]*>([^<]*)</text>")) labels += text + " ";
        return labels;
    };
    CHECK(texts("C1") == "0.25 0.5 1 2 4 ");
    CHECK(count_of("<path", row_of(page, "C1")) == 0);
    CHECK(texts("C7a") == "0.25 0.5 1 2 4 0.0182 ");
    CHECK(count_of("<path", row_of(page, "C7a")) == 1);
    CHECK(count_of("<circle", row_of(page, "C7a")) == 0);
    CHECK(texts("C7b") == "0.25 0.5 1 2 4 0.100 19.0 ");
    CHECK(count_of("<path", row_of(page, "C7b")) == 2);
    // Positions are fractions of the width.
    for (const std::string& percent : found_in(page, "=\"(-?[0-9.]+)%\""))
        CHECK((0 <= std::stod(percent) && std::stod(percent) <= 100));
}

TEST_CASE("The rule is drawn once, and every possible verdict is explained") {
    const std::string page = written(fictitious()).html;
    CHECK(count_of("<svg class=\"rule\"", page) == 1);
    for (const char* word : {"less", "no difference", "more", "undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</text>"));
    for (const char* word : {"Holds", "Holds in part", "No difference", "Does not hold", "Undecided"})
        CHECK(holds(page, ">" + std::string(word) + "</span></dt>"));
    CHECK(holds(page, "Verdicts by band."));
}

TEST_CASE("The macros of the paper list the claims and their sentences") {
    const std::string macros = written(fictitious()).macros;
    CHECK(holds(macros, "\\aabbset{claims}{C1,C7a,C7b,C8,C9}"));
    CHECK(holds(macros, "\\aabbset{headline}{The first sentence. The second one. The third one.}"));
    CHECK(holds(macros, "\\aabbset{C7a.sentence}{The verdict on C7a in words.}"));
}
