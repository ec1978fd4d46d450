#include "core/effects/geometric_stiffening.hpp"

#include <algorithm>

namespace pleuel {

GeometricStiffening::GeometricStiffening(
    std::string body, std::vector<StiffeningElement> elements, double damping,
    const std::vector<DesignDerivative<std::vector<StiffeningDerivative>>>& derivatives)
    : body_(std::move(body)),
      elements_(std::move(elements)),
      damping_(damping),
      changes_(elements_.size()),
      is_designed_(!derivatives.empty()) {
  for (const auto& [variable, changes] : derivatives) {
    for (const StiffeningDerivative& change : changes) {
      changes_[static_cast<std::size_t>(change.element)].push_back(
          {variable, change, change.damping != 0.0 || !change.slopes.isZero(0.0)});
    }
  }
}

void GeometricStiffening::declare_entries(EntryList& entries) const {
  for (const StiffeningElement& element : elements_) {
    for (int row : element.coordinates) {
      for (int col : element.coordinates) entries.emplace_back(row, col);
    }
  }
}

void GeometricStiffening::evaluate(const StiffeningElement& element, const State& state) {
  if (element.coordinates.size() == 6) {
    evaluate<6>(element, state);  // planar motion
  } else {
    evaluate<Eigen::Dynamic>(element, state);
  }
}

/// `Size` is the number of coordinates where the compiler may know it.
template <int Size>
void GeometricStiffening::evaluate(const StiffeningElement& element, const State& state) {
  constexpr int most = Size == Eigen::Dynamic ? 12 : Size;
  using Vector = Eigen::Matrix<double, Size, 1, 0, most, 1>;
  const auto size = static_cast<Eigen::Index>(element.coordinates.size());
  Vector q(size), v(size), slope_q = Vector::Zero(size), slope_v = slope_q;
  for (Eigen::Index i = 0; i < size; ++i) {
    q(i) = state.q(element.coordinates[static_cast<std::size_t>(i)]);
    v(i) = state.v(element.coordinates[static_cast<std::size_t>(i)]);
    const Eigen::Map<const Vector> slopes(element.slopes.data() + i * size, size);
    slope_q += q(i) * slopes;
    slope_v += v(i) * slopes;
  }
  const Vector elongation = element.elongation;
  strain_.linear = elongation.dot(q);
  strain_.linear_rate = elongation.dot(v);
  strain_.total = strain_.linear + 0.5 * q.dot(slope_q);
  strain_.total_rate = strain_.linear_rate + v.dot(slope_q);
  strain_.q = q;
  strain_.v = v;
  strain_.gradient = elongation + slope_q;
  strain_.slope_v = slope_v;
}

/// f/κ
ElementVector GeometricStiffening::unit_forces(const StiffeningElement& element) const {
  return (strain_.total + damping_ * strain_.total_rate) * strain_.gradient -
         (strain_.linear + damping_ * strain_.linear_rate) * element.elongation;
}

void GeometricStiffening::add_forces(const StiffeningElement& element,
                                     Eigen::VectorXd& residual) const {
  const ElementVector forces = element.axial_stiffness * unit_forces(element);
  for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
    residual(element.coordinates[i]) += forces(static_cast<Eigen::Index>(i));
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
      double* block = entries.block(i) + first;
      if (weights[i].q == 0.0 && weights[i].v == 0.0) {
        std::fill_n(block, element.slopes.size(), 0.0);
      } else if (element.coordinates.size() == 6) {
        write_element<6>(element, weights[i], block);  // planar motion
      } else {
        write_element<Eigen::Dynamic>(element, weights[i], block);
      }
    }
    first += element.slopes.size();
  }
}

template <int Size>
void GeometricStiffening::write_element(const StiffeningElement& element, const Weights& weights,
                                        double* entries) const {
  using Vector = Eigen::Matrix<double, Size, 1, 0, Size == Eigen::Dynamic ? 12 : Size, 1>;
  const double kappa = element.axial_stiffness;
  const double material = kappa * (weights.q + weights.v * damping_);
  const double geometric = weights.q * kappa * (strain_.total + damping_ * strain_.total_rate);
  const double rate = weights.q * kappa * damping_;
  const Eigen::Index size = element.slopes.rows();
  const Vector row = material * strain_.gradient + rate * strain_.slope_v;
  const Vector elongation = element.elongation;
  for (Eigen::Index i = 0; i < size; ++i) {  // Ĝ is symmetric
    Eigen::Map<Vector>(entries + i * size, size) =
        strain_.gradient(i) * row - (material * elongation(i)) * elongation +
        geometric * Eigen::Map<const Vector>(element.slopes.data() + i * size, size);
  }
}

void GeometricStiffening::add_design_derivative(const State& state, ConstraintLevel,
                                                Eigen::MatrixXd& columns) {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    if (changes_[e].empty()) continue;
    const StiffeningElement& element = elements_[e];
    evaluate(element, state);
    const ElementVector unit = unit_forces(element);
    for (const Change& change : changes_[e]) {
      ElementVector forces = change.derivative.axial_stiffness * unit;
      if (change.is_of_shape) forces += element.axial_stiffness * unit_change(element, change);
      for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
        columns(element.coordinates[i], change.variable) += forces(static_cast<Eigen::Index>(i));
      }
    }
  }
}

/// The derivative of f/κ.
ElementVector GeometricStiffening::unit_change(const StiffeningElement& element,
                                               const Change& change) const {
  const StiffeningDerivative& d = change.derivative;
  const ElementVector d_slope_q = d.slopes.lazyProduct(strain_.q);
  const double d_total = 0.5 * strain_.q.dot(d_slope_q) + damping_ * strain_.v.dot(d_slope_q) +
                         d.damping * strain_.total_rate;
  return d_total * strain_.gradient + (strain_.total + damping_ * strain_.total_rate) * d_slope_q -
         (d.damping * strain_.linear_rate) * element.elongation;
}

int GeometricStiffening::design_sum_count() const {
  if (!is_designed_) return 0;
  Eigen::Index count = 0;
  for (const StiffeningElement& element : elements_) count += sum_count(element);
  return static_cast<int>(count);
}

/// With m = μᵀ (b + Ĝ q), the force in add_design_derivative() read as a function of κ', β', Ĝ'.
void GeometricStiffening::add_design_sums(const State& state, ConstraintLevel,
                                          const ConstColumns& mu, Columns sums) {
  if (!is_designed_) return;
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
  Eigen::Index first = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    for (const Change& change : changes_[e]) {
      const StiffeningDerivative& d = change.derivative;
      const Eigen::Map<const Eigen::VectorXd> slopes(d.slopes.data(), d.slopes.size());
      gradients.row(change.variable) +=
          d.axial_stiffness * sums.row(first) + d.damping * sums.row(first + 1) +
          slopes.transpose() * sums.middleRows(first + 2, slopes.size());
    }
    first += sum_count(elements_[e]);
  }
}

std::vector<QuadraticStrain> GeometricStiffening::strains() const {
  std::vector<QuadraticStrain> strains;
  for (const StiffeningElement& element : elements_) {
    strains.push_back(
        {element.coordinates, element.elongation, element.slopes, element.axial_stiffness});
  }
  return strains;
}

}  // namespace pleuel
