module aabblab.conditions;

import aabb.policy;

namespace aabblab {

namespace {

/// The names and values that identify the condition of a measurement: kind of scene, parameters and meshes, but not the
/// number of frames, since times are per frame.
factors factors_of(const scene_choice& scene) {
    factors scene_factors{{"scene", scene.kind}};
    for (const aabb::setting& s : scene.settings)
        if (s.name != "frames") scene_factors.emplace_back(s.name, s.value);
    std::string meshes;
    for (const std::string& mesh : scene.meshes) meshes += (meshes.empty() ? "" : "+") + mesh;
    if (!meshes.empty()) scene_factors.emplace_back("meshes", meshes);
    return scene_factors;
}

std::vector<double> values_in(std::span<const row* const> rows, const row_value& quantity) {
    std::vector<double> values;
    for (const row* r : rows)
        if (const std::optional<double> value = quantity(*r)) values.push_back(*value);
    return values;
}

}  // namespace

std::string value_of(const factors& scene, std::string_view name) {
    const auto factor = std::ranges::find(scene, name, &std::pair<std::string, std::string>::first);
    return factor != scene.end() ? factor->second : "";
}

double number_of(const factors& scene, std::string_view name) {
    return number_or_nan(value_of(scene, name));
}

selection selection::with(aabb::strategy_kind kind, std::string choice) const {
    selection changed = *this;
    changed.wanted_[kind] = std::move(choice);
    return changed;
}

/// Older results, such as the archived run, omit `axes` where two were cut, which was the default at the time.
static std::string with_default_axes(const std::string& choice) {
    constexpr std::string_view cut = "axial_cut";
    if (!choice.starts_with(cut) || choice.find("axes=") != std::string::npos) return choice;
    const std::string others = choice.size() > cut.size() ? "," + choice.substr(cut.size() + 1) : "";
    return std::string(cut) + ":axes=2" + others;
}

bool selection::matches(const candidate_name& name) const {
    return name.engine.empty() && std::ranges::all_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
               return wanted_[kind].empty() || wanted_[kind] == name[kind] ||
                      wanted_[kind] == with_default_axes(name[kind]);
           });
}

std::string text_of(const selection& s) {
    std::string text;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (!s.wanted_[kind].empty())
            text += (text.empty() ? "" : " ") + std::string(name_of(kind)) + "=" + s.wanted_[kind];
    return text;
}

/// Rows of one scene. Lists the seeds and processes that occur, in order: statistics have a cell for each combination.
condition::condition(factors scene, std::vector<const row*> rows) : factors_(std::move(scene)), rows_(std::move(rows)) {
    for (const row* r : rows_) {
        if (std::ranges::find(seeds_, r->scene.seed) == seeds_.end()) seeds_.push_back(r->scene.seed);
        if (std::ranges::find(processes_, r->process) == processes_.end()) processes_.push_back(r->process);
    }
    std::ranges::sort(seeds_);
    std::ranges::sort(processes_);
}

std::optional<double> condition::value(const selection& composition, const row_value& quantity) const {
    const std::vector<const row*> rows = rows_of(composition);
    return rows.empty() ? std::nullopt : quantity(*rows.front());
}

void condition::add(cells& to, const row& r, double value) const {
    const auto process = std::ranges::find(processes_, r.process) - processes_.begin();
    const auto seed = std::ranges::find(seeds_, r.scene.seed) - seeds_.begin();
    to.add(static_cast<std::size_t>(process), static_cast<std::size_t>(seed), value);
}

std::vector<const row*> condition::rows_of(const selection& composition) const {
    std::vector<const row*> rows;
    for (const row* r : rows_)
        if (composition.matches(r->name) && r->status == "exact") rows.push_back(r);
    return rows;
}

/// Logarithms of the ratio of two compositions, paired by repeat and seed; values not above 0 have none.
cells condition::log_ratios(const selection& composition, const selection& baseline, const row_value& quantity) const {
    cells ratios(processes(), seeds());
    const std::vector<const row*> base_rows = rows_of(baseline);
    for (const row* r : rows_of(composition)) {
        const double value = quantity(*r).value_or(0);
        if (!(value > 0)) continue;
        for (const row* b : base_rows) {
            if (b->repeat != r->repeat || b->scene != r->scene) continue;
            if (const double other = quantity(*b).value_or(0); other > 0) add(ratios, *r, std::log(value / other));
        }
    }
    return ratios;
}

cells condition::logs(const selection& composition, const row_value& quantity) const {
    cells logarithms(processes(), seeds());
    for (const row* r : rows_of(composition))
        if (const double value = quantity(*r).value_or(0); value > 0) add(logarithms, *r, std::log(value));
    return logarithms;
}

std::vector<double> condition::values(const row_value& quantity) const {
    return values_in(rows_, quantity);
}

/// The noise of a measurement: relative differences of each row to the preceding repeat of its composition and seed.
std::vector<double> condition::differences(const row_value& quantity) const {
    std::map<std::pair<candidate_name, std::optional<std::uint64_t>>, const row*> preceding;
    std::vector<double> shares;
    for (const row* r : rows_) {
        const row*& last = preceding[{r->name, r->scene.seed}];
        if (last) {
            const double a = quantity(*last).value_or(0), b = quantity(*r).value_or(0);
            if (a + b > 0) shares.push_back(2 * std::abs(a - b) / (a + b));
        }
        last = r;
    }
    return shares;
}

std::optional<quartiles> condition::spread(const selection& composition, const row_value& quantity) const {
    const std::vector<double> values = values_in(rows_of(composition), quantity);
    return values.empty() ? std::nullopt : std::optional(quartiles_of(values));
}

std::optional<figure_point> condition::point(double x, const selection& composition, const row_value& quantity) const {
    const std::optional<quartiles> q = spread(composition, quantity);
    if (!q) return std::nullopt;
    return figure_point{x, q->median, q->low, q->high};
}

/// Reads an experiment on first use, by condition: a scene with all its seeds. Empty if it has no results.
const measurements::experiment_results& measurements::read(const std::string& experiment) const {
    std::unique_ptr<experiment_results>& results = read_[experiment];
    if (results) return *results;
    results = std::make_unique<experiment_results>();
    if (!std::filesystem::exists(folder_ / experiment / "results.csv")) return *results;
    results->rows = verified_rows(folder_ / experiment);
    std::vector<std::pair<factors, std::vector<const row*>>> groups;
    for (const row& r : results->rows) {
        const factors scene = factors_of(r.scene);
        auto group = std::ranges::find(groups, scene, &std::pair<factors, std::vector<const row*>>::first);
        if (group == groups.end()) group = groups.insert(group, {scene, {}});
        group->second.push_back(&r);
    }
    for (auto& [scene, rows] : groups) results->conditions.emplace_back(scene, std::move(rows));
    return *results;
}

std::vector<std::string> measurements::experiments() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (std::filesystem::exists(entry.path() / "results.csv")) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

/// The number of rows of an experiment, and of different compositions, scenes, processes, seeds and repeats in them.
extent_of_results measurements::extent(const std::string& experiment) const {
    const std::vector<row>& rows = read(experiment).rows;
    const auto distinct = [&](auto value) {
        std::set<std::remove_cvref_t<decltype(std::invoke(value, rows.front()))>> values;
        for (const row& r : rows) values.insert(std::invoke(value, r));
        return values.size();
    };
    const auto seed = [](const row& r) { return r.scene.seed; };
    return {rows.size(),    distinct(&row::name),  distinct(&row::scene), distinct(&row::process),
            distinct(seed), distinct(&row::repeat)};
}

}  // namespace aabblab
