#include "core/joints/joint_wrench.hpp"

#include "core/joints/joint_residual.hpp"

namespace pleuel {

template <class Scalar>
Eigen::Matrix<Scalar, 6, 1> joint_wrench(const JointTopology& topology,
                                         const JointData<Scalar>& data, double time,
                                         const Scalar* q, const Scalar* lambda) {
  using Evaluation = JointEvaluation<Scalar>;
  // Rates do not matter at position level, but the kinematics wants them.
  typename Evaluation::Kinematics::Coordinates rest;
  rest.fill(Scalar(0));
  std::vector<Scalar> equations(topology.equations.size());
  Evaluation evaluation(topology, data, time, q, rest.data(), rest.data());
  evaluation.evaluate(ConstraintLevel::position, lambda, equations.data());
  Eigen::Matrix<Scalar, 6, 1> result;
  result << evaluation.wrench().force, evaluation.wrench().moment;
  return result;
}

template Eigen::Matrix<double, 6, 1> joint_wrench(const JointTopology&, const JointData<double>&,
                                                  double, const double*, const double*);
template Eigen::Matrix<Dual, 6, 1> joint_wrench(const JointTopology&, const JointData<Dual>&,
                                                double, const Dual*, const Dual*);
template Eigen::Matrix<WideDual, 6, 1> joint_wrench(const JointTopology&,
                                                    const JointData<WideDual>&, double,
                                                    const WideDual*, const WideDual*);

}  // namespace pleuel
