#include "optimization/design/made_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
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

}  // namespace pleuel
