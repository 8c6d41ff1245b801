#include <Eigen/Geometry>

#include "../random_poses.hpp"

using namespace aabb;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::MessageMatches;

namespace {

using unaligned_isometry = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;
using row_major_affine = Eigen::Transform<double, 3, Eigen::Affine, Eigen::RowMajor>;

static_assert(EigenTransform<Eigen::Isometry3d> && EigenTransform<Eigen::Affine3d> &&
              EigenTransform<Eigen::AffineCompact3f> && EigenTransform<unaligned_isometry>);
static_assert(!EigenTransform<Eigen::Projective3d> && !EigenTransform<Eigen::Isometry2d> &&
              !EigenTransform<Eigen::Matrix4d> && !EigenTransform<pose>);

using indices = Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic>;
using bounds = Eigen::Matrix<float, 6, Eigen::Dynamic>;
using rows_of_points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

pose any_pose() {
    return turned_by({0.5, 1, -2, 0.25}, {3, -4, 5});
}

const mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

template <class T>
void require_same_motion() {
    const pose p = any_pose();
    const T transform = to_transform<T>(p);
    REQUIRE(to_pose(transform) == p);
    const Eigen::Vector3d image = transform * Eigen::Vector3d(1, 2, 3);
    for (int i = 0; i < 3; ++i) {
        const auto row = static_cast<std::size_t>(3 * i);
        const double expected = p.rotation[row] + 2 * p.rotation[row + 1] + 3 * p.rotation[row + 2] + p.translation[i];
        REQUIRE(std::abs(image[i] - expected) < 1e-14);
    }
}

}  // namespace

TEST_CASE("a pose is the same motion as its Eigen transform") {
    require_same_motion<Eigen::Isometry3d>();
    require_same_motion<Eigen::Affine3d>();
    require_same_motion<Eigen::AffineCompact3d>();
    require_same_motion<unaligned_isometry>();
    require_same_motion<row_major_affine>();
}

TEST_CASE("a transform of floats becomes a pose up to rounding") {
    const pose p = to_pose(to_transform<Eigen::Isometry3f>(any_pose()));
    for (std::size_t k = 0; k < 9; ++k) REQUIRE(p.rotation[k] == double{static_cast<float>(any_pose().rotation[k])});
}

TEST_CASE("a singular transform is rejected") {
    const auto rejects = [](const Eigen::Affine3d& transform, const char* sentence) {
        REQUIRE_THROWS_MATCHES(to_pose(transform), input_error, MessageMatches(ContainsSubstring(sentence)));
    };
    rejects(Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, 0.0)), "singular");
    rejects(Eigen::Affine3d(Eigen::Translation3d(0, NAN, 0)), "a translation that is not finite");
}

TEST_CASE("Eigen maps the library's points, triangles and boxes in place") {
    mesh m = tetrahedron;
    auto points = map_over<Eigen::Map<Eigen::Matrix3Xf>>(m.vertices);
    REQUIRE(points.cols() == 4);
    points.col(2) *= 2;
    REQUIRE(m.vertices[2] == vec3f{0, 4, 0});
    const auto rows = map_over<Eigen::Map<rows_of_points>>(m.vertices);
    REQUIRE(rows.rows() == 4);
    REQUIRE(rows.row(3).z() == 3);
    const auto corners = map_over<Eigen::Map<const indices>>(tetrahedron.triangles);
    REQUIRE(corners(1, 3) == 2);
    const std::vector<box> boxes = {{{0, 1, 2}, {3, 4, 5}}, {{6, 7, 8}, {9, 10, 11}}};
    const auto ends = map_over<Eigen::Map<const bounds>>(boxes);
    REQUIRE(ends(0, 1) == 6);
    REQUIRE(ends(5, 1) == 11);
    std::vector<vec3f> empty;
    REQUIRE(map_over<Eigen::Map<Eigen::Matrix3Xf>>(empty).cols() == 0);
}

TEST_CASE("points_in and boxes_in refer to the user's memory, aligned or not") {
    std::array<float, 13> memory{};
    for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<float>(i);
    // One float off any alignment.
    const Eigen::Map<Eigen::Matrix3Xf> columns(memory.data() + 1, 3, 4);
    REQUIRE(points_in(columns).size() == 4);
    REQUIRE(points_in(columns)[3] == vec3f{10, 11, 12});
    REQUIRE(static_cast<const void*>(points_in(columns).data()) == memory.data() + 1);
    REQUIRE(points_in(Eigen::Map<const rows_of_points>(memory.data() + 1, 4, 3))[1] == vec3f{4, 5, 6});
    const Eigen::Map<const bounds> box_columns(memory.data() + 1, 6, 2);
    REQUIRE(boxes_in(box_columns)[1] == box{{7, 8, 9}, {10, 11, 12}});
    const Eigen::Map<Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> strided(memory.data(), 3, 3, Eigen::OuterStride<>(4));
    REQUIRE_THROWS_MATCHES(points_in(strided), input_error, MessageMatches(ContainsSubstring("not contiguous")));
    const Eigen::Map<Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> single(memory.data(), 3, 1, Eigen::OuterStride<>(4));
    REQUIRE(points_in(single).size() == 1);
}

TEST_CASE("a mesh is made from a user's matrices, with points in columns or rows") {
    const auto points = map_over<Eigen::Map<const Eigen::Matrix3Xf>>(tetrahedron.vertices);
    const auto corners = map_over<Eigen::Map<const indices>>(tetrahedron.triangles);
    const auto is_tetrahedron = [](const mesh& m) {
        return m.vertices == tetrahedron.vertices && m.triangles == tetrahedron.triangles;
    };
    REQUIRE(is_tetrahedron(to_mesh(points, corners)));
    const Eigen::MatrixX3d point_rows = points.transpose().cast<double>();
    const Eigen::MatrixX3i corner_rows = corners.transpose().cast<int>();
    REQUIRE(is_tetrahedron(to_mesh(point_rows, corner_rows)));
    Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3> invalid = corner_rows.cast<std::int64_t>();
    for (const std::int64_t index : {std::int64_t{-1}, (std::int64_t{1} << 32) + 1}) {
        invalid(2, 1) = index;
        REQUIRE_THROWS_MATCHES(
            to_mesh(point_rows, invalid), input_error,
            MessageMatches(ContainsSubstring("triangle 2 uses vertex " + std::to_string(index) + ", which")));
    }
}
