module;

#include "report_css.hpp"
#include "rule_md.hpp"

module aabblab.reproduction;

import aabblab.fmt;
import aabblab.markup;
import aabblab.numbers;
import aabblab.scale;
import aabblab.svg;

namespace aabblab {

namespace {

// The scale of the plots of all claims' ratios, logarithmic with 1 in the middle.
const scale claims_scale{0.2, 5, true};
constexpr double margin = 4;  // at both ends, in percent, for arrows

double x_percent(double ratio) {
    return margin + (100 - 2 * margin) * claims_scale.place(std::clamp(ratio, claims_scale.from, claims_scale.to));
}

/// Draws the band of no difference, with 1 in the middle.
void add_band(svg_picture& picture, double low, double centre, double high, double top, double bottom) {
    picture.rectangle("band", {low, top, high - low, bottom - top});
    picture.line("one", {centre, top}, {centre, bottom});
}

constexpr double first_row = 16;
constexpr double row_height = 12;

/// Draws the axis of ratios, with its numbers, at the vertical position y.
void add_axis(svg_picture& picture, double y) {
    picture.line("axis", {margin, y}, {100 - margin, y});
    for (const double ratio : {0.25, 0.5, 1., 2., 4.}) {
        picture.line("axis", {x_percent(ratio), y}, {x_percent(ratio), y + 3});
        picture.text("", {x_percent(ratio), y + 14}, short_number(ratio), {{"text-anchor", "middle"}});
    }
}

/// Draws a value beyond the scale as an arrow at the left or right end of the picture, with the number beside it.
/// Positions are in percent of the width (x) and in pixels (y), as everywhere in these pictures.
void add_arrow(svg_picture& picture, bool to_left, double y, double number) {
    const double back = to_left ? 8 : -8;  // pixels
    svg_picture head;
    head.path("", {{{back, -5}, {0, 0}, {back, 5}}}, /*closed=*/true);
    picture.put({to_left ? 1. : 99., y}, head);
    picture.text("", {to_left ? margin : 100 - margin, y - 4}, ratio_digits_of(number),
                 {{"text-anchor", to_left ? "start" : "end"}});
}

/// Draws a ratio as a disc on its 95 % interval. An arrow shows a limit beyond the scale, or the ratio, if beyond, too.
void add_interval(svg_picture& picture, const endpoint& e, double y) {
    const auto& [low, high] = e.range;
    const bool is_below = low < claims_scale.from;
    const bool is_above = high > claims_scale.to;
    picture.line("range", {is_below ? 2 : x_percent(low), y}, {is_above ? 98 : x_percent(high), y});
    if (claims_scale.from <= e.ratio && e.ratio <= claims_scale.to) picture.disc({x_percent(e.ratio), y}, 4);
    if (is_below) add_arrow(picture, /*to_left=*/true, y, e.ratio < claims_scale.from ? e.ratio : low);
    if (is_above) add_arrow(picture, /*to_left=*/false, y, e.ratio > claims_scale.to ? e.ratio : high);
}

/// A claim's ratios and intervals as SVG, one per row, on a logarithmic scale that is common to all claims.
std::string interval_picture(std::span<const endpoint> endpoints) {
    const double axis_y = first_row + row_height * static_cast<double>(endpoints.size());
    std::string label;
    svg_picture picture("%");
    add_band(picture, x_percent(1 / (1 + equivalence_band)), /*centre=*/50, x_percent(1 + equivalence_band), /*top=*/4,
             axis_y);
    add_axis(picture, axis_y);
    for (const endpoint& e : endpoints) {
        label += (label.empty() ? "ratio " : "; ") + ratio_text(e);
        add_interval(picture, e, first_row + row_height * static_cast<double>(&e - endpoints.data()));
    }
    return picture.in_page("interval", label, axis_y + 16);
}

/// An SVG picture of the rule by which ratios are judged: example intervals with their outcomes.
std::string rule_picture() {
    struct example {
        double low;
        double high;
        std::string_view outcome;
    };
    constexpr std::array<example, 5> examples{{{0.45, 0.62, "less"},
                                               {0.84, 0.98, "less"},
                                               {0.965, 1.035, "no difference"},
                                               {1.3, 1.8, "more"},
                                               {0.72, 1.35, "undecided"}}};
    // The left part of the picture has the scale, and the right part the words.
    constexpr double plot_width = 64;  // %
    const scale shown{.from = 0.4, .to = 2.5, .logarithmic = true};
    const auto x = [&](double ratio) { return plot_width * shown.place(ratio); };
    constexpr double row = 26;  // vertical measures, in pixels
    constexpr double first = 40;
    constexpr double end = first + row * examples.size() - 8;
    svg_picture picture("%");
    add_band(picture, x(1 / (1 + equivalence_band)), plot_width / 2, x(1 + equivalence_band), /*top=*/22, end);
    picture.text("", {plot_width / 2, 14}, "1", {{"text-anchor", "middle"}});
    picture.text("", {0, 14}, "\u2190 for the claim");
    picture.text("", {plot_width, 14}, "against \u2192", {{"text-anchor", "end"}});
    for (const example& e : examples) {
        const double y = first + row * static_cast<double>(&e - examples.data());
        picture.line("range", {x(e.low), y}, {x(e.high), y});
        picture.disc({x(std::sqrt(e.low * e.high)), y}, 5);
        picture.text("outcome", {plot_width + 3, y + 5}, e.outcome);
    }
    picture.text("", {plot_width / 2, end + 18}, fmt::format("band of \u00b1{:.0f} %", 100 * equivalence_band),
                 {{"text-anchor", "middle"}});
    return picture.in_page("rule", "an interval against the band of no difference", end + 26);
}

struct verdict_word {
    std::string_view kind;  ///< a class of the style
    std::string_view word;
    std::string_view meaning;
};

/// The words for a verdict, in the order of `verdict_kind`.
constexpr verdict_word verdict_words[] = {
    {"holds", "Holds", "every primary ratio favours the claim"},
    {"part", "Holds in part", "some primary ratios favour it and some do not; the text after the verdict says where"},
    {"same", "No difference", "every primary ratio shows no difference"},
    {"not", "Does not hold", "no primary ratio favours it, and at least one contradicts it"},
    {"open", "Undecided", "a primary ratio is undecided, and the verdict depends on it"}};

const verdict_word& word_of(verdict_kind verdict) {
    return verdict_words[static_cast<std::size_t>(verdict)];
}

/// The paragraphs of rule.md, which is embedded in the program, each joined to one line.
std::vector<std::string> rule_paragraphs() {
    std::vector<std::string> paragraphs;
    std::istringstream text{std::string(embedded::rule_md)};
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

std::string verdict_markup(const claim_result& c, const std::string& sentence) {
    return element("span", {{"class", "word"}}, std::string(word_of(c.verdict).word) + ".") + " " +
           markup_text(sentence);
}

/// Adds the overview: in HTML a row with a link per claim; in Markdown a table, a sentence per claim, and the figures.
void add_claim_rows(page& out, const reproduction& reproduced) {
    std::string rows = "\n";
    for (const claim_result& c : reproduced.claims) {
        const std::string text = paragraph("said", markup_text(c.claim)) + paragraph("", verdict_markup(c, c.brief));
        const std::string measured =
            c.primaries.empty() ? paragraph("ratio", "not measured")
                                : paragraph("ratio", ratio_text(c.primaries.front())) + interval_picture(c.primaries);
        rows += element("a", {{"class", "claim " + std::string(word_of(c.verdict).kind)}, {"href", "#" + c.id}},
                        element("b", {}, c.id) + element("div", {}, text) + element("div", {}, measured)) +
                "\n";
    }
    out.add_html(element("div", {{"class", "claims"}}, rows) + "\n" +
                 paragraph("soft",
                           "Each row gives the paper's claim, the verdict, the first primary ratio with its 95 % "
                           "interval, and a plot of all primary ratios. All plots share a scale. Ratios left of 1 "
                           "favour the claim; those in the shaded band make no difference.") +
                 "\n");
    out.add_markdown(to_markdown(brief_table(reproduced)) + "\n");
    for (const claim_result& c : reproduced.claims)
        out.add_markdown("- " + c.id + ", " + text_of(c.verdict) + ". " + c.sentence + "\n");
    out.add_markdown("\n");
    for (const figure& f : reproduced.figures)
        out.add_markdown("![" + f.caption + "](figures/" + f.name + ".svg)\n\n" + f.caption + "\n\n");
}

/// Adds the section on the decision rule: a picture, the meaning of each verdict, rule.md and the null control.
void add_decision_rule(page& out, const reproduction& reproduced) {
    out.heading("How a verdict is reached", "rule");
    out.add_html(rule_picture() + "\n");
    std::string words;
    for (const auto& [kind, word, meaning] : verdict_words)
        words += element("dt", {{"class", kind}}, element("span", {{"class", "word"}}, word)) +
                 element("dd", {}, meaning) + "\n";
    out.add_html(element("dl", {{"class", "words"}}, words) + "\n");
    out.add_markdown(to_markdown(rule_table()) + "\n");
    std::string text;
    for (const std::string& rule_paragraph : rule_paragraphs()) {
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

/// Composes the report; further sections come before provenance.
page report_of(const reproduction& reproduced, std::span<const report_section> sections, const provenance& origin,
               const std::vector<std::string>& failures) {
    page out("AABB Lab: the paper, reproduced", embedded::report_css);
    if (!reproduced.disturbance.empty()) out.paragraph(reproduced.disturbance, "wrong");
    for (const std::string& failure : failures) {
        out.add_html(paragraph("wrong", markup_text("Wrong: " + failure + ".")) + "\n");
        out.add_markdown("**Wrong:** " + failure + ".\n\n");
    }
    out.title("The paper, reproduced");
    std::string headline;
    for (const std::string& sentence : reproduced.headline) {
        headline += paragraph("", markup_text(sentence)) + "\n";
        out.add_markdown(sentence + "\n\n");
    }
    out.add_html(element("div", {{"class", "headline"}}, headline) + "\n");
    if (!origin.verdict_agreement.empty()) out.paragraph(origin.verdict_agreement);
    out.paragraph(
        fmt::format(
            "\"Research on Collision Detection Algorithm Based on AABB\": its table, its figures and {} claims. C13 "
            "was made for the method that the paper builds on (Li, Feng and Owen, \"SMB: collision detection based "
            "on temporal coherence\", 2006). Only the primary ratios of a claim, those before \"Secondary\" in its "
            "text, decide its verdict. Broad phase means the paper's global search, narrow phase its local detection; "
            "the scene brownian has drifting cubes. A displacement is how far a moving box moves per frame, in "
            "brownian at most. A mean spacing is the cube root of the world's volume per box. {}, {} size. Commit {}, "
            "{}, {}. {} rows of {} scenes, each with up to {} seeds; per composition and seed up to {} repeats in all, "
            "over {} processes.",
            reproduced.claims.size(), origin.date, origin.size, origin.commit, origin.compiler, origin.cpu,
            grouped(origin.rows), origin.scenes, origin.seeds, origin.repeats, origin.processes),
        "soft");
    for (const std::string& note : origin.notes) out.paragraph("Note: " + note + ".", "soft");
    add_claim_rows(out, reproduced);
    add_decision_rule(out, reproduced);
    out.heading("Under other bands of no difference", "bands");
    out.add(reproduced.bands);
    for (const claim_result& c : reproduced.claims) {
        out.heading(c.id + ": " + c.claim, c.id);
        out.add_html(paragraph("verdict " + std::string(word_of(c.verdict).kind), verdict_markup(c, c.sentence)) +
                     "\n");
        out.add_markdown("**" + text_of(c.verdict) + ".** " + c.sentence + "\n\n");
        if (c.evidence != c.sentence) out.paragraph(c.evidence);
        out.paragraph("The ratio: " + c.measured + ".", "soft");
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
    out.heading("Table 1: sizes of nodes", "table1");
    for (const named_table& t : reproduced.tables) out.add(t);
    add_open_choices(out, reproduced);
    for (const report_section& section : sections) {
        out.heading(section.title, section.id);
        for (const std::string& text : section.paragraphs) out.paragraph(text);
        for (const figure& f : section.figures) out.add(f);
        for (const named_table& t : section.tables) out.add(t);
    }
    out.add_html(element("h2", {{"id", "manifest"}}, "Provenance") + "\n");
    for (const provenance::config& config : origin.configs)
        out.folded(config.experiment + "/manifest.json", element("pre", {}, markup_text(config.manifest)));
    return out;
}

}  // namespace aabblab
