module;
#include <cassert>

export module aabb.pipeline:basic_pipeline;

import aabb.std;
import :stage;

export namespace aabb {

/// A broad phase that may divide objects, as any one chosen at run time may (`global_stage::divide`).
template <class Global>
concept DividingSearch = requires(Global& global, const mesh_scene& scene) {
    { global.divide(scene) } -> std::same_as<std::unique_ptr<scene_parts>>;
};

static_assert(DividingSearch<global_stage>);

/// Both stages on a scene of moving meshes: the broad phase proposes candidate pairs of objects, and the narrow phase
/// decides on them. The stages are independent and only share the buffer of candidates. If the broad phase divides
/// objects (`DividingSearch`), both stages see parts instead of objects, but contacts always name whole objects. For a
/// broad phase whose type divides nothing, the code for parts is not compiled.
template <class Global, class Local>
class basic_pipeline {
    static constexpr bool may_divide = DividingSearch<Global>;

public:
    /// Inserts all objects and builds the models of the scene. Scene and stages must outlive the pipeline.
    basic_pipeline(const mesh_scene& scene, Global& global, Local& local)
        : scene_(scene), global_(&global), local_(local) {
        if constexpr (may_divide) parts_ = global.divide(scene);
        add_models();
        if (!parts_) world_.emplace(scene);
        for (std::uint32_t id = 0; id < pieces(); ++id) global.insert(id);
    }
    /// A pipeline without a broad phase, in which all pairs of objects are candidates and objects may lie anywhere.
    basic_pipeline(const mesh_scene& scene, Local& local)
        requires may_divide
        : scene_(scene), local_(local) {
        add_models();
    }

    /// Inserts a removed object again, or removes one, from the next frame on. Requires a broad phase.
    /// @throws input_error if the object does not exist, is already present, or is not present
    void insert(std::uint32_t object) { change_pieces_of(object, /*inserts=*/true); }
    void remove(std::uint32_t object) { change_pieces_of(object, /*inserts=*/false); }

    /// The first step of a frame, before `search` and `detect`, which can be timed separately: takes one pose per
    /// object, refits deformed meshes, and passes the world boxes to the broad phase.
    /// @throws input_error on a pose that is singular or moves an object beyond the range of float, with its number
    void update(std::span<const pose> poses) {
        frame_.begin();
        searched_ = false;
        require_ieee_arithmetic();
        refit_deformed();
        place(poses);
        poses_.assign(poses.begin(), poses.end());
        if (searches()) global_->update(boxes());
        frame_.taken();
    }
    /// Finds the candidates: the pairs of objects whose boxes overlap, or all pairs without a broad phase. If it
    /// divides objects into pieces, it finds pairs of pieces, and each makes the pair of its objects a candidate.
    /// @throws input_error if the last update failed or there was none
    void search() {
        frame_.require_taken();
        searched_ = false;
        candidates_.clear();
        if (parts_) {
            parts_->piece_pairs.clear();
            global_->search(parts_->piece_pairs);
            parts_->append_objects(candidates_);
        } else if (searches())
            global_->search(candidates_);
        else
            add_all_pairs();
        searched_ = true;
    }
    /// Finds the contacts: the pairs of intersecting triangles of each candidate pair, in `contacts_`.
    /// @throws input_error if the last search failed or there was none since the last update
    void detect() {
        contacts_.clear();
        require_searched();
        append_guard guard(contacts_);  // removes what was appended, unless it is kept
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const auto [a, b] = models_of(i);
            triangle_pairs_.clear();
            local_.all_pairs(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b], triangle_pairs_);
            if (parts_) parts_->map_triangles({a, b}, triangle_pairs_);  // to triangles of whole meshes
            // Resizing once is faster than `push_back`, whose capacity checks take longer than the writes.
            const std::size_t before = contacts_.size();
            contacts_.resize(before + triangle_pairs_.size());
            contact* to = contacts_.data() + before;
            const index_pair objects = candidates_[i];
            for (const auto [t, u] : triangle_pairs_) *to++ = {objects.a, objects.b, t, u};
        }
        guard.keep();
    }

    /// Some contact of the frame, if there is one; ends at the first, unlike `detect`.
    /// @throws input_error as `detect`
    [[nodiscard]] std::optional<contact> first_contact() {
        require_searched();
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const auto [a, b] = models_of(i);
            if (auto pair = local_.first_pair(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b])) {
                if (parts_) parts_->map_triangles({a, b}, {&*pair, 1});  // to triangles of whole meshes
                return contact{candidates_[i].a, candidates_[i].b, pair->a, pair->b};
            }
        }
        return std::nullopt;
    }
    /// The number of contacts of the frame, without storing them as `detect` does.
    /// @throws input_error as `detect`
    [[nodiscard]] std::uint64_t count_contacts() {
        require_searched();
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const auto [a, b] = models_of(i);
            count += local_.count_pairs(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b]);
        }
        return count;
    }

    /// World boxes by object, or by piece if meshes are divided; empty without a broad phase.
    [[nodiscard]] std::span<const box> boxes() const noexcept {
        if (parts_) return parts_->boxes();
        return world_ ? world_->boxes() : std::span<const box>();
    }
    /// Pairs of objects whose boxes overlap, in unspecified order; of divided meshes, once per pair of their pieces.
    [[nodiscard]] std::span<const index_pair> candidates() const noexcept { return candidates_; }
    /// The contacts of the last `detect`, in unspecified order.
    [[nodiscard]] std::span<const contact> contacts() const noexcept { return contacts_; }
    /// Number of models in the narrow phase: the meshes, or their parts if they are divided.
    [[nodiscard]] std::uint32_t models() const noexcept {
        if (parts_) return parts_->models();
        return static_cast<std::uint32_t>(scene_.meshes.size());
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return (world_ ? world_->bytes() : 0) + bytes_of(poses_, candidates_) +
               (parts_ ? bytes_of(parts_->piece_pairs) : 0) + bytes_of(triangle_pairs_, contacts_);
    }
    /// Additional heap bytes for the parts of divided meshes.
    [[nodiscard]] std::size_t division_bytes() const noexcept { return parts_ ? parts_->bytes() : 0; }

private:
    [[nodiscard]] bool searches() const noexcept { return !may_divide || global_ != nullptr; }
    /// Number of objects or parts in the broad phase.
    [[nodiscard]] std::uint32_t pieces() const noexcept {
        return parts_ ? parts_->pieces() : static_cast<std::uint32_t>(scene_.mesh_of.size());
    }

    void add_models() {
        assert(std::ranges::all_of(scene_.mesh_of, [&](std::uint32_t m) { return m < scene_.meshes.size(); }));
        for (std::uint32_t m = 0; m < models(); ++m) local_.add_model(mesh_of(m));
    }
    [[nodiscard]] const mesh& mesh_of(std::uint32_t model) const noexcept {
        return parts_ ? parts_->mesh_of(model) : scene_.meshes[model];
    }
    [[nodiscard]] bool deforms(std::uint32_t model) const {
        return parts_ ? parts_->deforms(model) : scene_.deforms(model);
    }

    /// Inserts or removes an object in the broad phase, with all its pieces; undone if one operation throws.
    void change_pieces_of(std::uint32_t object, bool inserts) {
        const auto change = [&](std::uint32_t id, bool insert) { insert ? global_->insert(id) : global_->remove(id); };
        assert(searches());
        if (object >= scene_.mesh_of.size())
            throw input_error("there is no object " + std::to_string(object) + ": the scene has " +
                              std::to_string(scene_.mesh_of.size()));
        if (!parts_) return change(object, inserts);
        const auto [first, last] = parts_->pieces_of(object);
        for (std::uint32_t id = first; id < last; ++id) {
            try {
                change(id, inserts);
            } catch (...) {
                while (id-- > first) change(id, !inserts);
                throw;
            }
        }
    }

    /// Refits deformed meshes, which also validates them.
    void refit_deformed() {
        if (parts_) parts_->follow();
        for (std::uint32_t m = 0; m < models(); ++m)
            if (deforms(m)) local_.refit(m);
    }
    void place(std::span<const pose> poses) {
        if (parts_) return parts_->place(poses);
        if (world_)
            world_->update(poses);
        else
            require_poses(scene_, poses);
    }

    void add_all_pairs() {
        for (std::uint32_t b = 0; b < poses_.size(); ++b)
            for (std::uint32_t a = 0; a < b; ++a) candidates_.push_back({a, b});
    }
    void require_searched() const {
        if (!searched_) throw input_error("there are no candidates to test: search was not called, or did not succeed");
        assert(poses_.size() == scene_.mesh_of.size());
    }
    [[nodiscard]] index_pair models_of(std::size_t candidate) const noexcept {
        if (parts_) return parts_->models_of(parts_->piece_pairs[candidate]);
        return {scene_.mesh_of[candidates_[candidate].a], scene_.mesh_of[candidates_[candidate].b]};
    }

    const mesh_scene& scene_;
    Global* global_ = nullptr;
    Local& local_;
    // Set if the broad phase divides objects; otherwise `world_` contains the boxes of the objects.
    [[no_unique_address]] std::conditional_t<may_divide, std::unique_ptr<scene_parts>, no_scene_parts> parts_;
    std::optional<posed_boxes> world_;
    std::vector<pose> poses_;
    std::vector<index_pair> candidates_;
    std::vector<index_pair> triangle_pairs_;
    large_vector<contact> contacts_;
    frame_state frame_;
    bool searched_ = false;
};

}  // namespace aabb
