#pragma once

#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Gradients of numbers with respect to each of the constants of one elastic body.
struct ConstantGradients {
  BodyConstants constants;  ///< of the body at the design
  std::vector<BodyConstants>
      numbers;  ///< one a response: dJ/dI in the arrangement of I [unit of J per SI unit]
};

/// dJ/dI: the gradients of all responses with respect to every invariant of a body of a file, its places, stress and
/// stiffening. The equations of motion are linear in them, so they are what the adjoint sums up anyway; whoever knows
/// dI/dx of his own finite-element model has
///     dJ/dx = Σ dJ/dI · dI/dx
/// for any number of variables x, without another simulation. Of sparse matrices there are the entries that the file
/// lists, zeros among them. Entries count one by one: of a symmetric matrix only the sum over changes that keep it
/// symmetric has a meaning.
/// @param body  of the type "invariants"
/// @throws InputError if there is no such body, or the problem has load cases; SimulationError
ConstantGradients constant_gradients(const ProblemFile& problem, const Eigen::VectorXd& x,
                                     const std::string& body);

/// Σ dJ/dI · dI/dx
double along(const BodyConstants& gradient, const BodyConstants& change);

}  // namespace pleuel
