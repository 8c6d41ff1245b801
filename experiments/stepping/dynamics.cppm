export module aabblab.stepping:dynamics;

import aabb.geometry;
import aabb.std;
import :body;
import :contact_law;

export namespace aabblab {

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

}  // namespace aabblab
