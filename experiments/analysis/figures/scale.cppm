module;
#include <string>
#include <vector>

/// The range of an axis and its ticks. They are chosen here, not by gnuplot, because its own choice leaves a
/// logarithmic axis of less than a decade with one number or none.
module aabblab.figures:scale;

namespace aabblab {

struct tick {
    double at;
    std::string label;  ///< in gnuplot's enhanced text; empty for a small tick
};

struct scale {
    double from;
    double to;
    bool logarithmic;
    std::vector<tick> ticks;
    bool named = false;  ///< ticks have names, not numbers, which are no enhanced text

    /// 0 at the left or lower end, 1 at the other.
    [[nodiscard]] double place(double value) const;
};

enum class scale_end : unsigned char {
    near_values,  ///< shortly beyond the values
    on_ticks,     ///< where an axis is linear, on a tick, and at 0 if that is not far
};

/// Of an axis that shows all from `least` to `greatest`, which may be equal; both are positive where it is logarithmic.
[[nodiscard]] scale scale_of(double least, double greatest, bool logarithmic, scale_end end);

}  // namespace aabblab
