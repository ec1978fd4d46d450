#pragma once

#include <utility>

#include "cli/text/json.hpp"
#include "picture/motion.hpp"
#include "sensitivity/gradients.hpp"

/// What the report shows of simulated designs (docs/report.md) [SI].
namespace pleuel {

struct DesignInfluence {
  Eigen::MatrixXd gradients;  ///< responses × variables [SI]
  /// Empty where they would take too much time or memory.
  std::vector<HistoryGradients> histories{};
};

/// Of a simulation that is there already: no other one is made. With few variables by one run of
/// direct differentiation, which gives the histories, too; with many by the cheaper exact method.
/// Null without variables, and where the gradients cannot be computed.
std::shared_ptr<const DesignInfluence> design_influence(const ProblemFile& problem,
                                                        Analysis& analysis);

/// A design that is shown.
struct ShownDesign {
  std::string name;  ///< "start", "optimum"; for people, too
  Eigen::VectorXd x;
  std::shared_ptr<Analysis> analysis{};  ///< null: geometry only
  /// Of the histories (core/trust/error_bars.hpp); empty where none is known.
  std::vector<Eigen::VectorXd> bands{};
  std::shared_ptr<const DesignInfluence> influence{};  ///< of the variables; null: not known
  Motion rigid{};  ///< without an analysis: how drives move it; empty: it stands
};

/// The mechanism of a problem at some designs: its geometry and, of simulated ones, motion, stress,
/// histories and what else is known of them; units and meaning of all numbers.
/// @param pictures  that share one page, and with it its room: more of them have fewer frames and
///                  points each
Json run_picture(const ProblemFile& problem, const std::vector<ShownDesign>& designs,
                 std::size_t pictures = 1);

/// Of designs that are not simulated: their drives move them, with rigid bodies.
Json rigid_picture(const ProblemFile& problem,
                   const std::vector<std::pair<std::string, Eigen::VectorXd>>& designs);

/// One picture of the pictures of all load cases (none empty): that of `shown`, with the others
/// under "other_cases" in the order of the file, and under "units" those of the responses and limits
/// of all cases, by their names in result.json.
Json picture_of_cases(const ProblemFile& joined, std::vector<Json> cases, std::size_t shown);

// What is drawn of a scene.

/// What does not depend on the design: names, kinds, who is joined to whom, gravity, plane of
/// motion.
Json scene_picture(const ProblemFile& problem);

/// What does: bodies with their axes and the outlines of their sections, places of joints and loads
/// on the bodies, drives and loads over time.
Json geometry_picture(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
