#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/response/response.hpp"

namespace pleuel {

/// Observes the signals of all responses while the mechanism is simulated, so that no state is
/// needed twice.
class Recorder {
 public:
  /// @param responses  must outlive this
  /// @param instants   as many as there are, if no step has to be split
  Recorder(const std::vector<Response>& responses, int instants);

  void see(int step, const State& state);

  /// The histories, one a response: channels × instants; empty for constants.
  /// @param instants  as many as were seen
  std::vector<Eigen::MatrixXd> take(int instants);

 private:
  const std::vector<Response>& responses_;
  std::vector<Eigen::MatrixXd> histories_;
};

}  // namespace pleuel
