module;
#include <nlohmann/json.hpp>

module aabblab.checking;

import aabblab.fmt;
import aabblab.numbers;
import aabblab.output;

namespace aabblab {

namespace {

/// A line for each kind of error with its number; of faulty rows only where there are any.
std::string errors_text(const check_result& r, const checked_list& of) {
    struct kind {
        std::string_view name;
        std::uint64_t count;
        std::string meaning;
        bool always;
    };
    const kind kinds[] = {
        {"false negatives", r.false_negatives(), "pairs that the list lacks", true},
        {"false positives", r.false_positives(), "rows that are no pair", true},
        {"duplicates", r.duplicates, "rows that repeat a pair", false},
        {"self pairs", r.self_pairs, fmt::format("rows with one {} twice", of.objects), false},
        {"unknown ids", r.unknown_ids, fmt::format("rows with an id that no {} has", of.objects), false},
        {of.frames == "pose" ? "unknown poses" : "unknown frames", r.unknown_frames,
         fmt::format("rows with a {} that the scene does not have", of.frames), false}};
    std::string text;
    for (const auto& [name, count, meaning, always] : kinds)
        if (always || count > 0) text += fmt::format("{:<16}{:>12}  {}\n", name, grouped(count), meaning);
    return text;
}

std::string classes_text(const check_result& r) {
    std::string text = fmt::format("\n{:<28}{:>18}{:>18}\n", "class", "false negatives", "false positives");
    for (const class_counts& c : r.classes)
        if (c.false_negatives + c.false_positives > 0)
            text += fmt::format("{:<28}{:>18}{:>18}\n", c.name, grouped(c.false_negatives), grouped(c.false_positives));
    if (r.unclassified > 0) text += fmt::format("{} more are not classified\n", grouped(r.unclassified));
    return text;
}

/// The frames with wrong pairs, in a line; of many the first few.
std::string frames_text(const check_result& r, const checked_list& of) {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, r.frames.size()); ++i) {
        const wrong_frame& f = r.frames[i];
        text += fmt::format("{}{} (-{} +{})", i == 0 ? "" : ", ", f.frame, f.false_negatives, f.false_positives);
    }
    if (r.frames.size() > most) text += fmt::format(" and {} more", grouped(r.frames.size() - most));
    return fmt::format("{} with wrong pairs (-false negatives +false positives): {}",
                       counted(r.frames.size(), of.frames), text);
}

/// "frame 3: 4,7 is a false negative (touching on x)"
std::string line_of(const wrong_pair& w, const checked_list& of) {
    const std::string objects = w.objects ? fmt::format("objects {},{}, triangles ", w.objects->a, w.objects->b) : "";
    return fmt::format("{} {}: {}{},{} is {} ({})", of.frames, w.frame, objects, w.pair.a, w.pair.b,
                       w.is_listed ? "a false positive" : "a false negative", w.description);
}

std::string first_text(const check_result& r, const checked_list& of) {
    std::string text = fmt::format("\nThe first {}:\n", r.first.size() == 1 ? "one" : grouped(r.first.size()));
    for (const wrong_pair& w : r.first) {
        text += wrapped(line_of(w, of)) + "\n";
        for (const std::string& shape : w.shapes) text += hanging("  ", shape, paragraph_width()) + "\n";
    }
    return text;
}

}  // namespace

/// The report for reading: totals, what the wrong pairs have in common, their classes, and the first of them.
std::string text_of(const check_result& r, const checked_list& of) {
    std::string text =
        fmt::format("{}: {} of {}\n", visible(of.list), counted(r.listed, "row"), counted(r.expected, "pair"));
    if (r.is_right()) return text + "The list is right.\n";
    text += errors_text(r, of);
    for (const std::string& sentence : r.patterns) text += "\n" + wrapped(sentence) + "\n";
    if (r.first.empty()) return text;
    return text + classes_text(r) + "\n" + wrapped(frames_text(r, of)) + "\n" + first_text(r, of);
}

std::string brief_text_of(const check_result& r, const checked_list& of) {
    constexpr std::size_t most = 3;
    std::string text =
        fmt::format("{} on {}: {} of {}", of.list, of.scene, counted(r.listed, "row"), counted(r.expected, "pair"));
    if (r.is_right()) return text + "; the list is right.";
    text += fmt::format(", {} and {}", counted(r.false_negatives(), "false negative"),
                        counted(r.false_positives(), "false positive"));
    const std::array<std::pair<std::uint64_t, std::string_view>, 4> faults{{{r.duplicates, "duplicate"},
                                                                            {r.self_pairs, "self pair"},
                                                                            {r.unknown_ids, "unknown id"},
                                                                            {r.unknown_frames, "unknown frame"}}};
    for (const auto& [count, name] : faults)
        if (count > 0) text += ", " + counted(count, name);
    std::string classes;
    for (const class_counts& c : r.classes)
        if (c.false_negatives + c.false_positives > 0)
            classes += fmt::format("{}{} (-{} +{})", classes.empty() ? ": " : ", ", c.name, c.false_negatives,
                                   c.false_positives);
    text += classes + ".";
    for (const std::string& sentence : r.patterns) text += " " + sentence;
    for (const wrong_pair& w : std::span(r.first).first(std::min(most, r.first.size())))
        text += fmt::format(" In {}.", line_of(w, of));
    return text;
}

std::string json_of(const check_result& r, const checked_list& of) {
    nlohmann::ordered_json summary = {{"scene", of.scene},
                                      {"list", of.list},
                                      {"right", r.is_right()},
                                      {"rows", r.listed},
                                      {"pairs", r.expected},
                                      {"correct", r.correct},
                                      {"false_negatives", r.false_negatives()},
                                      {"false_positives", r.false_positives()},
                                      {"duplicates", r.duplicates},
                                      {"self_pairs", r.self_pairs},
                                      {"unknown_ids", r.unknown_ids},
                                      {"unknown_frames", r.unknown_frames},
                                      {"classes", nlohmann::ordered_json::object()},
                                      {"unclassified", r.unclassified},
                                      {"frames", nlohmann::ordered_json::array()},
                                      {"first", nlohmann::ordered_json::array()},
                                      {"patterns", r.patterns},
                                      {"search_ms", r.search_ms},
                                      {"check_ms", r.check_ms}};
    for (const class_counts& c : r.classes) summary["classes"][c.name] = {c.false_negatives, c.false_positives};
    for (const wrong_frame& f : r.frames) summary["frames"].push_back({f.frame, f.false_negatives, f.false_positives});
    for (const wrong_pair& w : r.first) {
        auto& pair = summary["first"].emplace_back(nlohmann::ordered_json{{of.frames, w.frame},
                                                                          {"a", w.pair.a},
                                                                          {"b", w.pair.b},
                                                                          {"listed", w.is_listed},
                                                                          {"description", w.description},
                                                                          {"shapes", w.shapes}});
        if (w.objects) pair["objects"] = {w.objects->a, w.objects->b};
    }
    return summary.dump() + "\n";
}

}  // namespace aabblab
