module;
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What the experiments of the paper measured, read from their results folders.
export module aabblab.claims:measurements;

import aabblab.figures;
import aabblab.results;
import aabblab.statistics;

export namespace aabblab {

/// Names and values that tell a condition from others: scene, objects, displacement, …
using factors = std::vector<std::pair<std::string, std::string>>;

/// The value of a factor; empty where there is none of that name.
[[nodiscard]] std::string value_of(const factors& all, std::string_view name);
/// The same as a number; NaN where it is none.
[[nodiscard]] double number_of(const factors& all, std::string_view name);

/// One number of a row; empty where it has none.
using metric = std::function<std::optional<double>(const row&)>;

/// Milliseconds a frame after frame 0: all of it, taking and sorting the boxes, testing triangles.
[[nodiscard]] metric frame_ms();
[[nodiscard]] metric update_ms();
[[nodiscard]] metric detect_ms();
/// Milliseconds of all frames, frame 0 and the making of stages and trees with them.
[[nodiscard]] metric whole_ms();
[[nodiscard]] metric build_ms();
/// A count of work, a frame after frame 0, by its column.
[[nodiscard]] metric count_of(std::string_view column);
/// Bytes of these parts together.
[[nodiscard]] metric bytes_of(std::vector<std::string> parts);
/// Bytes of the trees for each triangle.
[[nodiscard]] metric tree_bytes();

/// Strategies that name a composition among others; what is empty may be anything.
struct selection {
    std::string sort, partition, sweep, split_large, tree;

    [[nodiscard]] bool matches(const contender_name& name) const;
};

/// A scene with all its seeds: a condition under which ratios are measured.
class condition {
public:
    condition(factors of, std::vector<const row*> rows);

    /// Scene and parameters without the seed.
    [[nodiscard]] const factors& of() const { return of_; }
    [[nodiscard]] std::size_t processes() const { return processes_; }
    [[nodiscard]] std::size_t seeds() const { return seeds_.size(); }
    [[nodiscard]] const std::vector<const row*>& rows() const { return rows_; }
    /// The rows of one composition; empty where it has none (or was wrong).
    [[nodiscard]] std::vector<const row*> rows_of(const selection& who) const;

    /// Logarithms of the ratios of two compositions in the same repeat.
    [[nodiscard]] cells log_ratios(const selection& arm, const selection& base, const metric& of) const;
    /// Logarithms of one composition's values: for counts and bytes, which no machine disturbs.
    [[nodiscard]] cells logs(const selection& who, const metric& of) const;
    /// Median and quartiles over all repeats; empty where there are none.
    [[nodiscard]] std::optional<quartiles> spread(const selection& who, const metric& of) const;
    /// The same as a point of a figure.
    [[nodiscard]] std::optional<figure_point> point(double x, const selection& who, const metric& of) const;

private:
    [[nodiscard]] std::size_t seed_index(const row& r) const;

    factors of_;
    std::vector<const row*> rows_;
    std::vector<std::string> seeds_;
    std::size_t processes_ = 1;
};

/// The results of experiments in the folders of one, each read when it is first asked for.
class measurements {
public:
    explicit measurements(std::filesystem::path folder) : folder_(std::move(folder)) {}

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    /// The conditions of an experiment in the order of its config; none where it has no results.
    [[nodiscard]] const std::vector<condition>& of(const std::string& experiment) const;

private:
    struct experiment_results {
        std::vector<row> rows;
        std::vector<condition> conditions;
    };
    [[nodiscard]] const experiment_results& read(const std::string& experiment) const;

    std::filesystem::path folder_;
    mutable std::map<std::string, std::unique_ptr<experiment_results>> read_;
};

}  // namespace aabblab
