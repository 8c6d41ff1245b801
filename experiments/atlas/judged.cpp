module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

struct measured_ratio {
    std::size_t scenes = 0;
    estimate log{std::nan(""), 0, 1};
};

/// The ratio of two candidates' times, a geometric mean over matching scenes, which count as independent.
measured_ratio ratio_in(const std::vector<atlas_scene>& atlas, const statement_ratio& r, const scene_filter& matches) {
    std::vector<estimate> logs;
    for (const atlas_scene& scene : atlas) {
        if (!matches(scene)) continue;
        const atlas_candidate* candidate = scene.find(r.candidate);
        const atlas_candidate* baseline = scene.find(r.baseline);
        if (!candidate || !baseline) continue;
        if (const estimate log = log_ratio_in(scene, *candidate, *baseline); log.is_known()) logs.push_back(log);
    }
    return logs.empty() ? measured_ratio() : measured_ratio{logs.size(), mean_of(logs)};
}

/// The ratio that a statement speaks of, divided by that in the reference scenes; of no scenes if one is unknown.
measured_ratio measure(const std::vector<atlas_scene>& atlas, const statement_ratio& r) {
    measured_ratio ratio = ratio_in(atlas, r, r.scenes);
    if (!r.reference_scenes || ratio.scenes == 0) return ratio;
    const measured_ratio reference = ratio_in(atlas, r, r.reference_scenes);
    if (reference.scenes == 0) return {};
    return {ratio.scenes + reference.scenes, difference_of(ratio.log, reference.log)};
}

}  // namespace

/// The verdicts on all statements: Holm's correction for multiple tests needs all ratios before any is decided.
std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas) {
    std::vector<judged_statement> verdicts;
    std::vector<tested> evidence;
    for (const statement& s : statements()) {
        judged_statement& entry = verdicts.emplace_back(s.text);
        for (const statement_ratio& r : s.ratios) {
            const measured_ratio ratio = measure(atlas, r);
            if (ratio.scenes == 0 || !ratio.log.is_known()) continue;
            const interval range = ratio.log.range();
            entry.ratios.push_back({r.where, r.candidate + " over " + r.baseline, ratio.scenes,
                                    std::exp(ratio.log.value), interval{std::exp(range.low), std::exp(range.high)}});
            evidence.push_back({r.expected, tails_of(ratio.log, r.band)});
        }
    }
    const std::vector<double> levels = levels_together(evidence);
    std::size_t i = 0;  // over the ratios of all statements
    for (judged_statement& s : verdicts) {
        // A ratio that was not measured is undecided: the others alone do not decide the statement.
        const std::size_t stated = statements()[static_cast<std::size_t>(&s - verdicts.data())].ratios.size();
        std::vector<support> endpoints(stated - s.ratios.size(), support::undecided);
        for (judged_ratio& r : s.ratios) {
            r.verdict = support_of(evidence[i].expected, evidence[i].p, levels[i]);
            endpoints.push_back(r.verdict);
            ++i;
        }
        s.verdict = verdict_of(endpoints);
    }
    return verdicts;
}

/// A verdict on proxies says so: it is not one on the algorithms of the source.
std::string verdict_text(const judged_statement& s) {
    return text_of(s.verdict) + (s.text.is_proxy ? " (proxy)" : "");
}

/// One row per published statement: its source, what was played, its verdict and the ratios that decide it.
table statements_table(const std::vector<judged_statement>& judged) {
    table t = empty_table({"statement", "source", "link", "quote", "says", "played", "verdict", "ratios"});
    for (const judged_statement& s : judged) {
        std::string ratios;
        for (const judged_ratio& r : s.ratios) ratios += (ratios.empty() ? "" : ", ") + fmt::format("{:.3g}", r.ratio);
        const statement_text& text = s.text;
        t.rows.push_back(
            {text.id, text.source, text.link, text.quote, text.says, text.played, verdict_text(s), ratios});
    }
    return t;
}

/// One row per ratio on which the verdict on a statement depends.
table ratios_table(const std::vector<judged_statement>& judged) {
    table t = empty_table({"statement", "where", "time of a frame"}, {"scenes", "ratio", "95 %"}, {"found"});
    for (const judged_statement& s : judged)
        for (const judged_ratio& r : s.ratios)
            t.rows.push_back({s.text.id, r.where, r.candidates, grouped(r.scenes), fmt::format("{:.3g}", r.ratio),
                              fmt::format("{:.3g}-{:.3g}", r.range.low, r.range.high), text_of(r.verdict)});
    return t;
}

}  // namespace aabblab
