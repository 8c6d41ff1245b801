module aabblab.trials;

namespace aabblab {

namespace {

/// Replaces the measured times, which are those of reading the results of the external engine.
void take_reported(std::span<const reported_times> times, observation& result) {
    result.build = {};
    result.first = result.rest = {};
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        phases& took = frame == 0 ? result.first : result.rest;
        took.update.wall_ms += times[frame].update_ms;
        took.search.wall_ms += times[frame].search_ms;
    }
}

/// Evicts everything else from the processor's caches.
void fill_caches() {
    constexpr std::size_t larger_than_caches = std::size_t{128} << 20U;
    constexpr std::size_t line = 64;
    static std::vector<unsigned char> buffer(larger_than_caches);
    for (std::size_t i = 0; i < buffer.size(); i += line) ++buffer[i];
}

/// Times a query once with cold caches. With warm caches it returns the mean of several queries in a row: the first of
/// them, which may take only a microsecond, would suffer from the work since the previous frame.
template <class Query>
elapsed mean_time(const Query& query, bool cold) {
    const int times = cold ? 1 : 16;
    if (!cold) query();
    const elapsed sum = elapsed_in([&] {
        for (int i = 0; i < times; ++i) query();
    });
    return {sum.wall_ms / times, sum.cpu_ms / times};
}

/// Times the query, detects all contacts, and compares the result of the query with them.
elapsed ask(stage_runner& p, const asking& how, std::string& wrong) {
    if (how.cold) fill_caches();
    if (how.ask == question::pairs) return detect_in(p);
    std::optional<aabb::contact> first;
    std::uint64_t count = 0;
    const elapsed took = how.ask == question::first ? mean_time([&] { first = p.first_contact(); }, how.cold)
                                                    : mean_time([&] { count = p.count_contacts(); }, how.cold);
    p.detect();
    const std::vector<aabb::contact>& contacts = p.sorted_contacts();
    if (how.ask == question::count && count != contacts.size())
        wrong = "it counts " + std::to_string(count) + " contacts, but there are " + std::to_string(contacts.size());
    if (how.ask == question::first && (first ? !std::ranges::binary_search(contacts, *first) : !contacts.empty()))
        wrong = first ? "the contact that it finds is a false positive"
                      : "it finds no contact, but there are " + std::to_string(contacts.size());
    return took;
}

}  // namespace

observation observe(scene_frames& scene, const candidate& tested, const protocol& how) {
    observation result;
    std::optional<stage_runner> p;
    result.build = elapsed_in([&] { p.emplace(tested, scene, how.counted); });
    tally totals(scene.meshes() != nullptr);
    const auto take = [&](const searched_frame& frame) {
        totals.add(frame.pairs, frame.contacts);
        (result.frames++ == 0 ? result.first : result.rest) += frame.took;
        if (!how.each) return;
        result.digest = totals.digest();
        how.each(result);
    };
    play(scene, *p, take, how.frames, [&](stage_runner& asked) { return ask(asked, how.asked, result.wrong); });
    if (tested.reported) take_reported(*tested.reported, result);
    result.digest = totals.digest();
    result.bytes = p->held_bytes();
    result.work = p->counters();
    result.left_out = p->left_out();
    return result;
}

observation observe(const scene_choice& choice, const candidate& tested, const protocol& how) {
    scene_frames scene(choice);
    return observe(scene, tested, how);
}

}  // namespace aabblab
