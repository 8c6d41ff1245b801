module aabblab.suites;

import :wrong_lists;
import aabb.collision_filter;
import aabblab.checking;
import aabblab.files;
import aabblab.filters;
import aabblab.fmt;
import aabblab.output;

namespace aabblab {

namespace {

/// A word for the shell, in quotes where it needs them.
std::string quoted(const std::string& word) {
    constexpr std::string_view further = "_-./=:,+@%";
    const auto is_plain = [further](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || further.find(c) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

/// The command line that runs the engine on the scene alone, after one that generates the scene if no file has it.
std::string repetition_of(const external_engine& engine, const scene_choice& scene) {
    std::string recording = "scene.aabbs", generation = "./aabblab scene " + scene.kind;
    for (const auto& [name, value] : scene.settings) {
        if (std::ranges::find(filter_settings, name) != filter_settings.end()) continue;
        if (!scene.seed) recording = resolve_file(value, scene.folder).string();  // it has no other setting
        generation += " --" + name + " " + quoted(value);
    }
    generation = scene.seed ? fmt::format("{} --seed {} --out {} && ", generation, *scene.seed, recording) : "";
    std::string command = quoted(engine.program);
    for (const std::string& argument : std::span(engine.command).subspan(1)) command += " " + quoted(argument);
    return fmt::format("{}./aabblab check {} --command {}", generation, quoted(recording), quoted(command));
}

/// The list of an engine, without the pairs that the filter of the scene leaves out: the engine does not know it.
pair_list filtered_list(const std::filesystem::path& file, const aabb::collision_filter* filter) {
    pair_list list = read_pair_list(file);
    if (filter) std::erase_if(list.rows, [&](const listed_pair& r) { return !filter->keeps(r.pair.a, r.pair.b); });
    return list;
}

}  // namespace

void report_wrong_lists(const experiment& e, std::size_t scene, std::span<const candidate> candidates,
                        const std::filesystem::path& folder) {
    const scene_choice& choice = e.scenes[scene];
    for (const candidate& c : candidates) {
        if (!c.reported || !c.reported->is_wrong || !std::filesystem::exists(c.reported->pairs)) continue;
        const external_engine& engine = *std::ranges::find(e.externals, c.name.engine, &external_engine::name);
        scene_frames frames(open_boxes(c.reported->recording));
        frames.filter_by(filter_of(choice, frames.objects()));
        const check_result result = check_boxes(frames, filtered_list(c.reported->pairs, frames.filter()));
        const std::filesystem::path kept =
            folder / "wrong_lists" / fmt::format("{}_{}_{}.csv", engine.name, choice.kind, scene);
        std::filesystem::create_directories(kept.parent_path());
        std::filesystem::copy(c.reported->pairs, kept, std::filesystem::copy_options::overwrite_existing);
        note(brief_text_of(
            result, {.scene = fmt::format("{} ({})", choice.kind, parameters_text(choice)), .list = engine.name}));
        note(fmt::format("{}: this list is {}; to check it again and find the smallest scene: {}", engine.name,
                         kept.string(), repetition_of(engine, choice)));
    }
}

}  // namespace aabblab
