#include <fcntl.h>
#include <sys/stat.h>

#include "temporary_folder.hpp"

import aabb;
import aabblab.files;

namespace {

void write_output(const std::filesystem::path& file, const std::string& text) {
    aabblab::output_file out(file);
    out.write(text);
    out.commit();
}

}  // namespace

TEST_CASE_METHOD(in_folder, "an output file appears only when it is committed") {
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

TEST_CASE_METHOD(in_folder, "an uncommitted output file is unnamed, so that an interrupted process leaves no file") {
    const int descriptor = open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600);
    if (descriptor >= 0) close(descriptor);
    const bool has_unnamed_files = descriptor >= 0 && std::filesystem::exists("/proc/self/fd");
    for (int round = 0; round < 2; ++round) {  // the second replaces the file of the first
        aabblab::output_file out(folder / "a");
        out.write(std::string(100'000, 'x'));
        // If the system has no unnamed files, or no /proc to name them, a temporary file is created beside the target.
        REQUIRE(folder.files() == static_cast<std::size_t>(round) + (has_unnamed_files ? 0 : 1));
        out.commit();
        REQUIRE(folder.files() == 1);
        REQUIRE(bytes_of_file(folder / "a") == std::string(100'000, 'x'));
    }
}

TEST_CASE_METHOD(in_folder, "an output file may have a name or path of the maximum length") {
    const std::string name(255, 'n');
    write_output(folder / name, "");
    REQUIRE(std::filesystem::exists(folder / name));
    // The path leaves room for a name of one letter.
    std::filesystem::path deep = folder.path();
    while (deep.native().size() < 4093) {
        const std::size_t room = 4093 - deep.native().size() - 1;
        deep /= std::string(room > 250 ? 200 : room, 'd');
    }
    std::filesystem::create_directories(deep);
    write_output(deep / "a", "");
    REQUIRE(std::filesystem::exists(deep / "a"));
}

TEST_CASE_METHOD(in_folder, "an output file has the permissions that umask allows") {
    const mode_t before = umask(027);
    write_output(folder / "a", "");
    umask(before);
    REQUIRE(std::filesystem::status(folder / "a").permissions() == std::filesystem::perms{0640});
}

TEST_CASE_METHOD(in_folder, "an output file without a folder is written to the working directory") {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    write_output("a", "");
    std::filesystem::current_path(before);
    REQUIRE(std::filesystem::exists(folder / "a"));
    REQUIRE(folder.files() == 1);
}

TEST_CASE_METHOD(in_folder, "an existing file is replaced only on commit, and concurrent writers do not interfere") {
    folder.write("a", "older");
    aabblab::output_file first(folder / "a");
    aabblab::output_file second(folder / "a");
    first.write("one");
    second.write("two");
    REQUIRE(bytes_of_file(folder / "a") == "older");
    second.commit();
    REQUIRE(bytes_of_file(folder / "a") == "two");
    first.commit();
    REQUIRE(bytes_of_file(folder / "a") == "one");
}

TEST_CASE_METHOD(in_folder, "writing to a symbolic link replaces its target") {
    folder.write("a", "older");
    std::filesystem::create_symlink("a", folder / "link");
    write_output(folder / "link", "new");
    REQUIRE(std::filesystem::is_symlink(folder / "link"));
    REQUIRE(bytes_of_file(folder / "a") == "new");
}

TEST_CASE_METHOD(in_folder, "a file that is not regular is written to, not replaced") {
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    std::string read;
    std::thread reader([&] { read = bytes_of_file(folder / "pipe"); });
    write_output(folder / "pipe", "through");
    reader.join();
    REQUIRE(read == "through");
    REQUIRE(std::filesystem::is_fifo(folder / "pipe"));
    REQUIRE(folder.files() == 1);
}

TEST_CASE_METHOD(in_folder, "targets that cannot be written are rejected") {
    using Catch::Matchers::EndsWith;
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
    const auto fill = [] { write_output("/dev/full", std::string(100'000, 'x')); };
    REQUIRE_THROWS_WITH(fill(), "/dev/full: cannot be written: No space left on device");
    REQUIRE_THROWS_AS(fill(), aabb::input_error);
}
