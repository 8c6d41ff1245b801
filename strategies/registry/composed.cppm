module;
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What turns statically composed stages into rows of a table, for the generated units of the registry.
export module aabb.composed;

import aabb;

export namespace aabb::composed {

/// One row of the table of global searches; `make` is null where the combination is refused.
struct global_row {
    std::string_view sort;
    std::string_view partition;
    std::string_view sweep;
    std::string_view refusal;
    std::unique_ptr<global_stage> (*make)(const strategy_choice& sort, const strategy_choice& partition,
                                          const strategy_choice& sweep, instrumentation counted);
};

struct local_row {
    std::string_view tree;
    std::string_view triangle;
    std::string_view refusal;
    std::unique_ptr<local_stage> (*make)(const strategy_choice& tree, const strategy_choice& triangle,
                                         instrumentation counted);
};

/// The counters of a stage, whatever its policy.
[[nodiscard]] inline work_counters counted(const work_counters& counters) {
    return counters;
}
[[nodiscard]] inline work_counters counted(const no_counters&) {
    return {};
}

template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
class composed_global_stage final : public global_stage {
public:
    composed_global_stage(Sort sort, Partition partition, Sweep sweep)
        : search_(std::move(sort), std::move(partition), std::move(sweep)) {}

    void insert(std::uint32_t id) override { search_.insert(id); }
    void remove(std::uint32_t id) override { search_.remove(id); }
    void update(std::span<const box> boxes) override { search_.update(boxes); }
    void search(std::vector<index_pair>& pairs) override { search_.search(pairs); }
    [[nodiscard]] work_counters counters() const override { return counted(search_.counters()); }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts{{"projections", search_.projection_bytes()}, {"sort", search_.sort_bytes()}};
        if constexpr (CuttingPartition<Partition>) parts.push_back({"partition", search_.partition_bytes()});
        parts.push_back({"sweep", search_.sweep_bytes()});
        return parts;
    }

    [[nodiscard]] std::vector<std::string> left_out() const override {
        std::vector<std::string> absent;
        if constexpr (!CuttingPartition<Partition>) absent.emplace_back("no partition: no cells, no copies of objects");
        if constexpr (CoherentSweep<Sweep>)
            absent.emplace_back("no projection lists beside those that the sweep keeps for itself");
        for (std::size_t k = 0; k < 3; ++k)
            if (!has_axis(search_.sorted_axes(), k))
                absent.push_back(std::string("no projection list of the ") + "xyz"[k] + " axis");
        if constexpr (!Counters::enabled) absent.emplace_back("no work counters");
        return absent;
    }

private:
    global_search<Sort, Partition, Sweep, Counters> search_;
};

template <TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class composed_local_stage final : public local_stage {
public:
    composed_local_stage(const config_of<Tree>& tree, Triangle triangle)
        : tree_(tree), detection_(std::move(triangle)) {}

    std::uint32_t add_model(const mesh& m) override {
        models_.emplace_back(m, make_strategy<Tree>(tree_));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) override {
        detection_.all_pairs(models_[model_a], pose_a, models_[model_b], pose_b, pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        return detection_.first_pair(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) override {
        return detection_.count_pairs(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) override {
        detection_.self_pairs(models_[model], pairs);
    }
    void refit(std::uint32_t model) override { models_[model].refit(refitted_); }
    [[nodiscard]] std::optional<tree_survey> survey(std::uint32_t model) const override {
        return survey_of(models_[model].tree(), models_[model].triangles());
    }
    [[nodiscard]] work_counters counters() const override { return counted(detection_.counters()); }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        tree_bytes trees{};
        for (const model<Tree>& m : models_) {
            trees.nodes += m.tree().bytes().nodes;
            trees.indices += m.tree().bytes().indices;
        }
        return {{"nodes", trees.nodes},
                {"indices", trees.indices},
                {"stack", detection_.bytes()},
                {"refit", bytes_of(refitted_)}};
    }

    [[nodiscard]] std::vector<std::string> left_out() const override {
        std::vector<std::string> absent;
        if constexpr (requires { Tree::leaves_out; }) absent.emplace_back(Tree::leaves_out);
        if constexpr (!Counters::enabled) absent.emplace_back("no work counters");
        return absent;
    }

private:
    config_of<Tree> tree_;
    std::deque<model<Tree>> models_;
    local_detection<Tree, Triangle, Counters> detection_;
    std::vector<box> refitted_;  // scratch of the largest tree
};

template <TrianglePolicy Triangle>
class composed_triangle_test final : public triangle_test {
public:
    explicit composed_triangle_test(Triangle triangle) : triangle_(std::move(triangle)) {}

    [[nodiscard]] bool intersects(const triangle3f& s, const triangle3f& t) const override {
        require_ieee_arithmetic();
        return triangle_.intersects(s, t);
    }
    [[nodiscard]] bool intersects(const triangle3d& s, const triangle3d& t) const override {
        require_ieee_arithmetic();
        if constexpr (DoubleTrianglePolicy<Triangle>)
            return triangle_.intersects(s, t);
        else
            throw input_error(std::string(Triangle::name) + " tests triangles of floats only");
    }
    [[nodiscard]] bool takes_double() const override { return DoubleTrianglePolicy<Triangle>; }

private:
    [[no_unique_address]] Triangle triangle_;
};

template <class Sort, class Partition, class Sweep>
[[nodiscard]] constexpr global_row row_of() {
    constexpr std::string_view reason = refusal<Sort, Partition, Sweep>();
    global_row row{Sort::name, Partition::name, Sweep::name, reason, nullptr};
    if constexpr (reason.empty())
        row.make = [](const strategy_choice& sort, const strategy_choice& partition, const strategy_choice& sweep,
                      instrumentation counted) -> std::unique_ptr<global_stage> {
            const auto with = [&]<class Counters>(Counters) {
                return std::make_unique<composed_global_stage<Sort, Partition, Sweep, Counters>>(
                    make_strategy<Sort>(configured<Sort>(sort.settings)),
                    make_strategy<Partition>(configured<Partition>(partition.settings)),
                    make_strategy<Sweep>(configured<Sweep>(sweep.settings)));
            };
            if (counted == instrumentation::counters) return with(work_counters{});
            return with(no_counters{});
        };
    return row;
}

/// Every sort and sweep with one partition.
template <class Partition, class... Sorts, class... Sweeps>
[[nodiscard]] std::vector<global_row> global_rows(type_list<Sorts...>, type_list<Sweeps...>) {
    std::vector<global_row> rows;
    const auto with_sort = [&]<class Sort>(type_list<Sort>) {
        (rows.push_back(row_of<Sort, Partition, Sweeps>()), ...);
    };
    (with_sort(type_list<Sorts>{}), ...);
    return rows;
}

template <class Tree, class Triangle>
[[nodiscard]] constexpr local_row row_of() {
    constexpr std::string_view reason = refusal<Tree, Triangle>();
    local_row row{Tree::name, Triangle::name, reason, nullptr};
    if constexpr (reason.empty())
        row.make = [](const strategy_choice& tree, const strategy_choice& triangle,
                      instrumentation counted) -> std::unique_ptr<local_stage> {
            const auto with = [&]<class Counters>(Counters) {
                return std::make_unique<composed_local_stage<Tree, Triangle, Counters>>(
                    configured<Tree>(tree.settings), make_strategy<Triangle>(configured<Triangle>(triangle.settings)));
            };
            if (counted == instrumentation::counters) return with(work_counters{});
            return with(no_counters{});
        };
    return row;
}

/// Every triangle test with one tree.
template <class Tree, class... Triangles>
[[nodiscard]] std::vector<local_row> local_rows(type_list<Triangles...>) {
    return {row_of<Tree, Triangles>()...};
}

}  // namespace aabb::composed
