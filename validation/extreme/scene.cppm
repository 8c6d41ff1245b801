export module aabb.extreme:scene;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import :arithmetic;

export namespace aabb {

/// What is asked of a scene of meshes. Whoever lists all candidates first has no part in `first_pair`: there are more
/// of them than any memory holds.
enum class extreme_query : std::uint8_t { all_pairs, count_pairs, first_pair };

/// A scene, and what is expected of whoever plays it: the exact answer, or a refusal.
struct extreme_scene {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<box_scene>()> make_boxes = {};    ///< empty in a scene of meshes
    std::function<std::unique_ptr<mesh_scene>()> make_meshes = {};  ///< empty in a scene of boxes
    std::string refusal = {};  ///< what the sentence says with which everybody must refuse; empty: all must answer
    /// Who computes with the poses as they are, in double, may say in place of refusing that nothing meets.
    bool answered_in_double = false;
    arithmetic computed_in = arithmetic::ieee;
    /// `all_pairs` asks everything, `count_pairs` that and `first_pair`, `first_pair` nothing else.
    extreme_query asked = extreme_query::all_pairs;
    std::size_t most_bytes = 0;  ///< that a composition may hold; 0 where none are stated
};

/// Frames of boxes that are known beforehand.
class known_boxes final : public box_scene {
public:
    /// @param present by frame and object, 0 or 1; empty where all are there all the time
    explicit known_boxes(std::vector<std::vector<box>> frames, std::vector<std::vector<std::uint8_t>> present = {})
        : frames_(std::move(frames)), present_(std::move(present)) {}

    [[nodiscard]] std::size_t objects() const override { return frames_.front().size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<box>& boxes) override {
        if (played_ == frames_.size()) return false;
        boxes = frames_[played_++];
        return true;
    }
    [[nodiscard]] std::span<const std::uint8_t> present() const override {
        return present_.empty() ? std::span<const std::uint8_t>() : present_[played_ - 1];
    }

private:
    std::vector<std::vector<box>> frames_;
    std::vector<std::vector<std::uint8_t>> present_;
    std::size_t played_ = 0;
};

/// Meshes at poses that are known beforehand.
class known_poses final : public mesh_scene {
public:
    /// Object i is mesh i.
    known_poses(std::vector<mesh> given, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes = std::move(given);
        for (std::uint32_t m = 0; m < meshes.size(); ++m) mesh_of.push_back(m);
    }
    /// As many objects of one mesh as there are poses.
    known_poses(mesh given, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes.push_back(std::move(given));
        mesh_of.assign(frames_.front().size(), 0);
    }

    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<pose>& poses) override {
        if (played_ == frames_.size()) return false;
        poses = frames_[played_++];
        return true;
    }

private:
    std::vector<std::vector<pose>> frames_;
    std::size_t played_ = 0;
};

}  // namespace aabb
