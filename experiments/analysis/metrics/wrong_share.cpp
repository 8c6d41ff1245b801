module;
#include <algorithm>
#include <optional>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric wrong_share_metric() {
    return {"wrong_share",
            "",
            "pairs missing and invented, over those of the exact answer, or over one where it has none",
            metric_group::error,
            better::less,
            [](const row& r) -> std::optional<double> {
                if (!r.missing) return std::nullopt;
                const auto found = static_cast<double>(r.contacts ? *r.contacts : r.candidates);
                const auto missing = static_cast<double>(*r.missing);
                const auto invented = static_cast<double>(*r.invented);
                return (missing + invented) / std::max(found - invented + missing, 1.0);
            }};
}

}  // namespace aabblab
