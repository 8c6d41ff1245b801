module aabblab.pair_output;

import aabblab.fmt;

namespace aabblab {

namespace {

std::array<std::uint32_t, 2> words_of(const aabb::index_pair& pair) {
    return {pair.a, pair.b};
}

std::array<std::uint32_t, 4> words_of(const aabb::contact& c) {
    return {c.a, c.b, c.triangle_a, c.triangle_b};
}

/// A radix digit: consecutive bits of one word of a row.
struct digit {
    static constexpr std::size_t most_bits = 8;
    static constexpr std::size_t values = std::size_t{1} << most_bits;

    std::size_t word;
    std::size_t shift;
    std::uint32_t mask;

    [[nodiscard]] std::size_t value_in(const auto& row) const { return words_of(row)[word] >> shift & mask; }
};

/// The digits that cover all bits in which the rows differ, most significant first; sorting by others would be in vain.
template <class Row>
std::vector<digit> digits_of(std::span<const Row> rows) {
    const auto first = words_of(rows[0]);
    decltype(words_of(rows[0])) differing{};  // a bit is set if rows differ in it
    for (const Row& row : rows) {
        const auto words = words_of(row);
        for (std::size_t i = 0; i < words.size(); ++i) differing[i] |= words[i] ^ first[i];
    }
    std::vector<digit> digits;
    for (std::size_t i = 0; i < differing.size(); ++i) {
        const auto lowest = static_cast<std::size_t>(std::countr_zero(differing[i]));
        for (auto above = static_cast<std::size_t>(std::bit_width(differing[i])); above > lowest;) {
            const std::size_t bits = std::min(digit::most_bits, above - lowest);
            above -= bits;
            digits.push_back({i, above, (std::uint32_t{1} << bits) - 1});
        }
    }
    return digits;
}

/// Sorts rows that differ only in these digits, in place, by American flag sort: first into buckets by the first digit.
template <class Row>
void sort_by(std::span<const digit> digits, std::span<Row> rows) {
    // For fewer rows a comparison sort is faster than a histogram of the digit.
    if (rows.size() <= digit::values / 4) {
        std::ranges::sort(rows);
        return;
    }
    if (digits.empty()) return;
    const digit d = digits.front();
    std::array<std::size_t, digit::values> ends{};
    for (const Row& row : rows) ++ends[d.value_in(row)];
    std::array<std::size_t, digit::values> next{};
    std::exclusive_scan(ends.begin(), ends.end(), next.begin(), std::size_t{0});
    std::inclusive_scan(ends.begin(), ends.end(), ends.begin());
    // Cycle permutation: each row is swapped into its bucket, and the displaced row continues.
    for (std::size_t value = 0; value <= d.mask; ++value)
        while (next[value] < ends[value]) {
            Row row = rows[next[value]];
            for (std::size_t target = d.value_in(row); target != value; target = d.value_in(row))
                std::swap(row, rows[next[target]++]);
            rows[next[value]++] = row;
        }
    std::size_t begin = 0;
    for (std::size_t value = 0; value <= d.mask; ++value) {
        sort_by(digits.subspan(1), rows.subspan(begin, ends[value] - begin));
        begin = ends[value];
    }
}

template <class Row>
void sort_whole(std::span<Row> rows) {
    if (!std::ranges::is_sorted(rows)) sort_by(digits_of(std::span<const Row>(rows)), rows);
}

void append(std::string& text, char before, const aabb::vec3d& p) {
    for (const double x : p.at) text += before + aabb::shortest(x);
}

}  // namespace

void sort_rows(std::span<aabb::index_pair> pairs) {
    sort_whole(pairs);
}

void sort_rows(std::span<aabb::contact> contacts) {
    sort_whole(contacts);
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
    : file_(file), text_(std::string(header) + "\n") {}

void number_table::add(std::initializer_list<std::uint32_t> row, std::string_view further) {
    fmt::format_to(std::back_inserter(text_), "{}{}{}\n", fmt::join(row, ","), further.empty() ? "" : ",", further);
    if (text_.size() < 1U << 16U) return;
    file_.write(text_);
    text_.clear();
}

void number_table::commit() {
    file_.write(text_);
    file_.commit();
}

}  // namespace aabblab
