module;
#include <cstdint>
#include <tuple>

/// The parameter that all builds share.
export module aabb.build.threaded;

import aabb.policy;

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

}  // namespace aabb
