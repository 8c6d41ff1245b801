/// The stiff suite: bodies stepped in time through detection, held against closed forms and published results.
export module aabblab.stiff;

import aabb.registry;
import aabb.std;
import aabblab.figures;
import aabblab.trials;

export namespace aabblab {

/// Nothing is expected where a value is only told.
enum class stiff_verdict : std::uint8_t { told, holds, fails };
inline constexpr std::array<std::string_view, 3> stiff_verdict_words = {"", "holds", "FAILS"};

/// Something measured, and what is expected of it.
struct stiff_row {
    std::string subject;   ///< what was played: "velocity_verlet, dt·ω 0.05"
    std::string quantity;  ///< with its unit: "contact time (s)"
    double measured = 0;
    std::string rule;  ///< what is expected, in words; empty where nothing is
    stiff_verdict verdict = stiff_verdict::told;

    [[nodiscard]] bool holds() const { return verdict != stiff_verdict::fails; }
};

/// A point of a plot.
struct stiff_point {
    std::string figure;  ///< its name
    std::string line;    ///< its label
    double x = 0;
    double y = 0;
};

struct stiff_result {
    std::vector<stiff_row> rows;
    std::vector<stiff_point> points;

    void add(stiff_row row) { rows.push_back(std::move(row)); }
    void plot(std::string_view name, std::string_view line, double x, double y) {
        points.push_back({std::string(name), std::string(line), x, y});
    }
};

struct stiff_setting {
    bool quick = false;
    contender who;  ///< who finds the contacts, but where a study compares methods
    /// Takes the share of a study that is done, from 0 to 1.
    std::function<void(double)> progress = [](double) {};
};

struct stiff_study {
    std::string_view name;
    std::string_view about;      ///< what is played, what it is held against
    std::string_view reference;  ///< where the expectation comes from
    stiff_result (*play)(const stiff_setting& setting);
    std::vector<figure> figures{};  ///< that its points stand in, without them
    /// Marks in them what is in the rows.
    void (*mark)(std::span<figure> figures, std::span<const stiff_row> rows) = nullptr;
};

/// In the order in which they are told.
[[nodiscard]] std::span<const stiff_study> stiff_studies();

/// With their points; a figure in which no line has any is left out.
[[nodiscard]] std::vector<figure> figures_of(const stiff_study& study, const stiff_result& result);

/// Writes STUDY.csv, the rows, and STUDY_points.csv.
void write_result(const std::filesystem::path& folder, const stiff_study& study, const stiff_result& result);
/// The inverse; empty where there are no such files.
/// @throws aabb::input_error with file and line where they are something else.
[[nodiscard]] std::optional<stiff_result> read_result(const std::filesystem::path& folder, const stiff_study& study);

/// The default composition.
[[nodiscard]] contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
