#include "core/response/fatigue_signal.hpp"

#include <utility>

#include "core/response/body_strengths.hpp"
#include "core/response/composed_signals.hpp"

namespace pleuel {

namespace {

/// 1/S of a strength S of the material.
DesignFactor inverse_of(const BodyModel& body, int variables, double Strengths<double>::*member,
                        const char* name) {
  DesignFactor strength{strengths_of(body).*member, Eigen::VectorXd::Zero(variables), name};
  for (const auto& [variable, change] : strength_derivatives(body)) {
    strength.derivatives(variable) = change.*member;
  }
  return strength.inverse();
}

}  // namespace

std::unique_ptr<Signal> make_fatigue_signal(std::unique_ptr<Signal> stress, const BodyModel& body,
                                            int variables, const CycleStrengths& strengths) {
  return std::make_unique<ScaledSignal>(
      std::move(stress),
      std::vector<DesignFactor>{
          inverse_of(body, variables, strengths.of_amplitude, ""),
          inverse_of(body, variables, strengths.of_mean, ", as a mean stress")},
      ScaledOrder::channel_by_channel);
}

}  // namespace pleuel
