// Bodies that functions of the caller make, and permission for programs (include/pleuel.h).

#include <memory>
#include <mutex>
#include <optional>

#include "core/base/child_program.hpp"
#include "core/base/error.hpp"
#include "core/base/worker.hpp"
#include "core/scene/body_generator.hpp"
#include "library/guarded_call.hpp"

namespace {

using namespace pleuel;

std::string text_of(pleuel_body_maker make, void* user, const Eigen::VectorXd& values) {
  const char* text = nullptr;
  const int code = make(values.data(), static_cast<std::size_t>(values.size()), &text, user);
  std::string copy = text == nullptr ? "" : text;
  if (code == 0) return copy;
  throw SimulationError(copy.empty() ? "it failed without a word" : copy);
}

/// Whatever it throws is a failure of the design.
std::string guarded_text_of(pleuel_body_maker make, void* user, const Eigen::VectorXd& values) {
  try {
    return text_of(make, user, values);
  } catch (const std::exception& error) {
    throw SimulationError(error.what());
  } catch (...) {
    throw SimulationError("it threw what is no exception of the standard library");
  }
}

}  // namespace

pleuel_status pleuel_register_body(const char* body, pleuel_body_maker make, void* user) {
  return guarded_call([&] {
    require_pointer(body, "body");
    BodyFunction function;
    if (make != nullptr) {
      const auto here = std::make_shared<WorkersForbidden>();  // as long as it is registered
      function = [make, user, here](const Eigen::VectorXd& values) {
        return guarded_text_of(make, user, values);
      };
    }
    register_body(body, std::move(function));
  });
}

pleuel_status pleuel_allow_programs(int allowed) {
  return guarded_call([&] {
    static std::mutex mutex;
    static std::optional<ProgramPermission> permission;
    const std::lock_guard<std::mutex> lock(mutex);
    permission.reset();
    if (allowed != 0) permission.emplace();
  });
}
