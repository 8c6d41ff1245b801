module aabb.distance.exact_distance;

import aabb.distance.exact_integer;

namespace aabb {

namespace {

/// All terms of two triangles, and the range of their bits.
struct pair_terms {
    std::array<corner_terms, 6> corners;
    term_range range;

    pair_terms(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept {
        for (std::size_t i = 0; i < 6; ++i) {
            const int corner = static_cast<int>(i % 3);
            corners[i] = i < 3 ? terms_of(poses.a, s[corner]) : terms_of(poses.b, t[corner]);
            range.note(corners[i]);
        }
    }
};

template <class Integer>
struct exact_vector {
    std::array<Integer, 3> at;

    friend exact_vector operator-(const exact_vector& p, const exact_vector& q) noexcept {
        return {{p.at[0] - q.at[0], p.at[1] - q.at[1], p.at[2] - q.at[2]}};
    }
    friend exact_vector operator+(const exact_vector& p, const exact_vector& q) noexcept {
        return {{p.at[0] + q.at[0], p.at[1] + q.at[1], p.at[2] + q.at[2]}};
    }
    friend exact_vector operator*(const exact_vector& p, const Integer& factor) noexcept {
        return {{p.at[0] * factor, p.at[1] * factor, p.at[2] * factor}};
    }
};

/// A point of a feature: the vector over the denominator, which is positive.
template <class Integer>
struct exact_point {
    exact_vector<Integer> numerator;
    Integer denominator;
};

template <class Integer>
scaled_double rounded_quotient(const Integer& numerator, const Integer& denominator, int unit) noexcept {
    const auto [p, p_exponent] = numerator.rounded_magnitude();
    const auto [q, q_exponent] = denominator.rounded_magnitude();
    int exponent = 0;
    const double mantissa = std::frexp(p / q, &exponent);
    return {numerator.sign() < 0 ? -mantissa : mantissa, exponent + p_exponent - q_exponent + unit};
}

template <class Integer>
vec3d rounded(const exact_point<Integer>& point, int unit) noexcept {
    vec3d p{};
    for (std::size_t k = 0; k < 3; ++k) {
        const scaled_double x = rounded_quotient(point.numerator.at[k], point.denominator, unit);
        p[static_cast<int>(k)] = std::ldexp(x.mantissa, x.exponent);
    }
    return p;
}

template <class Integer>
Integer dot(const exact_vector<Integer>& p, const exact_vector<Integer>& q) noexcept {
    return p.at[0] * q.at[0] + p.at[1] * q.at[1] + p.at[2] * q.at[2];
}
template <class Integer>
exact_vector<Integer> cross(const exact_vector<Integer>& p, const exact_vector<Integer>& q) noexcept {
    return {{p.at[1] * q.at[2] - p.at[2] * q.at[1], p.at[2] * q.at[0] - p.at[0] * q.at[2],
             p.at[0] * q.at[1] - p.at[1] * q.at[0]}};
}

/// The distances of the features of two triangles, as the class comment of `disjoint_triangles` lists them.
template <class Integer>
class exact_features {
public:
    explicit exact_features(const pair_terms& terms) noexcept {
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                for (const product_of_doubles& term : terms.corners[i][k])
                    if (term.magnitude != 0)
                        corners_[i].at[k] =
                            corners_[i].at[k] +
                            Integer(term.magnitude, term.exponent - terms.range.unit(), term.is_negative);
    }

    /// Calls `take` for each pair of features with numerator and denominator of their squared distance, and a function
    /// that returns the nearest points of s and of t, until it returns true.
    /// @returns whether it did
    template <class Take>
    bool each_distance(const Take& take) const noexcept {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const vector &a = corners_[i], &b = corners_[(i + 1) % 3];
                const vector &c = corners_[3 + j], &e = corners_[3 + (j + 1) % 3];
                if (corner_and_edge(a, c, e, take) || corner_and_edge(c, a, b, swapped(take)) ||
                    edges(a, b, c, e, take))
                    return true;
            }
        for (std::size_t i = 0; i < 3; ++i)
            if (corner_and_face(corners_[i], 3, take) || corner_and_face(corners_[3 + i], 0, swapped(take)))
                return true;
        return false;
    }

private:
    using vector = exact_vector<Integer>;
    using point = exact_point<Integer>;
    using points = std::pair<point, point>;

    static Integer one() noexcept { return Integer(1, 0, false); }

    /// Passes the points on in the opposite order.
    template <class Take>
    static auto swapped(const Take& take) noexcept {
        return [&take](const Integer& numerator, const Integer& denominator, const auto& nearest) {
            return take(numerator, denominator, [&nearest] {
                auto [second, first] = nearest();
                return points{first, second};
            });
        };
    }

    /// From a corner p to the beginning of an edge from a to b, and to its interior.
    template <class Take>
    static bool corner_and_edge(const vector& p, const vector& a, const vector& b, const Take& take) noexcept {
        const vector w = p - a, u = b - a;
        if (take(dot(w, w), one(), [&] { return points{{p, one()}, {a, one()}}; })) return true;
        const Integer along = dot(w, u), length = dot(u, u);
        if (along.sign() <= 0 || length <= along) return false;
        const vector x = cross(w, u);
        return take(dot(x, x), length, [&] { return points{{p, one()}, {a * length + u * along, length}}; });
    }

    /// Of the interiors of two edges that are not parallel, ab and ce. The nearest points a + s u and c + t v of their
    /// lines have w = c - a = s u - t v + r n, so that s n² = (w × v)·n, t n² = (w × u)·n and r n² = w·n.
    template <class Take>
    static bool edges(const vector& a, const vector& b, const vector& c, const vector& e, const Take& take) noexcept {
        const vector u = b - a, v = e - c, w = c - a;
        const vector n = cross(u, v);
        const Integer square = dot(n, n);
        if (square.sign() == 0) return false;
        const auto is_inside = [&](const Integer& along) { return along.sign() >= 0 && along <= square; };
        const Integer along_u = dot(cross(w, v), n);
        if (!is_inside(along_u)) return false;
        const Integer along_v = dot(cross(w, u), n);
        if (!is_inside(along_v)) return false;
        const Integer volume = dot(w, n);
        return take(volume * volume, square,
                    [&] { return points{{a * square + u * along_u, square}, {c * square + v * along_v, square}}; });
    }

    /// Of a corner and the interior of a face, whose first corner is given.
    template <class Take>
    bool corner_and_face(const vector& p, std::size_t face, const Take& take) const noexcept {
        const vector& origin = corners_[face];
        const vector u = corners_[face + 1] - origin, v = corners_[face + 2] - origin, w = p - origin;
        const vector n = cross(u, v);
        const Integer square = dot(n, n);
        if (square.sign() == 0) return false;
        const Integer along_u = dot(cross(w, v), n), along_v = dot(cross(u, w), n);
        if (along_u.sign() < 0 || along_v.sign() < 0 || !(along_u + along_v <= square)) return false;
        const Integer volume = dot(w, n);
        return take(volume * volume, square,
                    [&] { return points{{p, one()}, {origin * square + u * along_u + v * along_v, square}}; });
    }

    std::array<vector, 6> corners_{};
};

/// Calls `compute` with features in integers that are wide enough. A coordinate of four terms below 2^end is below
/// 2^(bits + 2), a difference 2^(bits + 3), a component of a normal 2^(2 bits + 7), a volume 2^(3 bits + 12), and its
/// square, times that of nothing else, 2^(6 bits + 24); the square of the mantissa of d, below 2^106, times a squared
/// normal is below 2^(4 bits + 122), and the numerator of a nearest point, a corner times a squared normal and edges
/// times as much, below 2^(5 bits + 22). A sum or a product may take one limb more before its leading zeros are
/// dropped. The greatest range is that of products of doubles, from 2^-2148 to 2^2048.
template <class Compute>
auto in_integers(const pair_terms& terms, const Compute& compute) noexcept {
    constexpr std::size_t narrow = 24, wide = 400;
    const int bits = std::max(6 * terms.range.bits() + 24, 4 * terms.range.bits() + 122);
    const std::size_t limbs = static_cast<std::size_t>(bits) / 64 + 3;
    if (limbs <= narrow) return compute(exact_integer<narrow>());
    return compute(exact_integer<wide>());
}

}  // namespace

bool disjoint_triangles::are_within(double d) const noexcept {
    const pair_terms terms(poses_, s_, t_);
    const odd_double length(d);
    // The power of two of d may be far from that of the corners, so that it stays apart.
    const int shift = 2 * (terms.range.unit() - length.exponent);
    return in_integers(terms, [&]<class Integer>(const Integer& /*zero*/) {
        const Integer square(unsigned_128{length.mantissa} * length.mantissa, 0, false);
        return exact_features<Integer>(terms).each_distance(
            [&](const Integer& numerator, const Integer& denominator, const auto& /*nearest*/) {
                return is_at_most(numerator, shift, square * denominator);
            });
    });
}

/// Numerators and denominators are rounded once, and so are their quotients: 3.01 u are less than 2^-51.
nearest_of_triangles disjoint_triangles::nearest() const noexcept {
    const pair_terms terms(poses_, s_, t_);
    return in_integers(terms, [&]<class Integer>(const Integer& /*zero*/) {
        std::optional<nearest_of_triangles> least;
        const auto take = [&](const Integer& numerator, const Integer& denominator, const auto& nearest) {
            const scaled_double squared = rounded_quotient(numerator, denominator, 2 * terms.range.unit());
            const auto order = [](const scaled_double& x) { return std::pair(x.exponent, x.mantissa); };
            if (least && !(order(squared) < order(least->squared))) return false;
            const auto [p, q] = nearest();
            least = nearest_of_triangles{squared, rounded(p, terms.range.unit()), rounded(q, terms.range.unit())};
            return false;  // continues
        };
        static_cast<void>(exact_features<Integer>(terms).each_distance(take));
        return *least;
    });
}

}  // namespace aabb
