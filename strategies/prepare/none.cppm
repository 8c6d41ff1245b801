export module aabb.prepare.none;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// Passes boxes to the broad phase unchanged. When to use: unless a few objects are very large.
struct none_prepare {
    static constexpr std::string_view name = "none";
    static constexpr std::string_view summary = "boxes are searched as they are";
    static constexpr std::array leaves_out{absence::neighbour_list, absence::division};

    [[nodiscard]] static std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search, instrumentation) {
        return search;
    }
};

static_assert(PreparePolicy<none_prepare>);

}  // namespace aabb
