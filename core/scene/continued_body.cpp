#include "core/scene/continued_body.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_chart.hpp"
#include "core/scene/expansion_mean.hpp"

namespace pleuel {

namespace {

using FilePointer = std::shared_ptr<const InvariantsFile>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
    chart_.take_logarithms(value, slopes);
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
    chart_.take_exponentials(inside.value, inside.slopes);
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
