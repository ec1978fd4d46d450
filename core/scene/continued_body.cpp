#include "core/scene/continued_body.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_chart.hpp"

namespace pleuel {

namespace {

/// Numbers of a body about a place, with their derivatives by its coordinates.
struct Expansion {
  Eigen::VectorXd place;
  BodyConstants value;
  std::vector<BodyConstants> slopes;  ///< one a coordinate
};

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the largest eigenvalue of the normal equations: directions in which nothing is known.
constexpr double unknown = 1e-6;

/// Where B_ab of a symmetric matrix has its place among its numbers.
int packed_index(int a, int b) {
  return std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b);
}

/// The rows of B d = g for the numbers of B.
MatrixXd rows_of(const VectorXd& d) {
  const int n = int_size(d);
  MatrixXd rows = MatrixXd::Zero(n, n * (n + 1) / 2);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) rows(a, packed_index(a, b)) += d(b);
  }
  return rows;
}

/// The pseudo-inverse, of A with full rank or not.
MatrixXd pseudo_inverse(const MatrixXd& a) {
  const SymmetricModes modes = symmetric_modes(a.transpose() * a);
  VectorXd inverse = modes.values;
  const double least = unknown * modes.values.maxCoeff();
  for (double& value : inverse) value = value > least ? 1.0 / value : 0.0;
  return modes.vectors * inverse.asDiagonal() * modes.vectors.transpose() * a.transpose();
}

/// A function that has values and slopes of some expansions: a mean of their Taylor polynomials,
///     z(x) = Σ wⱼ (zⱼ + zⱼ′ (x − xⱼ) + ½ (x − xⱼ)ᵀ Bⱼ (x − xⱼ)),   wⱼ ∝ 1/|x − xⱼ|⁴,   Σ wⱼ = 1
/// (Shepard 1968; with derivatives Farwig 1986): the weights are flat at the places. The second
/// derivatives Bⱼ are the smallest that explain how slopes differ from place to place,
///     Bⱼ (xᵢ − xⱼ) = zᵢ′ − zⱼ′,
/// by least squares with weights 1/|xᵢ − xⱼ|⁴, as what third derivatives leave goes with the square of the
/// distance.
class ExpansionMean {
 public:
  /// @param expansions  at least one, at different places, of one arrangement
  explicit ExpansionMean(std::vector<Expansion> expansions) : expansions_(std::move(expansions)) {
    for (std::size_t j = 0; j < expansions_.size(); ++j) bends_.push_back(bends_of(j));
  }

  /// Value and slopes.
  Expansion at(const VectorXd& place) const {
    for (const Expansion& known : expansions_) {
      if (known.place == place) return known;
    }
    const Weights weights = weights_at(place);
    const BodyConstants zero = zero_constants(expansions_.front().value);
    Expansion sum{place, zero, std::vector<BodyConstants>(place.size(), zero)};
    for (int j = 0; j < int_size(expansions_); ++j) {
      const Expansion one = polynomial(static_cast<std::size_t>(j), place);
      add_constants(sum.value, weights.values(j), one.value);
      for (int a = 0; a < int_size(place); ++a) {
        add_constants(sum.slopes[a], weights.values(j), one.slopes[a]);
        add_constants(sum.slopes[a], weights.slopes(j, a), one.value);
      }
    }
    return sum;
  }

 private:
  /// B of an expansion: its columns, as derivatives of slopes.
  using Bends = std::vector<std::vector<BodyConstants>>;
  /// Weights and their slopes, expansions × coordinates.
  struct Weights {
    Eigen::VectorXd values;
    Eigen::MatrixXd slopes;
  };

  Bends bends_of(std::size_t expansion) const {
    const Expansion& here = expansions_[expansion];
    const int n = int_size(here.place), others = int_size(expansions_) - 1;
    if (others == 0 || n == 0) return {};
    MatrixXd rows(n * others, n * (n + 1) / 2);
    std::vector<BodyConstants> right;
    for (std::size_t i = 0; i < expansions_.size(); ++i) {
      if (i == expansion) continue;
      const VectorXd away = expansions_[i].place - here.place;
      const double weight = 1.0 / away.squaredNorm();
      rows.middleRows(int_size(right), n) = weight * rows_of(away);
      for (int a = 0; a < n; ++a) {
        right.push_back(zero_constants(here.value));
        add_constants(right.back(), weight, expansions_[i].slopes[a]);
        add_constants(right.back(), -weight, here.slopes[a]);
      }
    }
    const MatrixXd solution = pseudo_inverse(rows);
    Bends bends(n, std::vector<BodyConstants>(n, zero_constants(here.value)));
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        for (int r = 0; r < int_size(right); ++r) {
          add_constants(bends[a][b], solution(packed_index(a, b), r), right[r]);
        }
      }
    }
    return bends;
  }

  Weights weights_at(const VectorXd& place) const {
    const int count = int_size(expansions_);
    Weights weights{VectorXd(count), MatrixXd(count, place.size())};
    for (int j = 0; j < count; ++j) {
      const VectorXd away = place - expansions_[j].place;
      const double square = away.squaredNorm();
      weights.values(j) = 1.0 / (square * square);
      weights.slopes.row(j) = (-4.0 / square) * away.transpose();
    }
    weights.values /= weights.values.sum();
    const Eigen::RowVectorXd mean = weights.values.transpose() * weights.slopes;
    for (int j = 0; j < count; ++j) {
      weights.slopes.row(j) = weights.values(j) * (weights.slopes.row(j) - mean);
    }
    return weights;
  }

  Expansion polynomial(std::size_t expansion, const VectorXd& place) const {
    Expansion there = expansions_[expansion];
    const VectorXd away = place - there.place;
    const std::vector<BodyConstants> slopes = there.slopes;
    for (int a = 0; a < int_size(away); ++a) {
      add_constants(there.value, away(a), slopes[a]);
      if (bends_[expansion].empty()) continue;
      for (int b = 0; b < int_size(away); ++b) {
        add_constants(there.value, 0.5 * away(a) * away(b), bends_[expansion][a][b]);
        add_constants(there.slopes[a], away(b), bends_[expansion][a][b]);
      }
    }
    return there;
  }

  std::vector<Expansion> expansions_;
  std::vector<Bends> bends_;
};

using FilePointer = std::shared_ptr<const InvariantsFile>;

VectorXd values_of(const InvariantsFile& file) {
  VectorXd values(int_size(file.design));
  for (int i = 0; i < int_size(values); ++i) values(i) = file.design[i].value;
  return values;
}

class ContinuedBody : public BodySource {
 public:
  ContinuedBody(const std::string& made_by, std::vector<FilePointer> designs)
      : identity_(made_by), files_(std::move(designs)), chart_(files_.front()->constants) {
    unit_ = values_of(*files_.front()).cwiseAbs();
    for (double& one : unit_) one = one > 0.0 ? one : 1.0;
    is_positive_.assign(unit_.size(), true);
    for (const FilePointer& file : files_) {
      const VectorXd x = values_of(*file);
      for (int i = 0; i < int_size(x); ++i) {
        is_positive_[i] = is_positive_[i] && x(i) > 0.0;
        identity_ += fmt::format(" {}", x(i));
      }
    }
    std::vector<Expansion> logarithms, others;
    for (const FilePointer& file : files_) add_expansions(*file, logarithms, others);
    logarithms_ = std::make_unique<ExpansionMean>(std::move(logarithms));
    others_ = std::make_unique<ExpansionMean>(std::move(others));
  }

  std::string identity() const override { return identity_; }

  FilePointer at(const VectorXd& x) const override {
    for (const FilePointer& file : files_) {
      if (values_of(*file) == x) return file;
    }
    return std::make_shared<const InvariantsFile>(between(x));
  }

  double distance(const VectorXd& x) const override {
    double nearest = 1e300;
    for (const FilePointer& file : files_) {
      const VectorXd made = values_of(*file);
      double farthest = 0.0;
      for (int i = 0; i < int_size(x); ++i) {
        const double size = made(i) != 0.0 ? std::abs(made(i)) : 1.0;
        farthest = std::max(farthest, std::abs(x(i) - made(i)) / size);
      }
      nearest = std::min(nearest, farthest);
    }
    return nearest;
  }

 private:
  /// ξ = log x, or x as a multiple of its unit.
  VectorXd logarithmic_place(const VectorXd& x) const {
    VectorXd place = x.cwiseQuotient(unit_);
    for (int i = 0; i < int_size(x); ++i) {
      if (!is_positive_[i]) continue;
      if (!(x(i) > 0.0)) {
        throw SimulationError(
            fmt::format("a body cannot be continued from positive values of \"{}\" to {:.6g}",
                        files_.front()->design[i].variable, x(i)));
      }
      place(i) = std::log(place(i));
    }
    return place;
  }

  /// dx/dξ
  double stretch(const VectorXd& x, int i) const { return is_positive_[i] ? x(i) : unit_(i); }

  void add_expansions(const InvariantsFile& file, std::vector<Expansion>& logarithms,
                      std::vector<Expansion>& others) const {
    const VectorXd x = values_of(file);
    BodyConstants value = file.constants;
    std::vector<BodyConstants> slopes;
    for (const ConstantsDerivative& of : file.design) slopes.push_back(*of.derivative);
    chart_.change(BodyChart::Way::to_chart, value, slopes);
    Expansion& inside = logarithms.emplace_back(Expansion{logarithmic_place(x), value, {}});
    Expansion& outside = others.emplace_back(Expansion{x.cwiseQuotient(unit_), value, {}});
    BodyChart::scale(outside.value, 0.0);
    add_constants(inside.value, -1.0, outside.value);
    for (int i = 0; i < int_size(x); ++i) {
      BodyConstants other = slopes[i];
      BodyChart::scale(other, 0.0);
      add_constants(slopes[i], -1.0, other);
      inside.slopes.push_back(scaled(slopes[i], stretch(x, i)));
      outside.slopes.push_back(scaled(other, unit_(i)));
    }
  }

  static BodyConstants scaled(const BodyConstants& constants, double factor) {
    BodyConstants all = zero_constants(constants);
    add_constants(all, factor, constants);
    return all;
  }

  InvariantsFile between(const VectorXd& x) const {
    Expansion inside = logarithms_->at(logarithmic_place(x));
    const Expansion outside = others_->at(x.cwiseQuotient(unit_));
    chart_.change(BodyChart::Way::back, inside.value, inside.slopes);
    InvariantsFile file = *files_.front();
    file.surface.reset();  // nobody has seen it
    file.constants = outside.value;
    add_constants(file.constants, 1.0, inside.value);
    for (int i = 0; i < int_size(x); ++i) {
      file.design[i].value = x(i);
      file.design[i].derivative = scaled(outside.slopes[i], 1.0 / unit_(i));
      add_constants(*file.design[i].derivative, 1.0 / stretch(x, i), inside.slopes[i]);
    }
    return file;
  }

  std::string identity_;
  std::vector<FilePointer> files_;
  BodyChart chart_;
  VectorXd unit_;                  ///< of the variables: their values at the first design
  std::vector<bool> is_positive_;  ///< at all designs
  std::unique_ptr<ExpansionMean> logarithms_, others_;
};

}  // namespace

std::shared_ptr<const BodySource> continue_body(const std::string& made_by,
                                                std::vector<FilePointer> designs) {
  return std::make_shared<const ContinuedBody>(made_by, std::move(designs));
}

double stiffness_distance(const BodyConstants& a, const BodyConstants& b) {
  const VectorXd ratios = symmetric_eigenvalues(MatrixXd(a.stiffness), MatrixXd(b.stiffness));
  return ratios.array().log().abs().maxCoeff();
}

}  // namespace pleuel
