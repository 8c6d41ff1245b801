module;
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

module aabblab.report;

import aabb;
import aabblab.files;
import aabblab.results;

namespace aabblab {

namespace {

void write_file(const std::filesystem::path& file, const std::string& text) {
    output_file out(file);
    out.write(text);
    out.commit();
}

std::string html_text(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

/// The same report twice: as Markdown with links, and as one page that needs no other file.
class document {
public:
    explicit document(std::filesystem::path folder) : folder_(std::move(folder)) {
        std::filesystem::create_directories(folder_ / "tables");
        html_ =
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>AABB Lab: report</title>\n"
            "<style>body{font-family:sans-serif;max-width:70em;margin:2em auto;padding:0 1em}table{border-collapse:"
            "collapse}th,td{padding:.2em .7em;border-bottom:1px solid #ccc;text-align:left}.number{text-align:right;"
            "font-variant-numeric:tabular-nums}svg{max-width:100%;height:auto}</style></head><body>\n";
    }

    void heading(std::size_t level, const std::string& text) {
        markdown_ += std::string(level, '#') + " " + text + "\n\n";
        const std::string tag = "h" + std::to_string(level) + ">";
        html_ += "<" + tag + html_text(text) + "</" + tag + "\n";
    }

    void paragraph(const std::string& text) {
        markdown_ += text + "\n\n";
        html_ += "<p>" + html_text(text) + "</p>\n";
    }

    void preformatted(const std::string& text) {
        markdown_ += "```text\n" + text + "```\n\n";
        html_ += "<pre>" + html_text(text) + "</pre>\n";
    }

    /// @param name of the files, without folder and ending
    void add(const std::string& name, const table& shown, const table& plain) {
        write_file(folder_ / "tables" / (name + ".csv"), to_csv(plain));
        write_file(folder_ / "tables" / (name + ".md"), to_markdown(shown));
        write_file(folder_ / "tables" / (name + ".tex"), to_tex(shown));
        markdown_ += to_markdown(shown) + "\n";
        html_ += to_html(shown);
    }

    void figure(const std::string& name, const std::string& svg) {
        if (svg.empty()) return;
        write_file(folder_ / "tables" / (name + ".svg"), svg);
        markdown_ += "![time of each composition](tables/" + name + ".svg)\n\n";
        html_ += svg;
    }

    void write() {
        write_file(folder_ / "report.md", markdown_);
        write_file(folder_ / "report.html", html_ + "</body></html>\n");
    }

private:
    std::filesystem::path folder_;
    std::string markdown_;
    std::string html_;
};

table table_of(std::span<const difference> differences) {
    table t{{{"scene", false}, {"composition or engine", false}, {"what", false}, {"class", false}, {"count"}}, {}};
    for (const difference& d : differences) {
        std::string who = d.name.engine;
        if (who.empty())
            who = d.name.sort + " + " + d.name.partition + " + " + d.name.sweep + " + " + d.name.split_large;
        if (d.name.engine.empty() && !d.name.tree.empty()) who += " + " + d.name.tree + " + " + d.name.triangle;
        t.rows.push_back({d.scene + " " + d.scene_parameters, who, d.what, d.kind, std::to_string(d.count)});
    }
    return t;
}

void add_part(document& out, const report_part& part) {
    const manifest_summary manifest = read_manifest(part.results);
    const std::vector<row> rows = read_rows(part.results / "results.csv");
    const std::string name = rows.empty() ? part.results.filename().string() : rows[0].experiment;
    out.heading(2, name);
    for (const std::string& note : manifest.notes) out.paragraph("Note: " + note + ".");
    for (const std::string& failure : part.failures) out.paragraph("Failed: " + failure + ".");
    std::size_t number = 0;
    for (const scene_summary& scene : summarise(rows)) {
        const std::string file = name + "-" + std::to_string(++number) + "-" + scene.scene;
        out.heading(3, scene.scene + " " + std::to_string(number));
        out.preformatted(heading_of(scene));
        out.add(file, table_of(scene, number_style::grouped), table_of(scene, number_style::plain));
        out.figure(file, figure_of(scene));
        if (const table counts = counts_table_of(scene, number_style::grouped); !counts.columns.empty()) {
            out.paragraph("Work a frame, after the first one, and bytes of the parts:");
            out.add(file + "-counts", counts, counts_table_of(scene, number_style::plain));
        }
    }
    const std::filesystem::path differences_file = part.results / "differences.csv";
    if (!std::filesystem::exists(differences_file)) return;
    const std::vector<difference> differences = read_differences(differences_file);
    if (differences.empty()) return;
    out.heading(3, "Differences from the exact answer, by class");
    const table t = table_of(differences);
    out.add(name + "-differences", t, t);
}

}  // namespace

void write_report(const std::filesystem::path& folder, std::span<const report_part> parts) {
    document out(folder);
    out.heading(1, "AABB Lab: report");
    std::size_t failures = 0;
    std::set<std::string> exact;
    for (const report_part& part : parts) {
        failures += part.failures.size();
        for (const row& r : read_rows(part.results / "results.csv"))
            if (r.status == "exact")
                exact.insert(r.scene + r.scene_parameters + r.name.engine + r.name.sort + r.name.partition +
                             r.name.sweep + r.name.tree + r.name.triangle);
    }
    if (!parts.empty()) {
        const manifest_summary made = read_manifest(parts[0].results);
        out.paragraph("Made " + made.date + " from commit " + made.commit + " with " + made.compiler + " on " +
                      made.cpu + ".");
    }
    out.paragraph(failures == 0 ? "Validated before it was timed: " + std::to_string(exact.size()) +
                                      " times a composition or engine played a scene and gave exactly the pairs of the "
                                      "reference, frame by frame; no composition that must be exact was wrong."
                                : std::to_string(failures) + " compositions were wrong; they have no times.");
    out.paragraph(
        "Times are medians over interleaved repeats in one process; compare them within a table only. The "
        "ratio is the median, over the repeats, of the time to the first line's in the same repeat; \"95 %\" holds it "
        "with that confidence (the whole range where there are fewer than six repeats). \"build\" is the time to "
        "make the stages and trees, in ms.");
    for (const report_part& part : parts) add_part(out, part);
    out.write();
}

}  // namespace aabblab
