/// All strategies by name, and stages composed of them. The interface names none of them: importers are not rebuilt
/// when a strategy changes.
export module aabb.registry;

import aabb.pipeline;
import aabb.std;
export import :kinds;

export namespace aabb {

/// "sort", "partition", … as in configs, options, CSV columns and folders.
[[nodiscard]] std::string_view name_of(strategy_kind kind);

/// In the order in which they are declared.
[[nodiscard]] std::vector<strategy_kind> kinds_of(stage of);

struct strategy_info {
    std::string name;
    std::string summary;
    bool exact;  ///< false for one that approximates, whatever its parameters: its results are compared, not refused
    std::vector<parameter_info> parameters;
    std::vector<absence> leaves_out;         ///< what a stage with it does without
    std::string needs_meshes;                ///< why it has no use for boxes alone, a sentence; empty where it has
    std::vector<strategy_choice> contrasts;  ///< with settings by which it has what it or others leave out as it is
    scene_fit (*fit)(const scene_outlook& scene);          ///< whether `auto` is to choose it; null where it never does
    void (*check)(const strategy_choice& choice);          ///< throws input_error on settings that it has not
    bool (*is_exact_with)(const strategy_choice& choice);  ///< whether it is with these settings
};

/// The strategies of a kind, in the order of `strategies/CMakeLists.txt`.
[[nodiscard]] std::span<const strategy_info> strategies(strategy_kind kind);

[[nodiscard]] std::vector<std::string> strategy_names(strategy_kind kind);

/// Refuses an unknown name, an unknown parameter, or a value that is not one.
/// @throws input_error with the nearest valid name, or the kind that the name is of.
void require_known(strategy_kind kind, const strategy_choice& choice);

/// What is said of each kind, if anything.
using named_strategies = by_kind<std::optional<strategy_choice>>;

/// A strategy of each kind: what both stages are made of.
class composition {
public:
    /// What every kind has where nothing is said.
    composition() : composition(named_strategies()) {}
    /// What is named. The other kinds of a stage have their `fallback` where no kind is named that is compiled with
    /// them; else their `beside`, or their `fallback` if only with that the stage makes sense.
    /// @throws input_error on an unknown name or parameter in a stage of which something is named.
    explicit composition(const named_strategies& named);

    [[nodiscard]] strategy_choice& operator[](strategy_kind kind) { return choices_[kind]; }
    [[nodiscard]] const strategy_choice& operator[](strategy_kind kind) const { return choices_[kind]; }
    friend bool operator==(const composition&, const composition&) = default;

private:
    by_kind<strategy_choice> choices_;
};

/// Strategies of these kinds, each as the command line takes it: "shell + axial_cut + one_axis". Nothing is said of one
/// that stands apart and is the usual one.
[[nodiscard]] std::string text_in_line(const by_kind<std::string>& choices,
                                       std::span<const strategy_kind> kinds = strategy_kinds);

/// "sort + partition + sweep", "tree + triangle".
[[nodiscard]] std::string to_text(const composition& c, stage of);

/// Why the stage makes no sense, in the words of the policy that refuses it; empty where it makes sense.
[[nodiscard]] std::string_view refusal_of(const composition& c, stage of);

/// Whether every strategy of the stage is exact with the parameters that it has there.
[[nodiscard]] bool is_exact(const composition& c, stage of);

/// Why the composition is refused in scenes of boxes, in the words of the strategy; empty where it plays them too.
[[nodiscard]] std::string needs_meshes(const composition& c);

/// Every combination of a stage that makes sense, with default parameters; what stands apart in turn, with the usual
/// strategies and with the first ones.
[[nodiscard]] std::vector<composition> every_composition(stage of);

/// @throws input_error on an unknown name or parameter, or a refused combination.
[[nodiscard]] std::unique_ptr<global_stage> compose_global_search(const composition& c, instrumentation counted);
[[nodiscard]] std::unique_ptr<local_stage> compose_local_detection(const composition& c, instrumentation counted);

/// @throws input_error on an unknown name or parameter.
[[nodiscard]] std::unique_ptr<triangle_test> make_triangle_test(const strategy_choice& choice);

/// A mesh in another order, and which triangle stands where, by the number that it had.
struct ordered_mesh {
    mesh ordered;
    std::vector<std::uint32_t> triangles;
};

/// The mesh in the order of the leaves that this build gives `implicit`: triangle by triangle, and its vertices in the
/// order in which these come upon them.
/// @throws input_error on an unknown name or parameter, and as `require_valid`.
[[nodiscard]] ordered_mesh in_leaf_order(const mesh& m, const strategy_choice& build);

}  // namespace aabb
