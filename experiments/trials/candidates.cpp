module;
#include <sys/wait.h>

#include <cerrno>

module aabblab.trials;

import aabblab.files;
import aabblab.fmt;
import aabblab.pair_output;
import aabblab.processes;

namespace aabblab {

namespace {

/// Gives a candidate the strategies of one stage. A strategy that needs meshes divides them, and then the broad phase
/// finds pairs of parts, which cannot be compared with pairs of whole objects (`whole_boxes`).
void set_stage(candidate& result, const aabb::composition& c, aabb::stage stage) {
    for (const aabb::strategy_kind kind : kinds_of(stage)) result.name[kind] = to_text(c[kind]);
    result.exact = result.exact && is_exact(c, stage);
    if (stage == aabb::stage::global_search) {
        result.exact_boxes = is_exact(c, stage);
        result.whole_boxes = needs_meshes(c).empty();
        result.make_global = [c](aabb::instrumentation counted) { return aabb::compose_global_search(c, counted); };
    } else {
        result.make_local = [c](aabb::instrumentation counted) { return aabb::compose_local_detection(c, counted); };
    }
}

}  // namespace

candidate candidate_of(const aabb::composition& c, bool meshes) {
    candidate result;
    set_stage(result, c, aabb::stage::global_search);
    if (meshes) set_stage(result, c, aabb::stage::local_detection);
    return result;
}

/// A candidate `auto`: every run keeps the strategies that the user named, and selects the others for the scene.
candidate candidate_of(const aabb::named_strategies& named, const scene_frames& scene) {
    aabb::composition initial = aabb::complete_composition(named);  // with defaults for the others
    const auto selected = [named, traits = traits_of(scene)](aabb::composition& c) -> const aabb::composition& {
        select_for_scene(c, named, traits);
        return c;
    };
    candidate result = candidate_of(selected(initial), scene.meshes() != nullptr);
    // The selection runs when the stages are created, so that its time counts as build time.
    result.make_global = [selected, initial](aabb::instrumentation counted) mutable {
        return aabb::compose_global_search(selected(initial), counted);
    };
    if (result.make_local)
        result.make_local = [selected, initial](aabb::instrumentation counted) mutable {
            return aabb::compose_local_detection(selected(initial), counted);
        };
    // The name has only the named strategies, so that it is the same for all scenes: "auto + shell". Several kinds have
    // a strategy called none, so the kind is added: "auto + prepare none".
    result.name = {};
    result.name.engine = candidate_name::automatic;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const auto& choice = named[kind])
            result.name.engine +=
                (choice->name == "none" ? fmt::format(" + {} ", name_of(kind)) : " + ") + to_text(*choice);
    return result;
}

aabb::scene_traits traits_of(const scene_frames& scene) {
    if (!scene.meshes()) return {.frames = scene.frames()};
    return aabb::traits_of(scene.meshes()->meshes, scene.objects(), scene.frames());
}

/// An engine, the code of another library, of one stage runs with the default strategies for the other stage.
/// @param meshes whether the scene has meshes, not only boxes
/// @returns empty if the engine cannot run the scene
std::optional<candidate> candidate_of(const aabb::engine_info& engine, bool meshes) {
    if (!engine.searches_boxes && !(meshes && engine.collides_meshes)) return std::nullopt;
    candidate result;
    result.name.engine = engine.name;
    result.exact = engine.exact;
    if (engine.searches_boxes)
        result.make_global = [name = engine.name](aabb::instrumentation) { return aabb::make_box_engine(name); };
    else
        set_stage(result, /*c=*/{}, aabb::stage::global_search);  // {}: the default strategies
    if (meshes && engine.collides_meshes)
        result.make_local = [name = engine.name](aabb::instrumentation) { return aabb::make_mesh_engine(name); };
    else if (meshes)
        set_stage(result, /*c=*/{}, aabb::stage::local_detection);
    return result;
}

// External engines: third-party programs that read a recording, and write the pairs they find and their times.

namespace {

/// A temporary folder, created on first use, for the recording of a scene and the results of its external engines.
class exchange_folder {
public:
    explicit exchange_folder(scene_choice scene) : scene_(std::move(scene)) {}

    /// "brownian (objects=1000 seed=1)"
    [[nodiscard]] std::string scene_text() const { return scene_.kind + " (" + parameters_text(scene_) + ")"; }
    /// The file with all frames for external programs, which the first call writes to a folder that `guard_` deletes.
    [[nodiscard]] const std::filesystem::path& recording() {
        if (!recording_.empty()) return recording_;
        guard_.emplace(make_temporary_folder("external engines cannot be given a scene"));
        const auto scene = make_box_scene(scene_);
        objects_ = scene->objects();
        frames_ = scene->frames();
        const std::filesystem::path file = guard_->folder() / "scene.aabbs";
        write_recording(*scene, scene_.kind, parameters_text(scene_), file, /*progress=*/{});
        if (!scene->in_double().empty())
            throw aabb::input_error("external engines read boxes of floats, but those of " + scene_.kind +
                                    " are doubles");
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

/// Reads the CSV output of an external engine row by row.
class engine_output {
public:
    /// Opens the file and requires `columns` as its first line, so that a wrong file is not read as results.
    /// @param noun the rows in messages: "the pairs of the external engine 'NAME'"
    /// @throws aabb::input_error if the file is missing or its header differs. All member functions that read throw it.
    engine_output(std::string noun, const std::filesystem::path& file, std::string columns)
        : noun_(std::move(noun)), columns_(std::move(columns)) {
        if (!std::filesystem::exists(file))
            throw aabb::input_error(noun_ + " are missing: the engine did not write the file");
        if (std::filesystem::is_directory(file)) throw aabb::input_error(noun_ + " are a folder; expected a file");
        in_.emplace(file, noun_);
        if (!next()) throw aabb::input_error(noun_ + " are an empty file; expected the line " + columns_);
        if (line_ != columns_) fail("expected the line " + columns_);
    }

    /// Advances to the next row and splits it at commas (pairs and times have three columns); false after the last.
    bool next() {
        fields_.clear();
        const bool has_row = in_->next();
        line_ = has_row ? in_->line() : std::string_view();
        if (!has_row) return false;
        for (std::size_t from = 0;;) {
            const std::size_t to = std::min(line_.find(',', from), line_.size());
            fields_.push_back(line_.substr(from, to - from));
            if (to == line_.size()) break;
            from = to + 1;
        }
        if (fields_.size() != 3) fail("expected " + columns_);
        return true;
    }
    /// A number below `end`.
    [[nodiscard]] std::uint32_t number(std::size_t column, std::string_view singular, std::size_t end) const {
        const std::optional<std::uint32_t> value = parsed<std::uint32_t>(column);
        if (!value || *value >= end) fail("expected " + std::string(singular) + " below " + std::to_string(end));
        return *value;
    }
    /// A number below `end`; empty if it is another integer.
    [[nodiscard]] std::optional<std::uint32_t> number_if_known(std::size_t column, std::string_view singular,
                                                               std::size_t end) const {
        const std::optional<std::int64_t> value = parsed<std::int64_t>(column);
        if (!value) fail("expected " + std::string(singular) + " below " + std::to_string(end));
        if (*value < 0 || static_cast<std::uint64_t>(*value) >= end) return std::nullopt;
        return static_cast<std::uint32_t>(*value);
    }
    [[nodiscard]] double milliseconds(std::size_t column) const {
        const std::optional<double> value = parsed<double>(column);
        if (!value || !(*value >= 0) || !std::isfinite(*value))
            fail("expected a time in milliseconds, finite and not negative");
        return *value;
    }
    /// Throws an error that quotes the row and its line number.
    [[noreturn]] void fail(const std::string& sentence) const {
        constexpr std::size_t longest_quote = 60;  // since a row may have any length
        std::string row(line_.substr(0, longest_quote));
        if (line_.size() > longest_quote) row += "…";
        throw aabb::input_error(noun_ + ", line " + std::to_string(in_->number()) + ", '" + row + "': " + sentence);
    }

private:
    template <class Number>
    [[nodiscard]] std::optional<Number> parsed(std::size_t column) const {
        const std::string_view text = fields_[column];
        Number value{};
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error == std::errc() && rest == text.data() + text.size() ? std::optional(value) : std::nullopt;
    }

    std::string noun_, columns_;
    std::optional<line_stream> in_;
    std::string_view line_;
    std::vector<std::string_view> fields_;  // views into line_
};

/// A broad phase that replays the pairs of an external engine. The constructor runs the engine on the whole scene.
/// Error messages begin with the place in the config and the scene.
class external_search final : public aabb::global_stage {
public:
    /// Runs the engine, an external program, on all frames at once; `update` then advances through its pairs.
    /// @param exchange the recorded scene, and the folder for the output
    /// @param output receives the reported times, the names of the files and, as frames are taken, the faulty rows
    /// @throws engine_timeout, and aabb::input_error if the engine fails or reports malformed times
    external_search(const external_engine& engine, exchange_folder& exchange, external_output& output)
        : output_(output),
          place_(engine.place + ": " + exchange.scene_text() + ": "),
          name_("external engine '" + engine.name + "'") {
        with_place([&] {
            run(engine, exchange);
            read_times(output.times);
            output.recording = exchange.recording();
            output.pairs = pairs_file_;
            output.faulty_rows = 0;
            table_.emplace("the pairs of the " + name_, pairs_file_, "frame,a,b");
            read_next_row();
        });
    }

    void insert(std::uint32_t) override {}
    void remove(std::uint32_t) override {}
    /// Advances to the next frame.
    /// @throws aabb::input_error on rows that are malformed, or of an earlier frame
    void update(std::span<const aabb::box>) override {
        with_place([this] { take_frame(); });
    }
    void search(std::vector<aabb::index_pair>& pairs) override {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
    }
    /// The engine has found the pairs of all objects, in every frame.
    [[nodiscard]] bool finds_overlaps_only() const override { return false; }
    [[nodiscard]] aabb::work_counters counters() const override { return {}; }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return {}; }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return {}; }

private:
    struct pair_row {
        std::uint32_t frame;
        aabb::index_pair pair;
    };

    /// Prefixes errors of `work` with the place in the config. Timeouts keep their type: other candidates still run.
    template <class Work>
    void with_place(Work work) const {
        try {
            work();
        } catch (const engine_timeout& error) {
            throw engine_timeout(place_ + error.what());
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(place_ + error.what());
        }
    }

    [[noreturn]] void fail(const std::string& sentence) const { throw aabb::input_error("the " + name_ + sentence); }

    /// Runs the engine on the recording; it writes pairs and times to files: COMMAND… RECORDING PAIRS TIMES.
    void run(const external_engine& engine, exchange_folder& exchange) {
        const std::filesystem::path recording = exchange.recording();
        objects_ = exchange.objects();
        frames_ = exchange.frames();
        pairs_file_ = recording.parent_path() / (engine.name + ".pairs.csv");
        times_file_ = recording.parent_path() / (engine.name + ".times.csv");
        std::vector<std::string> arguments(engine.command.begin() + 1, engine.command.end());
        arguments.push_back(recording.string());
        for (const std::filesystem::path& file : {pairs_file_, times_file_}) {
            // Files of an earlier run must not be mistaken for results.
            std::filesystem::remove(file);
            arguments.push_back(file.string());
        }
        // Without a terminal the engine cannot wait for input; the keeper kills all processes that it leaves behind.
        const std::chrono::seconds timeout(engine.timeout_s);
        const program_result ended =
            run_child(engine.program, arguments, {.input = "/dev/null", .has_keeper = true, .timeout = timeout});
        if (ended.timed_out)
            throw engine_timeout(fmt::format("the {} was killed: it was still running after {} s, its timeout_s", name_,
                                             engine.timeout_s));
        if (ended.start_error == ENOENT && engine.program.find('/') == std::string::npos)
            fail(fmt::format(": there is no program {0} in PATH; write ./{0} for one in the folder of the config",
                             engine.program));
        if (ended.start_error != 0)
            fail(": " + engine.program + " cannot be started: " + std::strerror(ended.start_error));
        if (!WIFEXITED(ended.status)) fail(" was terminated by signal " + std::to_string(WTERMSIG(ended.status)));
        if (WEXITSTATUS(ended.status) != 0) fail(" ended with status " + std::to_string(WEXITSTATUS(ended.status)));
    }

    /// Reads the times that the engine reports, one row per frame. They replace measured times in every ratio.
    void read_times(std::vector<reported_times>& times) const {
        times.clear();
        engine_output table("the times of the " + name_, times_file_, "frame,update_ms,search_ms");
        while (table.next()) {
            if (table.number(0, "a frame", frames_) != times.size())
                table.fail("expected frame " + std::to_string(times.size()) + "; each frame has one row, in order");
            times.push_back({table.milliseconds(1), table.milliseconds(2)});
            // A ratio cannot be formed with zero, and no search takes zero time.
            if (times.back().update_ms + times.back().search_ms == 0)
                table.fail("expected a sum of the two times above 0 ms");
        }
        if (times.size() < frames_)
            throw aabb::input_error("the times of the " + name_ + " end before frame " + std::to_string(times.size()));
    }

    /// Reads the next row that the scene can have, which may belong to a later frame, into `next_row_`; empty at the
    /// end of the file.
    void read_next_row() {
        next_row_.reset();
        while (table_->next()) {
            const auto frame = table_->number_if_known(0, "a frame", frames_);
            const auto a = table_->number_if_known(1, "an object", objects_);
            const auto b = table_->number_if_known(2, "an object", objects_);
            if (frame && a && b && *a != *b) {
                next_row_ = {*frame, aabb::ordered_pair(*a, *b)};
                return;
            }
            ++output_.faulty_rows;
        }
    }

    /// Collects the pairs of `frame_`, each once, up to a row of a later frame; rows must be sorted by frame.
    void take_frame() {
        pairs_.clear();
        for (; next_row_ && next_row_->frame <= frame_; read_next_row()) {
            if (next_row_->frame < frame_)
                table_->fail(
                    fmt::format("this row of frame {} follows one of frame {}; expected rows sorted by frame, "
                                "from 0 on, in any order within a frame",
                                next_row_->frame, frame_));
            pairs_.push_back(next_row_->pair);
        }
        sort_rows(pairs_);
        const auto repeated = std::ranges::unique(pairs_);
        output_.faulty_rows += repeated.size();
        pairs_.erase(repeated.begin(), repeated.end());
        ++frame_;
    }

    external_output& output_;
    std::string place_, name_;
    std::filesystem::path pairs_file_, times_file_;
    std::size_t objects_ = 0, frames_ = 0;
    std::optional<engine_output> table_;
    std::uint32_t frame_ = 0;           // the next frame
    std::optional<pair_row> next_row_;  // the first row of a later frame
    std::vector<aabb::index_pair> pairs_;
};

/// An external engine as a candidate: `make_global` runs it on the scene and fills in its times (`reported`).
/// @param exchange the recorded scene, shared with other external engines
candidate candidate_of(const external_engine& engine, const std::shared_ptr<exchange_folder>& exchange) {
    candidate result;
    result.name.engine = engine.name;
    result.exact = result.exact_boxes = engine.exact;
    result.reported = std::make_unique<external_output>();
    result.make_global = [engine, exchange, output = result.reported](aabb::instrumentation) {
        return std::make_unique<external_search>(engine, *exchange, *output);
    };
    return result;
}

}  // namespace

/// The candidates that can run the scene, in table order: compositions, `auto`, engines, external engines.
std::vector<candidate> candidates_for(const experiment& e, const scene_choice& scene) {
    const bool meshes = has_meshes(scene);
    std::vector<candidate> candidates;
    std::set<candidate_name> names;
    for (const aabb::composition& c : e.compositions) {
        // A config that lists such a composition is rejected, but `validate` runs all compositions on every scene.
        if (!meshes && !needs_meshes(c).empty()) continue;
        candidate composed = candidate_of(c, meshes);
        // For boxes, compositions that differ only in the narrow phase are the same candidate.
        if (names.insert(composed.name).second) candidates.push_back(std::move(composed));
    }
    if (!e.automatic.empty()) {
        const scene_frames frames(scene);
        for (const aabb::named_strategies& named : e.automatic) candidates.push_back(candidate_of(named, frames));
    }
    for (const std::string& name : e.engines) {
        const auto engine = std::ranges::find(aabb::engines(), name, &aabb::engine_info::name);
        if (std::optional<candidate> c = candidate_of(*engine, meshes)) candidates.push_back(*std::move(c));
    }
    if (meshes) return candidates;
    const std::shared_ptr exchange = std::make_unique<exchange_folder>(scene);
    for (const external_engine& engine : e.externals) candidates.push_back(candidate_of(engine, exchange));
    return candidates;
}

std::string text_of(const candidate_name& name) {
    const std::string strategies = text_in_line(name.choices);
    return name.engine + (name.engine.empty() || strategies.empty() ? "" : " + ") + strategies;
}

}  // namespace aabblab
