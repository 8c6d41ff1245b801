#include "../testing.hpp"

import aabblab.metrics;
import aabblab.results;

using aabblab::byte_columns;
using aabblab::measured;
using aabblab::row;

TEST_CASE("Names of metrics and metric groups are unique") {
    std::set<std::string> names;
    for (const aabblab::metric_group_info& group : aabblab::metric_groups) CHECK(names.emplace(group.name).second);
    for (const std::string& name : aabblab::metric_names()) {
        INFO(name);
        CHECK(names.insert(name).second);
    }
}

TEST_CASE("Times per frame need a frame after the first one") {
    row r;
    r.frames = 3;
    r.first_ms = 5;
    r.update_ms = 1;
    r.search_ms = 2;
    r.detect_ms = 9;
    CHECK(measured("frame_ms")(r) == 6);
    CHECK(measured("update_ms")(r) == 0.5);
    CHECK(measured("search_ms")(r) == 1);
    CHECK(measured("detect_ms")(r) == 4.5);
    r.frames = 1;
    r.update_ms = r.search_ms = r.detect_ms = 0;
    CHECK(measured("frame_ms")(r) == 5);
    for (const char* metric : {"update_ms", "search_ms", "detect_ms"}) {
        INFO(metric);
        CHECK_FALSE(measured(metric)(r).has_value());
    }
}

TEST_CASE("The share of global search is computed from processor time") {
    row r;
    r.frames = 3;
    r.update_ms = r.search_ms = r.detect_ms = 100;
    r.update_cpu_ms = 1;
    r.search_cpu_ms = 2;
    r.detect_cpu_ms = 9;
    CHECK(measured("global_share")(r) == 25);
}

TEST_CASE("Processor time is reported next to wall time, and their difference as waiting") {
    row r;
    r.frames = 3;
    r.build_ms = r.first_ms = r.update_ms = r.search_ms = r.detect_ms = 4;
    r.build_cpu_ms = r.first_cpu_ms = r.update_cpu_ms = r.search_cpu_ms = r.detect_cpu_ms = 3;
    CHECK(measured("frame_cpu_ms")(r) == 4.5);
    CHECK(measured("update_cpu_ms")(r) == 1.5);
    CHECK(measured("search_cpu_ms")(r) == 1.5);
    CHECK(measured("detect_cpu_ms")(r) == 1.5);
    CHECK(measured("global_cpu_ms")(r) == 3);
    CHECK(measured("build_cpu_ms")(r) == 3);
    CHECK(measured("whole_cpu_ms")(r) == 15);
    CHECK(measured("waiting")(r) == 25);
    r.first_cpu_ms = r.update_cpu_ms = r.search_cpu_ms = r.detect_cpu_ms = 4.1;
    CHECK(measured("waiting")(r) == 0);
    r.frames = 1;
    CHECK(measured("frame_cpu_ms")(r) == 4.1);
    for (const char* metric : {"update_cpu_ms", "global_cpu_ms", "global_share"}) {
        INFO(metric);
        CHECK_FALSE(measured(metric)(r).has_value());
    }
    r.update_cpu_ms.reset();
    CHECK_FALSE(measured("waiting")(r).has_value());
}

TEST_CASE("Bytes of trees are unknown for engines") {
    row r;
    r.triangles = 100;
    for (std::size_t i = 0; i < r.bytes.size(); ++i) r.bytes[i] = byte_columns[i] == "nodes" ? 700 : 0;
    CHECK(measured("tree_bytes")(r) == 7);
    r.name.engine = "embree_meshes";
    CHECK_FALSE(measured("tree_bytes")(r).has_value());
}
