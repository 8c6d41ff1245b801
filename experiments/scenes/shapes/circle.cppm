/// Reproducible sine and cosine: libraries differ in the last digit, but additions and products do not.
module aabblab.scenes:circle;

import aabb.std;

namespace aabblab {

struct circle_point {
    double cos;
    double sin;
};

/// The point of the unit circle at `turns` turns from (1, 0), within 1e-15. The nearest quarter turn is applied last,
/// so that the Taylor series are of angles below an eighth of a turn, where they converge fast.
[[nodiscard]] inline circle_point on_circle(double turns) {
    constexpr double two_pi = 6.283185307179586;
    const double quarters = std::floor(4 * turns + 0.5);
    const double angle = (turns - quarters / 4) * two_pi;  // at most π/4 from 0
    circle_point p{1, angle};
    double term = angle;
    // Terms angle^n / n!, even n for the cosine and odd n for the sine, until they are below 1e-17.
    for (int n = 2; n < 18; ++n) {
        term *= angle / n;
        const bool subtracted = n % 4 >= 2;
        (n % 2 == 0 ? p.cos : p.sin) += subtracted ? -term : term;
    }
    const double quarter = quarters - 4 * std::floor(quarters / 4);  // 0 to 3
    if (quarter == 1) return {-p.sin, p.cos};
    if (quarter == 2) return {-p.cos, -p.sin};
    if (quarter == 3) return {p.sin, -p.cos};
    return p;
}

}  // namespace aabblab
