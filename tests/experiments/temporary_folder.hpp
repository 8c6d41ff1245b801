#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "../testing.hpp"

/// A temporary folder, removed at the end of its lifetime.
class temporary_folder {
public:
    temporary_folder() {
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("aabblab_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(folder_);
    }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    ~temporary_folder() { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

    /// Writes a file and creates its parent folders.
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }

    [[nodiscard]] std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }

private:
    std::filesystem::path folder_;
};

/// Test cases that use files have a folder each: `TEST_CASE_METHOD(in_folder, "…")`.
struct in_folder {
    const temporary_folder folder;
};

[[nodiscard]] inline std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
