#include <nlohmann/json.hpp>

#include "command_parser.hpp"
#include "distances.hpp"

import aabb.distance_stage;
import aabb.geometry;
import aabblab.numbers;

namespace aabblab {

namespace {

std::string text_of(const aabb::vec3d& point) {
    return fmt::format("({}, {}, {})", point[0], point[1], point[2]);
}

std::string text_of(const aabb::mesh_distance& d) {
    const std::string points = d.distance == 0 ? fmt::format("triangles {} and {} meet at {}\n", d.triangles.a,
                                                             d.triangles.b, text_of(d.point_a))
                                               : fmt::format("triangle {} at {}\ntriangle {} at {}\n", d.triangles.a,
                                                             text_of(d.point_a), d.triangles.b, text_of(d.point_b));
    return fmt::format("distance {}, error at most {}\n", d.distance, d.error) + points;
}

void print_json(const distances_result& result, bool by_pose) {
    nlohmann::ordered_json distances, errors, nearest, points, point_errors;
    for (const aabb::mesh_distance& d : result.distances) {
        distances.push_back(d.distance);
        errors.push_back(d.error);
        nearest.push_back({d.triangles.a, d.triangles.b});
        points.push_back({d.point_a.at, d.point_b.at});
        point_errors.push_back(d.point_error);
    }
    const auto value = [&](const nlohmann::ordered_json& values) { return by_pose ? values : values.front(); };
    const nlohmann::ordered_json summary = {{"triangles", result.triangles}, {"distance", value(distances)},
                                            {"error", value(errors)},        {"nearest", value(nearest)},
                                            {"points", value(points)},       {"point_error", value(point_errors)},
                                            {"build_ms", result.build_ms},   {"query_ms", value(result.query_ms)},
                                            {"method", result.method}};
    print(summary.dump() + "\n");
}

}  // namespace

void print_distances(const std::vector<std::string>& meshes, const distances_result& result, bool by_pose, bool json) {
    if (json) return print_json(result, by_pose);
    const auto description_of = [&](std::size_t i) {
        return visible(meshes[i]) + " (" + counted(result.triangles[i], "triangle") + ")";
    };
    print(description_of(0) + " against " + description_of(1) + "\n");
    for (std::size_t pose = 0; pose < result.distances.size(); ++pose)
        print((by_pose ? fmt::format("pose {}: ", pose) : "") + text_of(result.distances[pose]));
    const double measuring = std::accumulate(result.query_ms.begin(), result.query_ms.end(), 0.0);
    print(fmt::format("{}: built in {:.3f} ms, measured in {:.3f} ms\n", result.method, result.build_ms, measuring));
}

}  // namespace aabblab
