/// Pictures that show a scene at a glance.
export module aabblab.picture;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// Collects the data of a picture, frame by frame.
class picture_data {
public:
    [[nodiscard]] static bool takes_part(std::span<const std::uint8_t> present, std::size_t object) {
        return present.empty() || present[object] != 0;
    }
    struct frame {
        std::vector<aabb::box> boxes;
        std::vector<std::uint8_t> present;  ///< by object; empty if all are present

        [[nodiscard]] bool has(std::size_t object) const { return takes_part(present, object); }
    };
    /// The centre of an object in every frame, or in every n-th of many; empty while it is absent.
    using path = std::vector<std::optional<aabb::vec3d>>;

    /// @param frames number in the scene; `add_frame` must be called for each of them
    picture_data(std::size_t objects, std::size_t frames);

    void add_frame(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);

    [[nodiscard]] std::size_t frames() const { return frames_seen_; }
    [[nodiscard]] const frame& first() const { return first_; }
    [[nodiscard]] const frame& last() const { return last_; }
    /// Paths of some objects, with evenly spaced ids.
    [[nodiscard]] std::span<const path> paths() const { return paths_; }

    /// The bounding box of all frames; empty_box() without boxes.
    [[nodiscard]] const aabb::box& world() const { return world_; }
    /// The sides of the world; 0 on a flat axis, on which all boxes of a frame are equal.
    [[nodiscard]] aabb::vec3d sides() const;

    /// The mean displacement of centres per frame, over the mean longest extent or the mean spacing; empty without any.
    [[nodiscard]] std::optional<double> displacement_over_extent() const;
    [[nodiscard]] std::optional<double> displacement_over_spacing() const;

private:
    [[nodiscard]] std::optional<double> displacement_over(double length) const;
    void measure(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);
    void extend_paths(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);

    std::size_t frames_seen_ = 0;
    std::size_t path_stride_ = 1;  // frames between the places of a path
    frame first_;
    frame last_;
    std::vector<std::size_t> followed_;  // objects with paths
    std::vector<path> paths_;
    aabb::box world_ = aabb::empty_box();
    std::array<bool, 3> is_flat_{true, true, true};
    double displacements_ = 0;
    double extents_ = 0;
    std::size_t displacements_counted_ = 0;
    std::size_t boxes_counted_ = 0;
};

/// "mean displacement per frame: 0.1 of the mean extent, 0.063 of the mean spacing"
[[nodiscard]] std::string displacement_text(const picture_data& data);

struct picture_caption {
    std::string name;
    std::string summary;
    std::string parameters;
};

/// The first and the last frame as SVG, projected along the narrowest axis of the scene; overlapping boxes have another
/// colour. Of many boxes, only the largest and a sample of the others are drawn.
/// @param data of at least one frame
[[nodiscard]] std::string picture_of(const picture_data& data, const picture_caption& caption);

}  // namespace aabblab
