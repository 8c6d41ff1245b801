module aabblab.files;

import aabblab.fmt;
import :mesh_builder;
import :scalar;
import :text_scanner;

namespace aabblab {

namespace {

/// Merges bitwise equal vertices, which STL repeats for each triangle. Vertices are numbered by their first occurrence,
/// and triangles keep the order of the file. The indices are in a hash table with open addressing.
class vertex_merger {
public:
    /// @param triangles the approximate number, which sizes the table: a closed mesh has half as many vertices
    vertex_merger(mesh_builder& mesh, std::size_t triangles)
        : mesh_(mesh), slots_(std::bit_ceil(std::max<std::size_t>(triangles, 16)), none) {}

    /// Prefetches the slot of the vertex, so that it is in the cache when `index_of` needs it.
    /// @returns the hash for `index_of`
    [[nodiscard]] std::size_t prefetch(const aabb::vec3d& p) const noexcept {
        const std::size_t hash = hash_of(bits_of(p));
        __builtin_prefetch(&slots_[hash & (slots_.size() - 1)]);
        return hash;
    }
    /// The index of the vertex, added if it is new. The hash table holds indices or `none` (open addressing).
    [[nodiscard]] std::uint32_t index_of(const aabb::vec3d& p, std::size_t hash) {
        const auto bits = bits_of(p);
        std::size_t slot = hash & (slots_.size() - 1);
        for (; slots_[slot] != none; slot = next_slot(slot))
            if (bits_of(mesh_.vertex(slots_[slot])) == bits) return slots_[slot];
        const auto added = static_cast<std::uint32_t>(mesh_.vertices());
        mesh_.add_vertex(p);
        slots_[slot] = added;
        if (2 * mesh_.vertices() > slots_.size()) double_slots();
        return added;
    }
    [[nodiscard]] std::uint32_t index_of(const aabb::vec3d& p) { return index_of(p, prefetch(p)); }

private:
    using bits_of_vertex = std::array<std::uint64_t, 3>;
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] static bits_of_vertex bits_of(const aabb::vec3d& p) noexcept {
        return std::bit_cast<bits_of_vertex>(p);
    }
    /// A hash of a vertex, whose lower bits select its slot: a shift brings the mixed upper bits down.
    [[nodiscard]] static std::size_t hash_of(const bits_of_vertex& bits) noexcept {
        constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;  // 2^64 over the golden ratio (Knuth, volume 3, 6.4)
        std::uint64_t hash = 0;
        for (const std::uint64_t part : bits) {
            hash = (hash ^ part) * odd;
            hash ^= hash >> 32U;
        }
        return hash;
    }
    [[nodiscard]] std::size_t next_slot(std::size_t slot) const noexcept { return (slot + 1) & (slots_.size() - 1); }

    /// Doubles the hash table: in one that is more than half full, a search passes many slots.
    void double_slots() {
        slots_.assign(2 * slots_.size(), none);
        for (std::uint32_t vertex = 0; vertex < mesh_.vertices(); ++vertex) {
            std::size_t slot = hash_of(bits_of(mesh_.vertex(vertex))) & (slots_.size() - 1);
            while (slots_[slot] != none) slot = next_slot(slot);
            slots_[slot] = vertex;
        }
    }

    mesh_builder& mesh_;
    std::vector<std::uint32_t> slots_;  // vertex indices or none; a power of two, at most half full
};

constexpr std::size_t header_bytes = 84;
constexpr std::size_t count_offset = 80;  // of the number of triangles in the header
constexpr std::size_t normal_bytes = 12;
constexpr std::size_t triangle_bytes = normal_bytes + 3 * sizeof(aabb::vec3f) + 2;  // and two bytes of attributes

/// Compares without case, as writers disagree about the case of keywords.
bool is_keyword(std::string_view word, std::string_view keyword) {
    return std::ranges::equal(word, keyword, [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

/// Reads the text format: solid … facet … outer loop, three vertices, endloop, endfacet … endsolid.
loaded_mesh read_text(const file_text& file) {
    text_scanner in(file, no_comments);
    mesh_builder mesh(file.name);
    vertex_merger merger(mesh, /*triangles=*/0);  // unknown
    std::array<std::uint32_t, 3> corners{};
    std::size_t count = 0;  // of the corners of the current facet
    bool in_solid = false;
    bool in_facet = false;
    const auto require_end_of_line = [&] {
        if (in.has_word()) in.fail_expected("the end of the line", in.word());
    };
    while (in.next_line()) {
        const std::string_view word = in.word();
        if (is_keyword(word, "vertex") && in_facet) {
            aabb::vec3d p{};
            for (int k = 0; k < 3; ++k) p[k] = in.coordinate(in.word());
            require_end_of_line();
            if (!aabb::is_finite(p)) in.fail("the vertex has a coordinate that is not finite");
            if (count == 3) in.fail("a facet has more than three vertices");
            corners[count++] = merger.index_of(p);
        } else if (is_keyword(word, "facet") && in_solid && !in_facet) {
            in_facet = true;
            count = 0;
            // The normal is skipped, as the vertices determine it.
            for (int i = 0; i < 4; ++i) static_cast<void>(in.word());
            require_end_of_line();
        } else if (is_keyword(word, "endfacet") && in_facet) {
            if (count < 3) in.fail("a facet has " + std::to_string(count) + " vertices, not three");
            mesh.add_face(corners, in.line());
            in_facet = false;
            require_end_of_line();
        } else if (is_keyword(word, "solid") && !in_solid) {
            in_solid = true;  // its name in the rest of the line is skipped
        } else if (is_keyword(word, "endsolid") && in_solid && !in_facet) {
            in_solid = false;
        } else if (in_facet && (is_keyword(word, "outer") || is_keyword(word, "endloop"))) {
            if (is_keyword(word, "outer")) static_cast<void>(in.word());
            require_end_of_line();
        } else {
            in.fail_expected(in_facet ? "a vertex or endfacet" : in_solid ? "facet or endsolid" : "solid", word);
        }
    }
    if (in_solid) in.fail_at_end(in_facet ? "inside a facet" : "without endsolid");
    return mesh.finish(file.name + ":");
}

/// The size of a binary file with this number of triangles.
std::uint64_t bytes_of_binary(std::uint64_t triangles) {
    return header_bytes + triangle_bytes * triangles;
}

constexpr auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };

}  // namespace

/// Reads binary STL; nullopt if the file's size contradicts the number of triangles in its header, as for text. The
/// first word does not decide, as binary files may begin with "solid" too. The file is several times as large as its
/// mesh and is read in blocks, since touching fresh memory would take most of the time.
std::optional<loaded_mesh> read_binary_stl(const std::filesystem::path& file, std::size_t size) {
    if (size < header_bytes) return {};
    input_file opened(file, size);
    std::array<char, header_bytes> header{};
    opened.read(header.data(), header.size());
    const std::uint32_t count = u32_at({header.data(), header.size()}, count_offset);
    if (size != bytes_of_binary(count)) return {};
    require_memory(file.string() + ": reading it", static_cast<double>(size));
    mesh_builder mesh(file.string());
    mesh.reserve(count / 2, count);
    vertex_merger merger(mesh, count);
    constexpr std::uint32_t most_at_once = 64;
    std::array<char, triangle_bytes * most_at_once> bytes{};
    std::array<aabb::vec3d, 3 * most_at_once> points{};
    std::array<std::size_t, 3 * most_at_once> hashes{};
    for (std::uint32_t first = 0; first < count; first += std::min(most_at_once, count - first)) {
        const std::uint32_t triangles = std::min(most_at_once, count - first);
        opened.read(bytes.data(), triangle_bytes * triangles);
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<aabb::vec3f, 3> corners{};
            std::memcpy(corners.data(), bytes.data() + triangle_bytes * t + normal_bytes, sizeof corners);
            for (std::size_t i = 0; i < 3; ++i) points[3 * t + i] = aabb::in_double(corners[i]);
        }
        // All hashes of a block come first, so that the slots are in the cache when they are searched.
        for (std::size_t i = 0; i < 3 * triangles; ++i) {
            if (!aabb::is_finite(points[i]))
                reject(file, "triangle " + std::to_string(first + i / 3) + " has a coordinate that is not finite");
            hashes[i] = merger.prefetch(points[i]);
        }
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) corners[i] = merger.index_of(points[3 * t + i], hashes[3 * t + i]);
            mesh.add_face(corners, first + t);
        }
    }
    return mesh.finish(file.string() + ": triangle ");
}

/// Whether the bytes are text STL: UTF-16, or UTF-8 with "solid" and no control characters but those that the decoder
/// drops at both ends. A truncated binary file, which may begin with "solid" too, must not count as text.
bool is_text_stl(std::string_view bytes) {
    if (text_encoding_of(bytes) != text_encoding::utf8) return true;
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    const auto is_padding = [](char c) { return is_space(c) || c == '\0' || c == '\x1a'; };
    while (!bytes.empty() && is_space(bytes.front())) bytes.remove_prefix(1);
    while (!bytes.empty() && is_padding(bytes.back())) bytes.remove_suffix(1);
    return is_keyword(bytes.substr(0, 5), "solid") &&
           std::ranges::all_of(bytes, [](char c) { return is_space(c) || static_cast<unsigned char>(c) > ' '; });
}

/// Reads text STL. A binary file gets here only if its size contradicts its header, which the message states.
loaded_mesh read_stl(const file_text& file) {
    if (is_text_stl(file.text)) return read_text(file);
    const std::size_t size = file.text.size();
    if (size < header_bytes)
        file.fail(
            "is not an STL file: it is neither text that begins with solid nor holds the 84 bytes of a binary header");
    const std::uint32_t count = u32_at(file.text, count_offset);
    file.fail(fmt::format("its header announces {} triangles, which take {} bytes, but the file has {}", count,
                          bytes_of_binary(count), size));
}

}  // namespace aabblab
