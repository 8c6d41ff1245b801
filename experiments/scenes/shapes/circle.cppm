/// Reproducible sine and cosine: libraries differ in the last digit, but additions and products do not.
module aabblab.scenes:circle;

import aabb.std;

namespace aabblab {

struct circle_point {
    double cos;
    double sin;
};

/// The point of the unit circle at `turns` turns from (1, 0), within 1e-15.
[[nodiscard]] inline circle_point on_circle(double turns) {
    constexpr double two_pi = 6.283185307179586;
    const double quarter = std::floor(4 * turns + 0.5);
    const double x = (turns - quarter / 4) * two_pi;  // at most an eighth of a turn from 0
    circle_point p{1, x};
    double power = x;
    // The Taylor series, until terms are below 1e-17.
    for (int n = 2; n < 18; ++n) {
        power *= x / n;
        const bool subtracted = n % 4 >= 2;
        (n % 2 == 0 ? p.cos : p.sin) += subtracted ? -power : power;
    }
    const double turn = quarter - 4 * std::floor(quarter / 4);
    if (turn == 1) return {-p.sin, p.cos};
    if (turn == 2) return {-p.cos, -p.sin};
    if (turn == 3) return {p.sin, -p.cos};
    return p;
}

}  // namespace aabblab
