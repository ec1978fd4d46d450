#include "picture/section_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/model/scene_geometry.hpp"

namespace pleuel {

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// @param height  along y
Points rectangle(double height, double width) {
  const double y = height / 2.0, z = width / 2.0;
  return {{y, -z}, {y, z}, {-y, z}, {-y, -z}};
}

Points ellipse(double height, double width) {
  constexpr int corners = 32;
  Points points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    points.emplace_back(height / 2.0 * std::cos(angle), width / 2.0 * std::sin(angle));
  }
  return points;
}

Points i_shape(double height, double width, double flange, double web) {
  const double y = height / 2.0, z = width / 2.0, inner_y = y - flange, inner_z = web / 2.0;
  return {
      {y, -z}, {y, z},   {inner_y, z},   {inner_y, inner_z},   {-inner_y, inner_z}, {-inner_y, z},
      {-y, z}, {-y, -z}, {-inner_y, -z}, {-inner_y, -inner_z}, {inner_y, -inner_z}, {inner_y, -z}};
}

struct OutlineMaker {
  const Design<double>& design;
  double of(const Number& number) const { return resolve(number, design); }

  SectionOutline operator()(const RectangleSection& s) const {
    return {rectangle(of(s.height), of(s.width)), {}};
  }
  SectionOutline operator()(const CircleSection& s) const {
    return {ellipse(of(s.diameter), of(s.diameter)), {}};
  }
  SectionOutline operator()(const TubeSection& s) const {
    const double outer = of(s.outer_diameter), hole = outer - 2.0 * of(s.thickness);
    return {ellipse(outer, outer), hole > 0.0 ? ellipse(hole, hole) : Points{}};
  }
  SectionOutline operator()(const EllipseSection& s) const {
    return {ellipse(of(s.height), of(s.width)), {}};
  }
  SectionOutline operator()(const BoxSection& s) const {
    const double walls = 2.0 * of(s.thickness);
    const double height = of(s.height) - walls, width = of(s.width) - walls;
    const bool has_hole = height > 0.0 && width > 0.0;
    return {rectangle(of(s.height), of(s.width)), has_hole ? rectangle(height, width) : Points{}};
  }
  SectionOutline operator()(const ISection& s) const {
    return {i_shape(of(s.height), of(s.width), of(s.flange_thickness), of(s.web_thickness)), {}};
  }
  SectionOutline operator()(const GeneralSection& s) const {
    const double area = of(s.area);
    return {rectangle(std::sqrt(12.0 * of(s.inertia_z) / area),
                      std::sqrt(12.0 * of(s.inertia_y) / area)),
            {},
            false};
  }
};

}  // namespace

SectionOutline section_outline(const Section& section, const Design<double>& design) {
  return std::visit(OutlineMaker{design}, section);
}

namespace {

/// Of the length, for the tangent.
constexpr double difference = 1e-4;

/// The deformed axis.
class Axis {
 public:
  Axis(const BodyTrack& motion, Eigen::Index instant) : motion_(motion), instant_(instant) {}

  Eigen::Vector3d position(double share) const {
    const auto [k, part] = place(share);
    return (1.0 - part) * station(k) + part * station(k + 1);
  }

  bool has_stress() const { return motion_.stress.size() > 0; }

  double stress(double share) const {
    const auto [k, part] = place(share);
    return (1.0 - part) * motion_.stress(k, instant_) + part * motion_.stress(k + 1, instant_);
  }

  /// Columns: local y and z of the section.
  Eigen::Matrix<double, 3, 2> section_axes(double share) const {
    const Eigen::Vector3d x =
        position(std::min(share + difference, 1.0)) - position(std::max(share - difference, 0.0));
    const auto [k, part] = place(share);
    const auto frame = motion_.parts[part < 0.5 ? k : k + 1];
    const Eigen::Quaterniond turn(
        Eigen::Vector4d(motion_.rotations.block<4, 1>(4 * frame, instant_)));
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(1) = x.cross(turn * Eigen::Vector3d::UnitY()).normalized();
    axes.col(0) = axes.col(1).cross(x).normalized();
    return axes;
  }

 private:
  struct Place {
    Eigen::Index before;  ///< station
    double part;          ///< of the way to the next one
  };

  Place place(double share) const {
    const std::vector<double>& stations = motion_.stations;
    const auto next = std::upper_bound(stations.begin() + 1, stations.end() - 1, share);
    const auto k = static_cast<std::size_t>(next - stations.begin()) - 1;
    return {static_cast<Eigen::Index>(k), (share - stations[k]) / (stations[k + 1] - stations[k])};
  }

  Eigen::Vector3d station(Eigen::Index k) const {
    return motion_.positions.block<3, 1>(3 * k, instant_);
  }

  const BodyTrack& motion_;
  Eigen::Index instant_;
};

/// Both ends of a segment and the stations between.
std::vector<double> shares_of(const std::vector<double>& stations, double begin, double end) {
  std::vector<double> shares = {begin};
  for (const double station : stations) {
    if (station > begin + difference && station < end - difference) shares.push_back(station);
  }
  shares.push_back(end);
  return shares;
}

class Sweep {
 public:
  explicit Sweep(const Axis& axis) : axis_(axis) {}

  void add_segment(const SectionOutline& outline, const std::vector<double>& shares) {
    const int outer = add_rings(outline.outer, shares);
    const int around = int_size(outline.outer);
    const int last = int_size(shares) - 1;
    add_sides(outer, around, last, 1);
    const bool has_hole = !outline.inner.empty() && outline.inner.size() == outline.outer.size();
    if (!has_hole) {
      add_end(outer, around, -1);
      add_end(outer + last * around, around, 1);
      return;
    }
    const int inner = add_rings(outline.inner, shares);
    add_sides(inner, around, last, -1);
    add_end_with_hole(outer, inner, around, -1);
    add_end_with_hole(outer + last * around, inner + last * around, around, 1);
  }

  SweptSurface take() {
    const Eigen::Index count = points_.size();
    surface_.points.resize(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      surface_.points.col(i) = points_[i];
    }
    surface_.stress = Eigen::Map<const Eigen::VectorXd>(stress_.data(), stress_.size());
    return std::move(surface_);
  }

 private:
  /// @returns number of the first point
  int add_rings(const std::vector<Eigen::Vector2d>& outline, const std::vector<double>& shares) {
    const int first = int_size(points_);
    for (const double share : shares) {
      const Eigen::Vector3d position = axis_.position(share);
      const Eigen::Matrix<double, 3, 2> axes = axis_.section_axes(share);
      for (const Eigen::Vector2d& point : outline) {
        points_.push_back(position + axes * point);
        if (axis_.has_stress()) stress_.push_back(axis_.stress(share));
      }
    }
    return first;
  }

  /// @param side  1: outwards from the ring, −1: into the hole
  void add_sides(int first, int around, int intervals, int side) {
    for (int i = 0; i < intervals; ++i) {
      for (int k = 0; k < around; ++k) {
        const int a = first + i * around + k, b = first + i * around + (k + 1) % around;
        add_face({a, b, b + around, a + around}, side);
      }
    }
  }

  /// @param side  1: seen from behind the end of the axis, −1: from before its begin
  void add_end(int first, int around, int side) {
    std::vector<int> face;
    for (int k = 0; k < around; ++k) face.push_back(first + k);
    add_face(std::move(face), side);
  }

  void add_end_with_hole(int outer, int inner, int around, int side) {
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      add_face({outer + k, outer + next, inner + next, inner + k}, side);
    }
  }

  void add_face(std::vector<int> face, int side) {
    if (side < 0) std::reverse(face.begin(), face.end());
    surface_.faces.push_back(std::move(face));
  }

  const Axis& axis_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> stress_;
  SweptSurface surface_;
};

}  // namespace

SweptSurface swept_beam(const BeamBody& beam, const Design<double>& design, const BodyTrack& motion,
                        Eigen::Index instant) {
  const Axis axis(motion, instant);
  Sweep sweep(axis);
  const std::vector<double> fractions = length_fractions(beam);
  double begin = 0.0;
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const double end = i + 1 < beam.segments.size() ? begin + fractions[i] : 1.0;
    sweep.add_segment(section_outline(beam.segments[i].section, design),
                      shares_of(motion.stations, begin, end));
    begin = end;
  }
  return sweep.take();
}

}  // namespace pleuel
