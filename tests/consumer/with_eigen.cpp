// Poses, points and meshes of Eigen's. What it is compiled with aligns Eigen's types as no other program here does.
#include <Eigen/Geometry>
#include <cstdio>
#include <vector>

import aabb;
import aabb.build.median;
import aabb.partition.columns;
import aabb.sort.bucket;
import aabb.sweep.simd;
import aabb.tree.implicit;
import aabb.triangle.exact;

using search = aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep>;
using detection = aabb::mesh_detection<aabb::median_build, aabb::implicit_tree, aabb::exact_triangle>;

int main() {
    Eigen::MatrixX3d vertices(4, 3);
    Eigen::MatrixX3i triangles(4, 3);
    vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
    aabb::detector<search, detection> detector({aabb::to_mesh(vertices, triangles)}, {0, 0});
    std::vector<aabb::pose> poses(2);
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    for (int frame = 0; frame < 3; ++frame) {
        moved.translation() = Eigen::Vector3d(0.5 * frame, 0.25, 0.25);
        poses[1] = aabb::to_pose(moved);
        std::printf("frame %d: %zu contacts\n", frame, detector.contacts(poses).size());
    }
    const Eigen::Affine3d back = aabb::to_transform<Eigen::Affine3d>(aabb::to_pose(moved));
    const Eigen::Matrix<float, 6, 2> ends =
        (Eigen::Matrix<float, 6, 2>() << 0, 1, 0, 0, 0, 0, 2, 3, 1, 1, 1, 1).finished();
    std::printf("x %g, %zu boxes\n", back.translation().x(), aabb::boxes_in(ends).size());
}
