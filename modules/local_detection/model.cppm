export module aabb.local_detection:model;

import aabb.std;
import :policies;

export namespace aabb {

/// Whether the boxes of a mesh contain its current triangles. After a failed refit they may not, and a query would
/// silently yield false negatives, so queries are rejected until a refit succeeds.
class mesh_fit {
public:
    template <class Refit>
    void renew(Refit refit) {
        fits_ = false;
        refit();
        fits_ = true;
    }

    /// Must be called before a query.
    /// @throws input_error if the last refit failed
    void require() const {
        if (!fits_) throw input_error("the last refit of a model did not succeed; refit it before the next query");
    }

private:
    bool fits_ = true;
};

/// A mesh with its BVH, built in the local frame of the mesh. The mesh must outlive it.
template <TreePolicy Tree>
class model {
public:
    /// Builds the tree of a mesh, which must outlive the model.
    /// @param builder builds binary nodes, or for a balanced tree the order of its triangles
    /// @param tree an empty tree, which packs these into its layout
    /// @throws input_error on a mesh that `require_valid` rejects, and as `require_ieee_arithmetic`
    template <TreeBuilder Builder>
    model(const mesh& m, const Builder& builder, Tree tree = {})
        : mesh_(&m), triangles_(m.triangles.size()), tree_(std::move(tree)) {
        require_ieee_arithmetic();
        require_valid(m);
        if constexpr (BalancedTree<Tree>)
            tree_.pack(m, builder.order(m));
        else
            tree_.pack(builder.build(m, leaf_arrangement_of<Tree>));
        bounds_ = tree_.bounds(tree_.root(m));
    }

    /// Updates the tree's boxes after vertices have moved; if it throws, queries throw until a refit succeeds.
    /// @param boxes scratch memory, one box per internal node or per triangle
    /// @throws input_error if the mesh is invalid or has another number of triangles, and as `require_ieee_arithmetic`
    void refit(std::vector<box>& boxes) {
        fit_.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*mesh_, triangles_);
            tree_.refit(*mesh_, boxes);
            bounds_ = tree_.bounds(tree_.root(*mesh_));
            state_ = next_number();  // queries must not reuse results of the earlier boxes
        });
    }

    [[nodiscard]] const mesh& triangles() const noexcept { return *mesh_; }
    [[nodiscard]] const Tree& tree() const noexcept { return tree_; }
    /// The node at which every query begins.
    [[nodiscard]] typename Tree::cursor root() const {
        require_fit();
        return tree_.root(*mesh_);
    }
    /// Called by `root`, `bounds` and every query.
    /// @throws input_error if the last refit failed
    void require_fit() const { fit_.require(); }
    /// Unique among models, except that copies share it.
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
    /// Models of equal state have the same boxes of the same mesh; each refit changes the state.
    [[nodiscard]] std::uint64_t state() const noexcept { return state_; }
    [[nodiscard]] const box& bounds() const {
        require_fit();
        return bounds_;
    }

private:
    [[nodiscard]] static std::uint64_t next_number() noexcept {
        static constinit std::uint64_t last = 0;
        return __atomic_add_fetch(&last, 1, __ATOMIC_RELAXED);  // clang rejects <atomic> beside a module of headers
    }

    const mesh* mesh_;
    std::size_t triangles_;
    Tree tree_;
    box bounds_{};
    mesh_fit fit_;
    std::uint64_t number_ = next_number();
    std::uint64_t state_ = number_;
};

/// The motion from the frame of model B to that of model A.
template <TreePolicy Tree>
[[nodiscard]] relative_pose pose_relative_to(const model<Tree>& a, const pose& pose_a, const model<Tree>& b,
                                             const pose& pose_b) {
    return {pose_a, pose_b, b.bounds(), a.triangles().frame, b.triangles().frame};
}

}  // namespace aabb
