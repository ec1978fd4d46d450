#include "optimization/design/made_search.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
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

}  // namespace

bool has_made_bodies(const ProblemFile& file) {
  for (const ProblemFile* problem : simulated_problems(file)) {
    for (const Body& body : problem->scene.bodies) {
      if (made_body(body)) return true;
    }
  }
  return false;
}

MadeBodies::MadeBodies(ProblemFile file) : file_(std::move(file)) {
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

Eigen::VectorXd MadeBodies::values_of(const Made& made, const Eigen::VectorXd& x) {
  return x(made.variables);
}

std::shared_ptr<const BodySource> MadeBodies::continued(const Made& made) {
  return continue_body(made.source->identity(), made.made);
}

double MadeBodies::make_at(const Eigen::VectorXd& x) {
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

bool MadeBodies::are_made_at(const Eigen::VectorXd& x) const {
  return std::all_of(bodies_.begin(), bodies_.end(), [&](const Made& made) {
    return !made.made.empty() && continued(made)->distance(values_of(made, x)) == 0.0;
  });
}

ProblemFile MadeBodies::continued(ProblemFile file) const {
  const std::vector<ProblemFile*> problems = simulated_problems(file);
  for (const Made& made : bodies_) {
    Body& body = problems[made.problem]->scene.bodies[made.body];
    std::get<ImportedBody>(body.shape).maker = continued(made);
  }
  return file;
}

ProblemFile MadeBodies::continued_around(const Eigen::VectorXd& x, double radius) const {
  ProblemFile file = continued();
  std::vector<ProblemFile*> problems = simulated_problems(file);
  if (file.has_cases()) problems.push_back(&file);
  std::vector<bool> is_narrow(file.variables.size(), false);
  for (const Made& made : bodies_) {
    for (const int variable : made.variables) is_narrow[static_cast<std::size_t>(variable)] = true;
  }
  for (ProblemFile* problem : problems) {
    for (std::size_t i = 0; i < is_narrow.size(); ++i) {
      if (is_narrow[i]) narrow(problem->variables[i], x(static_cast<Eigen::Index>(i)), radius);
    }
  }
  return file;
}

namespace {

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
                              const SolveOptions& options, const Execution& execution,
                              Result& before, const Observer& observer) {
  DesignProblem problem(bodies.continued_around(x, radius), execution.tasks.jobs, execution.store);
  problem.start_from(x);
  SolveOptions strict = options;
  strict.verdict.violation = tight_violation;
  Eigen::VectorXd found = x;
  before = run_after(before, observer, [&](const Observer& hears) {
    Result result = search_with_setting(problem, strict, hears);
    if (has_moved(result)) found = result.x;
    return result;
  });
  return found;
}

}  // namespace

Eigen::VectorXd search_between_calls(MadeBodies& bodies, const Eigen::VectorXd& x,
                                     const SolveOptions& options, const Execution& execution,
                                     Result& before, const Observer& observer,
                                     const Notice& notice) {
  double radius = first_radius;
  Eigen::VectorXd best = x;
  while (bodies.designs() < most_designs && radius > least_radius) {
    const Eigen::VectorXd next =
        search_region(bodies, best, radius, options, execution, before, observer);
    const double step = relative_step(best, next);
    if (step < small_step) break;
    try {
      const double error = bodies.make_at(next);
      notify(
          notice,
          fmt::format("bodies were made for design {}, {:.2g} % away; their stiffness was foretold "
                      "to {:.2g} %",
                      bodies.designs(), 100.0 * step, 100.0 * error));
      if (error < good_error) radius = std::min(2.0 * radius, largest_radius);
      if (error > bad_error) radius *= 0.5;
      radius = std::min(radius, longest_next_step * step);
      best = next;
    } catch (const SimulationError& failure) {
      notify(notice, fmt::format("{}: the next step is shorter", failure.what()));
      radius *= 0.25;
    }
  }
  return best;
}

}  // namespace pleuel
