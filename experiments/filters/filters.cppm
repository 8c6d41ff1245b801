/// Collision filters from the user's files: groups, masks, sets and rest of each object, and exceptions.
export module aabblab.filters;

import aabb.collision_filter;
import aabb.std;
import aabblab.scenes;

export namespace aabblab {

/// The files of a filter, as options or keys of a scene name them.
struct filter_files {
    std::optional<std::string> groups;  ///< CSV of object, group, mask, set, rest
    std::optional<std::string> except;  ///< CSV of exceptions a, b

    [[nodiscard]] bool any() const noexcept { return groups || except; }
    /// The names, for the user: "groups.csv and except.csv".
    [[nodiscard]] std::string text() const;
};

/// Reads the filter of a scene; null if there are no files.
/// @throws aabb::input_error with file and line on a malformed row, an object that the scene does not have, an object
/// that is listed twice, or a pair of an object with itself.
[[nodiscard]] std::shared_ptr<const aabb::collision_filter> read_filter(const filter_files& files, std::size_t objects);

/// Reads the filter that the settings of a scene name; null if they name none.
/// @throws aabb::input_error likewise, and if a file does not exist.
[[nodiscard]] std::shared_ptr<const aabb::collision_filter> filter_of(const scene_choice& scene, std::size_t objects);

/// Adds the files to the settings of a scene.
void add_filter(const filter_files& files, scene_choice& scene);

}  // namespace aabblab
