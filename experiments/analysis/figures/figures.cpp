module aabblab.figures;

import aabb.base;
import aabblab.files;
import :sheet;

namespace aabblab {

std::string svg_of(const figure& f) {
    return svg_of(sheet_of(f));
}

std::string pdf_of(const figure& f) {
    return pdf_of(sheet_of(f));
}

void draw(const std::filesystem::path& folder, std::span<const figure> figures) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error(folder.string() + ": cannot be made: " + error.message());
    for (const figure& f : figures) {
        const sheet drawn = sheet_of(f);
        write_file(folder / (f.name + ".csv"), csv_of(f));
        write_file(folder / (f.name + ".svg"), svg_of(drawn));
        write_file(folder / (f.name + ".pdf"), pdf_of(drawn));
    }
}

}  // namespace aabblab
