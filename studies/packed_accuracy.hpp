#pragma once

#include "core/base/packed.hpp"
#include "studies/accuracy.hpp"
#include "studies/accuracy_optimum.hpp"

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

template <class Archive>
void transfer(Archive& archive, ReferenceCheck& check) {
  auto& [formulation, failure, differences] = check;
  archive(formulation, failure, differences);
}

/// But for the variation, which the file says.
template <class Archive>
void transfer(Archive& archive, VariedRun& varied) {
  auto& [variation, run, time_change, influence] = varied;
  (void)variation;
  archive(run, time_change, influence);
}

template <class Archive>
void transfer(Archive& archive, OptimumRun& run) {
  auto& [settings, failure, status, x, objective, change, seconds, evaluations] = run;
  archive(settings, failure, status, x, objective, change, seconds, evaluations);
}

}  // namespace pleuel
