#include "cli/work_makers.hpp"

#include "optimization/design/multi_start.hpp"
#include "optimization/design/size_trials.hpp"
#include "studies/front_ends.hpp"
#include "studies/pareto.hpp"
#include "studies/uncertainty.hpp"

namespace pleuel {

WorkMakers work_makers() {
  return {{search_work_name, make_search_work},
          {trial_work_name, make_trial_work},
          {end_work_name, make_end_work},
          {point_work_name, make_point_work},
          {sample_work_name, make_sample_work}};
}

}  // namespace pleuel
