#pragma once

#include "core/model/model.hpp"

namespace pleuel {

/// What a joint, its drive included, exerts on its second body at that body's point of the joint,
/// global axes: the force [N], then the moment about the point [N m],
///     [ −(∂Φ/∂P₂)ᵀ λ ; −(∂Φ/∂θ₂)ᵀ λ ]
/// with exact derivatives. States are in the numbers of the joint: local where it has a map.
class JointReaction {
 public:
  using Wrench = Eigen::Matrix<double, 6, 1>;
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  struct Derivatives {
    Columns q;       ///< one column for each of coordinates()
    Columns lambda;  ///< one for each equation, from multiplier() on
    std::vector<DesignDerivative<Wrench>> design;
  };

  /// @param joint  must outlive the reaction
  explicit JointReaction(const JointModel& joint);
  ~JointReaction();

  const JointModel& joint() const { return joint_; }
  /// Indices in q of the coordinates that it depends on.
  const std::vector<int>& coordinates() const { return coordinates_; }
  /// Index in λ of the first equation.
  int multiplier(const State& state) const;

  Wrench wrench(const State& state) const;
  Derivatives derivatives(const State& state) const;

 private:
  struct Numbers;

  const JointModel& joint_;
  std::vector<int> coordinates_;
  std::unique_ptr<const Numbers> numbers_;
};

}  // namespace pleuel
