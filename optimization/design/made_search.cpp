#include "optimization/design/made_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/continued_body.hpp"
#include "core/scene/load_cases.hpp"

namespace pleuel {

namespace {

const ImportedBody* made_body(const Body& body) {
  const auto* imported = std::get_if<ImportedBody>(&body.shape);
  return imported && imported->maker ? imported : nullptr;
}

void narrow(DesignVariable& variable, double x, double radius) {
  const bool is_positive = x > 0.0;
  const double away = radius * (variable.upper - variable.lower);
  variable.lower = std::max(variable.lower, is_positive ? x * std::exp(-radius) : x - away);
  variable.upper = std::min(variable.upper, is_positive ? x * std::exp(radius) : x + away);
  variable.start = std::clamp(x, variable.lower, variable.upper);
}

/// The bodies that were made for some designs of an optimization, and the problem in which they are
/// continued between these designs (core/scene/continued_body.hpp).
class MadeBodies {
 public:
  /// @pre has_made_bodies(file)
  explicit MadeBodies(ProblemFile file) : file_(std::move(file)) {
    const std::vector<ProblemFile*> problems = simulated_problems(file_);
    for (std::size_t p = 0; p < problems.size(); ++p) {
      for (std::size_t b = 0; b < problems[p]->scene.bodies.size(); ++b) {
        const ImportedBody* imported = made_body(problems[p]->scene.bodies[b]);
        if (!imported) continue;
        Made& made = bodies_.emplace_back(Made{p, b, {}, imported->maker, {}});
        for (const ImportedVariable& of : imported->variables) {
          made.variables.push_back(of.number.variable);
        }
      }
    }
  }

  /// Has all bodies made for a design.
  /// @returns how far what was continued to this design was off: the largest relative stiffness, as
  ///          a logarithm; 0 at the first design
  /// @throws SimulationError if one cannot be made
  double make_at(const Eigen::VectorXd& x) {
    double error = 0.0;
    std::vector<std::shared_ptr<const InvariantsFile>> files;
    for (const Made& made : bodies_) files.push_back(made.source->at(values_of(made, x)));
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Made& made = bodies_[i];
      if (designs_ > 0) {
        const auto foretold = continued(made)->at(values_of(made, x));
        error = std::max(error, stiffness_distance(foretold->constants, files[i]->constants));
      }
      made.made.push_back(std::move(files[i]));
    }
    ++designs_;
    return error;
  }

  /// Whether they were made for this very design.
  bool are_made_at(const Eigen::VectorXd& x) const {
    return std::ranges::all_of(bodies_, [&](const Made& made) {
      return !made.made.empty() && continued(made)->distance(values_of(made, x)) == 0.0;
    });
  }

  /// Designs they were made for.
  int designs() const { return designs_; }

  const ProblemFile& original() const { return file_; }

  /// The problem, or one that differs from it in its setting only, with continued bodies.
  ProblemFile continued(ProblemFile file) const {
    const std::vector<ProblemFile*> problems = simulated_problems(file);
    for (const Made& made : bodies_) {
      Body& body = problems[made.problem]->scene.bodies[made.body];
      std::get<ImportedBody>(body.shape).maker = continued(made);
    }
    return file;
  }
  ProblemFile continued() const { return continued(file_); }

  /// The same with the bounds of variables that bodies depend on narrowed to x e^±radius, or to
  /// x ± radius (upper − lower) of those that are not positive.
  ProblemFile continued_around(const Eigen::VectorXd& x, double radius) const {
    ProblemFile file = continued();
    std::vector<ProblemFile*> problems = simulated_problems(file);
    if (file.has_cases()) problems.push_back(&file);
    std::vector<bool> is_narrow(file.variables.size(), false);
    for (const Made& made : bodies_) {
      for (const int variable : made.variables)
        is_narrow[static_cast<std::size_t>(variable)] = true;
    }
    for (ProblemFile* problem : problems) {
      for (std::size_t i = 0; i < is_narrow.size(); ++i) {
        if (is_narrow[i]) narrow(problem->variables[i], x(static_cast<Eigen::Index>(i)), radius);
      }
    }
    return file;
  }

 private:
  /// A body of one of the problems that are simulated.
  struct Made {
    std::size_t problem, body;
    std::vector<int> variables;  ///< of the problem, that it depends on
    std::shared_ptr<const BodySource> source;
    std::vector<std::shared_ptr<const InvariantsFile>> made;
  };

  static Eigen::VectorXd values_of(const Made& made, const Eigen::VectorXd& x) {
    return x(made.variables);
  }
  static std::shared_ptr<const BodySource> continued(const Made& made) {
    return continue_body(made.source->identity(), made.made);
  }

  ProblemFile file_;
  std::vector<Made> bodies_;
  int designs_ = 0;
};

/// Half the width of the region, in logarithms of the variables.
constexpr double first_radius = 0.7, largest_radius = 1.4, least_radius = 1e-3;
/// Errors of the stiffness that was foretold, below which the region grows, above which it shrinks.
constexpr double good_error = 0.2, bad_error = 0.5;
/// A step is no longer than so many times the one before: what was foretold of a short one tells little of a
/// long one.
constexpr double longest_next_step = 4.0;
/// A design that moves by less stays.
constexpr double small_step = 1e-3;
/// Violation of limits that a search may leave: what the next bodies change comes on top.
constexpr double tight_violation = 1e-7;
constexpr int most_designs = 30;

/// The largest change of a variable, relative to its value.
double relative_step(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const Eigen::ArrayXd size = from.array().abs().max(to.array().abs()).max(1e-300);
  return ((to - from).array().abs() / size).maxCoeff();
}

/// @returns the best design of the region, or x if nothing could be evaluated
Eigen::VectorXd search_region(const MadeBodies& bodies, const Eigen::VectorXd& x, double radius,
                              const SearchSetup& setup, Result& before) {
  const auto problem = setup.problem_at(bodies.continued_around(x, radius), x);
  SolveOptions strict = setup.options;
  strict.verdict.violation = tight_violation;
  Eigen::VectorXd found = x;
  before = run_after(before, setup.observer, [&](const Observer& hears) {
    Result result = search_with_setting(*problem, strict, hears);
    if (has_moved(result)) found = result.x;
    return result;
  });
  return found;
}

/// Moves a design towards the optimum with few calls of what makes the bodies: searches with
/// continued bodies within a region in which they are trusted, has the bodies made at the design
/// that is found, and goes on from there, until the design stays (to 1e-3). The region grows or
/// shrinks by how well the next bodies were foretold, and is no wider than four steps such as the last.
/// @param x       that the bodies were made for
/// @param before  effort and history of what was done before; goes on with that of the searches
/// @returns       a design that the bodies were made for
Eigen::VectorXd search_between_calls(MadeBodies& bodies, const Eigen::VectorXd& x,
                                     const SearchSetup& setup, Result& before) {
  double radius = first_radius;
  Eigen::VectorXd best = x;
  while (bodies.designs() < most_designs && radius > least_radius) {
    const Eigen::VectorXd next = search_region(bodies, best, radius, setup, before);
    const double step = relative_step(best, next);
    if (step < small_step) break;
    try {
      const double error = bodies.make_at(next);
      notify(
          setup.notice,
          fmt::format("bodies were made for design {}, {:.2g} % away; their stiffness was foretold "
                      "to {:.2g} %",
                      bodies.designs(), 100.0 * step, 100.0 * error));
      if (error < good_error) radius = std::min(2.0 * radius, largest_radius);
      if (error > bad_error) radius *= 0.5;
      radius = std::min(radius, longest_next_step * step);
      best = next;
    } catch (const SimulationError& failure) {
      notify(setup.notice, fmt::format("{}: the next step is shorter", failure.what()));
      radius *= 0.25;
    }
  }
  return best;
}

/// Bodies that are made anew for each design are made for few. The verdict is over a design that they were
/// made for: where the audited search ends elsewhere, they are made there, and it begins again.
class MadeSolve {
 public:
  MadeSolve(const ProblemFile& file, const SearchSetup& setup) : bodies_(file), setup_(setup) {
    setup_.options.takes_verified_start = true;
  }

  StagedSolution run(const Eigen::VectorXd& x) {
    if (!make_at(x)) return solve(bodies_.original(), x);
    made_for_ = search_between_calls(bodies_, x, setup_, before_);
    StagedSolution solution = solve(bodies_.continued(), made_for_);
    bool can_go_on = true;
    for (int round = 1; round < most_judgements && can_go_on && has_left(solution); ++round) {
      can_go_on = make_at(solution.result.x);
      notify(setup_.notice,
             can_go_on ? "bodies were made for the design that was found, which is judged again"
                       : "the last design that bodies were made for is judged in its place");
      if (!can_go_on) setup_.options.max_iterations = 1;
      ProblemFile next = solution.problem->file();
      next.accuracy.chooses_setting = false;  // that is done
      std::vector<Stage> stages = std::move(solution.stages);
      solution = solve(bodies_.continued(std::move(next)), made_for_);
      stages.insert(stages.end(), solution.stages.begin(), solution.stages.end());
      solution.stages = std::move(stages);
    }
    return solution;
  }

 private:
  static constexpr int most_judgements = 5;

  /// @returns whether there are bodies
  bool make_at(const Eigen::VectorXd& x) {
    try {
      bodies_.make_at(x);
      made_for_ = x;
      return true;
    } catch (const SimulationError& failure) {
      notify(setup_.notice, failure.what());
      return false;
    }
  }

  bool has_left(const StagedSolution& solution) const {
    return solution.result.evaluation.has_gradients() && !bodies_.are_made_at(solution.result.x);
  }

  StagedSolution solve(const ProblemFile& file, const Eigen::VectorXd& x) {
    StagedSolution solution;
    before_ = run_after(before_, setup_.observer, [&](const Observer& observer) {
      solution = solve_stages(file, x, setup_.heard_by(observer));
      return std::move(solution.result);
    });
    solution.result = before_;
    return solution;
  }

  MadeBodies bodies_;
  SearchSetup setup_;
  Result before_;             ///< effort and history so far
  Eigen::VectorXd made_for_;  ///< the last design with bodies
};

}  // namespace

bool has_made_bodies(const ProblemFile& file) {
  for (const ProblemFile* problem : simulated_problems(file)) {
    for (const Body& body : problem->scene.bodies) {
      if (made_body(body)) return true;
    }
  }
  return false;
}

StagedSolution solve_with_made_bodies(const ProblemFile& file, const Eigen::VectorXd& start,
                                      const SearchSetup& setup) {
  return MadeSolve(file, setup).run(start);
}

}  // namespace pleuel
