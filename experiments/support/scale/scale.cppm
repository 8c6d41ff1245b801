/// Computes the range of an axis and its ticks.
export module aabblab.scale;

import aabb.std;

export namespace aabblab {

struct tick {
    double at;
    std::string label;    ///< empty for a small tick
    std::string power{};  ///< superscript after the label: "6" in 10^6
};

struct scale {
    double from, to;
    bool logarithmic;
    std::vector<tick> ticks{};
    bool named = false;  ///< ticks have names, not numbers

    /// 0 at the left or lower end, 1 at the other.
    [[nodiscard]] double place(double value) const;
};

enum class scale_end : unsigned char {
    near_values,  ///< slightly beyond the values
    on_ticks,     ///< on a tick if the axis is linear, and at 0 if that is near
};

/// The scale of an axis that shows `least` to `greatest`, which may be equal, and must be positive if logarithmic.
[[nodiscard]] scale scale_of(double least, double greatest, bool logarithmic, scale_end end);

/// The smallest step of 1, 2 or 5 times a power of ten of which at most `most` fit into the span.
[[nodiscard]] double round_step(double span, double most);
/// The multiples of the step in a range; ends that are multiples up to rounding are included.
[[nodiscard]] std::vector<double> round_values(double from, double to, double step);

}  // namespace aabblab
