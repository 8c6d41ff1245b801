module;
#include <Eigen/QR>

module aabblab.stepping;

import aabb.base;

namespace aabblab {

namespace {

/// Solves J d = r by GMRES (Saad and Schultz 1986) for a matrix that is known by its products only.
/// @param product sets its second argument to J times the first
template <class Product>
Eigen::VectorXd gmres(const Product& product, const Eigen::VectorXd& r) {
    constexpr double tolerance = 1e-6;  // of the residual, relative to r
    const Eigen::Index most = std::min<Eigen::Index>(r.size(), 50);
    const double size = r.norm();
    Eigen::MatrixXd basis(r.size(), 1);  // orthonormal
    basis.col(0) = r / size;
    Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(most + 1, most);  // J basis = (larger basis) reduced
    Eigen::VectorXd coefficients, next;
    for (Eigen::Index j = 0; j < most; ++j) {
        product(basis.col(j), next);
        // Twice, as rounding leaves a part along the basis.
        for (int pass = 0; pass < 2; ++pass) {
            const Eigen::VectorXd along = basis.transpose() * next;
            reduced.col(j).head(j + 1) += along;
            next -= basis * along;
        }
        reduced(j + 1, j) = next.norm();
        const Eigen::VectorXd right = size * Eigen::VectorXd::Unit(j + 2, 0);
        const auto system = reduced.topLeftCorner(j + 2, j + 1);
        coefficients = system.colPivHouseholderQr().solve(right);
        if ((right - system * coefficients).norm() <= tolerance * size || reduced(j + 1, j) == 0) break;
        if (j + 1 == most) break;
        basis.conservativeResize(Eigen::NoChange, j + 2);
        basis.col(j + 1) = next / reduced(j + 1, j);
    }
    return basis * coefficients;
}

/// Finds x = g(x) by Newton's method, with directional derivatives from differences (Knoll and Keyes 2004, J. Comput.
/// Phys. 193, 357). Where g is linear between jumps of its slope, as contacts of springs are, it ends once it knows
/// which contacts there are.
/// @param g sets its second argument to g of the first
/// @param negligible size of g(x) - x, for an x near 0 that is the difference of great numbers
/// @returns whether x converged
template <class Function>
bool solve(const Function& g, Eigen::VectorXd& x, double negligible) {
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-14;     // of a change relative to x
    constexpr double difference = 1e-7;     // of x for a derivative, relative to x and its change
    constexpr double near_solution = 1e-4;  // of g(x) - x relative to both; farther where g jumps
    Eigen::VectorXd image, moved_image;
    double last_change = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_iterations; ++i) {
        g(x, image);
        const Eigen::VectorXd residual = image - x;
        if (!std::isfinite(residual.norm())) return false;
        if (residual.norm() == 0) return true;
        const double step = difference * std::max(x.norm(), residual.norm());
        const Eigen::VectorXd change = gmres(
            [&](const Eigen::VectorXd& direction, Eigen::VectorXd& product) {
                g(x + step * direction, moved_image);
                product = direction - (moved_image - image) / step;
            },
            residual);
        x += change;
        if (residual.norm() <= std::max(negligible, near_solution * (image.norm() + x.norm()))) {
            if (change.norm() <= tolerance * x.norm()) return true;
            // Rounding is all that is left once changes no longer shrink.
            constexpr double small = 1e-8;
            if (change.norm() > last_change / 2 && (residual.norm() <= negligible || change.norm() <= small * x.norm()))
                return true;
        }
        last_change = change.norm();
    }
    return false;
}

/// Bodies turn by `turn_freely` with the angular momentum of the middle of the step.
class implicit_midpoint final : public integrator {
public:
    /// Solves for the rates at the middle of the step, where position and velocity depend on them too.
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        const auto velocities = static_cast<Eigen::Index>(state.velocity.size());
        const auto momenta = static_cast<Eigen::Index>(state.angular_momentum.size());
        motion_state middle = state;
        motion_rates rates;
        rates.fit(state);
        // Of the middle, for accelerations and torques.
        const auto set_middle = [&](const Eigen::VectorXd& change) {
            in_vector(middle.velocity) = in_vector(state.velocity) + step / 2 * change.head(velocities);
            in_vector(middle.position) = in_vector(state.position) + step / 2 * in_vector(middle.velocity);
            in_vector(middle.angular_momentum) = in_vector(state.angular_momentum) + step / 2 * change.tail(momenta);
        };
        const auto rates_in_middle = [&](const Eigen::VectorXd& change, Eigen::VectorXd& result) {
            set_middle(change);
            middle.orientation = state.orientation;
            turn_all_freely(equations.rotors, middle, step / 2);
            equations.rates(middle, rates);
            result.resize(velocities + momenta);
            result.head(velocities) = in_vector(rates.acceleration);
            result.tail(momenta) = in_vector(rates.torque);
        };
        if (last_.size() != velocities + momenta) last_ = Eigen::VectorXd::Zero(velocities + momenta);
        // Accelerations that change positions by no more than their rounding.
        const double negligible =
            std::numeric_limits<double>::epsilon() * in_vector(state.position).norm() / (step * step);
        if (!solve(rates_in_middle, last_, negligible))
            throw aabb::input_error("implicit_midpoint gives up after " + std::to_string(state.time) +
                                    " s: its equation does not converge");
        set_middle(last_);
        middle.orientation = state.orientation;
        turn_all_freely(equations.rotors, middle, step);
        state.orientation = middle.orientation;
        in_vector(state.position) += step * in_vector(middle.velocity);
        in_vector(state.velocity) += step * last_.head(velocities);
        in_vector(state.angular_momentum) += step * last_.tail(momenta);
        state.time += step;
    }

private:
    static Eigen::Map<Eigen::VectorXd> in_vector(std::vector<double>& values) {
        return {values.data(), static_cast<Eigen::Index>(values.size())};
    }

    Eigen::VectorXd last_;  // the rates of the last step, where the next search starts
};

}  // namespace

integrator_info implicit_midpoint_integrator() {
    return {.name = "implicit_midpoint",
            .summary = "implicit, with the force at the middle of a step: no linear oscillation ever grows",
            .order = 2,
            .half_period_error = std::numbers::pi / 12,  // π times the error z³/12 of a step over |z|³
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<implicit_midpoint>(); }};
}

}  // namespace aabblab
