#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/response/histories.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// Observes the signals of all responses while the mechanism is simulated, so that no state is
/// needed twice. A signal that several responses share is observed once.
class Recorder {
 public:
  /// @param responses  must outlive this
  /// @param instants   as many as there are, if no step has to be split
  Recorder(const std::vector<Response>& responses, int instants);

  void see(int step, const State& state);

  /// @param instants  as many as were seen
  Histories take(int instants);

 private:
  struct Observed {
    Signal* signal;  ///< null: nothing, for constants
    std::shared_ptr<Eigen::MatrixXd> history;
  };
  std::vector<Observed> observed_;
  std::vector<std::size_t> places_;  ///< of responses, in `observed_`
};

}  // namespace pleuel
