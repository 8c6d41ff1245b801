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
        case verdict_kind::holds_when: return "when";
        case verdict_kind::no_difference: return "same";
        case verdict_kind::does_not_hold: return "not";
        case verdict_kind::undecided: break;
    }
    return "undecided";
}

class page {
public:
    explicit page(std::filesystem::path folder) : folder_(std::move(folder)) {
        text_ = fmt::format(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
            "<link rel=\"icon\" href=\"data:,\">\n<title>AABB Lab: the paper, reproduced</title>\n"
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

void add_summary(page& out, const reproduction& all) {
    out.paragraph(
        "Each claim with its verdict and its primary ratio (95 % interval): below 1 favours the claim, whatever a "
        "condition in the verdict adds.",
        "soft");
    out.raw("<div class=\"claims\">\n");
    for (const claim_result& c : all.claims)
        out.raw(
            fmt::format("<a class=\"claim {}\" href=\"#{}\"><b>{}</b><span>{}</span><span class=\"verdict\">{}"
                        "</span><span class=\"number\">{}</span></a>\n",
                        class_of(c.verdict), c.id, c.id, html_text(c.claim), html_text(text_of(c)),
                        c.has_primary ? ratio_text(c.primary) : "-"));
    out.raw("</div>\n");
}

void add_rule(page& out, const reproduction& all) {
    out.heading("rule", "How a verdict comes about");
    for (const std::string& text : rule_paragraphs()) out.paragraph(text);
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
    out.raw("<h1>The paper, reproduced</h1>\n");
    out.paragraph(
        "\"Research on Collision Detection Algorithm Based on AABB\": its table, its figures and twelve claims, "
        "tested.");
    out.paragraph(
        fmt::format(
            "{}, {} size. Commit {}, {}, {}. {} rows of {} scenes; up to {} processes, {} seeds and {} repeats in all.",
            made.date, made.size, made.commit, made.compiler, made.cpu, made.rows, made.scenes, made.processes,
            made.seeds, made.repeats),
        "soft");
    for (const std::string& failure : failures) out.paragraph("Wrong: " + failure + ".", "wrong");
    for (const std::string& note : made.notes) out.paragraph("Note: " + note + ".", "soft");
    add_summary(out, all);
    for (const figure& f : all.figures) out.add(f);
    add_rule(out, all);
    for (const claim_result& c : all.claims) {
        out.heading(c.id, c.id + ": " + c.claim);
        out.raw(fmt::format("<p class=\"verdict\">Verdict: {}.</p>\n", html_text(text_of(c))));
        out.paragraph(c.because);
        out.paragraph("The ratio is that of " + c.measured + ".", "soft");
        for (const figure& f : c.figures) out.add(f);
        for (const named_table& t : c.tables)
            if (&t != c.tables.data()) out.add(t);
        out.folded("Every endpoint",
                   "<div class=\"wide\">" + (c.tables.empty() ? "" : to_html(c.tables.front().content)) + "</div>");
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
