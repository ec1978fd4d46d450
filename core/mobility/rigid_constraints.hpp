#pragma once

#include <optional>
#include <vector>

#include "core/base/sparse_rows.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// Joints and drives Φ(z, t) = 0 of bodies that do not deform: z are the coordinates of frames and point
/// masses, elastic ones stay as they are. All is relative to the scales: lengths in a joint to the
/// size of the smaller of its bodies, angles to 1 rad. Rows are those that the system keeps, drives
/// among them.
class RigidConstraints {
 public:
  /// @param model  must outlive this
  explicit RigidConstraints(const Model& model);

  int rows() const { return static_cast<int>(multipliers_.size()); }
  int coordinates() const { return static_cast<int>(coordinates_.size()); }
  /// Whether a row is that of a drive.
  const std::vector<bool>& is_drive() const { return is_drive_; }
  /// By how much joints are apart: the sum of their distances, angles times the length.
  struct Gap {
    double distance = 0.0;  ///< [m]
    double share = 0.0;     ///< relative to the lengths
  };
  Gap gap(const Eigen::VectorXd& values) const;
  /// Steps that close() has made so far.
  int iterations() const { return iterations_; }

  /// Φ at positions q (all coordinates of the mechanism) and a time.
  Eigen::VectorXd values(const Eigen::VectorXd& q, double time) const;
  /// Φ and Φ_z.
  void linearize(const Eigen::VectorXd& q, double time, Eigen::VectorXd& values,
                 SparseRows& jacobian) const;
  /// q ⊕ change, a change of z.
  Eigen::VectorXd advance(const Eigen::VectorXd& q, const Eigen::VectorXd& change) const;
  /// The change of z from one position to another.
  Eigen::VectorXd difference(const Eigen::VectorXd& to, const Eigen::VectorXd& from) const;
  /// A change of z in all coordinates of the mechanism, in their units.
  Eigen::VectorXd expand(const Eigen::VectorXd& change) const;

  struct Closure {
    Eigen::VectorXd q;      ///< where Φ is zero, or least
    Eigen::VectorXd first;  ///< the first step: the tangent, of least norm
    bool is_closed = false;
  };
  /// The closest positions with Φ = 0, or those where ‖W Φ‖ has a minimum: by the method of
  /// Levenberg and Marquardt (Nocedal & Wright, Numerical Optimization, §10.3), which needs no
  /// independent rows.
  Closure close(const Eigen::VectorXd& q, double time, const Eigen::VectorXd& weight);
  Closure close(const Eigen::VectorXd& q, double time);
  /// W with which joints come apart in their points: directions and drives are kept.
  Eigen::VectorXd weight_of_gaps() const;

 private:
  struct Part {
    Term* term;
    EntryList entries;
  };

  bool solve_damped(const SparseRows& jacobian, const Eigen::VectorXd& values, double damping,
                    Eigen::VectorXd& step);

  const Mechanism& mechanism_;
  std::vector<Part> parts_;       ///< terms with constraints
  std::vector<int> coordinates_;  ///< z in q
  std::vector<int> column_of_;    ///< of each coordinate, or −1
  std::vector<int> multipliers_;  ///< rows in λ
  std::vector<int> row_of_;       ///< of each multiplier, or −1
  std::vector<bool> is_drive_, is_angle_;
  std::vector<int> joint_;     ///< of each row
  Eigen::VectorXd row_scale_;  ///< of each row
  Eigen::VectorXd length_;     ///< of each row [m]
  int iterations_ = 0;
  std::optional<LinearSolver> solver_;  ///< of the steps of close()
};

}  // namespace pleuel
