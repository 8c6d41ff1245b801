/// Reads binary numbers; the machine must be little-endian, which `gltf_buffers.cpp` asserts.
module aabblab.files:scalar;

import aabb.std;

namespace aabblab {

enum class scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

[[nodiscard]] constexpr bool is_integer(scalar type) noexcept {
    return type != scalar::f32 && type != scalar::f64;
}

[[nodiscard]] constexpr std::size_t bytes_of(scalar type) noexcept {
    return std::array<std::size_t, 8>{1, 1, 2, 2, 4, 4, 4, 8}[static_cast<std::size_t>(type)];
}

/// The greatest value of an integer type.
[[nodiscard]] inline double greatest(scalar type) noexcept {
    const bool has_sign = type == scalar::i8 || type == scalar::i16 || type == scalar::i32;
    return std::ldexp(1, static_cast<int>(8 * bytes_of(type)) - has_sign) - 1;
}

[[nodiscard]] inline std::uint32_t u32_at(std::string_view bytes, std::size_t offset) noexcept {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

/// Reads the number at `bytes`, which need not be aligned, as a double, to which every type converts exactly.
[[nodiscard]] inline double number_at(const char* bytes, scalar type, bool is_big_endian = false) noexcept {
    const auto as = [&]<class Value>(Value) {
        std::array<char, sizeof(Value)> raw{};
        std::copy_n(bytes, raw.size(), raw.begin());
        if (is_big_endian) std::ranges::reverse(raw);
        return static_cast<double>(std::bit_cast<Value>(raw));
    };
    switch (type) {
        case scalar::i8: return as(std::int8_t{});
        case scalar::u8: return as(std::uint8_t{});
        case scalar::i16: return as(std::int16_t{});
        case scalar::u16: return as(std::uint16_t{});
        case scalar::i32: return as(std::int32_t{});
        case scalar::u32: return as(std::uint32_t{});
        case scalar::f32: return as(float{});
        case scalar::f64: return as(double{});
    }
    return 0;
}

}  // namespace aabblab
