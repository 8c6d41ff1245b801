module aabblab.pair_output;

import aabb.base;

namespace aabblab {

namespace {

void append(std::string& text, char before, const aabb::vec3d& p) {
    for (const double x : p.at) text += before + aabb::shortest(x);
}

}  // namespace

std::string to_text(const aabb::triangle_intersection& common) {
    std::string text = std::string(name_of(common.kind)) + ' ' + std::to_string(common.size);
    for (std::uint32_t i = 0; i < common.size; ++i) append(text, ' ', common.corners[i]);
    append(text, ' ', common.error);
    return text;
}

std::string to_cells(const aabb::triangle_intersection& common) {
    std::string cells = std::string(name_of(common.kind)) + ',' + std::to_string(common.size);
    append(cells, ',', common.error);
    for (std::uint32_t i = 0; i < common.corners.size(); ++i) {
        if (i < common.size)
            append(cells, ',', common.corners[i]);
        else
            cells += ",,,";
    }
    return cells;
}

}  // namespace aabblab
