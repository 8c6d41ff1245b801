module;
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// All strategies by name, and stages composed of them. The interface names none of them: importers are not rebuilt
/// when a strategy changes.
export module aabb.registry;

import aabb;

export namespace aabb {

enum class strategy_kind { sort, partition, sweep, tree, triangle };
inline constexpr strategy_kind strategy_kinds[] = {strategy_kind::sort, strategy_kind::partition, strategy_kind::sweep,
                                                   strategy_kind::tree, strategy_kind::triangle};

/// "sort", "partition", … as in configs, options, CSV columns and folders.
[[nodiscard]] std::string_view name_of(strategy_kind kind);

struct strategy_info {
    std::string name;
    std::string summary;
    bool exact;  ///< false for one that approximates, whatever its parameters: its results are compared, not refused
    std::vector<parameter_info> parameters;
};

/// The strategies of a kind, in the order of `strategies/CMakeLists.txt`.
[[nodiscard]] std::span<const strategy_info> strategies(strategy_kind kind);

/// The same strategies by name only.
[[nodiscard]] std::vector<std::string> strategy_names(strategy_kind kind);

/// Refuses an unknown name, an unknown parameter, or a value that is not one.
/// @throws input_error with the nearest valid name.
void require_known(strategy_kind kind, const strategy_choice& choice);

/// What a global search is made of.
struct global_composition {
    strategy_choice sort{"std", {}};
    strategy_choice partition{"none", {}};
    strategy_choice sweep{"one_axis", {}};
    std::optional<double> split_large = std::nullopt;  ///< see split_large_stage

    friend bool operator==(const global_composition&, const global_composition&) = default;
};

/// What a local detection is made of.
struct local_composition {
    strategy_choice tree{"canonical", {}};
    strategy_choice triangle{"exact", {}};

    friend bool operator==(const local_composition&, const local_composition&) = default;
};

/// "off", or the size as a setting takes it.
[[nodiscard]] std::string split_large_text(const global_composition& composition);

/// "sort + partition + sweep" and "tree + triangle", each as the command line takes it; with "split_large=4" behind the
/// sweep where there is that.
[[nodiscard]] std::string to_text(const global_composition& composition);
[[nodiscard]] std::string to_text(const local_composition& composition);

/// Why the combination makes no sense, in the words of the policy that refuses it; empty where it makes sense.
[[nodiscard]] std::string_view refusal_of(const global_composition& composition);
[[nodiscard]] std::string_view refusal_of(const local_composition& composition);

/// Whether every strategy in the composition is exact with the parameters that it has there.
[[nodiscard]] bool is_exact(const global_composition& composition);
[[nodiscard]] bool is_exact(const local_composition& composition);

/// @throws input_error on an unknown name or parameter, or a refused combination.
[[nodiscard]] std::unique_ptr<global_stage> compose(const global_composition& composition, instrumentation counted);
[[nodiscard]] std::unique_ptr<local_stage> compose(const local_composition& composition, instrumentation counted);

/// @throws input_error on an unknown name or parameter.
[[nodiscard]] std::unique_ptr<triangle_test> make_triangle_test(const strategy_choice& choice);

}  // namespace aabb
