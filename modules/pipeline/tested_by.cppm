module;
#include <cassert>

export module aabb.pipeline:tested_by;

import aabb.std;
import :stage;

export namespace aabb {

/// A statically composed triangle test behind the run-time interface.
template <TrianglePolicy Triangle>
class tested_by final : public triangle_test {
public:
    explicit tested_by(Triangle triangle = {}) : triangle_(std::move(triangle)) {}

    [[nodiscard]] bool intersects(const triangle3f& s, const triangle3f& t) const override {
        require_ieee_arithmetic();
        return triangle_.intersects(s, t);
    }
    [[nodiscard]] bool intersects(const triangle3d& s, const triangle3d& t) const override {
        require_ieee_arithmetic();
        if constexpr (DoubleTrianglePolicy<Triangle>)
            return triangle_.intersects(s, t);
        else
            reject_doubles();
    }
    [[nodiscard]] bool takes_double() const override { return DoubleTrianglePolicy<Triangle>; }
    void intersect(std::span<const triangle_pair<float>> pairs, std::span<std::uint8_t> results) const override {
        test_pairs(pairs, results);
    }
    void intersect(std::span<const triangle_pair<double>> pairs, std::span<std::uint8_t> results) const override {
        if constexpr (DoubleTrianglePolicy<Triangle>)
            test_pairs(pairs, results);
        else
            reject_doubles();
    }

    /// Constructs the intersection of two triangles.
    /// @throws input_error if the strategy `Triangle` only decides whether they intersect
    [[nodiscard]] triangle_intersection intersection(const triangle3d& s, const triangle3d& t) const override {
        require_ieee_arithmetic();
        if constexpr (ConstructingTrianglePolicy<Triangle>)
            return triangle_.intersection(s, t);
        else
            throw input_error(std::string(Triangle::name) +
                              " decides whether triangles intersect, but does not construct their intersection");
    }
    [[nodiscard]] bool constructs() const override { return ConstructingTrianglePolicy<Triangle>; }

private:
    template <class Real>
    void test_pairs(std::span<const triangle_pair<Real>> pairs, std::span<std::uint8_t> results) const {
        assert(pairs.size() == results.size());
        require_ieee_arithmetic();
        for (std::size_t i = 0; i < pairs.size(); ++i)
            results[i] = static_cast<std::uint8_t>(triangle_.intersects(pairs[i].a, pairs[i].b));
    }

    [[noreturn]] static void reject_doubles() {
        throw input_error(std::string(Triangle::name) + " tests triangles of floats only");
    }

    [[no_unique_address]] Triangle triangle_;
};

}  // namespace aabb
