/// Poses, points, boxes and meshes to and from Eigen. No type of Eigen's is named here: how those are aligned and how
/// wide their vectors are follows from the options of whoever includes them, and a module file that held them would ask
/// these options of everybody who imports it. So it asks for no alignment, and who does not use Eigen needs none.
export module aabb.eigen;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A motion in three dimensions: Eigen::Isometry3d, Eigen::Affine3d, Eigen::AffineCompact3f, aligned or not. A
/// projective one has a row that a pose has no place for.
template <class T>
concept EigenTransform = requires(const T& from, T& to) {
    requires int { T::Dim }
    == 3 && int{T::Mode} < 32;  // Eigen::Projective
    { from.linear()(0, 0) } -> std::convertible_to<double>;
    { from.translation()(0) } -> std::convertible_to<double>;
    to.linear()(0, 0) = from.linear()(0, 0);
    to.translation()(0) = from.translation()(0);
};

/// @throws input_error where the transform is not rigid, as an affine one need not be (`require_rigid`).
template <EigenTransform T>
[[nodiscard]] inline pose to_pose(const T& transform) {
    pose p;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) p.rotation[static_cast<std::size_t>(3 * i + j)] = transform.linear()(i, j);
        p.translation[i] = transform.translation()(i);
    }
    require_rigid(p);
    return p;
}

/// `to_transform<Eigen::Isometry3d>(p)`
template <EigenTransform T>
[[nodiscard]] inline T to_transform(const pose& p) {
    using scalar = typename T::Scalar;
    T transform;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            transform.linear()(i, j) = static_cast<scalar>(p.rotation[static_cast<std::size_t>(3 * i + j)]);
        transform.translation()(i) = static_cast<scalar>(p.translation[i]);
    }
    return transform;
}

/// Numbers side by side in memory, `Rows` a column (or a row, where the matrix stores those one after the other):
/// Eigen::Matrix3Xf, Eigen::Map of it, Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>.
template <class Matrix, int Rows>
concept EigenColumns = requires(const Matrix& m) {
    requires int { Matrix::IsRowMajor ? Matrix::ColsAtCompileTime : Matrix::RowsAtCompileTime }
    == Rows;
    { *m.data() } -> std::convertible_to<typename Matrix::Scalar>;
    { m.outerStride() } -> std::convertible_to<std::ptrdiff_t>;
};

}  // namespace aabb

namespace aabb::detail {

template <class Element>
typename Element::value_type scalar_in(const Element& of);
template <class Real>
Real scalar_in(const vec3<Real>& of);
float scalar_in(const box& of);
template <class Element>
using scalar_of = decltype(scalar_in(std::declval<const Element&>()));

/// The columns of a matrix as the elements of our own that are laid out like them.
template <class Element, class Matrix>
[[nodiscard]] inline std::span<const Element> elements_in(const Matrix& m) {
    static_assert(std::same_as<typename Matrix::Scalar, scalar_of<Element>>);
    constexpr std::ptrdiff_t rows = sizeof(Element) / sizeof(typename Matrix::Scalar);
    const auto count = static_cast<std::size_t>(Matrix::IsRowMajor ? m.rows() : m.cols());
    if (count > 1 && (m.innerStride() != 1 || m.outerStride() != rows))
        throw input_error("the numbers of the matrix do not stand side by side in memory");
    return {reinterpret_cast<const Element*>(m.data()), count};
}

}  // namespace aabb::detail

export namespace aabb {

/// Eigen's view of points, triangles or boxes, one a column: `map_over<Eigen::Map<Eigen::Matrix3Xf>>(mesh.vertices)`. A
/// box is its lower ends, then its upper ones.
/// @tparam Map of a matrix of the elements' numbers, which is const where the elements are
template <class Map, class Elements>
[[nodiscard]] inline Map map_over(Elements& elements) {
    using element = typename Elements::value_type;
    using scalar = detail::scalar_of<element>;
    constexpr std::size_t rows = sizeof(element) / sizeof(scalar);
    static_assert(EigenColumns<Map, int{rows}> && std::same_as<typename Map::Scalar, scalar>);
    // Found by its first member, which is an array of them or begins with one.
    auto* const numbers = reinterpret_cast<decltype(Map(nullptr, rows, 0).data())>(elements.data());
    const auto count = static_cast<std::ptrdiff_t>(elements.size());
    if constexpr (Map::IsRowMajor)
        return Map(numbers, count, rows);
    else
        return Map(numbers, rows, count);
}

/// The points in a user's matrix, which are not copied.
/// @throws input_error where others stand between them.
template <EigenColumns<3> Matrix>
[[nodiscard]] inline std::span<const vec3<typename Matrix::Scalar>> points_in(const Matrix& m) {
    return detail::elements_in<vec3<typename Matrix::Scalar>>(m);
}

/// The boxes in a user's matrix of floats, lower ends above upper ones, which are not copied.
/// @throws input_error where others stand between them.
template <EigenColumns<6> Matrix>
[[nodiscard]] inline std::span<const box> boxes_in(const Matrix& m) {
    return detail::elements_in<box>(m);
}

/// A mesh of the user's points and triangles, one a column, or one a row where there are three columns and not three
/// rows. Coordinates are rounded to float; the corners of triangles are counted from 0.
/// @throws input_error as `require_valid`.
template <class Vertices, class Triangles>
    requires requires(const Vertices& v, const Triangles& t) {
        { v(0, 0) } -> std::convertible_to<float>;
        { t(0, 0) } -> std::convertible_to<std::int64_t>;
    }
[[nodiscard]] inline mesh to_mesh(const Vertices& vertices, const Triangles& triangles) {
    const auto for_each = [](const auto& m, auto take) {
        using matrix = std::remove_cvref_t<decltype(m)>;
        constexpr bool in_columns = int{matrix::RowsAtCompileTime} == 3;
        static_assert(in_columns || int{matrix::ColsAtCompileTime} == 3, "three rows, or three columns");
        const std::ptrdiff_t count = in_columns ? m.cols() : m.rows();
        for (std::ptrdiff_t i = 0; i < count; ++i)
            take([&](std::ptrdiff_t k) { return in_columns ? m(k, i) : m(i, k); });
    };
    mesh made;
    for_each(vertices, [&](auto at) {
        made.vertices.push_back({static_cast<float>(at(0)), static_cast<float>(at(1)), static_cast<float>(at(2))});
    });
    for_each(triangles, [&](auto at) {
        const auto corner = [&](std::ptrdiff_t k) {
            const std::int64_t v = at(k);
            if (v < 0 || v > std::numeric_limits<std::uint32_t>::max())
                throw input_error("triangle " + std::to_string(made.triangles.size()) + " uses vertex " +
                                  std::to_string(v) + ", which there cannot be");
            return static_cast<std::uint32_t>(v);
        };
        made.triangles.push_back({corner(0), corner(1), corner(2)});
    });
    require_valid(made);
    return made;
}

}  // namespace aabb
