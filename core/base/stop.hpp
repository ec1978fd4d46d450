#pragma once

namespace pleuel {

/// What check_stop() throws. No exception of the standard library: nobody takes it for a failure of
/// what was being computed.
struct Stopped {};

/// Asks all that computes in this process to end. May be called by the handler of a signal.
void request_stop() noexcept;

/// Forgets that. To be called where nothing computes.
void withdraw_stop() noexcept;

/// To be called in every loop that may take long: each time step, each sample.
/// @throws Stopped if the end was asked for
void check_stop();

}  // namespace pleuel
