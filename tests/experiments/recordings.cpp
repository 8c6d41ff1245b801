#include "mesh_bytes.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::EndsWith;

namespace {

using frame = std::vector<aabb::box>;

/// A scene of the given frames.
class given_scene final : public aabb::box_scene {
public:
    explicit given_scene(std::vector<frame> frames) : frames_(std::move(frames)) {}
    [[nodiscard]] std::size_t objects() const override { return frames_.empty() ? 0 : frames_[0].size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(frame& boxes) override {
        if (next_ == frames_.size()) return false;
        if (frames_[next_].size() != objects()) throw aabb::input_error("the scene breaks off");
        boxes = frames_[next_++];
        return true;
    }

private:
    std::vector<frame> frames_;
    std::size_t next_ = 0;
};

/// Announces more frames than any disk holds, and must not be run.
class endless_scene final : public aabb::box_scene {
public:
    [[nodiscard]] std::size_t objects() const override { return 2147483647; }
    [[nodiscard]] std::size_t frames() const override { return 2147483647; }
    bool next(frame&) override { throw aabb::input_error("the scene was run"); }
};

std::vector<frame> frames_of(aabb::box_scene& scene) {
    std::vector<frame> frames;
    for (frame boxes; scene.next(boxes);) frames.push_back(boxes);
    return frames;
}

std::string box_bytes(const std::array<float, 3>& min, const std::array<float, 3>& max) {
    std::string bytes;
    for (const float c : min) bytes += raw(c);
    bytes += raw(0.0F);
    for (const float c : max) bytes += raw(c);
    return bytes + raw(0.0F);
}

const std::string unit = box_bytes({0, 0, 0}, {1, 1, 1});

std::string header(std::int32_t objects, std::int32_t frames, const std::string& world = unit,
                   std::int32_t is_double = 0) {
    const std::string name = "name" + std::string(124, '\0');
    return name + name + raw(objects) + raw(frames) + raw(is_double) + raw(0) + world;
}

/// The error of opening and reading a recording.
std::string error_of(const std::filesystem::path& file) {
    return refusal_in<aabb::input_error>([&] { frames_of(*aabblab::open_recording(file)); });
}

const aabb::box small = {{-0.0F, 1e-45F, -3}, {0, 0.1F, 3}};
const aabb::box large = {{-3.4e38F, -1, 5}, {3.4e38F, -1, 5}};

}  // namespace

TEST_CASE_METHOD(in_folder, "a recording has the frames that were recorded") {
    for (const std::vector<frame>& frames :
         {std::vector<frame>{{}}, {{small}}, {{small, large}, {large, small}, {small, small}}, {{}, {}}}) {
        given_scene scene(frames);
        std::vector<std::size_t> calls;
        aabblab::write_recording(scene, "name", "type", folder / "a.aabbs", [&](auto done) { calls.push_back(done); });
        REQUIRE(calls.size() == frames.size());
        REQUIRE(calls.back() == frames.size());
        const auto recording = aabblab::open_recording(folder / "a.aabbs");
        REQUIRE(recording->objects() == frames[0].size());
        REQUIRE(recording->frames() == frames.size());
        REQUIRE(frames_of(*recording) == frames);
        REQUIRE(folder.files() == 1);
    }
}

TEST_CASE_METHOD(in_folder, "a recording has Broadmark's binary format") {
    given_scene scene({{{{0, 0, 0}, {1, 1, 1}}}, {{{2, 0, 0}, {3, 1, 1}}}});
    aabblab::write_recording(scene, "name", "name", folder / "a.aabbs", {});
    REQUIRE(bytes_of_file(folder / "a.aabbs") ==
            header(1, 1, box_bytes({0, 0, 0}, {3, 1, 1})) + unit + box_bytes({2, 0, 0}, {3, 1, 1}));
    given_scene nameless({{small}});
    aabblab::write_recording(nameless, std::string(500, 'n'), "", folder / "b.aabbs", {});
    const std::string bytes = bytes_of_file(folder / "b.aabbs");
    REQUIRE(bytes.substr(0, 128) == std::string(127, 'n') + '\0');
    REQUIRE(bytes.substr(128, 6) == std::string("boxes\0", 6));
}

TEST_CASE_METHOD(in_folder, "a recording of doubles is read, copied and searched as doubles") {
    const std::vector<std::vector<aabb::boxd>> frames{
        // A gap and a touch that floats do not see, far from the origin; then boxes beyond the range of float.
        {{{3948995, 0, 0}, {3948996.1, 1, 1}},
         {{std::nextafter(3948996.1, 4e6), 0, 0}, {3948997, 1, 1}},
         {{3948997, 1, 1}, {3948998, 2, 2}}},
        {{{1e300, 0, 0}, {2e300, 1, 1}}, {{2e300, 1, 1}, {3e300, 2, 2}}, {{-1e300, -1, -1}, {0.1, 0.1, 0.1}}}};
    std::string bytes = header(3, 1, box_bytes({-3.4028235e38F, -1, -1}, {3.4028235e38F, 2, 2}), 1);
    for (const auto& boxes : frames)
        for (const aabb::boxd& b : boxes) {
            for (const double c : b.min.at) bytes += raw(c);
            bytes += raw(0.0);
            for (const double c : b.max.at) bytes += raw(c);
            bytes += raw(0.0);
        }
    const auto file = folder.write("a.aabbs", bytes);
    const auto copied = aabblab::open_recording(file);
    aabblab::write_recording(*copied, "name", "name", folder / "b.aabbs", {});
    CHECK(bytes_of_file(folder / "b.aabbs") == bytes);
    const auto recording = aabblab::open_recording(file);
    std::vector<aabb::box> rounded;
    for (const auto& boxes : frames) {
        REQUIRE(recording->next(rounded));
        REQUIRE(std::ranges::equal(recording->in_double(), boxes));
    }
    for (const char* const engine : {"", "brute_force", "fcl"}) {
        std::vector<std::string> command{"pairs", file.string(), "--out", folder / "pairs.csv"};
        if (*engine != '\0') command.insert(command.end(), {"--engine", engine});
        CAPTURE(engine);
        REQUIRE(run_program(command).status == 0);
        CHECK(bytes_of_file(folder / "pairs.csv") == "frame,a,b\n0,1,2\n1,0,1\n");
    }
    folder.write("c.aabbs", bytes.substr(0, bytes.size() - 16) + raw(-2.0) + raw(0.0));
    CHECK_THAT(error_of(folder / "c.aabbs"), EndsWith("frame 1: box 2 is inverted: its minimum is above its maximum"));
}

TEST_CASE_METHOD(in_folder, "a scene that fails leaves no recording behind and an existing one untouched") {
    folder.write("a.aabbs", "older");
    given_scene scene({{small}, {small, small}});
    REQUIRE_THROWS_AS(aabblab::write_recording(scene, "n", "t", folder / "a.aabbs", {}), aabb::input_error);
    REQUIRE(bytes_of_file(folder / "a.aabbs") == "older");
    REQUIRE(folder.files() == 1);
    given_scene empty({});
    REQUIRE_THROWS_AS(aabblab::write_recording(empty, "n", "t", folder / "b.aabbs", {}), aabb::input_error);
}

TEST_CASE_METHOD(in_folder, "a recording that exceeds the free disk space is rejected before it is written") {
    endless_scene scene;
    REQUIRE_THROWS_WITH(
        aabblab::write_recording(scene, "n", "t", folder / "a.aabbs", {}),
        ContainsSubstring("a.aabbs: would take 137438953344.0 GiB, but only ") && EndsWith(" GiB are free"));
    REQUIRE(folder.files() == 0);
    // A file that is not regular takes no disk space.
    REQUIRE_THROWS_WITH(aabblab::write_recording(scene, "n", "t", "/dev/null", {}), "the scene was run");
}

TEST_CASE_METHOD(in_folder, "a recording without objects has at most a million frames") {
    const auto frames = aabblab::open_recording(folder.write("a.aabbs", header(0, 999'999)))->frames();
    REQUIRE(frames == 1'000'000);
    given_scene scene(std::vector<frame>(1'000'001));
    REQUIRE_THROWS_WITH(aabblab::write_recording(scene, "n", "t", folder / "b.aabbs", {}),
                        EndsWith("b.aabbs: a recording of 0 objects holds at most 1000000 frames, not 1000001"));
}

TEST_CASE_METHOD(in_folder, "invalid recordings are rejected") {
    using malformed = std::pair<std::string, std::string>;
    for (const auto& [bytes, error] : {
             malformed{"", "is empty"},
             {"short", "is not a recording: its header takes 304 bytes, but the file has 5"},
             {header(1, 0, unit, 7) + unit,
              "is not a recording: its header does not hold two names, 0 (floats) or 1 (doubles), and 0"},
             {std::string(400, 'x'),
              "is not a recording: its header does not hold two names, 0 (floats) or 1 (doubles), and 0"},
             {header(-1, 0), "its header announces -1 objects and 0 frames; neither can be negative"},
             {header(1, -1), "its header announces 1 objects and -1 frames; neither can be negative"},
             {header(1, 0, box_bytes({0, 0, 0}, {not_a_number, 1, 1})) + unit,
              "the world box in its header is inverted or not finite"},
             {header(1, 1) + unit,
              "its header announces 2 boxes (1 objects, 1 + 1 frames), but the file has 32 bytes of them, 32 each"},
             {header(1, 0) + unit + "x",
              "its header announces 1 boxes (1 objects, 0 + 1 frames), but the file has 33 bytes of them, 32 each"},
             {header(0, 5) + unit,
              "its header announces 0 boxes (0 objects, 5 + 1 frames), but the file has 32 bytes of them, 32 each"},
             {header(0, 1'000'000), "a recording of 0 objects holds at most 1000000 frames, not 1000001"},
             {header(0, 2147483647), "a recording of 0 objects holds at most 1000000 frames, not 2147483648"},
             {header(2147483647, 2147483647) + unit,
              "its header announces 4611686016279904256 boxes (2147483647 objects, 2147483647 + 1 frames), but the "
              "file has 32 bytes of them, 32 each"},
             {header(2, 1) + unit + unit + unit + box_bytes({0, not_a_number, 0}, {1, 1, 1}),
              "frame 1: box 1 has a coordinate that is not finite"},
             {header(1, 0) + box_bytes({0, 2, 0}, {1, 1, 1}),
              "frame 0: box 0 is inverted: its minimum is above its maximum"},
         }) {
        CHECK_THAT(error_of(folder.write("a.aabbs", bytes)), EndsWith("/a.aabbs: " + error));
    }
    CHECK_THAT(error_of(folder / "absent.aabbs"), EndsWith("absent.aabbs: no such file"));
    CHECK_THAT(error_of(folder.path()), EndsWith(": is a folder, not a file"));
}

TEST_CASE_METHOD(in_folder, "a recording that shrinks while it is read is rejected") {
    std::string bytes = header(40000, 1);
    for (int i = 0; i < 80000; ++i) bytes += unit;
    const auto file = folder.write("a.aabbs", bytes);
    const auto recording = aabblab::open_recording(file);
    frame boxes;
    REQUIRE(recording->next(boxes));
    std::filesystem::resize_file(file, 304);
    REQUIRE_THROWS_AS(recording->next(boxes), aabb::input_error);
}
