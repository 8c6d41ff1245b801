module;
#include <cassert>

module aabblab.explain;

import aabb.policy;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.output;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr std::size_t most_frames = 40;
constexpr std::size_t rounds = 5;
/// Scenes with more objects vary only some kinds: the slower sort and sweep strategies would take minutes.
constexpr std::size_t most_objects_to_vary_every_kind = 20'000;

/// A composition that runs in the same rounds as the selected one.
struct variant {
    std::string kind;  ///< the strategy kind in which it differs from the selected one; empty if none
    std::string name;  ///< of the strategy in its place
    candidate tested;
    std::vector<observation> times{};     ///< empty if no run finished
    std::optional<attempt> broken_off{};  ///< its first run, if that did not finish
    bool is_hopeless = false;             ///< far slower than the selected one
};

/// The variant's name where no column shows its kind.
std::string label_of(const variant& v) {
    return v.name == "none" ? v.kind + " none" : v.name;
}

/// The exact compositions that apply to the scene and differ from the selected one in the strategy of one kind.
std::vector<variant> variants_by_strategy(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<variant> variants;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        if (info.name == selected[kind].name) continue;
        aabb::composition c = selected;
        c[kind] = {info.name, {}};
        if (rejection_of(c, info_of(kind).stage).empty() && is_exact(c, info_of(kind).stage) &&
            (meshes || needs_meshes(c).empty()))
            variants.push_back({std::string(name_of(kind)), info.name, candidate_of(c, meshes)});
    }
    return variants;
}

/// Compositions in which one strategy has other settings, with features that the selected one may leave out.
std::vector<variant> variants_by_settings(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<variant> variants;
    for (const aabb::strategy_info& info : aabb::strategies(kind))
        for (const aabb::strategy_choice& choice : info.contrasts) {
            aabb::composition c = selected;
            c[kind] = choice;
            if (c != selected && rejection_of(c, info_of(kind).stage).empty())
                variants.push_back({std::string(name_of(kind)), to_text(choice), candidate_of(c, meshes)});
        }
    return variants;
}

double median_ms(std::span<const observation> times) {
    return quartiles_of(frame_ms_of(times)).median;
}

/// The features that a variant leaves out, such as a Verlet list, each once and without the reason.
std::vector<aabb::absence> omitted_by(const variant& v) {
    std::vector<aabb::absence> absences;
    for (const aabb::omission& absent : omissions_of(v.tested.name, v.times.back().left_out))
        if (std::ranges::find(absences, absent.feature) == absences.end()) absences.push_back(absent.feature);
    return absences;
}

/// The fastest variant that has this feature; null if every variant leaves it out.
const variant* fastest_with(aabb::absence feature, std::span<const variant> variants) {
    const variant* fastest = nullptr;
    for (const variant& v : variants)
        if (!v.times.empty() && std::ranges::count(omitted_by(v), feature) == 0 &&
            (!fastest || median_ms(v.times) < median_ms(fastest->times)))
            fastest = &v;
    return fastest;
}

std::string difference_text(std::uint64_t bytes, std::uint64_t than) {
    return bytes < than ? "-" + grouped(than - bytes) : grouped(bytes - than);
}

/// Prints what each feature left out by the selected composition saves: the time and bytes of the fastest variant that
/// has the feature, less those of the selected composition.
/// @param variants the selected composition, then the others
void print_omissions(std::span<const variant> variants) {
    const std::vector<observation>& times = variants[0].times;
    table t = empty_table({"left out", "available with"}, {"saved ms", "bytes"});
    for (const aabb::absence what : omitted_by(variants[0])) {
        t.rows.push_back({to_text(what), "-", "-", "-"});
        const variant* fastest = fastest_with(what, variants.subspan(1));
        if (!fastest) continue;
        const bool undecided = paired_ratio_of(frame_ms_of(fastest->times), frame_ms_of(times)).may_be_same();
        t.rows.back() = {to_text(what), label_of(*fastest),
                         fmt::format("{:.5f}{}", median_ms(fastest->times) - median_ms(times), undecided ? "?" : ""),
                         difference_text(fastest->times.back().bytes, times.back().bytes)};
    }
    print(
        "time per frame and bytes saved by what is left out, compared with the fastest\n"
        "variant that uses it; those with parameters are not in the table above\n");
    print_wrapped_table(t, 0);
    print(wrapped("-: no variant that ran used it (split_large divides nothing if no object is large). Below 0: the "
                  "variant takes less. ?: undecided, as above.") +
          "\n");
}

/// The same candidate with counters of all work: its time shows what counting costs.
candidate with_counters(candidate tested) {
    const auto counting = [](const auto& make) {
        return [make](aabb::instrumentation) { return make(aabb::instrumentation::counters); };
    };
    tested.make_global = counting(tested.make_global);
    if (tested.make_local) tested.make_local = counting(tested.make_local);
    return tested;
}

std::vector<std::string> ratio_cells_of(const variant& v, std::span<const observation> selected) {
    if (v.is_hopeless) return {fmt::format("> {:.0f}", hopeless_ratio), "-"};
    if (v.times.empty()) return {"-", "-"};
    const paired_ratio ratio = paired_ratio_of(frame_ms_of(v.times), frame_ms_of(selected));
    return {fmt::format("{:.2f}{}", ratio.median, ratio.may_be_same() ? "?" : ""),
            fmt::format("{:.2f}-{:.2f}", ratio.least, ratio.greatest)};
}

/// Adds a row with a variant's times and bytes, and the ratio to the selected composition; "-" if no run finished.
void add_row(table& t, const variant& v, const variant& selected) {
    const std::vector<std::string> ratio =
        &v == &selected ? std::vector<std::string>{"1", "-"} : ratio_cells_of(v, selected.times);
    if (v.times.empty()) {
        t.rows.push_back({v.kind, v.name, "-", ratio[0], ratio[1], "-", "-"});
        return;
    }
    std::vector<double> build_ms;
    for (const observation& time : v.times) build_ms.push_back(time.build.wall_ms);
    t.rows.push_back({v.kind, v.name, fmt::format("{:.4g}", median_ms(v.times)), ratio[0], ratio[1],
                      fmt::format("{:.3g}", quartiles_of(build_ms).median), grouped(v.times.back().bytes)});
}

void print_unfinished(const std::vector<variant>& variants) {
    table t = empty_table({"not finished", ""});
    for (const variant& v : variants)
        if (v.broken_off) t.rows.push_back({label_of(v), text_of(*v.broken_off)});
    if (!t.rows.empty()) print(to_text(t, output_width()) + "\n");
}

/// Prints which variants find other pairs than the selected composition, the first; all are exact, so one is wrong.
/// @returns whether the results of all variants agree
bool print_disagreements(const std::vector<variant>& variants) {
    // Inexact candidates find other pairs by design, and move a reactive scene differently.
    if (!variants.front().tested.exact || !variants.front().tested.exact_boxes) return true;
    std::vector<std::vector<observation>> times;
    for (const variant& v : variants) times.push_back(v.times);
    const std::vector<std::size_t> wrong = disagreeing(times);
    for (const std::size_t i : wrong)
        print_paragraph(label_of(variants[i]) +
                        " finds other pairs than the selected composition: one of the two is wrong.");
    return wrong.empty();
}

/// The variants that run beside the selected composition.
struct variant_lists {
    std::vector<variant> in_table{};     ///< the selected composition first, and with counters of all work last
    std::vector<variant> by_settings{};  ///< for `print_omissions` only
    std::string unreplaced{};            ///< kinds without any other strategy that fits the composition
};

/// Collects the variants of the selected composition that differ in one kind of strategy.
/// @param is_small varies all kinds; otherwise a slow sort, partition or sweep would take too long, so only those kinds
/// are varied that are compiled alone (`prepare`, `build`)
variant_lists variants_of(const aabb::composition& selected, bool meshes, bool is_small) {
    variant_lists lists;
    lists.in_table.push_back({"", "as selected", candidate_of(selected, meshes)});
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (!meshes && info_of(kind).stage == aabb::stage::local_detection) continue;
        if (!is_small && !info_of(kind).is_compiled_alone) continue;
        const std::vector<variant> of_kind = variants_by_strategy(selected, kind, meshes);
        lists.in_table.insert(lists.in_table.end(), of_kind.begin(), of_kind.end());
        std::ranges::move(variants_by_settings(selected, kind, meshes), std::back_inserter(lists.by_settings));
        if (of_kind.empty()) lists.unreplaced += (lists.unreplaced.empty() ? "" : ", ") + std::string(name_of(kind));
    }
    lists.in_table.push_back({"", "counters of all work", with_counters(lists.in_table.front().tested)});
    return lists;
}

/// One row per variant: its times, their ratio to those of the first, the selected composition, and its bytes.
table savings_table(std::span<const variant> variants) {
    table t = empty_table({"kind", "replaced by"}, {"ms/frame", "ratio", "range"});
    t.columns.push_back({.name = "build ms", .spare = 2});
    t.columns.push_back({.name = "bytes", .spare = 1});
    for (const variant& v : variants) add_row(t, v, variants[0]);
    return t;
}

}  // namespace

/// All features that a composition leaves out: those of its stages, and of strategies compiled alone.
std::vector<aabb::omission> omissions_of(const candidate_name& name, std::vector<aabb::omission> by_stages) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        // The stages report the omissions of all other kinds.
        if (!info_of(kind).is_compiled_alone || name[kind].empty()) continue;
        const std::span<const aabb::strategy_info> strategies = aabb::strategies(kind);
        const auto strategy =
            std::ranges::find(strategies, aabb::parse_strategy(name[kind]).name, &aabb::strategy_info::name);
        assert(strategy != strategies.end());
        for (const aabb::absence what : strategy->leaves_out) by_stages.push_back({what});
    }
    return by_stages;
}

/// Prints what each choice of the selected composition saves, measured by runs interleaved with those of variants that
/// differ in one strategy. Variants with other settings serve only `print_omissions`.
/// @returns false if variants report different pairs
bool print_savings(staged_scene& staged, const aabb::composition& selected, const time_limits& limits) {
    const scene_frames& scene = staged.scene();
    const bool meshes = scene.meshes() != nullptr;
    const bool is_small = scene.objects() <= most_objects_to_vary_every_kind;
    variant_lists lists = variants_of(selected, meshes, is_small);
    std::vector<variant> variants = std::move(lists.in_table);
    const std::size_t in_table = variants.size();
    std::ranges::move(lists.by_settings, std::back_inserter(variants));
    std::vector<candidate> candidates;
    for (const variant& v : variants) candidates.push_back(v.tested);
    interleaved_runs outcome = run_interleaved(staged, candidates, most_frames, rounds, limits);
    if (outcome.times[0].empty()) {
        const attempt& selected_run = *outcome.broken_off[0];
        if (selected_run.end == ending::rejected) throw aabb::input_error(selected_run.reason);
        print_paragraph("the alternatives to each choice could not be timed; as selected: " + text_of(selected_run) +
                        (selected_run.end == ending::stopped ? "; increase --seconds" : "") + ".");
        return true;
    }
    for (std::size_t i = 0; i < variants.size(); ++i) {
        variants[i].times = std::move(outcome.times[i]);
        variants[i].broken_off = std::move(outcome.broken_off[i]);
        variants[i].is_hopeless = outcome.hopeless[i];
    }

    print_paragraph(fmt::format(
        "alternatives to each choice: one strategy is replaced at a time; variants run interleaved, in {} of {} each",
        counted(outcome.rounds, "round"), counted(outcome.frames, "frame")));
    print(to_text(savings_table(std::span(variants).first(in_table)), output_width()) + "\n");
    print_unfinished(variants);
    if (!lists.unreplaced.empty())
        print_paragraph(lists.unreplaced + ": no other strategy can be composed with the rest.");
    if (!is_small)
        print_paragraph(fmt::format("With more than {}, only prepare and build are replaced, to save time.",
                                    counted(most_objects_to_vary_every_kind, "object")));
    print_paragraph(ms_per_frame_text);
    print_paragraph(fmt::format(
        "ratio: ms/frame relative to the selected composition in the same round, below 1 if the variant is faster; "
        "medians of "
        "rounds; range: the least and the greatest ratio; ?: undecided, since the range comes within 3 % of 1; "
        "> {:.0f}: dropped after one run.",
        hopeless_ratio));
    print_paragraph(build_ms_text);
    print_paragraph(
        "bytes: memory after the last frame of a round; counters of all work: as selected, with all work counted.");
    print("\n");
    print_omissions(variants);
    const bool agree = print_disagreements(variants);
    flush_output();
    return agree;
}

}  // namespace aabblab
