#include "core/response/motion_signals.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/response/body_state.hpp"
#include "core/response/composed_signals.hpp"

namespace pleuel {

namespace {

/// Directions of a formula in the frame and in p, ṗ, p̈ of a point.
constexpr int point_directions = frame_directions + 9;

class MotionSignal final : public Signal {
 public:
  MotionSignal(const BodyModel& body, NamedPoint point, int direction, TimeDerivative derivative)
      : body_(body), point_(std::move(point)), direction_(direction), derivative_(derivative) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("{}, {}", point_.name, component_name(direction_));
  }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    const BodyState of_body(body_, state);
    values(0) = evaluate<double>(of_body.frame(), of_body.motion(point_.point));
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    const PointMotion fixed = of_body.motion(point_.point);
    const auto slopes = derivatives_of<point_directions>([&](const SeedGroup& seed) {
      std::array<Vector3<WideDual>, 3> motion;
      for (std::size_t k = 0; k < 3; ++k) {
        motion[k] = fixed[k].cast<WideDual>();
        for (int i = 0; i < 3; ++i) seed(motion[k](i), first_of(k) + i);
      }
      return evaluate<WideDual>(of_body.seeded_frame(seed), motion);
    });
    PointMotion of_point;
    for (std::size_t k = 0; k < 3; ++k) {
      of_point[k] = weight * slopes.template segment<3>(first_of(k));
    }
    BodyGradient writer(body_, of_body, gradient);
    writer.add_frame(weight, slopes);
    writer.add_point(point_.point, of_point);
    for (const auto& [variable, change] : point_.point.derivatives) {
      writer.add_point_change(variable, change, of_point);
    }
  }

 private:
  static int first_of(std::size_t derivative) {
    return 3 * (most_frame_coordinates + static_cast<int>(derivative));
  }

  template <class Scalar>
  Scalar evaluate(const FrameMotion<Scalar>& frame,
                  const std::array<Vector3<Scalar>, 3>& motion) const {
    return component_of<Scalar>(place_motion<Scalar>(frame, motion, derivative_), direction_);
  }

  const BodyModel& body_;
  NamedPoint point_;
  int direction_;
  TimeDerivative derivative_;
};

class DeflectionSignal final : public Signal {
 public:
  DeflectionSignal(const BodyModel& body, NamedPoint point, int direction)
      : body_(body), point_(std::move(point)), direction_(direction) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return point_.name; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = product(point_.point.shape, direction_, BodyState(body_, state).q());
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    BodyGradient writer(body_, of_body, gradient);
    writer.add_elastic(weight, point_.point.shape, direction_);
    for (const auto& [variable, change] : point_.point.derivatives) {
      writer.add_design(variable, weight * product(change.shape, direction_, of_body.q()));
    }
  }

 private:
  const BodyModel& body_;
  NamedPoint point_;
  int direction_;
};

class AxisSignal final : public Signal {
 public:
  AxisSignal(const BodyModel& body, int axis) : body_(body), axis_(axis) {}

  int channels() const override { return 3; }
  std::string describe(int channel) const override {
    return fmt::format("axis of the body frame, {}", component_name(channel));
  }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values = BodyState(body_, state).frame().A.col(axis_);
  }
  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    const auto slopes = derivatives_of<frame_directions>(
        [&](const SeedGroup& seed) { return of_body.seeded_frame(seed).A(channel, axis_); });
    BodyGradient(body_, of_body, gradient).add_frame(weight, slopes);
  }

 private:
  const BodyModel& body_;
  int axis_;
};

/// Of the acute angle α between two axes: α, or π/2 − α.
class AcuteAngleSignal final : public Signal {
 public:
  /// @param second  null: `fixed`
  AcuteAngleSignal(std::unique_ptr<Signal> first, std::unique_ptr<Signal> second,
                   const Eigen::Vector3d& fixed)
      : first_(std::move(first)), second_(std::move(second)), fixed_(fixed) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return "between body frames"; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    const auto [a, b] = axes(state);
    const double acute = std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
    values(0) = second_ ? acute : 0.5 * std::numbers::pi - acute;
  }
  /// ±d(a·b)/sin α; at α = 0 the mean of both sides, which is none.
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const auto [a, b] = axes(state);
    const double sine = a.cross(b).norm();
    if (sine == 0.0) return;
    const double slope = (second_ ? -weight : weight) * std::copysign(1.0, a.dot(b)) / sine;
    for (int i = 0; i < 3; ++i) {
      first_->add_gradient(state, i, slope * b(i), gradient);
      if (second_) second_->add_gradient(state, i, slope * a(i), gradient);
    }
  }

 private:
  std::pair<Eigen::Vector3d, Eigen::Vector3d> axes(const State& state) {
    Eigen::VectorXd a(3), b = fixed_;
    first_->observe(state, a);
    if (second_) second_->observe(state, b);
    return {a, b};
  }

  std::unique_ptr<Signal> first_, second_;
  Eigen::Vector3d fixed_;
};

class SpinSignal final : public Signal {
 public:
  SpinSignal(const BodyModel& body, int direction, TimeDerivative derivative)
      : body_(body), direction_(direction), derivative_(derivative) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("body frame, {}", component_name(direction_));
  }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = evaluate<double>(BodyState(body_, state).frame());
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    const auto slopes = derivatives_of<frame_directions>(
        [&](const SeedGroup& seed) { return evaluate<WideDual>(of_body.seeded_frame(seed)); });
    BodyGradient(body_, of_body, gradient).add_frame(weight, slopes);
  }

 private:
  template <class Scalar>
  Scalar evaluate(const FrameMotion<Scalar>& frame) const {
    const Vector3<Scalar>& local = derivative_ == TimeDerivative::first ? frame.omega : frame.alpha;
    return component_of<Scalar>(Vector3<Scalar>(frame.A * local), direction_);
  }

  const BodyModel& body_;
  int direction_;
  TimeDerivative derivative_;
};

class AngleSignal final : public Signal {
 public:
  AngleSignal(const BodyModel& body, int direction)
      : body_(body), direction_(direction), local_(direction == 0 && !body.is_beam() ? 1 : 0) {
    from_ = Eigen::Vector3d::Unit(direction == 0 ? 1 : 0);
    beside_ = Eigen::Vector3d::Unit(direction).cross(from_);
    const BodyFrame& frame = body.frame;
    if (frame.rotation != RotationCoordinates::angle) return;
    constexpr double parallel = 1.0 - 1e-12;
    if (std::abs(frame.axis(direction)) < parallel) return;
    sense_ = frame.axis(direction) > 0.0 ? 1.0 : -1.0;
    reference_ = angle_of<double>(frame.reference, 0.0);
  }

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("body frame, about {}", component_name(direction_));
  }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = counts_turns() ? reference_ + sense_ * state.q(coordinate())
                               : angle_of<double>(BodyState(body_, state).frame().A, state.time);
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    if (counts_turns()) {
      gradient.q(coordinate()) += weight * sense_;
      return;
    }
    const BodyState of_body(body_, state);
    const auto slopes = derivatives_of<frame_directions>([&](const SeedGroup& seed) {
      return angle_of<WideDual>(of_body.seeded_frame(seed).A, state.time);
    });
    BodyGradient(body_, of_body, gradient).add_frame(weight, slopes);
  }

 private:
  bool counts_turns() const { return sense_ != 0.0; }
  int coordinate() const { return body_.frame.offset + body_.frame.translations(); }

  template <class Scalar>
  Scalar angle_of(const Matrix3<Scalar>& A, double time) const {
    using std::atan2;
    const Vector3<Scalar> axis = A.col(local_);
    const Scalar x = axis.dot(from_.cast<Scalar>()), y = axis.dot(beside_.cast<Scalar>());
    constexpr double tiny = 1e-12;
    if (std::hypot(value_of(x), value_of(y)) < tiny) {
      throw SimulationError(
          fmt::format("the angle of \"{}\" about {} has no value at t = {:g} s: its local {} axis "
                      "points along that",
                      body_.name, component_name(direction_), time, local_ == 0 ? "x" : "y"));
    }
    return atan2(y, x);
  }

  const BodyModel& body_;
  int direction_, local_;
  Eigen::Vector3d from_, beside_;
  double sense_ = 0.0, reference_ = 0.0;  ///< of motion in a plane normal to the axis
};

}  // namespace

std::unique_ptr<Signal> make_spin_signal(const BodyModel& body, int direction,
                                         TimeDerivative derivative) {
  return std::make_unique<SpinSignal>(body, direction, derivative);
}

std::unique_ptr<Signal> make_angle_signal(const BodyModel& body, int direction) {
  return std::make_unique<AngleSignal>(body, direction);
}

std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, NamedPoint point,
                                               int direction) {
  return std::make_unique<DeflectionSignal>(body, std::move(point), direction);
}

std::unique_ptr<Signal> make_axis_signal(const BodyModel& body, int axis) {
  return std::make_unique<AxisSignal>(body, axis);
}

std::unique_ptr<Signal> make_transmission_angle(const BodyModel& first, const BodyModel& second) {
  return std::make_unique<AcuteAngleSignal>(make_axis_signal(first, 0), make_axis_signal(second, 0),
                                            Eigen::Vector3d::Zero());
}

std::unique_ptr<Signal> make_transmission_angle(const BodyModel& body,
                                                const Eigen::Vector3d& guide) {
  return std::make_unique<AcuteAngleSignal>(make_axis_signal(body, 0), nullptr, guide);
}

std::unique_ptr<Signal> make_motion_signal(const BodyModel& body, NamedPoint point, int direction,
                                           TimeDerivative derivative) {
  return std::make_unique<MotionSignal>(body, std::move(point), direction, derivative);
}

}  // namespace pleuel
