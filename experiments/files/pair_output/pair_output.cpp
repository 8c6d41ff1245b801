module;
#include <boost/sort/spreadsort/integer_sort.hpp>

module aabblab.pair_output;

import aabblab.fmt;

namespace aabblab {

namespace {

constexpr auto objects_of = [](const auto& row) { return std::uint64_t{row.a} << 32U | row.b; };
constexpr auto triangles_of = [](const aabb::contact& c) { return std::uint64_t{c.triangle_a} << 32U | c.triangle_b; };

void sort_by(auto rows, auto key_of) {
    boost::sort::spreadsort::integer_sort(
        rows.begin(), rows.end(), [key_of](const auto& row, unsigned bits) { return key_of(row) >> bits; },
        [key_of](const auto& p, const auto& q) { return key_of(p) < key_of(q); });
}

/// Cells of CSV as those of JSON: words in quotes, null for empty ones.
std::string quoted_cells(std::string_view cells) {
    std::string text;
    while (!cells.empty()) {
        const std::string_view cell = cells.substr(0, cells.find(','));
        const bool is_last = cell.size() == cells.size();
        const bool is_number =
            !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell.front())) || cell.front() == '-');
        text += is_number ? std::string(cell) : cell.empty() ? "null" : '"' + std::string(cell) + '"';
        cells.remove_prefix(is_last ? cell.size() : cell.size() + 1);
        if (!is_last) text += cells.empty() ? ",null" : ",";
    }
    return text;
}

void append(std::string& text, char before, const aabb::vec3d& p) {
    for (const double x : p.at) text += before + aabb::shortest(x);
}

}  // namespace

void sort_rows(std::span<aabb::index_pair> pairs) {
    sort_by(pairs, objects_of);
}

/// Sorts contacts by objects, by a radix sort of keys of 64 bits, then those of each pair by triangles.
void sort_rows(std::span<aabb::contact> contacts) {
    sort_by(contacts, objects_of);
    for (auto first = contacts.begin(); first != contacts.end();) {
        const auto is_of_others = [&](const aabb::contact& c) { return objects_of(c) != objects_of(*first); };
        const auto last = std::find_if(first, contacts.end(), is_of_others);
        sort_by(std::span(first, last), triangles_of);
        first = last;
    }
}

std::string to_text(const aabb::triangle_intersection& common) {
    std::string text = std::string(name_of(common.kind)) + ' ' + std::to_string(common.size);
    for (std::uint32_t i = 0; i < common.size; ++i) append(text, ' ', common.corners[i]);
    append(text, ' ', common.error);
    return text;
}

/// The intersection of two triangles as cells of a CSV row: kind, corners, error per axis, coordinates of six corners.
std::string to_cells(const aabb::triangle_intersection& common) {
    std::string cells = std::string(name_of(common.kind)) + ',' + std::to_string(common.size);
    append(cells, ',', common.error);
    for (std::uint32_t i = 0; i < common.corners.size(); ++i) {
        if (i < common.size)
            append(cells, ',', common.corners[i]);
        else
            cells += ",,,";
    }
    return cells;
}

void require_each_once(std::span<const aabb::index_pair> pairs, std::string_view where) {
    if (const auto duplicate = std::ranges::adjacent_find(pairs); duplicate != pairs.end())
        throw defect(fmt::format("{}: the pair {},{} was reported more than once", where, duplicate->a, duplicate->b));
}

void require_each_once(std::span<const aabb::contact> contacts, std::string_view where) {
    if (const auto duplicate = std::ranges::adjacent_find(contacts); duplicate != contacts.end())
        throw defect(fmt::format("{}: the contact {},{},{},{} was reported more than once", where, duplicate->a,
                                 duplicate->b, duplicate->triangle_a, duplicate->triangle_b));
}

number_table::number_table(const std::filesystem::path& file, std::string_view header)
    : file_(file),
      format_(file.extension() == ".npy"    ? format::npy
              : file.extension() == ".json" ? format::json
                                            : format::csv),
      columns_(static_cast<std::size_t>(std::ranges::count(header, ',')) + 1) {
    if (format_ == format::npy && header.find("error") != std::string_view::npos)
        throw aabb::input_error(file.string() +
                                ": an .npy file has integers only, and these rows need a file of CSV or .json");
    text_ = format_ == format::npy   ? array_header()
            : format_ == format::csv ? std::string(header) + "\n"
                                     : "{\"columns\":[" + quoted_cells(header) + "],\n\"rows\":[";
}

/// The header of the array; the number of its rows is known at the end.
std::string number_table::array_header() const {
    return npy_header("<u4", std::array{rows_, columns_});
}

void number_table::add(std::initializer_list<std::uint32_t> row, std::string_view further) {
    switch (format_) {
        case format::csv:
            fmt::format_to(std::back_inserter(text_), "{}{}{}\n", fmt::join(row, ","), further.empty() ? "" : ",",
                           further);
            break;
        case format::npy:
            text_.append(reinterpret_cast<const char*>(row.begin()), row.size() * sizeof *row.begin());
            break;
        case format::json:
            fmt::format_to(std::back_inserter(text_), "{}\n[{}{}{}]", rows_ == 0 ? "" : ",", fmt::join(row, ","),
                           further.empty() ? "" : ",", quoted_cells(further));
            break;
    }
    ++rows_;
    if (text_.size() < 1U << 16U) return;
    file_.write(text_);
    text_.clear();
}

void number_table::commit() {
    if (format_ == format::json) text_ += "\n]}\n";
    file_.write(text_);
    if (format_ == format::npy) {
        const std::string header = array_header();
        file_.overwrite(0, header.data(), header.size());
    }
    file_.commit();
}

}  // namespace aabblab
