#include <random>

#include "../compositions.hpp"
#include "../meshes.hpp"

import aabb.strategies;
import aabb.tree.quantized_planes;

using namespace aabb;

namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

/// Any finite float, each exponent as often as any other.
float any_float(std::mt19937& random) {
    for (;;)
        if (const float x = std::bit_cast<float>(static_cast<std::uint32_t>(random())); std::isfinite(x)) return x;
}

/// Intervals in which float arithmetic goes wrong, and ordinary ones.
std::pair<float, float> any_interval(std::mt19937& random) {
    std::pair<float, float> ends;
    switch (random() % 8) {
        case 0: ends = {-largest, largest}; break;
        case 1: ends = {largest, std::nextafter(largest, 0.0F)}; break;
        case 2: ends = {-smallest, static_cast<float>(random() % 100) * smallest}; break;
        case 3: ends = {-0.0F, 0.0F}; break;
        case 4: ends = {1e7F, 1e7F + static_cast<float>(random() % 4)}; break;
        case 5: ends = {any_float(random), any_float(random)}; break;
        default: ends = {0, 1}; break;
    }
    return std::minmax(ends.first, ends.second);
}

/// A float between two others, often one of them or next to it.
float any_between(std::mt19937& random, float low, float high) {
    const double fraction = std::uniform_real_distribution<double>(0, 1)(random);
    switch (random() % 6) {
        case 0: return low;
        case 1: return high;
        case 2: return std::nextafter(low, high);
        case 3: return std::nextafter(high, low);
        default: return std::clamp(static_cast<float>(low + (double{high} - low) * fraction), low, high);
    }
}

/// A box within another.
box any_within(std::mt19937& random, const box& outer) {
    box b;
    for (int k = 0; k < 3; ++k)
        std::tie(b.min[k], b.max[k]) = std::minmax(
            {any_between(random, outer.min[k], outer.max[k]), any_between(random, outer.min[k], outer.max[k])});
    return b;
}

/// Triangles of two sizes along a spiral.
mesh spiral(std::uint32_t n) {
    mesh m;
    for (std::uint32_t i = 0; i < n; ++i) {
        const float angle = static_cast<float>(i) * 0.37F;
        const float radius = 1 + static_cast<float>(i % 17);
        const vec3f at{radius * std::cos(angle), radius * std::sin(angle), static_cast<float>(i) * 0.05F};
        const float size = i % 5 == 0 ? 2.0F : 0.1F;
        add_triangle(m, at, at + vec3f{size, size / 2, 0}, at + vec3f{0, size, size});
    }
    return m;
}

/// Variants of a mesh for which float has few bits left, none to spare, or none at all.
std::vector<mesh> extremes(const mesh& m) {
    std::vector<mesh> variants;
    const auto add = [&](auto moved) {
        mesh& variant = variants.emplace_back(m);
        for (vec3f& v : variant.vertices)
            for (int k = 0; k < 3; ++k) v[k] = moved(v[k], k);
    };
    add([](float x, int) { return x * 1e36F; });
    add([](float x, int k) { return k == 0 ? (x > 0 ? largest : -largest) : x; });
    add([](float x, int) { return std::round(x) * smallest; });
    add([](float x, int) { return x * 1e-38F; });
    add([](float x, int) { return x + 1e7F; });
    add([](float x, int k) { return k == 1 ? -0.0F : x; });
    add([](float, int) { return 3.0F; });
    return variants;
}

quantized_tree with_bits(unsigned bits) {
    quantized_config config;
    config.bits = bits;
    return quantized_tree(config);
}

double inflation_of(const model<quantized_tree>& m) {
    const tree_validation validation = validate(m.tree(), m.triangles());
    CHECK(validation.fault.empty());
    return validation.area_inflation;
}

}  // namespace

TEST_CASE("a quantized plane never cuts a child, but the next code would") {
    std::mt19937 random(1);
    for (unsigned bits = quantized_planes::least_bits; bits <= quantized_planes::most_bits; ++bits) {
        const quantized_planes planes(bits);
        for (int i = 0; i < 20'000; ++i) {
            box parent;
            for (int k = 0; k < 3; ++k) std::tie(parent.min[k], parent.max[k]) = any_interval(random);
            const std::array<box, 2> exact{any_within(random, parent), any_within(random, parent)};
            std::array<std::byte, 12 + quantized_planes::read_beyond> codes{};
            sibling_planes own{};
            std::uint8_t symbol = 0;
            encode_siblings(exact[0], exact[1], own, symbol);
            planes.encode(parent, own, codes.data());
            const std::array<box, 2> decoded = decode_siblings(parent, planes.decode(parent, codes.data()), symbol);
            for (std::size_t side = 0; side < 2; ++side) {
                REQUIRE(contains(decoded[side], exact[side]));
                REQUIRE(contains(parent, decoded[side]));
            }
            for (int k = 0; k < 3; ++k) {
                const double length = double{parent.max[k]} - double{parent.min[k]};
                if (length > largest || length < 1e-30) continue;
                // A step, and what rounding to float takes at this distance from the origin.
                const double slack =
                    length * std::ldexp(1.0, -static_cast<int>(bits)) * 1.001 +
                    std::max(std::abs(double{parent.min[k]}), std::abs(double{parent.max[k]})) * 0x1p-22;
                const std::size_t inner_low = exact[0].min[k] > exact[1].min[k] ? 0 : 1;
                const std::size_t inner_high = exact[0].max[k] < exact[1].max[k] ? 0 : 1;
                REQUIRE(exact[inner_low].min[k] - double{decoded[inner_low].min[k]} <= slack);
                REQUIRE(double{decoded[inner_high].max[k]} - exact[inner_high].max[k] <= slack);
            }
        }
    }
}

TEST_CASE("quantized boxes contain what is below them, and are tighter with more bits") {
    const mesh m = spiral(501);
    double previous = 1e9;
    for (unsigned bits = quantized_planes::least_bits; bits <= quantized_planes::most_bits; ++bits) {
        INFO(bits << " bits");
        const double inflation = inflation_of({m, median_build(), with_bits(bits)});
        CHECK_BETWEEN(0, inflation, previous);
        previous = inflation;
        for (const mesh& extreme : extremes(m)) CHECK(inflation_of({extreme, median_build(), with_bits(bits)}) >= 0);
    }
    CHECK(previous < 1e-3);
}

TEST_CASE("each refit recomputes quantized boxes, so that they do not grow") {
    mesh m = spiral(300);
    const mesh at_rest = m;
    for (const unsigned bits : {4U, 7U, 16U}) {
        INFO(bits << " bits");
        model<quantized_tree> fitted(m, median_build(), with_bits(bits));
        const double built = inflation_of(fitted);
        std::vector<box> scratch;
        for (int round = 0; round < 20; ++round) {
            for (std::size_t v = 0; v < m.vertices.size(); ++v)
                m.vertices[v][round % 3] += std::sin(0.1F * static_cast<float>(v));
            fitted.refit(scratch);
            inflation_of(fitted);
        }
        m = at_rest;
        fitted.refit(scratch);
        CHECK(inflation_of(fitted) == built);
    }
}

TEST_CASE("quantized trees miss no pair, at any number of bits and any coordinates") {
    for (const mesh& m : extremes(spiral(150))) {
        const auto pairs_of = [&](const std::string& tree) {
            const auto stage = local_of(composed({{strategy_kind::tree, tree.c_str()}}));
            stage->add_model(m);
            std::vector<index_pair> pairs;
            stage->self_pairs(0, pairs);
            return sorted(pairs);
        };
        const std::vector<index_pair> truth = pairs_of("canonical");
        for (unsigned bits = quantized_planes::least_bits; bits <= quantized_planes::most_bits; ++bits)
            for (const char* leaf_test : {"none", "triangle_box", "triangle_aabb"}) {
                INFO(bits << " bits, " << leaf_test);
                REQUIRE(pairs_of("quantized:bits=" + std::to_string(bits) + ",leaf_test=" + leaf_test) == truth);
            }
    }
}

TEST_CASE("a quantized tree takes six codes, a symbol and an index per sibling pair, and an index per triangle") {
    for (std::uint32_t n = 2; n <= 60; ++n) {
        const mesh m = spiral(n);
        for (unsigned bits = quantized_planes::least_bits; bits <= quantized_planes::most_bits; ++bits) {
            const model<quantized_tree> packed(m, median_build(), with_bits(bits));
            const std::size_t pairs = n / 2;
            const std::size_t records = n - 1 - pairs;
            INFO(n << " triangles, " << bits << " bits");
            CHECK(packed.tree().bytes().nodes == 24 + records * (1 + (6 * bits + 7) / 8));
            CHECK(packed.tree().bytes().indices == 4 * records + 8 * pairs);
        }
    }
}
