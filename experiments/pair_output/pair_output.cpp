module;
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

module aabblab.pair_output;

import aabb;
import aabblab.files;

namespace aabblab {

void sort_each_once(std::vector<aabb::index_pair>& pairs, std::string_view where) {
    std::ranges::sort(pairs);
    const auto twice = std::ranges::adjacent_find(pairs);
    if (twice != pairs.end())
        throw defect(fmt::format("{}: the pair {},{} was reported more than once", where, twice->a, twice->b));
}

pair_table::pair_table(const std::filesystem::path& file, columns wanted)
    : file_(file), columns_(wanted), text_(wanted == columns::frame_a_b ? "frame,a,b\n" : "a,b\n") {}

void pair_table::add(std::uint32_t frame, std::span<const aabb::index_pair> sorted) {
    constexpr std::size_t block = 1U << 16U;
    for (const auto [a, b] : sorted) {
        if (columns_ == columns::frame_a_b) fmt::format_to(std::back_inserter(text_), "{},", frame);
        fmt::format_to(std::back_inserter(text_), "{},{}\n", a, b);
        if (text_.size() < block) continue;
        file_.write(text_);
        text_.clear();
    }
}

void pair_table::commit() {
    file_.write(text_);
    file_.commit();
}

}  // namespace aabblab
