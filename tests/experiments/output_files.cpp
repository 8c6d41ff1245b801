#include <fcntl.h>
#include <sys/stat.h>

#include "temporary_folder.hpp"

import aabb;
import aabblab.files;

namespace {

void put(const std::filesystem::path& file, const std::string& text) {
    aabblab::output_file out(file);
    out.write(text);
    out.commit();
}

}  // namespace

TEST_CASE("an output file appears when it is committed, and not otherwise") {
    const temporary_folder folder;
    {
        aabblab::output_file out(folder / "a");
        out.write("lost");
    }
    REQUIRE(folder.files() == 0);
    {
        aabblab::output_file out(folder / "a");
        out.write("first, ");
        out.write("last", 4);
        out.overwrite(0, "F", 1);
        out.write("!");
        REQUIRE_FALSE(std::filesystem::exists(folder / "a"));
        out.commit();
    }
    REQUIRE(bytes_of_file(folder / "a") == "First, last!");
    REQUIRE(folder.files() == 1);
}

TEST_CASE("an output file that is not committed has no name, so that an interrupted process leaves nothing") {
    const temporary_folder folder;
    const int opened = open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600);
    if (opened >= 0) close(opened);
    const bool unnamed = opened >= 0 && std::filesystem::exists("/proc/self/fd");
    for (int round = 0; round < 2; ++round) {  // the second finds the file of the first
        aabblab::output_file out(folder / "a");
        out.write(std::string(100'000, 'x'));
        // Where files without a name are not supported, or cannot be named for want of /proc, one has a name beside the
        // target.
        REQUIRE(folder.files() == static_cast<std::size_t>(round) + (unnamed ? 0 : 1));
        out.commit();
        REQUIRE(folder.files() == 1);
        REQUIRE(bytes_of_file(folder / "a") == std::string(100'000, 'x'));
    }
}

TEST_CASE("an output file may have the longest of names and the longest of paths") {
    const temporary_folder folder;
    const std::string name(255, 'n');
    put(folder / name, "");
    REQUIRE(std::filesystem::exists(folder / name));
    // With room for a name of one letter.
    std::filesystem::path deep = folder.path();
    while (deep.native().size() < 4093) {
        const std::size_t room = 4093 - deep.native().size() - 1;
        deep /= std::string(room > 250 ? 200 : room, 'd');
    }
    std::filesystem::create_directories(deep);
    put(deep / "a", "");
    REQUIRE(std::filesystem::exists(deep / "a"));
}

TEST_CASE("the permissions of an output file are those of any new file") {
    const temporary_folder folder;
    const mode_t before = umask(027);
    put(folder / "a", "");
    umask(before);
    REQUIRE(std::filesystem::status(folder / "a").permissions() == std::filesystem::perms{0640});
}

TEST_CASE("an output file in the working folder") {
    const temporary_folder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    put("a", "");
    std::filesystem::current_path(before);
    REQUIRE(std::filesystem::exists(folder / "a"));
    REQUIRE(folder.files() == 1);
}

TEST_CASE("an older file stays until the new one is complete; two writers do not meet") {
    const temporary_folder folder;
    folder.write("a", "older");
    aabblab::output_file one(folder / "a");
    aabblab::output_file two(folder / "a");
    one.write("one");
    two.write("two");
    REQUIRE(bytes_of_file(folder / "a") == "older");
    two.commit();
    REQUIRE(bytes_of_file(folder / "a") == "two");
    one.commit();
    REQUIRE(bytes_of_file(folder / "a") == "one");
}

TEST_CASE("a symbolic link is written through") {
    const temporary_folder folder;
    folder.write("a", "older");
    std::filesystem::create_symlink("a", folder / "link");
    put(folder / "link", "new");
    REQUIRE(std::filesystem::is_symlink(folder / "link"));
    REQUIRE(bytes_of_file(folder / "a") == "new");
}

TEST_CASE("what is no regular file is written, not replaced") {
    const temporary_folder folder;
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    std::string read;
    std::thread reader([&] { read = bytes_of_file(folder / "pipe"); });
    put(folder / "pipe", "through");
    reader.join();
    REQUIRE(read == "through");
    REQUIRE(std::filesystem::is_fifo(folder / "pipe"));
    REQUIRE(folder.files() == 1);
}

TEST_CASE("what cannot be written is refused") {
    using Catch::Matchers::EndsWith;
    const temporary_folder folder;
    REQUIRE_THROWS_WITH(aabblab::output_file(""), "the file to write has no name");
    REQUIRE_THROWS_WITH(aabblab::output_file(folder.path()), EndsWith(": cannot be written: it is a folder"));
    REQUIRE_THROWS_WITH(aabblab::output_file(folder / "absent" / "a"),
                        EndsWith("/absent/a: cannot be written: No such file or directory"));
    REQUIRE_THROWS_WITH(aabblab::output_file(folder / std::string(256, 'n')),
                        EndsWith("n: cannot be written: File name too long"));
    REQUIRE_THROWS_WITH(aabblab::output_file("/proc/self/a"),
                        EndsWith("/proc/self/a: cannot be written: No such file or directory"));
    std::filesystem::create_symlink("absent", folder / "link");
    REQUIRE_THROWS_WITH(aabblab::output_file(folder / "link"),
                        EndsWith("/link: cannot be written: it is a symbolic link to a file that does not exist"));
    REQUIRE(folder.files() == 1);
    const auto fill = [] { put("/dev/full", std::string(100'000, 'x')); };
    REQUIRE_THROWS_WITH(fill(), "/dev/full: cannot be written: No space left on device");
    REQUIRE_THROWS_AS(fill(), aabb::input_error);
}
