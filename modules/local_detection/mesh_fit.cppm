module;

export module aabb.local_detection:mesh_fit;

import aabb.base;

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

}  // namespace aabb
