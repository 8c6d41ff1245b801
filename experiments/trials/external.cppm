/// External engines: programs of others that read a recording, and write what they found and how long they took.
module aabblab.trials:external;

import aabb.counters;
import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import aabblab.configs;
import aabblab.files;
import aabblab.processes;
import aabblab.scenes;
import :player;

namespace aabblab {

/// A folder in which the external engines of a scene find its recording and leave their answers; made when it is first
/// asked for, and gone with this, as are the engines.
class exchange_folder {
public:
    explicit exchange_folder(scene_choice scene) : scene_(std::move(scene)) {}
    exchange_folder(const exchange_folder&) = delete;
    exchange_folder& operator=(const exchange_folder&) = delete;
    ~exchange_folder() = default;

    /// "brownian (objects=1000 seed=1)"
    [[nodiscard]] std::string scene_text() const;
    /// The scene from its first frame to its last.
    [[nodiscard]] const std::filesystem::path& recording();
    [[nodiscard]] std::size_t objects() const { return objects_; }
    [[nodiscard]] std::size_t frames() const { return frames_; }

private:
    scene_choice scene_;
    std::optional<folder_guard> guard_;
    std::filesystem::path recording_;
    std::size_t objects_ = 0, frames_ = 0;
};

/// A CSV file of rows of numbers that such a program wrote, read row by row.
class answer_table {
public:
    /// @param what the rows are, for messages: "the pairs of the external engine 'NAME'"
    /// @param columns their names, as the first line has them
    /// @throws aabb::input_error where the file is not there or begins otherwise. So do all that read.
    answer_table(std::string what, const std::filesystem::path& file, std::string columns);

    /// Goes to the next row; false after the last.
    bool next();
    /// A number below `end`.
    [[nodiscard]] std::uint32_t number(std::size_t column, std::string_view of, std::size_t end) const;
    [[nodiscard]] double milliseconds(std::size_t column) const;
    /// Of the row, with its line and what stands there.
    [[noreturn]] void fail(const std::string& sentence) const;

private:
    std::string what_, columns_;
    std::optional<line_stream> in_;
    std::string_view text_;
    std::vector<std::string_view> fields_;  // of text_
};

/// What such a program found, in place of a search: it has played the whole scene when this is made. Its errors begin
/// with the place in the config and the scene.
class external_search final : public aabb::global_stage {
public:
    /// Runs the program.
    /// @param told gets its times, by frame
    /// @throws engine_timeout, and aabb::input_error where it cannot be started or fails, and on times that are
    /// malformed
    external_search(const external_engine& who, exchange_folder& exchange, std::vector<told_times>& told);

    void insert(std::uint32_t) override {}
    void remove(std::uint32_t) override {}
    /// Goes to the next frame.
    /// @throws aabb::input_error on rows that are malformed, not of this frame or a later one, or there twice
    void update(std::span<const aabb::box> boxes) override;
    void search(std::vector<aabb::index_pair>& pairs) override;
    [[nodiscard]] aabb::work_counters counters() const override { return {}; }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return {}; }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return {}; }

private:
    struct found_pair {
        std::uint32_t frame;
        aabb::index_pair pair;
    };
    void run(const external_engine& who, exchange_folder& exchange);
    void read_times(std::vector<told_times>& told) const;
    void read_ahead();
    void take_frame();
    /// Does what may fail.
    template <class Work>
    void in_place(Work work) const;

    std::string place_, name_;
    std::filesystem::path pairs_file_, times_file_;
    std::size_t objects_ = 0, frames_ = 0;
    std::optional<answer_table> table_;
    std::uint32_t frame_ = 0;          // the next one
    std::optional<found_pair> ahead_;  // the first row that is not of a frame so far
    std::vector<aabb::index_pair> pairs_;
};

}  // namespace aabblab
