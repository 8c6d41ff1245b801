#include "distance_judge.hpp"

#include <algorithm>
#include <bit>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace {

using integer = boost::multiprecision::cpp_int;
using vector = std::array<integer, 3>;

/// The exponent of the last bit of x that is set; the greatest number for 0.
int last_bit(double x) {
    if (x == 0) return std::numeric_limits<int>::max();
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
    return exponent - 53 + std::countr_zero(static_cast<std::uint64_t>(mantissa));
}

/// x / 2^unit, which is an integer.
integer in_units(double x, int unit) {
    if (x == 0) return 0;
    const int last = last_bit(x);
    return integer(static_cast<std::int64_t>(std::ldexp(x, -last))) << static_cast<unsigned>(last - unit);
}

/// Units that divide all entries of matrices and vertices, and a unit of coordinates in the world.
struct units {
    int matrix = std::numeric_limits<int>::max(), vertex = matrix, world = matrix;

    void note(const distance_judge::placement& at, const distance_judge::triangle& t) {
        for (const double r : at.rotation) matrix = std::min(matrix, last_bit(r));
        for (const auto& corner : t)
            for (const double x : corner) vertex = std::min(vertex, last_bit(x));
        for (const double x : at.translation) world = std::min(world, last_bit(x));
    }
    void close() {
        for (int* const unit : {&matrix, &vertex})
            if (*unit == std::numeric_limits<int>::max()) *unit = 0;  // all are 0
        world = std::min(world, matrix + vertex);
    }
};

vector placed(const units& in, const distance_judge::placement& at, const distance_judge::point& p) {
    vector world;
    for (std::size_t k = 0; k < 3; ++k) {
        integer sum = 0;
        for (std::size_t j = 0; j < 3; ++j)
            sum += in_units(at.rotation[3 * k + j], in.matrix) * in_units(p[j], in.vertex);
        world[k] =
            (sum << static_cast<unsigned>(in.matrix + in.vertex - in.world)) + in_units(at.translation[k], in.world);
    }
    return world;
}

vector between(const vector& p, const vector& q) {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
integer product(const vector& p, const vector& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/// By expansion along the first row.
integer determinant(const std::vector<std::vector<integer>>& m) {
    if (m.empty()) return 1;
    integer sum = 0;
    for (std::size_t c = 0; c < m.size(); ++c) {
        std::vector<std::vector<integer>> minor;
        for (std::size_t r = 1; r < m.size(); ++r) {
            minor.push_back(m[r]);
            minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(c));
        }
        const integer term = m[0][c] * determinant(minor);
        c % 2 == 0 ? sum += term : sum -= term;
    }
    return sum;
}

/// The corners of each face of a triangle, as bits: corners, edges and the triangle.
std::vector<std::vector<std::size_t>> faces() {
    std::vector<std::vector<std::size_t>> all;
    for (unsigned bits = 1; bits < 8; ++bits) {
        all.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            if ((bits >> i & 1U) != 0) all.back().push_back(i);
    }
    return all;
}

}  // namespace

struct distance_judge::quotient {
    integer numerator, denominator;  // times 2^(2 unit)
    int unit;
};

/// The least of the distances of all pairs of faces. For each, the points p of the one and q of the other for which p -
/// q is perpendicular to both solve a linear system, whose matrix is that of the dot products of all edges. Where it is
/// singular, the same distance is that of smaller faces. Points outside the faces do not count.
distance_judge::distance_judge(const placement& of_s, const triangle& s, const placement& of_t, const triangle& t) {
    units in;
    in.note(of_s, s);
    in.note(of_t, t);
    in.close();
    std::array<vector, 3> p, q;
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = placed(in, of_s, s[i]);
        q[i] = placed(in, of_t, t[i]);
    }
    for (const auto& f : faces())
        for (const auto& g : faces()) {
            std::vector<vector> edges;
            for (std::size_t i = 1; i < f.size(); ++i) edges.push_back(between(p[f[i]], p[f[0]]));
            for (std::size_t i = 1; i < g.size(); ++i) edges.push_back(between(q[g[0]], q[g[i]]));
            const vector start = between(p[f[0]], q[g[0]]);
            std::vector<std::vector<integer>> matrix;
            for (const vector& e : edges) {
                matrix.emplace_back();
                for (const vector& other : edges) matrix.back().push_back(product(e, other));
            }
            const integer whole = determinant(matrix);  // not negative: it is that of a Gram matrix
            if (whole == 0) continue;
            std::vector<integer> weights;  // times `whole`, by Cramer's rule
            for (std::size_t c = 0; c < edges.size(); ++c) {
                auto replaced = matrix;
                for (std::size_t r = 0; r < edges.size(); ++r) replaced[r][c] = -product(edges[r], start);
                weights.push_back(determinant(replaced));
            }
            integer of_f = 0, of_g = 0;
            for (std::size_t i = 0; i < weights.size(); ++i) (i + 1 < f.size() ? of_f : of_g) += weights[i];
            if (of_f > whole || of_g > whole || std::ranges::any_of(weights, [](const integer& w) { return w < 0; }))
                continue;
            vector difference;
            for (std::size_t k = 0; k < 3; ++k) {
                difference[k] = start[k] * whole;
                for (std::size_t i = 0; i < edges.size(); ++i) difference[k] += edges[i][k] * weights[i];
            }
            quotient squared{product(difference, difference), whole * whole, in.world};
            if (!squared_ || squared.numerator * squared_->denominator < squared_->numerator * squared.denominator)
                squared_ = std::make_unique<quotient>(std::move(squared));
        }
}

distance_judge::~distance_judge() = default;

int distance_judge::compare(double d) const {
    const int unit = std::min(squared_->unit, d == 0 ? squared_->unit : last_bit(d));
    const integer length = in_units(d, unit);
    const integer numerator = squared_->numerator << static_cast<unsigned>(2 * (squared_->unit - unit));
    const integer difference = numerator - length * length * squared_->denominator;
    return difference.sign();
}

double distance_judge::rounded() const {
    using real = boost::multiprecision::cpp_bin_float_100;
    const real root = sqrt(real(squared_->numerator) / real(squared_->denominator));
    return static_cast<double>(ldexp(root, squared_->unit));
}
