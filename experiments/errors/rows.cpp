module aabblab.errors;

import aabblab.results;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 2> precisions{"float", "double"};

template <class Choice>
struct written_choice {
    Choice& choice;
};
template <class Choice>
std::string field_text(const written_choice<Choice>& from) {
    return to_text(from.choice);
}
bool parse_field(const written_choice<aabb::strategy_choice>& to, const std::string& text) {
    to.choice = aabb::parse_strategy(text);
    return true;
}

constexpr auto columns_of_point = [](auto& p, auto field) {
    field("pairs", p.pairs);
    field("precision", one_of_words(p.in_double, precisions));
    field("curve", p.curve);
    field("triangle", written_choice(p.triangle));
    field("count", p.count);
    field("intersecting", p.intersecting);
    field("false_negatives", p.false_negatives);
    field("false_positives", p.false_positives);
    field("ns", all_digits(p.ns_per_pair.median));
    field("ns_low", all_digits(p.ns_per_pair.low));
    field("ns_high", all_digits(p.ns_per_pair.high));
};

constexpr auto columns_of_hit = [](auto& p, auto field) {
    field("pairs", p.pairs);
    field("precision", one_of_words(p.in_double, precisions));
    field("triangle", p.triangle);
    field("tried", p.tried);
    field("hits", p.count);
    for (const aabb::intersection_kind kind : {aabb::intersection_kind::point, aabb::intersection_kind::segment,
                                               aabb::intersection_kind::transversal, aabb::intersection_kind::overlap})
        field(std::string(name_of(kind)), p.kinds[static_cast<std::size_t>(kind)]);
    field("different", p.different);
    field("outside", p.outside);
    field("of_bound", all_digits(p.greatest.of_bound));
    field("error", all_digits(p.greatest.greatest));
    field("bound", all_digits(p.greatest.bound));
    field("ns", all_digits(p.ns_per_hit.median));
    field("ns_low", all_digits(p.ns_per_hit.low));
    field("ns_high", all_digits(p.ns_per_hit.high));
};

}  // namespace

std::string csv_of(std::span<const error_point> points) {
    return csv_of(points, columns_of_point);
}

std::string csv_of(std::span<const hit_point> points) {
    return csv_of(points, columns_of_hit);
}

std::vector<error_point> read_error_rows(const std::filesystem::path& file) {
    return rows_of_file<error_point>(file, columns_of_point);
}

}  // namespace aabblab
