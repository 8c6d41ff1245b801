#pragma once

#include <array>
#include <memory>

/// A judge of distances of triangles at poses that shares no formula with the library: integers of any size, and the
/// normal equations of every two faces.
class distance_judge {
public:
    using point = std::array<double, 3>;
    using triangle = std::array<point, 3>;
    struct placement {
        std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
        point translation{};
    };

    distance_judge(const placement& of_s, const triangle& s, const placement& of_t, const triangle& t);
    ~distance_judge();

    /// The sign of the distance minus d, for d >= 0.
    [[nodiscard]] int compare(double d) const;
    /// The distance, rounded; 0 or infinity beyond the range of double.
    [[nodiscard]] double rounded() const;

private:
    struct quotient;
    std::unique_ptr<quotient> squared_;
};
