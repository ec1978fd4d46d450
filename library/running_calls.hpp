#pragma once

namespace pleuel {

/// A call that may be stopped, while it lasts. What was asked of the calls before is forgotten when the first
/// one begins.
class RunningCall {
 public:
  RunningCall() noexcept;
  ~RunningCall();
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;
};

}  // namespace pleuel
