module;
#include <archive.h>
#include <archive_entry.h>

module aabblab.archive;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

/// Where the bytes go, for functions of C, through which no exception may pass.
class sink {
public:
    explicit sink(const std::filesystem::path& file) : out_(file) {}

    static la_ssize_t write(archive*, void* client, const void* bytes, std::size_t size) {
        auto& self = *static_cast<sink*>(client);
        try {
            self.out_.write(bytes, size);
            return static_cast<la_ssize_t>(size);
        } catch (...) {
            self.failure_ = std::current_exception();
            return -1;
        }
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }
    void commit() { out_.commit(); }

private:
    output_file out_;
    std::exception_ptr failure_;
};

struct deleter {
    void operator()(archive* a) const { archive_write_free(a); }
    void operator()(archive_entry* e) const { archive_entry_free(e); }
};

class writer {
public:
    explicit writer(const std::filesystem::path& file) : file_(file), sink_(file), archive_(archive_write_new()) {
        require(archive_write_add_filter_xz(archive_.get()));
        require(archive_write_set_format_pax_restricted(archive_.get()));
        // The last block as it is, in place of a tape's.
        require(archive_write_set_bytes_in_last_block(archive_.get(), 1));
        require(archive_write_open(archive_.get(), &sink_, nullptr, &sink::write, nullptr));
    }

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
        sink_.commit();
    }

private:
    void require(int result) const {
        if (result == ARCHIVE_OK) return;
        sink_.rethrow();
        const char* why = archive_error_string(archive_.get());
        throw aabb::input_error(file_.string() + " cannot be written: " + (why ? why : "an error of the archive"));
    }

    std::filesystem::path file_;
    sink sink_;
    std::unique_ptr<archive, deleter> archive_;
};

}  // namespace

void write_archive(const std::filesystem::path& archive, const std::string& top, const std::filesystem::path& folder,
                   std::span<const std::filesystem::path> files) {
    writer out(archive);
    for (const std::filesystem::path& file : files)
        out.add(top + "/" + file.generic_string(), bytes_of_file(folder / file));
    out.finish();
}

}  // namespace aabblab
