module;
#include <fmt/format.h>

module aabblab.figures;

import aabblab.digits;
import aabblab.results;
import aabblab.text;
import :drawing;

namespace aabblab {

namespace {

[[nodiscard]] std::string name_at(const figure_axis& axis, double place) {
    for (const auto& [at, name] : axis.names)
        if (at == place) return one_line(name);
    return {};
}

}  // namespace

std::string csv_of(const figure& f) {
    std::vector<std::string> header{"number", "x", "y", "low", "high", "series"};
    if (!f.panels.empty()) header.emplace_back("panel");
    if (!f.x.names.empty()) header.emplace_back("x_name");
    if (!f.y.names.empty()) header.emplace_back("y_name");
    std::string text = csv_line(header);
    for (const numbered_series& s : numbered(f))
        for (const figure_point& p : points_of(*s.source)) {
            const bool level = s.source->style == series_style::level;
            std::vector<std::string> fields{fmt::format("{}", s.number), level ? "" : fifteen_digits(p.x)};
            for (const double value : {p.y, p.low, p.high}) fields.push_back(fifteen_digits(value));
            fields.push_back(one_line(s.source->label));
            if (!f.panels.empty()) fields.push_back(s.panel == nullptr ? "" : one_line(s.panel->title));
            if (!f.x.names.empty()) fields.push_back(level ? "" : name_at(f.x, p.x));
            if (!f.y.names.empty()) fields.push_back(name_at(f.y, p.y));
            text += csv_line(fields);
        }
    return text;
}

}  // namespace aabblab
