module;
#include <Eigen/Core>

module aabblab.scenes:adversarial;

import :boxes;

namespace aabblab {

/// Boxes with few pairs that broad phases find slowly: each construction defeats one of their ideas. All boxes move by
/// the same step, so that it lasts.
class adversarial final : public generated_boxes {
public:
    static constexpr std::string_view name = "adversarial";
    static constexpr std::string_view summary =
        "boxes with few pairs that defeat an idea of broad phases: cells, cuts, sorted lists, or one scale for all";

    enum class construction : unsigned char { rods, shells, plates, outlier, clumps };
    struct config : scene_size {
        construction kind = construction::rods;
        double displacement = 0.25;
    };
    static constexpr auto parameters = std::tuple_cat(
        size_parameters<config>("how many boxes"),
        std::tuple{
            aabb::choice_parameter{
                "construction", &config::kind,
                std::array<std::string_view, 5>{"rods", "shells", "plates", "outlier", "clumps"},
                "rods through the whole world along every axis, which cells and cuts copy; shells within shells, of "
                "which every sorted list overlaps half; plates that overlap on the axes where they vary most; cubes "
                "and an outlier, which puts them in one cell; clumps of clumps, which no scale suits"},
            aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                                   "displacement of all boxes per frame on each axis, in world units"}});

    adversarial(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, sizeof(aabb::boxd)), displacement_(c.displacement) {
        boxes_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            switch (c.kind) {
                case construction::rods: boxes_.push_back(rod(i, c.objects)); break;
                case construction::shells: boxes_.push_back(side_of_shell(i)); break;
                case construction::plates: boxes_.push_back(plate(i, c.objects)); break;
                case construction::outlier: boxes_.push_back(cube_or_outlier(i, c.objects)); break;
                case construction::clumps: boxes_.push_back(cube_of_clump(i)); break;
            }
        }
    }

private:
    static constexpr int cube_edge = 4;

    void place(std::span<aabb::box> boxes) override {
        const double shift = static_cast<double>(frame()) * displacement_;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                boxes[i].min[k] = static_cast<float>(boxes_[i].min[k] + shift);
                boxes[i].max[k] = static_cast<float>(boxes_[i].max[k] + shift);
            }
    }

    /// Rods of two directions share an axis across both, on which they lie in even or odd slots of 3: so they do not
    /// meet.
    aabb::boxd rod(std::uint32_t i, std::uint32_t objects) {
        const int along = static_cast<int>(i % 3);
        const std::uint32_t places = objects / 6 + 1;
        aabb::boxd b{};
        for (int k = 0; k < 3; ++k) {
            const double at = 6.0 * random_.below(places) + (k == (along + 1) % 3 ? 0 : 3) + 2 * random_.unit();
            b.min[k] = k == along ? 0 : at;
            b.max[k] = k == along ? 6.0 * places : at + 1;
        }
        return b;
    }
    /// One of six sides, without thickness, of the cube of that number; it ends before the edges, so that it touches
    /// none of the others.
    [[nodiscard]] static aabb::boxd side_of_shell(std::uint32_t i) {
        const std::uint32_t cube = i / 6;
        const double radius = 2.0 * cube + 2;
        aabb::boxd b{{1 - radius, 1 - radius, 1 - radius}, {radius - 1, radius - 1, radius - 1}};
        const int across = static_cast<int>(i % 3);
        b.min[across] = b.max[across] = i % 6 < 3 ? -radius : radius;
        return b;
    }
    /// They lie apart on y alone; on z they vary more, and each overlaps half of the others.
    [[nodiscard]] static aabb::boxd plate(std::uint32_t i, std::uint32_t objects) {
        const double at = i;
        return {{-at, at, 2 * at}, {at, at + 0.5, 2 * at + objects}};
    }
    /// Cubes fill a tenth of their world; the outlier is so far from it that a cell of a grid over both holds all of
    /// it.
    aabb::boxd cube_or_outlier(std::uint32_t i, std::uint32_t objects) {
        const double width = edge_of(10.0 * objects, /*axes=*/3);
        const Eigen::Vector3d corner = i == 0 ? Eigen::Vector3d::Constant(1000 * width) : random_.point(width);
        return {{corner[0], corner[1], corner[2]}, {corner[0] + 1, corner[1] + 1, corner[2] + 1}};
    }
    /// Eight cubes touch in a clump, eight clumps lie in one of eight times its size, and so on: octal digits of the
    /// number are the places within each.
    [[nodiscard]] static aabb::boxd cube_of_clump(std::uint32_t i) {
        aabb::boxd b{};
        double scale = cube_edge;
        for (; i > 0; i /= 8, scale *= 8)
            for (int k = 0; k < 3; ++k) b.min[k] += scale * (i >> k & 1U);
        for (int k = 0; k < 3; ++k) b.max[k] = b.min[k] + cube_edge;
        return b;
    }

    double displacement_;
    std::vector<aabb::boxd> boxes_;
};

}  // namespace aabblab
