// Meshes, composed statically, with as few includes as it can have: every tree and every triangle test must compile,
// and what is exact must give the same answer whatever this is compiled with.
#include <cstdio>
#include <vector>

import aabb;
import aabb.build.median;
import aabb.tree.canonical;
import aabb.tree.compressed;
import aabb.tree.compressed_literal;
import aabb.tree.implicit;
import aabb.tree.leafless;
import aabb.tree.quantized;
import aabb.tree.shared_planes;
import aabb.triangle.devillers_guigue;
import aabb.triangle.exact;
import aabb.triangle.moller;
import aabb.triangle.moller_double;

#pragma clang fp reassociate(off) reciprocal(off)

namespace {

/// Small numbers, always the same.
unsigned next(unsigned& state) {
    state = state * 1664525U + 1013904223U;
    return state >> 24;
}

aabb::mesh scattered_triangles() {
    aabb::mesh m;
    unsigned state = 1;
    for (unsigned t = 0; t < 100; ++t) {
        const float x = static_cast<float>(next(state));
        const float y = static_cast<float>(next(state));
        const float z = static_cast<float>(next(state));
        for (unsigned corner = 0; corner < 3; ++corner)
            m.vertices.push_back({x + static_cast<float>(next(state)) / 4, y + static_cast<float>(next(state)) / 4,
                                  z + static_cast<float>(next(state)) / 4});
        m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return m;
}

/// The rotation of a quaternion of small whole numbers, moved so that the vertex comes to lie as near to the origin as
/// rounding lets it: what is left of it there is nothing but rounding.
aabb::pose pose_that_cancels(unsigned& state, const aabb::vec3f& vertex) {
    const double a = 1 + next(state) % 8;
    const double b = next(state) % 8;
    const double c = next(state) % 8;
    const double d = next(state) % 8;
    const double n = a * a + b * b + c * c + d * d;
    const double rows[9] = {
        a * a + b * b - c * c - d * d, 2 * (b * c - a * d),           2 * (b * d + a * c),
        2 * (b * c + a * d),           a * a - b * b + c * c - d * d, 2 * (c * d - a * b),
        2 * (b * d - a * c),           2 * (c * d + a * b),           a * a - b * b - c * c + d * d};
    aabb::pose p;
    for (int i = 0; i < 9; ++i) p.rotation.begin()[i] = rows[i] / n;
    for (int i = 0; i < 3; ++i)
        p.translation[i] = -(rows[3 * i] * vertex[0] + rows[3 * i + 1] * vertex[1] + rows[3 * i + 2] * vertex[2]) / n;
    return p;
}

/// Of all contacts of the mesh with itself at other poses.
template <class Tree, class Triangle>
void print_answer(const aabb::mesh& m) {
    const aabb::model<Tree> model(m, aabb::median_build());
    aabb::local_detection<Tree, Triangle> detection;
    unsigned state = 2;
    unsigned long contacts = 0;
    for (const aabb::vec3f& vertex : m.vertices) {
        std::vector<aabb::index_pair> pairs;
        detection.all_pairs(model, {}, model, pose_that_cancels(state, vertex), pairs);
        contacts += pairs.size();
        if (detection.count_pairs(model, {}, model, {}) == 0 || !detection.first_pair(model, {}, model, {}))
            std::printf("no contact with itself\n");
    }
    std::vector<aabb::index_pair> own;
    detection.self_pairs(model, own);
    std::printf("%s %s: %lu contacts, %zu of its own\n", Tree::name.data(), Triangle::name.data(), contacts,
                own.size());
}

/// Of the images of vertices, down to the last bit.
void print_images(const aabb::mesh& m) {
    unsigned state = 2;
    aabb::digest images;
    for (const aabb::vec3f& vertex : m.vertices) {
        const aabb::relative_pose to_a({}, pose_that_cancels(state, vertex), aabb::bounds_of(m));
        const aabb::vec3f image = to_a(vertex);
        std::vector<unsigned> bits;
        for (int k = 0; k < 3; ++k) bits.push_back(__builtin_bit_cast(unsigned, image[k]));
        images.add(bits);
    }
    std::printf("images: %s\n", images.text().c_str());
}

/// Triangles at one height, where they touch their neighbours, and nothing but rounding could tell them apart.
void print_touching() {
    for (const float z : {0.1F, 0.3F, 1.1F, 5.0F}) {
        aabb::mesh m;
        for (unsigned i = 0; i < 20; ++i)
            for (unsigned j = 0; j < 20; ++j) m.vertices.push_back({static_cast<float>(i), static_cast<float>(j), z});
        for (unsigned i = 0; i + 1 < 20; ++i)
            for (unsigned j = 0; j + 1 < 20; ++j) m.triangles.push_back({20 * i + j, 20 * i + j + 1, 20 * i + j + 20});
        const aabb::model<aabb::implicit_tree> model(m, aabb::median_build());
        aabb::local_detection<aabb::implicit_tree, aabb::exact_triangle> detection;
        std::printf("%llu touch\n", static_cast<unsigned long long>(detection.count_pairs(model, {}, model, {})));
    }
}

}  // namespace

int main() {
    const aabb::mesh m = scattered_triangles();
    try {
        print_images(m);
        print_answer<aabb::canonical_tree, aabb::exact_triangle>(m);
        print_answer<aabb::compressed_tree, aabb::exact_triangle>(m);
        print_answer<aabb::compressed_literal_tree, aabb::exact_triangle>(m);
        print_answer<aabb::implicit_tree, aabb::exact_triangle>(m);
        print_answer<aabb::leafless_tree, aabb::exact_triangle>(m);
        print_answer<aabb::quantized_tree, aabb::exact_triangle>(m);
        print_answer<aabb::shared_planes_tree, aabb::exact_triangle>(m);
        print_answer<aabb::canonical_tree, aabb::devillers_guigue_triangle>(m);
        print_answer<aabb::canonical_tree, aabb::moller_triangle>(m);
        print_answer<aabb::canonical_tree, aabb::moller_double_triangle>(m);
        print_touching();
    } catch (const aabb::input_error& error) {
        std::printf("%s\n", error.what());
        return 2;
    }
}
