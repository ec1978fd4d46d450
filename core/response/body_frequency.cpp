#include "core/response/body_frequency.hpp"

#include <array>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/response/modal_vectors.hpp"

namespace pleuel {

namespace {

/// Squares of frequencies that differ by less are one, several times.
constexpr double coincidence = 1e-6;

/// Mean of x* A x over the columns x; A symmetric.
double mean_form(const Eigen::MatrixXd& a, const Eigen::MatrixXcd& x) {
  const Eigen::MatrixXd real = x.real();
  const Eigen::MatrixXd imaginary = x.imag();
  const Eigen::MatrixXd a_real = a * real;
  const Eigen::MatrixXd a_imaginary = a * imaginary;
  return (real.cwiseProduct(a_real).sum() + imaginary.cwiseProduct(a_imaginary).sum()) /
         static_cast<double>(x.cols());
}

class BodyModes {
 public:
  explicit BodyModes(const BodyModel& body)
      : body_(body),
        mass_(dense(body.invariants.mass_matrix)),
        modes_(body.elastic_size() > 0 ? natural_modes(dense(body.invariants.stiffness), mass_)
                                       : NaturalModes()) {}  // there is nothing to decompose

  Eigen::MatrixXd dense(const Eigen::VectorXd& entries) const {
    return dense_matrix(body_.invariants.pattern, entries);
  }

  BodyMode find(const ModeChoice& choice) const {
    Eigen::Index counted = 0;
    for (Eigen::Index first = 0, end = 0; first < modes_.lambda.size(); first = end) {
      end = end_of_coinciding(first);
      Eigen::MatrixXcd shapes = modes_.shapes.middleCols(first, end - first);
      if (choice.axis) shapes = shapes * combinations(shapes, *choice.axis);
      if (choice.number < counted + shapes.cols()) {
        return {choice.axis ? square_of(shapes) : modes_.lambda(first + choice.number - counted),
                shapes};
      }
      counted += shapes.cols();
    }
    refuse_mode(fmt::format("the body \"{}\"", body_.name), counted, choice);
  }

 private:
  /// By Rayleigh's quotient: of modes that nearly coincide each has its own.
  double square_of(const Eigen::MatrixXcd& shapes) const {
    return mean_form(dense(body_.invariants.stiffness), shapes);
  }

  Eigen::Index end_of_coinciding(Eigen::Index first) const {
    Eigen::Index end = first + 1;
    const double square = modes_.lambda(first);
    while (end < modes_.lambda.size() &&
           modes_.lambda(end) - square <= coincidence * std::abs(square)) {
      ++end;
    }
    return end;
  }

  Eigen::MatrixXcd combinations(const Eigen::MatrixXcd& shapes,
                                const std::array<double, 3>& axis) const {
    return combinations_along(
        shapes, mass_,
        elastic_mass_along(body_.invariants, Eigen::Map<const Eigen::Vector3d>(axis.data())));
  }

  const BodyModel& body_;
  Eigen::MatrixXd mass_;
  NaturalModes modes_;
};

}  // namespace

BodyMode body_mode(const BodyModel& body, const ModeChoice& choice) {
  return BodyModes(body).find(choice);
}

DesignConstant body_frequency(const BodyModel& body, const ModeChoice& choice, int variables) {
  const BodyModes modes(body);
  const auto [square, shapes] = modes.find(choice);
  DesignConstant frequency;
  frequency.value = std::sqrt(square);
  frequency.derivatives = Eigen::VectorXd::Zero(variables);
  for (const auto& [variable, change] : body.invariants_x) {
    const Eigen::MatrixXd matrix =
        modes.dense(change.stiffness) - square * modes.dense(change.mass_matrix);
    frequency.derivatives(variable) = mean_form(matrix, shapes) / (2.0 * frequency.value);
  }
  return frequency;
}

VibrationState vibration_state(Mechanism& mechanism) {
  if (mechanism.elastic.empty()) return {initial_state(mechanism), ""};
  try {
    return {equilibrium_state(mechanism), ""};
  } catch (const SimulationError& error) {
    return {initial_state(mechanism), error.what()};
  }
}

}  // namespace pleuel
