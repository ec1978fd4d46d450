#include "core/response/recorder.hpp"

#include <map>

#include "core/base/machine_memory.hpp"

namespace pleuel {

Recorder::Recorder(const std::vector<Response>& responses, int instants) {
  std::map<const Signal*, std::size_t> known;
  for (const Response& response : responses) {
    Signal* signal = response.history() ? response.history()->signal.get() : nullptr;
    const auto [place, is_new] = known.try_emplace(signal, observed_.size());
    places_.push_back(place->second);
    if (!is_new) continue;
    auto history = signal ? std::make_shared<Eigen::MatrixXd>(signal->channels(), instants)
                          : std::make_shared<Eigen::MatrixXd>();
    prefer_huge_pages(history->data(), history->size());
    observed_.push_back({signal, std::move(history)});
  }
}

void Recorder::see(int step, const State& state) {
  for (const auto& [signal, history] : observed_) {
    if (!signal) continue;
    if (step == history->cols()) {
      history->conservativeResize(Eigen::NoChange, step + step / 8 + 64);
    }
    signal->observe(state, history->col(step));
  }
}

Histories Recorder::take(int instants) {
  for (const auto& [signal, history] : observed_) {
    if (history->cols() > instants) history->conservativeResize(Eigen::NoChange, instants);
  }
  Histories histories;
  for (const std::size_t place : places_) histories.add(observed_[place].history);
  return histories;
}

}  // namespace pleuel
