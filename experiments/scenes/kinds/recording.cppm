module aabblab.scenes:recording;

import aabb.pipeline;
import aabb.std;
import aabblab.files;

namespace aabblab {

struct recording {
    static constexpr std::string_view name = "recording";
    static constexpr std::string_view summary = "the boxes of a file (.aabbs, .csv, .npy), frame by frame";

    struct config {
        std::string file;
    };
    static constexpr std::tuple parameters{
        aabb::text_parameter{"file", &config::file, "the path of a file", "the recording"}};

    [[nodiscard]] static std::unique_ptr<aabb::box_scene> open(const config& c) { return open_boxes(c.file); }
};

}  // namespace aabblab
