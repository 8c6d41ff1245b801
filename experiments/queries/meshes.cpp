module aabblab.queries;

import aabb.digest;
import aabb.triangle.self_intersection;
import aabblab.fmt;
import aabblab.stopwatch;

namespace aabblab {

namespace {

constexpr auto no_corner = std::numeric_limits<std::size_t>::max();

/// Links the corners at each position, in ascending order: gives, for each corner, the next one or no_corner. Corner
/// 3 t + k is corner k of triangle t. Vertices are compared by position, since meshes may repeat them.
std::vector<std::size_t> next_corners(const aabb::mesh& m) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t vertex = 0; vertex < m.vertices.size(); ++vertex)
        // Those that no triangle uses may be NaN, which has no order.
        if (aabb::is_finite(m.given_vertex(vertex))) vertices.push_back(vertex);
    std::ranges::sort(vertices, {}, [&](std::uint32_t vertex) {
        const aabb::vec3d at = m.given_vertex(vertex);
        return std::array{at[0], at[1], at[2]};
    });
    std::vector<std::size_t> position_of(m.vertices.size());  // a number, equal for equal vertices
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const bool is_next = m.given_vertex(vertices[i]) != m.given_vertex(vertices[i - 1]);
        position_of[vertices[i]] = position_of[vertices[i - 1]] + static_cast<std::size_t>(is_next);
    }
    std::vector<std::size_t> next(3 * m.triangles.size());
    std::vector<std::size_t> first(m.vertices.size(), no_corner);  // by position, of the corners linked so far
    for (std::size_t corner = next.size(); corner-- > 0;)
        next[corner] = std::exchange(first[position_of[m.triangles[corner / 3][corner % 3]]], corner);
    return next;
}

/// The number of vertices of one triangle that coincide with a vertex of the other.
std::uint32_t shared_vertices(const aabb::mesh& m, aabb::index_pair pair) {
    const aabb::triangle3d s = m.given_triangle(pair.a);
    const aabb::triangle3d t = m.given_triangle(pair.b);
    std::uint32_t shared = 0;
    for (int i = 0; i < 3; ++i) shared += s[i] == t[0] || s[i] == t[1] || s[i] == t[2];
    return shared;
}

bool share_vertex(const aabb::mesh& m, aabb::index_pair pair) {
    // Comparing indices is cheaper, and usually sufficient.
    for (const std::uint32_t vertex : m.triangles[pair.a])
        if (std::ranges::find(m.triangles[pair.b], vertex) != m.triangles[pair.b].end()) return true;
    return shared_vertices(m, pair) > 0;
}

/// Merges all pairs a < b of triangles that share a vertex with other pairs, by triangle a, since there may be many.
/// @param others sorted pairs of triangles that share no vertex
/// @param take receives the sorted pairs of each triangle in turn
/// @returns the number of pairs that share a vertex
std::uint64_t merge_neighbours(const aabb::mesh& m, std::span<const aabb::index_pair> others,
                               const std::function<void(std::span<const aabb::index_pair>)>& take) {
    const std::vector<std::size_t> next = next_corners(m);
    std::uint64_t count = 0;
    std::vector<aabb::index_pair> pairs;  // of one triangle
    for (std::uint32_t a = 0; a < m.triangle_count(); ++a) {
        pairs.clear();
        for (std::size_t corner = 3 * std::size_t{a}; corner < 3 * std::size_t{a} + 3; ++corner) {
            const auto sorted = static_cast<std::ptrdiff_t>(pairs.size());  // how many pairs are sorted already
            for (std::size_t other = next[corner]; other != no_corner; other = next[other])
                pairs.push_back({a, static_cast<std::uint32_t>(other / 3)});
            std::ranges::inplace_merge(pairs, pairs.begin() + sorted);
        }
        // Triangles with two corners at one position are met twice there, among them this one.
        pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
        std::erase(pairs, aabb::index_pair{a, a});
        count += pairs.size();
        const auto neighbours = static_cast<std::ptrdiff_t>(pairs.size());
        for (; !others.empty() && others.front().a == a; others = others.subspan(1)) pairs.push_back(others.front());
        std::ranges::inplace_merge(pairs, pairs.begin() + neighbours);
        take(pairs);
    }
    return count;
}

/// The number of triangles without area.
std::uint64_t count_degenerate(const aabb::mesh& m) {
    std::uint64_t count = 0;
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t)
        count += !aabb::self_intersection::has_area(m.given_triangle(t));
    return count;
}

/// A scene of one object per mesh, in which the second one takes all poses frame by frame, once per repeat.
class posed_meshes final : public aabb::mesh_scene {
public:
    /// @param poses_b at least one pose, even without a second mesh
    posed_meshes(std::vector<aabb::mesh> objects, const aabb::pose& pose_a, std::vector<aabb::pose> poses_b,
                 std::size_t repeats) {
        pose_a_ = pose_a;
        poses_b_ = std::move(poses_b);
        frames_ = repeats * poses_b_.size();
        meshes = std::move(objects);
        for (std::uint32_t object = 0; object < meshes.size(); ++object) mesh_of.push_back(object);
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }
    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        poses = {pose_a_, poses_b_[frame_++ % poses_b_.size()]};
        poses.resize(meshes.size());  // self-intersections have no second mesh
        return true;
    }

private:
    aabb::pose pose_a_;
    std::vector<aabb::pose> poses_b_;
    std::size_t frames_ = 0;
    std::size_t frame_ = 0;
};

struct query_result {
    std::uint64_t count = 0;              ///< of `self_pairs::all`, pairs that share no vertex
    std::uint64_t neighbours = 0;         ///< of `self_pairs::all`, pairs that share a vertex
    std::vector<aabb::index_pair> pairs;  ///< the stored pairs, without those that `detect` leaves in the runner
};

/// Whether a pair of intersecting triangles is among the pairs that the query reports.
bool is_reported(const aabb::mesh& m, aabb::index_pair pair, self_pairs wanted) {
    if (!share_vertex(m, pair)) return true;
    return wanted == self_pairs::intersecting &&
           aabb::self_intersection::intersects(m.given_triangle(pair.a), m.given_triangle(pair.b));
}

/// Runs the query. Within one mesh, neighbours, which share a vertex and are not reported, are counted separately.
/// @param neighbours_too whether neighbours are stored besides
query_result result_of(stage_runner& runner, const mesh_query& query, const aabb::mesh& m, bool neighbours_too) {
    query_result result;
    if (query.self) {
        runner.each_self_pair(0, [&](aabb::index_pair pair) {
            const bool reported = is_reported(m, pair, *query.self);
            ++(reported ? result.count : result.neighbours);
            if (reported ? query.ask != query_kind::count : neighbours_too) result.pairs.push_back(pair);
            return reported && query.ask == query_kind::first;
        });
        return result;
    }
    switch (query.ask) {
        case query_kind::count: result.count = runner.count_contacts(); break;
        case query_kind::pairs: runner.detect(); break;
        case query_kind::first:
            if (const auto c = runner.first_contact()) result.pairs.push_back({c->triangle_a, c->triangle_b});
            break;
    }
    return result;
}

/// Records the wanted pairs of each pose in order, with the intersections of their triangles, and rejects duplicates.
class pair_record {
public:
    /// @param rows,drawing may be null
    pair_record(const mesh_query& query, const scene_frames& scene, mesh_result& result, number_table* rows,
                hit_drawing* drawing)
        : query_(query), scene_(scene), result_(result), method_(result.method), rows_(rows), drawing_(drawing) {}

    /// Records the pairs of one pose: removes those that only touch unless wanted, counts the rest by kind, and writes
    /// them. Neighbours, unless among the pairs (`neighbours_too`), follow from the mesh; the query has counted them.
    void add(std::uint32_t pose, query_result hits, bool neighbours_too) {
        pose_ = pose;
        sort_rows(hits.pairs);
        require_each_once(hits.pairs, method_.name);
        const std::vector<aabb::mesh>& meshes = scene_.meshes()->meshes;
        geometry_.emplace(meshes.front(), scene_.poses().front(), meshes.back(), scene_.poses().back());
        hit_filter wanted(query_.hits.touching);
        std::erase_if(hits.pairs, [&](aabb::index_pair pair) { return !wanted.keeps(geometry_->kind(pair)); });
        result_.kinds.push_back(wanted.counts());
        if (!query_.hits.touching) result_.counts.back() = hits.pairs.size();
        if (query_.ask == query_kind::first) {
            result_.first.emplace_back();
            if (hits.pairs.size() > 1) hits.pairs.resize(1);
        }
        if (query_.self != self_pairs::all || neighbours_too) return add_sorted(hits.pairs);
        const std::uint64_t neighbours = merge_neighbours(
            meshes.front(), hits.pairs, [&](std::span<const aabb::index_pair> pairs) { add_sorted(pairs); });
        if (neighbours != hits.neighbours)
            throw defect(fmt::format("{} finds {} pairs of triangles that share a vertex, but there are {}",
                                     method_.name, hits.neighbours, neighbours));
    }
    [[nodiscard]] std::string digest() const { return digest_.text(); }

private:
    /// Adds sorted pairs to the digest, and, as the query asks, with their intersections to the rows and to the result.
    void add_sorted(std::span<const aabb::index_pair> pairs) {
        digest_.add(pose_, pairs);
        if (query_.take) query_.take(pose_, pairs);
        if (!rows_ && !drawing_ && !query_.hits.geometry && query_.ask != query_kind::first) return;
        const auto last = static_cast<std::uint32_t>(scene_.meshes()->meshes.size() - 1);
        for (const aabb::index_pair pair : pairs) {
            intersecting_pair row{pair, {}};
            if (drawing_) drawing_->add_hit({0, pair.a}, {last, pair.b}, (*geometry_)(pair));
            if (query_.hits.geometry) row.common = (*geometry_)(pair);
            if (rows_) add_row(row);
            if (query_.ask == query_kind::first) result_.first.back() = row;
        }
    }

    /// Writes a row: the pose if there are several, the triangles, and in one mesh the number of shared vertices.
    void add_row(const intersecting_pair& pair) {
        const auto [a, b] = pair.triangles;
        const std::string cells = pair.common ? to_cells(*pair.common) : "";
        if (query_.self && query_.self != self_pairs::no_adjacent)
            rows_->add({a, b, shared_vertices(scene_.meshes()->meshes.front(), pair.triangles)}, cells);
        else if (query_.by_pose)
            rows_->add({pose_, a, b}, cells);
        else
            rows_->add({a, b}, cells);
    }

    const mesh_query& query_;
    const scene_frames& scene_;
    mesh_result& result_;
    search_method& method_;
    number_table* rows_;
    hit_drawing* drawing_;
    std::optional<hit_geometry> geometry_;
    aabb::digest digest_;
    std::uint32_t pose_ = 0;
};

/// The bytes of the trees (nodes and indices) per triangle; empty for an engine that does not report them.
std::optional<double> bytes_per_triangle_of(const mesh_result& result) {
    std::optional<std::size_t> trees;
    for (const aabb::part_bytes& part : result.bytes)
        if (part.part == "nodes" || part.part == "indices") trees = trees.value_or(0) + part.bytes;
    if (!trees) return std::nullopt;
    const auto triangles = std::accumulate(result.triangles.begin(), result.triangles.end(), std::size_t{0});
    return static_cast<double>(*trees) / static_cast<double>(triangles);
}

}  // namespace

/// Runs and times the query for each pose of the second mesh, several times if asked; records the first repeat.
mesh_result search_meshes(const mesh_query& query, const search_choice& choice, std::vector<aabb::mesh> meshes,
                          const aabb::pose& pose_a, given_poses poses_b, number_table* rows, hit_drawing* drawing) {
    const std::size_t poses = poses_b.poses.size();
    scene_frames scene(
        std::make_unique<posed_meshes>(std::move(meshes), pose_a, std::move(poses_b.poses), query.repeats));
    aabb::scene_traits traits = traits_of(scene);
    traits.frames = 1;  // every query is timed on its own: nothing is reused between them
    mesh_result result;
    result.method = method_of(choice, traits);
    if (query.relations && !result.method.exact)
        throw aabb::input_error(
            fmt::format("--relation needs every intersecting pair, but {} is inexact", result.method.name));
    std::optional<stage_runner> searcher;
    const wall_stopwatch building;
    searcher.emplace(std::move(result.method.run_stages), scene);
    result.build_ms = building.ms();
    for (const aabb::mesh& m : scene.meshes()->meshes) result.triangles.push_back(m.triangle_count());
    // Within one mesh, pairs that share a vertex may dominate: n triangles around one vertex have n²/2 of them. They
    // are stored only if they are reported and an inexact method may have missed some; with an exact method, they
    // follow from the mesh.
    const bool neighbours_too = query.self == self_pairs::all && !result.method.exact && query.ask != query_kind::count;
    pair_record record(query, scene, result, rows, drawing);
    const std::vector<aabb::mesh>& searched = scene.meshes()->meshes;
    relation_search relations(searched.front(), searched.back());
    // Which pairs only touch is known once they are stored.
    mesh_query search = query;
    if (!query.hits.touching) search.ask = query_kind::pairs;
    // A frame is one query: frame r · poses + p is pose p of repeat r.
    for (std::uint32_t frame = 0; scene.next(); ++frame) {
        query_result hits;
        try {
            searcher->update();
            searcher->search();
            const wall_stopwatch searching;
            hits = result_of(*searcher, search, scene.meshes()->meshes.front(), neighbours_too);
            result.query_ms.push_back(searching.ms());
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(
                fmt::format("{}{}: {}", poses_b.place_of(frame % poses), query.between, error.what()));
        }
        if (frame >= poses) continue;
        if (drawing && frame == 0)
            for (std::size_t i = 0; i < searched.size(); ++i) drawing->add_object(searched[i], scene.poses()[i]);
        if (query.self && query.self != self_pairs::intersecting) result.neighbours = hits.neighbours;
        if (!query.self && search.ask != query_kind::count) {
            for (const aabb::contact& c : searcher->sorted_contacts())
                hits.pairs.push_back({c.triangle_a, c.triangle_b});
            hits.count = hits.pairs.size();
        }
        result.counts.push_back(hits.count);
        if (!query.self && result.method.exact) {
            result.relations.emplace_back();
            const aabb::pose &at_a = scene.poses().front(), &at_b = scene.poses().back();
            if (hits.count == 0)
                result.relations.back() = relations.at(at_a, at_b);
            else if (query.relations)
                result.relations.back() = relations.at(at_a, at_b, hits.pairs);
        }
        if (search.ask != query_kind::count) record.add(frame, std::move(hits), neighbours_too);
    }
    if (query.self && query.ask != query_kind::first)
        result.degenerate = count_degenerate(scene.meshes()->meshes.front());
    result.surfaces = relations.surfaces();
    result.relation_ms = relations.ms();
    result.bytes = searcher->local_bytes();
    result.bytes_per_triangle = bytes_per_triangle_of(result);
    if (query.ask != query_kind::count) result.digest = record.digest();
    return result;
}

}  // namespace aabblab
