module;
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

metric all_bytes_metric() {
    return {"all_bytes",
            "bytes",
            "memory of all parts but the meshes, which every composition reads",
            metric_group::bytes,
            better::less,
            [](const row& r) -> std::optional<double> {
                std::uint64_t all = 0;
                for (std::size_t i = 0; i < byte_columns.size(); ++i)
                    if (byte_columns[i] != "triangles" && byte_columns[i] != "vertices") all += r.bytes[i].value_or(0);
                // An engine need not say.
                return all > 0 ? std::optional(static_cast<double>(all)) : std::nullopt;
            }};
}

}  // namespace aabblab
