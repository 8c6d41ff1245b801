module aabblab.comparison;

import aabb.counters;

namespace aabblab {

namespace {

using number = std::pair<std::string, std::optional<std::uint64_t>>;

/// All that does not vary between repeats, by column.
std::vector<number> numbers_of(const row& r) {
    std::vector<number> all = {{"candidates", r.candidates}, {"contacts", r.contacts}};
    for (std::size_t i = 0; i < r.counts.size(); ++i) all.emplace_back(aabb::work_names[i], r.counts[i]);
    for (std::size_t i = 0; i < r.bytes.size(); ++i)
        all.emplace_back("bytes_" + std::string(byte_columns[i]), r.bytes[i]);
    all.emplace_back("missing", r.missing);
    all.emplace_back("invented", r.invented);
    return all;
}

std::set<std::string> exact_digests(const played_scenes::players& players) {
    std::set<std::string> digests;
    for (const auto& [name, repeats] : players)
        for (const row* r : repeats)
            if (r->status == "exact") digests.insert(r->digest);
    return digests;
}

std::string joined(const std::set<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all += (all.empty() ? "" : " ") + text;
    return all.empty() ? "-" : all;
}

}  // namespace

void compare_answers(const played_scenes& a, const played_scenes& b, comparison& found) {
    for (const auto& [scene, in_a] : a.scenes()) {
        const auto in_b = b.scenes().find(scene);
        if (in_b == b.scenes().end()) continue;
        ++found.answers_compared;
        const std::set<std::string> of_a = exact_digests(in_a);
        const std::set<std::string> of_b = exact_digests(in_b->second);
        std::set<std::string> both = of_a;
        both.insert(of_b.begin(), of_b.end());
        if (both.size() < 2) continue;
        const row& any = *in_a.begin()->second.front();
        found.answers.push_back({any.experiment, any.scene, joined(of_a), joined(of_b)});
    }
}

std::size_t compare_numbers(const shared_scene& in, const played_scenes& a, const played_scenes& b,
                            std::span<const std::string> labels, std::vector<changed_number>& changed) {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < in.names.size(); ++i) {
        struct sums {
            changed_number of;
            bool compared = false;
            bool differs = false;
        };
        std::vector<sums> columns;
        for (const played_scene& seed : in.seeds) {
            const played_scenes::repeats& of_a = a.of(seed, in.names[i]);
            const played_scenes::repeats& of_b = b.of(seed, in.names[i]);
            if (of_a.empty() || of_b.empty()) continue;
            const std::vector<number> numbers_a = numbers_of(*of_a.front());
            const std::vector<number> numbers_b = numbers_of(*of_b.front());
            columns.resize(numbers_a.size());
            for (std::size_t k = 0; k < columns.size(); ++k) {
                const std::optional<std::uint64_t>& before = numbers_a[k].second;
                const std::optional<std::uint64_t>& after = numbers_b[k].second;
                if (!before || !after) continue;
                sums& column = columns[k];
                column.of.what = numbers_a[k].first;
                column.of.in_a += *before;
                column.of.in_b += *after;
                column.compared = true;
                column.differs = column.differs || *before != *after;
            }
        }
        for (sums& column : columns) {
            compared += column.compared;
            if (!column.differs) continue;
            column.of.label = labels[i];
            changed.push_back(std::move(column.of));
        }
    }
    return compared;
}

}  // namespace aabblab
