module aabblab.comparison;

import aabblab.tables;

namespace aabblab {

namespace {

template <class T>
void add_once(std::vector<T>& to, const T& value) {
    if (std::ranges::find(to, value) == to.end()) to.push_back(value);
}

}  // namespace

played_scenes::played_scenes(std::span<const row> rows) {
    for (const row& r : rows) scenes_[{r.experiment, r.scene}][r.name].push_back(&r);
}

const played_scenes::repeats& played_scenes::of(const played_scene& scene, const contender_name& name) const {
    static const repeats none;
    const auto players = scenes_.find(scene);
    if (players == scenes_.end()) return none;
    const auto found = players->second.find(name);
    return found != players->second.end() ? found->second : none;
}

std::vector<shared_scene> scenes_shared(std::span<const row> a, const played_scenes& b) {
    std::vector<shared_scene> scenes;
    std::map<played_scene, std::size_t> places;  // whatever the seed
    for (const row& r : a) {
        const played_scene seed{r.experiment, r.scene};
        if (b.of(seed, r.name).empty()) continue;
        const auto [place, is_new] = places.emplace(played_scene{r.experiment, whatever_seed(r.scene)}, scenes.size());
        if (is_new) scenes.push_back({&r, {}, {}});
        add_once(scenes[place->second].seeds, seed);
        add_once(scenes[place->second].names, r.name);
    }
    return scenes;
}

std::vector<std::string> labels_of(std::span<const contender_name> names) {
    std::vector<row> rows;
    for (const contender_name& name : names) {
        row& r = rows.emplace_back();
        r.name = name;
        r.status = "exact";
    }
    const scene_summary scene = summarise(rows).at(0);
    if (names.size() == 1 && !scene.common.empty()) return {scene.common};
    std::vector<std::string> labels;
    for (const summary_line& line : scene.lines) labels.push_back(line.label);
    return labels;
}

}  // namespace aabblab
