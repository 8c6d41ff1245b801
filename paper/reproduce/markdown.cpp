module;
#include <span>
#include <string>
#include <vector>

module aabblab.reproduction;

import aabblab.claims;
import aabblab.figures;
import aabblab.tables;

namespace aabblab {

std::string markdown_of(const reproduction& all, std::span<const report_section> sections, const provenance& made,
                        const std::vector<std::string>& failures) {
    std::string text = "# The paper, put to the test\n\n";
    if (!all.disturbance.empty()) text += "**" + all.disturbance + "**\n\n";
    for (const std::string& failure : failures) text += "**Wrong:** " + failure + ".\n\n";
    for (const std::string& sentence : all.headline)
        text += sentence + (&sentence == &all.headline.back() ? "\n\n" : " ");
    if (!made.agreement.empty()) text += made.agreement + "\n\n";
    text += "\"" + std::string(paper_title) + "\", tested: " + made.date + ", commit " + made.commit + ", " +
            made.compiler + ", " + made.cpu + "; " + made.size + " size, " + std::to_string(made.rows) +
            " rows, up to " + std::to_string(made.processes) + " processes, up to " + std::to_string(made.seeds) +
            " seeds.\n\n";
    for (const std::string& note : made.notes) text += "Note: " + note + ".\n\n";
    text += to_markdown(brief_table(all)) + "\n";
    for (const claim_result& c : all.claims) text += "- " + c.id + ", " + text_of(c) + ": " + c.sentence + "\n";
    text += "\n";
    const auto add_table = [&](const named_table& t) { text += t.caption + "\n\n" + to_markdown(t.content) + "\n"; };
    const auto add_figure = [&](const figure& f) {
        text += "![" + f.caption + "](figures/" + f.name + ".svg)\n\n" + f.caption + "\n\n";
    };
    for (const figure& f : all.figures) add_figure(f);
    add_table(all.bands);
    for (const claim_result& c : all.claims) {
        text += "## " + c.id + ": " + c.claim + "\n\n**" + text_of(c) + ":** " + c.sentence + "\n\n";
        if (c.because != c.sentence) text += c.because + "\n\n";
        for (const figure& f : c.figures) add_figure(f);
        for (const named_table& t : c.tables) add_table(t);
    }
    text += "## How a verdict comes about\n\n" + to_markdown(rule_table()) + "\n";
    for (const std::string& paragraph : rule_paragraphs()) text += paragraph + "\n\n";
    add_table(all.null_control);
    text += "## Table 1\n\n";
    for (const named_table& t : all.tables) add_table(t);
    text += "## What the paper leaves open\n\n" + to_markdown(choice_table(all));
    for (const report_section& section : sections) {
        text += "\n## " + section.title + "\n\n";
        for (const std::string& paragraph : section.paragraphs) text += paragraph + "\n\n";
        for (const figure& f : section.figures) add_figure(f);
        for (const named_table& t : section.tables) add_table(t);
    }
    return text;
}

}  // namespace aabblab
