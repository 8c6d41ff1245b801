module aabb.prepare.split_mesh;

import aabb.split_mesh;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

double extent_of(const box& b, int axis) {
    return double{b.max[axis]} - double{b.min[axis]};
}

/// A uniform grid of numbered cells in a box.
class cell_grid {
public:
    cell_grid(const box& b, double longest) : box_(b) {
        for (int k = 0; k < 3; ++k) cells_[static_cast<std::size_t>(k)] = piece_count(extent_of(b, k), longest);
    }

    [[nodiscard]] std::size_t size() const { return cells_[0] * cells_[1] * cells_[2]; }
    /// The cell of the triangle's centroid, in row-major order; clamped, since rounding may place it beyond the grid.
    [[nodiscard]] std::size_t cell_of(const triangle3f& t) const {
        std::size_t cell = 0;
        for (int k = 0; k < 3; ++k) {
            const std::size_t cells = cells_[static_cast<std::size_t>(k)];
            std::size_t on_axis = 0;
            if (cells > 1) {
                const double centroid = (double{t[0][k]} + double{t[1][k]} + double{t[2][k]}) / 3;
                const double share = (centroid - double{box_.min[k]}) / extent_of(box_, k);
                on_axis =
                    std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(cells)), cells - 1);
            }
            cell = cell * cells + on_axis;
        }
        return cell;
    }

private:
    box box_;
    std::array<std::size_t, 3> cells_{};
};

/// Divides the triangles of a mesh into parts, by the cells of a grid that contain their centroids.
/// @param longest the limit on the edges of a cell
/// @returns indices of triangles by part; empty if there would be only one part
std::vector<std::vector<std::uint32_t>> parts_of(const mesh& m, const box& bounds, double longest) {
    const cell_grid grid(bounds, longest);
    if (grid.size() == 1) return {};
    std::vector<std::vector<std::uint32_t>> parts(grid.size());
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) parts[grid.cell_of(m.triangle(t))].push_back(t);
    std::erase_if(parts, [](const auto& triangles) { return triangles.empty(); });
    if (parts.size() < 2) parts.clear();
    return parts;
}

class split_mesh_stage final : public global_stage {
public:
    split_mesh_stage(std::unique_ptr<global_stage> search, double size, instrumentation counted)
        : search_(std::move(search)), size_(size), counted_(counted) {}

    /// Divides meshes longer than `size_` mean extents of the objects into parts, by the centroids of their triangles,
    /// since the box of a long object overlaps many others. Bounds are in units of a mesh's `frame.scale`.
    /// @returns null if no mesh is so long
    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) override {
        std::vector<box> bounds;
        for (const mesh& m : scene.meshes) {
            require_valid(m);
            bounds.push_back(bounds_of(m));
        }
        knows_meshes_ = true;
        const std::size_t objects = scene.mesh_of.size();
        if (objects == 0) return nullptr;
        double sum_of_extents = 0;
        for (const std::uint32_t m : scene.mesh_of)
            for (int k = 0; k < 3; ++k) sum_of_extents += scene.meshes[m].frame.scale * extent_of(bounds[m], k);
        const double longest = size_ * sum_of_extents / (3 * static_cast<double>(objects));
        mesh_division division;
        for (std::size_t m = 0; m < scene.meshes.size(); ++m)
            division.push_back(parts_of(scene.meshes[m], bounds[m], longest / scene.meshes[m].frame.scale));
        for (const std::uint32_t m : scene.mesh_of) pieces_ += division[m].size();
        require_few_pieces(split_mesh_prepare::name, pieces_, objects);
        if (std::ranges::all_of(division, [](const auto& parts) { return parts.empty(); })) return nullptr;
        return divided(scene, std::move(division));
    }

    void insert(std::uint32_t id) override { search_->insert(id); }
    void remove(std::uint32_t id) override { search_->remove(id); }
    void update(std::span<const box> boxes) override {
        if (!knows_meshes_) throw input_error(std::string(split_mesh_prepare::needs_meshes));
        if (counted_ == instrumentation::counters) pieces_counted_ += pieces_;
        search_->update(boxes);
    }
    void search(std::vector<index_pair>& pairs) override { search_->search(pairs); }
    [[nodiscard]] double share_of_update() const override { return search_->share_of_update(); }
    [[nodiscard]] work_counters counters() const override {
        work_counters total = search_->counters();
        total.add(work::pieces, pieces_counted_);
        return total;
    }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return search_->bytes(); }
    [[nodiscard]] std::vector<stage_plan> plans() const override { return search_->plans(); }
    [[nodiscard]] std::vector<omission> left_out() const override { return search_->left_out(); }

private:
    std::unique_ptr<global_stage> search_;
    double size_;
    instrumentation counted_;
    bool knows_meshes_ = false;
    std::uint64_t pieces_ = 0;  // number of pieces of the divided objects
    std::uint64_t pieces_counted_ = 0;
};

}  // namespace

std::unique_ptr<global_stage> split_mesh_prepare::before(std::unique_ptr<global_stage> search,
                                                         instrumentation counted) const {
    return std::make_unique<split_mesh_stage>(std::move(search), config_.size, counted);
}

}  // namespace aabb
