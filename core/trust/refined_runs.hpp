#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/response/analysis.hpp"

/// Runs of the same design with another division of time or space, to compare responses with.
namespace pleuel {

/// How a nested run differs from the one that is judged.
struct Refinement {
  double step = 1.0;      ///< times the steps of the file: 2 or 0.5
  double elements = 1.0;  ///< times the elements of every segment: 2 or 0.5
  int more_modes = 0;     ///< of each family of every reduced beam
  double newton = 1.0;    ///< times the tolerance of Newton's method
  /// Into how many each element of the mesh is divided. Twice the elements of the file may be the
  /// same mesh, where joints, loads or frames divide the beam anyway.
  int pieces = 1;

  auto operator<=>(const Refinement&) const = default;
};

/// Both, one after the other.
Refinement operator*(const Refinement& first, const Refinement& second);

/// Refinements that judge what is not divided: so many modes more in each family (with one the next
/// may be of a symmetry that is not excited), and so many times the tolerance of Newton's method,
/// where that is above what leaves no error that counts.
inline constexpr int judging_modes = 2;
inline constexpr double judging_newton = 1e-3, small_newton_tolerance = 1e-8;

/// What is compared of a run.
struct RefinedRun {
  std::string failure;  ///< empty: it succeeded; else nothing below is known
  Eigen::VectorXd values;
  Eigen::VectorXd time;
  Histories histories;
  double work = 0.0;  ///< steps × unknowns

  bool has_failed() const { return !failure.empty(); }
};

/// The problem with its steps and elements changed. Twice the steps are rounded so that they divide
/// the time; the local error that is allowed, where steps follow it, changes with their square.
/// Half of an odd number of elements is rounded up.
ProblemFile refined(ProblemFile problem, const Refinement& refinement);

/// A nested run with all that it found.
struct NestedRun {
  ProblemFile problem;
  std::unique_ptr<Analysis> analysis;  ///< null: it failed
  std::string failure;
};

/// Of runs that judge another one: only values are asked for, and windows may be too short for their
/// steps.
/// @param similar  see analyze()
inline AnalysisOptions judging(const Trajectory* similar) {
  return {similar, ShortWindow::unknown, false};
}

/// @param similar  see analyze()
NestedRun simulate_refined(const ProblemFile& problem, const Eigen::VectorXd& x,
                           const Refinement& refinement, const Trajectory* similar = nullptr);

/// The same without its model and states.
RefinedRun make_refined_run(const ProblemFile& problem, const Eigen::VectorXd& x,
                            const Refinement& refinement, const Trajectory* similar = nullptr);

/// What was simulated already.
RefinedRun refined_run_of(const NestedRun& nested);

/// The runs of one design, each made once.
class RefinedRuns {
 public:
  RefinedRuns(const ProblemFile& problem, const Eigen::VectorXd& x) : problem_(problem), x_(x) {}

  /// A run that is there already.
  void keep(const Refinement& refinement, RefinedRun run);
  bool has(const Refinement& refinement) const { return runs_.contains(refinement); }
  /// Those that are not there yet are made on the threads of the machine. They stay where they are.
  /// @param similar  see analyze()
  std::vector<const RefinedRun*> runs(const std::vector<Refinement>& refinements,
                                      const Trajectory* similar = nullptr);
  const RefinedRun& run(const Refinement& refinement) { return *runs({refinement}).front(); }

 private:
  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
  std::map<Refinement, RefinedRun> runs_;
};

/// Whether an elastic beam is reduced to modes.
bool has_reduced_beams(const Model& model, const ProblemFile& problem);

/// The elements of all beams that the file does not call rigid.
int beam_elements(const ProblemFile& problem);

/// The elements of the meshes of all beams that the file does not call rigid, with what joints, loads
/// and frames divide.
int mesh_size(const ProblemFile& problem);

/// Whether half the elements of every elastic beam is a mesh with about half the elements: joints,
/// loads and frames may divide it as it is.
bool can_be_halved(const Model& model, const ProblemFile& problem);

/// The fewest elements of a segment of an elastic beam; none without such a beam.
std::optional<int> fewest_elements(const Model& model, const ProblemFile& problem);

}  // namespace pleuel
