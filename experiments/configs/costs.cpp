module aabblab.configs;

import :document;
import aabb.simd;
import aabblab.files;
import aabblab.machine;
import aabblab.output;
import aabblab.stopwatch;

namespace aabblab {

namespace {

constexpr std::size_t longest_file = 65'536;

std::string_view instructions() {
    return aabb::simd::width == 16 ? "AVX-512" : aabb::simd::width == 8 ? "AVX2" : "128 bits";
}

/// Quotes a text for TOML; control characters, which a processor's name may contain, become blanks.
std::string toml_string(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return quoted + "\"";
}

std::string header_field(const document& doc, const std::string& key) {
    return doc.text_of(key, doc.required(doc.root(), key, "there is no " + key + "; aabblab calibrate writes it"));
}

/// Reads a cost; it must be above 0, because nothing is free.
double cost_of(const document& doc, const node& table, const aabb::cost_info& cost) {
    const std::string key(cost.name);
    const node& value = doc.required(table, key, "[costs] has no " + key + "; aabblab calibrate writes all");
    double number = 0;
    if (value.kind == node_kind::integer || value.kind == node_kind::real)
        std::from_chars(value.text.data(), value.text.data() + value.text.size(), number);
    if (!(number > 0) || !std::isfinite(number))
        doc.fail(value.line, key + " must be a number above 0" + (value.is_scalar() ? ", not " + value.text : ""));
    return number;
}

/// The folder in an environment variable; empty if it is unset or relative.
std::filesystem::path folder_in(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): the environment is never changed
    const std::filesystem::path folder = value ? value : "";
    return folder.is_absolute() ? folder : std::filesystem::path();
}

/// The date of the costs that `use_calibrated_costs` loaded; empty while the shipped costs are in use.
std::string& date_of_loaded_costs() {
    static std::string date;
    return date;
}

}  // namespace

calibrated_costs label_costs(const aabb::cost_model& costs) {
    return {AABBLAB_VERSION, date_now(), this_machine().processor, std::string(instructions()), costs};
}

/// Formats the costs as a TOML file: the version and machine, then each cost with its unit and operation as a comment.
std::string text_of(const calibrated_costs& costs) {
    std::string text =
        "# Times of elementary operations in nanoseconds, measured by `aabblab calibrate`. Another version of the\n"
        "# program, processor or instruction set ignores them; `aabblab calibrate --reset` removes them.\n";
    text += "version = " + toml_string(costs.version) + "\ndate = " + toml_string(costs.date) +
            "\nprocessor = " + toml_string(costs.processor) + "\ninstructions = " + toml_string(costs.instructions) +
            "\n\n[costs]\n";
    constexpr std::size_t comment_column = 34;
    for (const aabb::cost_info& cost : aabb::cost_infos) {
        std::string line = std::string(cost.name) + " = " + aabb::shortest(costs.costs.*cost.value);
        line.append(comment_column > line.size() ? comment_column - line.size() : 1, ' ');
        text += line + " # " + std::string(cost.unit) + ": " + std::string(cost.of) + "\n";
    }
    return text;
}

/// Reads a file of costs. Of another version's file, only the header is read: its costs may have other names.
calibrated_costs parse_costs(const std::string& text, const std::string& file) {
    const document doc(text, file, longest_file, "a file of costs");
    calibrated_costs parsed{.version = header_field(doc, "version"),
                            .date = {},
                            .processor = header_field(doc, "processor"),
                            .instructions = header_field(doc, "instructions"),
                            .costs = {}};
    if (parsed.version != AABBLAB_VERSION) return parsed;
    doc.require_keys(doc.root(), "", {"version", "date", "processor", "instructions", "costs"});
    parsed.date = header_field(doc, "date");
    const node& table = doc.required(doc.root(), "costs", "there is no [costs]; aabblab calibrate writes it");
    std::vector<std::string> names;
    for (const aabb::cost_info& cost : aabb::cost_infos) names.emplace_back(cost.name);
    doc.require_table("costs", table, " of [costs]", names);
    for (const aabb::cost_info& cost : aabb::cost_infos) parsed.costs.*cost.value = cost_of(doc, table, cost);
    return parsed;
}

calibrated_costs read_costs(const std::filesystem::path& file) {
    return parse_costs(text_of_file(file), file.string());
}

std::filesystem::path calibrated_costs_file() {
    const std::filesystem::path file = "aabblab/costs.toml";
    if (const std::filesystem::path config = folder_in("XDG_CONFIG_HOME"); !config.empty()) return config / file;
    const std::filesystem::path home = folder_in("HOME");
    return home.empty() ? home : home / ".config" / file;
}

/// Replaces the shipped costs of operations by those of the user's file, if this version of the program measured them
/// on this processor with these instructions; otherwise keeps them and prints a note. No file, no change.
void use_calibrated_costs() {
    const std::filesystem::path file = calibrated_costs_file();
    std::error_code ignored;  // an inaccessible file counts as absent
    if (file.empty() || !std::filesystem::exists(file, ignored)) return;
    const calibrated_costs costs = [&] {
        try {
            return read_costs(file);
        } catch (const aabb::input_error& e) {
            throw aabb::input_error(std::string(e.what()) + "; aabblab calibrate --reset removes it");
        }
    }();
    const calibrated_costs here = label_costs(/*costs=*/{});  // only its label counts: version and machine
    if (!costs.applies_to(here)) {
        note(file.string() + " is of aabblab " + costs.version + " with " + costs.instructions + " on " +
             costs.processor +
             ", so the shipped costs are used until aabblab calibrate measures those of this machine");
        return;
    }
    aabb::set_machine_costs(costs.costs);
    date_of_loaded_costs() = costs.date;
}

std::string costs_in_force() {
    if (date_of_loaded_costs().empty()) return "as shipped (aabblab calibrate measures yours)";
    return "calibrated " + date_of_loaded_costs() + " (" + calibrated_costs_file().string() + ")";
}

}  // namespace aabblab
