#include "kept_costs.hpp"

import aabb.base;
import aabb.costs;
import aabblab.configs;
import aabblab.machine;
import aabblab.output;

namespace aabblab {

namespace {

/// A folder that the environment names; empty where it does not, or not from the root on.
std::filesystem::path folder_in(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody changes the environment
    const std::filesystem::path folder = value ? value : "";
    return folder.is_absolute() ? folder : std::filesystem::path();
}

/// When the costs were measured that `use_kept_costs` took; empty where it took none.
std::string& date_taken() {
    static std::string date;
    return date;
}

}  // namespace

std::filesystem::path kept_costs_file() {
    const std::filesystem::path file = "aabblab/costs.toml";
    if (const std::filesystem::path config = folder_in("XDG_CONFIG_HOME"); !config.empty()) return config / file;
    const std::filesystem::path home = folder_in("HOME");
    return home.empty() ? home : home / ".config" / file;
}

void use_kept_costs() {
    const std::filesystem::path file = kept_costs_file();
    std::error_code ignored;  // what cannot be looked at is not there
    if (file.empty() || !std::filesystem::exists(file, ignored)) return;
    const kept_costs kept = [&] {
        try {
            return read_costs(file);
        } catch (const aabb::input_error& e) {
            throw aabb::input_error(std::string(e.what()) + "; aabblab calibrate --reset removes it");
        }
    }();
    const kept_costs here = costs_of(this_machine().processor, {});
    if (!kept.serve(here)) {
        note(file.string() + " is of aabblab " + kept.version + " with " + kept.instructions + " on " + kept.processor +
             ", not of this; costs are as shipped until aabblab calibrate measures them here");
        return;
    }
    aabb::set_machine_costs(kept.costs);
    date_taken() = kept.date;
}

std::string costs_in_force() {
    if (date_taken().empty()) return "costs as shipped";
    return "costs calibrated " + date_taken() + " (" + kept_costs_file().string() + ")";
}

}  // namespace aabblab
