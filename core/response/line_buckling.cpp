#include "core/response/line_buckling.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/response/recovered_signal.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using Members = std::vector<StretchedElement>;

/// The axial force of a member a station.
class LineForces final : public Stations {
 public:
  explicit LineForces(const BodyModel& body) : body_(body) {}

  int numbers() const override { return 1; }
  Recovery recovery() const override {
    const Members& members = body_.stretched->values;
    Recovery forces = of_elongation(members, members);
    forces.of_stretching.resize(int_size(members), int_size(members));
    forces.of_stretching.setIdentity();
    return forces;
  }
  /// (κ b)' = κ' b + κ b'
  Recovery recovery_derivative(std::size_t k) const override {
    const Members& members = body_.stretched->values;
    const Members& changes = body_.stretched->derivatives[k].data;
    Recovery forces = of_elongation(changes, members);
    forces.of_coordinates = forces.of_coordinates + of_elongation(members, changes).of_coordinates;
    return forces;
  }

  int channels() const override { return int_size(body_.stretched->values); }
  std::string describe(int channel) const override {
    return fmt::format("element {} of the stiffening", channel + 1);
  }
  int station(int channel) const override { return channel; }
  double value(int, const double* numbers) const override { return -numbers[0]; }
  Numbers slopes(int, const double*) override { return Numbers::Constant(1, -1.0); }
  double design_slope(int, const double*, std::size_t) const override { return 0.0; }

 private:
  Recovery of_elongation(const Members& stiffness, const Members& elongation) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int m = 0; m < int_size(stiffness); ++m) {
      for (int i = 0; i < int_size(elongation[m].displacements); ++i) {
        entries.emplace_back(m, elongation[m].displacements[i],
                             stiffness[m].axial_stiffness * elongation[m].elongation(i));
      }
    }
    Recovery forces;
    forces.of_coordinates.resize(int_size(stiffness), body_.elastic_size());
    forces.of_coordinates.setFromTriplets(entries.begin(), entries.end());
    forces.of_accelerations.resize(int_size(stiffness), 3 * body_.places.size());
    forces.of_stretching.resize(int_size(stiffness), int_size(stiffness));
    return forces;
  }

  const BodyModel& body_;
};

/// A line between two places of a body.
class CompressedLine {
 public:
  CompressedLine(const BodyModel& body, const std::array<std::string, 2>& chord) : body_(body) {
    const std::vector<std::string>& names = body.places.names;
    for (std::size_t i = 0; i < 2; ++i) {
      ends_[i] = std::ranges::find(names, chord[i]) - names.begin();
    }
  }

  /// Stretching has to be that of the distance of the places.
  bool is_stiffened() const {
    constexpr double round_off = 1e-6;
    VectorXd elongation = VectorXd::Zero(body_.elastic_size());
    for (const StretchedElement& member : body_.stretched->values) {
      for (int i = 0; i < int_size(member.displacements); ++i) {
        elongation(member.displacements[i]) += member.elongation(i);
      }
    }
    const VectorXd expected =
        displacement(body_.places).transpose() * chord(body_.places).normalized();
    const double size = expected.norm();
    return std::min((elongation - expected).norm(), (elongation + expected).norm()) <=
           round_off * size;
  }

  /// Σ Ĝ − Uᵀ U/L
  MatrixXd slopes() const {
    const MatrixXd u = displacement(body_.places);
    const Vector3d along = chord(body_.places).normalized();
    const MatrixXd across = u - along * (along.transpose() * u);
    return sum_of(body_.stretched->values) -
           across.transpose() * across / chord(body_.places).norm();
  }

  /// φᵀ (Σ Ĝ − Uᵀ U/L)' φ
  double slopes_derivative(std::size_t k, const VectorXd& mode) const {
    const BodyPlaces& change = body_.places_x[k].data;
    const Vector3d moved = displacement(body_.places) * mode, c = chord(body_.places);
    const Vector3d moved_x = displacement(change) * mode, c_x = chord(change);
    const double length = c.norm(), along = moved.dot(c) / length;
    const double length_x = c.dot(c_x) / length;
    const double along_x = (moved_x.dot(c) + moved.dot(c_x) - along * length_x) / length;
    const double square = moved.squaredNorm() - along * along;
    const double square_x = 2.0 * (moved.dot(moved_x) - along * along_x);
    const MatrixXd change_of_sum = sum_of(body_.stretched->derivatives[k].data);
    return mode.dot(change_of_sum * mode) - (square_x - square * length_x / length) / length;
  }

 private:
  Vector3d chord(const BodyPlaces& places) const {
    return places.positions.col(ends_[1]) - places.positions.col(ends_[0]);
  }
  MatrixXd displacement(const BodyPlaces& places) const {
    return MatrixXd(places.shape.middleRows(6 * ends_[1], 3)) -
           MatrixXd(places.shape.middleRows(6 * ends_[0], 3));
  }
  MatrixXd sum_of(const Members& members) const {
    MatrixXd sum = MatrixXd::Zero(body_.elastic_size(), body_.elastic_size());
    for (const StretchedElement& member : members) {
      for (int i = 0; i < int_size(member.displacements); ++i) {
        for (int k = 0; k < int_size(member.displacements); ++k) {
          sum(member.displacements[i], member.displacements[k]) += member.slopes(i, k);
        }
      }
    }
    return sum;
  }

  const BodyModel& body_;
  std::array<Eigen::Index, 2> ends_ = {};
};

}  // namespace

std::unique_ptr<Signal> make_line_compression_signal(const BodyModel& body,
                                                     const Vector3d& gravity) {
  return make_recovered_signal(body, gravity, std::make_unique<LineForces>(body));
}

DesignFactor pinned_line_load(const BodyModel& body, const std::array<std::string, 2>& chord,
                              int variables) {
  constexpr double coincidence = 1e-6;
  const CompressedLine line(body, chord);
  if (!line.is_stiffened()) {
    throw InputError(
        fmt::format("the block \"stiffening\" of \"{}\" is not that of the line from \"{}\" to "
                    "\"{}\"",
                    body.name, chord[0], chord[1]));
  }
  const auto dense = [&](const VectorXd& entries) {
    return dense_matrix(body.invariants.pattern, entries);
  };
  const SymmetricModes modes = symmetric_modes(line.slopes(), dense(body.invariants.stiffness));
  const Eigen::Index last = modes.values.size() - 1;
  const double inverse = modes.values(last);
  Eigen::Index first = last;
  while (first > 0 && modes.values(first - 1) >= (1.0 - coincidence) * inverse) --first;
  DesignFactor load{1.0 / inverse, VectorXd::Zero(variables), ""};
  for (std::size_t k = 0; k < body.invariants_x.size(); ++k) {
    const MatrixXd stiffness_x = dense(body.invariants_x[k].data.stiffness);
    double slope = 0.0;
    for (Eigen::Index i = first; i <= last; ++i) {
      const VectorXd mode = modes.vectors.col(i);
      slope += line.slopes_derivative(k, mode) - inverse * mode.dot(stiffness_x * mode);
    }
    load.derivatives(body.invariants_x[k].variable) =
        -slope / static_cast<double>(last - first + 1) / (inverse * inverse);
  }
  return load;
}

}  // namespace pleuel
