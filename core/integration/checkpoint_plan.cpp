#include "core/integration/checkpoint_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pleuel {

namespace {

int whole(double number) {
  return static_cast<int>(std::min(number, double{std::numeric_limits<int>::max()}));
}

}  // namespace

int CheckpointPlan::most_checkpoints() const {
  return whole(std::floor(0.5 * memory / checkpoint_bytes));
}

int CheckpointPlan::longest_stretch() const {
  return std::max(0, whole(std::floor(0.5 * memory / state_bytes)) - 1);
}

int CheckpointPlan::most_states() const {
  return whole(1.0 * most_checkpoints() * longest_stretch());
}

int CheckpointPlan::stretch_for(int states) const {
  return std::max(1, (states + most_checkpoints() - 1) / std::max(most_checkpoints(), 1));
}

double CheckpointPlan::least_memory(int states) const {
  const double balanced = std::sqrt(states * state_bytes * checkpoint_bytes);
  // Neither half holds a part of a state; the end of a stretch is the next checkpoint.
  return 2.0 * (balanced + checkpoint_bytes + state_bytes);
}

}  // namespace pleuel
