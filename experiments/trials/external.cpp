module;
#include <stdlib.h>
#include <sys/wait.h>

#include <cerrno>

module aabblab.trials;

import :external;
import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import aabblab.files;
import aabblab.pair_output;
import aabblab.processes;

namespace aabblab {

namespace {

/// What is quoted of a row that may be of any length.
constexpr std::size_t longest_quote = 60;

}  // namespace

std::string exchange_folder::scene_text() const {
    return scene_.kind + " (" + parameters_text(scene_) + ")";
}

const std::filesystem::path& exchange_folder::recording() {
    if (!recording_.empty()) return recording_;
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / ("aabblab-" + std::string(6, 'X'))).string();
    if (error || !mkdtemp(name.data()))
        throw aabb::input_error(
            "external engines cannot be given a scene: there is no folder for temporary files (TMPDIR)");
    guard_.emplace(name);
    const auto scene = make_box_scene(scene_);
    objects_ = scene->objects();
    frames_ = scene->frames();
    const std::filesystem::path file = std::filesystem::path(name) / "scene.aabbs";
    write_recording(*scene, scene_.kind, parameters_text(scene_), file, {});
    return recording_ = file;
}

answer_table::answer_table(std::string what, const std::filesystem::path& file, std::string columns)
    : what_(std::move(what)), columns_(std::move(columns)) {
    if (!std::filesystem::exists(file)) throw aabb::input_error(what_ + " are not there: it wrote no such file");
    if (std::filesystem::is_directory(file)) throw aabb::input_error(what_ + " are a folder; expected a file");
    in_.emplace(file, what_);
    if (!next()) throw aabb::input_error(what_ + " are an empty file; expected the line " + columns_);
    if (text_ != columns_) fail("expected the line " + columns_);
}

bool answer_table::next() {
    fields_.clear();
    const bool is_there = in_->next();
    text_ = is_there ? in_->line() : std::string_view();
    if (!is_there) return false;
    for (std::size_t from = 0;;) {
        const std::size_t to = std::min(text_.find(',', from), text_.size());
        fields_.push_back(text_.substr(from, to - from));
        if (to == text_.size()) break;
        from = to + 1;
    }
    if (fields_.size() != 3) fail("expected " + columns_);
    return true;
}

std::uint32_t answer_table::number(std::size_t column, std::string_view of, std::size_t end) const {
    const std::string_view text = fields_[column];
    std::uint32_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size() || value >= end)
        fail("expected " + std::string(of) + " below " + std::to_string(end));
    return value;
}

double answer_table::milliseconds(std::size_t column) const {
    const std::string_view text = fields_[column];
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size() || !(value >= 0) || !std::isfinite(value))
        fail("expected a time in milliseconds, finite and not negative");
    return value;
}

void answer_table::fail(const std::string& sentence) const {
    std::string row(text_.substr(0, longest_quote));
    if (text_.size() > longest_quote) row += "…";
    throw aabb::input_error(what_ + ", line " + std::to_string(in_->number()) + ", '" + row + "': " + sentence);
}

external_search::external_search(const external_engine& who, exchange_folder& exchange, std::vector<told_times>& told)
    : place_(who.place + ": " + exchange.scene_text() + ": "), name_("external engine '" + who.name + "'") {
    in_place([&] {
        run(who, exchange);
        read_times(told);
        table_.emplace("the pairs of the " + name_, pairs_file_, "frame,a,b");
        read_ahead();
    });
}

template <class Work>
void external_search::in_place(Work work) const {
    try {
        work();
    } catch (const engine_timeout& error) {
        throw engine_timeout(place_ + error.what());
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(place_ + error.what());
    }
}

void external_search::run(const external_engine& who, exchange_folder& exchange) {
    const std::filesystem::path recording = exchange.recording();
    objects_ = exchange.objects();
    frames_ = exchange.frames();
    pairs_file_ = recording.parent_path() / (who.name + ".pairs.csv");
    times_file_ = recording.parent_path() / (who.name + ".times.csv");
    // What it left the last time is not taken for an answer.
    for (const std::filesystem::path& file : {pairs_file_, times_file_}) std::filesystem::remove(file);
    std::vector<std::string> arguments(who.command.begin() + 1, who.command.end());
    for (const std::filesystem::path& file : {recording, pairs_file_, times_file_}) arguments.push_back(file.string());
    // Apart from the terminal it must not wait for what is typed there.
    const child_result ended = run_child(who.program, arguments,
                                         {.folder = {},
                                          .input = "/dev/null",
                                          .errors = {},
                                          .kept = true,
                                          .timeout = std::chrono::seconds(who.timeout_s)});
    if (ended.timed_out)
        throw engine_timeout("the " + name_ + " was killed: it had not ended after " + std::to_string(who.timeout_s) +
                             " s, its timeout_s");
    if (ended.refused == ENOENT && who.program.find('/') == std::string::npos)
        throw aabb::input_error("the " + name_ + ": there is no program " + who.program + " in PATH; write ./" +
                                who.program + " for one in the folder of the config");
    if (ended.refused != 0)
        throw aabb::input_error("the " + name_ + ": " + who.program +
                                " cannot be started: " + std::strerror(ended.refused));
    if (!WIFEXITED(ended.status))
        throw aabb::input_error("the " + name_ + " was ended by signal " + std::to_string(WTERMSIG(ended.status)));
    if (WEXITSTATUS(ended.status) != 0)
        throw aabb::input_error("the " + name_ + " ended with status " + std::to_string(WEXITSTATUS(ended.status)));
}

void external_search::read_times(std::vector<told_times>& told) const {
    told.clear();
    answer_table table("the times of the " + name_, times_file_, "frame,update_ms,search_ms");
    while (table.next()) {
        if (table.number(0, "a frame", frames_) != told.size())
            table.fail("expected frame " + std::to_string(told.size()) + "; each stands once, in order");
        told.push_back({table.milliseconds(1), table.milliseconds(2)});
        // No ratio can be formed with it, and nothing takes no time.
        if (told.back().update_ms + told.back().search_ms == 0) table.fail("expected more than 0 ms, the two together");
    }
    if (told.size() < frames_)
        throw aabb::input_error("the times of the " + name_ + " end before frame " + std::to_string(told.size()));
}

void external_search::read_ahead() {
    ahead_.reset();
    if (!table_->next()) return;
    const std::uint32_t frame = table_->number(0, "a frame", frames_);
    const std::uint32_t a = table_->number(1, "an object", objects_);
    const std::uint32_t b = table_->number(2, "an object", objects_);
    if (a == b) table_->fail("object " + std::to_string(a) + " is paired with itself");
    ahead_ = {frame, aabb::ordered_pair(a, b)};
}

void external_search::update(std::span<const aabb::box>) {
    in_place([this] { take_frame(); });
}

void external_search::take_frame() {
    pairs_.clear();
    for (; ahead_ && ahead_->frame <= frame_; read_ahead()) {
        if (ahead_->frame < frame_)
            table_->fail("this row of frame " + std::to_string(ahead_->frame) + " stands behind one of frame " +
                         std::to_string(frame_) +
                         "; expected rows sorted by frame, from 0 on, in any order within a frame");
        pairs_.push_back(ahead_->pair);
    }
    sort_rows(pairs_);
    if (const auto twice = std::ranges::adjacent_find(pairs_); twice != pairs_.end())
        throw aabb::input_error("the pairs of the " + name_ + " have " + std::to_string(twice->a) + " " +
                                std::to_string(twice->b) + " twice in frame " + std::to_string(frame_));
    ++frame_;
}

void external_search::search(std::vector<aabb::index_pair>& pairs) {
    pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
}

}  // namespace aabblab
