module aabblab.comparison;

import aabb.base;

namespace aabblab {

namespace {

/// Lines of all scenes that are decided together.
class family {
public:
    explicit family(std::vector<compared_time> compared_scene::* to) : to_(to) {}

    void add(std::size_t scene, std::string label, two_sides line) {
        if (line.a.empty() || line.b.empty()) return;
        places_.emplace_back(scene, std::move(label));
        lines_.push_back(std::move(line));
    }

    void decide(std::vector<compared_scene>& scenes) const {
        std::vector<compared_time> times = judged(lines_);
        for (std::size_t i = 0; i < times.size(); ++i) {
            times[i].label = places_[i].second;
            (scenes[places_[i].first].*to_).push_back(std::move(times[i]));
        }
    }

private:
    std::vector<compared_time> compared_scene::* to_;
    std::vector<std::pair<std::size_t, std::string>> places_;
    std::vector<two_sides> lines_;
};

std::size_t count_missing(const played_scenes& from, const played_scenes& in) {
    std::size_t count = 0;
    for (const auto& [scene, players] : from.scenes())
        for (const auto& [name, repeats] : players) count += in.of(scene, name).empty();
    return count;
}

}  // namespace

comparison compare(const run_results& a, const run_results& b, compared what) {
    const played_scenes of_a(a.rows);
    const played_scenes of_b(b.rows);
    comparison found;
    compare_answers(of_a, of_b, found);
    if (found.answers_compared == 0)
        throw aabb::input_error(a.folder.string() + " and " + b.folder.string() +
                                " have no scene in common: none of the same experiment, kind, parameters and seed");
    found.only_in_a = count_missing(of_a, of_b);
    found.only_in_b = count_missing(of_b, of_a);
    family ratios(&compared_scene::ratios);
    family times(&compared_scene::times);
    for (const shared_scene& shared : scenes_shared(a.rows, of_b)) {
        const std::size_t place = found.scenes.size();
        const std::vector<std::string> labels = labels_of(shared.names);
        compared_scene& scene = found.scenes.emplace_back();
        scene.experiment = shared.any->experiment;
        scene.scene = whatever_seed(shared.any->scene);
        found.numbers_compared += compare_numbers(shared, of_a, of_b, labels, scene.changed);
        const std::optional<contender_name> base = base_of(shared, of_a, of_b);
        if (!base) continue;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const contender_name& who = shared.names[i];
            const auto both = [&](const contender_name* to) {
                return two_sides{log_times(of_a, shared, who, to), log_times(of_b, shared, who, to)};
            };
            if (what == compared::ratios_and_times) times.add(place, labels[i], both(nullptr));
            if (who == *base)
                scene.base = labels[i];
            else
                ratios.add(place, labels[i], both(&*base));
        }
    }
    ratios.decide(found.scenes);
    times.decide(found.scenes);
    return found;
}

}  // namespace aabblab
