module aabblab.errors;

import :front;

namespace aabblab {

std::vector<std::size_t> front_of(std::span<const cost> costs) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return costs[i]; });
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || costs[i][1] < costs[front.back()][1]) front.push_back(i);
    return front;
}

std::string file_name(std::string text) {
    for (char& c : text)
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_') c = '-';
    return text.substr(0, 100);
}

}  // namespace aabblab
