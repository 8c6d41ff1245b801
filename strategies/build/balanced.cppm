/// Builds for layouts that prescribe how many triangles go to which side; and by several threads: their parameter, and
/// how a range of triangles is split in two, and these again.
export module aabb.build.balanced;

export import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// A build by several threads, which make the same tree as one.
struct threaded_build {
    struct config {
        std::uint32_t threads = 1;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"threads", &config::threads, 1U, 256U, "how many threads build a tree"}};

    threaded_build() = default;
    explicit threaded_build(const config& c) : threads(c.threads) {}

    std::uint32_t threads = 1;
};

/// How many triangles are worth another thread.
inline constexpr std::size_t least_shared = 2048;

/// Halves need no more than fourteen for 2^31 triangles and 256 threads.
inline constexpr std::size_t most_shared_levels = 64;

/// Splits the whole, and what comes of it, until there is enough for all threads to end at about the same time; then
/// each thread finishes one part after the other, neighbours first, which lie in its caches. With one thread the whole
/// is finished at once. Splits that take off little at a time end sooner, since each level costs stack.
/// @param split returns the two parts of one; called from several threads, like `finish`, of parts that do not overlap
/// @param finish does all that is left to do for a part
template <class Part, class Split, class Finish>
void halve(worker_threads& workers, const Part& whole, const Split& split, const Finish& finish) {
    const std::size_t enough =
        workers.count() > 1 ? std::max(least_shared, whole.size() / (std::size_t{16} * workers.count())) : whole.size();
    const auto halve_part = [&](const auto& again, const Part& p, std::size_t levels) -> void {
        if (p.size() <= enough || levels == 0) return finish(p);
        const auto halves = split(p);
        workers.both([&] { again(again, halves[0], levels - 1); }, [&] { again(again, halves[1], levels - 1); });
    };
    halve_part(halve_part, whole, most_shared_levels);
}

/// Across which axis a node's triangles are split, in the order of their boxes' centres, where their numbers are
/// prescribed: the longest of the node's box, or that with the least sum of area times triangles on both sides (of a
/// sample, where they are many).
enum class axis_rule : std::uint8_t { longest, least_area };

/// The same order whatever the number of threads.
[[nodiscard]] balanced_order order_by_halves(const mesh& m, axis_rule rule, std::uint32_t threads);

}  // namespace aabb
