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
/// With more objects, what sorts or sweeps all of them slowly would take minutes.
constexpr std::size_t most_objects_of_any = 20'000;

/// A way of playing the scene, played in the same rounds as the others.
struct other_way {
    std::string kind;  ///< in which it differs from what is selected; empty where it does not
    std::string name;  ///< of what stands in its place
    contender who;
    std::vector<observation> times{};     ///< none where no play came to its end
    std::optional<attempt> broken_off{};  ///< its first play, where that did not
    bool is_hopeless = false;             ///< it takes far longer than what is selected
};

/// What it is called where its kind does not stand beside it.
std::string called(const other_way& one) {
    return one.name == "none" ? one.kind + " none" : one.name;
}

/// Compositions that differ from the selected one in this kind, make sense in the scene and are exact.
std::vector<other_way> others(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<other_way> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        if (info.name == selected[kind].name) continue;
        aabb::composition c = selected;
        c[kind] = {info.name, {}};
        if (refusal_of(c, info_of(kind).stage).empty() && is_exact(c, info_of(kind).stage) &&
            (meshes || needs_meshes(c).empty()))
            all.push_back({std::string(name_of(kind)), info.name, contender_of(c, meshes)});
    }
    return all;
}

/// Those that have what the selected one leaves out for the sake of this kind's settings, not of its strategy.
std::vector<other_way> ways_by_settings(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<other_way> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind))
        for (const aabb::strategy_choice& choice : info.contrasts) {
            aabb::composition c = selected;
            c[kind] = choice;
            if (c != selected && refusal_of(c, info_of(kind).stage).empty())
                all.push_back({std::string(name_of(kind)), to_text(choice), contender_of(c, meshes)});
        }
    return all;
}

double median_ms(std::span<const observation> times) {
    return quartiles_of(frame_ms_of(times)).median;
}

/// What is left out, without reasons.
std::vector<aabb::absence> omitted_by(const other_way& one) {
    std::vector<aabb::absence> all;
    for (const aabb::omission& absent : omissions_of(one.who.name, one.times.back().left_out))
        if (std::ranges::find(all, absent.what) == all.end()) all.push_back(absent.what);
    return all;
}

/// Of those that leave it out not, the one that takes least time a frame; null where all do.
const other_way* fastest_with(aabb::absence what, std::span<const other_way> all) {
    const other_way* fastest = nullptr;
    for (const other_way& one : all)
        if (!one.times.empty() && std::ranges::count(omitted_by(one), what) == 0 &&
            (!fastest || median_ms(one.times) < median_ms(fastest->times)))
            fastest = &one;
    return fastest;
}

std::string more(std::uint64_t bytes, std::uint64_t than) {
    return bytes < than ? "-" + grouped(than - bytes) : grouped(bytes - than);
}

/// Prints for all that the first one leaves out which of the others has it and takes the least time, and how much more.
void print_omissions(std::span<const other_way> all) {
    const std::vector<observation>& times = all[0].times;
    table t{{{"left out", false}, {"is had with", false}, {"ms/frame"}, {"bytes"}}, {}};
    for (const aabb::absence what : omitted_by(all[0])) {
        t.rows.push_back({to_text(what), "-", "-", "-"});
        const other_way* with = fastest_with(what, all.subspan(1));
        if (!with) continue;
        const bool open = paired_ratio_of(frame_ms_of(with->times), frame_ms_of(times)).may_be_same();
        t.rows.back() = {to_text(what), called(*with),
                         fmt::format("{:.5f}{}", median_ms(with->times) - median_ms(times), open ? "?" : ""),
                         more(with->times.back().bytes, times.back().bytes)};
    }
    print("what is left out saves, against the fastest way of having it\n");
    print_broken(t, 0);
    print(wrapped("-: none that was played has it. Below 0: having it takes less. ?: as above.") + "\n");
}

/// The same with counters in its stages.
contender with_counters(contender who) {
    const auto counting = [](const auto& make) {
        return [make](aabb::instrumentation) { return make(aabb::instrumentation::counters); };
    };
    who.make_global = counting(who.make_global);
    if (who.make_local) who.make_local = counting(who.make_local);
    return who;
}

std::vector<std::string> ratio_cells(const other_way& one, std::span<const observation> selected) {
    if (one.is_hopeless) return {fmt::format("> {:.0f}", hopeless_ratio), "-"};
    if (one.times.empty()) return {"-", "-"};
    const paired_ratio ratio = paired_ratio_of(frame_ms_of(one.times), frame_ms_of(selected));
    return {fmt::format("{:.2f}{}", ratio.median, ratio.may_be_same() ? "?" : ""),
            fmt::format("{:.2f}-{:.2f}", ratio.least, ratio.greatest)};
}

void add_row(table& t, const other_way& one, const other_way& selected) {
    const std::vector<std::string> ratio =
        &one == &selected ? std::vector<std::string>{"1", "-"} : ratio_cells(one, selected.times);
    if (one.times.empty()) {
        t.rows.push_back({one.kind, one.name, "-", ratio[0], ratio[1], "-", "-"});
        return;
    }
    std::vector<double> build_ms;
    for (const observation& time : one.times) build_ms.push_back(time.build.wall_ms);
    t.rows.push_back({one.kind, one.name, fmt::format("{:.4g}", median_ms(one.times)), ratio[0], ratio[1],
                      fmt::format("{:.3g}", quartiles_of(build_ms).median), grouped(one.times.back().bytes)});
}

void print_unfinished(const std::vector<other_way>& all) {
    table t{{{"not finished", false}, {"", false}}, {}};
    for (const other_way& one : all)
        if (one.broken_off) t.rows.push_back({called(one), text_of(*one.broken_off)});
    if (!t.rows.empty()) print(to_text(t, output_width()) + "\n");
}

/// @returns whether there are none
bool print_disagreements(const std::vector<other_way>& all) {
    // What is inexact, or moves a scene that reacts, finds others by design.
    if (!all.front().who.exact || !all.front().who.exact_boxes) return true;
    std::vector<std::vector<observation>> times;
    for (const other_way& one : all) times.push_back(one.times);
    const std::vector<std::size_t> wrong = who_disagrees(times);
    for (const std::size_t i : wrong)
        print_paragraph(called(all[i]) + " finds other pairs than what is selected: one of the two is wrong.");
    return wrong.empty();
}

}  // namespace

std::vector<aabb::omission> omissions_of(const contender_name& who, std::vector<aabb::omission> by_stages) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        // Stages say the rest themselves.
        if (!info_of(kind).apart || who[kind].empty()) continue;
        const std::span<const aabb::strategy_info> all = aabb::strategies(kind);
        const auto found = std::ranges::find(all, aabb::parse_strategy(who[kind]).name, &aabb::strategy_info::name);
        assert(found != all.end());
        for (const aabb::absence what : found->leaves_out) by_stages.push_back({what});
    }
    return by_stages;
}

bool print_savings(staged_scene& staged, const aabb::composition& selected, const time_limits& limits) {
    const scene_play& scene = staged.scene();
    const bool meshes = scene.meshes() != nullptr;
    const bool any = scene.objects() <= most_objects_of_any;
    std::vector<other_way> all{{"", "as selected", contender_of(selected, meshes)}};
    std::vector<other_way> by_settings;
    std::string alone;  // kinds of which nothing else goes with the rest
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (!meshes && info_of(kind).stage == aabb::stage::local_detection) continue;
        if (!any && !info_of(kind).apart) continue;
        const std::vector<other_way> some = others(selected, kind, meshes);
        all.insert(all.end(), some.begin(), some.end());
        std::ranges::move(ways_by_settings(selected, kind, meshes), std::back_inserter(by_settings));
        if (some.empty()) alone += (alone.empty() ? "" : ", ") + std::string(name_of(kind));
    }
    all.push_back({"", "counters of all work", with_counters(all.front().who)});
    const std::size_t in_one_kind = all.size();
    std::ranges::move(by_settings, std::back_inserter(all));
    std::vector<contender> playing;
    for (const other_way& one : all) playing.push_back(one.who);
    turns played = play_in_turn(staged, playing, most_frames, rounds, limits);
    if (played.times[0].empty()) {
        const attempt& selected_play = *played.broken_off[0];
        if (selected_play.end == ending::refused) throw aabb::input_error(selected_play.reason);
        print_paragraph("what each choice saves is not known; as selected: " + text_of(selected_play) +
                        (selected_play.end == ending::stopped ? "; increase --seconds" : "") + ".");
        return true;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].times = std::move(played.times[i]);
        all[i].broken_off = std::move(played.broken_off[i]);
        all[i].is_hopeless = played.hopeless[i];
    }

    table t = empty_table({"kind", "in its place"}, {"ms/frame", "ratio", "range"});
    t.columns.push_back({"build ms", true, 2});
    t.columns.push_back({"bytes", true, 1});
    for (std::size_t i = 0; i < in_one_kind; ++i) add_row(t, all[i], all[0]);
    print_paragraph(fmt::format("what each choice saves: one kind at a time in another way, all in turn, {} of {}",
                                counted(played.rounds, "round"), counted(played.frames, "frame")));
    print(to_text(t, output_width()) + "\n");
    print_unfinished(all);
    if (!alone.empty()) print_paragraph(alone + ": nothing else can be composed with the rest.");
    if (!any)
        print_paragraph(fmt::format("With more than {} only kinds that stand apart are tried in other ways.",
                                    counted(most_objects_of_any, "object")));
    print_paragraph(ms_a_frame_text);
    print_paragraph(fmt::format(
        "ratio: ms/frame over that of what is selected in the same round, the median; range: the least and the "
        "greatest; ?: the range comes within 3 % of 1, so that the rounds leave it open; > {:.0f}: seen in one "
        "round.",
        hopeless_ratio));
    print_paragraph(build_ms_text);
    print_paragraph("bytes: held after the last of these frames; counters: the same with all work counted.");
    print("\n");
    print_omissions(all);
    const bool same = print_disagreements(all);
    flush_output();
    return same;
}

}  // namespace aabblab
