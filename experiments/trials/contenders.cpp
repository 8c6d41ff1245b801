module;
#include <stdlib.h>
#include <sys/wait.h>

#include <cerrno>

module aabblab.trials;

import aabblab.files;
import aabblab.pair_output;
import aabblab.processes;

namespace aabblab {

namespace {

/// Takes a stage of the composition.
void use(contender& who, const aabb::composition& c, aabb::stage stage) {
    for (const aabb::strategy_kind kind : kinds_of(stage)) who.name[kind] = to_text(c[kind]);
    who.exact = who.exact && is_exact(c, stage);
    if (stage == aabb::stage::global_search) {
        who.exact_boxes = is_exact(c, stage);
        who.whole_boxes = needs_meshes(c).empty();
        who.make_global = [c](aabb::instrumentation counted) { return aabb::compose_global_search(c, counted); };
    } else {
        who.make_local = [c](aabb::instrumentation counted) { return aabb::compose_local_detection(c, counted); };
    }
}

}  // namespace

contender contender_of(const aabb::composition& c, bool meshes) {
    contender who;
    use(who, c, aabb::stage::global_search);
    if (meshes) use(who, c, aabb::stage::local_detection);
    return who;
}

contender contender_of(const aabb::named_strategies& named, const scene_play& scene) {
    aabb::composition whole = aabb::complete_composition(named);
    const auto selected = [named, outlook = outlook_of(scene)](aabb::composition& c) -> const aabb::composition& {
        select_for_scene(c, named, outlook);
        return c;
    };
    contender who = contender_of(selected(whole), scene.meshes() != nullptr);
    // To select is part of making the stages, and of their time.
    who.make_global = [selected, whole](aabb::instrumentation counted) mutable {
        return aabb::compose_global_search(selected(whole), counted);
    };
    if (who.make_local)
        who.make_local = [selected, whole](aabb::instrumentation counted) mutable {
            return aabb::compose_local_detection(selected(whole), counted);
        };
    // It has one name in all scenes, whatever is selected.
    who.name = {};
    who.name.engine = contender_name::automatic;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (named[kind])
            who.name.engine += " + " +
                               (named[kind]->name == "none" ? std::string(name_of(kind)) + " " : std::string()) +
                               to_text(*named[kind]);
    return who;
}

aabb::scene_outlook outlook_of(const scene_play& scene) {
    if (!scene.meshes()) return {.frames = scene.frames()};
    return aabb::outlook_of(scene.meshes()->meshes, scene.objects(), scene.frames());
}

std::optional<contender> contender_of(const aabb::engine_info& engine, bool meshes) {
    if (!engine.searches_boxes && !(meshes && engine.collides_meshes)) return std::nullopt;
    contender who;
    who.name.engine = engine.name;
    who.exact = engine.exact;
    if (engine.searches_boxes)
        who.make_global = [name = engine.name](aabb::instrumentation) { return aabb::make_box_engine(name); };
    else
        use(who, {}, aabb::stage::global_search);
    if (meshes && engine.collides_meshes)
        who.make_local = [name = engine.name](aabb::instrumentation) { return aabb::make_mesh_engine(name); };
    else if (meshes)
        use(who, {}, aabb::stage::local_detection);
    return who;
}

// External engines: programs of others that read a recording, and write what they found and how long they took.

namespace {

/// A folder in which the external engines of a scene find its recording and leave their answers; made when it is first
/// asked for, and gone with this, as are the engines.
class exchange_folder {
public:
    explicit exchange_folder(scene_choice scene) : scene_(std::move(scene)) {}
    exchange_folder(const exchange_folder&) = delete;
    exchange_folder& operator=(const exchange_folder&) = delete;
    ~exchange_folder() = default;

    /// "brownian (objects=1000 seed=1)"
    [[nodiscard]] std::string scene_text() const { return scene_.kind + " (" + parameters_text(scene_) + ")"; }
    /// The scene from its first frame to its last.
    [[nodiscard]] const std::filesystem::path& recording() {
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
    answer_table(std::string what, const std::filesystem::path& file, std::string columns)
        : what_(std::move(what)), columns_(std::move(columns)) {
        if (!std::filesystem::exists(file)) throw aabb::input_error(what_ + " are not there: it wrote no such file");
        if (std::filesystem::is_directory(file)) throw aabb::input_error(what_ + " are a folder; expected a file");
        in_.emplace(file, what_);
        if (!next()) throw aabb::input_error(what_ + " are an empty file; expected the line " + columns_);
        if (text_ != columns_) fail("expected the line " + columns_);
    }

    /// Goes to the next row; false after the last.
    bool next() {
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
    /// A number below `end`.
    [[nodiscard]] std::uint32_t number(std::size_t column, std::string_view of, std::size_t end) const {
        const std::optional<std::uint32_t> value = parsed<std::uint32_t>(column);
        if (!value || *value >= end) fail("expected " + std::string(of) + " below " + std::to_string(end));
        return *value;
    }
    [[nodiscard]] double milliseconds(std::size_t column) const {
        const std::optional<double> value = parsed<double>(column);
        if (!value || !(*value >= 0) || !std::isfinite(*value))
            fail("expected a time in milliseconds, finite and not negative");
        return *value;
    }
    /// Of the row, with its line and what stands there.
    [[noreturn]] void fail(const std::string& sentence) const {
        constexpr std::size_t longest_quote = 60;  // of a row that may be of any length
        std::string row(text_.substr(0, longest_quote));
        if (text_.size() > longest_quote) row += "…";
        throw aabb::input_error(what_ + ", line " + std::to_string(in_->number()) + ", '" + row + "': " + sentence);
    }

private:
    template <class Number>
    [[nodiscard]] std::optional<Number> parsed(std::size_t column) const {
        const std::string_view text = fields_[column];
        Number value{};
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error == std::errc() && rest == text.data() + text.size() ? std::optional(value) : std::nullopt;
    }

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
    external_search(const external_engine& who, exchange_folder& exchange, std::vector<told_times>& told)
        : place_(who.place + ": " + exchange.scene_text() + ": "), name_("external engine '" + who.name + "'") {
        in_place([&] {
            run(who, exchange);
            read_times(told);
            table_.emplace("the pairs of the " + name_, pairs_file_, "frame,a,b");
            read_ahead();
        });
    }

    void insert(std::uint32_t) override {}
    void remove(std::uint32_t) override {}
    /// Goes to the next frame.
    /// @throws aabb::input_error on rows that are malformed, not of this frame or a later one, or there twice
    void update(std::span<const aabb::box>) override {
        in_place([this] { take_frame(); });
    }
    void search(std::vector<aabb::index_pair>& pairs) override {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
    }
    [[nodiscard]] aabb::work_counters counters() const override { return {}; }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return {}; }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return {}; }

private:
    struct found_pair {
        std::uint32_t frame;
        aabb::index_pair pair;
    };

    /// Does what may fail.
    template <class Work>
    void in_place(Work work) const {
        try {
            work();
        } catch (const engine_timeout& error) {
            throw engine_timeout(place_ + error.what());
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(place_ + error.what());
        }
    }

    [[noreturn]] void fail(const std::string& sentence) const { throw aabb::input_error("the " + name_ + sentence); }

    void run(const external_engine& who, exchange_folder& exchange) {
        const std::filesystem::path recording = exchange.recording();
        objects_ = exchange.objects();
        frames_ = exchange.frames();
        pairs_file_ = recording.parent_path() / (who.name + ".pairs.csv");
        times_file_ = recording.parent_path() / (who.name + ".times.csv");
        std::vector<std::string> arguments(who.command.begin() + 1, who.command.end());
        arguments.push_back(recording.string());
        for (const std::filesystem::path& file : {pairs_file_, times_file_}) {
            // What it left the last time is not taken for an answer.
            std::filesystem::remove(file);
            arguments.push_back(file.string());
        }
        // Apart from the terminal it must not wait for what is typed there.
        const child_result ended = run_child(who.program, arguments,
                                             {.folder = {},
                                              .input = "/dev/null",
                                              .errors = {},
                                              .kept = true,
                                              .timeout = std::chrono::seconds(who.timeout_s)});
        if (ended.timed_out)
            throw engine_timeout("the " + name_ + " was killed: it had not ended after " +
                                 std::to_string(who.timeout_s) + " s, its timeout_s");
        if (ended.refused == ENOENT && who.program.find('/') == std::string::npos)
            fail(": there is no program " + who.program + " in PATH; write ./" + who.program +
                 " for one in the folder of the config");
        if (ended.refused != 0) fail(": " + who.program + " cannot be started: " + std::strerror(ended.refused));
        if (!WIFEXITED(ended.status)) fail(" was ended by signal " + std::to_string(WTERMSIG(ended.status)));
        if (WEXITSTATUS(ended.status) != 0) fail(" ended with status " + std::to_string(WEXITSTATUS(ended.status)));
    }

    void read_times(std::vector<told_times>& told) const {
        told.clear();
        answer_table table("the times of the " + name_, times_file_, "frame,update_ms,search_ms");
        while (table.next()) {
            if (table.number(0, "a frame", frames_) != told.size())
                table.fail("expected frame " + std::to_string(told.size()) + "; each stands once, in order");
            told.push_back({table.milliseconds(1), table.milliseconds(2)});
            // No ratio can be formed with it, and nothing takes no time.
            if (told.back().update_ms + told.back().search_ms == 0)
                table.fail("expected more than 0 ms, the two together");
        }
        if (told.size() < frames_)
            throw aabb::input_error("the times of the " + name_ + " end before frame " + std::to_string(told.size()));
    }

    void read_ahead() {
        ahead_.reset();
        if (!table_->next()) return;
        const std::uint32_t frame = table_->number(0, "a frame", frames_);
        const std::uint32_t a = table_->number(1, "an object", objects_);
        const std::uint32_t b = table_->number(2, "an object", objects_);
        if (a == b) table_->fail("object " + std::to_string(a) + " is paired with itself");
        ahead_ = {frame, aabb::ordered_pair(a, b)};
    }

    void take_frame() {
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

    std::string place_, name_;
    std::filesystem::path pairs_file_, times_file_;
    std::size_t objects_ = 0, frames_ = 0;
    std::optional<answer_table> table_;
    std::uint32_t frame_ = 0;          // the next one
    std::optional<found_pair> ahead_;  // the first row that is not of a frame so far
    std::vector<aabb::index_pair> pairs_;
};

contender contender_of(const external_engine& engine, const std::shared_ptr<exchange_folder>& exchange) {
    contender who;
    who.name.engine = engine.name;
    who.exact = who.exact_boxes = engine.exact;
    const std::shared_ptr told = std::make_unique<std::vector<told_times>>();
    who.told = told;
    who.make_global = [engine, exchange, told](aabb::instrumentation) {
        return std::make_unique<external_search>(engine, *exchange, *told);
    };
    return who;
}

}  // namespace

std::vector<contender> contenders_for(const experiment& e, const scene_choice& scene) {
    const bool meshes = has_meshes(scene);
    std::vector<contender> all;
    std::set<contender_name> names;
    for (const aabb::composition& c : e.compositions) {
        // Refused in a config; of all compositions that there are, it has no part in this scene.
        if (!meshes && !needs_meshes(c).empty()) continue;
        contender who = contender_of(c, meshes);
        // In a scene of boxes, compositions that differ in local detection only are one.
        if (names.insert(who.name).second) all.push_back(std::move(who));
    }
    if (!e.automatic.empty()) {
        const scene_play play(scene);
        for (const aabb::named_strategies& named : e.automatic) all.push_back(contender_of(named, play));
    }
    for (const std::string& name : e.engines) {
        const auto engine = std::ranges::find(aabb::engines(), name, &aabb::engine_info::name);
        if (std::optional<contender> who = contender_of(*engine, meshes)) all.push_back(*std::move(who));
    }
    if (meshes) return all;
    const std::shared_ptr exchange = std::make_unique<exchange_folder>(scene);
    for (const external_engine& engine : e.externals) all.push_back(contender_of(engine, exchange));
    return all;
}

std::string text_of(const contender_name& name) {
    const std::string made_of = text_in_line(name.choices);
    return name.engine + (name.engine.empty() || made_of.empty() ? "" : " + ") + made_of;
}

}  // namespace aabblab
