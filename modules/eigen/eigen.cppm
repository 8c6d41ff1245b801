/// Conversions of poses, points, boxes and meshes to and from Eigen. The module names no Eigen types, since their
/// alignment and vector width depend on the compiler options of the includer, which a module would impose on all
/// importers. It therefore requires no alignment, and users without Eigen do not need the library.
export module aabb.eigen;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A motion in three dimensions: Eigen::Isometry3d, Eigen::Affine3d, Eigen::AffineCompact3f, aligned or not. Projective
/// transforms are excluded, since a pose cannot represent their last row.
template <class T>
concept EigenTransform = requires(const T& from, T& to) {
    requires(int{T::Dim} == 3 && int{T::Mode} < 32);  // Eigen::Projective is 32
    { from.linear()(0, 0) } -> std::convertible_to<double>;
    { from.translation()(0) } -> std::convertible_to<double>;
    to.linear()(0, 0) = from.linear()(0, 0);
    to.translation()(0) = from.translation()(0);
};

/// Converts an Eigen transform to a pose, whose matrix is stored by rows.
/// @throws input_error if the transform is singular (`require_full_rank`)
template <EigenTransform T>
[[nodiscard]] inline pose to_pose(const T& transform) {
    pose p;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) p.rotation[static_cast<std::size_t>(3 * i + j)] = transform.linear()(i, j);
        p.translation[i] = transform.translation()(i);
    }
    require_full_rank(p);
    return p;
}

/// Converts a pose to an Eigen transform: `to_transform<Eigen::Isometry3d>(p)`. The pose's matrix is stored by rows.
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

/// A matrix with direct access and `Rows` elements per column (or per row, if it is row-major): Eigen::Matrix3Xf,
/// Eigen::Map of it, Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>.
template <class Matrix, int Rows>
concept EigenColumns = requires(const Matrix& m) {
    requires(int{Matrix::IsRowMajor ? Matrix::ColsAtCompileTime : Matrix::RowsAtCompileTime} == Rows);
    { *m.data() } -> std::convertible_to<typename Matrix::Scalar>;
    { m.outerStride() } -> std::convertible_to<std::ptrdiff_t>;
};

}  // namespace aabb

namespace aabb::detail {

// The scalar type of a point, triangle or box: overloads without a definition, which `scalar_of` asks for their type.
template <class Element>
typename Element::value_type scalar_of_element(const Element& of);
template <class Real>
Real scalar_of_element(const vec3<Real>& of);
float scalar_of_element(const box& of);
double scalar_of_element(const boxd& of);
template <class Element>
using scalar_of = decltype(scalar_of_element(std::declval<const Element&>()));

/// Views each column of a matrix (row, if it is row-major) as a point or box of the same scalars, without a copy.
/// @throws input_error if the columns are not contiguous
template <class Element, class Matrix>
[[nodiscard]] inline std::span<const Element> columns_as(const Matrix& m) {
    static_assert(std::same_as<typename Matrix::Scalar, scalar_of<Element>>);
    constexpr std::ptrdiff_t scalars = sizeof(Element) / sizeof(typename Matrix::Scalar);  // per element
    const auto count = static_cast<std::size_t>(Matrix::IsRowMajor ? m.rows() : m.cols());
    if (count > 1 && (m.innerStride() != 1 || m.outerStride() != scalars))
        throw input_error("the matrix is not contiguous in memory");
    return {reinterpret_cast<const Element*>(m.data()), count};
}

}  // namespace aabb::detail

export namespace aabb {

/// An Eigen view of a vector of points, triangles or boxes, one per column, or per row of a row-major matrix:
/// `map_over<Eigen::Map<Eigen::Matrix3Xf>>(mesh.vertices)`, which are floats in the mesh's frame. The column of a box
/// contains its lower ends, then its upper ones.
/// @tparam Map map of a matrix of the elements' numbers, const if the elements are const
template <class Map, class Elements>
[[nodiscard]] inline Map map_over(Elements& elements) {
    using element = typename Elements::value_type;
    using scalar = detail::scalar_of<element>;
    constexpr std::size_t rows = sizeof(element) / sizeof(scalar);
    static_assert(EigenColumns<Map, int{rows}> && std::same_as<typename Map::Scalar, scalar>);
    // A pointer of the type that `Map` takes: an element is an array of numbers, or begins with one.
    auto* const numbers = reinterpret_cast<decltype(Map(nullptr, rows, 0).data())>(elements.data());
    const auto count = static_cast<std::ptrdiff_t>(elements.size());
    if constexpr (Map::IsRowMajor)
        return Map(numbers, count, rows);
    else
        return Map(numbers, rows, count);
}

/// Views the points in a user's matrix without a copy.
/// @throws input_error if they are not contiguous
template <EigenColumns<3> Matrix>
[[nodiscard]] inline std::span<const vec3<typename Matrix::Scalar>> points_in(const Matrix& m) {
    return detail::columns_as<vec3<typename Matrix::Scalar>>(m);
}

/// Views the boxes in a user's matrix of floats or doubles, lower ends above upper ones, without a copy.
/// @throws input_error if they are not contiguous
template <EigenColumns<6> Matrix>
[[nodiscard]] inline auto boxes_in(const Matrix& m) {
    return detail::columns_as<std::conditional_t<std::same_as<typename Matrix::Scalar, float>, box, boxd>>(m);
}

/// Copies a mesh from matrices of points and triangles, one per column, or one per row if there are three columns and
/// not three rows. Vertex indices start at 0.
/// @throws input_error as `require_valid`
template <class Vertices, class Triangles>
[[nodiscard]] inline mesh to_mesh(const Vertices& vertices, const Triangles& triangles)
    requires requires {
        { vertices(0, 0) } -> std::convertible_to<double>;
        { triangles(0, 0) } -> std::convertible_to<std::int64_t>;
    }
{
    // Calls `take(at)` for each point or triangle of a matrix; `at(k)` is its coordinate or corner k.
    const auto for_each = [](const auto& m, auto take) {
        using matrix = std::remove_cvref_t<decltype(m)>;
        constexpr bool in_columns = int{matrix::RowsAtCompileTime} == 3;
        static_assert(in_columns || int{matrix::ColsAtCompileTime} == 3, "three rows, or three columns");
        const std::ptrdiff_t count = in_columns ? m.cols() : m.rows();
        for (std::ptrdiff_t i = 0; i < count; ++i)
            take([&](std::ptrdiff_t k) { return in_columns ? m(k, i) : m(i, k); });
    };
    mesh result;
    for_each(triangles, [&](auto at) {
        const auto corner = [&](std::ptrdiff_t k) {
            const std::int64_t v = at(k);
            if (v < 0 || v > std::numeric_limits<std::uint32_t>::max())
                throw input_error("triangle " + std::to_string(result.triangles.size()) + " uses vertex " +
                                  std::to_string(v) + ", which cannot exist");
            return static_cast<std::uint32_t>(v);
        };
        result.triangles.push_back({corner(0), corner(1), corner(2)});
    });
    std::vector<vec3d> points;
    for_each(vertices, [&](auto at) { points.push_back({double(at(0)), double(at(1)), double(at(2))}); });
    set_vertices(result, std::move(points));
    require_valid(result);
    return result;
}

}  // namespace aabb
