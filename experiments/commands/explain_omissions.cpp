#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output.hpp"

// Imports, so it comes last.
#include "explain_omissions.hpp"

import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabblab.numbers;
import aabblab.play;
import aabblab.race;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

/// What a composition does without where it has this strategy that stands apart; stages say the rest themselves.
std::string left_out_by(aabb::strategy_kind kind, const std::string& choice) {
    if (!info_of(kind).apart) return {};
    const auto found = std::ranges::find(aabb::strategies(kind), choice, &aabb::strategy_info::name);
    return found == aabb::strategies(kind).end() ? "" : found->leaves_out;
}

/// What is left out, without the reason.
std::string omitted(std::string_view sentence) {
    return std::string(sentence.substr(0, sentence.find(':')));
}

/// After its first frames.
std::vector<std::string> omitted_by(const scene_choice& choice, const contender& who) {
    scene_play scene(choice);
    player p(who, scene, aabb::instrumentation::none);
    play(scene, p, [](const played_frame&) {}, explained_frames);
    std::vector<std::string> all;
    for (const std::string& sentence : omissions_of(who.name, p))
        if (std::string one = omitted(sentence); std::ranges::find(all, one) == all.end())
            all.push_back(std::move(one));
    return all;
}

double median_ms(std::span<const race_time> times) {
    return quartiles_of(frame_ms_of(times)).median;
}

/// With its sign.
std::string more(std::uint64_t bytes, std::uint64_t than) {
    return bytes < than ? "-" + grouped(than - bytes) : grouped(bytes - than);
}

}  // namespace

std::vector<std::string> omissions_of(const contender_name& who, const player& playing) {
    std::vector<std::string> all = playing.left_out();
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (std::string sentence = left_out_by(kind, who[kind]); !sentence.empty()) all.push_back(std::move(sentence));
    return all;
}

std::vector<other_way> ways_by_settings(const aabb::composition& selected, bool meshes) {
    const auto with = [&](aabb::strategy_kind kind, aabb::strategy_choice choice) {
        aabb::composition c = selected;
        c[kind] = std::move(choice);
        return c;
    };
    std::vector<other_way> all;
    for (const aabb::composition& c :
         {with(aabb::strategy_kind::prepare, {"neighbour_list", {{"margin", "0.1"}}}),
          with(aabb::strategy_kind::partition, {"columns", {{"few", "0"}}}),
          with(aabb::strategy_kind::partition, {"axial_cut", {{"axes", "3"}, {"segments", "2"}}})})
        for (const aabb::strategy_kind kind : {aabb::strategy_kind::prepare, aabb::strategy_kind::partition})
            if (c[kind] != selected[kind] && refusal_of(c, aabb::stage::global_search).empty())
                all.push_back({to_text(c[kind]), contender_of(c, meshes), {}});
    return all;
}

void print_omissions(const scene_choice& scene, std::span<const other_way> all) {
    std::vector<std::vector<std::string>> omitted_by_all;
    for (const other_way& one : all) omitted_by_all.push_back(omitted_by(scene, one.who));
    const std::vector<race_time>& times = all[0].times;
    const std::vector<std::string> heads{"left out", "is had with", "ms/frame", "bytes"};
    std::vector<std::vector<std::string>> rows;
    for (const std::string& what : omitted_by_all[0]) {
        const other_way* least = nullptr;
        for (std::size_t i = 1; i < all.size(); ++i)
            if (std::ranges::find(omitted_by_all[i], what) == omitted_by_all[i].end() &&
                (!least || median_ms(all[i].times) < median_ms(least->times)))
                least = &all[i];
        rows.push_back({what, "-", "-", "-"});
        if (!least) continue;
        const bool open = paired_ratio_of(frame_ms_of(least->times), frame_ms_of(times)).may_be_same();
        rows.back() = {what, least->name,
                       fmt::format("{:.3g}{}", median_ms(least->times) - median_ms(times), open ? "?" : ""),
                       more(least->times.back().bytes, times.back().bytes)};
    }
    std::size_t others = 0;
    for (std::size_t column = 1; column < heads.size(); ++column) {
        std::size_t widest = heads[column].size();
        for (const std::vector<std::string>& row : rows) widest = std::max(widest, row[column].size());
        others += 2 + widest;
    }
    const std::size_t room = std::max(output_width(), others + 20) - others;
    table t{{{heads[0], false}, {heads[1], false}, {heads[2]}, {heads[3]}}, {}};
    for (std::vector<std::string>& cells : rows) {
        std::istringstream lines(wrapped(cells[0], room));
        while (std::getline(lines, cells[0])) {
            t.rows.push_back(cells);
            std::ranges::fill(cells, "");
        }
    }
    print(to_text(t));
}

}  // namespace aabblab
