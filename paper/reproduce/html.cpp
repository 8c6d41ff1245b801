module;
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report_css.hpp"

module aabblab.reproduction;

import aabblab.claims;
import aabblab.figures;
import aabblab.files;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

/// What a script would be needed for: a picture in the page itself, as its own address.
std::string address_of(const std::string& svg) {
    std::string address = "data:image/svg+xml,";
    for (const char c : svg) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code >= 0x7f || std::string_view("\"'#%<>&").find(c) != std::string_view::npos)
            address += fmt::format("%{:02X}", code);
        else
            address += c;
    }
    return address;
}

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

class page {
public:
    explicit page(std::filesystem::path folder) : folder_(std::move(folder)) {
        text_ = fmt::format(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
            "<link rel=\"icon\" href=\"data:,\">\n<title>AABB Lab: the paper, put to the test</title>\n"
            "<style>\n{}</style></head><body>\n",
            embedded::report_css);
    }

    void heading(const std::string& id, const std::string& text) {
        text_ += "<h2 id=\"" + id + "\">" + html_text(text) + "</h2>\n";
    }
    void paragraph(const std::string& text, std::string_view kind = "") {
        text_ += kind.empty() ? "<p>" : fmt::format("<p class=\"{}\">", kind);
        text_ += html_text(text) + "</p>\n";
    }
    void raw(const std::string& html) { text_ += html; }
    void add(const named_table& t) {
        paragraph(t.caption);
        text_ += "<div class=\"wide\">" + to_html(t.content) + "</div>\n";
    }
    void folded(const std::string& title, const std::string& html) {
        text_ += "<details><summary>" + html_text(title) + "</summary>" + html + "</details>\n";
    }
    void add(const figure& f) {
        text_ += "<figure><img alt=\"" + html_text(f.caption) + "\" src=\"" +
                 address_of(bytes_of_file(folder_ / "figures" / (f.name + ".svg"))) + "\"><figcaption>" +
                 html_text(f.caption) + "</figcaption></figure>\n";
    }
    [[nodiscard]] std::string finished() const { return text_ + "</body></html>\n"; }

private:
    std::filesystem::path folder_;
    std::string text_;
};

void add_claim_rows(page& out, const reproduction& all) {
    out.raw("<div class=\"claims\">\n");
    for (const claim_result& c : all.claims) {
        out.raw(
            fmt::format("<a class=\"claim {}\" href=\"#{}\"><b>{}</b><div><p class=\"said\">{}</p><p><span "
                        "class=\"word\">{}:</span> "
                        "{}</p></div><div>",
                        class_of(c.verdict), c.id, c.id, html_text(c.claim), html_text(capitalised(text_of(c))),
                        html_text(c.brief)));
        if (c.has_primary)
            out.raw(
                fmt::format("<p class=\"ratio\">{}</p>{}", ratio_text(c.primary), interval_picture(primaries_of(c))));
        else
            out.raw("<p class=\"ratio\">not measured</p>");
        out.raw("</div></a>\n");
    }
    out.raw("</div>\n");
    out.paragraph(
        "Each row: what the paper says, the verdict, the first primary ratio with its 95 % interval, and all of them "
        "drawn, on one scale for all. Left of 1 favours the claim; the shaded band makes no difference.",
        "soft");
}

void add_rule(page& out, const reproduction& all) {
    out.heading("rule", "How a verdict comes about");
    out.raw(rule_picture() + "\n");
    out.raw("<dl class=\"words\">\n");
    for (const auto& [kind, word, meaning] : verdict_words())
        out.raw(fmt::format("<dt class=\"{}\"><span class=\"word\">{}</span></dt><dd>{}</dd>\n", class_of(kind), word,
                            meaning));
    out.raw("</dl>\n");
    std::string text;
    for (const std::string& paragraph : rule_paragraphs()) text += "<p>" + html_text(paragraph) + "</p>\n";
    out.folded("The rule in words", text);
    out.paragraph(all.null_control.caption);
    out.folded("Every ratio of the null control",
               "<div class=\"wide\">" + to_html(all.null_control.content) + "</div>");
}

void add_choices(page& out, const reproduction& all) {
    out.heading("open", "What the paper leaves open");
    out.raw("<dl>\n");
    for (const open_choice& c : all.choices) {
        out.raw("<dt>" + html_text(c.question) + "</dt><dd>" +
                html_text("Here: " + c.choice + ". Why: " + c.why + ".") + "</dd>\n");
        if (c.alternatives.empty()) continue;
        std::string ratios = c.claim + " at " + c.where + ", under each choice: ";
        for (const open_choice::alternative& a : c.alternatives)
            ratios += (&a == c.alternatives.data() ? "" : "; ") + a.label + " " + ratio_text(a.measured) + " " +
                      text_of(a.measured.found);
        const std::string dependence = dependence_of(c);
        ratios += dependence == "yes"  ? ". Its outcome depends on the choice."
                  : dependence == "no" ? ". Its outcome is the same."
                                       : ". Whether its outcome is the same cannot be told.";
        out.raw("<dd class=\"soft\">" + html_text(ratios) + "</dd>\n");
    }
    out.raw("</dl>\n");
}

}  // namespace

std::string html_of(const std::filesystem::path& folder, const reproduction& all,
                    std::span<const report_section> sections, const provenance& made,
                    const std::vector<std::string>& failures) {
    page out(folder);
    if (!all.disturbance.empty()) out.paragraph(all.disturbance, "wrong");
    for (const std::string& failure : failures) out.paragraph("Wrong: " + failure + ".", "wrong");
    out.raw("<h1>The paper, put to the test</h1>\n<div class=\"headline\">\n");
    for (const std::string& sentence : all.headline) out.paragraph(sentence);
    out.raw("</div>\n");
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
    out.heading("bands", "Under other bands of no difference");
    out.add(all.bands);
    for (const claim_result& c : all.claims) {
        out.heading(c.id, c.id + ": " + c.claim);
        out.raw(fmt::format("<p class=\"verdict {}\"><span class=\"word\">{}:</span> {}</p>\n", class_of(c.verdict),
                            html_text(capitalised(text_of(c))), html_text(c.sentence)));
        if (c.because != c.sentence) out.paragraph(c.because);
        out.paragraph("The ratio is that of " + c.measured + ".", "soft");
        for (const figure& f : c.figures) out.add(f);
        for (const named_table& t : c.tables)
            if (&t != c.tables.data()) out.add(t);
        if (!c.tables.empty())
            out.folded("Every endpoint", "<div class=\"wide\">" + to_html(c.tables.front().content) + "</div>");
        for (const std::string& experiment : c.experiments)
            for (const provenance::config& config : made.configs)
                if (config.experiment == experiment)
                    out.folded("The config that made it: " + experiment + ".toml",
                               "<pre>" + html_text(config.text) + "</pre>");
    }
    out.heading("table1", "Table 1: what nodes take");
    for (const named_table& t : all.tables) out.add(t);
    add_choices(out, all);
    for (const report_section& section : sections) {
        out.heading(section.id, section.title);
        for (const std::string& text : section.paragraphs) out.paragraph(text);
        for (const figure& f : section.figures) out.add(f);
        for (const named_table& t : section.tables) out.add(t);
    }
    out.heading("manifest", "What made it");
    for (const provenance::config& config : made.configs)
        out.folded(config.experiment + "/manifest.json", "<pre>" + html_text(config.manifest) + "</pre>");
    return out.finished();
}

}  // namespace aabblab
