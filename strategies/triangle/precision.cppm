export module aabb.triangle.precision;

import aabb.geometry;
import aabb.policy;
import aabb.std;

export namespace aabb {

/// The numbers that an inexact test computes with.
enum class precision_choice : std::uint8_t { float32, float64 };

/// The parameter `precision`.
template <class Config>
[[nodiscard]] constexpr auto precision_parameter(precision_choice Config::* field) {
    return choice_parameter{"precision", field, std::array<std::string_view, 2>{"float", "double"},
                            "what it computes in; float rounds doubles that it is given"};
}

/// Calls `test` with both triangles in that precision.
template <class Real, class Test>
[[nodiscard]] inline bool in_precision(precision_choice precision, const triangle3<Real>& s, const triangle3<Real>& t,
                                       Test test) {
    if (precision == precision_choice::float32) return test(in_float(s), in_float(t));
    return test(in_double(s), in_double(t));
}

}  // namespace aabb
