module;
#include <Eigen/Core>

module aabblab.calibrate;

namespace aabblab {

namespace {

Eigen::Map<const Eigen::VectorXd> work_of(const timed_work& o) {
    return {o.work.data(), static_cast<Eigen::Index>(o.work.size())};
}

/// The normal equations of a least-squares problem, accumulated over observations.
struct normal_equations {
    explicit normal_equations(Eigen::Index count)
        : products(Eigen::MatrixXd::Zero(count, count)), sums(Eigen::VectorXd::Zero(count)) {}

    /// Adds an observation; dividing by its time makes the residual relative.
    void add(const timed_work& o, double ns, double weight) {
        const Eigen::VectorXd share = work_of(o) / ns;
        products += weight * share * share.transpose();
        sums += weight * share;
    }

    Eigen::MatrixXd products;
    Eigen::VectorXd sums;
};

/// Improves costs to the least-squares solution with costs >= 0, by coordinate descent (Franc, Hlaváč and Navara 2005).
void descend(const normal_equations& equations, Eigen::VectorXd& costs) {
    constexpr int most_rounds = 20'000;
    constexpr double near_enough = 1e-12;
    for (int round = 0; round < most_rounds; ++round) {
        double change = 0, norm = 0;
        for (Eigen::Index i = 0; i < costs.size(); ++i) {
            const double curvature = equations.products(i, i);
            if (!(curvature > 0)) continue;
            const double slope = equations.sums[i] - equations.products.col(i).dot(costs);
            const double next = std::max(0.0, costs[i] + slope / curvature);
            // Weighting by curvature measures the change of the prediction, independent of the units of work.
            change += (next - costs[i]) * (next - costs[i]) * curvature;
            norm += next * next * curvature;
            costs[i] = next;
        }
        if (change <= near_enough * near_enough * norm) return;
    }
}

double median_of(std::vector<double> values) {
    return quartiles_of(std::move(values)).median;
}

/// Huber weights: 1 up to a threshold of the relative error of the predicted time, threshold / error beyond.
std::vector<double> weights_of(std::span<const timed_work> observations, const Eigen::VectorXd& costs) {
    constexpr double most_deviations = 1.345;         // standard deviations: 95 % efficient for normal errors
    constexpr double deviations_per_median = 1.4826;  // standard deviation over median of absolute normal errors
    constexpr double least_deviation = 1e-9;          // if most residuals are 0
    std::vector<double> residuals;
    for (const timed_work& o : observations) residuals.push_back(std::abs(work_of(o).dot(costs) / median_of(o.ns) - 1));
    const double threshold = most_deviations * std::max(least_deviation, deviations_per_median * median_of(residuals));
    std::vector<double> weights;
    for (const double r : residuals) weights.push_back(r <= threshold ? 1 : threshold / r);
    return weights;
}

/// Normal equations that can be bootstrapped. Whole scenes are resampled, in the role of processes.
class resampled_equations {
public:
    /// Sums up the normal equations of each scene and repeat; the bootstrap takes a scene as a process with one seed.
    resampled_equations(std::span<const timed_work> observations, std::span<const double> weights)
        : count_(static_cast<Eigen::Index>(observations.front().work.size())) {
        std::map<std::string, std::vector<std::size_t>> scenes;
        for (std::size_t o = 0; o < observations.size(); ++o) scenes[observations[o].scene].push_back(o);
        size_ = {.processes = scenes.size(), .seeds = 1, .repeats = observations.front().ns.size()};
        sums_.assign(observations.front().work.size(), cells(scenes.size(), /*seeds=*/1));
        products_.assign(observations.front().work.size() * observations.front().work.size(),
                         cells(scenes.size(), /*seeds=*/1));
        std::size_t scene = 0;
        for (const auto& [name, indices] : scenes) {
            for (std::size_t repeat = 0; repeat < size_.repeats; ++repeat) {
                normal_equations equations(count_);
                for (const std::size_t o : indices)
                    equations.add(observations[o], observations[o].ns[repeat], weights[o]);
                for (Eigen::Index i = 0; i < count_; ++i) {
                    sums_[static_cast<std::size_t>(i)].add(scene, /*seed=*/0, equations.sums[i]);
                    for (Eigen::Index j = 0; j <= i; ++j)
                        products_[index_of(i, j)].add(scene, /*seed=*/0, equations.products(i, j));
                }
            }
            ++scene;
        }
    }

    [[nodiscard]] const sample_size& size() const { return size_; }
    /// The normal equations of one resample: means over drawn scenes and repeats, stored on and below the diagonal.
    [[nodiscard]] normal_equations draw(const resample& drawn) const {
        normal_equations equations(count_);
        for (Eigen::Index i = 0; i < count_; ++i) {
            equations.sums[i] = drawn.mean_of(sums_[static_cast<std::size_t>(i)]);
            for (Eigen::Index j = 0; j <= i; ++j)
                equations.products(i, j) = equations.products(j, i) = drawn.mean_of(products_[index_of(i, j)]);
        }
        return equations;
    }

private:
    [[nodiscard]] std::size_t index_of(Eigen::Index i, Eigen::Index j) const {
        return static_cast<std::size_t>(i * count_ + j);
    }

    Eigen::Index count_;
    sample_size size_{};
    std::vector<cells> sums_;
    std::vector<cells> products_;  // on and below the diagonal
};

}  // namespace

/// Fits the costs of kinds of work, such that work times costs is near the measured times: by iteratively reweighted
/// least squares (Huber), in which outliers count less. The confidence intervals are from a bootstrap.
std::vector<estimate> fit_costs(std::span<const timed_work> observations) {
    constexpr int rounds = 30;
    const auto count = static_cast<Eigen::Index>(observations.front().work.size());
    std::vector<double> weights(observations.size(), 1.0);
    Eigen::VectorXd costs = Eigen::VectorXd::Zero(count);
    for (int round = 0; round < rounds; ++round) {
        normal_equations equations(count);
        for (std::size_t o = 0; o < observations.size(); ++o)
            equations.add(observations[o], median_of(observations[o].ns), weights[o]);
        descend(equations, costs);
        weights = weights_of(observations, costs);
    }
    const resampled_equations equations(observations, weights);
    std::vector<estimate> estimates;
    for (Eigen::Index k = 0; k < count; ++k) {
        estimates.push_back(bootstrap(equations.size(), [&](const resample& drawn) {
            Eigen::VectorXd resampled = costs;
            descend(equations.draw(drawn), resampled);
            return resampled[k];
        }));
        estimates.back().value = costs[k];
    }
    return estimates;
}

/// The factor, at least 1, by which times predicted with these costs are too long or too short: median and worst.
accuracy accuracy_of(std::span<const timed_work> observations, std::span<const estimate> costs) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(costs.size()));
    std::ranges::transform(costs, values.begin(), &estimate::value);
    std::vector<double> ratios;
    for (const timed_work& o : observations) {
        const double ratio = work_of(o).dot(values) / median_of(o.ns);
        ratios.push_back(std::max(ratio, 1 / ratio));
    }
    if (ratios.empty()) return {};
    return {ratios.size(), median_of(ratios), std::ranges::max(ratios)};
}

}  // namespace aabblab
