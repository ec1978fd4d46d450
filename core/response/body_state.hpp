#pragma once

/// What signals of one body are written in: its frame, its elastic coordinates and its points.

#include <array>

#include "core/model/body_frames.hpp"
#include "core/model/body_point.hpp"
#include "core/response/signal.hpp"
#include "core/scene/response_settings.hpp"

namespace pleuel {

/// Coordinates of a frame at most: so many directions a dual number has for the coordinates, for
/// their rates and for the rates of these.
inline constexpr int most_frame_coordinates = 6;

/// Directions of a formula in the coordinates of a frame and their rates.
inline constexpr int frame_directions = 3 * most_frame_coordinates;

/// p, ṗ and p̈ of a point, local axes.
using PointMotion = std::array<Eigen::Vector3d, 3>;

/// A row times a vector.
inline double product(const SparseMatrix& rows, Eigen::Index row,
                      const Eigen::Ref<const Eigen::VectorXd>& vector) {
  double sum = 0.0;
  for (SparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
    sum += entry.value() * vector(entry.col());
  }
  return sum;
}

/// Frame and elastic coordinates of one body in a state.
class BodyState {
 public:
  BodyState(const BodyModel& body, const State& state) : body_(body), state_(state) {}

  auto q() const { return elastic(state_.q); }
  auto v() const { return elastic(state_.v); }
  auto a() const { return elastic(state_.a); }

  FrameMotion<double> frame() const { return frame_motion(body_.frame, state_); }

  /// The frame with its coordinates and their rates as the first directions.
  FrameMotion<WideDual> seeded_frame(const SeedGroup& seed) const {
    Eigen::Matrix<WideDual, Eigen::Dynamic, 1> parts[3];
    const Eigen::VectorXd* vectors[3] = {&state_.q, &state_.v, &state_.a};
    for (int k = 0; k < 3; ++k) {
      parts[k] = of_frame(*vectors[k]).template cast<WideDual>();
      for (int i = 0; i < body_.frame.size(); ++i) {
        seed(parts[k](i), most_frame_coordinates * k + i);
      }
    }
    return frame_motion<WideDual>(body_.frame, parts[0], parts[1], parts[2]);
  }

  /// @param position  undeformed
  /// @param shape     its first three rows from `first` are those of the displacement
  PointMotion motion(const Eigen::Vector3d& position, const SparseMatrix& shape,
                     Eigen::Index first = 0) const {
    PointMotion motion;
    for (Eigen::Index k = 0; k < 3; ++k) {
      motion[0](k) = position(k) + product(shape, first + k, q());
      motion[1](k) = product(shape, first + k, v());
      motion[2](k) = product(shape, first + k, a());
    }
    return motion;
  }
  PointMotion motion(const PointShape& point) const { return motion(point.position, point.shape); }

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
class BodyGradient {
 public:
  BodyGradient(const BodyModel& body, const BodyState& state, SignalGradient& gradient)
      : body_(body), state_(state), gradient_(gradient) {}

  template <class Slopes>
  void add_frame(double weight, const Slopes& slopes) {
    for (int i = 0; i < body_.frame.size(); ++i) {
      gradient_.q(body_.frame.offset + i) += weight * slopes[i];
      gradient_.v(body_.frame.offset + i) += weight * slopes[most_frame_coordinates + i];
      gradient_.a(body_.frame.offset + i) += weight * slopes[2 * most_frame_coordinates + i];
    }
  }

  /// @param slopes  with respect to p, ṗ and p̈ of the point
  void add_point(const PointShape& point, const PointMotion& slopes) {
    add_rows(point.shape, 0, slopes);
  }
  /// The same of what a variable changes of the point.
  void add_point_change(int variable, const PointShape& change, const PointMotion& slopes) {
    add_motion_change(variable, state_.motion(change), slopes);
  }

  /// The same for one of the places of the body.
  void add_place(int place, const PointMotion& slopes) {
    add_rows(body_.places.shape, 6 * place, slopes);
    for (const auto& [variable, change] : body_.places_x) {
      add_motion_change(
          variable, state_.motion(change.positions.col(place), change.shape, 6 * place), slopes);
    }
  }

  /// @param slope  with respect to row · q_f
  void add_elastic(double slope, const SparseMatrix& rows, Eigen::Index row) {
    add_row(slope, rows, row, gradient_.q);
  }
  /// @param slope  with respect to an elastic coordinate
  void add_coordinate(double slope, int coordinate) {
    gradient_.q(body_.elastic_offset() + coordinate) += slope;
  }
  void add_design(int variable, double slope) { gradient_.design(variable) += slope; }

 private:
  void add_row(double slope, const SparseMatrix& rows, Eigen::Index row, Eigen::VectorXd& all) {
    for (SparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      all(body_.elastic_offset() + entry.col()) += slope * entry.value();
    }
  }
  void add_rows(const SparseMatrix& shape, Eigen::Index first, const PointMotion& slopes) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      add_row(slopes[0](k), shape, first + k, gradient_.q);
      add_row(slopes[1](k), shape, first + k, gradient_.v);
      add_row(slopes[2](k), shape, first + k, gradient_.a);
    }
  }
  void add_motion_change(int variable, const PointMotion& change, const PointMotion& slopes) {
    for (std::size_t k = 0; k < 3; ++k) add_design(variable, slopes[k].dot(change[k]));
  }

  const BodyModel& body_;
  const BodyState& state_;
  SignalGradient& gradient_;
};

/// Position of a place of a body, or its velocity or acceleration, global axes.
/// @param p  in the frame, with its rates
template <class Scalar>
Vector3<Scalar> place_motion(const FrameMotion<Scalar>& frame,
                             const std::array<Vector3<Scalar>, 3>& p, TimeDerivative derivative) {
  switch (derivative) {
    case TimeDerivative::none:
      return frame.r + frame.A * p[0];
    case TimeDerivative::first:
      return frame.r_dot + (frame.A_dot * p[0] + frame.A * p[1]);
    default:
      return frame.r_ddot + (frame.A_ddot * p[0] + 2.0 * (frame.A_dot * p[1]) + frame.A * p[2]);
  }
}

/// a = Aᵀ(r̈ − g) + α × p + ω × (ω × p + 2 ṗ) + p̈: what the inertia load of a place comes from,
/// local axes.
template <class Scalar>
Vector3<Scalar> local_acceleration(const FrameMotion<Scalar>& frame, const Eigen::Vector3d& gravity,
                                   const std::array<Vector3<Scalar>, 3>& p) {
  const Vector3<Scalar> spin = frame.omega.cross(p[0]) + 2.0 * p[1];
  return p[2] + frame.alpha.cross(p[0]) + frame.omega.cross(spin) +
         frame.A.transpose() * (frame.r_ddot - gravity.template cast<Scalar>());
}

}  // namespace pleuel
