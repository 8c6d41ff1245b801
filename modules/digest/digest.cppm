export module aabb.digest;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// XXH3-64 over the sorted records of a result, little-endian u32s: `frame, a, b` for pairs of boxes or triangles,
/// `frame, a, b, triangle of a, triangle of b` for contacts. Engines with equal results have equal digests.
class digest {
public:
    digest();
    ~digest();
    digest(digest&&) noexcept;
    digest& operator=(digest&&) noexcept;

    /// @param sorted the pairs of one frame, ascending and unique; frames must be added in order
    void add(std::uint32_t frame, std::span<const index_pair> sorted);
    void add(std::span<const std::uint32_t> record);

    [[nodiscard]] std::uint64_t value() const;
    /// 16 hexadecimal digits.
    [[nodiscard]] std::string text() const;

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// XXH3-64 of the bytes, in 16 hexadecimal digits.
[[nodiscard]] std::string hash_of_text(std::string_view text);

}  // namespace aabb
