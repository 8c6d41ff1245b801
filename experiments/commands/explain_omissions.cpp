#include <fmt/format.h>

#include <cassert>

// Imports, so they come last.
#include "explain_omissions.hpp"
#include "scene_texts.hpp"

import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.std;
import aabblab.numbers;
import aabblab.output;
import aabblab.trials;
import aabblab.race;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

double median_ms(std::span<const observation> times) {
    return quartiles_of(frame_ms_of(times)).median;
}

/// What is left out, without reasons.
std::vector<std::string> omitted_by(const other_way& one) {
    std::vector<std::string> all;
    for (const aabb::omission& absent : omissions_of(one.who.name, one.times.back().left_out))
        if (std::ranges::find(all, absent.what) == all.end()) all.push_back(absent.what);
    return all;
}

/// Of those that leave it out not, the one that takes least time a frame; null where all do.
const other_way* fastest_with(const std::string& what, std::span<const other_way> all) {
    const other_way* fastest = nullptr;
    for (const other_way& one : all)
        if (!one.times.empty() && std::ranges::count(omitted_by(one), what) == 0 &&
            (!fastest || median_ms(one.times) < median_ms(fastest->times)))
            fastest = &one;
    return fastest;
}

/// With its sign.
std::string more(std::uint64_t bytes, std::uint64_t than) {
    return bytes < than ? "-" + grouped(than - bytes) : grouped(bytes - than);
}

}  // namespace

std::vector<aabb::omission> omissions_of(const contender_name& who, std::vector<aabb::omission> by_stages) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        // Stages say the rest themselves.
        if (!info_of(kind).apart || who[kind].empty()) continue;
        const std::span<const aabb::strategy_info> all = aabb::strategies(kind);
        const auto found = std::ranges::find(all, aabb::parse_strategy(who[kind]).name, &aabb::strategy_info::name);
        assert(found != all.end());
        for (const std::string& what : found->leaves_out) by_stages.push_back({what, {}});
    }
    return by_stages;
}

std::vector<other_way> ways_by_settings(const aabb::composition& selected, aabb::strategy_kind kind, bool meshes) {
    std::vector<other_way> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind))
        for (const aabb::strategy_choice& choice : info.contrasts) {
            aabb::composition c = selected;
            c[kind] = choice;
            if (c != selected && refusal_of(c, info_of(kind).stage).empty())
                all.push_back({std::string(name_of(kind)), to_text(choice), contender_of(c, meshes), {}, {}, false});
        }
    return all;
}

std::string called(const other_way& one) {
    return one.name == "none" ? one.kind + " none" : one.name;
}

void print_omissions(std::span<const other_way> all) {
    const std::vector<observation>& times = all[0].times;
    const std::vector<std::string> heads{"left out", "is had with", "ms/frame", "bytes"};
    std::vector<std::vector<std::string>> rows;
    for (const std::string& what : omitted_by(all[0])) {
        rows.push_back({what, "-", "-", "-"});
        const other_way* with = fastest_with(what, all.subspan(1));
        if (!with) continue;
        const bool open = paired_ratio_of(frame_ms_of(with->times), frame_ms_of(times)).may_be_same();
        rows.back() = {what, called(*with),
                       fmt::format("{:.5f}{}", median_ms(with->times) - median_ms(times), open ? "?" : ""),
                       more(with->times.back().bytes, times.back().bytes)};
    }
    std::size_t others = 0;
    for (std::size_t column = 1; column < heads.size(); ++column) {
        std::size_t widest = heads[column].size();
        for (const std::vector<std::string>& row : rows) widest = std::max(widest, row[column].size());
        others += 2 + widest;
    }
    const std::size_t room = std::max(output_width(), others + 20) - others;
    table t{{{heads[0], false}, {heads[1], false}, {heads[2]}, {heads[3]}}, {}};
    for (const std::vector<std::string>& cells : rows) add_wrapped_row(t, cells, 0, room);
    print("what is left out saves, against the fastest way of having it\n");
    print(to_text(t) + "\n");
    print(wrapped("-: none that was played has it. Below 0: having it takes less. ?: as above.") + "\n");
}

}  // namespace aabblab
