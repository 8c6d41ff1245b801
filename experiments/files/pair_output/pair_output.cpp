module;
#include <fmt/format.h>

module aabblab.pair_output;

namespace aabblab {

void require_each_once(std::span<const aabb::index_pair> pairs, std::string_view where) {
    if (const auto twice = std::ranges::adjacent_find(pairs); twice != pairs.end())
        throw defect(fmt::format("{}: the pair {},{} was reported more than once", where, twice->a, twice->b));
}

void require_each_once(std::span<const aabb::contact> contacts, std::string_view where) {
    if (const auto twice = std::ranges::adjacent_find(contacts); twice != contacts.end())
        throw defect(fmt::format("{}: the contact {},{},{},{} was reported more than once", where, twice->a, twice->b,
                                 twice->triangle_a, twice->triangle_b));
}

number_table::number_table(const std::filesystem::path& file, std::string_view header)
    : file_(file), text_(std::string(header) + "\n") {}

void number_table::add(std::initializer_list<std::uint32_t> row, std::string_view further) {
    constexpr std::size_t block = 1U << 16U;
    fmt::format_to(std::back_inserter(text_), "{}{}{}\n", fmt::join(row, ","), further.empty() ? "" : ",", further);
    if (text_.size() < block) return;
    file_.write(text_);
    text_.clear();
}

void number_table::commit() {
    file_.write(text_);
    file_.commit();
}

}  // namespace aabblab
