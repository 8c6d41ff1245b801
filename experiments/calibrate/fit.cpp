module;
#include <Eigen/Core>

module aabblab.calibrate;

namespace aabblab {

namespace {

Eigen::Map<const Eigen::VectorXd> work_of(const timed_work& o) {
    return {o.work.data(), static_cast<Eigen::Index>(o.work.size())};
}

/// The normal equations of a least-squares problem: sums over observations of products of work, and of work.
struct normal_equations {
    explicit normal_equations(Eigen::Index count)
        : products(Eigen::MatrixXd::Zero(count, count)), sums(Eigen::VectorXd::Zero(count)) {}

    /// That the work took so long.
    void add(const timed_work& o, double ns, double weight) {
        const Eigen::VectorXd share = work_of(o) / ns;
        products += weight * share * share.transpose();
        sums += weight * share;
    }

    Eigen::MatrixXd products;
    Eigen::VectorXd sums;
};

/// Least squares with none below 0, by going down along one cost after the other from where they are.
void descend(const normal_equations& equations, Eigen::VectorXd& costs) {
    constexpr int most_rounds = 20'000;
    constexpr double near_enough = 1e-12;
    for (int round = 0; round < most_rounds; ++round) {
        double change = 0;
        double all = 0;
        for (Eigen::Index i = 0; i < costs.size(); ++i) {
            const double curvature = equations.products(i, i);
            if (!(curvature > 0)) continue;
            const double slope = equations.sums[i] - equations.products.col(i).dot(costs);
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

/// How much each observation counts: less, the further it is off, once that is more than is usual.
std::vector<double> weights_of(std::span<const timed_work> seen, const Eigen::VectorXd& costs) {
    constexpr double usual = 1.345;  // deviations: 95 % as efficient as least squares where errors are normal
    constexpr double deviations_a_median = 1.4826;
    constexpr double least_scale = 1e-9;
    std::vector<double> off;
    for (const timed_work& o : seen) off.push_back(std::abs(work_of(o).dot(costs) / median_of(o.ns) - 1));
    const double reach = usual * std::max(least_scale, deviations_a_median * median_of(off));
    std::vector<double> weights;
    for (const double one : off) weights.push_back(one <= reach ? 1 : reach / one);
    return weights;
}

/// The same as sums that are drawn anew. Scenes stand in the place of processes: what is drawn together.
class drawn_equations {
public:
    drawn_equations(std::span<const timed_work> seen, std::span<const double> weights)
        : count_(static_cast<Eigen::Index>(seen.front().work.size())) {
        std::map<std::string, std::vector<std::size_t>> scenes;
        for (std::size_t o = 0; o < seen.size(); ++o) scenes[seen[o].scene].push_back(o);
        size_ = {scenes.size(), 1, seen.front().ns.size()};
        sums_.assign(seen.front().work.size(), cells(scenes.size(), 1));
        products_.assign(seen.front().work.size() * seen.front().work.size(), cells(scenes.size(), 1));
        std::size_t scene = 0;
        for (const auto& [name, places] : scenes) {
            for (std::size_t repeat = 0; repeat < size_.repeats; ++repeat) {
                normal_equations own(count_);
                for (const std::size_t o : places) own.add(seen[o], seen[o].ns[repeat], weights[o]);
                for (Eigen::Index i = 0; i < count_; ++i) {
                    sums_[static_cast<std::size_t>(i)].add(scene, 0, own.sums[i]);
                    for (Eigen::Index j = 0; j <= i; ++j) products_[place(i, j)].add(scene, 0, own.products(i, j));
                }
            }
            ++scene;
        }
    }

    [[nodiscard]] const sample_size& size() const { return size_; }
    [[nodiscard]] normal_equations draw(const resample& drawn) const {
        normal_equations all(count_);
        for (Eigen::Index i = 0; i < count_; ++i) {
            all.sums[i] = drawn.mean_of(sums_[static_cast<std::size_t>(i)]);
            for (Eigen::Index j = 0; j <= i; ++j)
                all.products(i, j) = all.products(j, i) = drawn.mean_of(products_[place(i, j)]);
        }
        return all;
    }

private:
    [[nodiscard]] std::size_t place(Eigen::Index i, Eigen::Index j) const {
        return static_cast<std::size_t>(i * count_ + j);
    }

    Eigen::Index count_;
    sample_size size_{};
    std::vector<cells> sums_;
    std::vector<cells> products_;  // below the diagonal, and on it
};

}  // namespace

std::vector<estimate> fit_costs(std::span<const timed_work> seen) {
    constexpr int rounds = 30;
    const auto count = static_cast<Eigen::Index>(seen.front().work.size());
    std::vector<double> weights(seen.size(), 1.0);
    Eigen::VectorXd costs = Eigen::VectorXd::Zero(count);
    for (int round = 0; round < rounds; ++round) {
        normal_equations equations(count);
        for (std::size_t o = 0; o < seen.size(); ++o) equations.add(seen[o], median_of(seen[o].ns), weights[o]);
        descend(equations, costs);
        weights = weights_of(seen, costs);
    }
    const drawn_equations equations(seen, weights);
    std::vector<estimate> all;
    for (Eigen::Index k = 0; k < count; ++k) {
        all.push_back(bootstrap(equations.size(), [&](const resample& drawn) {
            Eigen::VectorXd found = costs;
            descend(equations.draw(drawn), found);
            return found[k];
        }));
        all.back().value = costs[k];
    }
    return all;
}

accuracy accuracy_of(std::span<const timed_work> seen, std::span<const estimate> costs) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(costs.size()));
    std::ranges::transform(costs, values.begin(), &estimate::value);
    std::vector<double> ratios;
    for (const timed_work& o : seen) {
        const double ratio = work_of(o).dot(values) / median_of(o.ns);
        ratios.push_back(std::max(ratio, 1 / ratio));
    }
    if (ratios.empty()) return {};
    return {ratios.size(), median_of(ratios), std::ranges::max(ratios)};
}

}  // namespace aabblab
