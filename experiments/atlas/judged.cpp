module;
#include <fmt/format.h>

module aabblab.atlas;

import :noise;
import :statement;
import aabblab.numbers;

namespace aabblab {

namespace {

struct measured_ratio {
    std::size_t scenes = 0;
    estimate log{std::nan(""), 0, 1};
};

/// The mean over the scenes that both play, which know nothing of each other.
measured_ratio ratio_in(const std::vector<atlas_scene>& atlas, const stated_ratio& r, const scene_filter& in) {
    std::vector<estimate> all;
    for (const atlas_scene& scene : atlas) {
        if (!in(scene)) continue;
        const atlas_line* arm = scene.find(r.arm);
        const atlas_line* base = scene.find(r.base);
        if (!arm || !base) continue;
        if (const estimate one = log_ratio_in(scene, *arm, *base, span_of_time::frame); one.known()) all.push_back(one);
    }
    return all.empty() ? measured_ratio() : measured_ratio{all.size(), mean_of(all)};
}

measured_ratio measured(const std::vector<atlas_scene>& atlas, const stated_ratio& r) {
    measured_ratio here = ratio_in(atlas, r, r.in);
    if (!r.over || here.scenes == 0) return here;
    const measured_ratio there = ratio_in(atlas, r, r.over);
    if (there.scenes == 0) return {};
    return {here.scenes + there.scenes, difference_of(here.log, there.log)};
}

std::string what_of(const stated_ratio& r) {
    return r.arm + " over " + r.base;
}

}  // namespace

std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas) {
    std::vector<judged_statement> all;
    std::vector<tested> evidence;
    std::vector<judged_ratio*> judged;
    // Pointers to ratios stay good: room for all is made first.
    all.reserve(statements().size());
    for (const statement& s : statements()) {
        judged_statement& made =
            all.emplace_back(s.id, s.source, s.says, verdict_kind::undecided, std::vector<judged_ratio>());
        made.ratios.reserve(s.ratios.size());
        for (const stated_ratio& r : s.ratios) {
            const measured_ratio found = measured(atlas, r);
            if (found.scenes == 0 || !found.log.known()) continue;
            const interval range = found.log.range();
            judged.push_back(&made.ratios.emplace_back(r.where, what_of(r), found.scenes, std::exp(found.log.value),
                                                       interval{std::exp(range.low), std::exp(range.high)},
                                                       support::undecided));
            evidence.push_back({r.expected, tails_of(found.log, r.band)});
        }
    }
    const std::vector<double> levels = levels_together(evidence);
    for (std::size_t i = 0; i < judged.size(); ++i)
        judged[i]->found = support_of(evidence[i].expected, evidence[i].p, levels[i]);
    for (judged_statement& s : all) {
        std::vector<support> found;
        for (const judged_ratio& r : s.ratios) found.push_back(r.found);
        s.verdict = verdict_of(found);
    }
    return all;
}

table statements_table(const std::vector<judged_statement>& all) {
    table t{{{"statement", false}, {"says", false}, {"source", false}, {"verdict", false}, {"ratios", false}}, {}};
    for (const judged_statement& s : all) {
        std::string ratios;
        for (const judged_ratio& r : s.ratios) ratios += (ratios.empty() ? "" : ", ") + fmt::format("{:.3g}", r.ratio);
        t.rows.push_back({s.id, s.says, s.source, text_of(s.verdict), ratios});
    }
    return t;
}

table ratios_table(const std::vector<judged_statement>& all) {
    table t{{{"statement", false},
             {"where", false},
             {"time of a frame", false},
             {"scenes"},
             {"ratio"},
             {"95 %"},
             {"found", false}},
            {}};
    for (const judged_statement& s : all)
        for (const judged_ratio& r : s.ratios)
            t.rows.push_back({s.id, r.where, r.what, grouped(r.scenes), fmt::format("{:.3g}", r.ratio),
                              fmt::format("{:.3g}-{:.3g}", r.range.low, r.range.high), text_of(r.found)});
    return t;
}

std::vector<std::string> labels_in_statements() {
    std::vector<std::string> labels;
    for (const statement& s : statements())
        for (const stated_ratio& r : s.ratios)
            for (const std::string& label : {r.arm, r.base})
                if (std::ranges::find(labels, label) == labels.end()) labels.push_back(label);
    return labels;
}

}  // namespace aabblab
