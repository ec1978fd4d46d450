#include "core/response/stress_signal.hpp"

#include <fmt/format.h>

#include "core/beam/beam_shape.hpp"
#include "core/response/body_signal.hpp"

namespace pleuel {

namespace {

/// Section forces in local axes: M_y, M_z such that σ = N/A − M_z y/I_z + M_y z/I_y.
template <class Scalar>
struct SectionForces {
  Scalar axial = Scalar(0), moment_y = Scalar(0), moment_z = Scalar(0), torque = Scalar(0);
};

/// A section at which stress is evaluated: a node, seen from one or two elements.
struct Station {
  std::vector<int> elements;  ///< adjacent, ascending
  int node;
};

/// One stress point of a station; `sign` of a round section's axial stress.
struct Channel {
  int station;
  int point;         ///< index in the section's points, −1: resultant moment of a round section
  double sign = 1.0;
};

std::vector<Station> find_stations(const BodyModel& body, std::optional<int> segment) {
  std::vector<Station> stations;
  const int elements = static_cast<int>(body.beam.elements.size());
  const auto segment_of = [&](int e) { return body.segment_of_element[static_cast<std::size_t>(e)]; };
  for (int e = 0; e < elements; ++e) {
    if (segment && segment_of(e) != *segment) continue;
    const bool continues = e > 0 && segment_of(e - 1) == segment_of(e);
    if (continues) {
      stations.back().elements.push_back(e);
    } else {
      stations.push_back({{e}, e});
    }
    stations.push_back({{e}, e + 1});
  }
  return stations;
}

/// In planar motion, points that differ only across the plane see the same stress.
std::vector<int> distinct_points(const BodyModel& body, const SectionProperties<double>& section) {
  const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
  const Eigen::Vector3d normal = body.frame.reference.transpose() * body.frame.axis;
  const bool bends_along_y = std::abs(normal.z()) > 0.5;
  std::vector<int> distinct;
  for (int i = 0; i < static_cast<int>(section.points.size()); ++i) {
    const auto lever = [&](int k) {
      const StressPoint<double>& point = section.points[static_cast<std::size_t>(k)];
      return bends_along_y ? point.y : point.z;
    };
    bool is_new = !is_planar || lever(i) != 0.0;
    for (int other : distinct) is_new = is_new && !(is_planar && lever(other) == lever(i));
    if (is_new) distinct.push_back(i);
  }
  return distinct;
}

class StressSignal final : public BodySignal<StressSignal> {
 public:
  StressSignal(const BodyModel& body, const Eigen::Vector3d& gravity, std::optional<int> segment)
      : BodySignal(body), gravity_(gravity), stations_(find_stations(body, segment)) {
    const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
    for (int s = 0; s < static_cast<int>(stations_.size()); ++s) {
      const auto& section = section_of(body.beam, s);
      if (section.radius > 0.0 && !is_planar) {
        channels_.push_back({s, -1, 1.0});
        channels_.push_back({s, -1, -1.0});
        continue;
      }
      for (int point : distinct_points(body, section)) channels_.push_back({s, point});
    }
  }

  int channels() const override { return static_cast<int>(channels_.size()); }

  std::string describe(int channel) const override {
    const Channel& c = channels_[static_cast<std::size_t>(channel)];
    const Station& station = stations_[static_cast<std::size_t>(c.station)];
    if (c.point < 0) return fmt::format("node {}", station.node);
    const auto& point =
        section_of(body().beam, c.station).points[static_cast<std::size_t>(c.point)];
    return fmt::format("node {}, y = {:.4g} m, z = {:.4g} m", station.node, point.y, point.z);
  }

  LocalPlace place(int channel) const {
    const Station& station = station_of(channel);
    return {station.elements.front(), static_cast<int>(station.elements.size()) + 1};
  }

  /// All channels of a station share its section forces.
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    BodySignal::observe(state, values);
  }

  template <class Scalar>
  Scalar evaluate(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion, int channel) const {
    using std::sqrt;
    const Channel& c = channels_[static_cast<std::size_t>(channel)];
    const SectionForces<Scalar> forces = station_forces(beam, motion, c.station);
    const SectionProperties<Scalar>& section = section_of(beam, c.station);
    Scalar normal, shear;
    if (c.point < 0) {
      const Scalar moment = sqrt(forces.moment_y * forces.moment_y +
                                 forces.moment_z * forces.moment_z + 1e-300);
      normal = c.sign * forces.axial / section.area + moment * section.radius / section.inertia_z;
      shear = forces.torque * section.radius / section.torsion;
    } else {
      const StressPoint<Scalar>& point = section.points[static_cast<std::size_t>(c.point)];
      normal = forces.axial / section.area - forces.moment_z * point.y / section.inertia_z +
               forces.moment_y * point.z / section.inertia_y;
      shear = forces.torque * point.shear;
    }
    return sqrt(normal * normal + 3.0 * shear * shear + 1e-300);
  }

 private:
  const Station& station_of(int channel) const {
    return stations_[static_cast<std::size_t>(channels_[static_cast<std::size_t>(channel)].station)];
  }

  template <class Scalar>
  const SectionProperties<Scalar>& section_of(const Beam<Scalar>& beam, int station) const {
    const int element = stations_[static_cast<std::size_t>(station)].elements.front();
    return beam.elements[static_cast<std::size_t>(element)].section;
  }

  template <class Scalar>
  SectionForces<Scalar> station_forces(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion,
                                       int s) const {
    const Station& station = stations_[static_cast<std::size_t>(s)];
    const FrameMotion<Scalar> frame = this->frame(motion);
    SectionForces<Scalar> sum;
    const double share = 1.0 / static_cast<double>(station.elements.size());
    for (std::size_t i = 0; i < station.elements.size(); ++i) {
      const int element = station.elements[i];
      const auto forces = element_forces(beam, motion, frame, element, static_cast<int>(i),
                                         station.node == element ? 0 : 1);
      sum.axial += share * forces.axial;
      sum.moment_y += share * forces.moment_y;
      sum.moment_z += share * forces.moment_z;
      sum.torque += share * forces.torque;
    }
    return sum;
  }

  /// Inertia (and weight) per length at a node of the place: w = −ρA a, a = a₀ + X p + Y u̇ + ü.
  template <class Scalar>
  Vector3<Scalar> load_at(const BeamElement<Scalar>& element, const Scalar& x,
                          const LocalMotion<Scalar>& motion, const FrameMotion<Scalar>& frame,
                          int node) const {
    Vector3<Scalar> p(x, Scalar(0), Scalar(0)), rate, acceleration;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(nodal(node, i));
      p(i) += motion.q[k];
      rate(i) = motion.v[k];
      acceleration(i) = motion.a[k];
    }
    const Vector3<Scalar> spin = frame.omega.cross(p) + 2.0 * rate;
    acceleration += frame.alpha.cross(p) + frame.omega.cross(spin);
    acceleration += frame.A.transpose() * (frame.r_ddot - gravity_.template cast<Scalar>());
    return (-element.density * element.section.area) * acceleration;
  }

  template <class Scalar>
  Scalar axial_strain(const BeamElement<Scalar>& element, const ElementRow<Scalar>& q) const {
    Scalar elongation = q(6) - q(0);
    if (body().has_stiffening) {
      for (const GaussPoint& point : gauss_points) {
        const Scalar v = deflection_y_row(point.xi, element.length, 1).dot(q);
        const Scalar w = deflection_z_row(point.xi, element.length, 1).dot(q);
        elongation += 0.5 * point.weight * element.length * (v * v + w * w);
      }
    }
    return elongation / element.length;
  }

  /// @param local  position of the element in the place (0 or 1);  @param end  0 or 1
  template <class Scalar>
  SectionForces<Scalar> element_forces(const Beam<Scalar>& beam, const LocalMotion<Scalar>& motion,
                                       const FrameMotion<Scalar>& frame, int index, int local,
                                       int end) const {
    const BeamElement<Scalar>& element = beam.elements[static_cast<std::size_t>(index)];
    const Scalar& length = element.length;
    ElementRow<Scalar> q;
    for (int i = 0; i < 12; ++i) {
      q(i) = motion.q[static_cast<std::size_t>(nodal(local + i / 6, i % 6))];
    }
    const Vector3<Scalar> first =
        load_at(element, beam.node_position(index), motion, frame, local);
    const Vector3<Scalar> second =
        load_at(element, beam.node_position(index + 1), motion, frame, local + 1);
    // Ends of a clamped element under a linear load: EI v″ = ℓ²(3w₁ + 2w₂)/60, EA u' = ±ℓ(2w₁ + w₂)/6
    const Vector3<Scalar> near = end == 0 ? first : second, far = end == 0 ? second : first;
    const Vector3<Scalar> clamped = (length * length / 60.0) * (3.0 * near + 2.0 * far);
    const Scalar sign(end == 0 ? 1.0 : -1.0);

    SectionForces<Scalar> forces;
    forces.axial = element.young * element.section.area * axial_strain(element, q) +
                   sign * length / 6.0 * (2.0 * near(0) + far(0));
    const Scalar curvature_y = deflection_y_row(double(end), length, 2).dot(q);
    const Scalar curvature_z = deflection_z_row(double(end), length, 2).dot(q);
    forces.moment_z = element.young * element.section.inertia_z * curvature_y + clamped(1);
    forces.moment_y = -(element.young * element.section.inertia_y * curvature_z + clamped(2));
    forces.torque = element.shear * element.section.torsion * (q(9) - q(3)) / length;
    return forces;
  }

  Eigen::Vector3d gravity_;
  std::vector<Station> stations_;
  std::vector<Channel> channels_;
};

}  // namespace

std::unique_ptr<Signal> make_stress_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                           std::optional<int> segment) {
  return std::make_unique<StressSignal>(body, gravity, segment);
}

}  // namespace pleuel
