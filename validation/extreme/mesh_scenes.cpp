module aabb.extreme;

import :making;

namespace aabb {

namespace {

/// A quarter turn about z, which is exact.
constexpr pose quarter_turn{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0}};

/// Two cubes of edge 2. In the second frame both are moved, and the second is rotated so that it fills the same space.
std::unique_ptr<mesh_scene> two_cubes(const vec3d& between) {
    const pose turned_second{quarter_turn.rotation, {between[0] + 2 + 7, between[1] + 5, between[2] - 3}};
    return posed(cube(), {{{}, shifted(between[0], between[1], between[2])}, {shifted(7, 5, -3), turned_second}});
}

std::unique_ptr<mesh_scene> same_place() {
    const pose anywhere = turned(0.7, {0.3, -0.2, 0.1});
    return posed(ball(4, 1), {{{}, {}}, {anywhere, anywhere}});
}

/// A corner of one mesh touches a face of the other, then an edge, then a vertex.
std::unique_ptr<mesh_scene> corner_on_face() {
    const mesh corner = soup_of({{{{0, 0, 0}, {1, 1, 1}, {2, 1, 1}}}, {{{0, 0, 0}, {1, 1, 1}, {1, 2, 1}}}});
    return posed(std::vector{cube(), corner},
                 {{{}, shifted(0.5, 0.75, 2)}, {{}, shifted(0.5, 2, 2)}, {{}, shifted(1, 1, 2)}});
}

constexpr triangle3f flat_triangle{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
constexpr triangle3f crossing_triangle{{{0.5F, 0.5F, -1}, {0.5F, 0.5F, 1}, {0.25F, 3, 0}}};

/// Two copies of a mesh in three frames, each a pair of poses. The centroid of each of its triangles is the origin,
/// exactly, since coordinates are integers: no build of a tree can separate them by their centroids.
std::unique_ptr<mesh_scene> same_centroid() {
    draws random(41);
    std::vector<triangle3f> triangles;
    const auto integer = [&] { return static_cast<float>(random.below(17)) - 8; };
    for (int i = 0; i < 40; ++i) {
        const vec3f p{integer(), integer(), integer()}, q{integer(), integer(), integer()};
        triangles.push_back({{p, q, {-p[0] - q[0], -p[1] - q[1], -p[2] - q[2]}}});
    }
    return posed(soup_of(triangles), {{{}, {}}, {{}, shifted(1, 0, 0)}, {{}, turned(1, {0, 0, 5})}});
}

/// Two copies of a mesh that has each triangle four times, and once with permuted corners: no build can separate these.
std::unique_ptr<mesh_scene> duplicates() {
    mesh m = cube();
    // One face and a half.
    m.triangles.resize(12);
    const auto originals = m.triangles;
    for (int i = 0; i < 3; ++i) m.triangles.insert(m.triangles.end(), originals.begin(), originals.end());
    for (const auto& t : originals) m.triangles.push_back({t[2], t[0], t[1]});
    return posed(std::move(m), {{{}, shifted(1, 1, 1)}, {{}, turned(0.5, {1, 0, 1})}});
}

std::unique_ptr<mesh_scene> one_triangle_each() {
    return posed(std::vector{soup_of({flat_triangle}), soup_of({crossing_triangle})},
                 {{{}, {}}, {{}, shifted(0, 0, 1)}, {{}, shifted(0, 0, 1.5)}, {shifted(3, 3, 3), shifted(3, 3, 3)}});
}

mesh coincident(std::uint32_t count) {
    mesh m = soup_of({flat_triangle});
    m.triangles.resize(count, m.triangles[0]);
    return m;
}

/// Two copies of a mesh of thin triangles of lengths about 1 in random directions, at the same pose, then almost.
/// @param height the greatest distance of the third corner from the middle of the long edge, on each axis
std::unique_ptr<mesh_scene> needles(float height) {
    draws random(51);
    std::vector<triangle3f> triangles;
    for (int i = 0; i < 60; ++i) {
        const vec3f from = random.point(-1, 1), to = random.point(-1, 1);
        vec3f beside = to;
        for (int k = 0; k < 3; ++k) beside[k] = (from[k] + to[k]) / 2 + height * random.between(-1, 1);
        triangles.push_back({{from, to, beside}});
    }
    return posed(soup_of(triangles), {{{}, {}}, {{}, shifted(1e-7, 0, 0)}, {{}, turned(1e-6, {0, 0, 0})}});
}

/// Two copies of a mesh of triangles, segments (two corners coincide: any two) and points (all three do). Coordinates
/// are integers from 0 to 4, so that many of them touch exactly.
std::unique_ptr<mesh_scene> zero_areas() {
    draws random(52);
    std::vector<triangle3f> triangles;
    const auto integer = [&] { return static_cast<float>(random.below(5)); };
    for (std::uint32_t i = 0; i < 60; ++i) {
        triangle3f t{
            {{integer(), integer(), integer()}, {integer(), integer(), integer()}, {integer(), integer(), integer()}}};
        if (i % 3 > 0) t[2] = t[1];
        if (i % 3 > 1) t[1] = t[0];
        if (i % 6 > 3) t[2] = t[0];
        triangles.push_back(t);
    }
    return posed(soup_of(triangles), {{{}, {}}, {{}, shifted(1, 0, 0)}});
}

/// Two intersecting spheres of this radius.
std::unique_ptr<mesh_scene> balls_of(double radius) {
    return posed(ball(5, radius), {{{}, turned(0.4, {0.8 * radius, 0.5 * radius, 0.1 * radius})},
                                   {turned(-1, {radius, 0, 0}), turned(2, {0.5 * radius, 0, radius})}});
}

/// A sphere of radius 1, and one of this radius on its surface.
std::unique_ptr<mesh_scene> ball_on_ball(double radius) {
    return posed(std::vector{ball(5, 1), ball(5, radius)},
                 {{{}, shifted(0, 0, 1 + radius / 2)}, {{}, shifted(0, 1, 0)}});
}

/// Both spheres moved by this distance, with the same distance between them.
std::unique_ptr<mesh_scene> balls_moved(double far) {
    return posed(ball(5, 1), {{shifted(far, -far, far), turned(0.4, {far + 1, -far, far + 0.5})},
                              {shifted(-far, far, 0), shifted(-far, far, 0)}});
}

/// Two cubes of doubles, whose coordinates end at this distance, also after a rotation of both.
std::unique_ptr<mesh_scene> cubes_apart(const vec3d& place, double gap) {
    const mesh first = in_double(cube(), 0.1, place);
    const mesh second = in_double(cube(), 0.1, {place[0] + 0.2 + gap, place[1], place[2]});
    const pose anywhere = turned(0.7, {0.3, -0.2, 0.1});
    return posed(std::vector{first, second},
                 {{{}, {}}, {anywhere, anywhere}, {anywhere, turned(0.7, {0.3, -0.2, 0.1 + 1e-9})}});
}

/// Two cubes of edge 2, face to face under a common rotation: the second is shifted along an axis of the first, a
/// column of the rotation matrix, by 2. Rounding of the matrix decides which of their triangles touch.
std::unique_ptr<mesh_scene> flush_turned() {
    draws random(54);
    std::vector<std::vector<pose>> frames;
    for (int i = 0; i < 8; ++i) {
        const pose first = turned(random.between(0, 3), {0, 0, 0});
        pose second = first;
        for (int k = 0; k < 3; ++k) second.translation[k] = 2 * first.rotation[static_cast<std::size_t>(3 * k + i % 3)];
        frames.push_back({first, second});
    }
    return posed(cube(), frames);
}

}  // namespace

/// All extreme scenes of valid meshes: they touch, consist of degenerate triangles, or are small, large or far away.
/// `many` coincident triangles cannot be separated by any split, so their scenes also limit the memory of trees.
std::vector<extreme_scene> mesh_scenes(extreme_size size) {
    const std::uint32_t many = size == extreme_size::small ? 300U : size == extreme_size::quick ? 20'000U : 1'000'000U;
    extreme_scene against_one = scene_of_meshes(
        "many_against_one", std::to_string(many) + " copies of one triangle, against another triangle",
        [many] { return posed(std::vector{coincident(many), soup_of({crossing_triangle})}, {{{}, {}}}); });
    against_one.query = extreme_query::count_pairs;
    extreme_scene against_itself =
        scene_of_meshes("many_against_many", "these copies against themselves, until one pair is found",
                        [many] { return posed(coincident(many), {{{}, shifted(0.5, 0.5, 0)}}); });
    against_itself.query = extreme_query::first_pair;
    // The largest layout has an internal node of 32 bytes and a leaf of 28 per triangle; the rest is for stacks.
    for (extreme_scene* scene : {&against_one, &against_itself}) scene->most_bytes = std::size_t{many} * 64 + 65'536;
    std::vector<extreme_scene> scenes{
        scene_of_meshes("same_place", "two copies of a mesh at the same pose", same_place),
        scene_of_meshes("touch_at_vertices", "two cubes that share a corner", [] { return two_cubes({2, 2, 2}); }),
        scene_of_meshes("touch_along_edges", "two cubes that share an edge", [] { return two_cubes({2, 2, 0}); }),
        scene_of_meshes("touch_at_faces", "two cubes that share a face", [] { return two_cubes({2, 0, 0}); }),
        scene_of_meshes("corner_on_face", "a corner on a face, on an edge, on a vertex", corner_on_face),
        scene_of_meshes("same_centroid", "all triangles have the same centroid", same_centroid),
        scene_of_meshes("duplicates", "each triangle five times", duplicates),
        scene_of_meshes("one_triangle", "meshes of one triangle each", one_triangle_each),
        against_one,
        against_itself,
        scene_of_meshes("slivers", "triangles a millionth as high as long", [] { return needles(1e-6F); }),
        scene_of_meshes("thinnest", "triangles about as high as one unit in the last place",
                        [] { return needles(1e-8F); }),
        scene_of_meshes("zero_areas", "triangles, segments and points, against each other", zero_areas),
    };
    for (const auto& [name, radius] : {std::pair{"scale_1e-44", 1e-44},
                                       {"scale_1e-39", 1e-39},
                                       {"scale_1e-30", 1e-30},
                                       {"scale_1e-10", 1e-10},
                                       {"scale_1e10", 1e10},
                                       {"scale_1e30", 1e30},
                                       {"scale_1e37", 1e37}})
        scenes.push_back(scene_of_meshes(name, "two intersecting spheres of the radius in the name",
                                         [size = radius] { return balls_of(size); }));
    for (const auto& [name, radius] : {std::pair{"beside_1e-6", 1e-6}, {"beside_1e6", 1e6}, {"beside_1e-38", 1e-38}})
        scenes.push_back(scene_of_meshes(name, "a sphere of the radius in the name that intersects one of radius 1",
                                         [size = radius] { return ball_on_ball(size); }));
    constexpr vec3d survey{388096, 3948995, 10};  // coordinates as in a map
    scenes.push_back(scene_of_meshes("doubles_apart", "two cubes of doubles 1e-9 apart, far from the origin",
                                     [survey] { return cubes_apart(survey, 1e-9); }));
    scenes.push_back(scene_of_meshes("doubles_pressed",
                                     "two cubes of doubles that intersect by less than a float resolves",
                                     [] { return cubes_apart({0.1, 0.2, 0.3}, -1e-12); }));
    scenes.push_back(scene_of_meshes("flush_turned", "two cubes face to face, rotated alike", flush_turned));
    for (const auto& [name, far] : {std::pair{"moved_1e6", 1e6}, {"moved_1e9", 1e9}, {"moved_1e15", 1e15}})
        scenes.push_back(scene_of_meshes(name, "two intersecting spheres as far from the origin as the name says",
                                         [distance = far] { return balls_moved(distance); }));
    return scenes;
}

}  // namespace aabb
