#include "core/response/drive_signals.hpp"

namespace pleuel {

namespace {

class DriveEffortSignal final : public Signal {
 public:
  explicit DriveEffortSignal(int row) : row_(row) {}
  int channels() const override { return 1; }
  std::string describe(int) const override { return "drive"; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = -state.lambda(row_);
  }
  void add_gradient(const State&, int, double weight, SignalGradient& gradient) override {
    gradient.lambda(row_) -= weight;
  }

 private:
  int row_;
};

TimeLaw<Dual> seed_law(const TimeLaw<double>& law, const TimeLaw<double>& derivative) {
  std::size_t i = 0;
  return law.transformed<Dual>([&](double parameter) {
    return Dual(parameter, Dual::Derivatives::Constant(derivative.parameters[i++]));
  });
}

class DrivePowerSignal final : public Signal {
 public:
  explicit DrivePowerSignal(const JointModel& joint) : joint_(joint) {
    for (const auto& [variable, data] : joint.derivatives) {
      laws_.push_back({variable, seed_law(joint.data.drive, data.drive)});
    }
  }
  int channels() const override { return 1; }
  std::string describe(int) const override { return "drive"; }
  void observe(const State& state, Eigen::Ref<Eigen::VectorXd> values) override {
    values(0) = -state.lambda(joint_.drive_row) * joint_.data.drive.at(state.time).rate;
  }
  void add_gradient(const State& state, int, double weight, SignalGradient& gradient) override {
    gradient.lambda(joint_.drive_row) -= weight * joint_.data.drive.at(state.time).rate;
    for (const auto& [variable, law] : laws_) {
      gradient.design(variable) -=
          weight * state.lambda(joint_.drive_row) * derivative_of(law.at(state.time).rate);
    }
  }

 private:
  const JointModel& joint_;
  std::vector<DesignDerivative<TimeLaw<Dual>>> laws_;
};

}  // namespace

std::unique_ptr<Signal> make_drive_effort_signal(const JointModel& joint) {
  return std::make_unique<DriveEffortSignal>(joint.drive_row);
}

std::unique_ptr<Signal> make_drive_power_signal(const JointModel& joint) {
  return std::make_unique<DrivePowerSignal>(joint);
}

}  // namespace pleuel
