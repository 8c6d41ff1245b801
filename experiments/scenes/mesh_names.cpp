module aabblab.scenes;

import aabb.registry;
import :icosphere;
import :kind;
import :noise_sphere;
import :slivers;
import :square;
import :torus_knot;

namespace aabblab {

namespace {

using shape_types = aabb::type_list<icosphere, torus_knot, noise_sphere, square, slivers>;

template <class... Shapes>
std::vector<shape_info> infos_of(aabb::type_list<Shapes...>) {
    return {{std::string(Shapes::name), std::string(Shapes::summary), aabb::parameters_of<Shapes>()}...};
}

bool is_shape(std::string_view name) {
    return std::ranges::find(shapes(), name, &shape_info::name) != shapes().end();
}

/// Makes the named one of `Shapes`. Rejects a size beyond the memory before it is allocated.
template <class... Shapes>
aabb::mesh make_shape(aabb::type_list<Shapes...>, const aabb::strategy_choice& choice) {
    aabb::mesh mesh;
    const auto try_shape = [&]<class Shape>(aabb::type_list<Shape>) {
        if (Shape::name != choice.name) return;
        const auto config = aabb::configured<Shape>(choice.settings);
        // A triangle needs three indices and half a vertex; the factor 2 covers vectors that grow by doubling.
        require_memory(aabb::to_text(choice), 2.0 * config.triangles * (3 * 4 + 0.5 * sizeof(aabb::vec3f)));
        mesh = Shape::make(config);
    };
    (try_shape(aabb::type_list<Shapes>{}), ...);
    return mesh;
}

/// The paths at which a mesh may be found, in search order.
std::array<std::filesystem::path, 3> places(std::string_view name, const std::filesystem::path& folder) {
    return {name, folder / name, data_folder() / name};
}

bool is_there(std::string_view name, const std::filesystem::path& folder) {
    std::error_code ignored;
    return std::ranges::any_of(places(name, folder),
                               [&](const auto& p) { return std::filesystem::exists(p, ignored); });
}

/// All names of meshes, shapes and files of the data folder, from which messages suggest the nearest to an unknown one.
std::vector<std::string> known_names() {
    std::vector<std::string> names;
    for (const shape_info& shape : shapes()) names.push_back(shape.name);
    const std::vector<std::string> endings = mesh_endings();
    std::vector<std::string> files;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(data_folder(), error), end; !error && entry != end;
         entry.increment(error))
        if (std::ranges::find(endings, entry->path().extension().string()) != endings.end())
            files.push_back(entry->path().filename().string());
    std::ranges::sort(files);
    names.insert(names.end(), files.begin(), files.end());
    return names;
}

/// "NAME:order=BUILD", or "SHAPE:parameter=value,order=BUILD".
struct ordered_name {
    std::string_view name;
    std::optional<std::string_view> build;  ///< empty if triangles keep their order
};

/// Splits "NAME:order=BUILD", unless a file has the full name. A parameter comes only after a colon or a later comma.
ordered_name split_name(std::string_view name, const std::filesystem::path& folder) {
    constexpr std::string_view key = "order=";
    if (is_there(name, folder)) return {name, {}};
    for (std::size_t begin = name.find(key); begin != std::string_view::npos; begin = name.find(key, begin + 1)) {
        const std::string_view before = name.substr(0, begin);
        const bool is_parameter = before.ends_with(':') || (before.ends_with(',') && before.find(':') < before.size());
        if (!is_parameter) continue;
        const std::string_view build = name.substr(begin + key.size());
        if (build.find_first_of(":,") != std::string_view::npos)
            throw aabb::input_error(
                "order=BUILD must end the name of a mesh and takes no parameters, as in "
                "torus_knot:triangles=5000,order=sah, not as in '" +
                std::string(name) + "'");
        return {before.substr(0, begin - 1), build};
    }
    return {name, {}};
}

/// Reads the first file of this name in search order, or makes the shape; suggests a name for an unknown one.
loaded_mesh make_unordered_mesh(std::string_view name, const std::filesystem::path& folder) {
    std::error_code ignored;
    for (const std::filesystem::path& file : places(name, folder))
        if (std::filesystem::is_regular_file(file, ignored)) return read_mesh(file);
    if (is_shape(name.substr(0, name.find(':')))) return {make_shape(shape_types{}, aabb::parse_strategy(name)), {}};
    if (std::filesystem::status(name, ignored).type() != std::filesystem::file_type::not_found)
        return read_mesh(name);  // fails, and reports what it is instead of a file
    throw aabb::input_error(aabb::unknown_name("mesh", name, known_names()) + " (a mesh is a file, here" +
                            (folder.empty() ? "" : ", in " + folder.string()) + " or in " + data_folder().string() +
                            ", where ./aabblab data puts some, or a shape)");
}

}  // namespace

std::span<const shape_info> shapes() {
    static const std::vector<shape_info> infos = infos_of(shape_types{});
    return infos;
}

std::filesystem::path data_folder() {
    const char* const set = std::getenv("AABBLAB_DATA");
    return set != nullptr && *set != '\0' ? set : AABBLAB_DATA_FOLDER;
}

/// The path of a file: as given if it exists, otherwise in the folder of the config. An empty name stays empty.
std::filesystem::path resolve_file(const std::filesystem::path& name, const std::filesystem::path& folder) {
    std::error_code ignored;
    std::filesystem::path in_folder = folder / name;
    if (name.empty() || std::filesystem::exists(name, ignored)) return name;
    if (std::filesystem::exists(in_folder, ignored)) return in_folder;
    throw aabb::input_error(name.string() + ": no such file" +
                            (in_folder != name ? ", here or in " + folder.string() : ""));
}

std::string_view name_without_order(std::string_view name, const std::filesystem::path& folder) {
    return split_name(name, folder).name;
}

bool is_mesh(std::string_view name, const std::filesystem::path& folder) {
    name = name_without_order(name, folder);
    return is_shape(name.substr(0, name.find(':'))) || is_there(name, folder);
}

/// Makes or reads the mesh; "order=BUILD" sorts its triangles by the leaves of the tree that this build makes.
loaded_mesh make_mesh(std::string_view name, const std::filesystem::path& folder) {
    const auto [plain_name, build] = split_name(name, folder);
    if (!build) return make_unordered_mesh(name, folder);
    const aabb::strategy_choice choice{std::string(*build), {}};
    require_known(aabb::strategy_kind::build, choice);
    loaded_mesh loaded = make_unordered_mesh(plain_name, folder);
    loaded.mesh = in_leaf_order(loaded.mesh, choice).ordered;
    return loaded;
}

/// The meshes of these names for a scene, whose kind takes at least one and at most `most` of them.
std::vector<aabb::mesh> meshes_named(const scene_choice& choice, std::span<const std::string> names, std::size_t most) {
    if (names.empty()) throw aabb::input_error(choice.kind + " needs at least one mesh");
    if (names.size() > most)
        throw aabb::input_error(choice.kind + " takes at most " + std::to_string(most) + " meshes, not " +
                                std::to_string(names.size()));
    std::vector<aabb::mesh> meshes;
    for (const std::string& name : names) meshes.push_back(make_mesh(name, choice.folder).mesh);
    return meshes;
}

}  // namespace aabblab
