#pragma once

#include <array>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

/// What signals of bodies that are known by their invariants are written in: frame, elastic
/// coordinates and places of one body.
namespace pleuel {

/// Coordinates of a frame at most: so many directions a dual number has for the coordinates, for
/// their rates and for the rates of these.
inline constexpr int most_frame_coordinates = 6;

/// Frame and elastic coordinates of one body in a state.
class ImportedState {
 public:
  ImportedState(const BodyModel& body, const State& state) : body_(body), state_(state) {}

  auto q() const { return elastic(state_.q); }
  auto v() const { return elastic(state_.v); }
  auto a() const { return elastic(state_.a); }

  FrameMotion<double> frame() const {
    return frame_motion<double>(body_.frame, of_frame(state_.q), of_frame(state_.v),
                                of_frame(state_.a));
  }

  /// The frame with its coordinates and their rates as the first directions.
  template <class Scalar>
  FrameMotion<Scalar> seeded_frame() const {
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> parts[3];
    const Eigen::VectorXd* vectors[3] = {&state_.q, &state_.v, &state_.a};
    for (int k = 0; k < 3; ++k) {
      parts[k] = of_frame(*vectors[k]).template cast<Scalar>();
      for (int i = 0; i < body_.frame.size(); ++i) {
        parts[k](i).derivatives()[most_frame_coordinates * k + i] = 1.0;
      }
    }
    return frame_motion<Scalar>(body_.frame, parts[0], parts[1], parts[2]);
  }

  /// p, ṗ and p̈ of a place, local axes.
  std::array<Eigen::Vector3d, 3> motion(std::size_t place) const {
    const BodyPlace& at = body_.constants->places[place];
    if (!body_.is_elastic) return {at.position, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    return {at.position + at.displacement * q(), at.displacement * v(), at.displacement * a()};
  }

 private:
  Eigen::VectorBlock<const Eigen::VectorXd> of_frame(const Eigen::VectorXd& all) const {
    return all.segment(body_.frame.offset, body_.frame.size());
  }
  Eigen::VectorBlock<const Eigen::VectorXd> elastic(const Eigen::VectorXd& all) const {
    return all.segment(body_.elastic_offset(), body_.elastic_size());
  }

  const BodyModel& body_;
  const State& state_;
};

/// Carries derivatives of a number on to the coordinates of the body and to the design.
class ImportedGradient {
 public:
  ImportedGradient(const BodyModel& body, const ImportedState& state, SignalGradient& gradient)
      : body_(body), state_(state), gradient_(gradient) {}

  template <class Slopes>
  void add_frame(double weight, const Slopes& slopes) {
    for (int i = 0; i < body_.frame.size(); ++i) {
      gradient_.q(body_.frame.offset + i) += weight * slopes[i];
      gradient_.v(body_.frame.offset + i) += weight * slopes[most_frame_coordinates + i];
      gradient_.a(body_.frame.offset + i) += weight * slopes[2 * most_frame_coordinates + i];
    }
  }

  /// @param slopes  with respect to p, ṗ and p̈ of the place
  void add_place(std::size_t place, const std::array<Eigen::Vector3d, 3>& slopes) {
    if (body_.is_elastic) {
      const SparseMatrix& shape = body_.constants->places[place].displacement;
      elastic(gradient_.q) += shape.transpose() * slopes[0];
      elastic(gradient_.v) += shape.transpose() * slopes[1];
      elastic(gradient_.a) += shape.transpose() * slopes[2];
    }
    for (const auto& [variable, change] : body_.constants_x) {
      const BodyPlace& at = change.places[place];
      gradient_.design(variable) += slopes[0].dot(at.position);
      if (!body_.is_elastic) continue;
      gradient_.design(variable) += slopes[0].dot(at.displacement * state_.q()) +
                                    slopes[1].dot(at.displacement * state_.v()) +
                                    slopes[2].dot(at.displacement * state_.a());
    }
  }

  void add_elastic(const Eigen::VectorXd& slopes) { elastic(gradient_.q) += slopes; }
  void add_design(int variable, double slope) { gradient_.design(variable) += slope; }

 private:
  Eigen::VectorBlock<Eigen::VectorXd> elastic(Eigen::VectorXd& all) const {
    return all.segment(body_.elastic_offset(), body_.elastic_size());
  }

  const BodyModel& body_;
  const ImportedState& state_;
  SignalGradient& gradient_;
};

}  // namespace pleuel
