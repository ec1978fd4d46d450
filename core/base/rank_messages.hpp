#pragma once

#include "core/base/packed.hpp"
#include "core/base/task_place.hpp"
#include "core/base/task_work.hpp"

/// What rank_place.hpp and task_server.hpp say to each other: packed, one message a frame.
namespace pleuel {

/// Followed by PackedWork; number and order; task and text; task; nothing.
enum class ToRank : char { work, start, answer, kill, ask_to_end };

/// Followed by number and event; what went wrong.
enum class FromRank : char { event, problem };

template <class... Values>
Frame message_of(const Values&... values) {
  return {Frame::Kind::message, packed(values...)};
}

}  // namespace pleuel
