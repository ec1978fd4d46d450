#include "core/response/reaction_signal.hpp"

#include <fmt/format.h>

#include "core/model/joint_reaction.hpp"
#include "core/response/vector_component.hpp"

namespace pleuel {

namespace {

class ReactionSignal final : public Signal {
 public:
  ReactionSignal(const JointModel& joint, const ReactionPart& part)
      : reaction_(joint), part_(part) {}

  int channels() const override { return 1; }
  std::string describe(int) const override {
    return fmt::format("joint {}, {}", reaction_.joint().name, component_name(part_.direction));
  }

  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = component_of<double>(part_of(reaction_.wrench(state)), part_.direction);
  }

  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    const JointReaction::Derivatives derivatives = reaction_.derivatives(state);
    const Eigen::RowVector3d slope =
        weight * component_slope(part_of(reaction_.wrench(state)), part_.direction);
    const Eigen::RowVectorXd q = slope * part_of(derivatives.q);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      gradient.q(reaction_.coordinates()[i]) += q(i);
    }
    const Eigen::RowVectorXd lambda = slope * part_of(derivatives.lambda);
    gradient.lambda.segment(reaction_.multiplier(state), lambda.size()) += lambda.transpose();
    for (const auto& [variable, wrench] : derivatives.design) {
      gradient.design(variable) += slope * part_of(wrench);
    }
  }

 private:
  /// The rows of the force or of the moment.
  template <class Rows>
  Eigen::Matrix<double, 3, Rows::ColsAtCompileTime> part_of(const Rows& rows) const {
    return rows.template middleRows<3>(part_.kind == ReactionPart::Kind::force ? 0 : 3);
  }

  JointReaction reaction_;
  ReactionPart part_;
};

}  // namespace

std::unique_ptr<Signal> make_reaction_signal(const JointModel& joint, const ReactionPart& part) {
  return std::make_unique<ReactionSignal>(joint, part);
}

}  // namespace pleuel
