module;
#include <fmt/format.h>

#include "report_css.hpp"

module aabblab.reproduction;

import aabblab.markup;

namespace aabblab {

namespace {

std::string_view class_of(verdict_kind verdict) {
    switch (verdict) {
        case verdict_kind::holds: return "holds";
        case verdict_kind::in_part: return "part";
        case verdict_kind::no_difference: return "same";
        case verdict_kind::does_not_hold: return "not";
        case verdict_kind::undecided: break;
    }
    return "open";
}

std::string capitalised(std::string text) {
    if (!text.empty() && 'a' <= text.front() && text.front() <= 'z') text.front() += 'A' - 'a';
    return text;
}

std::string paragraph(std::string_view kind, const std::string& markup) {
    return element("p", {{"class", kind}}, markup);
}

/// A verdict, and a sentence that says more.
std::string verdict_markup(const claim_result& c, const std::string& sentence) {
    return element("span", {{"class", "word"}}, markup_text(capitalised(text_of(c))) + ":") + " " +
           markup_text(sentence);
}

void add_claim_rows(page& out, const reproduction& all) {
    std::string rows = "\n";
    for (const claim_result& c : all.claims) {
        const std::string told = paragraph("said", markup_text(c.claim)) + paragraph("", verdict_markup(c, c.brief));
        const std::string measured = paragraph("ratio", c.has_primary ? ratio_text(c.primary) : "not measured") +
                                     (c.has_primary ? interval_picture(primaries_of(c)) : "");
        rows += element("a", {{"class", "claim " + std::string(class_of(c.verdict))}, {"href", "#" + c.id}},
                        element("b", {}, c.id) + element("div", {}, told) + element("div", {}, measured)) +
                "\n";
    }
    out.add_html(element("div", {{"class", "claims"}}, rows) + "\n" +
                 paragraph("soft",
                           "Each row: what the paper says, the verdict, the first primary ratio with its 95 % "
                           "interval, and all of them drawn, on one scale for all. Left of 1 favours the claim; the "
                           "shaded band makes no difference.") +
                 "\n");
    out.add_markdown(to_markdown(brief_table(all)) + "\n");
    for (const claim_result& c : all.claims)
        out.add_markdown("- " + c.id + ", " + text_of(c) + ": " + c.sentence + "\n");
    out.add_markdown("\n");
    for (const figure& f : all.figures)
        out.add_markdown("![" + f.caption + "](figures/" + f.name + ".svg)\n\n" + f.caption + "\n\n");
}

void add_rule(page& out, const reproduction& all) {
    out.heading("How a verdict comes about", "rule");
    out.add_html(rule_picture() + "\n");
    std::string words;
    for (const auto& [kind, word, meaning] : verdict_words())
        words += element("dt", {{"class", class_of(kind)}}, element("span", {{"class", "word"}}, word)) +
                 element("dd", {}, meaning) + "\n";
    out.add_html(element("dl", {{"class", "words"}}, words) + "\n");
    out.add_markdown(to_markdown(rule_table()) + "\n");
    std::string text;
    for (const std::string& one : rule_paragraphs()) {
        text += paragraph("", markup_text(one)) + "\n";
        out.add_markdown(one + "\n\n");
    }
    out.folded("The rule in words", text);
    out.add_html(paragraph("", markup_text(all.null_control.caption)));
    out.folded("Every ratio of the null control", all.null_control);
}

void add_choices(page& out, const reproduction& all) {
    out.heading("What the paper leaves open", "open");
    std::string list;
    for (const open_choice& c : all.choices) {
        list += element("dt", {}, markup_text(c.question)) +
                element("dd", {}, markup_text("Here: " + c.choice + ". Why: " + c.why + ".")) + "\n";
        if (c.alternatives.empty()) continue;
        std::string ratios = c.claim + " at " + c.where + ", under each choice: ";
        for (const open_choice::alternative& a : c.alternatives)
            ratios += (&a == c.alternatives.data() ? "" : "; ") + a.label + " " + ratio_text(a.measured) + " " +
                      text_of(a.measured.found);
        const std::string dependence = dependence_of(c);
        ratios += dependence == "yes"  ? ". Its outcome depends on the choice."
                  : dependence == "no" ? ". Its outcome is the same."
                                       : ". Whether its outcome is the same cannot be told.";
        list += element("dd", {{"class", "soft"}}, markup_text(ratios)) + "\n";
    }
    out.add_html(element("dl", {}, list) + "\n");
    out.add_markdown(to_markdown(choice_table(all)) + "\n");
}

std::string preformatted(const std::string& text) {
    return element("pre", {}, markup_text(text));
}

}  // namespace

page report_of(const reproduction& all, std::span<const report_section> sections, const provenance& made,
               const std::vector<std::string>& failures) {
    page out("AABB Lab: the paper, put to the test", embedded::report_css);
    if (!all.disturbance.empty()) out.paragraph(all.disturbance, "wrong");
    for (const std::string& failure : failures) {
        out.add_html(paragraph("wrong", markup_text("Wrong: " + failure + ".")) + "\n");
        out.add_markdown("**Wrong:** " + failure + ".\n\n");
    }
    out.title("The paper, put to the test");
    std::string headline;
    for (const std::string& sentence : all.headline) {
        headline += paragraph("", markup_text(sentence)) + "\n";
        out.add_markdown(sentence + "\n\n");
    }
    out.add_html(element("div", {{"class", "headline"}}, headline) + "\n");
    if (!made.agreement.empty()) out.paragraph(made.agreement);
    out.paragraph(
        fmt::format(
            "\"{}\": its table, its figures, its claims and one of the method that it follows (SMB, 2006): {} in all. "
            "{}, {} size. Commit {}, {}, {}. {} rows of {} "
            "scenes; up to {} processes, {} seeds and {} repeats in all.",
            paper_title, all.claims.size(), made.date, made.size, made.commit, made.compiler, made.cpu, made.rows,
            made.scenes, made.processes, made.seeds, made.repeats),
        "soft");
    for (const std::string& note : made.notes) out.paragraph("Note: " + note + ".", "soft");
    add_claim_rows(out, all);
    add_rule(out, all);
    out.heading("Under other bands of no difference", "bands");
    out.add(all.bands);
    for (const claim_result& c : all.claims) {
        out.heading(c.id + ": " + c.claim, c.id);
        out.add_html(paragraph("verdict " + std::string(class_of(c.verdict)), verdict_markup(c, c.sentence)) + "\n");
        out.add_markdown("**" + text_of(c) + ":** " + c.sentence + "\n\n");
        if (c.because != c.sentence) out.paragraph(c.because);
        out.paragraph("The ratio is that of " + c.measured + ".", "soft");
        for (const figure& f : c.figures) out.add(f);
        for (const named_table& t : c.tables)
            if (&t != c.tables.data()) out.add(t);
        if (!c.tables.empty()) out.folded("Every endpoint", c.tables.front());
        for (const std::string& experiment : c.experiments)
            for (const provenance::config& config : made.configs)
                if (config.experiment == experiment)
                    out.folded("The config that made it: " + experiment + ".toml", preformatted(config.text));
    }
    out.heading("Table 1: what nodes take", "table1");
    for (const named_table& t : all.tables) out.add(t);
    add_choices(out, all);
    for (const report_section& section : sections) {
        out.heading(section.title, section.id);
        for (const std::string& text : section.paragraphs) out.paragraph(text);
        for (const figure& f : section.figures) out.add(f);
        for (const named_table& t : section.tables) out.add(t);
    }
    out.add_html(element("h2", {{"id", "manifest"}}, "What made it") + "\n");
    for (const provenance::config& config : made.configs)
        out.folded(config.experiment + "/manifest.json", preformatted(config.manifest));
    return out;
}

}  // namespace aabblab
