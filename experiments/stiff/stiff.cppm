/// The stiff suite: simulations with collision detection, compared with closed forms and published results.
export module aabblab.stiff;

import aabb.registry;
import aabb.std;
import aabblab.figures;
import aabblab.trials;

export namespace aabblab {

/// `reported` is for values that are reported without an expectation.
enum class stiff_verdict : std::uint8_t { reported, holds, fails };
inline constexpr std::array<std::string_view, 3> stiff_verdict_words = {"", "holds", "FAILS"};

/// A measurement and its expectation.
struct stiff_row {
    std::string subject;   ///< the simulated case: "velocity_verlet, dt·ω 0.05"
    std::string quantity;  ///< with its unit: "contact time (s)"
    double measured = 0;
    std::string rule;  ///< the expectation in words; may be empty
    stiff_verdict verdict = stiff_verdict::reported;
    double expected = 0;  ///< the value that the rule expects; 0 if that is none or a limit. Not stored

    [[nodiscard]] bool holds() const { return verdict != stiff_verdict::fails; }
};

struct stiff_point {
    std::string figure;  ///< its name
    std::string line;    ///< its label
    double x = 0, y = 0;
    std::string label = {};  ///< of the point: the step or tolerance that gives it
};

struct stiff_result {
    std::vector<stiff_row> rows;
    std::vector<stiff_point> points;

    void add(stiff_row row) { rows.push_back(std::move(row)); }
    void plot(std::string_view name, std::string_view line, double x, double y, std::string label = {}) {
        points.push_back({std::string(name), std::string(line), x, y, std::move(label)});
    }
};

/// What tests break on purpose, to show that a verdict depends on it: factors of friction, of torques, and of a length
/// that determines the shape of a gear's flanks (the radius of their base circle) or of a nut's thread (its pitch).
struct stiff_fault {
    double friction = 1;
    double torque = 1;
    double shape = 1;
};

struct stiff_setting {
    bool quick = false;
    candidate tested;  ///< finds the contacts; of a study that compares methods, the exact ones
    /// Receives the completed share of a study, from 0 to 1.
    std::function<void(double)> progress = [](double) {};
    stiff_fault fault = {};
    /// The names of those that a study runs with, of the ones that it would choose itself; all if empty.
    std::vector<std::string_view> integrators = {};
};

struct stiff_study {
    std::string_view name;
    std::string_view about;      ///< the simulated case and what it tests
    std::string_view reference;  ///< the source of the expectation
    void (*run)(const stiff_setting& setting, stiff_result& result);
    std::vector<figure> figures{};  ///< the figures of its points, still empty
    bool compares_methods = false;  ///< whether it chooses its candidates itself
};

/// All studies, in the order of the report.
[[nodiscard]] std::span<const stiff_study> stiff_studies();

/// The figures of a study with their points; figures without points are omitted.
[[nodiscard]] std::vector<figure> figures_of(const stiff_study& study, const stiff_result& result);

/// Writes STUDY.csv, the rows, and STUDY_points.csv.
void write_result(const std::filesystem::path& folder, const stiff_study& study, const stiff_result& result);
/// The inverse of `write_result`; empty if the files do not exist.
/// @throws aabb::input_error with file and line if they are malformed.
[[nodiscard]] std::optional<stiff_result> read_result(const std::filesystem::path& folder, const stiff_study& study);

[[nodiscard]] candidate default_candidate() {
    return candidate_of(aabb::composition(), true);
}

/// A candidate that finds nothing in one of `every` queries of two meshes.
[[nodiscard]] candidate losing_contacts(const candidate& tested, std::size_t every);

/// How the results of a study change if another method finds the contacts.
struct method_effect {
    std::string study = {};
    std::string method = {};
    std::size_t rules = 0;   ///< rows that have a rule, with exact contacts
    std::size_t turned = 0;  ///< of these, with another verdict or missing
    /// The greatest change of a measured value of which the rule expects a value, relative to that; infinite if a value
    /// is not finite or missing.
    double change = 0;

    friend bool operator==(const method_effect&, const method_effect&) = default;
};

/// Compares the results with another method with those with exact contacts; rows match by subject and quantity.
[[nodiscard]] method_effect effect_of(const stiff_result& exact, const stiff_result& with_method);

/// Runs a study with exact contacts and with each of some methods: an inexact triangle test in two settings, a stale
/// Verlet list, a coarse tree, and lost contacts.
[[nodiscard]] std::vector<method_effect> effects_of_methods(const stiff_study& study, const stiff_setting& exact);

/// Writes methods.csv.
void write_effects(const std::filesystem::path& folder, std::span<const method_effect> effects);
/// The inverse of `write_effects`; empty if there is no file.
/// @throws aabb::input_error with file and line if it is malformed.
[[nodiscard]] std::vector<method_effect> read_effects(const std::filesystem::path& folder);

}  // namespace aabblab
