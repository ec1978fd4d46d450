#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "core/frame/marker.hpp"
#include "core/system/term.hpp"

/// Force elements on bodies of every kind, in states that obey no joint.

/// Two bodies that a force element acts on.
struct Mount {
  std::string name;
  std::array<pleuel::Marker, 2> markers;
  int coordinates = 0;
  std::vector<int> rotations;  ///< first coordinates of rotation vectors
};

/// Bodies that move freely in space, and in a tilted plane; ground and body; ground and point mass;
/// two places of one body.
std::vector<Mount> all_mounts();

struct ForceSample {
  std::string name;
  Mount mount;
  int numbers = 0;  ///< of the data; each is a design variable
  /// The term with one of its numbers shifted.
  std::function<std::unique_ptr<pleuel::Term>(int number, double shift)> make_shifted = {};

  // Of elements that act along a coordinate s of two markers:
  std::function<double(const Eigen::VectorXd& q)> coordinate = {};  ///< s
  double stiffness = 0.0, damping = 0.0, rest = 0.0;                ///< k, c, s₀
  std::function<std::unique_ptr<pleuel::Term>()> make_spring = {},
                                                 make_damper = {};  ///< with k, c only

  std::unique_ptr<pleuel::Term> make() const { return make_shifted(0, 0.0); }

  /// The same at every call: lengths of 1 m, rotations of 1 rad, elastic displacements of 0.05 m
  /// and rotations of 0.4 rad.
  pleuel::State random_state() const;
  /// q ⊕ increment.
  Eigen::VectorXd advanced(const Eigen::VectorXd& q, const Eigen::VectorXd& increment) const;
};

/// Which: those that act along a coordinate s; those between two bodies in space; those that do
/// both.
enum class ForceChoice { all, internal, spatial, internal_spatial };
std::vector<ForceSample> force_samples(ForceChoice choice);

/// How a failing test calls its sample.
std::ostream& operator<<(std::ostream& stream, const ForceSample& sample);
