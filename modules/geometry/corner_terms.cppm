/// The coordinates of corners in the world before they are rounded, for integers of a common unit.
export module aabb.geometry:corner_terms;

import aabb.std;
import :exact_products;
import :points;
import :pose;

export namespace aabb {

/// The terms of a corner's coordinates R v + t: on each axis three products and the translation.
using corner_terms = std::array<std::array<product_of_doubles, 4>, 3>;

[[nodiscard]] inline corner_terms terms_of(const pose& at, const vec3d& vertex) noexcept {
    corner_terms terms;
    const odd_double one(1);
    const std::array of_vertex{odd_double(vertex[0]), odd_double(vertex[1]), odd_double(vertex[2])};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) terms[k][j] = {odd_double(at.rotation[3 * k + j]), of_vertex[j]};
        terms[k][3] = {odd_double(at.translation[static_cast<int>(k)]), one};
    }
    return terms;
}

/// The range of the bits of terms that are not 0.
class term_range {
public:
    inline void note(const product_of_doubles& term) noexcept {
        if (term.magnitude == 0) return;
        unit_ = std::min(unit_, term.exponent);
        end_ = std::max(end_, term.end());
    }
    inline void note(const corner_terms& terms) noexcept {
        for (const auto& along : terms)
            for (const product_of_doubles& term : along) note(term);
    }

    /// 2^unit divides every term; 0 if there is none.
    [[nodiscard]] inline int unit() const noexcept { return end_ < unit_ ? 0 : unit_; }
    /// Every term is below 2^(unit + bits).
    [[nodiscard]] inline int bits() const noexcept { return end_ < unit_ ? 0 : end_ - unit_; }

private:
    int unit_ = std::numeric_limits<int>::max();
    int end_ = std::numeric_limits<int>::min();
};

}  // namespace aabb
