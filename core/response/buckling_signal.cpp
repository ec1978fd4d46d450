#include "core/response/buckling_signal.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/int_size.hpp"
#include "core/response/section_force_signal.hpp"

namespace pleuel {

namespace {

/// Bending in the local x–y plane and in the x–z plane, whether the motion has both or not.
enum class Plane { y, z };

template <class Scalar>
const Scalar& shear_compliance(const BeamElement<Scalar>& element, Plane plane) {
  return plane == Plane::y ? element.shear_compliance_y : element.shear_compliance_z;
}

template <class Scalar>
Scalar inertia(const SectionProperties<Scalar>& section, Plane plane) {
  return plane == Plane::y ? section.inertia_z : section.inertia_y;
}

/// Whether all sections are as stiff along one axis as along the other, at neighbouring designs,
/// too.
bool is_equal_in_both(const BodyModel& body) {
  constexpr double round_off = 1e-12;
  const auto differ = [](double a, double b) { return std::abs(a - b) > round_off * std::abs(b); };
  for (const BeamElement<double>& element : body.beam.elements) {
    if (differ(element.section.inertia_y, element.section.inertia_z)) return false;
    if (differ(element.shear_compliance_y, element.shear_compliance_z)) return false;
  }
  const auto derivatives_differ = [&](const Dual& a, const Dual& b) {
    return differ(derivative_of(a), derivative_of(b));
  };
  for (const auto& [variable, beam] : body.beam_x) {
    for (const BeamElement<Dual>& element : beam.elements) {
      const SectionProperties<Dual>& s = element.section;
      if (derivatives_differ(s.inertia_y, s.inertia_z)) return false;
      if (derivatives_differ(element.shear_compliance_y, element.shear_compliance_z)) return false;
    }
  }
  return true;
}

/// Of the section with the least.
template <class Scalar>
Scalar euler_load(const Beam<Scalar>& beam, Plane plane) {
  constexpr double pi = std::numbers::pi;
  const Scalar length = beam.node_position(beam.node_count() - 1);
  Scalar least(std::numeric_limits<double>::infinity());
  for (const BeamElement<Scalar>& element : beam.elements) {
    const Scalar stiffness = element.young * inertia(element.section, plane);
    Scalar load = pi * pi * stiffness / (length * length);
    const Scalar& compliance = shear_compliance(element, plane);
    if (value_of(compliance) != 0.0) load = load / (1.0 + load * compliance);
    if (value_of(load) < value_of(least)) least = load;
  }
  return least;
}

class CompressionQuantity : public OneASection {
 public:
  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>&,
                                   const SectionForces<Force>& forces, Point) const {
    return -forces.axial;
  }
};

/// The channels of a compression over each of several loads, load by load.
class BucklingSignal final : public Signal {
 public:
  BucklingSignal(std::unique_ptr<Signal> compression, std::vector<EulerLoad> loads)
      : compression_(std::move(compression)),
        loads_(std::move(loads)),
        values_(compression_->channels()) {}

  int channels() const override { return int_size(loads_) * places(); }
  std::string describe(int channel) const override {
    return compression_->describe(channel % places()) + load_of(channel).name;
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    compression_->observe(state, values_);
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      values.segment(static_cast<Eigen::Index>(i) * places(), places()) = values_ / loads_[i].value;
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    const EulerLoad& load = load_of(channel);
    const int place = channel % places();
    compression_->observe(state, values_);
    compression_->add_gradient(state, place, weight / load.value, gradient);
    const double slope = -values_(place) / (load.value * load.value);
    gradient.design += weight * slope * load.derivatives;
  }

 private:
  int places() const { return int_size(values_); }
  const EulerLoad& load_of(int channel) const {
    return loads_[static_cast<std::size_t>(channel / places())];
  }

  std::unique_ptr<Signal> compression_;
  std::vector<EulerLoad> loads_;
  Eigen::VectorXd values_;  ///< of the compression
};

}  // namespace

std::unique_ptr<Signal> make_buckling_signal(std::unique_ptr<Signal> compression,
                                             std::vector<EulerLoad> loads) {
  return std::make_unique<BucklingSignal>(std::move(compression), std::move(loads));
}

std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity) {
  return make_section_signal(body, gravity, {}, CompressionQuantity());
}

std::vector<EulerLoad> euler_loads(const BodyModel& body, int variables) {
  std::vector<EulerLoad> loads;
  const auto add = [&](Plane plane, const char* name) {
    EulerLoad load{euler_load(body.beam, plane), Eigen::VectorXd::Zero(variables), name};
    for (const auto& [variable, beam] : body.beam_x) {
      load.derivatives(variable) = derivative_of(euler_load(beam, plane));
    }
    loads.push_back(std::move(load));
  };
  if (is_equal_in_both(body)) {
    add(Plane::y, "");
  } else {
    add(Plane::y, ", bending along y");
    add(Plane::z, ", bending along z");
  }
  return loads;
}

}  // namespace pleuel
