/// Reads the results of experiments and groups them by condition, across seeds and processes.
export module aabblab.conditions;

import aabb.registry;
import aabb.std;
import aabblab.figures;
import aabblab.metrics;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// The names and values that identify a condition: scene, objects, displacement, …
using factors = std::vector<std::pair<std::string, std::string>>;

/// The value of a factor; empty if no factor has that name.
[[nodiscard]] std::string value_of(const factors& scene, std::string_view name);
/// The value as a number; NaN if it is not a number.
[[nodiscard]] double number_of(const factors& scene, std::string_view name);

/// A short alias for the tables of claims.
using kind = aabb::strategy_kind;

/// A filter of compositions: one strategy per kind; a kind without a strategy matches any.
class selection {
public:
    selection() = default;
    selection(std::initializer_list<std::pair<aabb::strategy_kind, std::string>> wanted) {
        for (const auto& [kind, choice] : wanted) wanted_[kind] = choice;
    }

    [[nodiscard]] const std::string& operator[](aabb::strategy_kind kind) const { return wanted_[kind]; }
    /// A copy with this kind replaced.
    [[nodiscard]] selection with(aabb::strategy_kind kind, std::string choice) const;
    [[nodiscard]] bool matches(const candidate_name& name) const;

    /// "sort=shell partition=axial_cut"
    friend std::string text_of(const selection& s);

private:
    aabb::by_kind<std::string> wanted_;
};
[[nodiscard]] std::string text_of(const selection& s);

/// A scene with all its seeds: a condition under which ratios are measured.
class condition {
public:
    condition(factors scene, std::vector<const row*> rows);

    [[nodiscard]] std::string experiment() const { return rows_.empty() ? "" : rows_.front()->experiment; }
    /// The scene and its parameters, without the seed.
    [[nodiscard]] const factors& scene() const { return factors_; }
    [[nodiscard]] std::size_t processes() const { return std::max<std::size_t>(1, processes_.size()); }
    [[nodiscard]] std::size_t seeds() const { return seeds_.size(); }
    /// The triangles of its meshes, each counted once; 0 in a scene of boxes.
    [[nodiscard]] double triangles() const {
        return rows_.empty() ? 0 : static_cast<double>(rows_.front()->triangles.value_or(0));
    }
    /// A value that is equal in all repeats and seeds of a composition; empty if it has no exact row.
    [[nodiscard]] std::optional<double> value(const selection& composition, const row_value& quantity) const;

    /// Logarithms of the ratios of two compositions in the same repeat.
    [[nodiscard]] cells log_ratios(const selection& composition, const selection& baseline,
                                   const row_value& quantity) const;
    /// Logarithms of one composition's values: for counts and bytes, which do not depend on the machine.
    [[nodiscard]] cells logs(const selection& composition, const row_value& quantity) const;
    /// The values of all repeats of all compositions that have one.
    [[nodiscard]] std::vector<double> values(const row_value& quantity) const;
    /// The differences of successive repeats of a composition with one seed, relative to their mean.
    [[nodiscard]] std::vector<double> differences(const row_value& quantity) const;
    /// Median and quartiles over all repeats; empty if there are none.
    [[nodiscard]] std::optional<quartiles> spread(const selection& composition, const row_value& quantity) const;
    [[nodiscard]] std::optional<figure_point> point(double x, const selection& composition,
                                                    const row_value& quantity) const;

private:
    [[nodiscard]] std::vector<const row*> rows_of(const selection& composition) const;
    /// Adds to the cell of the row's process and seed.
    void add(cells& to, const row& r, double value) const;

    factors factors_;
    std::vector<const row*> rows_;
    std::vector<std::optional<std::uint64_t>> seeds_;
    std::vector<std::uint64_t> processes_;
};

struct extent_of_results {
    std::size_t rows = 0, compositions = 0, scenes = 0, processes = 0, seeds = 0, repeats = 0;
};

/// The results of the experiments in the sub-folders of a folder, each read on first use.
class measurements {
public:
    /// @param name the name in reports
    explicit measurements(std::filesystem::path folder, std::string name = {})
        : folder_(std::move(folder)), name_(std::move(name)) {}

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    /// The experiments with results, sorted by name.
    [[nodiscard]] std::vector<std::string> experiments() const;
    /// The conditions of an experiment in the order of its config; empty if it has no results.
    [[nodiscard]] const std::vector<condition>& conditions_of(const std::string& experiment) const {
        return read(experiment).conditions;
    }
    [[nodiscard]] extent_of_results extent(const std::string& experiment) const;
    [[nodiscard]] manifest_summary manifest(const std::string& experiment) const {
        return read_manifest(folder_ / experiment);
    }

private:
    struct experiment_results {
        std::vector<row> rows;
        std::vector<condition> conditions;
    };
    [[nodiscard]] const experiment_results& read(const std::string& experiment) const;

    std::filesystem::path folder_;
    std::string name_;
    mutable std::map<std::string, std::unique_ptr<experiment_results>> read_;
};

}  // namespace aabblab
