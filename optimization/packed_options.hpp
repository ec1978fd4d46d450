#pragma once

#include "core/base/packed.hpp"
#include "optimization/solve.hpp"

/// Options for other processes (core/base/packed.hpp). Each names all members of its struct.
namespace pleuel {

template <class Archive>
void transfer(Archive& archive, Tolerances& tolerances) {
  auto& [kkt_residual, variable_residual, violation, gradient, gain] = tolerances;
  archive(kkt_residual, variable_residual, violation, gradient, gain);
}

template <class Archive>
void transfer(Archive& archive, SolveOptions::Used& used) {
  auto& [iterations, restarts] = used;
  archive(iterations, restarts);
}

template <class Archive>
void transfer(Archive& archive, SolveOptions& options) {
  auto& [backend, tolerance, max_iterations, max_restarts, max_escapes, max_consecutive_failures,
         max_polishes, polish_iterations, patience, first_step, starts, other_backends, verdict,
         earlier] = options;
  archive(backend, tolerance, max_iterations, max_restarts, max_escapes, max_consecutive_failures,
          max_polishes, polish_iterations, patience, first_step, starts, other_backends, verdict,
          earlier);
}

}  // namespace pleuel
