module;
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric box_inflation_metric() {
    return {"box_inflation",     "",           "area of the boxes of a tree over that of the smallest ones, less 1",
            metric_group::error, better::less, [](const row& r) -> std::optional<double> {
        return r.box_inflation; }};
}

}  // namespace aabblab
