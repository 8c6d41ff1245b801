/// The drawing of one frame, with its axes.
module aabblab.picture:panel;

import aabb.geometry;
import aabb.std;
import :survey;

namespace aabblab {

constexpr double panel_side = 490;
/// The space that the labels of an axis take.
constexpr double left_margin = 84;
constexpr double bottom_margin = 44;
/// Between panels.
constexpr double gap = 30;

/// Which two axes are shown, and how lengths become pixels.
class view_plane {
public:
    /// Along z lies what falls or is piled up, so z is left out only where it is flat, or less than a quarter as wide
    /// as both others. Where one of the two axes is much longer, each has a scale of its own.
    view_plane(const aabb::box& world, const aabb::vec3d& sides);

    [[nodiscard]] int across() const { return across_; }
    [[nodiscard]] int up() const { return up_; }
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_; }
    /// Too wide for another panel beside it.
    [[nodiscard]] bool is_wide() const { return width_ > panel_side; }
    [[nodiscard]] bool has_equal_scales() const { return equal_scales_; }

    /// From the left edge of the panel, from its upper edge.
    [[nodiscard]] double x(double value) const { return (value - least_[across_]) * scale_[across_]; }
    [[nodiscard]] double y(double value) const { return height_ - (value - least_[up_]) * scale_[up_]; }
    [[nodiscard]] double least(int axis) const { return least_[axis]; }
    [[nodiscard]] double length(int axis) const { return length_[axis]; }

private:
    int across_ = 0;
    int up_ = 1;
    double width_ = 0;
    double height_ = 0;
    bool equal_scales_ = true;
    aabb::vec3d least_{};   // by axis, as are the following
    aabb::vec3d length_{};  // shown
    aabb::vec3d scale_{};   // pixels a unit of length
};

/// Where panels have their upper left corner.
struct pixel {
    double x;
    double y;
};

/// In pixels, from the corner of a panel.
struct box_on_plane {
    double left, top, width, height;
};

/// @param kind a class of the style
[[nodiscard]] std::string rectangle(std::string_view kind, const box_on_plane& r);
[[nodiscard]] std::string words_at(double x, double y, std::string_view text, std::string_view kind = "",
                                   std::string_view anchor = "");
/// "x", "y" or "z"
[[nodiscard]] std::string_view name_of_axis(int axis);

/// What a panel shows of a frame.
struct frame_drawing {
    std::vector<std::size_t> drawn;         // objects, the largest first
    std::size_t huge = 0;                   // how many of them are outlined above all others
    std::vector<std::uint8_t> overlapping;  // by object
    std::size_t present = 0;
    std::size_t pairs = 0;
};

[[nodiscard]] std::string panel_of(const view_plane& view, pixel corner, std::string_view title,
                                   const survey::frame& frame, const frame_drawing& drawing,
                                   std::span<const survey::path> paths);

/// How many of the paths can be drawn before they hide everything: at least one, where there is one.
[[nodiscard]] std::size_t clear_paths(const view_plane& view, std::span<const survey::path> paths);

}  // namespace aabblab
