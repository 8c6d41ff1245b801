module;
#include <fmt/format.h>

module aabblab.atlas;

import :labels;
import aabblab.numbers;

namespace aabblab {

table regrets_table(const std::vector<atlas_scene>& atlas, span_of_time of) {
    struct standing {
        std::string label;
        std::vector<double> regrets;
        std::size_t beyond = 0;
        quartiles of{};
    };
    std::vector<standing> all;
    for (const std::string& label : labels_of(atlas)) {
        standing one{label, regrets_of(atlas, label, of), 0, {}};
        one.beyond = static_cast<std::size_t>(std::ranges::count_if(one.regrets, [](double r) { return r > 1.3; }));
        one.of = quartiles_of(one.regrets);
        all.push_back(std::move(one));
    }
    std::ranges::stable_sort(all, {}, [](const standing& one) { return one.of.median; });
    table t{{{row_number}, {"used everywhere", false}, {"scenes"}, {"median"}, {"9 of 10"}, {"worst"}, {"over 1.3"}},
            {}};
    for (const standing& one : all)
        t.rows.push_back({std::to_string(t.rows.size() + 1), one.label, grouped(one.regrets.size()),
                          fmt::format("{:.2f}", one.of.median),
                          fmt::format("{:.2f}", one.regrets[one.regrets.size() * 9 / 10]),
                          fmt::format("{:.2f}", one.regrets.back()), grouped(one.beyond)});
    return t;
}

}  // namespace aabblab
