export module aabblab.stepping:dynamics;

import aabb.base;
import :contact_law;
import :rotation;

export namespace aabblab {

/// A rigid body. Without a tensor of inertia it only translates.
struct body {
    std::uint32_t mesh = 0;
    /// The place of the mesh's origin, m; it is the centre of mass of a body that turns.
    aabb::vec3d position = {0, 0, 0};
    aabb::vec3d velocity = {0, 0, 0};                       ///< m/s
    double mass = std::numeric_limits<double>::infinity();  ///< kg; infinite for a body that does not translate
    matrix3 rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};         ///< row-major, from mesh to world
    std::optional<matrix3> inertia = {};                    ///< about the origin, in the mesh's axes, kg m²
    aabb::vec3d angular_velocity = {0, 0, 0};               ///< of a body with inertia, in the world's axes, rad/s
    double radius = 0;                                      ///< of a ball (`placed_mesh::radius`), m
};

/// Positions and velocities of all bodies, with three components per body, and orientations and angular momenta of
/// those that turn, in the same order (see the partition `rotation`).
struct motion_state {
    std::vector<double> position;               ///< m
    std::vector<double> velocity;               ///< m/s
    double time = 0;                            ///< s
    std::vector<double> orientation = {};       ///< unit quaternions x, y, z, w
    std::vector<double> angular_momentum = {};  ///< three components per body that turns, kg m²/s

    [[nodiscard]] std::size_t turning_bodies() const { return orientation.size() / 4; }
    [[nodiscard]] std::span<const double, 4> orientation_of(std::size_t turning) const {
        return std::span(orientation).subspan(4 * turning).first<4>();
    }
    [[nodiscard]] std::span<const double, 3> momentum_of(std::size_t turning) const {
        return std::span(angular_momentum).subspan(3 * turning).first<3>();
    }
};

/// What changes the velocities and angular momenta of a motion_state, in its order.
struct motion_rates {
    std::vector<double> acceleration;  ///< m/s²
    std::vector<double> torque;        ///< about the centre of mass, in the world's axes, N m

    void fit(const motion_state& state) {
        acceleration.resize(state.velocity.size());
        torque.resize(state.angular_momentum.size());
    }
};

/// Bodies under gravity with contact forces.
struct stepped_world {
    std::vector<aabb::mesh> meshes;
    std::vector<body> bodies;
    contact_law law;
    double gravity = 0;  ///< downwards, along z, m/s²

    [[nodiscard]] motion_state start() const;
    /// The moments of inertia of the bodies that turn.
    [[nodiscard]] std::vector<rotor> rotors() const;
    [[nodiscard]] std::vector<std::uint32_t> mesh_of() const;
    void place(const motion_state& state, std::vector<aabb::pose>& poses) const;
};

/// Computes the accelerations of bodies from the detected contacts.
class dynamics {
public:
    /// @throws aabb::input_error if a body's inertia is impossible, or there is friction without a slip speed.
    explicit dynamics(const stepped_world& world);

    /// @param contacts detected at these positions, sorted
    void accelerate(const motion_state& state, std::span<const aabb::contact> contacts, motion_rates& rates);

    /// The energy of springs at the last call of `accelerate`, J.
    [[nodiscard]] double spring_energy() const { return spring_energy_; }

    /// Kinetic energy and potential energy above z = 0, J.
    [[nodiscard]] double mechanical_energy(const motion_state& state) const;

    /// The angular velocity in the world's axes, rad/s; zero for a body without inertia.
    [[nodiscard]] aabb::vec3d angular_velocity(const motion_state& state, std::size_t body) const;

private:
    const stepped_world& world_;
    std::vector<rotor> rotors_;
    std::vector<std::optional<std::size_t>> turning_;  // index of a body among those that turn
    std::vector<aabb::pose> poses_;
    std::vector<rigid_motion> motions_;
    double spring_energy_ = 0;
};

/// x'' = a(x, v), and the change of angular momentum, with the moments of inertia of the bodies that turn.
struct equations_of_motion {
    /// Sets the rates of a state, whose vectors have the size that they need. Every call detects contacts once.
    std::function<void(const motion_state&, motion_rates&)> rates;
    std::vector<rotor> rotors = {};
};

/// Turns every body that turns as without a torque (`turn_freely`).
void turn_all_freely(std::span<const rotor> rotors, motion_state& state, double time);

/// Integrates one trajectory: later calls must pass the state that the previous one left, and the same equations.
///
/// Fixed steps of Euler and Verlet turn bodies by `turn_freely`, which stays on the group of rotations. Solvers for
/// systems of first order get the components of the quaternion: its length has no effect, since orientations are
/// normalised before use, and is set to 1 after each step, which keeps the order (Hairer, Lubich and Wanner 2006,
/// IV.4). Exponential coordinates instead would need a new chart, and so a restart of multistep methods, before half a
/// turn.
class integrator : public aabb::kept_in_place {
public:
    /// Advances the state by `step`, s; an adaptive integrator divides it into steps of its own choice.
    /// @throws aabb::input_error if it fails.
    virtual void advance(const equations_of_motion& equations, motion_state& state, double step) = 0;
};

struct integrator_info {
    std::string_view name;
    std::string_view summary;
    bool adaptive = false;  ///< chooses its own steps, by a tolerance
    int order;
    /// The leading error of an undamped oscillation after half a period, relative to its amplitude: this times the
    /// order-th power of step times angular frequency. 0 if adaptive.
    double half_period_error = 0;
    /// How many steps old the velocity is that forces see. Above 0, the order is 1 if forces depend on velocity.
    double velocity_lag = 0;
    /// The limit of step times angular frequency below which an undamped oscillation does not grow; 0 if it always
    /// grows, infinite if it never does.
    double stable_below = std::numeric_limits<double>::infinity();
    /// The factor by which a step multiplies the energy of an undamped oscillation, from step times angular frequency.
    /// Null if the energy is bounded, or if the integrator is adaptive.
    double (*energy_factor)(double scaled_step) = nullptr;
    std::unique_ptr<integrator> (*make)(double tolerance);  ///< only adaptive ones use the tolerance
    /// Whether the energy of an oscillation does not drift.
    [[nodiscard]] bool is_symplectic() const { return !adaptive && energy_factor == nullptr; }
};

[[nodiscard]] std::span<const integrator_info> integrators();
/// Integrators that this build lacks, since their library was not found.
[[nodiscard]] std::span<const std::string_view> left_out_integrators();
/// Null if this build has no integrator of this name.
[[nodiscard]] const integrator_info* integrator_named(std::string_view name);

}  // namespace aabblab
