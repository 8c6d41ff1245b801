module;
#include <concepts>
#include <memory>
#include <utility>

export module aabb.pipeline:prepare_policy;

import aabb.policy;
import :stage;

export namespace aabb {

/// What happens to boxes before a global search sees them. `before(search, counted)` returns a stage that hands them on
/// to that search, changed, and its pairs back, or the search itself where nothing is to be done. Such a stage may have
/// the meshes themselves divided (`global_stage::divide`), so that boxes of parts come to it.
template <class P>
concept PreparePolicy =
    Strategy<P> && requires(const P policy, std::unique_ptr<global_stage> search, instrumentation counted) {
        { policy.before(std::move(search), counted) } -> std::same_as<std::unique_ptr<global_stage>>;
    };

}  // namespace aabb
