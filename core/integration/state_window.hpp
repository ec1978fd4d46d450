#pragma once

#include "core/integration/state_columns.hpp"

namespace pleuel {

/// The states of consecutive instants.
class StateWindow {
 public:
  /// Of no capacity.
  StateWindow() = default;
  /// @param like  a state of the same size
  StateWindow(const RecordedState& like, Eigen::Index capacity) : columns_(like, capacity) {}

  /// Makes it empty, with this instant to come.
  void clear(Eigen::Index next) {
    first_ = next;
    count_ = 0;
  }

  /// Where there are more states than expected, it grows.
  void push(const RecordedState& state) {
    if (count_ == columns_.capacity()) columns_.resize(count_ + count_ / 8 + 64);
    columns_.set(count_++, state);
  }

  bool holds(Eigen::Index instant) const { return instant >= first_ && instant < first_ + count_; }
  void load(Eigen::Index instant, State& state) const { columns_.load(instant - first_, state); }
  void load_record(Eigen::Index instant, RecordedState& state) const {
    columns_.load_record(instant - first_, state);
  }

  /// All states; leaves none.
  StateColumns take() {
    if (count_ < columns_.capacity()) columns_.resize(count_);
    count_ = 0;
    return std::move(columns_);
  }

 private:
  Eigen::Index first_ = 0, count_ = 0;
  StateColumns columns_;
};

}  // namespace pleuel
