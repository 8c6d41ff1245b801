module;
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cassert>

module aabb.digest;

namespace aabb {

static_assert(std::endian::native == std::endian::little, "digests hash the bytes of little-endian u32s");

namespace {

std::string in_hexadecimal(std::uint64_t value) {
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(value));
    return digits.data();
}

}  // namespace

struct digest::state {
    XXH3_state_t hash;
};

digest::digest() : state_(std::make_unique<state>()) {
    XXH3_64bits_reset(&state_->hash);
}
digest::~digest() = default;
digest::digest(digest&&) noexcept = default;
digest& digest::operator=(digest&&) noexcept = default;

/// Hashes (frame, a, b) of each pair, 256 pairs at a time, since a short update is first copied into a buffer.
void digest::add(std::uint32_t frame, std::span<const index_pair> sorted) {
    assert(std::ranges::is_sorted(sorted));
    constexpr std::size_t most_pairs = 256;
    std::array<std::uint32_t, 3 * most_pairs> records{};
    while (!sorted.empty()) {
        const auto block = sorted.first(std::min(sorted.size(), most_pairs));
        std::size_t end = 0;
        for (const auto [a, b] : block)
            for (const std::uint32_t number : {frame, a, b}) records[end++] = number;
        add(std::span(records).first(end));
        sorted = sorted.subspan(block.size());
    }
}

void digest::add(std::span<const std::uint32_t> record) {
    XXH3_64bits_update(&state_->hash, record.data(), record.size_bytes());
}
std::uint64_t digest::value() const {
    return XXH3_64bits_digest(&state_->hash);
}
std::string digest::text() const {
    return in_hexadecimal(value());
}

std::string hash_of_text(std::string_view text) {
    return in_hexadecimal(XXH3_64bits(text.data(), text.size()));
}

}  // namespace aabb
