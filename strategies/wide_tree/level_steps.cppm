export module aabb.wide_tree.level_steps;

import aabb.base;
import aabb.std;

export namespace aabb {

/// The steps of a simultaneous descent from the roots of two trees to their leaves: each step opens the higher of two
/// nodes, or both if they have equal height. At the last step both are leaves.
class level_steps {
public:
    /// The heights of a pair of nodes: 0 for leaves.
    struct heights {
        std::size_t a;
        std::size_t b;

        friend bool operator==(const heights&, const heights&) = default;
    };

    /// Lists the heights from the roots to two leaves: each step opens the higher node, or both of equal height.
    void begin(heights roots) {
        if (!steps_.empty() && steps_.front() == roots) return;
        // Reserves first, so that a failed allocation leaves the old steps intact.
        steps_.reserve(std::max(roots.a, roots.b) + 1);
        steps_.assign(1, roots);
        for (heights current = roots; current.a > 0 || current.b > 0; steps_.push_back(current)) {
            const std::size_t higher = std::max(current.a, current.b);
            if (current.a == higher) --current.a;
            if (current.b == higher) --current.b;
        }
    }

    [[nodiscard]] inline std::size_t size() const noexcept { return steps_.size(); }
    [[nodiscard]] inline const heights& operator[](std::size_t step) const noexcept { return steps_[step]; }
    [[nodiscard]] inline bool opens_a(std::size_t step) const noexcept { return steps_[step + 1].a < steps_[step].a; }
    [[nodiscard]] inline bool opens_b(std::size_t step) const noexcept { return steps_[step + 1].b < steps_[step].b; }

    /// Maps overlapping pairs of children (bit 8 j + i for child i of A's node and j of B's) to the pairs that the next
    /// step opens: a node that is not opened takes the place of its first child.
    [[nodiscard]] inline std::uint64_t pairs_to_open(std::size_t step, std::uint64_t mask) const noexcept {
        if (!opens_a(step)) {  // collects each row of eight bits in its first bit: i becomes 0
            mask |= mask >> 4U;
            mask |= mask >> 2U;
            mask |= mask >> 1U;
            mask &= 0x0101010101010101;
        }
        if (!opens_b(step)) {  // collects all rows in the first one: j becomes 0
            mask |= mask >> 32U;
            mask |= mask >> 16U;
            mask |= mask >> 8U;
            mask &= 0xff;
        }
        return mask;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(steps_); }

private:
    std::vector<heights> steps_;
};

}  // namespace aabb
