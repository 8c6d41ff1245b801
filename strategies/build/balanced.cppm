/// Builds for layouts that prescribe how many triangles go to each side, and multithreaded builds: their parameter, and
/// the recursive splitting of a range of triangles.
export module aabb.build.balanced;

export import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// A multithreaded build; the tree does not depend on the number of threads.
struct threaded_build {
    struct config {
        std::uint32_t threads = 1;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"threads", &config::threads, 1U, 256U, "number of threads that build a tree"}};

    threaded_build() = default;
    explicit threaded_build(const config& c) : threads(c.threads) {}

    std::uint32_t threads = 1;
};

/// The triangles per share of multithreaded work, except the last: fewer would not be worth another thread.
inline constexpr std::size_t share_size = 2048;

/// Balanced splits need no more than 14 levels for 2^31 triangles and 256 threads.
inline constexpr std::size_t most_shared_levels = 64;

/// Splits a range of triangles recursively until there are 16 parts per thread, enough to balance the load; then each
/// thread finishes one part after the other, adjacent parts first, which are in its caches. A single thread finishes
/// the whole at once. Unbalanced splits end after `most_shared_levels`, since each level of recursion costs stack.
/// @param split returns the two sides of a part; runs in several threads, like `finish`, on disjoint parts
/// @param finish builds the whole subtree of a part
template <class Part, class Split, class Finish>
void split_recursively(worker_threads& workers, const Part& whole, const Split& split, const Finish& finish) {
    constexpr std::size_t parts_per_thread = 16;
    const std::size_t size_to_finish =
        workers.count() > 1 ? std::max(share_size, whole.size() / (parts_per_thread * workers.count())) : whole.size();
    const auto split_part = [&](const auto& self, const Part& p, std::size_t levels) -> void {
        if (p.size() <= size_to_finish || levels == 0) return finish(p);
        const auto sides = split(p);
        workers.both([&] { self(self, sides[0], levels - 1); }, [&] { self(self, sides[1], levels - 1); });
    };
    split_part(split_part, whole, most_shared_levels);
}

/// The axis along which a node's triangles are split, ordered by the centres of their boxes, when their numbers are
/// prescribed: the longest axis of the node's box, or that with the least sum of area times triangles over both sides
/// (estimated from a sample if there are many).
enum class axis_rule : std::uint8_t { longest, least_area };

/// Orders the triangles by recursive splits, as `balanced_order` prescribes, whatever the number of threads.
[[nodiscard]] balanced_order order_balanced(const mesh& m, axis_rule rule, std::uint32_t threads);

}  // namespace aabb
