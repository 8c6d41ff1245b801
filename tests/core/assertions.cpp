#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch_test_macros.hpp>
#include <csignal>
#include <cstdio>

import aabb.std;
import aabb;

TEST_CASE("a violated precondition aborts the program, unless assertions are disabled") {
    constexpr std::array descending{aabb::index_pair{2, 3}, aabb::index_pair{0, 1}};
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::signal(SIGABRT, SIG_DFL);
        std::fclose(stderr);
        aabb::digest digest;
        digest.add(0, descending);
        _exit(0);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
#ifdef NDEBUG
    CHECK(status == 0);
#else
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGABRT);
#endif
}
