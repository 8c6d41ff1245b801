module aabblab.files;

import aabblab.fmt;
import :file_text;

// NumPy's format: a magic number, a version, the length of a header, and the header, a Python dictionary of the type,
// the order and the shape (numpy.lib.format).
namespace aabblab {

namespace {

static_assert(std::endian::native == std::endian::little, "arrays are read as little-endian");

constexpr std::string_view magic = "\x93NUMPY";

/// The value of a key in the header, up to the comma or brace behind it; tuples are taken whole.
std::string_view value_of(std::string_view header, std::string_view key, const std::filesystem::path& file) {
    const std::size_t at = header.find("'" + std::string(key) + "'");
    const std::size_t colon = header.find(':', std::min(at, header.size()));
    if (at == std::string_view::npos || colon == std::string_view::npos)
        reject(file, "has no '" + std::string(key) + "' in its header");
    std::string_view value = header.substr(colon + 1);
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
    const std::size_t end = value.starts_with('(') ? value.find(')') : value.find_first_of(",}");
    if (end == std::string_view::npos) reject(file, "has no end of '" + std::string(key) + "' in its header");
    return value.substr(0, end);
}

/// The numbers of a tuple, "(12, 3".
std::vector<std::size_t> shape_of(std::string_view tuple, const std::filesystem::path& file) {
    std::vector<std::size_t> shape;
    tuple.remove_prefix(std::min<std::size_t>(1, tuple.size()));
    while (true) {
        tuple.remove_prefix(std::min(tuple.find_first_not_of(" ,"), tuple.size()));
        if (tuple.empty()) return shape;
        std::size_t extent = 0;
        const auto [end, error] = std::from_chars(tuple.data(), tuple.data() + tuple.size(), extent);
        if (error != std::errc{}) reject(file, "has a shape of other things than numbers in its header");
        shape.push_back(extent);
        tuple = std::string_view(end, tuple.data() + tuple.size());
    }
}

/// An array whose values are still bytes.
struct raw_array {
    std::vector<std::size_t> shape;
    std::size_t count = 1;  ///< of values
    std::string type;
    bool is_column_major = false;
    std::string bytes;      ///< of the whole file
    std::size_t begin = 0;  ///< of the values in it
};

raw_array read_raw(const std::filesystem::path& file) {
    raw_array array{.bytes = bytes_of_file(file)};
    constexpr std::size_t version_at = magic.size();
    if (!array.bytes.starts_with(magic) || array.bytes.size() < version_at + 6) reject(file, "is not an .npy file");
    const bool has_long_header = array.bytes[version_at] > 1;
    std::uint32_t length = 0;
    std::memcpy(&length, array.bytes.data() + version_at + 2, has_long_header ? 4 : 2);
    const std::size_t header_at = version_at + (has_long_header ? 6 : 4);
    if (array.bytes.size() < header_at + length) reject(file, "ends in its header");
    const std::string_view header = std::string_view(array.bytes).substr(header_at, length);
    array.begin = header_at + length;
    array.shape = shape_of(value_of(header, "shape", file), file);
    for (const std::size_t extent : array.shape) {
        if (extent > 0 && array.count > array.bytes.size() / extent) reject(file, "ends in its values");
        array.count *= extent;
    }
    array.type = value_of(header, "descr", file);
    std::erase(array.type, '\'');
    array.is_column_major = value_of(header, "fortran_order", file) == "True";
    return array;
}

/// The values of one of some types, converted; others are rejected.
/// @param expected names the types
/// @param types each with a value of its type
template <class Number>
number_array<Number> converted(const std::filesystem::path& file, const std::string& expected, auto... types) {
    raw_array array = read_raw(file);
    number_array<Number> result{.shape = array.shape, .values = {}};
    const auto read = [&]<class Stored>(std::string_view type, Stored value) {
        if (array.type != type) return;
        if (array.bytes.size() - array.begin < array.count * sizeof value) reject(file, "ends in its values");
        for (std::size_t i = 0; i < array.count; ++i) {
            std::memcpy(&value, array.bytes.data() + array.begin + i * sizeof value, sizeof value);
            if constexpr (std::unsigned_integral<Stored>) {
                // The greatest of 64 bits have no counterpart with a sign.
                const auto number = static_cast<Number>(value);
                result.values.push_back(number < 0 ? std::numeric_limits<Number>::max() : number);
            } else {
                result.values.push_back(value);
            }
        }
    };
    (read(types.first, types.second), ...);
    if (result.values.size() != array.count)
        reject(file, "expected " + expected + " in little-endian order, found the type '" + array.type + "'");
    if (!array.is_column_major) return result;
    // Value i of the file has the index (i mod s0, i / s0 mod s1, …).
    std::vector<Number> ordered(array.count);
    for (std::size_t i = 0; i < array.count; ++i) {
        std::size_t place = 0, rest = i, stride = array.count;
        for (const std::size_t extent : array.shape) {
            stride /= extent;
            place += rest % extent * stride;
            rest /= extent;
        }
        ordered[place] = result.values[i];
    }
    result.values = std::move(ordered);
    return result;
}

}  // namespace

number_array<std::int64_t> read_npy_integers(const std::filesystem::path& file) {
    return converted<std::int64_t>(file, "integers of 16, 32 or 64 bits", std::pair("<i8", std::int64_t{}),
                                   std::pair("<u8", std::uint64_t{}), std::pair("<i4", std::int32_t{}),
                                   std::pair("<u4", std::uint32_t{}), std::pair("<i2", std::int16_t{}),
                                   std::pair("<u2", std::uint16_t{}));
}

number_array<double> read_npy_reals(const std::filesystem::path& file) {
    return converted<double>(file, "floats or doubles", std::pair("<f4", float{}), std::pair("<f8", double{}));
}

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
    constexpr std::size_t size = 128;  // a multiple of 64, as the format asks
    std::string extents;
    for (const std::size_t extent : shape) extents += std::to_string(extent) + ", ";
    std::string header = fmt::format("{}{}{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", magic,
                                     std::string("\x01\0\x76\0", 4), type, extents);
    header.resize(size - 1, ' ');
    return header + '\n';
}

}  // namespace aabblab
