module;
#include <Eigen/Core>

module aabblab.files;

import aabblab.fmt;
import aabblab.vectors;
import :gltf_asset;
import :mesh_builder;

namespace aabblab {

namespace {

/// The topology of a primitive, by its code in the format.
enum class gltf_mode : std::uint8_t { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

/// The product of two affine transforms, `child` first; the last of their columns is the translation.
gltf_matrix combined(const gltf_matrix& parent, const gltf_matrix& child) {
    gltf_matrix transform;
    for (int column = 0; column < 4; ++column)
        // Adding zero turns -0 into 0, so that equal transforms have equal bits.
        transform.col(column) = product(parent, child.col(column)) + Eigen::Vector3d::Zero();
    transform.col(3) += parent.col(3);
    return transform;
}

Eigen::Vector3d moved(const gltf_matrix& m, const Eigen::Vector3d& p) {
    return product(m, p) + m.col(3);
}

class gltf_reader {
public:
    gltf_reader(const file_text& file, gltf_asset asset)
        : file_(file),
          asset_(std::move(asset)),
          mesh_(file.name),
          world_transforms_(asset_.nodes.size()),
          is_mesh_shown_(asset_.meshes.size()) {}

    [[nodiscard]] loaded_mesh read() {
        for (const std::size_t node : placed_nodes()) add_node(asset_.nodes[node]);
        mesh_.ignore(asset_.animations, static_cast<std::size_t>(std::ranges::count(is_mesh_shown_, false)));
        return mesh_.finish(file_.name + ": face ");
    }

private:
    [[nodiscard]] const gltf_node& node(std::size_t index) const {
        return gltf_element(file_, asset_.nodes, "nodes", index);
    }
    [[nodiscard]] const gltf_accessor& accessor(std::size_t index) const {
        return gltf_element(file_, asset_.accessors, "accessors", index);
    }

    /// Computes the world transform of each node depth first, and rejects nodes that occur twice, as in a cycle.
    /// @returns the indices of the nodes in preorder, children in file order
    [[nodiscard]] std::vector<std::size_t> placed_nodes() {
        struct waiting_node {
            std::size_t node;
            gltf_matrix parent;  // world transform of its parent
        };
        std::vector<waiting_node> stack;
        const auto push = [&](const std::vector<std::size_t>& nodes, const gltf_matrix& parent) {
            // In reverse, as the last one that is pushed is visited first.
            for (std::size_t i = nodes.size(); i-- > 0;) stack.push_back({nodes[i], parent});
        };
        std::vector<std::size_t> nodes;
        push(asset_.roots, gltf_matrix::Identity());
        while (!stack.empty()) {
            const waiting_node top = stack.back();
            stack.pop_back();
            const gltf_node& visited = node(top.node);
            std::optional<gltf_matrix>& transform = world_transforms_[top.node];
            if (transform) file_.fail(gltf_path("nodes", top.node) + " occurs more than once in the scene");
            if (!visited.extension.empty())
                file_.fail(fmt::format("{} has the extension {}, which is not supported", gltf_path("nodes", top.node),
                                       in_quotes(visited.extension)));
            transform = combined(top.parent, visited.transform);
            nodes.push_back(top.node);
            push(visited.children, *transform);
        }
        return nodes;
    }

    [[noreturn]] void fail_accessor(std::size_t index, const std::string& expected) const {
        file_.fail(gltf_path("accessors", index) + " must be " + expected);
    }
    [[nodiscard]] std::vector<double> numbers(std::size_t index, bool no_view_means_zeros = false) const {
        return gltf_numbers(asset_, file_, index, no_view_means_zeros);
    }

    /// Positions, or position offsets of a morph target; integers need the extension KHR_mesh_quantization.
    [[nodiscard]] std::vector<double> positions(std::size_t index, bool no_view_means_zeros) const {
        const gltf_accessor& a = accessor(index);
        const bool is_integer = a.component != gltf_component::f32 && a.component != gltf_component::u32;
        if (a.type != "VEC3" || !(a.component == gltf_component::f32 || (is_integer && asset_.has_quantized_positions)))
            fail_accessor(index, "of floats and VEC3, as it has positions");
        return numbers(index, no_view_means_zeros);
    }

    /// Reads the vertex indices of a primitive from an accessor; the format allows only unsigned integers.
    [[nodiscard]] std::vector<std::uint32_t> indices(std::size_t index) const {
        const gltf_accessor& a = accessor(index);
        if (a.type != "SCALAR" || (a.component != gltf_component::u8 && a.component != gltf_component::u16 &&
                                   a.component != gltf_component::u32))
            fail_accessor(index, "of whole numbers and SCALAR, as it has indices");
        const std::vector<double> values = numbers(index);
        return {values.begin(), values.end()};
    }

    /// The skinning matrices of a skin, one per joint: the joint's world transform times its inverse bind matrix. Each
    /// moves a vertex from the bind pose, in which the skin was attached to the joints, to the joint's current pose.
    [[nodiscard]] std::vector<gltf_matrix> joint_matrices(std::size_t index) const {
        const gltf_skin& skin = gltf_element(file_, asset_.skins, "skins", index);
        const std::string name = gltf_path("skins", index);
        std::vector<double> bind;
        if (skin.inverse_bind_matrices) {
            const gltf_accessor& a = accessor(*skin.inverse_bind_matrices);
            if (a.type != "MAT4" || a.component != gltf_component::f32)
                fail_accessor(*skin.inverse_bind_matrices, "of floats and MAT4, as it has inverse bind matrices");
            if (a.count < skin.joints.size())
                file_.fail(
                    fmt::format("{} has {} joints, but {} inverse bind matrices", name, skin.joints.size(), a.count));
            bind = numbers(*skin.inverse_bind_matrices);
        }
        std::vector<gltf_matrix> matrices;
        for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
            const std::size_t index_of_node = skin.joints[joint];
            static_cast<void>(node(index_of_node));  // rejects an index out of range
            const std::optional<gltf_matrix>& transform = world_transforms_[index_of_node];
            if (!transform)
                file_.fail(gltf_path("nodes", index_of_node) + " is a joint of " + name + ", but not in the scene");
            matrices.push_back(*transform);
            if (bind.empty()) continue;  // all inverse bind matrices are identities
            const Eigen::Map<const Eigen::Matrix4d> inverse(&bind[16 * joint]);
            // The tolerance is for exporters that invert the matrix in single precision.
            if (!((inverse.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().array() <= 1e-6).all())
                file_.fail(name + " has an inverse bind matrix whose last row is not 0 0 0 1");
            matrices.back() = combined(*transform, inverse.topRows<3>());
        }
        return matrices;
    }

    /// Adds the weighted offsets of each morph target to the positions (x, y, z of each vertex in turn).
    void morph(std::vector<double>& points, const gltf_primitive& primitive, const std::vector<double>& weights,
               const std::string& mesh) const {
        const auto is_zero = [](double weight) { return weight == 0; };
        if (weights.size() != primitive.targets.size() && !std::ranges::all_of(weights, is_zero))
            file_.fail(fmt::format("{} has a primitive of {}, but {}", mesh,
                                   counted(primitive.targets.size(), "morph target"),
                                   counted(weights.size(), "weight")));
        for (std::size_t t = 0; t < std::min(primitive.targets.size(), weights.size()); ++t) {
            // A target without positions changes only attributes that are not read, such as normals.
            if (!primitive.targets[t] || weights[t] == 0) continue;
            // The format allows offsets without data, which are all zero.
            const std::vector<double> offsets = positions(*primitive.targets[t], /*no_view_means_zeros=*/true);
            if (offsets.size() != points.size())
                file_.fail(fmt::format("{} has a morph target for a number of vertices other than its own: {}, not {}",
                                       mesh, offsets.size() / 3, points.size() / 3));
            for (std::size_t i = 0; i < points.size(); ++i) points[i] += weights[t] * offsets[i];
        }
    }

    /// Joints and weights of all vertices, four of each per vertex.
    struct bindings {
        std::vector<double> joints;
        std::vector<double> weights;
    };
    /// The joints that move each vertex, and their weights, in sets of four: the accessors JOINTS_n and WEIGHTS_n.
    /// @param vertices the number of positions, which both accessors must match
    [[nodiscard]] std::vector<bindings> bindings_of(const gltf_primitive& primitive, std::size_t vertices,
                                                    const std::string& mesh) const {
        if (primitive.joints.empty() || primitive.joints.size() != primitive.weights.size())
            file_.fail(fmt::format("{} has a skin and a primitive of {} lists of joints and {} of weights", mesh,
                                   primitive.joints.size(), primitive.weights.size()));
        std::vector<bindings> sets;
        for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
            const std::size_t joints = primitive.joints[set];
            const std::size_t weights = primitive.weights[set];
            const gltf_accessor& j = accessor(joints);
            if (j.type != "VEC4" || (j.component != gltf_component::u8 && j.component != gltf_component::u16))
                fail_accessor(joints, "of whole numbers and VEC4, as it has joints");
            const gltf_accessor& w = accessor(weights);
            const bool is_fraction =
                w.normalized && (w.component == gltf_component::u8 || w.component == gltf_component::u16);
            if (w.type != "VEC4" || (w.component != gltf_component::f32 && !is_fraction))
                fail_accessor(weights, "of floats or normalized numbers and VEC4, as it has weights of joints");
            if (j.count != vertices || w.count != vertices)
                file_.fail(fmt::format("{} has {} positions, but joints of {} and weights of {} vertices", mesh,
                                       vertices, j.count, w.count));
            sets.push_back({numbers(joints), numbers(weights)});
        }
        return sets;
    }

    /// Linear blend skinning: the mean, by weights, of the images of p under the matrices of its joints.
    [[nodiscard]] Eigen::Vector3d skinned(const Eigen::Vector3d& p, std::size_t vertex,
                                          const std::vector<bindings>& sets, const std::vector<gltf_matrix>& joints,
                                          const std::string& mesh) const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double weights = 0;
        for (const bindings& set : sets)
            for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
                const double weight = set.weights[i];
                if (weight == 0) continue;
                const auto joint = static_cast<std::size_t>(set.joints[i]);
                if (joint >= joints.size())
                    file_.fail(
                        fmt::format("{} has a vertex that refers to joint {}, counted from 0, but its skin has {}",
                                    mesh, joint, counted(joints.size(), "joint")));
                sum += moved(joints[joint], p) * weight;
                weights += weight;
            }
        // Weights must sum to 1 up to rounding: each may be off by half a step of the coarsest type, which is 1/255.
        if (!(std::abs(weights - 1) <= static_cast<double>(4 * sets.size()) / 255 / 2))
            file_.fail(mesh + " has a vertex whose joint weights sum to " + aabb::shortest(weights) + ", not 1");
        return sum / weights;
    }

    /// Adds a primitive's vertices in world coordinates, and returns their number; `joints` is empty without a skin.
    std::size_t add_vertices(const gltf_primitive& primitive, const gltf_node& node,
                             const std::vector<gltf_matrix>& joints, const std::string& mesh_name) {
        std::vector<double> points = positions(*primitive.positions, /*no_view_means_zeros=*/false);
        const std::size_t count = points.size() / 3;
        if (count > std::numeric_limits<std::uint32_t>::max() - mesh_.vertices())
            file_.fail("its scene has more than 2^32 - 1 vertices");
        // The scene may have many instances of a mesh, so the file's size does not bound it.
        require_memory(file_.name + ": its scene",
                       static_cast<double>(mesh_.vertices() + count) * sizeof(aabb::vec3d) +
                           static_cast<double>(faces_) * sizeof(std::array<std::uint32_t, 3>));
        const gltf_mesh& mesh = asset_.meshes[*node.mesh];
        morph(points, primitive, node.weights.value_or(mesh.weights.value_or(std::vector<double>())), mesh_name);
        const auto sets = node.skin ? bindings_of(primitive, count, mesh_name) : std::vector<bindings>();
        const auto index_of_node = static_cast<std::size_t>(&node - asset_.nodes.data());
        const gltf_matrix& transform = *world_transforms_[index_of_node];
        for (std::size_t v = 0; v < count; ++v) {
            const Eigen::Vector3d p(&points[3 * v]);
            // Joints place a skinned mesh; the format ignores the transform of its node.
            const Eigen::Vector3d world = node.skin ? skinned(p, v, sets, joints, mesh_name) : moved(transform, p);
            mesh_.add_vertex({world[0], world[1], world[2]});
        }
        return count;
    }

    /// Adds the mesh of a node of the scene: the vertices and triangles of its primitives.
    void add_node(const gltf_node& node) {
        if (!node.mesh) return;
        const gltf_mesh& shown = gltf_element(file_, asset_.meshes, "meshes", *node.mesh);
        is_mesh_shown_[*node.mesh] = true;
        const std::string mesh = gltf_path("meshes", *node.mesh);
        const auto joints = node.skin ? joint_matrices(*node.skin) : std::vector<gltf_matrix>();
        for (const gltf_primitive& primitive : shown.primitives) {
            if (!primitive.positions) file_.fail(mesh + " has a primitive without positions");
            if (primitive.mode > static_cast<std::size_t>(gltf_mode::triangle_fan))
                file_.fail(mesh + " has a primitive of mode " + std::to_string(primitive.mode) + "; modes are 0 to 6");
            const std::size_t first = mesh_.vertices();  // the index in the result of the primitive's vertex 0
            const std::size_t count = add_vertices(primitive, node, joints, mesh);
            // Without indices, the vertices themselves are the corners in order.
            std::vector<std::uint32_t> corners(count);
            std::iota(corners.begin(), corners.end(), 0U);
            if (primitive.indices) corners = indices(*primitive.indices);
            for (std::uint32_t& corner : corners) {
                if (corner >= count)
                    file_.fail(
                        fmt::format("{} has a face that uses vertex {}, but there are {} vertices, counted from 0",
                                    mesh, corner, count));
                corner += static_cast<std::uint32_t>(first);
            }
            add_faces(static_cast<gltf_mode>(primitive.mode), corners);
        }
    }

    /// Adds the triangles of a primitive. Points, lines and corners that remain at the end count as dropped faces.
    /// @param corners vertex indices, by mode: three per triangle, a strip or a fan
    void add_faces(gltf_mode mode, const std::vector<std::uint32_t>& corners) {
        const std::size_t count = corners.size();
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            mesh_.add_face({{corners[a], corners[b], corners[c]}}, faces_++);
        };
        switch (mode) {
            case gltf_mode::points:
            case gltf_mode::line_loop: mesh_.drop_faces(count); break;
            case gltf_mode::lines: mesh_.drop_faces(count / 2); break;
            case gltf_mode::line_strip: mesh_.drop_faces(count > 0 ? count - 1 : 0); break;
            case gltf_mode::triangles:
                for (std::size_t i = 2; i < count; i += 3) add(i - 2, i - 1, i);
                mesh_.drop_faces(count % 3 == 0 ? 0 : 1);
                break;
            case gltf_mode::triangle_strip:
                for (std::size_t i = 2; i < count; ++i) {
                    std::array<std::uint32_t, 3> triangle{corners[i - 2], corners[i - 1], corners[i]};
                    if (i % 2 == 1) std::swap(triangle[1], triangle[2]);  // for consistent winding
                    mesh_.add_strip_triangle(triangle, faces_++);
                }
                mesh_.drop_faces(count == 1 || count == 2 ? 1 : 0);
                break;
            case gltf_mode::triangle_fan:
                for (std::size_t i = 2; i < count; ++i) add(0, i - 1, i);
                mesh_.drop_faces(count == 1 || count == 2 ? 1 : 0);
                break;
        }
    }

    const file_text& file_;
    gltf_asset asset_;
    mesh_builder mesh_;
    std::vector<std::optional<gltf_matrix>> world_transforms_;  // of the scene's nodes
    std::vector<bool> is_mesh_shown_;
    std::size_t faces_ = 0;
};

}  // namespace

loaded_mesh read_gltf(const file_text& file) {
    const gltf_parts parts = gltf_parts_of(file);
    gltf_asset asset = parse_gltf(file, parts);
    load_gltf_buffers(asset, file, parts.binary);
    return gltf_reader(file, std::move(asset)).read();
}

}  // namespace aabblab
