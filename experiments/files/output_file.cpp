module;
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

module aabblab.files;

import aabb;
import :file_text;

namespace aabblab {

struct output_file::state {
    std::filesystem::path target;
    bool in_place = false;       // the target is no regular file: written at once
    std::filesystem::path part;  // the name beside the target, while there is one
    file_handle file;

    [[noreturn]] void fail() const {
        throw aabb::input_error(target.string() +
                                ": cannot be written: " + std::error_code(errno, std::generic_category()).message());
    }

    [[nodiscard]] std::filesystem::path folder() const {
        return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
    }

    /// Gives `make` names that no other process and no other file of this one has, until it makes one. `make` must not
    /// take an existing file (EEXIST).
    template <class Make>
    [[nodiscard]] bool make_part(Make make) {
        for (int attempt = 0; attempt < 100; ++attempt) {
            part = target;
            part.replace_filename("." + target.filename().string() + "." + std::to_string(getpid()) + "." +
                                  std::to_string(attempt) + ".part");
            if (make(part.c_str())) return true;
            if (errno != EEXIST) break;
        }
        part.clear();
        return false;
    }

    /// A file without a name goes with its process, however that ends.
    void open_unnamed() {
        const int descriptor = open(folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
        if (descriptor < 0) return;
        // Without /proc it could never be named.
        if (access(link_to(descriptor).c_str(), F_OK) == 0) file.reset(fdopen(descriptor, "wb"));
        if (!file) close(descriptor);
    }

    [[nodiscard]] static std::string link_to(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }
};

output_file::output_file(std::filesystem::path file) : state_(std::make_unique<state>()) {
    if (file.empty()) throw aabb::input_error("the file to write has no name");
    state_->target = file;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (is_directory(status)) throw aabb::input_error(file.string() + ": cannot be written: it is a folder");
    if (exists(status) && !is_regular_file(status)) {
        state_->in_place = true;
        state_->file.reset(std::fopen(file.c_str(), "wb"));
    } else {
        // Through a symbolic link, so that the link stays one.
        if (exists(status)) state_->target = std::filesystem::canonical(file);
        state_->open_unnamed();
        // Not every file system has files without a name.
        if (!state_->file && !state_->make_part([&](const char* part) {
                state_->file.reset(std::fopen(part, "wbx"));
                return state_->file != nullptr;
            }))
            state_->fail();
    }
    if (!state_->file) state_->fail();
}

output_file::~output_file() {
    if (!state_->file) return;
    state_->file.reset();
    std::error_code ignored;
    if (!state_->part.empty()) std::filesystem::remove(state_->part, ignored);
}

void output_file::require_space(double bytes) const {
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(state_->folder(), error);
    if (error || state_->in_place) return;
    const auto available = static_cast<double>(space.available);
    if (bytes <= available) return;
    std::array<char, 96> sizes{};
    std::snprintf(sizes.data(), sizes.size(), ": would take %.1f GiB, but only %.1f GiB are free", bytes * 0x1p-30,
                  available * 0x1p-30);
    throw aabb::input_error(state_->target.string() + sizes.data());
}

void output_file::write(const void* data, std::size_t bytes) {
    if (std::fwrite(data, 1, bytes, state_->file.get()) != bytes) state_->fail();
}

void output_file::write(const std::string& text) {
    write(text.data(), text.size());
}

void output_file::overwrite(std::uint64_t offset, const void* data, std::size_t bytes) {
    std::FILE* const file = state_->file.get();
    if (fseeko(file, static_cast<off_t>(offset), SEEK_SET) != 0) state_->fail();
    write(data, bytes);
    if (fseeko(file, 0, SEEK_END) != 0) state_->fail();
}

void output_file::commit() {
    std::FILE* const file = state_->file.get();
    if (std::fflush(file) != 0) state_->fail();
    if (!state_->in_place) {
        // An existing file cannot be linked over, only renamed over.
        const std::string unnamed = state::link_to(fileno(file));
        if (state_->part.empty() && !state_->make_part([&](const char* part) {
                return linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, part, AT_SYMLINK_FOLLOW) == 0;
            }))
            state_->fail();
        if (std::rename(state_->part.c_str(), state_->target.c_str()) != 0) state_->fail();
    }
    state_->file.reset();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
    output_file out(file);
    out.write(text);
    out.commit();
}

}  // namespace aabblab
