module aabblab.race;

namespace aabblab {

namespace {

/// The logarithms of one's time over the other's in the same repeat, which the machine's slow and fast moments leave
/// alone.
cells log_ratios(const racer& one, const racer& other) {
    cells ratios(1, 1);
    for (std::size_t i = 0; i < one.times.size(); ++i)
        ratios.add(0, 0, std::log(one.times[i].whole_ms() / other.times[i].whole_ms()));
    return ratios;
}

double median_of(const cells& repeats) {
    return resample(1, 1, level::none, 0).mean_of(repeats);
}

/// How far the nearest of the others is behind; below 0 where one is ahead.
double lead_of(const racer& one, const std::vector<racer>& all) {
    double least = std::numeric_limits<double>::infinity();
    for (const racer& other : all)
        if (&other != &one) least = std::min(least, median_of(log_ratios(other, one)));
    return least;
}

observation median_of(std::vector<observation> times) {
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::ranges::nth_element(times, middle, {}, &observation::whole_ms);
    return *middle;
}

}  // namespace

void rank(std::vector<racer>& finalists) {
    if (finalists.empty()) return;
    const auto first =
        std::ranges::max_element(finalists, {}, [&](const racer& one) { return lead_of(one, finalists); });
    std::rotate(finalists.begin(), first, first + 1);
    for (racer& one : finalists) {
        one.last = median_of(one.times);
        one.log_ratio = bootstrap(log_ratios(one, finalists.front()));
        // Three may be ahead of each other in a circle: none is then.
        one.log_ratio->value = std::max(one.log_ratio->value, 0.0);
    }
    std::stable_sort(finalists.begin() + 1, finalists.end(),
                     [](const racer& a, const racer& b) { return a.log_ratio->value < b.log_ratio->value; });
}

}  // namespace aabblab
