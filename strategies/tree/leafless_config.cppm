export module aabb.tree.leafless_config;

export import aabb.local_detection;
import aabb.std;
export import aabb.tree.sibling_planes;

export namespace aabb {

/// The common part of layouts without leaves: at a leaf the cursor carries the parent's box, or the triangle's own.
class leafless_layout {
public:
    static constexpr std::array leaves_out{absence::triangle_boxes};
    static constexpr bool has_leaf_boxes = false;

    struct config {
        leaf_test_choice leaf_test = leaf_test_choice::none;

        /// Möller's original test may reject a touching pair.
        [[nodiscard]] constexpr bool is_exact() const noexcept {
            return leaf_test != leaf_test_choice::moller_triangle_box;
        }
    };
    static constexpr std::tuple parameters{choice_parameter{
        "leaf_test", &config::leaf_test,
        std::array<std::string_view, 4>{"none", "triangle_box", "triangle_aabb", "moller_triangle_box"},
        "what replaces the test of a leaf's box: nothing, the triangle against the other box, or the triangle's own "
        "box; "
        "moller_triangle_box is Möller's original triangle-box test, inexact"}};
    using cursor = box_cursor;

    leafless_layout() = default;
    explicit leafless_layout(const config& c) : leaf_test_(c.leaf_test) {}
    [[nodiscard]] static inline bool is_leaf(const cursor& at) noexcept { return at.is_leaf(); }
    [[nodiscard]] static inline const box& bounds(const cursor& at) noexcept { return at.bounds; }
    [[nodiscard]] static inline std::uint32_t triangle(const cursor& at) noexcept { return at.leaf(); }
    [[nodiscard]] inline leaf_test_choice leaf_test() const noexcept { return leaf_test_; }

protected:
    [[nodiscard]] inline cursor leaf_cursor(std::uint32_t triangle, const box& parent, const mesh& m) const noexcept {
        return {leaf_test_ == leaf_test_choice::triangle_aabb ? bounds_of(m.triangle(triangle)) : parent,
                triangle | cursor::leaf_bit};
    }

private:
    leaf_test_choice leaf_test_ = leaf_test_choice::none;
};

}  // namespace aabb
