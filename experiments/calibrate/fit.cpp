module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

module aabblab.calibrate;

import aabblab.statistics;

namespace aabblab {

namespace {

/// The normal equations of a least-squares problem: sums over observations of products of work, and of work.
struct normal_equations {
    explicit normal_equations(std::size_t count) : products(count * count), sums(count) {}

    std::vector<double> products;  // a square, row after row
    std::vector<double> sums;
};

/// Least squares with none below 0, by going down along one cost after the other from where they are.
void descend(const normal_equations& equations, std::vector<double>& costs) {
    constexpr int most_rounds = 20'000;
    constexpr double near_enough = 1e-12;
    const std::size_t count = costs.size();
    for (int round = 0; round < most_rounds; ++round) {
        double change = 0;
        double all = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double curvature = equations.products[i * count + i];
            if (!(curvature > 0)) continue;
            double slope = equations.sums[i];
            for (std::size_t j = 0; j < count; ++j) slope -= equations.products[i * count + j] * costs[j];
            const double next = std::max(0.0, costs[i] + slope / curvature);
            // By how much the prediction changes, whatever the unit of the work.
            change += (next - costs[i]) * (next - costs[i]) * curvature;
            all += next * next * curvature;
            costs[i] = next;
        }
        if (change <= near_enough * near_enough * all) return;
    }
}

double median_of(std::vector<double> values) {
    return quartiles_of(std::move(values)).median;
}

double sum_of(std::span<const double> work, std::span<const double> costs) {
    double sum = 0;
    for (std::size_t k = 0; k < costs.size(); ++k) sum += work[k] * costs[k];
    return sum;
}

/// How much each timed_work counts: less, the further it is off, once that is more than is usual.
std::vector<double> weights_of(std::span<const timed_work> seen, std::span<const double> costs) {
    constexpr double usual = 1.345;  // deviations: 95 % as efficient as least squares where errors are normal
    constexpr double deviations_a_median = 1.4826;
    constexpr double least_scale = 1e-9;
    std::vector<double> off;
    for (const timed_work& o : seen) off.push_back(std::abs(sum_of(o.work, costs) / median_of(o.ns) - 1));
    const double reach = usual * std::max(least_scale, deviations_a_median * median_of(off));
    std::vector<double> weights;
    for (const double one : off) weights.push_back(one <= reach ? 1 : reach / one);
    return weights;
}

normal_equations equations_of(std::span<const timed_work> seen, std::span<const double> weights) {
    const std::size_t count = seen.front().work.size();
    normal_equations all(count);
    for (std::size_t o = 0; o < seen.size(); ++o) {
        const double ns = median_of(seen[o].ns);
        for (std::size_t i = 0; i < count; ++i) {
            all.sums[i] += weights[o] * seen[o].work[i] / ns;
            for (std::size_t j = 0; j < count; ++j)
                all.products[i * count + j] += weights[o] * seen[o].work[i] * seen[o].work[j] / (ns * ns);
        }
    }
    return all;
}

/// The same as sums that are drawn anew. Scenes stand in the place of processes: what is drawn together.
class drawn_equations {
public:
    drawn_equations(std::span<const timed_work> seen, std::span<const double> weights)
        : count_(seen.front().work.size()) {
        std::map<std::string, std::vector<std::size_t>> scenes;
        for (std::size_t o = 0; o < seen.size(); ++o) scenes[seen[o].scene].push_back(o);
        size_ = {scenes.size(), 1, seen.front().ns.size()};
        sums_.assign(count_, cells(scenes.size(), 1));
        products_.assign(count_ * count_, cells(scenes.size(), 1));
        std::size_t scene = 0;
        for (const auto& [name, places] : scenes) {
            for (std::size_t repeat = 0; repeat < size_.repeats; ++repeat) {
                normal_equations own(count_);
                for (const std::size_t o : places) {
                    const double ns = seen[o].ns[repeat];
                    for (std::size_t i = 0; i < count_; ++i) {
                        own.sums[i] += weights[o] * seen[o].work[i] / ns;
                        for (std::size_t j = 0; j <= i; ++j)
                            own.products[i * count_ + j] += weights[o] * seen[o].work[i] * seen[o].work[j] / (ns * ns);
                    }
                }
                for (std::size_t i = 0; i < count_; ++i) {
                    sums_[i].add(scene, 0, own.sums[i]);
                    for (std::size_t j = 0; j <= i; ++j)
                        products_[i * count_ + j].add(scene, 0, own.products[i * count_ + j]);
                }
            }
            ++scene;
        }
    }

    [[nodiscard]] const sample_size& size() const { return size_; }
    [[nodiscard]] normal_equations draw(const resample& drawn) const {
        normal_equations all(count_);
        for (std::size_t i = 0; i < count_; ++i) {
            all.sums[i] = drawn.mean_of(sums_[i]);
            for (std::size_t j = 0; j <= i; ++j)
                all.products[i * count_ + j] = all.products[j * count_ + i] = drawn.mean_of(products_[i * count_ + j]);
        }
        return all;
    }

private:
    std::size_t count_;
    sample_size size_{};
    std::vector<cells> sums_;
    std::vector<cells> products_;  // below the diagonal, and on it
};

}  // namespace

std::vector<estimate> fit_costs(std::span<const timed_work> seen) {
    constexpr int rounds = 30;
    const std::size_t count = seen.front().work.size();
    std::vector<double> weights(seen.size(), 1.0);
    std::vector<double> costs(count, 0.0);
    for (int round = 0; round < rounds; ++round) {
        descend(equations_of(seen, weights), costs);
        weights = weights_of(seen, costs);
    }
    const drawn_equations equations(seen, weights);
    std::vector<estimate> all;
    for (std::size_t k = 0; k < count; ++k) {
        all.push_back(bootstrap(equations.size(), [&](const resample& drawn) {
            std::vector<double> found = costs;
            descend(equations.draw(drawn), found);
            return found[k];
        }));
        all.back().value = costs[k];
    }
    return all;
}

accuracy accuracy_of(std::span<const timed_work> seen, std::span<const estimate> costs) {
    std::vector<double> values;
    for (const estimate& one : costs) values.push_back(one.value);
    std::vector<double> ratios;
    for (const timed_work& o : seen) {
        const double ratio = sum_of(o.work, values) / median_of(o.ns);
        ratios.push_back(std::max(ratio, 1 / ratio));
    }
    if (ratios.empty()) return {};
    return {ratios.size(), median_of(ratios), std::ranges::max(ratios)};
}

}  // namespace aabblab
