module;
#include <fmt/format.h>

module aabblab.record;

import aabb.base;
import aabblab.files;
import aabblab.sha256;

namespace aabblab {

namespace {

/// Checksums by file.
using sums = std::map<std::string, std::string>;

/// A copy may have come by a way that changes the ends of lines.
std::string sum_of(const std::filesystem::path& file) {
    const std::string bytes = bytes_of_file(file);
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != '\r' || i + 1 == bytes.size() || bytes[i + 1] != '\n') text += bytes[i];
    return sha256_of(text);
}

/// Of all files but the tables that a manifest speaks for.
sums sums_of(const std::filesystem::path& folder) {
    sums all;
    for (const std::filesystem::path& file : recorded_files(folder))
        if (const std::string name = file.filename().string(); name != "results.csv" && name != "differences.csv")
            all.emplace(file.generic_string(), sum_of(folder / file));
    return all;
}

sums stated_sums(const std::filesystem::path& file) {
    sums all;
    std::istringstream in(text_of_file(file));
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        while (line.ends_with('\r')) line.pop_back();
        if (line.size() < 67 || line.substr(64, 2) != "  ")
            throw aabb::input_error(
                fmt::format("{}:{}: expected a checksum of 64 digits, two blanks and a file", file.string(), number));
        all[line.substr(66)] = line.substr(0, 64);
    }
    return all;
}

}  // namespace

void seal_record(const std::filesystem::path& folder) {
    std::string text;
    for (const auto& [file, sum] : sums_of(folder)) text += sum + "  " + file + "\n";
    write_file(folder / sums_name, text);
}

void unseal_record(const std::filesystem::path& folder) {
    std::filesystem::remove(folder / sums_name);
}

bool is_sealed_record(const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / sums_name);
}

std::string seal_of_record(const std::filesystem::path& folder) {
    return sum_of(folder / sums_name);
}

void verify_record(const std::filesystem::path& folder) {
    if (!is_sealed_record(folder)) return;
    const sums found = sums_of(folder);
    const sums stated = stated_sums(folder / sums_name);
    for (const auto& [file, sum] : stated) {
        const auto there = found.find(file);
        if (there == found.end())
            throw aabb::input_error((folder / file).string() + " is missing; SHA256SUMS names it");
        if (there->second != sum)
            throw aabb::input_error((folder / file).string() +
                                    " was altered after the run: it does not have the checksum that SHA256SUMS states");
    }
    for (const auto& [file, sum] : found)
        if (!stated.contains(file))
            throw aabb::input_error((folder / file).string() + " was added after the run: SHA256SUMS does not name it");
    for (const auto& [file, sum] : stated)
        if (const std::filesystem::path manifest(file); manifest.filename() == "manifest.json")
            if (const auto table = folder / manifest.parent_path() / "results.csv"; !std::filesystem::exists(table))
                throw aabb::input_error(table.string() + " is missing, and its manifest.json is there");
}

}  // namespace aabblab
