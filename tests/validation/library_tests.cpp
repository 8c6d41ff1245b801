#include "pairs.hpp"

import aabb.triangle.exact;

using namespace aabb;

namespace {

template <class Real>
std::vector<triangle_pair<Real>> all_pairs(int count) {
    std::vector<triangle_pair<Real>> pairs;
    triangle_pairs::generator random(9);
    triangle_pairs::for_each_pair<Real>(
        random, count, [&](const auto& pair) { pairs.push_back(pair); }, [](std::size_t) {});
    return pairs;
}

template <class Real>
void check_against_exact(const triangle_test& test) {
    const std::vector<triangle_pair<Real>> pairs = all_pairs<Real>(40);
    std::vector<std::uint8_t> results(pairs.size());
    test.intersect(pairs, results);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        wrong += (results[i] == 1) != exact_triangle::intersects(pairs[i].a, pairs[i].b);
        if ((results[i] == 1) != test.intersects(pairs[i].a, pairs[i].b)) FAIL("pair " << i << " alone and in a batch");
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("exact triangle tests of libraries equal ours, alone and in batches") {
    std::size_t tested = 0;
    for (const library_test_info& info : library_tests()) {
        if (!info.exact) continue;
        INFO(info.name);
        ++tested;
        const auto test = make_library_test({info.name, {}});
        check_against_exact<float>(*test);
        check_against_exact<double>(*test);
    }
    CHECK(tested >= 2);
}

TEST_CASE("every triangle test of a library decides clear pairs") {
    const triangle3f face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    for (const library_test_info& info : library_tests()) {
        INFO(info.name);
        CHECK_FALSE(info.summary.empty());
        const auto test = make_library_test({info.name, {}});
        CHECK(test->intersects(face, {{{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}}));
        CHECK_FALSE(test->intersects(face, {{{3, 3, -1}, {3, 3, 1}, {5, 5, 1}}}));
        CHECK_FALSE(test->intersects(face, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}));
        CHECK(test->takes_double());
    }
}

TEST_CASE("epeck constructs the same intersections as exact, which other tests of libraries reject") {
    const triangle3d face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const triangle3d edge{{{1, 0, 0}, {2, 0, 0}, {1, 0, 3}}};
    for (const library_test_info& info : library_tests()) {
        INFO(info.name);
        const auto test = make_library_test({info.name, {}});
        CHECK(test->constructs() == (info.name == "epeck"));
        if (test->constructs())
            CHECK(test->intersection(face, edge).corners == exact_triangle::intersection(face, edge).corners);
        else
            CHECK_REFUSED(
                test->intersection(face, edge),
                info.name + " decides whether triangles intersect, but does not construct their intersection");
    }
}

TEST_CASE("every triangle test of a library terminates on any pair") {
    const auto floats = all_pairs<float>(30);
    const auto doubles = all_pairs<double>(30);
    std::vector<std::uint8_t> results(floats.size());
    for (const library_test_info& info : library_tests()) {
        INFO(info.name);
        const auto test = make_library_test({info.name, {}});
        test->intersect(floats, results);
        test->intersect(doubles, results);
        CHECK(std::ranges::any_of(results, [](std::uint8_t hit) { return hit == 1; }));
    }
}

TEST_CASE("a library's triangle test is rejected with the nearest name, or for unknown or invalid settings") {
    CHECK_REFUSED(make_library_test({"epik", {}}), "unknown triangle test 'epik'; did you mean 'epick'?");
    CHECK_REFUSED(make_library_test({"epick", {{"epsilon", "none"}}}),
                  "epick takes no parameters, but 'epsilon' is set");
    for (const library_test_info& info : library_tests())
        for (const parameter_info& p : info.parameters) {
            INFO(info.name << ": " << p.name);
            CHECK_THROWS_AS(make_library_test({info.name, {{p.name, "0"}}}), input_error);
            CHECK_NOTHROW(make_library_test({info.name, {{p.name, p.fallback}}}));
            CHECK_NOTHROW(make_library_test({info.name, {{p.name, "1"}}}));
        }
}
