#include "core/scene/continued_body.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

using FilePointer = std::shared_ptr<const InvariantsFile>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SparseMatrix sparse_of_dense(const MatrixXd& matrix) {
  return matrix.sparseView(1.0, 0.0);
}

/// f(A) of a symmetric A = V diag(λ) Vᵀ, and its derivative V (f[λᵢ, λⱼ] ∘ VᵀA′V) Vᵀ with the divided
/// differences of f (Daleckii & Krein 1965).
class MatrixFunction {
 public:
  enum class Kind { logarithm, exponential };

  MatrixFunction(Kind kind, const MatrixXd& matrix)
      : kind_(kind),
        modes_(symmetric_modes(matrix)),
        values_(modes_.values.unaryExpr(
            [kind](double x) { return kind == Kind::logarithm ? std::log(x) : std::exp(x); })) {}

  MatrixXd value() const {
    return MatrixXd(modes_.vectors * values_.asDiagonal()) * modes_.vectors.transpose();
  }

  MatrixXd derivative(const MatrixXd& change) const {
    MatrixXd inner = modes_.vectors.transpose() * change * modes_.vectors;
    for (int i = 0; i < int_size(values_); ++i) {
      for (int j = 0; j < int_size(values_); ++j) inner(i, j) *= divided_difference(i, j);
    }
    return modes_.vectors * inner * modes_.vectors.transpose();
  }

 private:
  double divided_difference(int i, int j) const {
    const double a = modes_.values(i), b = modes_.values(j);
    if (std::abs(a - b) > 1e-5 * (std::abs(a) + std::abs(b))) {
      return (values_(i) - values_(j)) / (a - b);
    }
    const double middle = 0.5 * (a + b);  // to second order
    return kind_ == Kind::logarithm ? 1.0 / middle : std::exp(middle);
  }

  Kind kind_;
  SymmetricModes modes_;
  VectorXd values_;
};

/// S with S Kᵢᵢ S = 1.
VectorXd scales_of(const MatrixXd& matrix) {
  return matrix.diagonal().cwiseSqrt().cwiseInverse();
}

MatrixXd scaled_both_ways(const VectorXd& s, const MatrixXd& matrix) {
  return s.asDiagonal() * matrix * s.asDiagonal();
}

/// The constants with what has to stay positive as logarithms, and back.
class Chart {
 public:
  using Kind = MatrixFunction::Kind;

  explicit Chart(const BodyConstants& first) {
    add_scales(first.stiffness);
    if (Cholesky(MatrixXd(first.damping)).is_positive_definite()) add_scales(first.damping);
  }

  /// Multiplies what is a logarithm.
  void scale(BodyConstants& constants, double factor) const {
    for (std::size_t m = 0; m < scales_.size(); ++m) constants.*member(m) *= factor;
    if (!constants.stretching) return;
    for (StretchedElement& element : constants.stretching->elements) {
      element.axial_stiffness *= factor;
    }
  }

  void take_logarithms(BodyConstants& constants, std::vector<BodyConstants>& derivatives) const {
    for (std::size_t m = 0; m < scales_.size(); ++m) {
      change(Kind::logarithm, member(m), scales_[m], constants, derivatives);
    }
    change_axial(
        constants, derivatives, [](double k) { return std::log(k); },
        [](double k) { return 1.0 / k; });
  }

  void take_exponentials(BodyConstants& constants, std::vector<BodyConstants>& derivatives) const {
    for (std::size_t m = 0; m < scales_.size(); ++m) {
      change(Kind::exponential, member(m), scales_[m], constants, derivatives);
    }
    change_axial(
        constants, derivatives, [](double z) { return std::exp(z); },
        [](double z) { return std::exp(z); });
  }

 private:
  using Member = SparseMatrix BodyConstants::*;

  static Member member(std::size_t m) {
    return m == 0 ? &BodyConstants::stiffness : &BodyConstants::damping;
  }

  void add_scales(const SparseMatrix& matrix) { scales_.push_back(scales_of(MatrixXd(matrix))); }

  static void change(Kind kind, Member which, const VectorXd& scale, BodyConstants& constants,
                     std::vector<BodyConstants>& derivatives) {
    const bool is_logarithm = kind == Kind::logarithm;
    const VectorXd back = scale.cwiseInverse();
    const auto before = [&](const SparseMatrix& of) {
      return is_logarithm ? scaled_both_ways(scale, MatrixXd(of)) : MatrixXd(of);
    };
    const auto after = [&](const MatrixXd& of) {
      return sparse_of_dense(is_logarithm ? of : scaled_both_ways(back, of));
    };
    const MatrixFunction function(kind, before(constants.*which));
    for (BodyConstants& one : derivatives) {
      one.*which = after(function.derivative(before(one.*which)));
    }
    constants.*which = after(function.value());
  }

  template <class Function, class Slope>
  static void change_axial(BodyConstants& constants, std::vector<BodyConstants>& derivatives,
                           const Function& function, const Slope& slope) {
    if (!constants.stretching) return;
    for (std::size_t e = 0; e < constants.stretching->elements.size(); ++e) {
      double& value = constants.stretching->elements[e].axial_stiffness;
      for (BodyConstants& one : derivatives) {
        one.stretching->elements[e].axial_stiffness *= slope(value);
      }
      value = function(value);
    }
  }

  std::vector<VectorXd> scales_;  ///< of stiffness, and of damping if it is positive definite
};

class ContinuedBody : public BodySource {
 public:
  explicit ContinuedBody(std::vector<FilePointer> designs)
      : files_(std::move(designs)), chart_(files_.front()->constants) {
    const int count = int_size(files_.front()->design);
    is_logarithmic_.assign(count, true);
    for (const FilePointer& file : files_) {
      for (int i = 0; i < count; ++i) {
        is_logarithmic_[i] = is_logarithmic_[i] && file->design[i].value > 0.0;
      }
    }
    for (const FilePointer& file : files_) expansions_.push_back(expansion_of(*file));
  }

  FilePointer at(const VectorXd& values) const override {
    const VectorXd place = place_of(values);
    for (std::size_t j = 0; j < files_.size(); ++j) {
      if ((place - expansions_[j].place).norm() < 1e-12) return files_[j];
    }
    return std::make_shared<const InvariantsFile>(between(values, place));
  }

  double distance(const VectorXd& values) const override {
    double nearest = 1e300;
    for (const FilePointer& file : files_) {
      double farthest = 0.0;
      for (int i = 0; i < int_size(values); ++i) {
        const double made = file->design[i].value;
        farthest =
            std::max(farthest, std::abs(values(i) - made) / (made != 0.0 ? std::abs(made) : 1.0));
      }
      nearest = std::min(nearest, farthest);
    }
    return nearest;
  }

 private:
  /// Of a body in the chart, with its derivatives by x.
  struct Expansion {
    VectorXd place;
    BodyConstants value;
    std::vector<BodyConstants> slopes;
  };

  /// Weights and their derivatives by ξ, designs × variables.
  struct Weights {
    VectorXd values;
    MatrixXd slopes;
  };

  VectorXd place_of(const VectorXd& values) const {
    VectorXd place = values;
    for (int i = 0; i < int_size(values); ++i) {
      if (!is_logarithmic_[i]) continue;
      if (!(values(i) > 0.0)) {
        throw SimulationError(
            fmt::format("a body cannot be continued from positive values of \"{}\" "
                        "to {:.6g}",
                        files_.front()->design[i].variable, values(i)));
      }
      place(i) = std::log(values(i));
    }
    return place;
  }

  Expansion expansion_of(const InvariantsFile& file) const {
    Expansion expansion{VectorXd(int_size(file.design)), file.constants, {}};
    for (int i = 0; i < int_size(file.design); ++i) {
      const ConstantsDerivative& of = file.design[i];
      expansion.place(i) = is_logarithmic_[i] ? std::log(of.value) : of.value;
      expansion.slopes.push_back(*of.derivative);
    }
    chart_.take_logarithms(expansion.value, expansion.slopes);
    return expansion;
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

  /// A derivative of what is a line in x, or of logarithms in log x: these times a factor.
  BodyConstants with_logarithms_times(double factor, BodyConstants slope) const {
    chart_.scale(slope, factor);
    return slope;
  }

  /// The Taylor expansion about a design, and its derivatives by x.
  BodyConstants tangent_at(std::size_t design, const VectorXd& values, const VectorXd& place,
                           std::vector<BodyConstants>& slopes) const {
    const Expansion& from = expansions_[design];
    BodyConstants tangent = from.value;
    for (int i = 0; i < int_size(values); ++i) {
      const double made = files_[design]->design[i].value, away = values(i) - made;
      // x₀ (log x − log x₀) in place of x − x₀, and its derivative x₀/x.
      const double ratio =
          is_logarithmic_[i] && away != 0.0 ? made * (place(i) - from.place(i)) / away : 1.0;
      const double slope_ratio = is_logarithmic_[i] ? made / values(i) : 1.0;
      add_constants(tangent, away, with_logarithms_times(ratio, from.slopes[i]));
      slopes.push_back(with_logarithms_times(slope_ratio, from.slopes[i]));
    }
    return tangent;
  }

  InvariantsFile between(const VectorXd& values, const VectorXd& place) const {
    const Weights weights = weights_at(place);
    const int count = int_size(values);
    BodyConstants sum = zero_constants(expansions_.front().value);
    std::vector<BodyConstants> slopes(count, sum);
    for (std::size_t j = 0; j < expansions_.size(); ++j) {
      const int row = static_cast<int>(j);
      std::vector<BodyConstants> own;
      const BodyConstants tangent = tangent_at(j, values, place, own);
      add_constants(sum, weights.values(row), tangent);
      for (int i = 0; i < count; ++i) {
        const double slope = weights.slopes(row, i) / (is_logarithmic_[i] ? values(i) : 1.0);
        add_constants(slopes[i], weights.values(row), own[i]);
        add_constants(slopes[i], slope, tangent);
      }
    }
    chart_.take_exponentials(sum, slopes);
    return file_of(values, std::move(sum), std::move(slopes));
  }

  InvariantsFile file_of(const VectorXd& values, BodyConstants constants,
                         std::vector<BodyConstants> slopes) const {
    if (!(constants.mass > 0.0) ||
        !Cholesky(MatrixXd(constants.mass_matrix)).is_positive_definite()) {
      throw SimulationError(
          "a body that is continued from other designs has no positive mass here");
    }
    InvariantsFile file = *files_.front();
    for (int i = 0; i < int_size(values); ++i) {
      file.design[i].value = values(i);
      file.design[i].derivative = std::move(slopes[i]);
    }
    file.constants = std::move(constants);
    return file;
  }

  std::vector<FilePointer> files_;
  Chart chart_;
  std::vector<bool> is_logarithmic_;
  std::vector<Expansion> expansions_;
};

}  // namespace

std::shared_ptr<const BodySource> continue_body(std::vector<FilePointer> designs) {
  return std::make_shared<const ContinuedBody>(std::move(designs));
}

double stiffness_distance(const BodyConstants& a, const BodyConstants& b) {
  const VectorXd ratios = symmetric_eigenvalues(MatrixXd(a.stiffness), MatrixXd(b.stiffness));
  return ratios.array().log().abs().maxCoeff();
}

}  // namespace pleuel
