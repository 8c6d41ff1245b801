module aabblab.inputs;

import aabblab.files;
import aabblab.fmt;
import aabblab.output;

namespace aabblab {

/// Parses a finite number to the nearest Real; not as a double first, since two roundings may miss it.
template <class Real>
Real parse_number(const std::string& text) {
    char* end = nullptr;
    Real value;
    if constexpr (std::same_as<Real, float>)
        value = std::strtof(text.c_str(), &end);
    else
        value = std::strtod(text.c_str(), &end);
    if (text.empty() || end != text.c_str() + text.size()) throw aabb::input_error("'" + text + "' is not a number");
    if (std::isfinite(value)) return value;
    const bool too_large = std::isinf(value) && text.find_first_of("0123456789") != std::string::npos;
    throw aabb::input_error("'" + text + "' is " + (too_large ? "too large" : "not finite"));
}

/// Parses word i of a line of numbers; a message has its place in the line, counted from 1.
template <class Real>
Real parse_number_of(const std::vector<std::string>& words, std::size_t i) {
    try {
        return parse_number<Real>(words[i]);
    } catch (const aabb::input_error& error) {
        throw aabb::input_error("number " + std::to_string(i + 1) + " of " + std::to_string(words.size()) + ": " +
                                error.what());
    }
}

template float parse_number_of<float>(const std::vector<std::string>&, std::size_t);
template double parse_number_of<double>(const std::vector<std::string>&, std::size_t);

std::uint64_t parse_whole(const std::string& text, std::uint64_t least, std::uint64_t most, std::string_view expected) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most)
        throw aabb::input_error(std::string(expected) + ", not '" + text + "'");
    return value;
}

/// Parses the value of the option --seconds; `to_do` says in a message what takes so long.
double seconds_of(const std::string& text, std::string_view to_do) {
    constexpr double most = 1e6;
    try {
        if (const auto seconds = parse_number<double>(text); seconds > 0 && seconds <= most) return seconds;
    } catch (const aabb::input_error&) {  // NOLINT(bugprone-empty-catch)
        // The message below says what is expected, which is more helpful.
    }
    throw aabb::input_error("--seconds is how long to " + std::string(to_do) +
                            ": a number above 0, at most 1,000,000, not '" + text + "'");
}

/// Splits a line into the texts of its numbers, which blanks or a single comma separate.
std::vector<std::string> split_numbers(std::string_view line) {
    constexpr std::string_view blanks = " \t\r";
    std::vector<std::string> words;
    bool after_comma = true;  // no comma may begin the line
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (line.empty()) break;
        if (line[0] != ',') {
            words.emplace_back(line.substr(0, line.find_first_of(" \t\r,")));
            line.remove_prefix(words.back().size());
            after_comma = false;
            continue;
        }
        if (after_comma) throw aabb::input_error("a number is missing before a comma");
        after_comma = true;
        line.remove_prefix(1);
    }
    if (after_comma && !words.empty()) throw aabb::input_error("a number is missing after the last comma");
    return words;
}

namespace {

constexpr std::size_t most_poses = 10'000'000;  // as in motions; a pipe could otherwise deliver poses without end

/// Parses the rows of [R t], and rejects a singular matrix R.
aabb::pose parse_pose(const std::vector<std::string>& words) {
    if (words.size() != 12)
        throw aabb::input_error(
            fmt::format("a pose is 12 numbers, the rows of [R t] with commas between, not {}", words.size()));
    aabb::pose pose;
    for (std::size_t i = 0; i < 12; ++i) {
        const auto number = parse_number_of<double>(words, i);
        const std::size_t row = i / 4;
        if (i % 4 == 3)
            pose.translation[static_cast<int>(row)] = number;
        else
            pose.rotation[3 * row + i % 4] = number;
    }
    aabb::require_full_rank(pose);
    return pose;
}

}  // namespace

/// The pose in the value of an option, which messages name; the identity without the option.
aabb::pose pose_of(const std::optional<std::string>& text, const char* option) {
    if (!text) return {};
    try {
        return parse_pose(split_numbers(*text));
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(fmt::format("{}: {}", option, error.what()));
    }
}

/// Reads a pose from each line that is not empty, and keeps their line numbers for later messages.
given_poses read_poses(const std::string& file) {
    given_poses parsed{.poses = {}, .file = file, .lines = {}};
    for (line_stream lines(file); lines.next();) {
        try {
            const std::vector<std::string> words = split_numbers(without_comment(lines.line()));
            if (words.empty()) continue;
            if (parsed.poses.size() == most_poses)
                throw aabb::input_error(fmt::format("there are more than {} poses", most_poses));
            parsed.poses.push_back(parse_pose(words));
            parsed.lines.push_back(lines.number());
        } catch (const aabb::input_error& error) {
            lines.fail(error.what());
        }
    }
    if (parsed.poses.empty()) throw aabb::input_error(file + ": has no poses");
    return parsed;
}

/// Loads meshes by name, and notes for the user how reading changed each.
std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names) {
    std::vector<aabb::mesh> meshes;
    for (const std::string& name : names) {
        loaded_mesh loaded = make_mesh(name);
        if (const std::string report = loaded.report.text(); !report.empty()) note(name + ": " + report);
        meshes.push_back(std::move(loaded.mesh));
    }
    return meshes;
}

void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder) {
    const std::vector<std::string> endings = mesh_endings();
    for (const std::string& name : std::set(names.begin(), names.end()))
        if (std::ranges::find(endings, mesh_ending_of(name_without_order(name, folder))) != endings.end())
            if (const std::string left_out = make_mesh(name, folder).report.left_out(); !left_out.empty())
                note(name + ": " + left_out);
}

void require_other_file(const std::string& out, const std::string& input) {
    std::error_code ignored;  // a file that does not exist is no conflict
    if (std::filesystem::equivalent(out, input, ignored))
        throw aabb::input_error(out + " would overwrite " + input + ", which this command reads");
}

/// Rejects an output `out` that would overwrite, or from now on hide, a mesh that the same command reads.
void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes) {
    std::vector<std::string> names;
    for (const std::string& name : meshes) names.emplace_back(name_without_order(name));
    for (const std::string& name : names) require_other_file(out, name);
    for (const std::string& name : names) require_other_file(out, (data_folder() / name).string());
    // A file with this name in the working directory would hide the one in the data folder from now on.
    for (const std::string& name : names)
        if (std::filesystem::weakly_canonical(name) == std::filesystem::weakly_canonical(out))
            throw aabb::input_error(out + " is the name of a mesh that this command reads from the data folder");
}

void require_two_files(const std::string& a, const std::string& file, const std::string& b, const std::string& other) {
    std::error_code ignored;  // files that do not exist yet are compared by their paths
    if (std::filesystem::equivalent(file, other, ignored) ||
        std::filesystem::weakly_canonical(file) == std::filesystem::weakly_canonical(other))
        throw aabb::input_error(a + " and " + b + " are the same file, " + file);
}

bool is_mesh_name(const std::string& name) {
    if (!is_mesh(name, {})) return false;
    const std::vector<std::string> endings = mesh_endings();
    return !std::filesystem::exists(name) || std::ranges::find(endings, mesh_ending_of(name)) != endings.end();
}

bool is_config_name(const std::string& argument) {
    return argument.ends_with(".toml");
}

/// The scene of a command without a config, with notes of what readers of mesh files leave out. A name that is no file
/// is taken for a mesh, whose reader reports it. Meshes keep their size, and two meshes move as with seed 1.
scene_choice scene_of_arguments(const std::vector<std::string>& arguments) {
    const std::string& first = arguments.front();
    if (is_config_name(first))
        throw aabb::input_error(
            first +
            " is a config, which explain and run take as their only argument; expected a recording, "
            "meshes, or a motion file and its meshes");
    if (is_file_of_boxes(first)) {
        if (arguments.size() > 1)
            throw aabb::input_error("a recording is a scene of its own, so give " + first + " alone");
        return {.kind = "recording", .settings = {{"file", first}}, .meshes = {}, .seed = std::nullopt};
    }
    if (!is_mesh_name(first) && arguments.size() > 1) {
        const std::vector<std::string> meshes(arguments.begin() + 1, arguments.end());
        note_left_out(meshes);
        return {.kind = "motion", .settings = {{"file", first}}, .meshes = meshes, .seed = std::nullopt};
    }
    if (std::error_code ignored; !is_mesh_name(first) && std::filesystem::is_regular_file(first, ignored))
        throw aabb::input_error(first +
                                " is neither a recording (.aabbs) nor a mesh; if it is a motion file, its "
                                "meshes follow it");
    if (arguments.size() > 2)
        throw aabb::input_error("more than two meshes need a motion file, which comes first; " + first + " is a mesh");
    note_left_out(arguments);
    return {.kind = "mesh_pair", .settings = {{"normalise", "no"}}, .meshes = arguments, .seed = 1};
}

}  // namespace aabblab
