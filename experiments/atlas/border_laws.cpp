module;
#include <Eigen/Dense>

module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Whether a law is fitted to this border: it is seen, and not beyond its scenes.
bool is_fitted(const border& b) {
    return !b.is_unseen && b.position > 0 && std::isfinite(b.position);
}

/// The number with enough digits to fit the law again.
std::string digits_of(double value) {
    return fmt::format("{:.6g}", value);
}

/// "0.0612345", or where the border lies if it is beyond its scenes.
std::string position_text(const border& b) {
    if (b.position == 0) return "below " + digits_of(b.played.low);
    return std::isfinite(b.position) ? digits_of(b.position) : "above " + digits_of(b.played.high);
}

/// The predicted position and its 95 % interval, as lengths or numbers instead of logarithms.
struct predicted_position {
    double value, low, high;
};
predicted_position prediction(const border_law& law, const border& b) {
    const estimate log = law.predicted(b.terms);
    return {std::exp(log.value), std::exp(log.range().low), std::exp(log.range().high)};
}

/// "ln displacement = -2.10 - 0.590 ln(1 + p) + 0.174 ln r"
std::string formula_of(const border_law& law) {
    std::string text = fmt::format("ln {} = {}", law.kind->parameter, three_digits(law.coefficients[0].value));
    for (std::size_t i = 1; i < law.coefficients.size(); ++i) {
        const double c = law.coefficients[i].value;
        text += fmt::format(" {} {} {}", c < 0 ? '-' : '+', three_digits(std::abs(c)), law.kind->terms[i - 1].name);
    }
    return text;
}

/// How a law's predictions compare with borders.
struct law_check {
    std::size_t fitted = 0, unseen = 0;
    std::size_t inside = 0;  ///< of the unseen ones
    double factor = 1;       ///< from a prediction to the end of its interval, the median over all borders
};
law_check check_of(const border_law& law) {
    law_check check;
    std::vector<double> factors;
    for (const border& b : law.borders) {
        const predicted_position p = prediction(law, b);
        factors.push_back(p.high / p.value);
        check.fitted += is_fitted(b);
        check.unseen += b.is_unseen;
        check.inside += b.is_unseen && law.contains(b);
    }
    check.factor = quartiles_of(factors).median;
    return check;
}

}  // namespace

/// For a new observation the variance of the prediction is s² (1 + x' (X'X)^-1 x), and Student's t has the degrees of
/// freedom of s² (Ross, "Introduction to Probability and Statistics for Engineers and Scientists", 9.10).
estimate border_law::predicted(std::span<const double> terms) const {
    const Eigen::VectorXd x = vector_of(terms);
    const auto count = static_cast<Eigen::Index>(terms.size());
    const Eigen::Map<const Eigen::MatrixXd> inverted(inverse.data(), count, count);
    double value = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) value += coefficients[i].value * terms[i];
    return {value, deviation * std::sqrt(1 + x.dot(inverted * x)), degrees};
}

bool border_law::contains(const border& b) const {
    const predicted_position p = prediction(*this, b);
    if (b.position == 0) return p.low < b.played.low;
    if (!std::isfinite(b.position)) return p.high > b.played.high;
    return p.low <= b.position && b.position <= p.high;
}

/// Ordinary least squares: there must be more borders than terms, and the terms must not depend on each other.
std::optional<border_law> law_of(const border_kind& kind, std::vector<border> borders) {
    const auto columns = static_cast<Eigen::Index>(kind.terms.size() + 1);
    const auto rows = static_cast<Eigen::Index>(std::ranges::count_if(borders, is_fitted));
    if (rows <= columns) return std::nullopt;
    Eigen::MatrixXd x(rows, columns);
    Eigen::VectorXd y(rows);
    Eigen::Index row = 0;
    for (const border& b : borders) {
        if (!is_fitted(b)) continue;
        x.row(row) = vector_of(b.terms);
        y[row++] = std::log(b.position);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(x);
    if (factors.rank() < columns) return std::nullopt;
    const Eigen::VectorXd coefficients = factors.solve(y);
    const Eigen::MatrixXd inverse = (x.transpose() * x).inverse();
    border_law law{.kind = &kind, .borders = std::move(borders), .degrees = static_cast<double>(rows - columns)};
    law.deviation = std::sqrt((y - x * coefficients).squaredNorm() / law.degrees);
    law.inverse.assign(inverse.data(), inverse.data() + inverse.size());
    for (Eigen::Index i = 0; i < columns; ++i)
        law.coefficients.push_back({coefficients[i], law.deviation * std::sqrt(inverse(i, i)), law.degrees});
    return law;
}

/// One sentence for terminals.
std::string sentence_of(const border_law& law) {
    const law_check check = check_of(law);
    return fmt::format(
        "{} is faster than {} up to {}, within a factor of {:.2f}. {} of {} unseen borders lie inside the prediction.",
        law.kind->before, law.kind->after, formula_of(law), check.factor, grouped(check.inside), grouped(check.unseen));
}

table laws_table(const std::vector<border_law>& laws) {
    table t = empty_table({"faster below", "faster above", "law"},
                          {"borders", "within a factor of", "unseen", "of these inside", "%"});
    for (const border_law& law : laws) {
        const law_check check = check_of(law);
        const double share = 100.0 * static_cast<double>(check.inside) / static_cast<double>(check.unseen);
        t.rows.push_back({law.kind->before, law.kind->after, formula_of(law), grouped(check.fitted),
                          fmt::format("{:.2f}", check.factor), grouped(check.unseen), grouped(check.inside),
                          check.unseen ? fmt::format("{:.0f}", share) : ""});
    }
    return t;
}

table coefficients_table(const std::vector<border_law>& laws) {
    table t = empty_table({"border", "term"}, {"coefficient", "low", "high"});
    for (const border_law& law : laws)
        for (std::size_t i = 0; i < law.coefficients.size(); ++i) {
            const estimate& c = law.coefficients[i];
            t.rows.push_back({law.kind->name, i == 0 ? "1" : law.kind->terms[i - 1].name,
                              fmt::format("{:.4g}", c.value), fmt::format("{:.4g}", c.range().low),
                              fmt::format("{:.4g}", c.range().high)});
        }
    return t;
}

table borders_table(const std::vector<border_law>& laws) {
    table t =
        empty_table({"border", "scenes", "along"}, {"at", "predicted", "low", "high"}, {"inside", "terms", "settings"});
    for (const border_law& law : laws)
        for (const border& b : law.borders) {
            const predicted_position p = prediction(law, b);
            std::string terms;
            for (std::size_t i = 1; i < b.terms.size(); ++i)  // the first is the constant
                terms += (terms.empty() ? "" : " ") + digits_of(b.terms[i]);
            t.rows.push_back({law.kind->name,
                              b.is_unseen    ? "unseen"
                              : is_fitted(b) ? "fitted"
                                             : "left out",
                              law.kind->parameter, position_text(b), digits_of(p.value), digits_of(p.low),
                              digits_of(p.high), law.contains(b) ? "yes" : "no", std::move(terms), b.settings});
        }
    return t;
}

/// Each border by its predicted and its measured position, and the line of equal ones with the prediction interval.
std::vector<figure> border_figures(const std::vector<border_law>& laws) {
    std::vector<figure> figures;
    for (const border_law& law : laws) {
        series line{.label = "as predicted, 95 %"};
        series fitted{.label = "fitted", .style = series_style::points};
        series unseen{.label = "unseen", .style = series_style::points};
        for (const border& b : law.borders) {
            const predicted_position p = prediction(law, b);
            line.points.push_back({p.value, p.value, p.low, p.high});
            // Positions beyond the scenes, 0 or infinite, are omitted by the drawing.
            (b.is_unseen ? unseen : fitted).points.push_back({p.value, b.position});
        }
        std::ranges::sort(line.points, {}, &figure_point::x);
        figures.push_back({.name = law.kind->name,
                           .caption = fmt::format(
                               "The {} up to which {} is faster than {}, in scenes to which the law was fitted and "
                               "in unseen ones.",
                               law.kind->parameter, law.kind->before, law.kind->after),
                           .x = {fmt::format("predicted {}", law.kind->parameter), /*logarithmic=*/true},
                           .y = {fmt::format("measured {}", law.kind->parameter), /*logarithmic=*/true},
                           .lines = {std::move(line), std::move(fitted), std::move(unseen)}});
    }
    return figures;
}

}  // namespace aabblab
