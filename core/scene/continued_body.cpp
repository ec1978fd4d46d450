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

using FilePointer = std::shared_ptr<const InvariantsFile>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class ContinuedBody : public BodySource {
 public:
  ContinuedBody(const std::string& made_by, std::vector<FilePointer> designs)
      : identity_(made_by), files_(std::move(designs)), chart_(files_.front()->constants) {
    const int count = int_size(files_.front()->design);
    is_logarithmic_.assign(count, true);
    for (const FilePointer& file : files_) {
      for (int i = 0; i < count; ++i) {
        is_logarithmic_[i] = is_logarithmic_[i] && file->design[i].value > 0.0;
      }
    }
    for (const FilePointer& file : files_) expansions_.push_back(expansion_of(*file));
    for (const FilePointer& file : files_) {
      for (const ConstantsDerivative& of : file->design) identity_ += fmt::format(" {}", of.value);
    }
  }

  std::string identity() const override { return identity_; }

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
  static BodyConstants with_logarithms_times(double factor, BodyConstants slope) {
    BodyChart::scale(slope, factor);
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
    InvariantsFile file = *files_.front();
    for (int i = 0; i < int_size(values); ++i) {
      file.design[i].value = values(i);
      file.design[i].derivative = std::move(slopes[i]);
    }
    file.constants = std::move(constants);
    return file;
  }

  std::string identity_;
  std::vector<FilePointer> files_;
  BodyChart chart_;
  std::vector<bool> is_logarithmic_;
  std::vector<Expansion> expansions_;
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
