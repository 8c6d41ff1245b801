module;
#include <Eigen/Core>

module aabblab.scenes:pile;

import :boxes;

namespace aabblab {

/// Jiggling unit cubes piled on a floor: their lowest corners fill a pyramid half as high as it is wide.
class pile final : public generated_boxes {
public:
    static constexpr std::string_view name = "pile";
    static constexpr std::string_view summary =
        "unit cubes heaped on a floor, each overlapping many others and jiggling about its place";

    struct config : motion_config {
        config() { displacement = 0.02; }
        std::uint32_t neighbours = 20;
    };
    static constexpr auto parameters =
        std::tuple_cat(motion_parameters_with("displacement of each box per frame"),
                       std::tuple{aabb::integer_parameter{"neighbours", &config::neighbours, 10U, 50U,
                                                          "mean number of others that a box overlaps"}});

    /// Places boxes at random in a heap of such a height that each overlaps the wanted number on average.
    pile(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(jiggling_box)) {
        const double height = height_for(c);
        step_ = step_of(c, 1, {2 * height + 1, 2 * height + 1, height + 1});
        boxes_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            const Eigen::Vector3d home = place_in_heap(height);
            boxes_.push_back({home, /*corner=*/home});
        }
    }

private:
    struct jiggling_box {
        Eigen::Vector3d home;
        Eigen::Vector3d corner;
    };

    static bool is_in_heap(const Eigen::Vector3d& p, double height) {
        return p[2] >= 0 && std::abs(p[0]) <= height - p[2] && std::abs(p[1]) <= height - p[2];
    }

    Eigen::Vector3d place_in_heap(double height) {
        while (true) {
            const Eigen::Vector3d p = {random_.signed_unit() * height, random_.signed_unit() * height,
                                       random_.unit() * height};
            if (is_in_heap(p, height)) return p;
        }
    }

    /// The height h at which a box overlaps `neighbours` others on average. It overlaps those whose corners lie in the
    /// cube of volume 8 around its own; of this cube, a share lies in the heap, of volume 4/3 h^3. So neighbours =
    /// (objects - 1) · 8 share / (4/3 h^3). The share depends on h: the equation is solved by fixed-point iteration.
    double height_for(const config& c) {
        if (c.objects < 2) return 1;
        double height = 0;
        double share = 1;
        for (int iteration = 0; iteration < 10; ++iteration) {
            height = cube_root(6 * share * (c.objects - 1) / c.neighbours);
            if (height < 1) return 1;
            share = share_in_heap(height);
        }
        return height;
    }

    /// Estimates, by sampling, which share of the cube of edge 2 around a box's corner lies in the heap, on average.
    double share_in_heap(double height) {
        constexpr int samples = 4096;
        int inside = 0;
        for (int i = 0; i < samples; ++i) {
            const Eigen::Vector3d beside = {random_.signed_unit(), random_.signed_unit(), random_.signed_unit()};
            inside += is_in_heap(place_in_heap(height) + beside, height);
        }
        return static_cast<double>(inside) / samples;
    }

    /// A box moves along a random line, in the direction that leads nearer home, and bounces off the floor.
    void advance() override {
        for (jiggling_box& b : boxes_) {
            const Eigen::Vector3d direction = random_.direction();
            b.corner += direction * (dot(direction, b.corner - b.home) > 0 ? -step_ : step_);
            b.corner[2] = std::abs(b.corner[2]);
        }
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cube_at(boxes_[i].corner, 1);
    }

    double step_;
    std::vector<jiggling_box> boxes_;
};

}  // namespace aabblab
