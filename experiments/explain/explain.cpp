module aabblab.explain;

import aabb.policy;
import aabb.selection;
import aabblab.configs;
import aabblab.fmt;
import aabblab.inputs;
import aabblab.measures;
import aabblab.numbers;
import aabblab.output;
import aabblab.scenes;
import aabblab.stopwatch;
import aabblab.suites;

namespace aabblab {

namespace {

/// The parts with the bytes of all of the same name: a filter and a Verlet list are both `prepare`.
std::vector<aabb::part_bytes> summed_by_name(const std::vector<aabb::part_bytes>& parts) {
    std::vector<aabb::part_bytes> sums;
    for (const aabb::part_bytes& part : parts) {
        const auto same = std::ranges::find(sums, part.part, &aabb::part_bytes::part);
        if (same == sums.end())
            sums.push_back(part);
        else
            same->bytes += part.bytes;
    }
    return sums;
}

std::string text_of(std::string_view stage, const std::string& strategies, const std::vector<aabb::part_bytes>& parts) {
    std::string text = fmt::format("    {}{}{}\n", stage, strategies.empty() ? "" : ": ", strategies);
    for (const aabb::part_bytes& part : summed_by_name(parts))
        text += fmt::format("      {:<34}{:>14} bytes\n",
                            part.part == "projections" ? "set of objects, and lists if any" : part.part,
                            grouped(part.bytes));
    return text;
}

std::string indented_list(std::string_view heading, const std::vector<std::string>& sentences) {
    std::string text = sentences.empty() ? "" : fmt::format("    {}\n", heading);
    for (const std::string& sentence : sentences) text += hanging("      ", sentence) + "\n";
    return text;
}

/// The share of the remaining time that one part of the explanation may use.
constexpr double share_of_part = 0.25;

/// Why work in a child process did not finish, in place of its output.
std::string reason_of(const child_result& result) {
    return text_of(attempt{result.end, {}, result.reason, result.seconds});
}

std::string text_of(const candidate_name& name, aabb::stage stage) {
    const std::string text = text_in_line(name.choices, kinds_of(stage));
    return text.empty() ? name.engine : text;
}

/// Enough that buffers have grown and data that is kept between frames exists.
constexpr std::size_t frames_before_bytes = 2;

/// Runs a candidate on the first frames, and describes each stage: strategies, bytes by part, plans, omissions.
std::string explanation_of(scene_frames& scene, const candidate& tested) {
    stage_runner runner(tested, scene, aabb::instrumentation::none);
    run_frames(scene, runner, [](const searched_frame&) {}, frames_before_bytes);
    const candidate_name& name = tested.name;
    std::string text;
    if (scene.frames() > frames_before_bytes)
        text = fmt::format("    memory after the first {} of {} frames; aabblab run reports it after the last\n",
                           frames_before_bytes, grouped(scene.frames()));
    text += text_of("broad phase", text_of(name, aabb::stage::global_search), runner.global_bytes());
    text += text_of(scene.meshes() ? "between phases" : "found pairs", "", {{"buffers", runner.buffer_bytes()}});
    if (scene.meshes())
        text += text_of("narrow phase", text_of(name, aabb::stage::local_detection), runner.local_bytes());
    std::vector<std::string> planned;
    for (const aabb::stage_plan& plan : runner.plans()) planned.push_back(to_text(plan.decision));
    text += indented_list("plans for the next frames", planned);
    std::vector<std::string> left_out;
    for (const aabb::omission& absent : omissions_of(name, runner.left_out())) left_out.push_back(to_text(absent));
    return text + indented_list("left out", left_out);
}

/// Prints the explanation of a candidate, made in a child process with a time limit, or why it did not finish.
void print_candidate(staged_scene& scene, const candidate& tested, const time_limits& limits) {
    const child_result result =
        scene.in_child([&](scene_frames& frames, const output_sender& send) { send(explanation_of(frames, tested)); },
                       share_of_part * limits.to_run());
    // A candidate rejects only invalid input.
    if (result.end == ending::rejected) throw aabb::input_error(result.reason);
    print(hanging("  ", text_of(tested.name)) + "\n");
    print(result.end == ending::done ? result.reported
                                     : hanging("    ", "bytes and plans: " + reason_of(result)) + "\n");
}

/// Says which engines and strategy kinds do not apply: those of the narrow phase, if the scene has no meshes.
void print_idle_parts(const experiment& e, const scene_choice& scene) {
    for (const std::string& sentence : idle_engines(e, scene, "this scene")) print("  " + sentence + "\n");
    if (has_meshes(scene)) return;
    std::string kinds;
    for (const aabb::strategy_kind kind : kinds_of(aabb::stage::local_detection))
        kinds += (kinds.empty() ? "" : ", ") + std::string(name_of(kind));
    print("  " + kinds + " do not apply to this scene: it has no meshes\n");
}

/// Prints the scene and its measures. They are computed in a child process with a time limit; if it does not finish,
/// only the numbers of objects and frames are known.
void print_measures(staged_scene& scene, const time_limits& limits) {
    const child_result result = scene.in_child(
        [](scene_frames& frames, const output_sender& send) {
            send(to_text(measures_table(measure_scene(frames)), output_width()));
        },
        share_of_part * limits.to_run());
    if (result.end == ending::rejected) throw aabb::input_error(result.reason);
    print_paragraph(heading_of(scene.choice()));
    table unmeasured = empty_table({"measured", ""});
    unmeasured.rows = {{"objects", grouped(scene.scene().objects())},
                       {"frames", grouped(scene.scene().frames())},
                       {"the rest", reason_of(result)}};
    print((result.end == ending::done ? result.reported : to_text(unmeasured, output_width())) + "\n");
}

void print_selected(const std::vector<aabb::selected_strategy>& selected) {
    table t = empty_table({"selected", "", "because"});
    for (const aabb::selected_strategy& s : selected)
        t.rows.push_back({std::string(name_of(s.kind)), to_text(s.choice), s.rule});
    print_wrapped_table(t, 2);
}

/// Explains the composition that `auto` selects for the scene, and what each choice saves over the alternatives.
/// @param named the strategies that the user has fixed; `auto` selects the others
/// @returns whether all compositions that ran find the same pairs
bool explain_automatic(staged_scene& scene, const aabb::named_strategies& named, const time_limits& limits) {
    const bool meshes = scene.scene().meshes() != nullptr;
    std::vector<aabb::selected_strategy> selected = select_strategies(named, traits_of(scene.scene()));
    const aabb::composition c = composed_of(selected);
    if (!meshes)
        std::erase_if(selected, [](const aabb::selected_strategy& s) {
            return info_of(s.kind).stage == aabb::stage::local_detection;
        });
    print_selected(selected);
    print_candidate(scene, candidate_of(c, meshes), limits);
    print("\n");
    flush_output();
    return print_savings(scene, c, limits);
}

/// Explains the compositions of a config in one scene: those that `auto` selects, with savings, then the named ones.
/// @returns whether all compositions that ran find the same pairs
bool explain_scene(const experiment& e, staged_scene& scene, const time_limits& limits) {
    print_measures(scene, limits);
    print_idle_parts(e, scene.choice());
    flush_output();
    bool agree = true;
    for (const aabb::named_strategies& named : e.automatic) {
        agree &= explain_automatic(scene, named, limits);
        print("\n");
    }
    const std::vector<candidate> candidates = candidates_for(e, scene.choice());
    for (const candidate& tested : candidates) {
        if (tested.name.is_automatic()) continue;
        print_candidate(scene, tested, limits);
        flush_output();
    }
    if (candidates.size() > e.automatic.size()) print("\n");
    return agree;
}

}  // namespace

/// Explains the compositions of a config in its scenes, or `auto` in one: what runs, why, and what it saves.
/// @returns the exit status: 1 if compositions disagree about the pairs
int explain(const explain_request& request) {
    experiment e;
    if (request.what.size() == 1 && is_config_name(request.what.front())) {
        if (request.filter.any())
            throw aabb::input_error("--groups and --except are for a scene; a config has the keys groups and except");
        e = open_experiment(request.what.front(), /*quick=*/false);
    } else {
        e.automatic.emplace_back();
        add_filter(request.filter, e.scenes.emplace_back(scene_of_arguments(request.what)));
    }
    if (!e.automatic.empty()) require_fine_clock();
    bool agree = true;
    for (const scene_choice& choice : e.scenes) {
        time_limits limits(request.seconds);
        // A scene that cannot be created is reported before any output.
        staged_scene scene(choice);
        limits.note_scene_read();
        if (&choice == e.scenes.data()) print(wrapped("costs of elementary operations: " + costs_in_force()) + "\n\n");
        agree &= explain_scene(e, scene, limits);
    }
    return agree ? 0 : 1;
}

/// Prints a table; cells of one column are wrapped to the width that the others leave.
void print_wrapped_table(const table& t, std::size_t column) {
    constexpr std::size_t between = 2, least_room = 20;  // characters
    std::size_t other_widths = 0;
    for (std::size_t other = 0; other < t.columns.size(); ++other) {
        if (other == column) continue;
        std::size_t widest = t.columns[other].name.size();
        for (const std::vector<std::string>& row : t.rows) widest = std::max(widest, row[other].size());
        other_widths += between + widest;
    }
    const std::size_t room = std::max(output_width(), other_widths + least_room) - other_widths;
    table broken{t.columns, {}};
    for (std::vector<std::string> cells : t.rows) {
        std::istringstream lines(wrapped(cells[column], room));
        while (std::getline(lines, cells[column])) {
            broken.rows.push_back(cells);
            std::ranges::fill(cells, "");
        }
    }
    print(to_text(broken) + "\n");
}

}  // namespace aabblab
