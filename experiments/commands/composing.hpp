#pragma once

import aabb.distance;
import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.queries;

namespace aabblab {

class command_parser;

/// Options that select the method: the strategies of some stages, one per kind, or an engine for the last stage.
class method_options {
public:
    explicit method_options(std::vector<aabb::stage> stages) : stages_(std::move(stages)) {}

    /// @param replaced what an engine replaces, for the help
    void add_to(const command_parser& command, const std::string& replaced);
    /// @throws aabb::input_error on an unknown strategy or parameter, on a strategy that the engine replaces, and on an
    /// invalid combination, so that all of these are rejected before any file is read.
    [[nodiscard]] search_choice choice() const;

private:
    std::vector<aabb::stage> stages_;
    aabb::by_kind<std::optional<std::string>> values_;
    std::optional<std::string> engine_;
};

/// The numbers for which results on moving meshes are exact.
inline constexpr const char* exact_for_meshes = "vertices and poses in double";

/// The pairs that a value of --self asks for; a flag without a value is "true".
/// @throws aabb::input_error on another value
[[nodiscard]] self_pairs self_pairs_of(const std::string& value);

/// The option --touching.
/// @param hits "pairs" or "contacts", for the help
void add_touching(const command_parser& command, bool* touching, const std::string& hits);

/// The option --within, a distance.
/// @param pairs "triangles" or "boxes", for the help
void add_within(const command_parser& command, std::optional<double>* distance, const std::string& pairs);

/// The option --metric, of the distance of boxes.
void add_metric(const command_parser& command, std::optional<aabb::box_metric>* metric);

/// Rejects the choice of what decides whether triangles intersect, or of a test before, which distances replace.
void require_no_triangle_test(const search_choice& choice);

/// " within 0.5", or nothing without --within.
[[nodiscard]] std::string text_of_within(const std::optional<double>& distance);

/// The names of a kind's strategies, "median, mean, …", for help texts.
[[nodiscard]] std::string listed_names(aabb::strategy_kind kind);

}  // namespace aabblab
