module aabblab.conditions;

import aabb.policy;

namespace aabblab {

namespace {

/// Everything that tells a scene from others, but its seed, and its frames, which times do not depend on.
factors factors_of(const scene_choice& scene) {
    factors all{{"scene", scene.kind}};
    for (const aabb::setting& s : scene.settings)
        if (s.name != "frames") all.emplace_back(s.name, s.value);
    std::string meshes;
    for (const std::string& mesh : scene.meshes) meshes += (meshes.empty() ? "" : "+") + mesh;
    if (!meshes.empty()) all.emplace_back("meshes", meshes);
    return all;
}

}  // namespace

std::string value_of(const factors& all, std::string_view name) {
    const auto found = std::ranges::find(all, name, &std::pair<std::string, std::string>::first);
    return found != all.end() ? found->second : "";
}

double number_of(const factors& all, std::string_view name) {
    return number_or_nan(value_of(all, name));
}

selection selection::with(aabb::strategy_kind kind, std::string choice) const {
    selection changed = *this;
    changed.wanted_[kind] = std::move(choice);
    return changed;
}

// Results of before axial_cut chose the number of axes itself, as the archived run, name none where two were cut.
static std::string as_named_now(const std::string& choice) {
    constexpr std::string_view cut = "axial_cut";
    if (!choice.starts_with(cut) || choice.find("axes=") != std::string::npos) return choice;
    const std::string others = choice.size() > cut.size() ? "," + choice.substr(cut.size() + 1) : "";
    return std::string(cut) + ":axes=2" + others;
}

bool selection::matches(const contender_name& name) const {
    return name.engine.empty() && std::ranges::all_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
               return wanted_[kind].empty() || wanted_[kind] == name[kind] || wanted_[kind] == as_named_now(name[kind]);
           });
}

std::string text_of(const selection& s) {
    std::string text;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (!s.wanted_[kind].empty())
            text += (text.empty() ? "" : " ") + std::string(name_of(kind)) + "=" + s.wanted_[kind];
    return text;
}

condition::condition(factors of, std::vector<const row*> rows) : of_(std::move(of)), rows_(std::move(rows)) {
    for (const row* r : rows_) {
        if (std::ranges::find(seeds_, r->scene.seed) == seeds_.end()) seeds_.push_back(r->scene.seed);
        // Whatever number stands there.
        if (std::ranges::find(processes_, r->process) == processes_.end()) processes_.push_back(r->process);
    }
    std::ranges::sort(seeds_);
    std::ranges::sort(processes_);
}

std::optional<double> condition::value(const selection& who, const row_value& of) const {
    const std::vector<const row*> rows = rows_of(who);
    return rows.empty() ? std::nullopt : of(*rows.front());
}

void condition::add(cells& to, const row& r, double value) const {
    const auto process = std::ranges::find(processes_, r.process) - processes_.begin();
    const auto seed = std::ranges::find(seeds_, r.scene.seed) - seeds_.begin();
    to.add(static_cast<std::size_t>(process), static_cast<std::size_t>(seed), value);
}

std::vector<const row*> condition::rows_of(const selection& who) const {
    std::vector<const row*> found;
    for (const row* r : rows_)
        if (who.matches(r->name) && r->status == "exact") found.push_back(r);
    return found;
}

cells condition::log_ratios(const selection& arm, const selection& base, const row_value& of) const {
    cells all(processes(), seeds());
    const std::vector<const row*> against = rows_of(base);
    for (const row* r : rows_of(arm)) {
        const double value = of(*r).value_or(0);
        if (!(value > 0)) continue;
        for (const row* b : against) {
            if (b->repeat != r->repeat || b->scene != r->scene) continue;
            if (const double other = of(*b).value_or(0); other > 0) add(all, *r, std::log(value / other));
        }
    }
    return all;
}

cells condition::logs(const selection& who, const row_value& of) const {
    cells all(processes(), seeds());
    for (const row* r : rows_of(who))
        if (const double value = of(*r).value_or(0); value > 0) add(all, *r, std::log(value));
    return all;
}

std::vector<double> condition::values(const row_value& of) const {
    std::vector<double> all;
    for (const row* r : rows_)
        if (const std::optional<double> value = of(*r)) all.push_back(*value);
    return all;
}

std::vector<double> condition::differences(const row_value& of) const {
    std::map<std::pair<contender_name, std::optional<std::uint64_t>>, const row*> before;
    std::vector<double> all;
    for (const row* r : rows_) {
        const row*& last = before[{r->name, r->scene.seed}];
        if (last) {
            const double a = of(*last).value_or(0), b = of(*r).value_or(0);
            if (a + b > 0) all.push_back(2 * std::abs(a - b) / (a + b));
        }
        last = r;
    }
    return all;
}

std::optional<quartiles> condition::spread(const selection& who, const row_value& of) const {
    std::vector<double> values;
    for (const row* r : rows_of(who))
        if (const std::optional<double> value = of(*r)) values.push_back(*value);
    return values.empty() ? std::nullopt : std::optional(quartiles_of(values));
}

std::optional<figure_point> condition::point(double x, const selection& who, const row_value& of) const {
    const std::optional<quartiles> q = spread(who, of);
    if (!q) return std::nullopt;
    return figure_point{x, q->median, q->low, q->high};
}

const measurements::experiment_results& measurements::read(const std::string& experiment) const {
    std::unique_ptr<experiment_results>& results = read_[experiment];
    if (results) return *results;
    results = std::make_unique<experiment_results>();
    if (!std::filesystem::exists(folder_ / experiment / "results.csv")) return *results;
    results->rows = verified_rows(folder_ / experiment);
    std::vector<std::pair<factors, std::vector<const row*>>> groups;
    for (const row& r : results->rows) {
        const factors of = factors_of(r.scene);
        auto group = std::ranges::find(groups, of, &std::pair<factors, std::vector<const row*>>::first);
        if (group == groups.end()) group = groups.insert(group, {of, {}});
        group->second.push_back(&r);
    }
    for (auto& [of, rows] : groups) results->conditions.emplace_back(of, std::move(rows));
    return *results;
}

std::vector<std::string> measurements::experiments() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (std::filesystem::exists(entry.path() / "results.csv")) all.push_back(entry.path().filename().string());
    std::ranges::sort(all);
    return all;
}

extent_of_results measurements::extent(const std::string& experiment) const {
    const std::vector<row>& rows = read(experiment).rows;
    const auto distinct = [&](auto of) {
        std::set<std::remove_cvref_t<decltype(std::invoke(of, rows.front()))>> values;
        for (const row& r : rows) values.insert(std::invoke(of, r));
        return values.size();
    };
    const auto seed = [](const row& r) { return r.scene.seed; };
    return {rows.size(),    distinct(&row::name),  distinct(&row::scene), distinct(&row::process),
            distinct(seed), distinct(&row::repeat)};
}

}  // namespace aabblab
