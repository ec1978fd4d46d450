#pragma once

#include <fmt/format.h>

#include "core/beam/beam_shape.hpp"
#include "core/response/body_signal.hpp"
#include "core/response/element_forces.hpp"
#include "core/response/place_kinematics.hpp"
#include "core/response/station.hpp"
#include "core/section/section_stress.hpp"

/// The common part of signals that are made from the section forces of a beam.
namespace pleuel {

/// Section forces are those of the element (N from its strain, M = EI v″) plus the fixed-end terms
/// of the inertia load w = −ρA a, linear in the element: without them moments at nodes are off by
/// wℓ²/12. Where two elements of one segment meet, their section forces are averaged.
///
/// Quantity says what is made of them:
///     std::vector<int> points(const BodyModel&, const SectionProperties<double>&) const;
///     template <class Scalar> Scalar evaluate(const Beam<Scalar>&,
///         const SectionProperties<Scalar>&, const SectionForces<Scalar>&, int point) const;
/// One channel a station and point; points from 0 are those of the section, negative ones belong to
/// the quantity.
template <class Quantity>
class SectionSignal final : public BodySignal<SectionSignal<Quantity>> {
  using Base = BodySignal<SectionSignal<Quantity>>;

 public:
  SectionSignal(const BodyModel& body, const Eigen::Vector3d& gravity, const StationChoice& choice,
                Quantity quantity)
      : Base(body),
        gravity_(gravity),
        quantity_(std::move(quantity)),
        stations_(find_stations(body, choice)) {
    for (int s = 0; s < static_cast<int>(stations_.size()); ++s) {
      for (int point : quantity_.points(body, section_of(body.beam, s))) {
        channels_.push_back({s, point});
      }
    }
  }

  int channels() const override { return static_cast<int>(channels_.size()); }

  std::string describe(int channel) const override {
    const Channel& c = channels_[static_cast<std::size_t>(channel)];
    const Station& station = stations_[static_cast<std::size_t>(c.station)];
    const double place = this->body().stretch.first_element + station.place;
    if (c.point < 0) {
      std::string what;
      if constexpr (requires { quantity_.name(c.point); }) what = quantity_.name(c.point);
      return fmt::format("node {}{}", place, what);
    }
    const auto& point =
        section_of(this->body().beam, c.station).points[static_cast<std::size_t>(c.point)];
    return fmt::format("node {}, y = {:.4g} m, z = {:.4g} m", place, point.y, point.z);
  }

  LocalPlace place(int channel) const {
    const Station& station = station_of(channel);
    return {station.elements.front(), static_cast<int>(station.elements.size()) + 1};
  }

  /// All channels share one evaluation of the body.
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    const BodyModel& body = this->body();
    const int first = body.frame.offset, m = body.frame.size();
    const FrameMotion<double> frame =
        frame_motion<double>(body.frame, state.q.segment(first, m), state.v.segment(first, m),
                             state.a.segment(first, m));
    const int nodes = body.beam.node_count();
    nodal_q_.resize(6, nodes);
    accelerations_.resize(3, nodes);
    double x = 0.0;
    for (int node = 0; node < nodes; ++node) {
      std::array<Eigen::Vector3d, 3> motion;  // displacement, rate, acceleration
      for (int i = 0; i < 6; ++i) {
        const int index = body.coordinate(node, i);
        nodal_q_(i, node) = index < 0 ? 0.0 : state.q(index);
        if (i >= 3) continue;
        motion[0](i) = nodal_q_(i, node);
        motion[1](i) = index < 0 ? 0.0 : state.v(index);
        motion[2](i) = index < 0 ? 0.0 : state.a(index);
      }
      motion[0](0) += x;
      accelerations_.col(node) = local_acceleration<double>(frame, gravity_, motion);
      if (node + 1 < nodes) x += body.beam.elements[static_cast<std::size_t>(node)].length;
    }
    SectionForces<double> forces;
    int station = -1;
    for (int channel = 0; channel < channels(); ++channel) {
      const Channel& c = channels_[static_cast<std::size_t>(channel)];
      if (c.station != station) {
        station = c.station;
        forces = station_forces<double>(
            body.beam, station, [&](int node, int i) { return nodal_q_(i, node); },
            [&](int node) { return Eigen::Vector3d(accelerations_.col(node)); });
      }
      values(channel) =
          quantity_.evaluate(body.beam, section_of(body.beam, station), forces, c.point);
    }
  }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion, int channel) const {
    const Channel& c = channels_[static_cast<std::size_t>(channel)];
    const int first = station_of(channel).elements.front();
    const FrameMotion<Scalar> frame = this->frame(motion);
    const auto displacement = [&](int node, int i) {
      return motion.q[static_cast<std::size_t>(this->nodal(node - first, i))];
    };
    const auto accelerated = [&](int node) {
      std::array<Vector3<Scalar>, 3> local;
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(this->nodal(node - first, i));
        local[0](i) = motion.q[k];
        local[1](i) = motion.v[k];
        local[2](i) = motion.a[k];
      }
      local[0](0) += beam.node_position(node);
      return local_acceleration<Scalar>(frame, gravity_, local);
    };
    return quantity_.evaluate(beam, section_of(beam, c.station),
                              station_forces<Scalar>(beam, c.station, displacement, accelerated),
                              c.point);
  }

 private:
  const Station& station_of(int channel) const {
    return stations_[static_cast<std::size_t>(
        channels_[static_cast<std::size_t>(channel)].station)];
  }

  template <class Scalar>
  const SectionProperties<Scalar>& section_of(const Beam<Scalar>& beam, int station) const {
    const int element = stations_[static_cast<std::size_t>(station)].elements.front();
    return beam.elements[static_cast<std::size_t>(element)].section;
  }

  /// @param displacement  (node, 0 … 5) → nodal displacement
  /// @param accelerated   node → acceleration, local axes
  template <class Scalar, class Displacement, class Acceleration>
  SectionForces<Scalar> station_forces(const Beam<Scalar>& beam, int s,
                                       const Displacement& displacement,
                                       const Acceleration& accelerated) const {
    const Station& station = stations_[static_cast<std::size_t>(s)];
    SectionForces<Scalar> sum;
    const double share = 1.0 / static_cast<double>(station.elements.size());
    for (int index : station.elements) {
      Eigen::Matrix<Scalar, 12, 1> q;
      for (int i = 0; i < 12; ++i) q(i) = displacement(index + i / 6, i % 6);
      const BeamElement<Scalar>& element = beam.elements[static_cast<std::size_t>(index)];
      const auto forces = element_forces<Scalar>(element, q, elongation(element, q),
                                                 {accelerated(index), accelerated(index + 1)},
                                                 station.place - index);
      sum.axial += share * forces.axial;
      sum.moment_y += share * forces.moment_y;
      sum.moment_z += share * forces.moment_z;
      sum.torque += share * forces.torque;
    }
    return sum;
  }

  template <class Scalar>
  Scalar elongation(const BeamElement<Scalar>& element,
                    const Eigen::Matrix<Scalar, 12, 1>& q) const {
    const Scalar linear = q(6) - q(0);
    if (!this->body().has_stiffening) return linear;
    return linear + 0.5 * (slope_integral<Scalar>(q(7) - q(1), q(5), q(11), element.length) +
                           slope_integral<Scalar>(q(8) - q(2), -q(4), -q(10), element.length));
  }

  /// One number of a station.
  struct Channel {
    int station;
    int point;  ///< as Quantity names it
  };

  Eigen::Vector3d gravity_;
  Quantity quantity_;
  std::vector<Station> stations_;
  std::vector<Channel> channels_;
  Eigen::MatrixXd nodal_q_, accelerations_;  ///< scratch of observe()
};

}  // namespace pleuel
