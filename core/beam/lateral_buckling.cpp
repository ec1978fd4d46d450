#include "core/beam/lateral_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/beam/beam_shape.hpp"

namespace pleuel {

namespace {

template <class Scalar>
using RowOf = Eigen::Matrix<Scalar, 1, 6>;
template <class Scalar>
using MatrixOf = Eigen::Matrix<Scalar, 6, 6>;

/// A beam whose stiffnesses in both planes differ by less is as stiff in both.
constexpr double equal_stiffness = 1e-9;

/// A row in w, θ, φ of both nodes.
template <class Scalar>
RowOf<Scalar> bending_row(const BendingRow<Scalar>& bending) {
  RowOf<Scalar> row = RowOf<Scalar>::Constant(Scalar(0));
  row(0) = bending[0];
  row(1) = bending[1];
  row(3) = bending[2];
  row(4) = bending[3];
  return row;
}
template <class Scalar>
RowOf<Scalar> twist_row(const Scalar& first, const Scalar& last) {
  RowOf<Scalar> row = RowOf<Scalar>::Constant(Scalar(0));
  row(2) = first;
  row(5) = last;
  return row;
}

/// K of an element, and G of unit entries of its load.
template <class Scalar>
struct ElementMatrices {
  MatrixOf<Scalar> elastic = MatrixOf<Scalar>::Constant(Scalar(0));
  std::array<MatrixOf<Scalar>, 4> geometric;

  ElementMatrices(const BeamElement<Scalar>& element, BendingPlane plane) {
    using std::sqrt;
    geometric.fill(elastic);
    const SectionProperties<Scalar>& section = element.section;
    const Scalar& length = element.length;
    const ElementForm<Scalar> form = form_of(element);
    const bool is_xy = plane == BendingPlane::xy;
    const Scalar& shear = is_xy ? form.shear_z : form.shear_y;
    const Scalar& compliance = is_xy ? element.shear_compliance_z : element.shear_compliance_y;
    const Scalar lateral = is_xy ? section.inertia_y : section.inertia_z;
    const Scalar bending = is_xy ? section.inertia_z : section.inertia_y;
    const Scalar left = 1.0 - lateral / bending;  // m²
    const Scalar m = value_of(left) > equal_stiffness ? Scalar(sqrt(left)) : Scalar(0);
    const Scalar polar = (section.inertia_y + section.inertia_z) / section.area;
    const Scalar slope_of_twist = 1.0 / length;
    const RowOf<Scalar> twist_slope = twist_row(Scalar(-slope_of_twist), slope_of_twist);
    for (const GaussPoint& point : gauss_points) {
      const Scalar weight = point.weight * length;
      const RowOf<Scalar> slope = bending_row(deflection(point.xi, length, shear, 1));
      const RowOf<Scalar> curvature = bending_row(deflection(point.xi, length, shear, 2));
      const RowOf<Scalar> twist = twist_row(Scalar(1.0 - point.xi), Scalar(point.xi));
      const MatrixOf<Scalar> twisting = twist_slope.transpose() * twist_slope;
      const MatrixOf<Scalar> coupling = twist.transpose() * curvature;
      elastic += weight * (element.young * lateral) * (curvature.transpose() * curvature) +
                 weight * (element.shear * section.torsion) * twisting;
      const MatrixOf<Scalar> of_axial =
          weight * (slope.transpose() * slope) + (weight * polar) * twisting;
      const MatrixOf<Scalar> of_moment = (weight * m) * (coupling + coupling.transpose());
      geometric[0] += (1.0 - point.xi) * of_axial;
      geometric[1] += point.xi * of_axial;
      geometric[2] += (1.0 - point.xi) * of_moment;
      geometric[3] += point.xi * of_moment;
    }
    if (value_of(compliance) == 0.0) return;
    const RowOf<Scalar> angle = bending_row(shear_angle(length, shear));
    elastic += (length / compliance) * (angle.transpose() * angle);
  }

  /// The nodal values of an end become those of the support of its rigid body, which carries N.
  /// @param end  0 or 1: the first or the last node
  void extend(int end, const RigidEnd& rigid) {
    const Eigen::Index w = 3 * end, slope = w + 1;
    const double moved = end == 0 ? rigid.pivot : -rigid.pivot;  // w = w_support + moved · w'
    const auto transform = [&](MatrixOf<Scalar>& matrix) {
      matrix.col(slope) += moved * matrix.col(w);
      matrix.row(slope) += moved * matrix.row(w);
    };
    transform(elastic);
    for (MatrixOf<Scalar>& matrix : geometric) transform(matrix);
    geometric[end](slope, slope) += rigid.reach;
  }
};

/// Those of an element of a beam with what its ends carry on with.
template <class Scalar>
ElementMatrices<Scalar> matrices_of(const Beam<Scalar>& beam, Eigen::Index element,
                                    BendingPlane plane, const RigidEnds& ends) {
  ElementMatrices<Scalar> matrices(beam.elements[element], plane);
  if (element == 0) matrices.extend(0, ends[0]);
  if (element + 1 == std::ssize(beam.elements)) matrices.extend(1, ends[1]);
  return matrices;
}

Eigen::Index first_row(Eigen::Index element) {
  return 3 * element;
}

}  // namespace

LateralBuckling::LateralBuckling(const Beam<double>& beam, BendingPlane plane,
                                 std::vector<LateralSupport> supports, const RigidEnds& ends)
    : plane_(plane), supports_(std::move(supports)), ends_(ends) {
  double lateral = std::numeric_limits<double>::infinity(), twisting = lateral;
  for (const BeamElement<double>& element : beam.elements) {
    const auto matrices = matrices_of(beam, std::ssize(elastic_), plane, ends);
    elastic_.push_back(matrices.elastic);
    geometric_.push_back(matrices.geometric);
    const SectionProperties<double>& s = element.section;
    const double inertia = plane == BendingPlane::xy ? s.inertia_y : s.inertia_z;
    lateral = std::min(lateral, element.young * inertia);
    twisting = std::min(twisting, element.shear * s.torsion);
  }
  const double wave = std::numbers::pi / beam.node_position(beam.node_count() - 1);
  critical_press_ = wave * wave * lateral;
  critical_moment_ = wave * std::sqrt(lateral * twisting);
  is_held_ = hold();
  if (is_held_) return;
  supports_.front().twist = true;
  is_held_ = hold();
}

/// @returns whether the supports do
bool LateralBuckling::hold() {
  rows_.clear();
  Eigen::Index size = 0;
  for (const LateralSupport& support : supports_) {
    for (const bool is_fixed : {support.deflection, support.slope, support.twist}) {
      rows_.push_back(is_fixed ? -1 : size++);
    }
  }
  const auto for_free = [&](std::size_t e, const auto& use) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        const Eigen::Index row = rows_[3 * e + static_cast<std::size_t>(i)],
                           column = rows_[3 * e + static_cast<std::size_t>(j)];
        if (row >= 0 && column >= 0) use(row, column, i, j);
      }
    }
  };
  Band stiffness = Band::Zero(6, size);
  for (std::size_t e = 0; e < elastic_.size(); ++e) {
    for_free(e, [&](Eigen::Index row, Eigen::Index column, Eigen::Index i, Eigen::Index j) {
      stiffness(row - column, column) += elastic_[e](i, j);
    });
  }
  scale_ = stiffness.row(0).cwiseSqrt().cwiseInverse().transpose();
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index d = 0; d < std::min<Eigen::Index>(6, size - j); ++d) {
      stiffness(d, j) *= scale_(j) * scale_(j + d);
    }
  }
  entries_.clear();
  for (std::size_t e = 0; e < geometric_.size(); ++e) {
    for_free(e, [&](Eigen::Index row, Eigen::Index column, Eigen::Index i, Eigen::Index j) {
      BandEntry entry{static_cast<Eigen::Index>(e), row, column, {}};
      for (std::size_t k = 0; k < 4; ++k) {
        entry.of_load(k) = -geometric_[e][k](i, j) * scale_(row) * scale_(column);
      }
      if (!entry.of_load.isZero(0.0)) entries_.push_back(entry);
    });
  }
  destabilizing_.resize(6, size);
  largest_ = LargestBandMode(stiffness);
  if (size == 0) return true;
  constexpr double singular = 1e-12;
  BandFactors factors;
  return factors.factorize(stiffness) && factors.least_pivot() > singular;
}

void LateralBuckling::set_destabilizing(const PlaneLoad& load) {
  destabilizing_.setZero();
  for (const BandEntry& entry : entries_) {
    destabilizing_(entry.row - entry.column, entry.column) +=
        entry.of_load.dot(load.col(entry.element));
  }
}

/// Of the share, by the closed forms of simple supports.
double LateralBuckling::size_of(const PlaneLoad& load) const {
  return load.topRows<2>().cwiseAbs().maxCoeff() / critical_press_ +
         load.bottomRows<2>().cwiseAbs().maxCoeff() / critical_moment_;
}

double LateralBuckling::share(const PlaneLoad& load, double least) {
  set_destabilizing(load);
  return largest_.value(destabilizing_, size_of(load), least);
}

LateralModes LateralBuckling::modes(const PlaneLoad& load) {
  LateralModes modes;
  modes.share = share(load);
  if (!(modes.share > 0.0)) return modes;
  const Eigen::MatrixXd free = scale_.asDiagonal() * largest_.vectors();
  modes.shapes.setZero(rows_.size(), free.cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i] >= 0) modes.shapes.row(i) = free.row(rows_[i]);
  }
  return modes;
}

PlaneLoad LateralBuckling::load_slopes(const LateralModes& modes) const {
  PlaneLoad slopes = PlaneLoad::Zero(4, geometric_.size());
  for (Eigen::Index e = 0; e < slopes.cols(); ++e) {
    for (const auto& shape : modes.shapes.colwise()) {
      const Eigen::Matrix<double, 6, 1> moved = shape.segment<6>(first_row(e));
      for (Eigen::Index k = 0; k < 4; ++k) {
        const Matrix6& unit = geometric_[e][k];
        slopes(k, e) -= moved.dot(unit * moved) / static_cast<double>(modes.shapes.cols());
      }
    }
  }
  return slopes;
}

double LateralBuckling::design_slope(const Beam<Dual>& beam, const PlaneLoad& load,
                                     const LateralModes& modes) const {
  double slope = 0.0;
  for (Eigen::Index e = 0; e < load.cols(); ++e) {
    const auto matrices = matrices_of(beam, e, plane_, ends_);
    Matrix6 change = modes.share * derivative_matrix(matrices.elastic);
    for (Eigen::Index k = 0; k < 4; ++k) {
      change += load(k, e) * derivative_matrix(matrices.geometric[k]);
    }
    for (const auto& shape : modes.shapes.colwise()) {
      const Eigen::Matrix<double, 6, 1> moved = shape.segment<6>(first_row(e));
      slope -= moved.dot(change * moved) / static_cast<double>(modes.shapes.cols());
    }
  }
  return slope;
}

/// With A = share K + G of the element: ∂A/∂reach has N at the slope alone; as ∂T/∂pivot = T E with
/// E² = 0, ∂A/∂pivot = Eᵀ A + A E, where E makes a deflection of the slope.
RigidEnds LateralBuckling::end_slopes(const PlaneLoad& load, const LateralModes& modes) const {
  RigidEnds slopes;
  for (Eigen::Index end = 0; end < 2; ++end) {
    const Eigen::Index e = end == 0 ? 0 : load.cols() - 1, w = 3 * end;
    Matrix6 change = modes.share * elastic_[e];
    for (Eigen::Index k = 0; k < 4; ++k) change += load(k, e) * geometric_[e][k];
    for (const auto& shape : modes.shapes.colwise()) {
      const Eigen::Matrix<double, 6, 1> moved = shape.segment<6>(first_row(e));
      const double weight = moved(w + 1) / static_cast<double>(modes.shapes.cols());
      slopes[end].reach -= weight * load(end, e) * moved(w + 1);
      slopes[end].pivot -= (end == 0 ? 2.0 : -2.0) * weight * change.row(w).dot(moved);
    }
  }
  return slopes;
}

}  // namespace pleuel
