#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/response/history_map.hpp"
#include "core/response/reduction.hpp"
#include "core/response/signal.hpp"
#include "core/scene/response_settings.hpp"

namespace pleuel {

/// A number that follows from the design alone: a mass, a natural frequency of a body.
struct DesignConstant {
  double value = 0.0;
  Eigen::VectorXd derivatives;  ///< one a design variable
};

/// How cycles of stress become a number, in place of a reduction over time. The channels of the
/// history are pairs: stress over two strengths.
struct FatigueRule {
  FatigueCriterion criterion = FatigueCriterion::goodman;
  /// Of the damage by all cycles (reduce_damage()); without it, by the largest one (reduce_cycle()).
  std::optional<double> damage_exponent = {};
};

/// A signal over time, reduced to a number.
struct ResponseHistory {
  std::shared_ptr<Signal> signal;  ///< the same for all that observe the same
  OverTime over_time = OverTime::max;
  std::optional<double> from = {}, to = {};  ///< window of time that is reduced [s]
  /// From what is observed to what is shown and reduced; null: the same.
  std::unique_ptr<const HistoryMap> map = {};
  std::optional<FatigueRule> fatigue = {};
  AmongChannels among = AmongChannels::largest;
  /// Of a deflection against the rigid mechanism: which response of Analysis::rigid is taken off.
  std::optional<std::size_t> rigid_response = {};
};

/// A number that the user asks for.
struct Response {
  std::string name;
  std::string unit;  ///< SI
  /// A mode is one of the whole mechanism at its initial state, whose derivatives it takes; a formula is
  /// evaluated by core/response/expression_value.hpp.
  std::variant<DesignConstant, ModeChoice, ResponseHistory, ExpressionResponse> source;

  /// What is observed; null for a number that is none of a motion.
  const ResponseHistory* history() const { return std::get_if<ResponseHistory>(&source); }
  const ModeChoice* mode() const { return std::get_if<ModeChoice>(&source); }
  const Expression* expression() const {
    const auto* formula = std::get_if<ExpressionResponse>(&source);
    return formula ? formula->expression.get() : nullptr;
  }
  bool is_fatigue() const { return history() && history()->fatigue; }
  /// Whether its number is reduced over time in one of these ways.
  bool is_reduced_by(OverTime kind) const { return history() && history()->over_time == kind; }
  bool is_peak_over_time() const { return history() && is_peak(history()->over_time); }

  /// Whether its window holds two steps or more, from which it can be reduced.
  bool holds_steps(const Eigen::VectorXd& time) const;
  /// The steps of a simulation that are reduced: all of them where the response has no history.
  /// @throws InputError if the window holds less than two
  StepRange steps(const Eigen::VectorXd& time) const;
};

/// `the response "…" cannot be computed: …`
std::string refused_response(const std::string& name, const std::string& why);
/// @throws InputError that says so
[[noreturn]] void refuse_response(const std::string& name, const std::string& why);

}  // namespace pleuel
