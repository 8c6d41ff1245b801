module;
#include <archive.h>
#include <archive_entry.h>
#include <unistd.h>

module aabblab.archive;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

/// The path of an entry relative to the folder `top`. Rejects absolute paths and "..", which could lead outside.
/// @param archive its file name, for the message
std::filesystem::path path_below(const std::string& top, const std::string& name, const std::string& archive) {
    const std::filesystem::path path(name);
    const bool has_detour = std::ranges::any_of(
        path, [](const std::filesystem::path& part) { return part.empty() || part == "." || part == ".."; });
    if (path.empty() || path.is_absolute() || has_detour || *path.begin() != top)
        throw aabb::input_error(archive + " is not an archive of " + top + ": it has the entry '" + name + "'");
    return path.lexically_relative(top);
}

struct deleter {
    void operator()(archive* a) const { archive_free(a); }
    void operator()(archive_entry* e) const { archive_entry_free(e); }
};

class reader {
public:
    /// Opens an archive of the only kind that `writer` makes: tar compressed by xz.
    reader(const std::filesystem::path& file, const archive_limits& limits)
        : file_(file.string()), limits_(limits), archive_(archive_read_new()) {
        archive_read_support_filter_xz(archive_.get());
        archive_read_support_format_tar(archive_.get());
        if (access(file_.c_str(), R_OK) != 0) fail("cannot be read");
        // Opening a named pipe without a writer would block.
        if (!std::filesystem::is_regular_file(file)) fail("is not a regular file");
        if (archive_read_open_filename(archive_.get(), file_.c_str(), std::size_t{1} << 16U) != ARCHIVE_OK)
            fail_reading();
    }

    /// Unpacks the folder `top` as `into`. An archive is not trusted: links, duplicates and excesses are rejected.
    void unpack(const std::string& top, const std::filesystem::path& into) {
        std::set<std::filesystem::path> paths;
        std::size_t folders = 0;
        archive_entry* entry = nullptr;
        while (advance(entry)) {
            const char* pathname = archive_entry_pathname(entry);
            const auto type = archive_entry_filetype(entry);
            std::string name = pathname ? pathname : "";
            if (type == AE_IFDIR && name.ends_with('/')) name.pop_back();
            const std::filesystem::path path = path_below(top, name, file_);
            if (archive_entry_hardlink(entry) || (type != AE_IFREG && type != AE_IFDIR))
                fail("has an entry that is neither a file nor a folder: '" + path.string() + "'");
            if (type == AE_IFDIR) {
                if (++folders > limits_.files)
                    fail("has more than " + std::to_string(limits_.files) + " folders, the limit for results");
                continue;
            }
            if (!paths.insert(path).second) fail("has the file '" + path.string() + "' twice");
            if (paths.size() > limits_.files)
                fail("has more than " + std::to_string(limits_.files) + " files, the limit for results");
            write_entry(into / path);
        }
        if (paths.empty()) fail("is empty");
    }

private:
    /// Advances to the next entry; false after the last.
    [[nodiscard]] bool advance(archive_entry*& entry) {
        const int result = archive_read_next_header(archive_.get(), &entry);
        if (result == ARCHIVE_EOF) return false;
        if (result != ARCHIVE_OK) fail_reading();
        has_entry_ = true;
        return true;
    }

    /// Writes the contents of the current entry to a file. `bytes_` counts those of all entries.
    void write_entry(const std::filesystem::path& file) {
        std::error_code error;
        std::filesystem::create_directories(file.parent_path(), error);
        if (error) fail("cannot be unpacked: " + error.message());
        output_file out(file);
        std::array<char, std::size_t{1} << 16U> buffer{};
        for (;;) {
            const la_ssize_t size = archive_read_data(archive_.get(), buffer.data(), buffer.size());
            if (size < 0) fail_reading();
            if (size == 0) break;
            // Counts the actual bytes, as the size in the header cannot be trusted.
            bytes_ += static_cast<std::uint64_t>(size);
            if (bytes_ > limits_.bytes)
                fail("unpacks to more than " + std::to_string(limits_.bytes >> 20U) + " MiB, the limit for results");
            out.write(buffer.data(), static_cast<std::size_t>(size));
        }
        out.commit();
    }

    [[noreturn]] void fail_reading() const {
        const char* reason = archive_error_string(archive_.get());
        if (!has_entry_) fail("is not an archive of results, which is tar compressed by xz");
        fail(std::string("is damaged or cut off: ") + (reason ? reason : "it cannot be read to its end"));
    }
    [[noreturn]] void fail(const std::string& sentence) const { throw aabb::input_error(file_ + " " + sentence); }

    std::string file_;
    archive_limits limits_;
    std::unique_ptr<archive, deleter> archive_;
    std::uint64_t bytes_ = 0;
    bool has_entry_ = false;
};

class writer {
public:
    explicit writer(const std::filesystem::path& file) : file_(file), out_(file), archive_(archive_write_new()) {
        require(archive_write_add_filter_xz(archive_.get()));
        require(archive_write_set_format_pax_restricted(archive_.get()));
        // Omits the padding of the last block, which only tapes need.
        require(archive_write_set_bytes_in_last_block(archive_.get(), 1));
        require(archive_write_open(archive_.get(), this, nullptr, &writer::write_bytes, nullptr));
    }

    /// Adds a file without owner and time, so that the same files give the same archive.
    void add(const std::string& name, const std::string& bytes) {
        const std::unique_ptr<archive_entry, deleter> entry(archive_entry_new());
        archive_entry_set_pathname(entry.get(), name.c_str());
        archive_entry_set_filetype(entry.get(), AE_IFREG);
        archive_entry_set_perm(entry.get(), 0644);
        archive_entry_set_mtime(entry.get(), 0, 0);
        archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
        require(archive_write_header(archive_.get(), entry.get()));
        if (std::cmp_not_equal(archive_write_data(archive_.get(), bytes.data(), bytes.size()), bytes.size()))
            require(ARCHIVE_FATAL);
    }

    void finish() {
        require(archive_write_close(archive_.get()));
        out_.commit();
    }

private:
    /// The callback with which libarchive writes. No exception may pass through its C code, so `require` rethrows it.
    static la_ssize_t write_bytes(archive*, void* self, const void* bytes, std::size_t size) {
        auto& to = *static_cast<writer*>(self);
        try {
            to.out_.write(bytes, size);
            return static_cast<la_ssize_t>(size);
        } catch (...) {
            to.failure_ = std::current_exception();
            return -1;
        }
    }
    void require(int result) const {
        if (result == ARCHIVE_OK) return;
        if (failure_) std::rethrow_exception(failure_);
        const char* why = archive_error_string(archive_.get());
        throw aabb::input_error(file_.string() + " cannot be written: " + (why ? why : "an error of the archive"));
    }

    std::filesystem::path file_;
    output_file out_;
    std::exception_ptr failure_;
    std::unique_ptr<archive, deleter> archive_;
};

}  // namespace

void write_archive(const std::filesystem::path& archive, const std::string& top, const std::filesystem::path& folder,
                   std::span<const std::filesystem::path> files, const std::map<std::string, std::string>& texts) {
    writer out(archive);
    for (const auto& [name, text] : texts) out.add(top + "/" + name, text);
    for (const std::filesystem::path& file : files)
        out.add(top + "/" + file.generic_string(), bytes_of_file(folder / file));
    out.finish();
}

unpacked_archive::unpacked_archive(const std::filesystem::path& archive, const std::string& top,
                                   const archive_limits& limits)
    : guard_(make_temporary_folder("an archive cannot be unpacked")) {
    reader(archive, limits).unpack(top, folder());
}

}  // namespace aabblab
