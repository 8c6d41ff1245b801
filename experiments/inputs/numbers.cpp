module aabblab.inputs;

import aabb.base;

namespace aabblab {

template <class Real>
Real parse_number(const std::string& text) {
    char* end = nullptr;
    Real value;
    // strtof and strtod round correctly; a double rounded again to float would not always be the nearest float.
    if constexpr (std::same_as<Real, float>)
        value = std::strtof(text.c_str(), &end);
    else
        value = std::strtod(text.c_str(), &end);
    if (text.empty() || end != text.c_str() + text.size()) throw aabb::input_error("'" + text + "' is not a number");
    if (std::isfinite(value)) return value;
    const bool too_large = std::isinf(value) && text.find_first_of("0123456789") != std::string::npos;
    throw aabb::input_error("'" + text + "' is " + (too_large ? "too large" : "not finite"));
}

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

double seconds_of(const std::string& text, std::string_view to_do) {
    constexpr double most = 1e6;
    try {
        if (const auto seconds = parse_number<double>(text); seconds > 0 && seconds <= most) return seconds;
    } catch (const aabb::input_error&) {  // NOLINT(bugprone-empty-catch)
        // What is expected says more.
    }
    throw aabb::input_error("--seconds is how long to " + std::string(to_do) +
                            ": a number above 0, at most 1,000,000, not '" + text + "'");
}

std::vector<std::string> split_numbers(std::string_view line) {
    constexpr std::string_view blanks = " \t\r";
    std::vector<std::string> words;
    bool after_comma = true;  // as it is at the start: no comma may follow
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

}  // namespace aabblab
