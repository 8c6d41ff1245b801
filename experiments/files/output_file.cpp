module;
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

module aabblab.files;

import :file_text;

namespace aabblab {

struct output_file::state {
    std::filesystem::path target;
    bool in_place = false;  // the target is not a regular file and is written directly
    int folder = -1;        // the open folder of the target, so that paths cannot be too long
    std::string part;       // the temporary name in the folder, if any
    file_handle file;

    ~state() {
        if (!part.empty()) unlinkat(folder, part.c_str(), 0);
        if (folder >= 0) close(folder);
    }

    [[noreturn]] void reject(const std::string& why) const { aabblab::reject(target, "cannot be written: " + why); }
    [[noreturn]] void fail() const { reject(system_error_text()); }

    [[nodiscard]] std::filesystem::path folder_path() const {
        return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
    }

    /// Makes a file of a temporary name, `part`: calls `make` with names unique to this process until it succeeds. It
    /// must fail with EEXIST on an existing file. The names are short, as the target's may have the maximum length.
    /// @returns false if it fails otherwise, for which errno has the reason
    [[nodiscard]] bool make_part(auto make) {
        for (int attempt = 0; attempt < 100; ++attempt) {
            part = ".aabblab." + std::to_string(getpid()) + "." + std::to_string(attempt) + ".part";
            if (make(part.c_str())) return true;
            if (errno != EEXIST) break;
        }
        part.clear();
        return false;
    }

    /// Opens a stream on the descriptor, and leaves `file` empty on failure.
    void open_stream(int descriptor) {
        if (descriptor < 0) return;
        file.reset(fdopen(descriptor, "wb"));
        if (!file) close(descriptor);
    }

    /// Opens an unnamed file in the target's folder, which vanishes with the process, or else one of a temporary name.
    void open_in_folder() {
        folder = open(folder_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
        if (folder < 0) fail();
        open_stream(openat(folder, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
        // An unnamed file can be named only through /proc.
        if (file && access(link_to(fileno(file.get())).c_str(), F_OK) != 0) file.reset();
        if (file) return;
        const auto open_part = [&](const char* name) {
            open_stream(openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
            return file != nullptr;
        };
        if (!make_part(open_part)) fail();
    }

    [[nodiscard]] static std::string link_to(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }
};

/// Opens a file that `commit` names, so that a failure leaves no partial file. A pipe or device is opened itself.
output_file::output_file(const std::filesystem::path& file) : state_(std::make_unique<state>()) {
    if (file.empty()) throw aabb::input_error("the file to write has no name");
    state_->target = file;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    // The file is named only after all work is done, so an invalid name must be rejected now.
    if (status.type() == std::filesystem::file_type::none) state_->reject(error.message());
    if (is_directory(status)) state_->reject("it is a folder");
    if (exists(status) && !is_regular_file(status)) {
        state_->in_place = true;
        state_->file.reset(std::fopen(file.c_str(), "wb"));
        if (!state_->file) state_->fail();
        return;
    }
    if (std::filesystem::is_symlink(file, error)) {
        if (!exists(status)) state_->reject("it is a symbolic link to a file that does not exist");
        state_->target = std::filesystem::canonical(file);  // the link itself is preserved
    }
    state_->open_in_folder();
}

output_file::~output_file() = default;

/// Rejects output for which the disk has no space before anything is written. Pipes and devices need none.
void output_file::require_space(double bytes) const {
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(state_->folder_path(), error);
    if (error || state_->in_place) return;
    const auto available = static_cast<double>(space.available);
    if (bytes <= available) return;
    const auto [needed, free] = different_sizes(bytes, available);
    reject(state_->target, "would take " + needed + ", but only " + free + " are free");
}

void output_file::write(const void* data, std::size_t bytes) {
    if (std::fwrite(data, 1, bytes, state_->file.get()) != bytes) state_->fail();
}

void output_file::overwrite(std::uint64_t offset, const void* data, std::size_t bytes) {
    std::FILE* const file = state_->file.get();
    if (fseeko(file, static_cast<off_t>(offset), SEEK_SET) != 0) state_->fail();
    write(data, bytes);
    if (fseeko(file, 0, SEEK_END) != 0) state_->fail();
}

/// Gives the complete file its name in one step, so that no reader sees a partial one. Pipes and devices are closed.
void output_file::commit() {
    std::FILE* const file = state_->file.get();
    if (std::fflush(file) != 0) state_->fail();
    if (!state_->in_place) {
        // An unnamed file first gets a temporary name, as linkat() cannot replace an existing file, but renameat() can.
        const std::string unnamed = state::link_to(fileno(file));
        if (state_->part.empty() && !state_->make_part([&](const char* part) {
                return linkat(AT_FDCWD, unnamed.c_str(), state_->folder, part, AT_SYMLINK_FOLLOW) == 0;
            }))
            state_->fail();
        if (renameat(state_->folder, state_->part.c_str(), state_->folder, state_->target.filename().c_str()) != 0)
            state_->fail();
        state_->part.clear();
    }
    state_->file.reset();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
    output_file out(file);
    out.write(text);
    out.commit();
}

}  // namespace aabblab
