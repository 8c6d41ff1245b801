module aabblab.trials;

namespace aabblab {

namespace {

/// In place of what was timed, which was reading its answer.
void take_told(std::span<const told_times> told, observation& seen) {
    seen.build = {};
    seen.first = seen.rest = {};
    for (std::size_t frame = 0; frame < told.size(); ++frame) {
        phases& took = frame == 0 ? seen.first : seen.rest;
        took.update.wall_ms += told[frame].update_ms;
        took.search.wall_ms += told[frame].search_ms;
    }
}

/// Fills the processor's caches with other things.
void fill_caches() {
    constexpr std::size_t larger_than_caches = std::size_t{128} << 20U;
    constexpr std::size_t line = 64;
    static std::vector<unsigned char> other_things(larger_than_caches);
    for (std::size_t i = 0; i < other_things.size(); i += line) ++other_things[i];
}

/// Asks once where caches are cold. Otherwise several times in a row, of which it tells the mean: a query that takes a
/// microsecond would be slowed down by all that was done since the one before.
template <class Query>
elapsed mean_time(const Query& query, bool cold) {
    const int times = cold ? 1 : 16;
    if (!cold) query();
    const elapsed all = elapsed_in([&] {
        for (int i = 0; i < times; ++i) query();
    });
    return {all.wall_ms / times, all.cpu_ms / times};
}

/// Times the query, detects all contacts, and holds the answer against them.
elapsed ask(player& who, const asking& how, std::string& wrong) {
    if (how.cold) fill_caches();
    if (how.ask == question::pairs) return detect_in(who);
    std::optional<aabb::contact> first;
    std::uint64_t count = 0;
    const elapsed took = how.ask == question::first ? mean_time([&] { first = who.first_contact(); }, how.cold)
                                                    : mean_time([&] { count = who.count_contacts(); }, how.cold);
    who.detect();
    const std::vector<aabb::contact>& all = who.sorted_contacts();
    if (how.ask == question::count && count != all.size())
        wrong = "it counts " + std::to_string(count) + " contacts of " + std::to_string(all.size());
    if (how.ask == question::first && (first ? !std::ranges::binary_search(all, *first) : !all.empty()))
        wrong =
            first ? "its first contact is none" : "it finds no contact, and there are " + std::to_string(all.size());
    return took;
}

}  // namespace

observation observe(scene_play& scene, const contender& who, const protocol& how) {
    observation seen;
    std::optional<player> p;
    seen.build = elapsed_in([&] { p.emplace(who, scene, how.counted); });
    tally found(scene.meshes() != nullptr);
    const auto take = [&](const played_frame& frame) {
        found.add(frame.pairs, frame.contacts);
        (seen.frames++ == 0 ? seen.first : seen.rest) += frame.took;
        if (!how.each) return;
        seen.digest = found.digest();
        how.each(seen);
    };
    play(scene, *p, take, how.frames, [&](player& asked) { return ask(asked, how.asked, seen.wrong); });
    if (who.told) take_told(*who.told, seen);
    seen.digest = found.digest();
    seen.bytes = p->held_bytes();
    seen.work = p->counters();
    seen.left_out = p->left_out();
    return seen;
}

observation observe(const scene_choice& choice, const contender& who, const protocol& how) {
    scene_play scene(choice);
    return observe(scene, who, how);
}

}  // namespace aabblab
