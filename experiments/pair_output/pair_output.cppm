module;
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Pairs on their way out of the program.
export module aabblab.pair_output;

import aabb;
import aabblab.files;

export namespace aabblab {

/// An answer that cannot be right. The program says so and exits with status 1.
class defect : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Sorts the pairs that a stage reported.
/// @param where what reported them, as the sentence begins: "std + none + one_axis, frame 3"
/// @throws defect where a pair is there more than once.
void sort_each_once(std::vector<aabb::index_pair>& pairs, std::string_view where);

/// A CSV file of sorted pairs: rows `frame,a,b` or `a,b` below that header. There only once it is committed.
class pair_table {
public:
    enum class columns { frame_a_b, a_b };

    /// @throws aabb::input_error when the file cannot be written, as do `add` and `commit`.
    pair_table(const std::filesystem::path& file, columns wanted);
    void add(std::uint32_t frame, std::span<const aabb::index_pair> sorted);
    void commit();

private:
    output_file file_;
    columns columns_;
    std::string text_;  // rows not yet written
};

}  // namespace aabblab
