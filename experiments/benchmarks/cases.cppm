/// The inputs of benchmarks: every strategy of a kind with the values of its parameters, and frames of a scene.
export module aabblab.cases;

import aabb.pipeline;
import aabb.std;
import aabblab.scenes;

export namespace aabblab {

inline constexpr std::array<std::uint32_t, 3> sizes = {1'000, 10'000, 100'000};  // objects per scene
/// The parameter of the scene `brownian`: the maximum displacement of an object per frame, relative to the mean extent.
inline constexpr std::array<std::string_view, 3> displacements = {"0.01", "0.1", "1"};

/// Calls `run(type_list<Strategy>)` for each strategy of a list.
template <class... Strategies, class Run>
void for_each_strategy(aabb::type_list<Strategies...>, Run run) {
    (run(aabb::type_list<Strategies>{}), ...);
}

namespace detail {
/// All values of a parameter with names or few integers as values; empty for others, which keep their default.
template <class Parameter>
[[nodiscard]] std::vector<std::string> values_of(const Parameter& parameter) {
    constexpr std::size_t few = 8;
    std::vector<std::string> values;
    if constexpr (requires { parameter.names; })
        values.assign(parameter.names.begin(), parameter.names.end());
    else if constexpr (requires { parameter.least; })
        if (static_cast<std::size_t>(parameter.most - parameter.least) < few)
            for (auto value = parameter.least; value <= parameter.most; ++value)
                values.push_back(std::to_string(value));
    return values;
}
}  // namespace detail

/// The strategy with every combination of its parameters' values.
template <aabb::Strategy S>
[[nodiscard]] std::vector<aabb::strategy_choice> choices_of() {
    std::vector<aabb::strategy_choice> choices{{std::string(S::name), {}}};
    const auto multiply = [&](const auto& parameter) {
        const std::vector<std::string> values = detail::values_of(parameter);
        if (values.empty()) return;
        std::vector<aabb::strategy_choice> multiplied;
        for (const aabb::strategy_choice& choice : choices)
            for (const std::string& value : values) {
                multiplied.push_back(choice);
                multiplied.back().settings.push_back({std::string(parameter.name), value});
            }
        choices = std::move(multiplied);
    };
    if constexpr (requires { S::parameters; })
        std::apply([&](const auto&... parameter) { (multiply(parameter), ...); }, S::parameters);
    return choices;
}

template <aabb::Strategy S>
[[nodiscard]] S make_configured(const aabb::strategy_choice& choice) {
    return aabb::make_strategy<S>(aabb::configured<S>(choice.settings));
}

/// A scene of cubes in Brownian motion.
/// @param frames the number of frames after the first one
[[nodiscard]] inline std::unique_ptr<aabb::box_scene> drifting_boxes(std::uint32_t objects, std::uint32_t frames,
                                                                     std::string_view displacement) {
    return make_box_scene({"brownian",
                           {{"objects", std::to_string(objects)},
                            {"frames", std::to_string(frames)},
                            {"displacement", std::string(displacement)}},
                           {}});
}

[[nodiscard]] inline std::vector<aabb::projection> sorted_list(std::span<const aabb::box> boxes, int axis) {
    std::vector<aabb::projection> list;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) list.push_back({boxes[id].min[axis], id});
    std::ranges::sort(list, [](const aabb::projection& p, const aabb::projection& q) { return precedes(p, q); });
    return list;
}

class sorted_frame {
public:
    explicit sorted_frame(std::uint32_t objects) {
        drifting_boxes(objects, 0, displacements.front())->next(boxes_);
        for (std::uint32_t id = 0; id < objects; ++id) objects_.insert(id);
        objects_.settle();
        for (int k = 0; k < 3; ++k) lists_[static_cast<std::size_t>(k)] = sorted_list(boxes_, k);
    }

    [[nodiscard]] std::span<const aabb::box> boxes() const noexcept { return boxes_; }
    [[nodiscard]] const aabb::membership& objects() const noexcept { return objects_; }
    /// The input of a strategy that requested the sorted lists of these axes.
    [[nodiscard]] aabb::whole_subset with_lists(aabb::axis_set axes) const noexcept {
        aabb::whole_subset whole{boxes_, {}};
        for (std::size_t k = 0; k < 3; ++k)
            if (aabb::has_axis(axes, k)) whole.lists[k] = lists_[k];
        return whole;
    }

private:
    std::vector<aabb::box> boxes_;
    aabb::membership objects_;
    std::array<std::vector<aabb::projection>, 3> lists_;
};

}  // namespace aabblab
