#include <random>

#include "interrupted.hpp"

import aabb.registry;
import aabblab.comparison;
import aabblab.results;
import aabblab.sha256;

using aabblab::row;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::MessageMatches;

namespace {

const char* const config =
    "name = \"sealed\"\nseed = [1, 2]\n[[scene]]\nkind = \"brownian\"\nobjects = 60\nframes = 2\n"
    "[compose]\nsort = [\"std\", \"insertion\"]\n[measure]\nrepeats = 3\nprocesses = 3\n";

/// A finished run.
struct finished_run : in_folder {
    finished_run() { run_well({"run", folder.write("sealed.toml", config), "--out", out()}); }

    /// The command that resumes it.
    [[nodiscard]] std::vector<std::string> resume_command() const {
        return {"run", folder / "sealed.toml", "--out", out(), "--resume"};
    }
    [[nodiscard]] std::filesystem::path out() const { return folder / "out"; }
    [[nodiscard]] std::string read_table() const { return bytes_of_file(out() / "results.csv"); }
    void write_table(const std::string& text) const { std::ofstream(out() / "results.csv", std::ios::binary) << text; }
    [[nodiscard]] nlohmann::ordered_json read_manifest() const {
        return nlohmann::ordered_json::parse(bytes_of_file(out() / "manifest.json"));
    }
    void write_manifest(const nlohmann::ordered_json& manifest) const {
        std::ofstream(out() / "manifest.json") << manifest.dump(2);
    }
    void check_rejected_rows(const std::string& text) const {
        CHECK_THROWS_MATCHES(aabblab::verified_rows(out()), aabb::input_error, MessageMatches(ContainsSubstring(text)));
    }
};

std::vector<std::string> keys_of(const std::vector<row>& rows) {
    std::vector<std::string> keys;
    for (const row& r : rows) keys.push_back(r.key());
    return keys;
}

std::string joined_lines(const std::vector<std::string>& lines, const char* end) {
    std::string text;
    for (const std::string& line : lines) text += line + end;
    return text;
}

std::string shuffled(const std::string& table) {
    std::vector<std::string> lines = lines_of(table);
    std::shuffle(lines.begin() + 1, lines.end(), std::mt19937(7));
    return joined_lines(lines, "\n");
}

/// Replaces the first `from` in a line, counted from 1.
std::string with_field(const std::string& table, std::size_t line, const std::string& from, const std::string& to) {
    std::vector<std::string> lines = lines_of(table);
    lines.at(line - 1) = replaced(lines.at(line - 1), from, to);
    return joined_lines(lines, "\n");
}

std::string without_line(const std::string& table, std::size_t line) {
    return replaced(table, lines_of(table).at(line - 1) + "\n", "");
}

}  // namespace

TEST_CASE("SHA-256 gives the digests of the FIPS 180-4 examples") {
    CHECK(aabblab::sha256_of("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(aabblab::sha256_of("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE_METHOD(finished_run,
                 "Rows of a finished run are read in run order, for any order and line endings in the file") {
    const std::vector<row> rows = aabblab::verified_rows(out());
    REQUIRE(rows.size() == 12);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CHECK(rows[i].scene.seed == i / 6 + 1);
        CHECK(rows[i].repeat == i / 2 % 3);
        CHECK(rows[i].name[aabb::strategy_kind::sort] == (i % 2 == 0 ? "std" : "insertion"));
    }
    const std::string table = read_table();
    const std::string mixed = shuffled(table);
    REQUIRE(mixed != table);
    write_table(mixed);
    CHECK(keys_of(aabblab::verified_rows(out())) == keys_of(rows));
    write_table(joined_lines(lines_of(mixed), "\r\n"));
    CHECK(keys_of(aabblab::verified_rows(out())) == keys_of(rows));
    // The checksum is that of the sorted lines, as sort and sha256sum compute it.
    const auto sealed = read_manifest()["seal"]["results.csv"];
    std::vector<std::string> lines = lines_of(table);
    std::ranges::sort(lines);
    CHECK(sealed["rows"] == 12);
    CHECK(sealed["sha256"] == aabblab::sha256_of(joined_lines(lines, "\n")));
}

TEST_CASE_METHOD(finished_run, "Altered, removed or added rows are rejected, with their line if it is known") {
    const std::string table = read_table();
    const row first = aabblab::read_rows(out() / "results.csv").front();
    const auto rejected = [&](const std::string& text, const std::string& sentence) {
        write_table(text);
        check_rejected_rows(sentence);
        write_table(table);
    };
    const std::string altered = "out/results.csv was altered after the run: its rows do not have the checksum";
    rejected(with_field(table, 3, ",exact", ",inexact"), altered);
    rejected(with_field(table, 3, first.digest, "0000000000000000"),
             "out/results.csv:3: the row is exact, but its digest is '0000000000000000'; that of the scene is " +
                 first.digest);
    rejected(with_field(table, 3, "\"\"objects\"\":60", "\"\"objects\"\":61"),
             "out/results.csv:3: manifest.json has no scene brownian with these parameters");
    rejected(with_field(table, 3, "sealed", "other"),
             "out/results.csv:3: the row is of the experiment 'other', and manifest.json of 'sealed'");
    rejected(without_line(table, 4), "out/results.csv has 11 rows; when the run was finished it had 12");
    rejected(table.substr(0, table.size() - 1), "out/results.csv has 11 rows; when the run was finished it had 12");
    CHECK(aabblab::verified_rows(out()).size() == 12);
}

TEST_CASE_METHOD(finished_run, "An altered manifest is rejected") {
    const nlohmann::ordered_json manifest = read_manifest();
    const auto rejected = [&](const std::function<void(nlohmann::ordered_json&)>& alter, const std::string& sentence) {
        nlohmann::ordered_json altered = manifest;
        alter(altered);
        write_manifest(altered);
        check_rejected_rows(sentence);
    };
    const std::string sentence =
        "manifest.json was altered after the run: it does not have the checksum that it states";
    rejected([](auto& m) { m["build"]["cpu"] = "a faster one"; }, sentence);
    rejected([](auto& m) { m["scenes"][0]["digest"] = "0000000000000000"; }, sentence);
    rejected([](auto& m) { m["config"]["text"] = "name = \"sealed\"\n"; }, sentence);
    rejected([](auto& m) { m["seal"]["results.csv"]["rows"] = 11; }, sentence);
    rejected([](auto& m) { m["seal"] = "none"; }, "manifest.json: seal must be an object");
    rejected([](auto& m) { m["seal"]["contenders"][0] = 1; }, "manifest.json: seal.contenders[0] must be an object");
    rejected([](auto& m) { m["seal"]["results.csv"]["rows"] = -1; },
             "manifest.json: seal.results.csv.rows must be a whole number");
    rejected([](auto& m) { m["scenes"][0]["parameters"]["objects"] = true; },
             "manifest.json: scenes[0] must have parameters, an object of settings");
}

TEST_CASE_METHOD(finished_run, "A manifest with a mistyped or missing member is read or rejected, sealed or not") {
    std::size_t rejections = 0;
    for (const bool is_sealed : {true, false}) {
        if (!is_sealed) unseal(out());
        const nlohmann::ordered_json complete = read_manifest();
        std::set<std::string> places;
        const nlohmann::ordered_json leaves = complete.flatten();
        for (const auto& [leaf, value] : leaves.items())
            for (nlohmann::json::json_pointer place(leaf); !place.empty(); place.pop_back())
                places.insert(place.to_string());
        for (const std::string& place : places)
            for (const char* other : {"null", "1", "-1.5", "true", "\"x\"", "[1]", "{\"x\":[]}", "without"}) {
                const nlohmann::ordered_json::json_pointer at(place);
                nlohmann::ordered_json altered = complete;
                if (std::string_view(other) == "without") {
                    nlohmann::ordered_json& parent = altered[at.parent_pointer()];
                    if (parent.is_array()) continue;
                    parent.erase(at.back());
                } else {
                    altered[at] = nlohmann::ordered_json::parse(other);
                }
                write_manifest(altered);
                CAPTURE(is_sealed, place, other);
                try {
                    (void)aabblab::read_manifest(out());
                    (void)aabblab::verified_rows(out());
                } catch (const aabb::input_error& rejected) {
                    ++rejections;
                    CHECK_THAT(rejected.what(), ContainsSubstring("/out/"));
                } catch (const std::exception& error) {
                    FAIL_CHECK(error.what());
                }
            }
    }
    CHECK(rejections > 100);
}

TEST_CASE_METHOD(finished_run, "A row with an implausible number is rejected or compared with finite changes") {
    const std::filesystem::path second = out().parent_path() / "second";
    std::filesystem::copy(out(), second);
    unseal(out());
    const std::vector<std::string> lines = lines_of(read_table());
    const auto columns = static_cast<std::size_t>(std::ranges::count(lines[0], ',')) + 1;
    std::size_t rejections = 0;
    for (const std::string number : {"", "-1", "nan", "inf", "1e300", "18446744073709551615", "1e999", "0", "x"})
        for (std::size_t column = 0; column < columns; ++column) {
            std::vector<std::string> altered = lines;
            std::string& line = altered[2];
            // One field of a row is quoted and contains commas.
            const auto end_of = [&](std::size_t at) {
                return std::min(line[at] == '"' ? line.find("\",", at) + 1 : line.find(',', at), line.size());
            };
            std::size_t at = 0;
            for (std::size_t i = 0; i < column; ++i) at = end_of(at) + 1;
            line.replace(at, end_of(at) - at, number);
            write_table(joined_lines(altered, "\n"));
            CAPTURE(number, column);
            try {
                const auto comparison = compare(aabblab::read_results(out()), aabblab::read_results(second),
                                                aabblab::compared::ratios_and_times);
                for (const aabblab::compared_scene& scene : comparison.scenes)
                    for (const auto* list : {&scene.ratios, &scene.times})
                        for (const aabblab::compared_time& time : *list) CHECK(std::isfinite(time.change));
            } catch (const aabb::input_error&) {
                ++rejections;
            }
        }
    CHECK(rejections > 100);
}

TEST_CASE_METHOD(finished_run, "An unfinished run has no seal and is read as it is") {
    unseal(out());
    write_table(without_line(read_table(), 13));
    CHECK(aabblab::verified_rows(out()).size() == 11);
    // Its digests are checked nevertheless.
    const row first = aabblab::read_rows(out() / "results.csv").front();
    write_table(with_field(read_table(), 3, first.digest, "0000000000000000"));
    CHECK_THROWS_AS(aabblab::verified_rows(out()), aabb::input_error);
}

TEST_CASE_METHOD(finished_run, "An altered run is neither resumed nor sealed again") {
    run_well(resume_command());
    REQUIRE(read_manifest().contains("seal"));
    write_table(without_line(read_table(), 4));
    const std::string before = bytes_of_file(out() / "manifest.json");
    CHECK(holds(run_refused(resume_command()).err, "has 11 rows; when the run was finished it had 12"));
    CHECK(bytes_of_file(out() / "manifest.json") == before);
}

TEST_CASE_METHOD(finished_run, "A manifest describes the machine, and a run does not resume with other caches") {
    const nlohmann::ordered_json manifest = read_manifest();
    CHECK(manifest["build"]["cpu"].is_string());
    CHECK(manifest["build"]["caches"].is_object());
    CHECK(manifest["machine"]["processors"] > 0);
    CHECK(manifest["machine"]["kernel"].get<std::string>().starts_with("Linux "));
    CHECK(manifest["machine"]["libc"].is_string());
    // A run resumes with another kernel, but not with another cache.
    unseal(out());
    nlohmann::ordered_json changed = read_manifest();
    changed["machine"]["kernel"] = "Linux 1.0 i386";
    write_manifest(changed);
    run_well(resume_command());
    unseal(out());
    changed = read_manifest();
    changed["build"]["caches"]["L2"] = 1;
    write_manifest(changed);
    CHECK(holds(run_program(resume_command()).err, "another build or machine"));
}
