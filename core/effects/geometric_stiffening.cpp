#include "core/effects/geometric_stiffening.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

namespace pleuel {

namespace {

template <int Size>
using Vector = Eigen::Matrix<double, Size, 1>;

/// A vector to work with: on the stack where the compiler knows its length.
template <int Size>
auto working_vector(Eigen::VectorXd& scratch, Eigen::Index size) {
  if constexpr (Size == Eigen::Dynamic) {
    return Eigen::Map<Eigen::VectorXd>(scratch.data(), size);
  } else {
    return Vector<Size>();
  }
}

/// The first entries of a vector; where these are all, their number is known to the compiler, which
/// then calls no function for it.
template <int Size, class From>
void copy_head(const From& from, Eigen::Index size, double* to) {
  if constexpr (Size != Eigen::Dynamic) {
    if (size == Size) {
      Eigen::Map<Vector<Size>>(to, Size) = from;
      return;
    }
  }
  std::copy_n(from.data(), size, to);
}

template <int Size>
Eigen::Map<const Vector<Size>> column(const Eigen::MatrixXd& matrix, Eigen::Index i) {
  return {matrix.data() + i * matrix.rows(), matrix.rows()};
}

/// Sizes up to the largest of these are known to the compiler: elements of planar motion have six
/// coordinates, those of spatial motion twelve, those of reduced bodies any number.
constexpr std::array<Eigen::Index, 4> known_sizes = {6, 8, 12, 16};

Eigen::Index padded_size(Eigen::Index size) {
  for (const Eigen::Index known : known_sizes) {
    if (size <= known) return known;
  }
  return size;
}

/// Calls a function with the size as a constant.
template <class Function>
void with_known_size(Eigen::Index size, const Function& function) {
  switch (size) {
    case 6:
      return function(std::integral_constant<int, 6>());
    case 8:
      return function(std::integral_constant<int, 8>());
    case 12:
      return function(std::integral_constant<int, 12>());
    case 16:
      return function(std::integral_constant<int, 16>());
    default:
      return function(std::integral_constant<int, Eigen::Dynamic>());
  }
}

}  // namespace

GeometricStiffening::PaddedElement::PaddedElement(StiffeningElement element)
    : StiffeningElement(std::move(element)) {
  const Eigen::Index padded = padded_size(size());
  padded_elongation.setZero(padded);
  padded_elongation.head(size()) = elongation;
  padded_slopes.setZero(padded, padded);
  padded_slopes.topLeftCorner(size(), size()) = slopes;
}

GeometricStiffening::GeometricStiffening(
    std::string body, std::vector<StiffeningElement> elements, double damping,
    const std::vector<DesignDerivative<std::vector<StiffeningDerivative>>>& derivatives)
    : body_(std::move(body)),
      damping_(damping),
      changes_(elements.size()),
      is_designed_(!derivatives.empty()) {
  for (const auto& [variable, changes] : derivatives) {
    for (const StiffeningDerivative& change : changes) {
      changes_[change.element].push_back(
          {variable, change,
           change.damping != 0.0 || !change.elongation.isZero(0.0) || !change.slopes.isZero(0.0)});
    }
  }
  Eigen::Index largest = 0;
  for (StiffeningElement& element : elements) {
    elements_.emplace_back(std::move(element));
    largest = std::max(largest, elements_.back().padded_elongation.size());
  }
  for (Eigen::VectorXd* scratch : {&strain_.q, &strain_.v, &strain_.gradient, &strain_.slope_v,
                                   &unit_forces_, &row_, &column_, &bent_, &forces_}) {
    scratch->resize(largest);
  }
}

void GeometricStiffening::declare_entries(EntryList& entries) const {
  for (const PaddedElement& element : elements_) {
    for (int row : element.coordinates) {
      for (int col : element.coordinates) entries.emplace_back(row, col);
    }
  }
}

void GeometricStiffening::evaluate(const PaddedElement& element, const State& state) {
  with_known_size(element.padded_elongation.size(),
                  [&](auto size) { evaluate<decltype(size)::value>(element, state); });
}

template <int Size>
void GeometricStiffening::evaluate(const PaddedElement& element, const State& state) {
  const Eigen::Index padded = element.padded_elongation.size();
  auto q = working_vector<Size>(strain_.q, padded), v = working_vector<Size>(strain_.v, padded);
  auto slope_q = working_vector<Size>(strain_.gradient, padded);
  auto slope_v = working_vector<Size>(strain_.slope_v, padded);
  q.setZero();
  v.setZero();
  slope_q.setZero();
  slope_v.setZero();
  for (Eigen::Index i = 0; i < element.size(); ++i) {
    q(i) = state.q(element.coordinates[i]);
    v(i) = state.v(element.coordinates[i]);
    const auto slopes = column<Size>(element.padded_slopes, i);
    slope_q += q(i) * slopes;
    slope_v += v(i) * slopes;
  }
  const Eigen::Map<const Vector<Size>> elongation(element.padded_elongation.data(), padded);
  strain_.linear = elongation.dot(q);
  strain_.linear_rate = elongation.dot(v);
  strain_.total = strain_.linear + 0.5 * q.dot(slope_q);
  strain_.total_rate = strain_.linear_rate + v.dot(slope_q);
  strain_.q.head(padded) = q;
  strain_.v.head(padded) = v;
  strain_.gradient.head(padded) = elongation + slope_q;
  strain_.slope_v.head(padded) = slope_v;
}

void GeometricStiffening::set_unit_forces(const StiffeningElement& element) {
  const Eigen::Index size = element.elongation.size();
  unit_forces_.head(size) =
      (strain_.total + damping_ * strain_.total_rate) * strain_.gradient.head(size) -
      (strain_.linear + damping_ * strain_.linear_rate) * element.elongation;
}

void GeometricStiffening::add_forces(const StiffeningElement& element, Eigen::VectorXd& residual) {
  set_unit_forces(element);
  for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
    residual(element.coordinates[i]) += element.axial_stiffness * unit_forces_(i);
  }
}

void GeometricStiffening::add_residual(const State& state, ConstraintLevel,
                                       Eigen::VectorXd& residual) {
  for (const PaddedElement& element : elements_) {
    evaluate(element, state);
    add_forces(element, residual);
  }
}

void GeometricStiffening::linearize(const State& state, const WeightList& weights, ConstraintLevel,
                                    Eigen::VectorXd& residual, const EntryBlocks& entries) {
  std::ptrdiff_t first = 0;
  for (const PaddedElement& element : elements_) {
    evaluate(element, state);
    add_forces(element, residual);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      double* block = entries.block(i) + first;
      if (weights[i].q == 0.0 && weights[i].v == 0.0) {
        std::fill_n(block, element.slopes.size(), 0.0);
      } else {
        write_element(element, weights[i], block);
      }
    }
    first += element.slopes.size();
  }
}

void GeometricStiffening::write_element(const PaddedElement& element, const Weights& weights,
                                        double* entries) {
  with_known_size(element.padded_elongation.size(), [&](auto size) {
    write_element<decltype(size)::value>(element, weights, entries);
  });
}

template <int Size>
void GeometricStiffening::write_element(const PaddedElement& element, const Weights& weights,
                                        double* entries) {
  const double kappa = element.axial_stiffness;
  const double material = kappa * (weights.q + weights.v * damping_);
  const double geometric = weights.q * kappa * (strain_.total + damping_ * strain_.total_rate);
  const double rate = weights.q * kappa * damping_;
  const Eigen::Index padded = element.padded_elongation.size(), size = element.size();
  const Eigen::Map<const Vector<Size>> gradient(strain_.gradient.data(), padded),
      slope_v(strain_.slope_v.data(), padded), elongation(element.padded_elongation.data(), padded);
  auto row = working_vector<Size>(row_, padded),
       entries_of_row = working_vector<Size>(column_, padded);
  row = material * gradient + rate * slope_v;
  for (Eigen::Index i = 0; i < size; ++i) {  // Ĝ is symmetric
    entries_of_row = gradient(i) * row - (material * elongation(i)) * elongation +
                     geometric * column<Size>(element.padded_slopes, i);
    copy_head<Size>(entries_of_row, size, entries + i * size);
  }
}

void GeometricStiffening::add_design_derivative(const State& state, ConstraintLevel,
                                                Eigen::MatrixXd& columns) {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    if (changes_[e].empty()) continue;
    const PaddedElement& element = elements_[e];
    const Eigen::Index size = element.elongation.size();
    evaluate(element, state);
    set_unit_forces(element);
    for (const Change& change : changes_[e]) {
      forces_.head(size) = change.derivative.axial_stiffness * unit_forces_.head(size);
      if (change.is_of_shape) add_unit_change(element, change, element.axial_stiffness);
      for (std::size_t i = 0; i < element.coordinates.size(); ++i) {
        columns(element.coordinates[i], change.variable) += forces_(i);
      }
    }
  }
}

/// forces_ += factor (f/κ)'
void GeometricStiffening::add_unit_change(const StiffeningElement& element, const Change& change,
                                          double factor) {
  const StiffeningDerivative& d = change.derivative;
  const Eigen::Index size = element.elongation.size();
  const auto q = strain_.q.head(size), v = strain_.v.head(size);
  auto bent = bent_.head(size);
  bent.setZero();
  for (Eigen::Index i = 0; i < size; ++i) bent += q(i) * d.slopes.col(i);
  const double d_linear =
      d.elongation.dot(q) + damping_ * d.elongation.dot(v) + d.damping * strain_.linear_rate;
  const double d_total = d.elongation.dot(q) + 0.5 * q.dot(bent) +
                         damping_ * (d.elongation.dot(v) + v.dot(bent)) +
                         d.damping * strain_.total_rate;
  const double total = strain_.total + damping_ * strain_.total_rate;
  const double linear = strain_.linear + damping_ * strain_.linear_rate;
  forces_.head(size) += factor * (d_total * strain_.gradient.head(size) + total * bent +
                                  (total - linear) * d.elongation - d_linear * element.elongation);
}

int GeometricStiffening::parameter_adjoint_count() const {
  if (!is_designed_) return 0;
  Eigen::Index count = 0;
  for (const PaddedElement& element : elements_) count += sum_count(element);
  return static_cast<int>(count);
}

/// With m = μᵀ (b + Ĝ q), the force in add_design_derivative() read as a function of κ', β', b', Ĝ'.
void GeometricStiffening::add_parameter_adjoints(const State& state, ConstraintLevel,
                                                 const ConstColumns& mu, Columns sums) {
  if (!is_designed_) return;
  Eigen::Index first = 0;
  for (const PaddedElement& element : elements_) {
    evaluate(element, state);
    const Eigen::Index size = element.coordinates.size();
    const double kappa = element.axial_stiffness;
    const double total = strain_.total + damping_ * strain_.total_rate;
    const double linear = strain_.linear + damping_ * strain_.linear_rate;
    const auto q = strain_.q.head(size), v = strain_.v.head(size);
    auto local = row_.head(size), weighted = bent_.head(size);
    for (Eigen::Index i = 0; i < mu.cols(); ++i) {
      for (Eigen::Index k = 0; k < size; ++k) {
        local(k) = mu(element.coordinates[k], i);
      }
      const double m = local.dot(strain_.gradient.head(size)), b = local.dot(element.elongation);
      auto of_element = sums.col(i).segment(first, sum_count(element));
      of_element(0) += total * m - linear * b;
      of_element(1) += kappa * (strain_.total_rate * m - strain_.linear_rate * b);
      of_element.segment(2, size) +=
          kappa * ((m - b) * (q + damping_ * v) + (total - linear) * local);
      weighted = kappa * (m * (0.5 * q + damping_ * v) + total * local);
      Eigen::Map<Eigen::MatrixXd>(of_element.data() + 2 + size, size, size) +=
          weighted.lazyProduct(q.transpose());
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
      const Eigen::Index size = d.elongation.size();
      gradients.row(change.variable) +=
          d.axial_stiffness * sums.row(first) + d.damping * sums.row(first + 1) +
          d.elongation.transpose() * sums.middleRows(first + 2, size) +
          slopes.transpose() * sums.middleRows(first + 2 + size, slopes.size());
    }
    first += sum_count(elements_[e]);
  }
}

std::vector<QuadraticStrain> GeometricStiffening::strains() const {
  std::vector<QuadraticStrain> strains;
  for (const PaddedElement& element : elements_) {
    strains.push_back(
        {element.coordinates, element.elongation, element.slopes, element.axial_stiffness});
  }
  return strains;
}

}  // namespace pleuel
