#include "core/response/imported_stress_signal.hpp"

#include <cmath>

#include "core/response/imported_state.hpp"
#include "core/response/place_kinematics.hpp"

namespace pleuel {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

using FrameDual = DualOf<3 * most_frame_coordinates>;

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
    const ImportedState of_body(body_, state);
    const VectorXd stress = evaluate(recovery_, of_body, accelerations(of_body), forces(of_body));
    for (int i = 0; i < channels(); ++i) values(i) = part_of(stress.segment<6>(6 * i));
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const ImportedState of_body(body_, state);
    const VectorXd local = accelerations(of_body), stretching = forces(of_body);
    const Stress stress = evaluate(recovery_, of_body, local, stretching).segment<6>(6 * channel);
    const Stress slope = weight * slope_of(stress);
    ImportedGradient writer(body_, of_body, gradient);
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

  static VectorXd evaluate(const StressRecovery& recovery, const ImportedState& state,
                           const VectorXd& accelerations, const VectorXd& forces) {
    return recovery.of_coordinates * state.q() + recovery.of_accelerations * accelerations +
           recovery.of_stretching * forces;
  }

  /// Of all places against free fall, local axes.
  VectorXd accelerations(const ImportedState& state) const {
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
  VectorXd forces(const ImportedState& state) const {
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
  void add_accelerations(const VectorXd& slopes, const ImportedState& state,
                         ImportedGradient& writer) {
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
  void add_forces(const VectorXd& slopes, const ImportedState& state, ImportedGradient& writer) {
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

std::unique_ptr<Signal> make_imported_stress_signal(const BodyModel& body, const Vector3d& gravity,
                                                    StressPart part) {
  return std::make_unique<ImportedStressSignal>(body, gravity, part);
}

}  // namespace pleuel
