#pragma once

#include <array>
#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

/// The common part of signals of one body: a formula in few local coordinates, written once for any
/// scalar type and differentiated by dual numbers.
namespace pleuel {

/// Coordinates of a body near one place: its frame, then the nodal displacements of up to three
/// neighbouring nodes (six each; zero where there is no coordinate).
template <class Scalar>
struct LocalMotion {
  static constexpr int max_size = 6 + 18;
  std::array<Scalar, max_size> q, v, a;
};

/// Frame and nodes of a body whose coordinates a formula may use.
struct LocalPlace {
  int first_node = 0;
  int nodes = 0;  ///< 0 for the frame alone
};

/// Base of signals that are formulas in LocalMotion. Derived provides
///     template <class Scalar> Scalar evaluate(const Beam<Scalar>&, const LocalMotion<Scalar>&, int
///     channel) const; LocalPlace place(int channel) const;
/// The model must outlive the signal.
/// @tparam Orders  which of positions, velocities and accelerations it depends on: the first so
/// many
template <class Derived, int Orders = 3>
class BodySignal : public Signal {
 public:
  explicit BodySignal(const BodyModel& body) : body_(body) {}

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    for (int channel = 0; channel < channels(); ++channel) {
      values(channel) =
          derived().template evaluate<double>(body_.beam, load<double>(state, channel), channel);
    }
  }

  void add_gradient(const State& state, int channel, double weight,
                    SignalGradient& gradient) override {
    add_state_gradient(state, channel, weight, gradient);
    for (const auto& [variable, beam] : body_.beam_x) {
      const Dual y = derived().template evaluate<Dual>(beam, load<Dual>(state, channel), channel);
      gradient.design(variable) += weight * derivative_of(y);
    }
  }

 protected:
  const BodyModel& body() const { return body_; }

  /// Kinematics of the frame from the local coordinates.
  template <class Scalar>
  FrameMotion<Scalar> frame(const LocalMotion<Scalar>& motion) const {
    using Map = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
    const int n = body_.frame.size();
    return frame_motion<Scalar>(body_.frame, Map(motion.q.data(), n), Map(motion.v.data(), n),
                                Map(motion.a.data(), n));
  }

  /// Nodal displacement (0 … 5) of a node of the place, counted from its first.
  int nodal(int node, int displacement) const {
    return body_.frame.size() + 6 * node + displacement;
  }

 private:
  static constexpr int size = LocalMotion<double>::max_size;
  using WideDual = DualOf<Orders * size>;

  const Derived& derived() const { return static_cast<const Derived&>(*this); }

  /// Index in q of a local coordinate, or −1.
  int global(const LocalPlace& place, int local) const {
    const int frame = body_.frame.size();
    if (local < frame) return body_.frame.offset + local;
    const int node = (local - frame) / 6;
    if (node >= place.nodes) return -1;
    return body_.coordinate(place.first_node + node, (local - frame) % 6);
  }

  template <class Scalar>
  LocalMotion<Scalar> load(const State& state, int channel) const {
    const LocalPlace place = derived().place(channel);
    LocalMotion<Scalar> motion;
    for (int i = 0; i < size; ++i) {
      const int index = global(place, i);
      const auto k = static_cast<std::size_t>(i);
      motion.q[k] = Scalar(index < 0 ? 0.0 : state.q(index));
      motion.v[k] = Scalar(index < 0 ? 0.0 : state.v(index));
      motion.a[k] = Scalar(index < 0 ? 0.0 : state.a(index));
    }
    return motion;
  }

  /// The beam as constants, cast once: it is large.
  const Beam<WideDual>& wide_beam();

  void add_state_gradient(const State& state, int channel, double weight,
                          SignalGradient& gradient) {
    LocalMotion<WideDual> motion = load<WideDual>(state, channel);
    for (int i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      motion.q[k].derivatives()[i] = 1.0;
      if constexpr (Orders > 1) motion.v[k].derivatives()[size + i] = 1.0;
      if constexpr (Orders > 2) motion.a[k].derivatives()[2 * size + i] = 1.0;
    }
    const WideDual y = derived().template evaluate<WideDual>(wide_beam(), motion, channel);
    const LocalPlace place = derived().place(channel);
    for (int i = 0; i < size; ++i) {
      const int index = global(place, i);
      if (index < 0) continue;
      gradient.q(index) += weight * y.derivatives()[i];
      if constexpr (Orders > 1) gradient.v(index) += weight * y.derivatives()[size + i];
      if constexpr (Orders > 2) gradient.a(index) += weight * y.derivatives()[2 * size + i];
    }
  }

  const BodyModel& body_;
  std::unique_ptr<const Beam<WideDual>> wide_beam_;
};

/// The same beam in another scalar type, as constants.
template <class To>
Beam<To> cast_beam(const Beam<double>& beam) {
  Beam<To> cast;
  for (const BeamElement<double>& from : beam.elements) {
    BeamElement<To> element;
    element.length = To(from.length);
    element.young = To(from.young);
    element.shear = To(from.shear);
    element.density = To(from.density);
    element.strength = To(from.strength);
    const SectionProperties<double>& section = from.section;
    element.section.area = To(section.area);
    element.section.inertia_y = To(section.inertia_y);
    element.section.inertia_z = To(section.inertia_z);
    element.section.torsion = To(section.torsion);
    element.section.radius_y = To(section.radius_y);
    element.section.radius_z = To(section.radius_z);
    for (const StressPoint<double>& point : section.points) {
      element.section.points.push_back({To(point.y), To(point.z), To(point.shear)});
    }
    cast.elements.push_back(std::move(element));
  }
  cast.mass_damping = To(beam.mass_damping);
  cast.stiffness_damping = To(beam.stiffness_damping);
  return cast;
}

template <class Derived, int Orders>
const Beam<typename BodySignal<Derived, Orders>::WideDual>&
BodySignal<Derived, Orders>::wide_beam() {
  if (!wide_beam_) {
    wide_beam_ = std::make_unique<const Beam<WideDual>>(cast_beam<WideDual>(body_.beam));
  }
  return *wide_beam_;
}

}  // namespace pleuel
