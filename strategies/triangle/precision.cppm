export module aabb.triangle.precision;

export import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// The floating-point type of an inexact test.
enum class precision_choice : std::uint8_t { float32, float64 };

template <precision_choice Usual>
struct precision_config {
    precision_choice precision = Usual;
};

/// The base of inexact tests with a configurable precision.
template <precision_choice Usual>
class test_in_precision {
public:
    static constexpr bool exact = false;

    using config = precision_config<Usual>;
    static constexpr auto parameters = std::make_tuple(
        choice_parameter{"precision", &config::precision, std::array<std::string_view, 2>{"float", "double"},
                         "precision of the arithmetic; float rounds input in double"});

    test_in_precision() = default;
    explicit test_in_precision(const config& c) : config_(c) {}

protected:
    /// Calls `test` with both triangles converted to the configured precision.
    template <class Real, class Test>
    [[nodiscard]] inline bool in_precision(const triangle3<Real>& s, const triangle3<Real>& t, Test test) const {
        if (config_.precision == precision_choice::float32) return test(in_float(s), in_float(t));
        return test(in_double(s), in_double(t));
    }

private:
    config config_;
};

}  // namespace aabb
