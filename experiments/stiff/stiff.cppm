/// The stiff suite: bodies stepped in time through detection, held against closed forms and published results.
export module aabblab.stiff;

import aabb.registry;
import aabb.std;
import aabblab.figures;
import aabblab.trials;

export namespace aabblab {

/// Something measured, and what is expected of it.
struct stiff_row {
    std::string subject;   ///< what was played: "velocity_verlet, dt·ω 0.05"
    std::string quantity;  ///< with its unit: "contact time (s)"
    double measured = 0;
    std::string rule;  ///< what is expected, in words; empty where nothing is
    bool holds = true;
};

struct stiff_result {
    std::vector<stiff_row> rows;
    std::vector<figure> figures;

    void add(stiff_row row) { rows.push_back(std::move(row)); }
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
};

/// In the order in which they are told.
[[nodiscard]] std::span<const stiff_study> stiff_studies();

/// The default composition.
[[nodiscard]] contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
