#include "core/response/imported_signals.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/response/imported_state.hpp"
#include "core/response/vector_component.hpp"

namespace pleuel {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A formula depends on the frame and on p, ṗ, p̈ of a place.
using PlaceDual = DualOf<3 * most_frame_coordinates + 9>;

std::size_t find_place_index(const BodyModel& body, const std::string& name) {
  const std::vector<BodyPlace>& places = body.constants->places;
  const auto found = std::find_if(places.begin(), places.end(),
                                  [&](const BodyPlace& place) { return place.name == name; });
  return static_cast<std::size_t>(found - places.begin());
}

class ImportedMotionSignal final : public Signal {
 public:
  ImportedMotionSignal(const BodyModel& body, const std::string& place, int direction,
                       TimeDerivative derivative)
      : body_(body),
        name_(place),
        place_(find_place_index(body, place)),
        direction_(direction),
        derivative_(derivative) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("at \"{}\", {}", name_, component_name(direction_));
  }
  void observe(const State& state, Eigen::Ref<VectorXd> values) override {
    const ImportedState of_body(body_, state);
    values(0) = evaluate<double>(of_body.frame(), of_body.motion(place_));
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const ImportedState of_body(body_, state);
    const auto fixed = of_body.motion(place_);
    std::array<Vector3<PlaceDual>, 3> motion;
    for (int k = 0; k < 3; ++k) {
      const auto index = static_cast<std::size_t>(k);
      motion[index] = fixed[index].cast<PlaceDual>();
      for (int i = 0; i < 3; ++i)
        motion[index](i).derivatives()[3 * most_frame_coordinates + 3 * k + i] = 1.0;
    }
    const auto slopes =
        evaluate<PlaceDual>(of_body.seeded_frame<PlaceDual>(), motion).derivatives();
    ImportedGradient writer(body_, of_body, gradient);
    writer.add_frame(weight, slopes);
    writer.add_place(place_, {weight * slopes.template segment<3>(3 * most_frame_coordinates),
                              weight * slopes.template segment<3>(3 * most_frame_coordinates + 3),
                              weight * slopes.template segment<3>(3 * most_frame_coordinates + 6)});
  }

 private:
  template <class Scalar>
  Scalar evaluate(const FrameMotion<Scalar>& frame,
                  const std::array<Vector3<Scalar>, 3>& motion) const {
    return component_of<Scalar>(place_motion<Scalar>(frame, motion, derivative_), direction_);
  }

  const BodyModel& body_;
  std::string name_;
  std::size_t place_;
  int direction_;
  TimeDerivative derivative_;
};

class ImportedDeflectionSignal final : public Signal {
 public:
  ImportedDeflectionSignal(const BodyModel& body, const std::string& place, int direction)
      : body_(body), name_(place), place_(find_place_index(body, place)), direction_(direction) {}

  int channels() const override { return 1; }
  std::string describe(int) const override { return fmt::format("at \"{}\"", name_); }
  void observe(const State& state, Eigen::Ref<VectorXd> values) override {
    values(0) = row(*body_.constants).dot(ImportedState(body_, state).q());
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const ImportedState of_body(body_, state);
    ImportedGradient writer(body_, of_body, gradient);
    writer.add_elastic(weight * row(*body_.constants));
    for (const auto& [variable, change] : body_.constants_x) {
      writer.add_design(variable, weight * row(change).dot(of_body.q()));
    }
  }

 private:
  VectorXd row(const BodyConstants& constants) const {
    return VectorXd(constants.places[place_].displacement.row(direction_).transpose());
  }

  const BodyModel& body_;
  std::string name_;
  std::size_t place_;
  int direction_;
};

}  // namespace

std::unique_ptr<Signal> make_imported_motion_signal(const BodyModel& body, const std::string& place,
                                                    int direction, TimeDerivative derivative) {
  return std::make_unique<ImportedMotionSignal>(body, place, direction, derivative);
}

std::unique_ptr<Signal> make_imported_deflection_signal(const BodyModel& body,
                                                        const std::string& place, int direction) {
  return std::make_unique<ImportedDeflectionSignal>(body, place, direction);
}

}  // namespace pleuel
