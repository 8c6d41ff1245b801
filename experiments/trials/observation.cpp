module aabblab.trials;

namespace aabblab {

namespace {

/// Replaces the measured times by those that an external engine reports: while measuring, only its output was read.
/// @param times by frame; frame 0 is kept separate from the rest
void use_reported_times(std::span<const reported_times> times, observation& result) {
    result.build = {};
    result.first = result.rest = {};
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        phases& sum = frame == 0 ? result.first : result.rest;
        sum.update.wall_ms += times[frame].update_ms;
        sum.search.wall_ms += times[frame].search_ms;
    }
}

/// Evicts the data of the stages from the processor's caches by writing to every line of a larger buffer.
void evict_caches() {
    constexpr std::size_t line = 64;
    static std::vector<unsigned char> buffer(std::size_t{128} << 20U);
    for (std::size_t i = 0; i < buffer.size(); i += line) ++buffer[i];
}

/// Times a query: cold once; warm, after an untimed one, as the mean of several, as one may take only a microsecond.
template <class Query>
elapsed mean_time(const Query& query, bool cold) {
    const int repeats = cold ? 1 : 16;
    if (!cold) query();
    stopwatch watch;
    for (int i = 0; i < repeats; ++i) query();
    const elapsed sum = watch.lap();
    return {sum.wall_ms / repeats, sum.cpu_ms / repeats};
}

/// Times the query for all pairs of triangles, the first contact or their number; then compares with all contacts.
/// @param wrong receives a sentence if they contradict each other
elapsed time_query(stage_runner& runner, const query_settings& query, std::string& wrong) {
    if (query.cold) evict_caches();
    if (query.kind == query_kind::pairs) return time_detection(runner);
    std::optional<aabb::contact> first;
    std::uint64_t count = 0;
    const elapsed took = query.kind == query_kind::first
                             ? mean_time([&] { first = runner.first_contact(); }, query.cold)
                             : mean_time([&] { count = runner.count_contacts(); }, query.cold);
    runner.detect();
    const std::vector<aabb::contact>& contacts = runner.sorted_contacts();
    if (query.kind == query_kind::count && count != contacts.size())
        wrong = "it counts " + std::to_string(count) + " contacts, but there are " + std::to_string(contacts.size());
    if (query.kind == query_kind::first && (first ? !std::ranges::binary_search(contacts, *first) : !contacts.empty()))
        wrong = first ? "the contact that it finds is a false positive"
                      : "it finds no contact, but there are " + std::to_string(contacts.size());
    return took;
}

}  // namespace

/// Runs a scene on fresh stages and sums their times: constructing them, frame 0, and all later frames.
/// @param settings what to run and record, and a function to call after each frame
observation observe(scene_frames& scene, const candidate& tested, const protocol& settings) {
    observation result;
    if (settings.query.says_moved) scene.compare_boxes();
    std::optional<stage_runner> runner;
    stopwatch building;
    runner.emplace(tested, scene, settings.counted);  // creates the stages, and builds their trees
    result.build = building.lap();
    tally totals(scene.meshes() != nullptr);
    const auto add_frame = [&](const searched_frame& frame) {
        totals.add(frame.pairs, frame.contacts);
        (result.frames++ == 0 ? result.first : result.rest) += frame.took;
        if (!settings.on_frame) return;
        result.digest = totals.digest();
        settings.on_frame(result);
    };
    const auto detect = [&](stage_runner& r) { return time_query(r, settings.query, result.wrong); };
    run_frames(scene, *runner, add_frame, settings.frames, detect);
    if (tested.reported) use_reported_times(tested.reported->times, result);
    result.digest = totals.digest();
    result.bytes = runner->held_bytes();
    result.work = runner->counters();
    result.left_out = runner->left_out();
    return result;
}

observation observe(const scene_choice& choice, const candidate& tested, const protocol& settings) {
    scene_frames scene(choice);
    return observe(scene, tested, settings);
}

}  // namespace aabblab
