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

    /// Makes a temporary file: calls `make`, which must fail with EEXIST on an existing file, with names unique to this
    /// process until it succeeds. They are short, as the target's name may have the maximum length.
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

    [[nodiscard]] static std::string link_to(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }
};

/// Opens an unnamed or temporary file in the target's folder, to be renamed on `commit`; or the pipe or device itself.
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
    } else {
        if (std::filesystem::is_symlink(file, error)) {
            if (!exists(status)) state_->reject("it is a symbolic link to a file that does not exist");
            state_->target = std::filesystem::canonical(file);  // the link itself is preserved
        }
        state_->folder = open(state_->folder_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
        if (state_->folder < 0) state_->fail();
        // An unnamed file vanishes with its process, however that ends. It can be named only through /proc.
        state_->open_stream(openat(state_->folder, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
        if (state_->file && access(state::link_to(fileno(state_->file.get())).c_str(), F_OK) != 0) state_->file.reset();
        // Not every file system supports unnamed files.
        if (!state_->file && !state_->make_part([&](const char* part) {
                state_->open_stream(openat(state_->folder, part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
                return state_->file != nullptr;
            }))
            state_->fail();
    }
    if (!state_->file) state_->fail();
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

/// Gives the file its name, in one step that replaces an existing target, so that no reader sees a partial file.
void output_file::commit() {
    std::FILE* const file = state_->file.get();
    if (std::fflush(file) != 0) state_->fail();
    if (!state_->in_place) {
        // linkat() cannot replace an existing file, but renameat() can.
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
