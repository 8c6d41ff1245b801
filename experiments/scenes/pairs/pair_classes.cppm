/// Generated pairs of triangles, in classes of relative position, size and location.
export module aabblab.scenes:pair_classes;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// A class as `aabblab list` shows it.
struct pair_class_info {
    std::string_view name;  ///< "random", "near_coplanar", …
    std::string_view summary;
};
[[nodiscard]] std::span<const pair_class_info> pair_classes();

/// Generates the pairs of a class; a seed gives the same pairs on every machine.
/// @tparam Real float or double
template <class Real>
class pair_source {
public:
    /// @throws aabb::input_error on an unknown class, with the nearest one.
    pair_source(std::string_view pair_class, std::uint64_t seed);
    ~pair_source();

    void next(std::span<aabb::triangle_pair<Real>> pairs);

private:
    struct state;
    std::unique_ptr<state> state_;
};

}  // namespace aabblab
