#pragma once

#include "program.hpp"

import aabblab.files;

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinity = std::numeric_limits<float>::infinity();

using triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The mesh that is read from a file of that name.
inline aabblab::loaded_mesh read(const std::string& name, const std::string& bytes) {
    const temporary_folder folder;
    return aabblab::read_mesh(folder.write(name, bytes));
}

/// The bytes of a number, as a binary file holds it.
template <class Value>
[[nodiscard]] std::string raw(Value value, bool big_endian = false) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big_endian) std::ranges::reverse(bytes);
    return bytes;
}

/// A binary STL triangle.
[[nodiscard]] inline std::string stl_triangle(const float (&corners)[9]) {
    std::string bytes(12, '\0');
    for (const float c : corners) bytes += raw(c);
    return bytes + std::string(2, '\0');
}

[[nodiscard]] inline std::string stl_header(std::uint32_t triangles, const std::string& text = "binary") {
    return text + std::string(80 - text.size(), ' ') + raw(triangles);
}

/// The text of an OFF file.
inline constexpr char tetrahedron[] = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";

/// A folder with a file of it.
struct with_mesh_file : in_folder {
    const std::string mesh = folder.write("a.off", tetrahedron);
};
