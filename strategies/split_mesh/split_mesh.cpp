module;
#include <cassert>

module aabb.split_mesh;

namespace aabb {

namespace {

constexpr std::uint32_t no_part = 0xffffffff;

struct part {
    mesh own_mesh;                         // with vertices of its own, as a model of the narrow phase
    std::vector<std::uint32_t> vertices;   // of the scene's mesh, by vertex of the part
    std::vector<std::uint32_t> triangles;  // the same for triangles
};

/// Copies a part's vertices, `to.vertices`: floats in the mesh's frame and, if these are rounded, the given doubles.
void copy_vertices(const mesh& m, part& to) {
    to.own_mesh.frame = m.frame;
    const auto copy = [&to](const auto& of_mesh, auto& of_part) {
        of_part.resize(of_mesh.empty() ? 0 : to.vertices.size());
        for (std::size_t v = 0; v < of_part.size(); ++v) of_part[v] = of_mesh[to.vertices[v]];
    };
    copy(m.vertices, to.own_mesh.vertices);
    copy(m.given, to.own_mesh.given);
}

/// A mesh of its own for these triangles of a mesh, so that it can be a model of the narrow phase. It has only the
/// vertices that they use, in the order of the mesh; `vertices` and `triangles` have their indices in the mesh.
part part_of(const mesh& m, std::vector<std::uint32_t> triangles) {
    assert(!triangles.empty());
    part result;
    for (const std::uint32_t t : triangles)
        result.vertices.insert(result.vertices.end(), m.triangles[t].begin(), m.triangles[t].end());
    std::ranges::sort(result.vertices);
    const auto repeated = std::ranges::unique(result.vertices);
    result.vertices.erase(repeated.begin(), repeated.end());
    result.vertices.shrink_to_fit();
    // The index in the part of a vertex of the mesh.
    const auto own_index = [&](std::uint32_t vertex) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(result.vertices, vertex) - result.vertices.begin());
    };
    copy_vertices(m, result);
    result.own_mesh.triangles.reserve(triangles.size());
    for (const std::uint32_t t : triangles) {
        const auto& [a, b, c] = m.triangles[t];
        result.own_mesh.triangles.push_back({own_index(a), own_index(b), own_index(c)});
    }
    result.triangles = std::move(triangles);
    return result;
}

class divided_scene final : public scene_parts {
public:
    /// Makes the narrow phase's models of all meshes, and the broad phase's pieces of all objects, one per model.
    divided_scene(const mesh_scene& scene, mesh_division division) : scene_(scene) {
        division.resize(scene.meshes.size());
        std::size_t parts = 0;
        for (const auto& of_mesh : division) parts += of_mesh.size();
        parts_.reserve(parts);                   // models keep pointers to them
        std::vector<std::uint32_t> first_model;  // by mesh; those of mesh m end where those of m + 1 begin
        for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
            triangle_counts_.push_back(scene.meshes[m].triangles.size());
            first_model.push_back(models());
            add_models(m, division[m]);
        }
        first_model.push_back(models());
        for (std::uint32_t object = 0; object < scene.mesh_of.size(); ++object)
            for (std::uint32_t m = first_model[scene.mesh_of[object]]; m < first_model[scene.mesh_of[object] + 1]; ++m)
                pieces_.push_back({object, m});
        boxes_.resize(pieces_.size());
    }

    [[nodiscard]] std::uint32_t pieces() const noexcept override { return static_cast<std::uint32_t>(pieces_.size()); }
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> pieces_of(std::uint32_t object) const noexcept override {
        const auto own = std::ranges::equal_range(pieces_, object, {}, &piece::object);
        return {static_cast<std::uint32_t>(own.begin() - pieces_.begin()),
                static_cast<std::uint32_t>(own.end() - pieces_.begin())};
    }
    [[nodiscard]] std::uint32_t models() const noexcept override { return static_cast<std::uint32_t>(models_.size()); }
    [[nodiscard]] const mesh& mesh_of(std::uint32_t model) const noexcept override {
        const auto& [source, part, bounds] = models_[model];
        return part == no_part ? scene_.meshes[source] : parts_[part].own_mesh;
    }
    [[nodiscard]] bool deforms(std::uint32_t model) const override { return scene_.deforms(models_[model].source); }
    /// Copies moved vertices of deforming meshes to the parts, and recomputes bounds.
    void follow() override {
        for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m)
            if (scene_.deforms(m)) require_still_valid(scene_.meshes[m], triangle_counts_[m]);
        for (auto& [source, part_index, bounds] : models_) {
            if (!scene_.deforms(source)) continue;
            if (part_index != no_part) copy_vertices(scene_.meshes[source], parts_[part_index]);
            bounds = bounds_of(part_index == no_part ? scene_.meshes[source] : parts_[part_index].own_mesh);
        }
    }
    void place(std::span<const pose> poses) override {
        require_poses(scene_, poses);
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            boxes_[i] = posed_box(models_[pieces_[i].model].bounds, mesh_of(pieces_[i].model).frame,
                                  poses[pieces_[i].object], pieces_[i].object);
    }
    [[nodiscard]] std::span<const box> boxes() const noexcept override { return boxes_; }
    void append_objects(std::vector<index_pair>& objects) override {
        const auto objects_of = [&](index_pair p) { return index_pair{pieces_[p.a].object, pieces_[p.b].object}; };
        std::erase_if(piece_pairs, [&](index_pair p) { return objects_of(p).a == objects_of(p).b; });
        for (const index_pair p : piece_pairs) objects.push_back(objects_of(p));
    }
    [[nodiscard]] index_pair models_of(index_pair pieces) const noexcept override {
        return {pieces_[pieces.a].model, pieces_[pieces.b].model};
    }
    void map_triangles(index_pair models, std::span<index_pair> triangles) const noexcept override {
        for (auto& [a, b] : triangles) {
            a = triangle_of(models.a, a);
            b = triangle_of(models.b, b);
        }
    }
    [[nodiscard]] std::size_t bytes() const noexcept override {
        std::size_t total = bytes_of(triangle_counts_, parts_, models_, pieces_, boxes_);
        for (const part& p : parts_)
            total += bytes_of(p.own_mesh.vertices, p.own_mesh.given, p.own_mesh.triangles, p.vertices, p.triangles);
        return total;
    }

private:
    struct model {
        std::uint32_t source;  // mesh of the scene
        std::uint32_t part;    // or `no_part`
        box bounds;
    };
    struct piece {
        std::uint32_t object;
        std::uint32_t model;
    };

    /// Adds the models of mesh m of the scene: one of each part, or of the whole mesh if it is not divided.
    void add_models(std::uint32_t m, mesh_division::value_type& parts) {
        if (parts.size() < 2) {
            models_.push_back({.source = m, .part = no_part, .bounds = bounds_of(scene_.meshes[m])});
            return;
        }
        for (std::vector<std::uint32_t>& triangles : parts) {
            parts_.push_back(part_of(scene_.meshes[m], std::move(triangles)));
            const auto part_index = static_cast<std::uint32_t>(parts_.size() - 1);
            models_.push_back({.source = m, .part = part_index, .bounds = bounds_of(parts_.back().own_mesh)});
        }
    }

    /// Maps a triangle of the model to the scene's mesh.
    [[nodiscard]] std::uint32_t triangle_of(std::uint32_t model, std::uint32_t triangle) const noexcept {
        const std::uint32_t part = models_[model].part;
        return part == no_part ? triangle : parts_[part].triangles[triangle];
    }

    const mesh_scene& scene_;
    std::vector<std::size_t> triangle_counts_;  // by mesh of the scene
    std::vector<part> parts_;
    std::vector<model> models_;
    std::vector<piece> pieces_;
    std::vector<box> boxes_;
};

}  // namespace

std::unique_ptr<scene_parts> divided(const mesh_scene& scene, mesh_division division) {
    return std::make_unique<divided_scene>(scene, std::move(division));
}

}  // namespace aabb
