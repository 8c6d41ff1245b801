/// All strategies by name, and stages composed of them. Depends on no strategy: a change of one rebuilds no importer.
export module aabb.registry;

import aabb.pipeline;
import aabb.std;
export import :kinds;

export namespace aabb {

/// The name of a kind ("sort", "partition", …) in configs, options, CSV columns and folders.
[[nodiscard]] std::string_view name_of(strategy_kind kind);

/// The kinds of a stage in the order of their declaration.
[[nodiscard]] std::vector<strategy_kind> kinds_of(stage of);

struct strategy_info {
    std::string name;
    std::string summary;
    bool exact;  ///< false if it approximates with any parameters: its results are compared, but not rejected
    std::vector<parameter_info> parameters;
    std::vector<absence> leaves_out;              ///< features that a stage with this strategy lacks
    std::string needs_meshes;                     ///< a sentence why it rejects scenes of boxes; empty if it takes them
    std::vector<strategy_choice> contrasts;       ///< settings that switch features on or off, for comparison
    scene_fit (*fit)(const scene_traits& scene);  ///< whether `auto` should choose it; null if it never does
    void (*check)(const strategy_choice& choice);          ///< throws input_error on unknown or invalid settings
    bool (*is_exact_with)(const strategy_choice& choice);  ///< whether it is exact with these settings
};

/// The strategies of a kind in the order of `strategies/CMakeLists.txt`.
[[nodiscard]] std::span<const strategy_info> strategies(strategy_kind kind);

[[nodiscard]] std::vector<std::string> strategy_names(strategy_kind kind);

/// Rejects an unknown name, an unknown parameter, or an invalid value.
/// @throws input_error with the nearest valid name, or the kind to which the name belongs
void require_known(strategy_kind kind, const strategy_choice& choice);

/// The choices that the user names, by kind.
using named_strategies = by_kind<std::optional<strategy_choice>>;

/// A strategy of each kind, which together define both stages.
class composition {
public:
    /// The default strategy of every kind.
    composition() : composition(named_strategies()) {}
    /// The named strategies. Other kinds use their `fallback` if no kind compiled together with them is named;
    /// otherwise their `default_with`, or their `fallback` if the stage is accepted only with that.
    /// @throws input_error on an unknown name or parameter in a stage with a named strategy
    explicit composition(const named_strategies& named);

    [[nodiscard]] strategy_choice& operator[](strategy_kind kind) { return choices_[kind]; }
    [[nodiscard]] const strategy_choice& operator[](strategy_kind kind) const { return choices_[kind]; }
    friend bool operator==(const composition&, const composition&) = default;

private:
    by_kind<strategy_choice> choices_;
};

/// Strategies of these kinds in the syntax of the command line: "shell + axial_cut + one_axis". Omits strategies that
/// are compiled alone and are the default.
[[nodiscard]] std::string text_in_line(const by_kind<std::string>& choices,
                                       std::span<const strategy_kind> kinds = strategy_kinds);

/// "sort + partition + sweep", "tree + triangle".
[[nodiscard]] std::string to_text(const composition& c, stage of);

/// Why the stage is rejected, in the words of the rejecting policy; empty if it is accepted.
[[nodiscard]] std::string_view rejection_of(const composition& c, stage of);

/// Whether every strategy of the stage is exact with its configured parameters.
[[nodiscard]] bool is_exact(const composition& c, stage of);

/// Why the composition rejects scenes of boxes, in the words of the strategy; empty if it accepts them.
[[nodiscard]] std::string needs_meshes(const composition& c);

/// Every accepted combination of a stage with default parameters. Strategies that are compiled alone vary one at a
/// time, combined with the default and with the first strategies of the other kinds.
[[nodiscard]] std::vector<composition> every_composition(stage of);

/// @throws input_error on an unknown name or parameter, or a rejected combination
[[nodiscard]] std::unique_ptr<global_stage> compose_global_search(const composition& c, instrumentation counted);
[[nodiscard]] std::unique_ptr<local_stage> compose_local_detection(const composition& c, instrumentation counted);

/// @throws input_error on an unknown name or parameter.
[[nodiscard]] std::unique_ptr<triangle_test> make_triangle_test(const strategy_choice& choice);

struct ordered_mesh {
    mesh ordered;
    std::vector<std::uint32_t> triangles;  ///< original index of each triangle
};

/// Reorders the triangles of a mesh by the leaves of an `implicit` tree with this build, and its vertices by their
/// first use.
/// @throws input_error on an unknown name or parameter, and as `require_valid`
[[nodiscard]] ordered_mesh in_leaf_order(const mesh& m, const strategy_choice& build);

}  // namespace aabb
