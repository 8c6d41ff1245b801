export module aabb.wide_tree.level_steps;

import aabb.base;
import aabb.std;

export namespace aabb {

/// The way down from the roots of two trees to their leaves: the higher of two nodes is opened first, both where they
/// are as high. At the last step both are leaves.
class level_steps {
public:
    /// How many levels of nodes lie below and with the nodes of a pair: 0 for leaves.
    struct heights {
        std::size_t a;
        std::size_t b;

        friend bool operator==(const heights&, const heights&) = default;
    };

    void begin(heights roots) {
        if (!steps_.empty() && steps_.front() == roots) return;
        // All memory first: what is there when it runs out must be whole.
        steps_.reserve(std::max(roots.a, roots.b) + 1);
        steps_.assign(1, roots);
        for (heights now = roots; now.a > 0 || now.b > 0; steps_.push_back(now)) {
            const std::size_t higher = std::max(now.a, now.b);
            if (now.a == higher) --now.a;
            if (now.b == higher) --now.b;
        }
    }

    [[nodiscard]] inline std::size_t size() const noexcept { return steps_.size(); }
    [[nodiscard]] inline const heights& operator[](std::size_t step) const noexcept { return steps_[step]; }
    [[nodiscard]] inline bool opens_a(std::size_t step) const noexcept { return steps_[step + 1].a < steps_[step].a; }
    [[nodiscard]] inline bool opens_b(std::size_t step) const noexcept { return steps_[step + 1].b < steps_[step].b; }

    /// Of pairs of children, bit 8 j + i for child i of A's node and j of B's, those that are opened at the next step:
    /// a node that is not opened stands at the place of its first child.
    [[nodiscard]] inline std::uint64_t opened(std::size_t step, std::uint64_t met) const noexcept {
        if (!opens_a(step)) {
            met |= met >> 4U;
            met |= met >> 2U;
            met |= met >> 1U;
            met &= 0x0101010101010101;
        }
        if (!opens_b(step)) {
            met |= met >> 32U;
            met |= met >> 16U;
            met |= met >> 8U;
            met &= 0xff;
        }
        return met;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(steps_); }

private:
    std::vector<heights> steps_;
};

}  // namespace aabb
