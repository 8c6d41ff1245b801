export module aabblab.stiff:study;

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

}  // namespace aabblab
