#include <archive.h>
#include <archive_entry.h>

#include <random>

#include "temporary_folder.hpp"

import aabb.base;
import aabblab.archive;

using aabblab::unpacked_archive;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::MessageMatches;

namespace {

struct entry {
    std::string name;
    std::string content{};
    unsigned type = AE_IFREG;
    std::string target{};  ///< of a link
};

/// Packs an archive that may be malicious.
std::filesystem::path packed(const temporary_folder& folder, const std::vector<entry>& entries) {
    const std::filesystem::path file = folder / "foreign.tar.xz";
    archive* out = archive_write_new();
    archive_write_add_filter_xz(out);
    archive_write_set_format_pax_restricted(out);
    REQUIRE(archive_write_open_filename(out, file.c_str()) == ARCHIVE_OK);
    for (const entry& item : entries) {
        archive_entry* e = archive_entry_new();
        archive_entry_set_pathname(e, item.name.c_str());
        archive_entry_set_filetype(e, item.type);
        archive_entry_set_perm(e, 0755);
        archive_entry_set_size(e, static_cast<la_int64_t>(item.content.size()));
        if (item.type == AE_IFLNK) archive_entry_set_symlink(e, item.target.c_str());
        if (item.type == AE_IFREG && !item.target.empty()) archive_entry_set_hardlink(e, item.target.c_str());
        REQUIRE(archive_write_header(out, e) == ARCHIVE_OK);
        archive_write_data(out, item.content.data(), item.content.size());
        archive_entry_free(e);
    }
    REQUIRE(archive_write_close(out) == ARCHIVE_OK);
    archive_write_free(out);
    return file;
}

void is_rejected(const std::filesystem::path& file, const std::string& sentence, aabblab::archive_limits limits = {}) {
    CHECK_THROWS_MATCHES(unpacked_archive(file, "results", limits), aabb::input_error,
                         MessageMatches(ContainsSubstring(sentence)));
}

/// Incompressible bytes.
std::string noise(std::size_t bytes) {
    std::mt19937 random(1);
    std::string text;
    for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(random());
    return text;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "Packing and unpacking round-trips, and packing is deterministic") {
    (void)folder.write("a/one.csv", "1,2\r\n");
    (void)folder.write("a/sub/two.json", noise(200'000));
    (void)folder.write("a/left.log", "not asked for");
    const std::vector<std::filesystem::path> files{"one.csv", "sub/two.json"};
    aabblab::write_archive(folder / "first.tar.xz", "results", folder / "a", files);
    std::filesystem::last_write_time(folder / "a/one.csv", std::filesystem::file_time_type{});
    std::filesystem::permissions(folder / "a/one.csv", std::filesystem::perms::owner_all);
    aabblab::write_archive(folder / "second.tar.xz", "results", folder / "a", files);
    CHECK(bytes_of_file(folder / "first.tar.xz") == bytes_of_file(folder / "second.tar.xz"));
    std::filesystem::path extracted;
    {
        const unpacked_archive unpacked(folder / "first.tar.xz", "results");
        extracted = unpacked.folder();
        for (const std::filesystem::path& file : files)
            CHECK(bytes_of_file(extracted / file) == bytes_of_file(folder / "a" / file));
        CHECK(!std::filesystem::exists(extracted / "left.log"));
    }
    CHECK(!std::filesystem::exists(extracted));
}

TEST_CASE_METHOD(in_folder, "Archives with paths outside their folder, links or pipes are rejected") {
    for (const char* name :
         {"/etc/passwd", "results/../../out", "../results/x", "other/x", "x", "results/./x", "results/../results/x"}) {
        CAPTURE(name);
        is_rejected(packed(folder, {{name, "content"}}), "is not an archive of results: it has the entry '");
    }
    is_rejected(packed(folder, {{"results/link", "", AE_IFLNK, "/etc"}, {"results/link/passwd", "content"}}),
                "has an entry that is neither a file nor a folder: 'link'");
    is_rejected(packed(folder, {{"results/a", "content"}, {"results/b", "", AE_IFREG, "results/a"}}),
                "has an entry that is neither a file nor a folder: 'b'");
    is_rejected(packed(folder, {{"results/pipe", "", AE_IFIFO}}), "neither a file nor a folder: 'pipe'");
    is_rejected(packed(folder, {{"results/a", "1"}, {"results/a", "2"}}), "has the file 'a' twice");
    is_rejected(packed(folder, {{"results/a", "1"}, {"results/a/b", "2"}}), "cannot be unpacked");
    is_rejected(packed(folder, {{"results/", "", AE_IFDIR}}), "is empty");
    // Other programs also pack entries for folders.
    const unpacked_archive valid(
        packed(folder, {{"results/", "", AE_IFDIR}, {"results/a/", "", AE_IFDIR}, {"results/a/b", "content"}}),
        "results");
    CHECK(bytes_of_file(valid.folder() / "a/b") == "content");
}

TEST_CASE_METHOD(in_folder, "Archives beyond the limits on bytes, files or folders are rejected") {
    const aabblab::archive_limits limits{.files = 3, .bytes = std::uint64_t{1} << 20U};
    const auto bomb = packed(folder, {{"results/a", std::string(std::size_t{64} << 20U, '0')}});
    REQUIRE(std::filesystem::file_size(bomb) < 100'000);
    is_rejected(bomb, "unpacks to more than 1 MiB, the limit for results", limits);
    is_rejected(packed(folder, {{"results/a"}, {"results/b"}, {"results/c"}, {"results/d"}}),
                "has more than 3 files, the limit for results", limits);
    // A folder counts each time that it is listed: an archive may list it 40 million times.
    const entry one_folder{"results/a/", "", AE_IFDIR};
    is_rejected(packed(folder, {one_folder, one_folder, one_folder, one_folder}),
                "has more than 3 folders, the limit for results", limits);
}

TEST_CASE_METHOD(in_folder, "Truncated, damaged and foreign archives are rejected") {
    const std::string whole = bytes_of_file(packed(folder, {{"results/a", noise(300'000)}, {"results/b", "content"}}));
    for (const double share : {0.3, 0.9, 0.999}) {
        CAPTURE(share);
        const auto bytes = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
        is_rejected(folder.write("cut.tar.xz", whole.substr(0, bytes)), "cut.tar.xz is damaged or cut off: ");
    }
    std::string damaged = whole;
    damaged[whole.size() / 2] = static_cast<char>(~damaged[whole.size() / 2]);
    is_rejected(folder.write("damaged.tar.xz", damaged), "damaged.tar.xz is damaged or cut off: ");
    for (const std::string& foreign : {std::string(), std::string("PK\3\4 a zip"), noise(1000), whole.substr(0, 10)})
        is_rejected(folder.write("foreign", foreign), "is not an archive of results, which is tar compressed by xz");
    is_rejected(folder / "none", "none cannot be read");
}
