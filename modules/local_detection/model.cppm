export module aabb.local_detection:model;

import aabb.std;
import :policies;

export namespace aabb {

/// Whether the boxes made of a mesh hold its triangles as they lie now. After a refit that did not come to its end they
/// may not, and a query would miss pairs without a word: it is refused until a refit succeeds.
class mesh_fit {
public:
    template <class Refit>
    void renew(Refit refit) {
        fits_ = false;
        refit();
        fits_ = true;
    }

    /// Before a query.
    /// @throws input_error when the last refit did not succeed.
    void require() const {
        if (!fits_) throw input_error("the last refit of a model did not succeed; refit it before the next query");
    }

private:
    bool fits_ = true;
};

/// A mesh with its tree, built in the mesh's own frame. The mesh must outlive it.
template <TreePolicy Tree>
class model {
public:
    /// @throws input_error on a mesh that `require_valid` refuses, and as `require_ieee_arithmetic`.
    /// @param builder of what the tree packs
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

    /// After vertices of the mesh have moved.
    /// @param boxes scratch, one box an internal node, or a triangle
    /// @throws input_error when the mesh is no longer valid or of as many triangles, and as `require_ieee_arithmetic`.
    void refit(std::vector<box>& boxes) {
        fit_.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*mesh_, triangles_);
            tree_.refit(*mesh_, boxes);
            bounds_ = tree_.bounds(tree_.root(*mesh_));
            state_ = next_number();
        });
    }

    [[nodiscard]] const mesh& triangles() const noexcept { return *mesh_; }
    [[nodiscard]] const Tree& tree() const noexcept { return tree_; }
    /// Where every query begins.
    /// @throws input_error when the last refit did not succeed.
    [[nodiscard]] typename Tree::cursor root() const {
        require_fit();
        return tree_.root(*mesh_);
    }
    /// @throws input_error when the last refit did not succeed.
    void require_fit() const { fit_.require(); }
    /// No other model has it but a copy.
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
    /// Whoever has the same holds the same boxes of the same mesh: each refit gives another one.
    [[nodiscard]] std::uint64_t state() const noexcept { return state_; }
    /// Of the root.
    /// @throws input_error when the last refit did not succeed.
    [[nodiscard]] const box& bounds() const {
        require_fit();
        return bounds_;
    }

private:
    [[nodiscard]] static std::uint64_t next_number() noexcept {
        static constinit std::uint64_t last = 0;
        return __atomic_add_fetch(&last, 1, __ATOMIC_RELAXED);  // <atomic> beside a module of headers is refused
    }

    const mesh* mesh_;
    std::size_t triangles_;
    Tree tree_;
    box bounds_{};
    mesh_fit fit_;
    std::uint64_t number_ = next_number();
    std::uint64_t state_ = number_;
};

}  // namespace aabb
