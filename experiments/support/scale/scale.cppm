/// The range of an axis and its ticks.
export module aabblab.scale;

import aabb.std;

export namespace aabblab {

struct tick {
    double at;
    std::string label;    ///< empty for a small tick
    std::string power{};  ///< raised behind it: "6" of a million written as a power of ten
};

struct scale {
    double from;
    double to;
    bool logarithmic;
    std::vector<tick> ticks{};
    bool named = false;  ///< ticks have names, not numbers

    /// 0 at the left or lower end, 1 at the other.
    [[nodiscard]] double place(double value) const;
};

enum class scale_end : unsigned char {
    near_values,  ///< shortly beyond the values
    on_ticks,     ///< where an axis is linear, on a tick, and at 0 if that is not far
};

/// Of an axis that shows all from `least` to `greatest`, which may be equal; both are positive where it is logarithmic.
[[nodiscard]] scale scale_of(double least, double greatest, bool logarithmic, scale_end end);

/// 1, 2 or 5 times a power of ten, so that at most so many of them fit into the span.
[[nodiscard]] double round_step(double span, double most);
/// The multiples of the step in a range, its ends among them, as far as rounding tells them apart.
[[nodiscard]] std::vector<double> round_values(double from, double to, double step);

}  // namespace aabblab
