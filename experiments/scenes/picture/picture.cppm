/// Pictures of scenes, for people to see at a glance what a scene is.
export module aabblab.picture;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// What is seen of a scene as it is played, frame by frame.
class survey {
public:
    [[nodiscard]] static bool takes_part(std::span<const std::uint8_t> present, std::size_t object) {
        return present.empty() || present[object] != 0;
    }
    struct frame {
        std::vector<aabb::box> boxes;
        std::vector<std::uint8_t> present;  ///< by object; empty where all are

        [[nodiscard]] bool has(std::size_t object) const { return takes_part(present, object); }
    };
    /// Where an object's centre was, in every frame or every few of many; empty while it was absent.
    using path = std::vector<std::optional<aabb::vec3d>>;

    /// @param objects of the scene
    /// @param frames of the scene; all of them will be seen
    survey(std::size_t objects, std::size_t frames);

    void see(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);

    [[nodiscard]] std::size_t frames() const { return frames_seen_; }
    [[nodiscard]] const frame& first() const { return first_; }
    [[nodiscard]] const frame& last() const { return last_; }
    /// Of some objects, evenly spread over the ids.
    [[nodiscard]] std::span<const path> paths() const { return paths_; }

    /// Around all boxes of all frames; empty_box() where there are none.
    [[nodiscard]] const aabb::box& world() const { return world_; }
    /// Its sides; 0 on a flat axis, on which all boxes of a frame are alike.
    [[nodiscard]] aabb::vec3d sides() const;

    /// The way of an object's centre from one frame to the next, mean, over the mean of the boxes' longest extents;
    /// over the mean spacing. Empty where there is nothing to measure.
    [[nodiscard]] std::optional<double> displacement_over_extent() const;
    [[nodiscard]] std::optional<double> displacement_over_spacing() const;

private:
    [[nodiscard]] std::optional<double> displacement_over(double length) const;
    void measure(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);
    void extend_paths(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present);

    std::size_t frames_seen_ = 0;
    std::size_t path_stride_;  // frames
    frame first_;
    frame last_;
    std::vector<std::size_t> followed_;  // the objects of the paths
    std::vector<path> paths_;
    aabb::box world_ = aabb::empty_box();
    std::array<bool, 3> is_flat_{true, true, true};
    double ways_ = 0;
    double extents_ = 0;
    std::size_t ways_counted_ = 0;
    std::size_t boxes_counted_ = 0;
};

/// "mean displacement a frame: 0.1 of the mean extent, 0.063 of the mean spacing"
[[nodiscard]] std::string displacement_text(const survey& seen);

/// What stands above the drawing.
struct picture_caption {
    std::string name;
    std::string summary;
    std::string parameters;
};

/// The first and the last frame as SVG, projected along the axis on which the scene is narrowest; those that overlap
/// another are told apart. Of many boxes the largest and a sample of the others are drawn.
/// @param seen at least one frame
[[nodiscard]] std::string picture_of(const survey& seen, const picture_caption& caption);

}  // namespace aabblab
