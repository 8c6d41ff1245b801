export module aabb.pipeline:prepared_search;

import aabb.geometry;
import aabb.policy;
import aabb.std;
import :scene;
import :scene_parts;
import :searched_by;
import :stage;

export namespace aabb {

/// What happens to boxes before a global search sees them. `before(search, counted)` returns a stage that hands them on
/// to that search, changed, and its pairs back, or the search itself where nothing is to be done. Such a stage may
/// divide the scene (`global_stage::divide`), so that boxes of parts come to it.
template <class P>
concept PreparePolicy =
    Strategy<P> && requires(const P policy, std::unique_ptr<global_stage> search, instrumentation counted) {
        { policy.before(std::move(search), counted) } -> std::same_as<std::unique_ptr<global_stage>>;
    };

/// A global search behind a strategy that prepares its boxes: what `global_stage` says of its functions holds here. The
/// two know each other as stages, at one call a frame.
template <PreparePolicy Prepare, class Search>
class prepared_search {
public:
    explicit prepared_search(const Prepare& prepare = {}, Search search = Search())
        : stage_(prepare.before(std::make_unique<searched_by<Search>>(std::move(search)), instrumentation::none)) {}

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) { return stage_->divide(scene); }
    void insert(std::uint32_t id) { stage_->insert(id); }
    void remove(std::uint32_t id) { stage_->remove(id); }
    void update(std::span<const box> boxes) { stage_->update(boxes); }
    void search(std::vector<index_pair>& pairs) { stage_->search(pairs); }

    [[nodiscard]] friend std::vector<part_bytes> bytes_by_part(const prepared_search& search) {
        return search.stage_->bytes();
    }

private:
    std::unique_ptr<global_stage> stage_;
};

}  // namespace aabb
