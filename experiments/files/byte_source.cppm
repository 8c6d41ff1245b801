/// Bytes of a file, a pipe or a device as they come.
module aabblab.files:byte_source;

import aabb.std;

namespace aabblab {

class byte_source {
public:
    /// Opens it for reading.
    /// @param name for messages, in place of the file's
    /// @throws aabb::input_error where that cannot be, where it is a folder, or a named pipe that nobody opens for
    /// writing within some seconds.
    explicit byte_source(const std::filesystem::path& file, const std::string& name = {});
    /// Standard input.
    byte_source();
    byte_source(const byte_source&) = delete;
    byte_source& operator=(const byte_source&) = delete;
    ~byte_source();

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    /// In bytes; 0 where it is not known.
    [[nodiscard]] std::uintmax_t size() const noexcept { return size_; }

    /// Appends what is there, at most so many bytes; waits until there is something.
    /// @returns false at the end
    /// @throws aabb::input_error where it cannot be read.
    bool read(std::size_t most, std::string& bytes);

private:
    void wait_for_writer();

    std::string name_;
    int descriptor_;
    std::uintmax_t size_ = 0;
    std::string ahead_;  // read while waiting for a writer
};

}  // namespace aabblab
