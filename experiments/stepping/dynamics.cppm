export module aabblab.stepping:dynamics;

import aabb.base;
import :contact_law;

export namespace aabblab {

/// A rigid body that translates only: its moment of inertia is assumed to be infinite, and contacts are frictionless.
struct body {
    std::uint32_t mesh = 0;
    aabb::vec3d position = {0, 0, 0};                              ///< of the mesh's origin, m
    aabb::vec3d velocity = {0, 0, 0};                              ///< m/s
    double mass = std::numeric_limits<double>::infinity();         ///< kg; infinite for a fixed body
    std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, from mesh to world
};

/// Positions and velocities of all bodies, with three components per body.
struct motion_state {
    std::vector<double> position;  ///< m
    std::vector<double> velocity;  ///< m/s
    double time = 0;               ///< s
};

/// Bodies under gravity with contact forces.
struct stepped_world {
    std::vector<aabb::mesh> meshes;
    std::vector<body> bodies;
    contact_law law;
    double gravity = 0;  ///< downwards, along z, m/s²

    [[nodiscard]] motion_state start() const;
    [[nodiscard]] std::vector<std::uint32_t> mesh_of() const;
    void place(std::span<const double> position, std::vector<aabb::pose>& poses) const;
};

/// Computes the accelerations of bodies from the detected contacts.
class dynamics {
public:
    explicit dynamics(const stepped_world& world) : world_(world) {}

    /// @param contacts detected at these positions, sorted
    void accelerate(std::span<const double> position, std::span<const double> velocity,
                    std::span<const aabb::contact> contacts, std::span<double> acceleration);

    /// The energy of springs at the last call of `accelerate`, J.
    [[nodiscard]] double spring_energy() const { return spring_energy_; }

    /// Kinetic energy and potential energy above z = 0, J.
    [[nodiscard]] double mechanical_energy(const motion_state& state) const;

private:
    const stepped_world& world_;
    std::vector<aabb::pose> poses_;
    double spring_energy_ = 0;
};

/// x'' = a(x, v): sets the acceleration for a position and a velocity. Every call detects contacts once.
using acceleration_of = std::function<void(const std::vector<double>& position, const std::vector<double>& velocity,
                                           std::vector<double>& acceleration)>;

/// Integrates one trajectory: later calls must pass the state that the previous one left, and the same acceleration.
class integrator : public aabb::kept_in_place {
public:
    /// Advances the state by `step`, s; an adaptive integrator divides it into steps of its own choice.
    /// @throws aabb::input_error if it fails.
    virtual void advance(const acceleration_of& acceleration, motion_state& state, double step) = 0;
};

struct integrator_info {
    std::string_view name;
    std::string_view summary;
    bool adaptive = false;  ///< chooses its own steps, by a tolerance
    int order;
    /// The limit of step times angular frequency below which an undamped oscillation does not grow; may be infinite.
    double stable_below = std::numeric_limits<double>::infinity();
    std::unique_ptr<integrator> (*make)(double tolerance);  ///< only adaptive ones use the tolerance
    /// Whether the energy of an oscillation does not drift: here, of Euler and Verlet, unlike Runge-Kutta and BDF.
    [[nodiscard]] bool is_symplectic() const { return !adaptive && order <= 2; }
};

[[nodiscard]] std::span<const integrator_info> integrators();
/// Integrators that this build lacks, since their library was not found.
[[nodiscard]] std::span<const std::string_view> left_out_integrators();
/// Null if this build has no integrator of this name.
[[nodiscard]] const integrator_info* integrator_named(std::string_view name);

}  // namespace aabblab
