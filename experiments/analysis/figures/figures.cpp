module aabblab.figures;

import aabb.base;
import aabblab.files;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.results;
import :drawing;
import :sheet;

namespace aabblab {

namespace {

[[nodiscard]] std::string name_at(const figure_axis& axis, double position) {
    for (const auto& [at, name] : axis.names)
        if (at == position) return one_line(name);
    return {};
}

}  // namespace

/// The points of a figure as CSV, for other programs; columns for panels, names, intervals of x and labels only if the
/// figure has them.
std::string csv_of(const figure& f) {
    const std::vector<numbered_series> all_series = numbered_series_of(f);
    const auto has_point = [&](const auto& matches) {
        return std::ranges::any_of(
            all_series, [&](const numbered_series& s) { return std::ranges::any_of(points_of(*s.source), matches); });
    };
    const bool has_x_intervals = has_point([](const figure_point& p) { return p.x_low < p.x_high; });
    const bool has_labels = has_point([](const figure_point& p) { return !p.label.empty(); });
    std::vector<std::string> header{"number", "x", "y", "low", "high", "series"};
    if (!f.panels.empty()) header.emplace_back("panel");
    if (!f.x.names.empty()) header.emplace_back("x_name");
    if (!f.y.names.empty()) header.emplace_back("y_name");
    if (has_x_intervals) header.insert(header.end(), {"x_low", "x_high"});
    if (has_labels) header.emplace_back("label");
    std::string text = csv_line(header);
    for (const numbered_series& s : all_series)
        for (const figure_point& p : points_of(*s.source)) {
            const bool level = s.source->style == series_style::level;  // a horizontal line, so without x
            std::vector<std::string> fields{fmt::format("{}", s.number), level ? "" : fifteen_digits(p.x)};
            for (const double value : {p.y, p.low, p.high}) fields.push_back(fifteen_digits(value));
            fields.push_back(one_line(s.source->label));
            if (!f.panels.empty()) fields.push_back(s.panel == nullptr ? "" : one_line(s.panel->title));
            if (!f.x.names.empty()) fields.push_back(level ? "" : name_at(f.x, p.x));
            if (!f.y.names.empty()) fields.push_back(name_at(f.y, p.y));
            if (has_x_intervals)
                for (const double value : {p.x_low, p.x_high}) fields.push_back(level ? "" : fifteen_digits(value));
            if (has_labels) fields.push_back(one_line(p.label));
            text += csv_line(fields);
        }
    return text;
}

std::string svg_of(const figure& f) {
    return svg_of(sheet_of(f));
}

std::string pdf_of(const figure& f) {
    return pdf_of(sheet_of(f));
}

/// Writes each figure into the folder as NAME.csv (its points), NAME.svg and NAME.pdf.
void draw(const std::filesystem::path& folder, std::span<const figure> figures) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error(folder.string() + ": cannot be made: " + error.message());
    for (const figure& f : figures) {
        const sheet drawn = sheet_of(f);
        write_file(folder / (f.name + ".csv"), csv_of(f));
        write_file(folder / (f.name + ".svg"), svg_of(drawn));
        write_file(folder / (f.name + ".pdf"), pdf_of(drawn));
    }
}

}  // namespace aabblab
