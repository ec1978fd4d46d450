#include "core/response/motion_signals.hpp"

#include <fmt/format.h>

#include "core/beam/beam_place.hpp"
#include "core/response/body_signal.hpp"
#include "core/response/place_kinematics.hpp"
#include "core/response/signal_sum.hpp"
#include "core/response/vector_component.hpp"

namespace pleuel {

namespace {

/// Displacement of the beam axis at a place, local axes; or its rate, from nodal rates.
template <class Scalar, class Nodal>
Vector3<Scalar> displacement(const Beam<Scalar>& beam, const BeamPlace& place, Nodal&& nodal) {
  const Scalar& length = beam.elements[static_cast<std::size_t>(place.element)].length;
  Eigen::Matrix<Scalar, 12, 1> q;
  for (int i = 0; i < 12; ++i) q(i) = nodal(i / 6, i % 6);
  return axis_shape(place.xi, length) * q;
}

class DeflectionSignal final : public BodySignal<DeflectionSignal, 1> {
 public:
  DeflectionSignal(const BodyModel& body, double at, int direction)
      : BodySignal(body), at_(at), place_(find_place(body.beam, at)), direction_(direction) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("at {:g} of the length", body().stretch.of_whole(at_));
  }
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

class PlaceSignal final : public BodySignal<PlaceSignal> {
 public:
  PlaceSignal(const BodyModel& body, const PlaceMotion& motion, TimeDerivative derivative)
      : BodySignal(body), motion_(motion), derivative_(derivative) {
    if (body.is_beam()) place_ = find_place(body.beam, motion.at);
  }

  int channels() const override { return 1; }
  std::string describe(int) const override {
    const std::string place =
        body().is_beam() ? fmt::format("at {:g} of the length", body().stretch.of_whole(motion_.at))
                         : "reference point";
    return fmt::format("{}, {}", place, component_name(motion_.direction));
  }
  LocalPlace place(int) const { return {place_.element, body().is_beam() ? 2 : 0}; }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion, int) const {
    const FrameMotion<Scalar> frame = this->frame(motion);
    std::array<Vector3<Scalar>, 3> p;
    for (auto& vector : p) vector.setConstant(Scalar(0));
    if (body().is_beam()) {
      const auto elastic = [&](const auto& nodes) {
        return displacement<Scalar>(beam, place_, [&](int node, int i) {
          return nodes[static_cast<std::size_t>(nodal(node, i))];
        });
      };
      p = {elastic(motion.q), elastic(motion.v), elastic(motion.a)};
      p[0](0) += position_of(beam, place_);
    }
    return component_of<Scalar>(place_motion<Scalar>(frame, p, derivative_), motion_.direction);
  }

 private:
  PlaceMotion motion_;
  TimeDerivative derivative_;
  BeamPlace place_;
};

class AxisSignal final : public BodySignal<AxisSignal, 1> {
 public:
  AxisSignal(const BodyModel& body, int axis) : BodySignal(body), axis_(axis) {}

  int channels() const override { return 3; }
  std::string describe(int channel) const override {
    return fmt::format("axis of the body frame, {}", component_name(channel));
  }
  LocalPlace place(int) const { return {}; }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>&, const LocalMotion<Scalar>& motion, int channel) const {
    return this->frame(motion).A(channel, axis_);
  }

 private:
  int axis_;
};

}  // namespace

std::unique_ptr<Signal> make_axis_signal(const BodyModel& body, int axis) {
  return std::make_unique<AxisSignal>(body, axis);
}

std::unique_ptr<Signal> make_deflection_signal(const BodyModel& body, double at, int direction) {
  return std::make_unique<DeflectionSignal>(body, at, direction);
}

std::unique_ptr<Signal> make_chord_deflection_signal(const BodyModel& body, double at,
                                                     int direction) {
  std::vector<SignalSum::Part> parts;
  parts.push_back({1.0, make_deflection_signal(body, at, direction)});
  parts.push_back({at - 1.0, make_deflection_signal(body, 0.0, direction)});
  parts.push_back({-at, make_deflection_signal(body, 1.0, direction)});
  return std::make_unique<SignalSum>(std::move(parts));
}

std::unique_ptr<Signal> make_position_signal(const BodyModel& body, const PlaceMotion& motion) {
  return std::make_unique<PlaceSignal>(body, motion, TimeDerivative::none);
}

std::unique_ptr<Signal> make_velocity_signal(const BodyModel& body, const PlaceMotion& motion) {
  return std::make_unique<PlaceSignal>(body, motion, TimeDerivative::first);
}

std::unique_ptr<Signal> make_acceleration_signal(const BodyModel& body, const PlaceMotion& motion) {
  return std::make_unique<PlaceSignal>(body, motion, TimeDerivative::second);
}

}  // namespace pleuel
