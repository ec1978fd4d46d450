#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/base/task_work.hpp"
#include "core/base/worker.hpp"

namespace pleuel {

/// Makes work again from its PackedWork, by kind.
using WorkMakers =
    std::map<std::string, std::function<std::unique_ptr<TaskWork>(const std::string& content)>>;

/// Carries out tasks of another rank (rank_place.hpp), each in a process forked from this one, until
/// the other end of the link is closed.
void serve_tasks(Channel& link, const WorkMakers& makers);

}  // namespace pleuel
