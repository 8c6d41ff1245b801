/// What a walk over two meshes tests, so that each test can be made again by itself.
export module aabblab.walked_pairs;

import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import aabb.build.median;
import aabb.std;
import aabb.tree.canonical;
import aabb.triangle.exact;
import aabblab.rotated_boxes;
import aabblab.scenes;

export namespace aabblab {

using walked_tree = aabb::canonical_tree;

/// A pair of nodes of which one is a leaf that has just been reached.
struct reached_leaf {
    walked_tree::cursor a;
    walked_tree::cursor b;
    std::uint32_t triangle;  ///< of the leaf
    aabb::box other;         ///< of the other node, in A's frame: the walk had it in hand for the test before
};

/// Two leaves whose boxes overlap.
struct met_triangles {
    std::uint32_t a;
    std::uint32_t b;
    aabb::triangle3f b_image;  ///< in A's frame
};

/// A noise sphere and a torus knot of about 5,000 triangles each, half-way into each other as in the scene `mesh_pair`,
/// and the pairs that `local_detection` tests between them: the same descent, with the tree `canonical`. So hits and
/// misses mix as they do there, and boxes are about as large as those that they meet.
class walked_pairs {
public:
    /// @throws std::logic_error when local detection has come to test other pairs
    walked_pairs() {
        walk();
        aabb::local_detection<walked_tree, aabb::exact_triangle, aabb::work_counters> detection;
        static_cast<void>(detection.count_pairs(a_, poses_[0], b_, poses_[1]));
        if (detection.counters()[aabb::work::box_tests] != box_tests_ ||
            detection.counters()[aabb::work::triangle_tests] != triangles_.size())
            throw std::logic_error("these are not the pairs that local detection tests");
    }

    [[nodiscard]] inline const aabb::model<walked_tree>& a() const noexcept { return a_; }
    [[nodiscard]] inline const aabb::model<walked_tree>& b() const noexcept { return b_; }
    [[nodiscard]] inline const aabb::relative_pose& to_a() const noexcept { return to_a_; }

    [[nodiscard]] inline const rotated_boxes& rotated() const noexcept { return rotated_; }

    /// Leaves of A, each with the node of B, a leaf or not, that it is tested against when it is reached; and of B.
    [[nodiscard]] inline const std::vector<reached_leaf>& leaves_of_a() const noexcept { return leaves_of_a_; }
    [[nodiscard]] inline const std::vector<reached_leaf>& leaves_of_b() const noexcept { return leaves_of_b_; }
    [[nodiscard]] inline const std::vector<met_triangles>& triangles() const noexcept { return triangles_; }

private:
    using cursor = walked_tree::cursor;

    struct node_pair {
        cursor a;
        cursor b;
        aabb::box b_bounds;
    };

    [[nodiscard]] static std::vector<aabb::pose> first_poses(aabb::mesh_scene& scene) {
        std::vector<aabb::pose> poses;
        scene.next(poses);
        return poses;
    }

    void walk() {
        test({a_.root(), b_.root(), to_a_(b_.bounds())});
        while (!open_.empty()) {
            const node_pair at = open_.back();
            open_.pop_back();
            const bool a_is_leaf = a_.tree().is_leaf(at.a);
            const bool b_is_leaf = b_.tree().is_leaf(at.b);
            if (a_is_leaf && b_is_leaf)
                meet(a_.tree().triangle(at.a), b_.tree().triangle(at.b));
            else if (b_is_leaf || (!a_is_leaf && length(a_.tree().bounds(at.a)) >= length(at.b_bounds)))
                for (const cursor child : a_.tree().children(at.a, a_.triangles())) reach_a({child, at.b, at.b_bounds});
            else
                for (const cursor child : b_.tree().children(at.b, b_.triangles()))
                    reach_b({at.a, child, to_a_(b_.tree().bounds(child))});
        }
    }

    void reach_a(const node_pair& next) {
        if (a_.tree().is_leaf(next.a))
            leaves_of_a_.push_back({next.a, next.b, a_.tree().triangle(next.a), next.b_bounds});
        test(next);
    }

    void reach_b(const node_pair& next) {
        if (b_.tree().is_leaf(next.b))
            leaves_of_b_.push_back({next.a, next.b, b_.tree().triangle(next.b), a_.tree().bounds(next.a)});
        test(next);
    }

    void test(const node_pair& next) {
        ++box_tests_;
        if (overlaps(a_.tree().bounds(next.a), next.b_bounds)) open_.push_back(next);
    }

    void meet(std::uint32_t a, std::uint32_t b) { triangles_.push_back({a, b, to_a_(b_.triangles().triangle(b))}); }

    /// By which the walk chooses the node to open.
    [[nodiscard]] static float length(const aabb::box& b) noexcept {
        const int k = aabb::longest_axis(b);
        return b.max[k] - b.min[k];
    }

    std::unique_ptr<aabb::mesh_scene> scene_ =
        make_mesh_scene({"mesh_pair",
                         {{"frames", "0"}, {"distance", "0.25"}},
                         {"noise_sphere:triangles=5000", "torus_knot:triangles=5000"}});
    aabb::model<walked_tree> a_{scene_->meshes[0], aabb::median_build()};
    aabb::model<walked_tree> b_{scene_->meshes[1], aabb::median_build()};
    std::vector<aabb::pose> poses_ = first_poses(*scene_);
    aabb::relative_pose to_a_{poses_[0], poses_[1], b_.bounds()};
    rotated_boxes rotated_{poses_[0], poses_[1], b_.bounds()};
    std::vector<node_pair> open_;
    std::vector<reached_leaf> leaves_of_a_;
    std::vector<reached_leaf> leaves_of_b_;
    std::vector<met_triangles> triangles_;
    std::size_t box_tests_ = 0;
};

/// Kept for all benchmarks, and since one is called several times before its time is taken.
[[nodiscard]] const walked_pairs& walked() {
    static const walked_pairs pairs;
    return pairs;
}

}  // namespace aabblab
