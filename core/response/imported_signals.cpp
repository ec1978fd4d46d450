#include "core/response/imported_signals.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/response/vector_component.hpp"

namespace pleuel {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Coordinates of a frame at most; a formula depends on them, their rates and a place's p, ṗ, p̈.
constexpr int most = 6;
using FrameDual = DualOf<3 * most>;
using PlaceDual = DualOf<3 * most + 9>;

std::size_t find_place_index(const BodyModel& body, const std::string& name) {
  const std::vector<BodyPlace>& places = body.constants->places;
  const auto found = std::find_if(places.begin(), places.end(),
                                  [&](const BodyPlace& place) { return place.name == name; });
  return static_cast<std::size_t>(found - places.begin());
}

/// Frame and elastic coordinates of one body in a state.
class BodyState {
 public:
  BodyState(const BodyModel& body, const State& state) : body_(body), state_(state) {}

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
    const VectorXd* vectors[3] = {&state_.q, &state_.v, &state_.a};
    for (int k = 0; k < 3; ++k) {
      parts[k] = of_frame(*vectors[k]).template cast<Scalar>();
      for (int i = 0; i < body_.frame.size(); ++i) parts[k](i).derivatives()[most * k + i] = 1.0;
    }
    return frame_motion<Scalar>(body_.frame, parts[0], parts[1], parts[2]);
  }

  /// p, ṗ and p̈ of a place, local axes.
  std::array<Vector3d, 3> motion(std::size_t place) const {
    const BodyPlace& at = body_.constants->places[place];
    if (!body_.is_elastic) return {at.position, Vector3d::Zero(), Vector3d::Zero()};
    return {at.position + at.displacement * q(), at.displacement * v(), at.displacement * a()};
  }

 private:
  Eigen::VectorBlock<const VectorXd> of_frame(const VectorXd& all) const {
    return all.segment(body_.frame.offset, body_.frame.size());
  }
  Eigen::VectorBlock<const VectorXd> elastic(const VectorXd& all) const {
    return all.segment(body_.elastic_offset(), body_.elastic_size());
  }

  const BodyModel& body_;
  const State& state_;
};

/// Carries derivatives of a number on to the coordinates of the body and to the design.
class GradientWriter {
 public:
  GradientWriter(const BodyModel& body, const BodyState& state, SignalGradient& gradient)
      : body_(body), state_(state), gradient_(gradient) {}

  template <class Slopes>
  void add_frame(double weight, const Slopes& slopes) {
    for (int i = 0; i < body_.frame.size(); ++i) {
      gradient_.q(body_.frame.offset + i) += weight * slopes[i];
      gradient_.v(body_.frame.offset + i) += weight * slopes[most + i];
      gradient_.a(body_.frame.offset + i) += weight * slopes[2 * most + i];
    }
  }

  /// @param slopes  with respect to p, ṗ and p̈ of the place
  void add_place(std::size_t place, const std::array<Vector3d, 3>& slopes) {
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

  void add_elastic(const VectorXd& slopes) { elastic(gradient_.q) += slopes; }
  void add_design(int variable, double slope) { gradient_.design(variable) += slope; }

 private:
  Eigen::VectorBlock<VectorXd> elastic(VectorXd& all) const {
    return all.segment(body_.elastic_offset(), body_.elastic_size());
  }

  const BodyModel& body_;
  const BodyState& state_;
  SignalGradient& gradient_;
};

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
    const BodyState of_body(body_, state);
    values(0) = evaluate<double>(of_body.frame(), of_body.motion(place_));
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    const auto fixed = of_body.motion(place_);
    std::array<Vector3<PlaceDual>, 3> motion;
    for (int k = 0; k < 3; ++k) {
      const auto index = static_cast<std::size_t>(k);
      motion[index] = fixed[index].cast<PlaceDual>();
      for (int i = 0; i < 3; ++i) motion[index](i).derivatives()[3 * most + 3 * k + i] = 1.0;
    }
    const auto slopes =
        evaluate<PlaceDual>(of_body.seeded_frame<PlaceDual>(), motion).derivatives();
    GradientWriter writer(body_, of_body, gradient);
    writer.add_frame(weight, slopes);
    writer.add_place(place_, {weight * slopes.template segment<3>(3 * most),
                              weight * slopes.template segment<3>(3 * most + 3),
                              weight * slopes.template segment<3>(3 * most + 6)});
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
    values(0) = row(*body_.constants).dot(BodyState(body_, state).q());
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    GradientWriter writer(body_, of_body, gradient);
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

/// Stress at a point: xx yy zz xy yz xz [Pa].
using Stress = Eigen::Matrix<double, 6, 1>;

constexpr double tiny = 1e-300;  // keeps the root differentiable at zero [Pa²]

double von_mises(const Stress& s) {
  const double xy = s(0) - s(1), yz = s(1) - s(2), zx = s(2) - s(0);
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * s.tail<3>().squaredNorm() + tiny);
}

Stress von_mises_slope(const Stress& s) {
  Stress slope;
  slope << 2 * s(0) - s(1) - s(2), 2 * s(1) - s(2) - s(0), 2 * s(2) - s(0) - s(1), 6 * s(3),
      6 * s(4), 6 * s(5);
  return slope / (2.0 * von_mises(s));
}

class ImportedStressSignal final : public Signal {
 public:
  ImportedStressSignal(const BodyModel& body, const Vector3d& gravity, StressPart part)
      : body_(body), recovery_(*body.constants->stress), gravity_(gravity), part_(part) {}

  int channels() const override { return static_cast<int>(recovery_.points.size()); }
  std::string describe(int channel) const override {
    return recovery_.points[static_cast<std::size_t>(channel)];
  }

  void observe(const State& state, Eigen::Ref<VectorXd> values) override {
    const BodyState of_body(body_, state);
    const VectorXd stress = evaluate(recovery_, of_body, accelerations(of_body), forces(of_body));
    for (int i = 0; i < channels(); ++i) values(i) = part_of(stress.segment<6>(6 * i));
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const BodyState of_body(body_, state);
    const VectorXd local = accelerations(of_body), stretching = forces(of_body);
    const Stress stress = evaluate(recovery_, of_body, local, stretching).segment<6>(6 * channel);
    const Stress slope = weight * slope_of(stress);
    GradientWriter writer(body_, of_body, gradient);
    const auto rows = [channel](const SparseMatrix& matrix) {
      return matrix.middleRows(6 * channel, 6);
    };
    writer.add_elastic(rows(recovery_.of_coordinates).transpose() * slope);
    add_accelerations(rows(recovery_.of_accelerations).transpose() * slope, of_body, writer);
    if (body_.has_stiffening) {
      add_forces(rows(recovery_.of_stretching).transpose() * slope, of_body, writer);
    }
    for (const auto& [variable, change] : body_.constants_x) {
      const Stress derivative =
          evaluate(*change.stress, of_body, local, stretching).segment<6>(6 * channel);
      writer.add_design(variable, slope.dot(derivative));
      if (part_ == StressPart::utilization) {
        writer.add_design(variable,
                          -weight * part_of(stress) / recovery_.strength * change.stress->strength);
      }
    }
  }

 private:
  double part_of(const Stress& stress) const {
    if (part_ == StressPart::normal) return stress(0);
    return von_mises(stress) / (part_ == StressPart::utilization ? recovery_.strength : 1.0);
  }
  Stress slope_of(const Stress& stress) const {
    if (part_ == StressPart::normal) return Stress::Unit(0);
    return von_mises_slope(stress) / (part_ == StressPart::utilization ? recovery_.strength : 1.0);
  }

  static VectorXd evaluate(const StressRecovery& recovery, const BodyState& state,
                           const VectorXd& accelerations, const VectorXd& forces) {
    return recovery.of_coordinates * state.q() + recovery.of_accelerations * accelerations +
           recovery.of_stretching * forces;
  }

  /// Of all places against free fall, local axes.
  VectorXd accelerations(const BodyState& state) const {
    const FrameMotion<double> frame = state.frame();
    const auto places = static_cast<Eigen::Index>(body_.constants->places.size());
    VectorXd all(3 * places);
    for (Eigen::Index i = 0; i < places; ++i) {
      all.segment<3>(3 * i) =
          local_acceleration<double>(frame, gravity_, state.motion(static_cast<std::size_t>(i)));
    }
    return all;
  }

  /// κ ½ dᵀ Ĝ d of each element; zero where geometric stiffening is left out.
  VectorXd forces(const BodyState& state) const {
    VectorXd all = VectorXd::Zero(recovery_.of_stretching.cols());
    if (!body_.has_stiffening) return all;
    const Stretching& stretching = *body_.constants->stretching;
    const VectorXd d = stretching.displacements * state.q();
    for (Eigen::Index e = 0; e < all.size(); ++e) {
      const StretchedElement& element = stretching.elements[static_cast<std::size_t>(e)];
      const VectorXd part = d(element.displacements);
      all(e) = 0.5 * element.axial_stiffness * part.dot(element.slopes * part);
    }
    return all;
  }

  /// @param slopes  with respect to the accelerations of the places
  void add_accelerations(const VectorXd& slopes, const BodyState& state, GradientWriter& writer) {
    const FrameMotion<double> frame = state.frame();
    const FrameMotion<FrameDual> seeded = state.seeded_frame<FrameDual>();
    for (Eigen::Index i = 0; 3 * i < slopes.size(); ++i) {
      const Vector3d slope = slopes.segment<3>(3 * i);
      if (slope.isZero(0.0)) continue;
      const auto place = static_cast<std::size_t>(i);
      std::array<Vector3<FrameDual>, 3> motion;
      const auto fixed = state.motion(place);
      for (std::size_t k = 0; k < 3; ++k) motion[k] = fixed[k].cast<FrameDual>();
      const auto acceleration = local_acceleration<FrameDual>(seeded, gravity_, motion);
      for (int k = 0; k < 3; ++k) writer.add_frame(slope(k), acceleration(k).derivatives());
      writer.add_place(place,
                       {frame.omega.cross(frame.omega.cross(slope)) - frame.alpha.cross(slope),
                        2.0 * slope.cross(frame.omega), slope});
    }
  }

  /// @param slopes  with respect to the forces of the elements
  void add_forces(const VectorXd& slopes, const BodyState& state, GradientWriter& writer) {
    const Stretching& stretching = *body_.constants->stretching;
    const VectorXd d = stretching.displacements * state.q();
    VectorXd of_d = VectorXd::Zero(d.size());
    for (Eigen::Index e = 0; e < slopes.size(); ++e) {
      const auto index = static_cast<std::size_t>(e);
      const StretchedElement& element = stretching.elements[index];
      const VectorXd part = d(element.displacements);
      of_d(element.displacements) += slopes(e) * element.axial_stiffness * (element.slopes * part);
      for (const auto& [variable, change] : body_.constants_x) {
        const StretchedElement& derivative = change.stretching->elements[index];
        writer.add_design(variable,
                          0.5 * slopes(e) *
                              (derivative.axial_stiffness * part.dot(element.slopes * part) +
                               element.axial_stiffness * part.dot(derivative.slopes * part)));
      }
    }
    writer.add_elastic(stretching.displacements.transpose() * of_d);
    for (const auto& [variable, change] : body_.constants_x) {
      writer.add_design(variable, of_d.dot(change.stretching->displacements * state.q()));
    }
  }

  const BodyModel& body_;
  const StressRecovery& recovery_;
  Vector3d gravity_;
  StressPart part_;
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

std::unique_ptr<Signal> make_imported_stress_signal(const BodyModel& body, const Vector3d& gravity,
                                                    StressPart part) {
  return std::make_unique<ImportedStressSignal>(body, gravity, part);
}

}  // namespace pleuel
