module;

#include "about_md.hpp"
#include "report_css.hpp"
#include "rule_md.hpp"
#include "terms_md.hpp"

module aabblab.reproduction;

import aabblab.fmt;
import aabblab.markup;
import aabblab.numbers;

namespace aabblab {

namespace {

struct verdict_word {
    verdict_kind kind;
    std::string_view word;
    std::string_view meaning;
};

constexpr verdict_word verdict_words[] = {
    {verdict_kind::holds, "Holds", "every primary ratio favours the claim"},
    {verdict_kind::in_part, "Holds in part",
     "of the cases that the claim leaves open, some primary ratios favour it and some do not"},
    {verdict_kind::no_difference, "No difference", "every primary ratio shows no difference"},
    {verdict_kind::does_not_hold, "Does not hold",
     "primary ratios refute it: one is enough if the claim speaks of all; of cases that it leaves open, none favours "
     "it"},
    {verdict_kind::undecided, "Undecided", "a primary ratio is undecided, and the verdict depends on it"}};

std::string_view word_of(verdict_kind verdict) {
    return std::ranges::find(verdict_words, verdict, &verdict_word::kind)->word;
}

/// The paragraphs of a text that is embedded in the program, each joined to one line.
std::vector<std::string> paragraphs_of(std::string_view embedded_text) {
    std::vector<std::string> paragraphs;
    std::istringstream text{std::string(embedded_text)};
    bool new_paragraph = true;
    for (std::string line; std::getline(text, line);) {
        if (line.empty())
            new_paragraph = true;
        else if (std::exchange(new_paragraph, false))
            paragraphs.push_back(line);
        else
            paragraphs.back() += " " + line;
    }
    return paragraphs;
}

std::string paragraph(std::string_view kind, const std::string& markup) {
    return element("p", {{"class", kind}}, markup);
}

/// A sentence on the run: when and where, and how much was measured.
std::string run_text(const provenance& origin) {
    return fmt::format(
        "The run: {}, {} size, commit {}, {} ({}), {}. {} rows of {} scenes, each with up to {} seeds; per composition "
        "and seed up to {} repeats in all, over {} processes; the small atlas and the errors have rows of their own. "
        "Other machines, compilers and scenes may give other "
        "ratios: compare ratios, never times.",
        origin.date, origin.size, origin.commit, origin.compiler, origin.flags, origin.cpu, grouped(origin.rows),
        origin.scenes, origin.seeds, origin.repeats, origin.processes);
}

/// Adds the first page: what was claimed, what holds, and by how much.
void add_summary(page& out, const reproduction& reproduced, const provenance& origin) {
    out.add_html(paragraph("soft", element("a", {{"href", "#ratios"}}, "The ratios that decide") + " \u00b7 " +
                                       element("a", {{"href", "#contents"}}, "Contents") + " \u00b7 " +
                                       element("a", {{"href", "#terms"}}, "Terms")) +
                 "\n");
    const std::vector<std::string> about = paragraphs_of(embedded::about_md);
    out.paragraph(about.front());
    out.paragraph(reproduced.headline, "headline");
    for (const std::string& note : origin.notes) out.paragraph("Note: " + note + ".", "soft");
    out.add_html(summary_html(reproduced, origin.published));
    // README has the first of these tables.
    for (const table& t : {brief_table(reproduced), summary_table(reproduced, origin.published)})
        out.add_markdown(to_markdown(t) + "\n");
    out.paragraph(about.back(), "soft");
    if (!origin.agreement.empty()) out.paragraph(origin.agreement);
    out.paragraph(run_text(origin), "soft");
}

/// Adds the second page: every ratio that decides a claim.
void add_primaries(page& out, const reproduction& reproduced, const provenance& origin) {
    out.heading("The ratios that decide", "ratios");
    out.paragraph(
        "A ratio below 1 is for the claim. Some claims say only that something costs no more: for these, equal is for "
        "the claim, too. The 95 % interval is that of the ratio alone; outcomes are corrected for the number of ratios "
        "(Holm), which leaves more of them undecided.",
        "soft");
    out.add_html(primaries_html(reproduced.claims, origin.published));
    out.add_markdown(to_markdown(primaries_table(reproduced, origin.published)) + "\n");
    for (const figure& f : reproduced.figures)
        out.add_markdown("![" + f.caption + "](figures/" + f.name + ".svg)\n\n" + f.caption + "\n\n");
}

/// Adds the glossary.
void add_terms(page& out) {
    out.heading("Terms", "terms");
    std::string list;
    for (const std::string& entry : paragraphs_of(embedded::terms_md)) {
        const std::size_t colon = entry.find(": ");  // between a term and its meaning
        list += element("dt", {}, markup_text(entry.substr(0, colon))) +
                element("dd", {}, markup_text(entry.substr(colon + 2))) + "\n";
        out.add_markdown("- " + entry + "\n");
    }
    out.add_html(element("dl", {{"class", "terms"}}, list) + "\n");
    out.add_markdown("\n");
}

/// Adds a claim's section: its verdict in words, the ratios that decide it, figures, tables and configs.
void add_claim(page& out, const claim_result& c, const provenance& origin) {
    out.heading(c.id + ": " + c.claim, c.id);
    if (!c.quote.empty()) {
        out.add_html(element("blockquote", {}, markup_text(c.quote)) + "\n");
        out.add_markdown("> " + c.quote + "\n\n");
    }
    if (!c.regime.empty()) out.paragraph("Where: " + c.regime + ".", "soft");
    // The sentence begins with the brief one, on the primary ratios, if both are about the same clauses.
    const std::size_t split = c.sentence.starts_with(c.brief) ? c.brief.size() : c.sentence.size();
    const std::string verdict = c.sentence.substr(0, split);
    out.add_html(paragraph("verdict " + verdict_class(c.verdict),
                           element("span", {{"class", "word"}}, std::string(word_of(c.verdict)) + ".") + " " +
                               markup_text(verdict)) +
                 "\n");
    out.add_markdown("**" + text_of(c.verdict) + ".** " + verdict + "\n\n");
    if (const std::string sentence = published_sentence(c, origin.published); !sentence.empty())
        out.paragraph(sentence);
    out.paragraph("The ratio: " + c.measured + ".", "soft");
    out.add_html(primaries_html({&c, 1}, origin.published));
    if (split + 1 < c.sentence.size()) out.paragraph(c.sentence.substr(split + 1));
    if (c.evidence != c.sentence) out.paragraph(c.evidence, "soft");
    for (const figure& f : c.figures) out.add(f);
    // `judged` inserted the table of all ratios first. It is long, so it is folded and comes last.
    for (const named_table& t : c.tables)
        if (&t != c.tables.data()) out.add(t);
    if (!c.tables.empty()) out.folded("Every ratio", c.tables.front());
    for (const std::string& experiment : c.experiments)
        for (const provenance::config& config : origin.configs)
            if (config.experiment == experiment)
                out.folded("The config: " + experiment + ".toml", element("pre", {}, markup_text(config.text)));
}

/// Adds the section on the decision rule: a picture, the meaning of each verdict, rule.md and the null control.
void add_decision_rule(page& out, const reproduction& reproduced) {
    out.heading("How a verdict is reached", "rule");
    out.add_html(rule_picture() + "\n");
    std::string words;
    for (const auto& [kind, word, meaning] : verdict_words)
        words += element("dt", {{"class", verdict_class(kind)}}, element("span", {{"class", "word"}}, word)) +
                 element("dd", {}, meaning) + "\n";
    out.add_html(element("dl", {{"class", "words"}}, words) + "\n");
    out.add_markdown(to_markdown(rule_table()) + "\n");
    std::string text;
    for (const std::string& rule_paragraph : paragraphs_of(embedded::rule_md)) {
        text += paragraph("", markup_text(rule_paragraph)) + "\n";
        out.add_markdown(rule_paragraph + "\n\n");
    }
    out.folded("The rule in words", text);
    out.add_html(paragraph("", markup_text(reproduced.null_control.caption)));
    out.folded("Every ratio of the null control", reproduced.null_control);
}

/// Adds the section on choices that the paper leaves open: ours, and a claim's ratio under each alternative.
void add_open_choices(page& out, const reproduction& reproduced) {
    out.heading("What the paper leaves open", "open");
    std::string list;
    for (const open_choice& c : reproduced.choices) {
        list += element("dt", {}, markup_text(c.question)) +
                element("dd", {}, markup_text("Here: " + c.choice + ". Why: " + c.why + ".")) + "\n";
        if (c.alternatives.empty()) continue;
        std::string ratios = c.claim + " at " + c.where + ", under each choice: ";
        for (const open_choice::alternative& a : c.alternatives)
            ratios += (&a == c.alternatives.data() ? "" : "; ") + a.label + " " + ratio_text(a.measured) + " " +
                      text_of(a.measured.corrected);
        const std::string dependence = dependence_of(c);
        ratios += dependence == "yes"  ? ". Its outcome depends on the choice."
                  : dependence == "no" ? ". Its outcome does not depend on the choice."
                                       : ". Whether its outcome depends on the choice is undecided.";
        list += element("dd", {{"class", "soft"}}, markup_text(ratios)) + "\n";
    }
    out.add_html(element("dl", {}, list) + "\n");
    out.add_markdown(to_markdown(choice_table(reproduced)) + "\n");
}

}  // namespace

table rule_table() {
    table t = empty_table({"verdict", "when"});
    for (const auto& [kind, word, meaning] : verdict_words) t.rows.push_back({std::string(word), std::string(meaning)});
    return t;
}

/// Composes the report: two pages that summarise it, the contents, and the sections.
page report_of(const reproduction& reproduced, std::span<const report_section> sections, const provenance& origin,
               const std::vector<std::string>& failures) {
    page out("AABB Lab: the paper, reproduced", embedded::report_css);
    if (!reproduced.disturbance.empty()) out.paragraph(reproduced.disturbance, "wrong");
    for (const std::string& failure : failures) {
        out.add_html(paragraph("wrong", markup_text("Wrong: " + failure + ".")) + "\n");
        out.add_markdown("**Wrong:** " + failure + ".\n\n");
    }
    out.title("The paper, reproduced");
    add_summary(out, reproduced, origin);
    add_primaries(out, reproduced, origin);
    out.contents();
    add_terms(out);
    add_decision_rule(out, reproduced);
    out.heading("Under other bands of no difference", "bands");
    out.add(reproduced.bands);
    for (const claim_result& c : reproduced.claims) add_claim(out, c, origin);
    out.heading("Table 1: sizes of nodes", "table1");
    for (const named_table& t : reproduced.tables) out.add(t);
    add_open_choices(out, reproduced);
    for (const report_section& section : sections) {
        out.heading(section.title, section.id);
        for (const std::string& text : section.paragraphs) out.paragraph(text);
        for (const figure& f : section.figures) out.add(f);
        for (const named_table& t : section.tables) out.add(t);
    }
    out.heading("Provenance", "provenance");
    out.paragraph(
        "`./aabblab reproduce`, of the commit of the run, measured; a newer version may have judged. Beside this "
        "report, "
        "endpoints.csv has every ratio, and tables and figures have files of their own. tests/paper/recompute.py "
        "recomputes the verdicts from the rows, independently. Each experiment has a manifest: program, processor, "
        "system, config and files.");
    for (const provenance::config& config : origin.configs)
        out.folded(config.experiment + "/manifest.json", element("pre", {}, markup_text(config.manifest)));
    return out;
}

}  // namespace aabblab
