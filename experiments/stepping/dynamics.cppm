export module aabblab.stepping:dynamics;

import :contact_law;

export namespace aabblab {

/// A rigid body that moves without turning: contacts have no friction, and its moment of inertia is taken for infinite.
struct body {
    std::uint32_t mesh = 0;
    aabb::vec3d position = {0, 0, 0};                              ///< of the mesh's origin, m
    aabb::vec3d velocity = {0, 0, 0};                              ///< m/s
    double mass = std::numeric_limits<double>::infinity();         ///< kg; one without end stands still
    std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, from the mesh's frame
};

/// Where all bodies are: three numbers a body.
struct motion_state {
    std::vector<double> position;  ///< m
    std::vector<double> velocity;  ///< m/s
    double time = 0;               ///< s
};

/// Bodies under gravity that push each other.
struct stepped_world {
    std::vector<aabb::mesh> meshes;
    std::vector<body> bodies;
    contact_law law;
    double gravity = 0;  ///< downwards, along z, m/s²

    [[nodiscard]] motion_state start() const;
    [[nodiscard]] std::vector<std::uint32_t> mesh_of() const;
    /// Where the bodies stand with these positions.
    void place(std::span<const double> position, std::vector<aabb::pose>& poses) const;
};

/// What acts on the bodies of a world, given what was found to intersect.
class dynamics {
public:
    explicit dynamics(const stepped_world& world) : world_(world) {}

    /// @param contacts found where the bodies are, sorted
    void accelerate(std::span<const double> position, std::span<const double> velocity,
                    std::span<const aabb::contact> contacts, std::span<double> acceleration);

    /// In springs at the last call, J.
    [[nodiscard]] double spring_energy() const { return spring_energy_; }

    /// Of motion and height, J, above z = 0.
    [[nodiscard]] double mechanical_energy(const motion_state& state) const;

private:
    const stepped_world& world_;
    std::vector<aabb::pose> poses_;
    double spring_energy_ = 0;
};

/// x'' = a(x, v): takes position and velocity, sets the acceleration. Every call is one detection.
using acceleration_of = std::function<void(const std::vector<double>& position, const std::vector<double>& velocity,
                                           std::vector<double>& acceleration)>;

/// Follows one trajectory: after the first call the state is the one that it left, and the acceleration the same.
class integrator {
public:
    integrator() = default;
    integrator(const integrator&) = delete;
    integrator& operator=(const integrator&) = delete;
    virtual ~integrator() = default;

    /// From the state's time on by `step`, s; one that chooses its own steps takes as many as it needs.
    /// @throws aabb::input_error where it cannot.
    virtual void advance(const acceleration_of& acceleration, motion_state& state, double step) = 0;
};

struct integrator_info {
    std::string_view name;
    std::string_view summary;
    bool adaptive;  ///< it chooses its own steps, after a tolerance
    int order;
    /// The greatest step times angular frequency with which an undamped oscillation does not grow; or infinite.
    double stable_below;
    std::unique_ptr<integrator> (*make)(double tolerance);  ///< the tolerance is of adaptive ones
};

[[nodiscard]] std::span<const integrator_info> integrators();
/// Those that this build lacks, because their library was not there.
[[nodiscard]] std::span<const std::string_view> left_out_integrators();
/// Null where this build has none of this name.
[[nodiscard]] const integrator_info* integrator_named(std::string_view name);

}  // namespace aabblab
