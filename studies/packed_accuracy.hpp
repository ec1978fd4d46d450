#pragma once

#include "core/base/packed.hpp"
#include "studies/accuracy_run.hpp"

/// Parts of accuracy studies (core/base/part_store.hpp). Each names all members of its struct.
namespace pleuel {

template <class Archive>
void transfer(Archive& archive, Discretization& settings) {
  auto& [step, elements, factor] = settings;
  archive(step, elements, factor);
}

template <class Archive>
void transfer(Archive& archive, Doubt& doubt) {
  auto& [text, is_serious, responses, bodies] = doubt;
  archive(text, is_serious, responses, bodies);
}

template <class Archive>
void transfer(Archive& archive, AccuracyRun& run) {
  auto& [settings, failure, values, gradients, magnitudes, errors, gradient_errors, optimum_change,
         simulation_seconds, gradient_seconds, steps, newton_iterations, factorizations, doubts] =
      run;
  archive(settings, failure, values, gradients, magnitudes, errors, gradient_errors, optimum_change,
          simulation_seconds, gradient_seconds, steps, newton_iterations, factorizations, doubts);
}

}  // namespace pleuel
