module;
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

module aabblab.files;

import aabb.base;

namespace aabblab {

std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw aabb::input_error(file.string() + " cannot be read");
    return bytes;
}

}  // namespace aabblab
