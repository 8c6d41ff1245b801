module aabblab.stiff;

import aabblab.files;
import aabblab.numbers;
import aabblab.results;

namespace aabblab {

namespace {

/// A column of floating-point numbers with fifteen digits.
template <class Number>
struct any_number {
    Number& value;
};
template <class Number>
std::string field_text(const any_number<Number>& number) {
    return fifteen_digits(number.value);
}
bool parse_field(const any_number<double>& to, const std::string& text) {
    const char* const end = text.data() + text.size();
    return std::from_chars(text.data(), end, to.value) == std::from_chars_result{end, std::errc{}};
}

constexpr auto columns_of_row = [](auto& r, auto field) {
    field("subject", r.subject);
    field("quantity", r.quantity);
    field("measured", any_number(r.measured));
    field("expected", r.rule);
    field("verdict", one_of_words(r.verdict, stiff_verdict_words));
};

constexpr auto columns_of_point = [](auto& p, auto field) {
    field("figure", p.figure);
    field("line", p.line);
    field("x", any_number(p.x));
    field("y", any_number(p.y));
    field("label", p.label);
};
constexpr std::array<std::string_view, 1> later_columns_of_point = {"label"};

constexpr auto columns_of_effect = [](auto& e, auto field) {
    field("study", e.study);
    field("method", e.method);
    field("rules", e.rules);
    field("turned", e.turned);
    field("change", any_number(e.change));
};
constexpr auto file_of_effects = "methods.csv";

std::filesystem::path file_of(const std::filesystem::path& folder, const stiff_study& study, const char* ending) {
    return folder / (std::string(study.name) + ending);
}

}  // namespace

/// The figures of a study with the points of its result: each point names its figure and the label of its line, which
/// is added if the figure lacks it. Figures without points are left out.
std::vector<figure> figures_of(const stiff_study& study, const stiff_result& result) {
    std::vector<figure> figures = study.figures;
    for (figure& f : figures)
        for (const stiff_point& p : result.points) {
            if (p.figure != f.name) continue;
            auto line = std::ranges::find(f.lines, p.line, &series::label);
            if (line == f.lines.end()) line = f.lines.insert(line, {p.line});
            line->points.push_back({.x = p.x, .y = p.y, .label = p.label});
        }
    std::erase_if(figures, [](const figure& f) {
        return std::ranges::all_of(f.lines, [](const series& line) { return line.points.empty(); });
    });
    return figures;
}

void write_result(const std::filesystem::path& folder, const stiff_study& study, const stiff_result& result) {
    write_file(file_of(folder, study, ".csv"), csv_of(std::span<const stiff_row>(result.rows), columns_of_row));
    write_file(file_of(folder, study, "_points.csv"),
               csv_of(std::span<const stiff_point>(result.points), columns_of_point));
}

std::optional<stiff_result> read_result(const std::filesystem::path& folder, const stiff_study& study) {
    const auto rows = file_of(folder, study, ".csv"), points = file_of(folder, study, "_points.csv");
    // Earlier versions wrote only the rows.
    if (!std::filesystem::exists(rows) || !std::filesystem::exists(points)) return std::nullopt;
    return stiff_result{rows_of_file<stiff_row>(rows, columns_of_row),
                        rows_of_file<stiff_point>(points, columns_of_point, later_columns_of_point)};
}

void write_effects(const std::filesystem::path& folder, std::span<const method_effect> effects) {
    write_file(folder / file_of_effects, csv_of(effects, columns_of_effect));
}

std::vector<method_effect> read_effects(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / file_of_effects)) return {};
    return rows_of_file<method_effect>(folder / file_of_effects, columns_of_effect);
}

}  // namespace aabblab
