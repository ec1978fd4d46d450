#include "core/trust/geometric_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/beam_shape.hpp"
#include "core/trust/beam_state.hpp"

namespace pleuel {

double GeometricError::largest() const {
  return std::max({deflection, position, rotation, curvature, strain});
}

std::string GeometricError::most() const {
  const double most = largest();
  if (most == strain) return "its length";
  if (most == deflection) return "its deflection";
  if (most == curvature) return "its curvature and stress";
  return most == rotation ? "the rotation of its nodes" : "its shortening by bending";
}

namespace {

/// Share of its buckling load up to which a pressed beam makes more of moments.
constexpr double nearest_to_buckling = 0.95;

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What is integrated as one piece: so many of them an element, and a beam. With n in a beam its
/// shortening by bending is 1/(4n²) off.
constexpr int least_of_element = 4, least_of_beam = 48;

int pieces_of_element(const BodyModel& body) {
  const int elements = int_size(body.beam.elements);
  return std::max(least_of_element, (least_of_beam + elements - 1) / elements);
}

/// Rotations, and displacements over the length, that say nothing.
constexpr double shape_round_off = 1e-9;

/// The middle of a piece in the linear solution.
struct Piece {
  double length;         ///< [m]
  Vector3d curvature;    ///< κ [1/m]
  Vector3d stiffness;    ///< D = GJ, EI_y, EI_z [N m²]
  double strain;         ///< ε
  double axial;          ///< EA [N]; 0 where elongation is no coordinate
  Vector3d angle;        ///< γ of shear along y and z, in sections
  Vector3d compliance;   ///< 1/(κGA) [1/N]
  Vector3d load;         ///< Q [N], frame axes
  Vector3d linear_rate;  ///< what the linear equations have in place of r' × Q [N]
};

/// A beam axis in the frame at the ends of all pieces, and directions there.
struct Shape {
  std::vector<Vector3d> position;
  std::vector<Matrix3d> rotation;
};

class ExactBeam {
 public:
  ExactBeam(const BodyModel& body, const Eigen::MatrixXd& nodal)
      : body_(body), in_frame_(nodal), nodal_(nodal), pieces_an_element_(pieces_of_element(body)) {
    if (body.condition == ReferenceCondition::mean_axis) lay_on_chord(nodal_);
    for (int e = 0; e + 1 < nodal.cols(); ++e) add_element(e);
  }

  GeometricError error() {
    const std::vector<Piece> linear = pieces_;
    correct(integrate());
    GeometricError error;
    compare_curvatures(linear, error);
    compare_shapes(integrate(), linear, error);
    for (const Piece& piece : linear) error.strain = std::max(error.strain, std::abs(piece.strain));
    return error;
  }

 private:
  bool is_chord() const {
    return body_.condition == ReferenceCondition::chord ||
           body_.condition == ReferenceCondition::mean_axis;
  }

  void add_element(int e) {
    const auto& element = body_.beam.elements[e];
    Eigen::Matrix<double, 12, 1> q;
    q << nodal_.col(e), nodal_.col(e + 1);
    const auto& section = element.section;
    const double length = element.length;
    Piece piece;
    piece.length = length / pieces_an_element_;
    piece.stiffness << element.shear * section.torsion, element.young * section.inertia_y,
        element.young * section.inertia_z;
    const bool stretches = has_coordinate(0);
    piece.strain = stretches ? elongation_of(body_, in_frame_, e) / length : 0.0;
    piece.axial = stretches ? element.young * section.area : 0.0;
    const ElementForm<double> form = form_of(element);
    piece.angle << 0.0, shear_y_row(form).dot(q), shear_z_row(form).dot(q);
    piece.compliance << 0.0, element.shear_compliance_y, element.shear_compliance_z;
    const double force = piece.axial * piece.strain;
    const auto rates = rates_of_curvature(q, form);
    piece.linear_rate =
        Vector3d(0.0, -piece.stiffness(1) * rates[0], -piece.stiffness(2) * rates[1]);
    for (int i = 0; i < pieces_an_element_; ++i) {
      const double xi = (i + 0.5) / pieces_an_element_;
      const double slope_y = deflection_y_row(xi, form, 1).dot(q);
      const double slope_z = deflection_z_row(xi, form, 1).dot(q);
      piece.curvature << (q(9) - q(3)) / length, -deflection_z_row(xi, form, 2).dot(q),
          deflection_y_row(xi, form, 2).dot(q);
      piece.load << force, piece.linear_rate(2), -piece.linear_rate(1);
      if (body_.has_stiffening) piece.load += force * Vector3d(0.0, slope_y, slope_z);
      pieces_.push_back(piece);
    }
  }

  /// κ_y' and κ_z' of an element.
  static std::array<double, 2> rates_of_curvature(const Eigen::Matrix<double, 12, 1>& q,
                                                  const ElementForm<double>& form) {
    const auto curvatures = [&](double xi) {
      return std::array<double, 2>{-deflection_z_row(xi, form, 2).dot(q),
                                   deflection_y_row(xi, form, 2).dot(q)};
    };
    const auto first = curvatures(0.0), last = curvatures(1.0);
    return {(last[0] - first[0]) / form.length, (last[1] - first[1]) / form.length};
  }

  /// r' of a piece whose section is turned by R.
  static Vector3d tangent_of(const Piece& piece, const Matrix3d& rotation) {
    return (1.0 + piece.strain) * rotation.col(0) + rotation * piece.angle;
  }

  /// The shape that curvatures, elongations and shear of the pieces make, in the frame.
  Shape integrate() const {
    Shape shape{{Vector3d::Zero()}, {Matrix3d::Identity()}};
    for (const Piece& piece : pieces_) {
      const Matrix3d middle =
          shape.rotation.back() * rotation_of(0.5 * piece.length * piece.curvature);
      shape.position.push_back(shape.position.back() + piece.length * tangent_of(piece, middle));
      shape.rotation.push_back(shape.rotation.back() * rotation_of(piece.length * piece.curvature));
    }
    align(shape);
    return shape;
  }

  /// Meets the condition that ties the frame to the beam; of the mean axis that of the chord.
  void align(Shape& shape) const {
    Matrix3d turned = Matrix3d::Identity();
    Vector3d shift = Vector3d::Zero();
    if (is_chord()) {
      const Vector3d tip = shape.position.back();
      const Vector3d axis = tip.cross(Vector3d::UnitX());
      const double sine = axis.norm();
      if (sine > 0.0) turned = rotation_of(axis * (std::atan2(sine, tip.x()) / sine));
    } else if (body_.condition == ReferenceCondition::tangent_end) {
      turned = shape.rotation.back().transpose();
      shift = length() * Vector3d::UnitX() - turned * shape.position.back();
    }
    for (Vector3d& position : shape.position) position = turned * position + shift;
    for (Matrix3d& rotation : shape.rotation) rotation = turned * rotation;
  }

  double length() const { return body_.beam.node_position(body_.beam.node_count() - 1); }

  /// Curvatures, elongations and shear of the loads at their true places.
  void correct(const Shape& shape) {
    std::vector<Matrix3d> rotations;
    std::vector<Vector3d> changes;  // of r' × Q, integrated from the first node to each middle
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      rotations.push_back(shape.rotation[i] * rotation_of(0.5 * piece.length * piece.curvature));
      const Vector3d tangent = tangent_of(piece, rotations[i]);
      const Vector3d half = 0.5 * piece.length * (tangent.cross(piece.load) - piece.linear_rate);
      changes.push_back(sum + half);
      sum += 2.0 * half;
    }
    const Vector3d share = share_beside_axial_force();
    double x = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      Piece& piece = pieces_[i];
      x += 0.5 * piece.length;
      Vector3d moment = -changes[i];  // beside that of the linear equations
      if (is_chord()) {
        moment += x / length() * sum;
      } else if (body_.condition == ReferenceCondition::tangent) {
        moment += sum;
      }
      x += 0.5 * piece.length;
      const Vector3d before = piece.stiffness.cwiseProduct(piece.curvature);
      const Vector3d local = rotations[i].transpose() * (before + share.cwiseProduct(moment));
      for (int k = 0; k < 3; ++k) {
        if (!has_coordinate(3 + k)) continue;
        piece.curvature(k) += (local(k) - before(k)) / piece.stiffness(k);
      }
      piece.angle = piece.compliance.cwiseProduct(rotations[i].transpose() * piece.load);
      if (piece.axial == 0.0) continue;
      const double force = rotations[i].col(0).dot(piece.load);
      piece.strain += (force - piece.axial * piece.strain) / piece.axial;
    }
  }

  /// What a beam makes of moments, as curvature, where its axial force N takes a part or adds one: that
  /// which a half sine against the chord (a quarter against a tangent) makes of it,  1/(1 + N/P),
  /// P = π² EI/L² (a quarter of it). Of a taut one that bends little it is next to nothing. One that
  /// bears more pressure than P is held more firmly than that: a wave of half the length has 4 P.
  Vector3d share_beside_axial_force() const {
    const double waves = is_chord() ? 1.0 : 0.5;
    double work = 0.0;  // N L
    Vector3d flexibility = Vector3d::Zero();
    for (const Piece& piece : pieces_) {
      work += piece.length * piece.axial * piece.strain;
      flexibility += piece.length * piece.stiffness.cwiseInverse();
    }
    Vector3d share = Vector3d::Ones();
    if (!body_.has_stiffening) return share;
    for (int k : {1, 2}) {
      const double buckling = std::pow(waves * std::numbers::pi, 2) / (flexibility(k) * length());
      double ratio = work / length() / buckling;
      while (ratio <= -1.0) ratio *= 0.25;
      share(k) = 1.0 / (1.0 + std::max(ratio, -nearest_to_buckling));
    }
    return share;
  }

  /// Whether the model has a nodal displacement (0 … 5) at all.
  bool has_coordinate(int displacement) const {
    const ElasticCoordinates& nodal = body_.coordinates;
    for (int node = 0; node < nodal.node_count(); ++node) {
      if (nodal.index(node, displacement) >= 0) return true;
    }
    return false;
  }

  void compare_curvatures(const std::vector<Piece>& linear, GeometricError& error) const {
    double largest = 0.0, change = 0.0;
    for (std::size_t i = 0; i < linear.size(); ++i) {
      largest = std::max(largest, linear[i].curvature.norm());
      change = std::max(change, (pieces_[i].curvature - linear[i].curvature).norm());
    }
    if (largest * length() > shape_round_off) error.curvature = change / largest;
  }

  void compare_shapes(const Shape& exact, const std::vector<Piece>& linear,
                      GeometricError& error) const {
    const Eigen::Index last = nodal_.cols() - 1;
    double sideways = 0.0, sideways_error = 0.0, along_error = 0.0, turned = 0.0,
           turned_error = 0.0, x = 0.0;
    for (Eigen::Index node = 0; node <= last; ++node) {
      const std::size_t i = pieces_an_element_ * node;
      const Vector3d displacement = exact.position[i] - x * Vector3d::UnitX();
      const Vector3d change = displacement - nodal_.col(node).head<3>();
      // Twist displaces the edges of the sections.
      sideways = std::max({sideways, nodal_.col(node).segment<2>(1).norm(),
                           std::abs(nodal_(3, node)) * edge_distance()});
      sideways_error = std::max(sideways_error, change.tail<2>().norm());
      along_error = std::max(along_error, std::abs(change(0)));
      const Vector3d rotation = nodal_.col(node).tail<3>();
      turned = std::max(turned, rotation.norm());
      turned_error =
          std::max(turned_error,
                   rotation_vector(rotation_of(rotation).transpose() * exact.rotation[i]).norm());
      if (node < last) x += body_.beam.elements[node].length;
    }
    if (sideways > shape_round_off * length()) error.deflection = sideways_error / sideways;
    if (turned > shape_round_off) error.rotation = turned_error / turned;
    const double along = body_.has_stiffening ? axial_scale(linear) : length();
    if (along > shape_round_off * length()) error.position = along_error / along;
  }

  /// From the axis to the farthest stress point of a section [m].
  double edge_distance() const {
    double largest = 0.0;
    for (const BeamElement<double>& element : body_.beam.elements) {
      for (const StressPoint<double>& point : element.section.points) {
        largest = std::max(largest, std::hypot(point.y, point.z));
      }
    }
    return largest;
  }

  /// Elongation and shortening by bending, each by its size [m].
  double axial_scale(const std::vector<Piece>& linear) const {
    double scale = 0.0;
    for (int e = 0; e + 1 < nodal_.cols(); ++e) {
      scale += std::abs(elongation_of(body_, in_frame_, e) - (nodal_(0, e + 1) - nodal_(0, e)));
    }
    for (const Piece& piece : linear) scale += std::abs(piece.strain) * piece.length;
    return scale;
  }

  /// Against the line through both ends.
  void lay_on_chord(Eigen::MatrixXd& nodal) const {
    const Eigen::Index last = nodal.cols() - 1;
    const Eigen::VectorXd first = nodal.col(0), end = nodal.col(last);
    const Eigen::Vector2d slope = (end - first).segment<2>(1) / length();
    double x = 0.0;
    for (Eigen::Index node = 0; node <= last; ++node) {
      nodal.col(node).head<3>() -= first.head<3>();
      nodal.col(node)(3) -= first(3);
      nodal.col(node).segment<2>(1) -= x * slope;
      nodal.col(node)(4) += slope(1);
      nodal.col(node)(5) -= slope(0);
      if (node < last) x += body_.beam.elements[node].length;
    }
  }

  const BodyModel& body_;
  const Eigen::MatrixXd& in_frame_;
  Eigen::MatrixXd nodal_;  ///< against the tangent or chord that shapes are aligned to
  int pieces_an_element_;
  std::vector<Piece> pieces_;
};

}  // namespace

GeometricError estimate_geometric_error(const BodyModel& body, const Eigen::MatrixXd& nodal) {
  return ExactBeam(body, nodal).error();
}

}  // namespace pleuel
