#include "core/effects/geometric_stiffening.hpp"

namespace pleuel {

GeometricStiffening::GeometricStiffening(
    std::string body, std::vector<StiffeningElement> elements, double damping,
    std::vector<DesignDerivative<std::vector<StiffeningDerivative>>> derivatives)
    : body_(std::move(body)),
      elements_(std::move(elements)),
      damping_(damping),
      derivatives_(std::move(derivatives)) {}

void GeometricStiffening::declare_entries(EntryList& entries) const {
  for (const StiffeningElement& element : elements_) {
    for (int row : element.coordinates) {
      for (int col : element.coordinates) entries.emplace_back(row, col);
    }
  }
}

void GeometricStiffening::evaluate(const StiffeningElement& element, const State& state) {
  const auto size = static_cast<Eigen::Index>(element.coordinates.size());
  strain_.q.resize(size);
  strain_.v.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    strain_.q(i) = state.q(element.coordinates[static_cast<std::size_t>(i)]);
    strain_.v(i) = state.v(element.coordinates[static_cast<std::size_t>(i)]);
  }
  strain_.gradient.noalias() = element.slopes * strain_.q;
  strain_.slope_v.noalias() = element.slopes * strain_.v;
  strain_.linear = element.elongation.dot(strain_.q);
  strain_.linear_rate = element.elongation.dot(strain_.v);
  strain_.total = strain_.linear + 0.5 * strain_.q.dot(strain_.gradient);
  strain_.total_rate = strain_.linear_rate + strain_.v.dot(strain_.gradient);
  strain_.gradient += element.elongation;
}

void GeometricStiffening::add_forces(const StiffeningElement& element,
                                     Eigen::VectorXd& residual) const {
  const double total = element.axial_stiffness * (strain_.total + damping_ * strain_.total_rate);
  const double linear = element.axial_stiffness * (strain_.linear + damping_ * strain_.linear_rate);
  for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    residual(element.coordinates[i]) +=
        total * strain_.gradient(k) - linear * element.elongation(k);
  }
}

void GeometricStiffening::add_residual(const State& state, ConstraintLevel,
                                       Eigen::VectorXd& residual) {
  for (const StiffeningElement& element : elements_) {
    evaluate(element, state);
    add_forces(element, residual);
  }
}

void GeometricStiffening::linearize(const State& state, const WeightList& weights, ConstraintLevel,
                                    Eigen::VectorXd& residual, const EntryBlocks& entries) {
  std::ptrdiff_t first = 0;
  for (const StiffeningElement& element : elements_) {
    evaluate(element, state);
    add_forces(element, residual);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      write_element(element, weights[i], entries.block(i) + first);
    }
    first += element.slopes.size();
  }
}

void GeometricStiffening::write_element(const StiffeningElement& element, const Weights& weights,
                                        double* entries) const {
  const double kappa = element.axial_stiffness;
  const double material = kappa * (weights.q + weights.v * damping_);
  const double geometric = weights.q * kappa * (strain_.total + damping_ * strain_.total_rate);
  const double rate = weights.q * kappa * damping_;
  const auto size = static_cast<Eigen::Index>(element.coordinates.size());
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      *entries++ = material * (strain_.gradient(i) * strain_.gradient(j) -
                               element.elongation(i) * element.elongation(j)) +
                   rate * strain_.gradient(i) * strain_.slope_v(j) +
                   geometric * element.slopes(i, j);
    }
  }
}

void GeometricStiffening::add_design_derivative(const State& state, ConstraintLevel,
                                                Eigen::MatrixXd& columns) {
  for (const auto& [variable, changes] : derivatives_) {
    for (const StiffeningDerivative& change : changes) {
      const StiffeningElement& element = elements_[static_cast<std::size_t>(change.element)];
      evaluate(element, state);
      const double kappa = element.axial_stiffness, d_kappa = change.axial_stiffness;
      const ElementVector d_slope_q = change.slopes * strain_.q;
      const double total = strain_.total + damping_ * strain_.total_rate;
      const double linear = strain_.linear + damping_ * strain_.linear_rate;
      const double d_total = 0.5 * strain_.q.dot(d_slope_q) + damping_ * strain_.v.dot(d_slope_q) +
                             change.damping * strain_.total_rate;
      for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double b = element.elongation(k);
        columns(element.coordinates[i], variable) +=
            d_kappa * (total * strain_.gradient(k) - linear * b) +
            kappa * (d_total * strain_.gradient(k) + total * d_slope_q(k) -
                     change.damping * strain_.linear_rate * b);
      }
    }
  }
}

int GeometricStiffening::design_sum_count() const {
  if (derivatives_.empty()) return 0;
  Eigen::Index count = 0;
  for (const StiffeningElement& element : elements_) count += sum_count(element);
  return static_cast<int>(count);
}

/// With m = μᵀ (b + Ĝ q), the force in add_design_derivative() read as a function of κ', β', Ĝ'.
void GeometricStiffening::add_design_sums(const State& state, ConstraintLevel,
                                          const ConstColumns& mu, Columns sums) {
  if (derivatives_.empty()) return;
  Eigen::Index first = 0;
  for (const StiffeningElement& element : elements_) {
    evaluate(element, state);
    const auto size = static_cast<Eigen::Index>(element.coordinates.size());
    const double kappa = element.axial_stiffness;
    const double total = strain_.total + damping_ * strain_.total_rate;
    const double linear = strain_.linear + damping_ * strain_.linear_rate;
    const ElementVector half = 0.5 * strain_.q + damping_ * strain_.v;
    ElementVector local(size);
    for (Eigen::Index i = 0; i < mu.cols(); ++i) {
      for (Eigen::Index k = 0; k < size; ++k) {
        local(k) = mu(element.coordinates[static_cast<std::size_t>(k)], i);
      }
      const double m = local.dot(strain_.gradient), b = local.dot(element.elongation);
      auto of_element = sums.col(i).segment(first, sum_count(element));
      of_element(0) += total * m - linear * b;
      of_element(1) += kappa * (strain_.total_rate * m - strain_.linear_rate * b);
      Eigen::Map<Eigen::MatrixXd>(of_element.data() + 2, size, size) +=
          kappa * (m * half + total * local) * strain_.q.transpose();
    }
    first += sum_count(element);
  }
}

void GeometricStiffening::add_design_gradients(const ConstColumns& sums,
                                               Eigen::MatrixXd& gradients) const {
  std::vector<Eigen::Index> first{0};
  for (const StiffeningElement& element : elements_) {
    first.push_back(first.back() + sum_count(element));
  }
  for (const auto& [variable, changes] : derivatives_) {
    for (const StiffeningDerivative& change : changes) {
      const Eigen::Index at = first[static_cast<std::size_t>(change.element)];
      const Eigen::Map<const Eigen::VectorXd> slopes(change.slopes.data(), change.slopes.size());
      gradients.row(variable) += change.axial_stiffness * sums.row(at) +
                                 change.damping * sums.row(at + 1) +
                                 slopes.transpose() * sums.middleRows(at + 2, slopes.size());
    }
  }
}

}  // namespace pleuel
