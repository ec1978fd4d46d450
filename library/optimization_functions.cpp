// Optimization (include/pleuel.h).

#include "core/response/analysis.hpp"
#include "library/guarded_call.hpp"
#include "library/search_document.hpp"

using namespace pleuel;

pleuel_status pleuel_optimize(pleuel_problem problem, const double* x, size_t variables,
                              const char* options, pleuel_observer observer, void* user,
                              char** result) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(result, "result");
    const Eigen::VectorXd start =
        x == nullptr ? start_design(open.file()) : checked_design(open, x, variables);
    const SearchOptions asked =
        read_search_options(options == nullptr ? "{}" : options, open.file());
    *result = text_out(to_text(search_document(open.file(), start, asked, {observer, user})));
  });
}
