#include "core/response/motion_signals.hpp"

#include <fmt/format.h>

#include "core/beam/beam_place.hpp"
#include "core/response/body_signal.hpp"

namespace pleuel {

namespace {

/// Displacement of the beam axis at a place, local axes.
template <class Scalar, class Nodal>
Vector3<Scalar> displacement(const Beam<Scalar>& beam, const BeamPlace& place, Nodal&& nodal) {
  const Scalar& length = beam.elements[static_cast<std::size_t>(place.element)].length;
  Eigen::Matrix<Scalar, 12, 1> q;
  for (int i = 0; i < 12; ++i) q(i) = nodal(i / 6, i % 6);
  return axis_shape(place.xi, length) * q;
}

class DeflectionSignal final : public BodySignal<DeflectionSignal> {
 public:
  DeflectionSignal(const BodyModel& body, double at, int direction)
      : BodySignal(body), at_(at), place_(find_place(body.beam, at)), direction_(direction) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return fmt::format("at {:g} of the length", at_); }
  LocalPlace place(int) const { return {place_.element, 2}; }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion, int) const {
    return displacement<Scalar>(beam, place_, [&](int node, int i) {
      return motion.q[static_cast<std::size_t>(nodal(node, i))];
    })(direction_);
  }

 private:
  double at_;
  BeamPlace place_;
  int direction_;
};

class PositionSignal final : public BodySignal<PositionSignal> {
 public:
  PositionSignal(const BodyModel& body, double at, int direction)
      : BodySignal(body), at_(at), direction_(direction) {
    if (body.is_beam()) place_ = find_place(body.beam, at);
  }

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return body().is_beam() ? fmt::format("at {:g} of the length", at_) : "reference point";
  }
  LocalPlace place(int) const { return {place_.element, body().is_beam() ? 2 : 0}; }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion, int) const {
    const FrameMotion<Scalar> frame = this->frame(motion);
    if (!body().is_beam()) return frame.r(direction_);
    Vector3<Scalar> p = displacement<Scalar>(beam, place_, [&](int node, int i) {
      return motion.q[static_cast<std::size_t>(nodal(node, i))];
    });
    p(0) += position_of(beam, place_);
    return frame.r(direction_) + Vector3<Scalar>(frame.A * p)(direction_);
  }

 private:
  double at_;
  BeamPlace place_;
  int direction_;
};

class DriveTorqueSignal final : public Signal {
 public:
  explicit DriveTorqueSignal(int row) : row_(row) {}
  int channels() const override { return 1; }
  std::string describe(int) const override { return "drive"; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = -state.lambda(row_);
  }
  void add_gradient(const State&, int, double weight, SignalGradient& gradient) override {
    gradient.lambda(row_) -= weight;
  }

 private:
  int row_;
};

}  // namespace

std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, double at, int direction) {
  return std::make_unique<DeflectionSignal>(body, at, direction);
}

std::unique_ptr<Signal> make_position_signal(const BodyModel& body, double at, int direction) {
  return std::make_unique<PositionSignal>(body, at, direction);
}

std::unique_ptr<Signal> make_drive_torque_signal(const JointModel& joint) {
  return std::make_unique<DriveTorqueSignal>(joint.drive_row);
}

}  // namespace pleuel
