#include "distance_judge.hpp"

#include <algorithm>
#include <bit>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace {

using integer = boost::multiprecision::mpz_int;
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

/// A matrix of at most three rows and columns, which are those of a larger one.
struct small_matrix {
    std::array<vector, 3> rows;
    std::size_t size = 0;

    [[nodiscard]] integer determinant() const {
        const auto& [a, b, c] = rows;
        switch (size) {
            case 0: return 1;
            case 1: return a[0];
            case 2: return a[0] * b[1] - a[1] * b[0];
            default:
                return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                       a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    void swap_column(std::size_t column, vector& other) {
        for (std::size_t r = 0; r < size; ++r) swap(rows[r][column], other[r]);
    }
};

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
/// singular, as with the four edges of two triangles, the same distance is that of smaller faces. Points outside the
/// faces do not count.
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
            if (edges.size() > 3) continue;
            const vector start = between(p[f[0]], q[g[0]]);
            small_matrix matrix{.rows = {}, .size = edges.size()};
            vector right;
            for (std::size_t r = 0; r < edges.size(); ++r) {
                for (std::size_t c = 0; c < edges.size(); ++c) matrix.rows[r][c] = product(edges[r], edges[c]);
                right[r] = -product(edges[r], start);
            }
            const integer whole = matrix.determinant();  // not negative: it is that of a Gram matrix
            if (whole == 0) continue;
            std::vector<integer> weights;  // times `whole`, by Cramer's rule
            for (std::size_t c = 0; c < edges.size(); ++c) {
                matrix.swap_column(c, right);
                weights.push_back(matrix.determinant());
                matrix.swap_column(c, right);
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
    if (squared_->numerator == 0) return 0;
    // An even power of two gives the quotient more than twice the bits of a double.
    constexpr std::ptrdiff_t bits = 112;
    const auto size = [](const integer& x) { return static_cast<std::ptrdiff_t>(msb(x)); };
    std::ptrdiff_t shift = bits - size(squared_->numerator) + size(squared_->denominator);
    shift += shift & 1;
    integer numerator = squared_->numerator, denominator = squared_->denominator;
    (shift > 0 ? numerator : denominator) <<= static_cast<unsigned>(std::abs(shift));
    const integer root = sqrt(integer(numerator / denominator));
    return std::ldexp(root.convert_to<double>(), squared_->unit - static_cast<int>(shift / 2));
}
