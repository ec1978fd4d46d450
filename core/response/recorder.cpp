#include "core/response/recorder.hpp"

#include "core/base/machine_memory.hpp"

namespace pleuel {

Recorder::Recorder(const std::vector<Response>& responses, int instants) : responses_(responses) {
  for (const Response& response : responses) {
    const ResponseHistory* observed = response.history();
    Eigen::MatrixXd& history = histories_.emplace_back(observed ? observed->signal->channels() : 0,
                                                       observed ? instants : 0);
    prefer_huge_pages(history.data(), history.size());
  }
}

void Recorder::see(int step, const State& state) {
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    const ResponseHistory* observed = responses_[i].history();
    if (!observed) continue;
    if (step == histories_[i].cols()) {
      histories_[i].conservativeResize(Eigen::NoChange, step + step / 8 + 64);
    }
    observed->signal->observe(state, histories_[i].col(step));
  }
}

std::vector<Eigen::MatrixXd> Recorder::take(int instants) {
  for (Eigen::MatrixXd& history : histories_) {
    if (history.cols() > instants) history.conservativeResize(Eigen::NoChange, instants);
  }
  return std::move(histories_);
}

}  // namespace pleuel
